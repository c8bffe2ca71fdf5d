//! `posekit keys bake`: keys as a motion file.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Args;
use posekit::motion::FrameTime;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{Bvh, WriteOptions, write_to};
use posekit_formats::report::Import;

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{Input, Inputs, Source};
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::scene_file;
use crate::text::counted;

/// Make a motion file of a scene's keys, a frame at a time
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct BakeArgs {
    /// The scene file
    #[arg(value_name = "SCENE")]
    file: PathBuf,
    /// The .bvh to write, or '-' for standard output
    #[arg(long, short, value_name = "OUT")]
    output: OsString,
    /// Frames a second [default: the scene's own]
    #[arg(long, value_name = "RATE")]
    fps: Option<f64>,
    /// The order of the rotation channels
    #[arg(long, value_name = "ORDER", default_value = "ZXY")]
    order: EulerOrder,
}

const EXAMPLES: &str = "\
Examples:
  posekit keys bake walk.posekit.toml -o walk.bvh
  posekit keys bake walk.posekit.toml -o - --fps 120 | posekit info -";

/// More frames than this are a mistake in the rate.
const MOST_FRAMES: f64 = 1e7;

pub(super) fn run(args: &BakeArgs, global: &Global) -> Result<(), Failure> {
    if !args.order.is_complete() {
        return Err(Failure::usage("--order takes three axes, as ZXY"));
    }
    extension::refuse_other(&args.output, &["bvh"], extension::REDIRECT)?;
    let frame_time = args.fps.map(FrameTime::of_rate).transpose();
    let frame_time = frame_time.map_err(|error| Failure::usage(format!("--fps: {error}")))?;
    let scene = scene_file::read(&args.file)?;
    if let Some(fps) = args.fps {
        let frames = (scene.range_secs[1] - scene.range_secs[0]) * fps;
        if frames > MOST_FRAMES {
            return Err(Failure::usage(
                "--fps makes more than ten million frames of this scene",
            ));
        }
    }
    let Import {
        document: shot,
        report,
    } = scene_file::shot(&args.file, &scene)?;
    let name = args.file.display().to_string();
    load::refuse_repairs(&name, &report, global)?;
    for warning in load::repair_lines(&name, &report.warnings) {
        console::warning(&warning);
    }
    let motion = shot.bake(frame_time);
    scene_file::refuse_too_far(&motion).map_err(|failure| failure.in_file(&name))?;
    let bvh = Bvh::from_motion(&motion, args.order);
    let input = Input {
        source: Source::File(args.file.clone()),
        relative: file_name(&args.file),
    };
    let inputs = Inputs {
        list: vec![input],
        ..Inputs::default()
    };
    let options = WriteOptions::default();
    match Plan::new(&args.output, &inputs, "bvh")?.destination(0) {
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            write_to(&bvh, options, &mut out)?;
            Ok(std::io::Write::flush(&mut out)?)
        }
        Destination::File(path) => {
            write_whole(path, |file| write_to(&bvh, options, file))?;
            if !global.quiet {
                let frames = counted(bvh.frame_count(), "frame");
                console::note(&format!("wrote {}: {frames}", path.display()));
            }
            Ok(())
        }
    }
}

/// The name that a file in a folder gets: `walk` of `walk.posekit.toml`.
fn file_name(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default();
    PathBuf::from(stem)
}
