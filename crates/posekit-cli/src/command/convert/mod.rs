//! `posekit convert`: BVH to BVH.

mod change;

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use posekit::figure::UpAxis;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{Bvh, WriteOptions, write_to};

use crate::args::Global;
use crate::batch::{self, Done};
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{self, Input, STDIN, Source};
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::positions::PositionsArgs;
use crate::program::ProgramArg;
use crate::reading::Said;
use crate::text::counted;
use change::{Rename, Trim};

/// BVH files to BVH files: another frame rate, part of the frames, another unit, axis or rotation order
///
/// What no option touches stays as it was, to the digit. The options are applied in this order:
/// positions, rename, reorder-like, frame-time, trim, fps, scale, up, channels, order, for.
#[derive(Debug, Args)]
#[command(
    after_help = EXAMPLES,
    override_usage = "posekit convert [OPTIONS] <IN>... <OUT>\n       posekit convert [OPTIONS] <IN>... --output <OUT>"
)]
pub(crate) struct ConvertArgs {
    /// Files, folders, patterns, '-' or sample:NAME; the last is the output, unless -o gives it
    #[arg(value_name = "IN", required = true)]
    files: Vec<OsString>,
    /// The new file; a folder for many inputs, a pattern with {stem} and {dir}, or '-'
    #[arg(long, short, value_name = "OUT")]
    output: Option<OsString>,
    /// What is written, whatever the output is called [default: by its extension]
    #[arg(long, value_name = "FORMAT")]
    format: Option<Format>,
    #[command(flatten)]
    positions: PositionsArgs,
    /// Seconds from one frame to the next: the same frames, played faster or slower
    #[arg(long, value_name = "SECS")]
    frame_time: Option<f64>,
    /// Frames a second; joints turn by slerp between old frames
    #[arg(long, value_name = "RATE")]
    fps: Option<f64>,
    /// Part of the motion, by frame (10..50, without the last; 10..) or by time (0.5s..2s)
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
    trim: Option<Trim>,
    /// Multiply every length, for example by 0.01 for centimetres to metres
    #[arg(long, value_name = "FACTOR")]
    scale: Option<f64>,
    /// The axis that should point up: x, y, z, or -x, -y, -z
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    up: Option<UpAxis>,
    /// The axis that points up now [default: the one along which the rest pose stands]
    #[arg(long, value_name = "AXIS", requires = "up", allow_hyphen_values = true)]
    from_up: Option<UpAxis>,
    /// Rotation order of every joint's channels, such as ZXY
    #[arg(long, value_name = "ORDER")]
    order: Option<EulerOrder>,
    /// 3: positions on roots (and on joints that truly move) only; 6: positions and rotations on every joint
    #[arg(long, value_name = "3|6")]
    channels: Option<Channels>,
    /// Change what this program would refuse or misread; see posekit check --for
    #[arg(long = "for", value_name = "PROGRAM")]
    program: Option<ProgramArg>,
    /// Rename joint A to B, or by pattern, such as 'mixamorig:*=*'; may be repeated
    #[arg(long, value_name = "A=B")]
    rename: Vec<Rename>,
    /// Put the joints in the order of another file with the same joints
    #[arg(long, value_name = "OTHER.bvh")]
    reorder_like: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  posekit convert walk.bvh walk30.bvh --fps 30
  posekit convert walk.bvh step.bvh --trim 0.5s..1.7s
  posekit convert takes/ metres/ --scale 0.01         a folder, its sub-folders mirrored
  posekit convert walk.bvh --fps 30 -o walk30.bvh     the output first or last, as you like
  posekit convert walk.bvh zup.bvh --up z --order XYZ
  posekit convert walk.bvh page.bvh --for three
  posekit convert a.bvh b.bvh --rename Hips=pelvis --rename Spine=spine_01
  posekit convert a.bvh b.bvh --rename 'mixamorig:*=*'  strips a prefix from every name
  posekit convert slow.bvh right.bvh --frame-time 0.01
  posekit convert a.bvh b.bvh --positions root=add      places that every program reads alike
  posekit convert push.bvh same.bvh --reorder-like walk.bvh";

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Biovision hierarchy, .bvh
    Bvh,
}

