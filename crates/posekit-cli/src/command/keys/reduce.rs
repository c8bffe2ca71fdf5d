//! `posekit keys reduce`: a dense motion as few keys.

use std::ffi::OsString;
use std::io::Write;

use clap::Args;
use posekit::keyframe::{Interpolation, ReduceConfig, reduce};
use posekit::motion::Motion;
use posekit::rotation::EulerOrder;
use posekit_formats::scene::{self, EXTENSION, Scene, SkeletonSource};

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs;
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::positions::PositionsArgs;
use crate::text::{counted, grouped, trimmed};

/// Find few keys that stand for a motion within a stated error
///
/// Every joint's rotation stays within --angle of the motion's at every frame, and every joint's place in
/// the world within --distance; both are measured on the result. Keys are cubic with set slopes, and
/// rotations are quaternions.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ReduceArgs {
    /// The motion: a file, '-' or sample:NAME
    #[arg(value_name = "FILE")]
    file: OsString,
    /// The scene file to write, or '-' for standard output
    #[arg(long, short, value_name = "OUT")]
    output: OsString,
    /// The largest angle, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 1.0)]
    angle: f64,
    /// The largest distance, in heights of the skeleton
    #[arg(long, value_name = "HEIGHTS", default_value_t = 0.01)]
    distance: f64,
    /// Keys with straight ways (slerp) between them instead of curves
    #[arg(long)]
    linear: bool,
    /// Write the quaternions as Euler angles in degrees in this order; they stay quaternions between keys
    #[arg(long, value_name = "ORDER")]
    euler: Option<EulerOrder>,
    #[command(flatten)]
    positions: PositionsArgs,
}

const EXAMPLES: &str = "\
Examples:
  posekit keys reduce walk.bvh -o walk.posekit.toml
  posekit keys reduce sample:run -o - --angle 3 --distance 0.03 --euler ZXY";

pub(super) fn run(args: &ReduceArgs, global: &Global) -> Result<(), Failure> {
    if args.euler.is_some_and(|order| !order.is_complete()) {
        return Err(Failure::usage("--euler takes three axes, as ZXY"));
    }
    extension::refuse_other(&args.output, &[EXTENSION], extension::REDIRECT)?;
    let inputs = inputs::expand(std::slice::from_ref(&args.file));
    if let Some((_, failure)) = inputs.failures.into_iter().next() {
        return Err(failure);
    }
    let [input] = inputs.list.as_slice() else {
        return Err(Failure::usage("one motion at a time is reduced"));
    };
    let name = input.name();
    let loaded = load::load(input, global)?;
    let in_file = |failure: Failure| failure.in_file(&name);
    let motion = loaded.motion(args.positions.policies()).map_err(in_file)?;
    drop(loaded);
    let config = ReduceConfig {
        angle_deg: args.angle,
        distance_heights: args.distance,
        interpolation: if args.linear {
            Interpolation::Linear
        } else {
            Interpolation::Cubic
        },
    };
    let mut scene = Scene::new(SkeletonSource::inline(motion.skeleton()));
    scene.title = name.clone();
    scene.range_secs = [0.0, motion.duration_secs()];
    scene.frames_per_sec = 1.0 / motion.frame_time_secs();
    if motion.frame_time_secs() > 0.0 {
        // What is written must be read again: that is seen before the work is done.
        scene::check(&scene).map_err(|error| in_file(Failure::new(error.to_string())))?;
    }
    let reduction =
        reduce(&motion, &config).map_err(|error| in_file(Failure::new(error.to_string())))?;
    let dense = dense_keys(&motion);
    // Keys and their text take memory of their own.
    drop(motion);
    scene.set_animation(&reduction.animation, args.euler);
    scene::check(&scene).map_err(|error| in_file(Failure::new(error.to_string())))?;
    let bytes = scene::write(&scene);
    drop(scene);
    let one = inputs::Inputs {
        list: vec![input.clone()],
        ..inputs::Inputs::default()
    };
    match Plan::new(&args.output, &one, EXTENSION, &global.guard)?.destination(0) {
        Destination::Stdout => Ok(console::binary_stdout().write_all(&bytes)?),
        Destination::File(target) => {
            write_whole(target, |file| file.write_all(&bytes))?;
            if !global.quiet {
                console::note(&format!(
                    "wrote {}: {} in quaternions{}, {} that a key at every frame would take; within {} degrees and {} % of the height",
                    target.display(),
                    counted(reduction.animation.key_count(), "key"),
                    args.euler
                        .map_or_else(String::new, |order| format!(" (written as {order} angles)")),
                    share(reduction.animation.key_count(), dense),
                    trimmed(reduction.error.angle_deg, 3),
                    trimmed(100.0 * reduction.error.distance_heights, 3),
                ));
            }
            Ok(())
        }
    }
}

fn dense_keys(motion: &Motion) -> usize {
    motion.frame_count() * (motion.rotated_joints().len() + motion.translated_joints().len())
}

fn share(part: usize, whole: usize) -> String {
    let percent = 100.0 * part as f64 / whole.max(1) as f64;
    format!("{} % of the {}", trimmed(percent, 1), grouped(whole))
}
