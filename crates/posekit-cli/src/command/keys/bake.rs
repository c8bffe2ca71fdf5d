//! `posekit keys bake`: keys as a motion file.

use std::cell::Cell;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use posekit::motion::FrameTime;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{WriteOptions, write_motion_to};
use posekit_formats::report::Import;
use posekit_formats::scene::Shot;

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs::{Input, Inputs, STDIN, Source};
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::scene_file;
use crate::text::counted;

/// Make a motion file of a scene's keys, a frame at a time
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct BakeArgs {
    /// The scene file, or '-'
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
        return Err(Failure::usage("--order takes three axes, such as ZXY"));
    }
    extension::refuse_other(&args.output, &["bvh"], extension::REDIRECT)?;
    let frame_time = args.fps.map(FrameTime::of_rate).transpose();
    let frame_time = frame_time.map_err(|error| Failure::usage(format!("--fps: {error}")))?;
    let scene = scene_file::read(&args.file, &global.guard)?;
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
    } = scene_file::shot(&args.file, &scene, &global.guard)?;
    let name = scene_file::name_of(&args.file);
    load::refuse_repairs(&name, &report, global)?;
    for warning in load::repair_lines(&name, &report.warnings) {
        console::warning(&warning);
    }
    let input = Input {
        source: match args.file.as_os_str() == STDIN {
            true => Source::Stdin,
            false => Source::File(args.file.clone()),
        },
        relative: file_name(&args.file),
    };
    let inputs = Inputs {
        list: vec![input],
        ..Inputs::default()
    };
    let baking = Baking {
        shot: &shot,
        frame_time,
        order: args.order,
        too_far: Cell::new(None),
    };
    let because = |failure: Failure| match baking.too_far.take() {
        Some(too_far) => too_far.in_file(&name),
        None => failure,
    };
    match Plan::new(&args.output, &inputs, "bvh", &global.guard)?.destination(0) {
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            baking
                .write(&mut out)
                .and_then(|()| out.flush())
                .map_err(|error| because(error.into()))
        }
        Destination::File(target) => {
            write_whole(target, |file| baking.write(file)).map_err(because)?;
            if !global.quiet {
                let frames = counted(shot.frame_count(frame_time), "frame");
                console::note(&format!("wrote {}: {frames}", target.display()));
            }
            Ok(())
        }
    }
}

/// How many joints are posed at once, one for each joint and frame: enough that their number does not show in the
/// time, few enough that it does not show in the memory.
const POSED_AT_ONCE: usize = 1 << 17;

/// A scene on its way to a BVH file.
struct Baking<'a> {
    shot: &'a Shot,
    frame_time: Option<FrameTime>,
    order: EulerOrder,
    /// Why the writing was given up, where the scene and not the file is the reason.
    too_far: Cell<Option<Failure>>,
}

impl Baking<'_> {
    /// Writes the frames, baked a piece at a time.
    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let Self {
            shot, frame_time, ..
        } = *self;
        let frame_count = shot.frame_count(frame_time);
        let at_once = (POSED_AT_ONCE / shot.skeleton().joint_count().max(1)).max(1);
        let head = shot.bake_frames(frame_time, 0..0);
        let pieces = (0..frame_count).step_by(at_once).map_while(|first| {
            let end = (first + at_once).min(frame_count);
            let piece = shot.bake_frames(frame_time, first..end);
            match scene_file::refuse_too_far(&piece, |place| first + place) {
                Ok(()) => Some(piece),
                Err(failure) => {
                    self.too_far.set(Some(failure));
                    None
                }
            }
        });
        let options = WriteOptions::default();
        write_motion_to(&head, frame_count, pieces, self.order, options, &mut *out)?;
        let too_far = self.too_far.take();
        let is_whole = too_far.is_none();
        self.too_far.set(too_far);
        if is_whole {
            Ok(())
        } else {
            Err(io::Error::other("a joint is too far away"))
        }
    }
}

/// The name that a file in a folder gets: `walk` of `walk.posekit.toml`.
fn file_name(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default();
    PathBuf::from(stem)
}
