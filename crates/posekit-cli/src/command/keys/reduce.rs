//! `posekit keys reduce`: a dense motion as few keys.

use std::ffi::OsString;
use std::io::{self, Write};

use clap::Args;
use posekit::keyframe::{Interpolation, KeyedFrames, ReduceConfig, TrackError};
use posekit::motion::Motion;
use posekit::rotation::EulerOrder;
use posekit::skeleton::JointId;
use posekit_formats::scene::{
    self, EXTENSION, EulerNotation, JointTrack, JointValues, Scene, SkeletonSource, WriteError,
};

use crate::args::Global;
use crate::console;
use crate::extension;
use crate::failure::Failure;
use crate::inputs;
use crate::load;
use crate::output::{Destination, Plan, write_whole};
use crate::positions::PositionsArgs;
use crate::reading::Said;
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
    /// Keys joined by straight lines (slerp) instead of curves
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
        return Err(Failure::usage("--euler takes three axes, such as ZXY"));
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
    // Reading and reducing take long: where the result cannot go is said before.
    let one = inputs::Inputs {
        list: vec![input.clone()],
        ..inputs::Inputs::default()
    };
    let plan = Plan::new(&args.output, &one, EXTENSION, &global.guard)?;
    Said::of(args.positions).refuse_scene(input)?;
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
    if let Some(rate) = motion.frame_time().frames_per_sec() {
        scene.frames_per_sec = rate;
        // What is written must be read again: that is seen before the work is done.
        scene::check(&scene).map_err(|error| in_file(Failure::new(error.to_string())))?;
    }
    let keys = KeyedFrames::of(&motion, &config)
        .map_err(|error| in_file(Failure::new(error.to_string())))?;
    match plan.destination(0) {
        Destination::Stdout => {
            let mut out = console::binary_stdout();
            write(&scene, &keys, args.euler, &motion, &mut out)?;
            Ok(out.flush()?)
        }
        Destination::File(target) => {
            write_whole(target, |file| {
                write(&scene, &keys, args.euler, &motion, file)
            })?;
            if !global.quiet {
                console::note(&format!(
                    "wrote {}: {} in quaternions{}, {} that a key at every frame would take; within {} degrees and {} % of the height",
                    target.display(),
                    counted(keys.key_count(), "key"),
                    args.euler
                        .map_or_else(String::new, |order| format!(" (written as {order} angles)")),
                    share(keys.key_count(), dense_keys(&motion)),
                    trimmed(keys.error().angle_deg, 3),
                    trimmed(100.0 * keys.error().distance_heights, 3),
                ));
            }
            Ok(())
        }
    }
}

/// Writes the scene and the keys, the tracks of a joint at a time: all keys of a long motion take much more memory
/// than the motion.
fn write(
    scene: &Scene,
    keys: &KeyedFrames<'_>,
    euler: Option<EulerOrder>,
    motion: &Motion,
    out: &mut dyn Write,
) -> io::Result<()> {
    let skeleton = motion.skeleton();
    let track = |joint, values: Result<JointValues, TrackError>| {
        let name = skeleton.unique_name(joint).to_owned();
        let values = values.map_err(io::Error::other)?;
        Ok(JointTrack {
            joint: name,
            values,
        })
    };
    let translation = |joint| {
        let values = keys.translation(joint)?;
        Some(track(
            joint,
            values.map(|track| JointValues::Translation(track.into())),
        ))
    };
    let rotation = |joint| {
        let values = keys.rotation(joint)?;
        let euler = euler.map(|order| EulerNotation {
            order,
            angles_deg: Vec::new(),
        });
        let values = values.map(|track| JointValues::Rotation {
            track: track.into(),
            euler,
        });
        Some(track(joint, values))
    };
    let of_joint = |joint| {
        let both: [&dyn Fn(JointId) -> Option<io::Result<JointTrack>>; 2] =
            [&translation, &rotation];
        both.into_iter().filter_map(move |values| values(joint))
    };
    let tracks = skeleton.joints().flat_map(of_joint);
    scene::write_with_tracks(scene, tracks, out).map_err(|error| match error {
        WriteError::Io(error) => error,
        error => io::Error::other(error),
    })
}

fn dense_keys(motion: &Motion) -> usize {
    motion.frame_count() * (motion.rotated_joints().len() + motion.translated_joints().len())
}

fn share(part: usize, whole: usize) -> String {
    let percent = 100.0 * part as f64 / whole.max(1) as f64;
    format!("{} % of the {}", trimmed(percent, 1), grouped(whole))
}
