//! `posekit sample`: the clips that the program makes itself, as files.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use posekit_formats::bvh::{WriteOptions, write_to};
use posekit_formats::scene;
use posekit_formats::urdf;

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{Input, Inputs, Source};
use crate::output::{Destination, Plan, write_whole};
use crate::sample::Sample;
use crate::scene_file;
use crate::text::counted;

/// Write a clip that posekit makes itself: a walk, a run, a wave, a robot arm, a keyed walk; or a robot as URDF
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SampleArgs {
    /// The clip: walk, run, wave, arm or keyed-walk; or the robot: planar2, arm6 or arm7, with or without .urdf
    #[arg(value_name = "NAME", value_parser = [
        "walk", "run", "wave", "arm", "keyed-walk", "planar2", "arm6", "arm7",
        "planar2.urdf", "arm6.urdf", "arm7.urdf",
    ], hide_possible_values = true)]
    name: String,
    /// The new file, or '-' for standard output
    #[arg(long, short, value_name = "FILE")]
    output: OsString,
}

const EXAMPLES: &str = "\
Examples:
  posekit sample walk -o walk.bvh
  posekit sample arm -o - | posekit info -
  posekit sample keyed-walk -o walk.posekit.toml   the keys of the walk, to edit
  posekit sample arm6 -o arm6.urdf";

/// Writes the clip.
pub(crate) fn run(args: &SampleArgs, global: &Global) -> Result<(), Failure> {
    let robot = args.name.strip_suffix(".urdf").unwrap_or(&args.name);
    if let Some(text) = urdf::sample::by_name(robot) {
        return write_robot(args, global, robot, text);
    }
    let sample = Sample::named(&args.name)
        .ok_or_else(|| Failure::usage(format!("there is no sample '{}'", args.name)))?;
    let known = [&["bvh"][..], &["bvh", scene::EXTENSION]];
    let known = known[usize::from(sample.scene().is_some())];
    if !scene_file::is_scene(std::path::Path::new(&args.output)) {
        extension::refuse_other(&args.output, known, extension::REDIRECT)?;
    }
    let inputs = Inputs {
        list: vec![Input::sample(sample)],
        ..Inputs::default()
    };
    let plan = Plan::new(&args.output, &inputs, "bvh", &global.guard)?;
    if let Destination::File(target) = plan.destination(0)
        && scene_file::is_scene(target.path())
    {
        let text = sample.scene().ok_or_else(|| {
            Failure::usage(format!("'{}' has no keys", args.name)).try_next(
                "only keyed-walk is made of keys; posekit keys reduce turns a motion into keys",
            )
        })?;
        return write_whole(target, |file| {
            std::io::Write::write_all(file, text.as_bytes())
        });
    }
    let bvh = sample.document()?;
    let options = WriteOptions::default();
    match plan.destination(0) {
        Destination::File(target) => {
            write_whole(target, |file| write_to(&bvh, options, file))?;
            if !global.quiet {
                let frames = counted(bvh.frame_count(), "frame");
                let joints = counted(bvh.joints.len(), "joint");
                console::note(&format!("wrote {}: {frames} of {joints}", target.display()));
            }
            Ok(())
        }
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            write_to(&bvh, options, &mut out)?;
            Ok(out.flush()?)
        }
    }
}

/// Writes a robot's file.
fn write_robot(args: &SampleArgs, global: &Global, name: &str, text: &str) -> Result<(), Failure> {
    extension::refuse_other(&args.output, &["urdf"], extension::REDIRECT)?;
    let inputs = Inputs {
        list: vec![Input {
            // Nothing is read: only its name counts, where the output is a folder.
            source: Source::Stdin,
            relative: PathBuf::from(format!("{name}.urdf")),
        }],
        ..Inputs::default()
    };
    let plan = Plan::new(&args.output, &inputs, "urdf", &global.guard)?;
    match plan.destination(0) {
        Destination::File(target) => {
            write_whole(target, |file| file.write_all(text.as_bytes()))?;
            if !global.quiet {
                let what = urdf::sample::names().find(|(known, _)| *known == name);
                let what = what.map_or("a robot", |(_, what)| what);
                console::note(&format!("wrote {}: {what}", target.display()));
            }
            Ok(())
        }
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            out.write_all(text.as_bytes())?;
            Ok(out.flush()?)
        }
    }
}