/// How many channels a joint has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Channels {
    /// Rotations
    #[value(name = "3")]
    Three,
    /// Positions and rotations
    #[value(name = "6")]
    Six,
}

/// Runs the command.
pub(crate) fn run(args: &ConvertArgs, global: &Global) -> Result<(), Failure> {
    let model = args
        .reorder_like
        .as_deref()
        .map(|path| load_model(path, global))
        .transpose()?;
    let (files, output) = args.inputs_and_output()?;
    if args.format.is_none() {
        extension::refuse_other(output, &["bvh"], "--format bvh writes BVH anyway")?;
    }
    let inputs = inputs::expand(files);
    let is_set = inputs.is_set;
    let plan = Plan::new(output, &inputs, "bvh", &global.guard)?;
    let mut written_count = 0;
    let result = batch::run(
        inputs,
        global,
        |index, input| convert(args, model.as_ref(), input, plan.destination(index), global),
        |_, announcement: String| {
            written_count += 1;
            if !is_set && !global.quiet && output != STDIN {
                console::note(&announcement);
            }
            Ok(())
        },
    );
    if is_set && written_count > 0 && !global.quiet {
        let files = counted(written_count, "file");
        console::note(&format!("wrote {files} to {}", Path::new(output).display()));
    }
    result
}

impl ConvertArgs {
    /// What is read, and where it goes: the place that -o names, or the last of the names.
    fn inputs_and_output(&self) -> Result<(&[OsString], &OsStr), Failure> {
        if let Some(output) = &self.output {
            return Ok((&self.files, output));
        }
        match self.files.split_last() {
            Some((output, files)) if !files.is_empty() => Ok((files, output)),
            _ => Err(Failure::usage("the output is missing")
                .try_next("name it after the inputs, or with -o")),
        }
    }
}

fn load_model(path: &Path, global: &Global) -> Result<Bvh, Failure> {
    if fs::metadata(path).is_ok_and(|meta| meta.is_dir()) {
        return Err(Failure::new(format!(
            "{}: is a folder, not a file",
            path.display()
        )));
    }
    let source = Source::File(path.to_owned());
    Ok(load::load(
        &Input {
            source,
            relative: path.to_owned(),
        },
        global,
    )?
    .bvh)
}

fn convert(
    args: &ConvertArgs,
    model: Option<&Bvh>,
    input: &Input,
    destination: &Destination,
    global: &Global,
) -> Result<Done<String>, Failure> {
    let name = input.name();
    Said::of(args.positions).refuse_scene(input)?;
    let loaded = load::load(input, global)?;
    let mut warnings = loaded.repairs(input);
    let mut bvh = loaded.bvh;
    let remarks = change::apply(args, model, &mut bvh).map_err(|failure| failure.in_file(&name))?;
    let named = |remark: String| format!("{name}: {remark}");
    warnings.extend(remarks.warnings.into_iter().map(named));
    let notes = remarks.notes.into_iter().map(named).collect();
    let announcement = write(&bvh, destination)?;
    Ok(Done {
        value: announcement,
        warnings,
        notes,
    })
}

fn write(bvh: &Bvh, destination: &Destination) -> Result<String, Failure> {
    let options = WriteOptions::default();
    let frames = counted(bvh.frame_count(), "frame");
    let joints = counted(bvh.joints.len(), "joint");
    match destination {
        Destination::File(target) => {
            write_whole(target, |file| write_to(bvh, options, file))?;
            Ok(format!("wrote {}: {frames} of {joints}", target.display()))
        }
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            write_to(bvh, options, &mut out)?;
            std::io::Write::flush(&mut out)?;
            Ok(String::new())
        }
    }
}
