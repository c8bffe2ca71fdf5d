//! `posekit keys print`: what keys a scene has.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use glam::{DQuat, DVec3};
use posekit::keyframe::{Extrapolation, Interpolation, KeyValue, Property, Track};
use posekit_formats::scene::{JointValues, Scene};

use crate::args::Global;
use crate::console::{self, HEADING, styled};
use crate::failure::Failure;
use crate::scene_file;
use crate::text::{Align, Table, counted, trimmed};

/// List the keys of a scene: what is keyed, when, and how it goes on
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct PrintArgs {
    /// The scene file, or '-'
    #[arg(value_name = "SCENE")]
    file: PathBuf,
    /// Every key with its value, as comma-separated values
    #[arg(long)]
    csv: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit keys print walk.posekit.toml
  posekit keys print walk.posekit.toml --csv";

pub(super) fn run(args: &PrintArgs, global: &Global) -> Result<(), Failure> {
    let scene = scene_file::read(&args.file, &global.guard)?;
    if args.csv {
        let mut out = console::binary_stdout();
        writeln!(out, "of,property,at_secs,curve,x,y,z,w")?;
        for row in rows(&scene) {
            for (time, curve, values) in &row.keys {
                let values: Vec<String> = values.iter().map(ToString::to_string).collect();
                let of = row.of.replace('"', "\"\"");
                writeln!(
                    out,
                    "\"{of}\",{},{time},{},{}",
                    row.property,
                    word(*curve),
                    values.join(",")
                )?;
            }
        }
        return Ok(out.flush()?);
    }
    let mut out = console::stdout();
    let rows = rows(&scene);
    let keys = rows.iter().map(|row| row.keys.len()).sum();
    let [start, end] = scene.range_secs;
    let title = if scene.title.is_empty() {
        scene_file::name_of(&args.file)
    } else {
        scene.title.clone()
    };
    writeln!(out, "{}", styled(HEADING, &title))?;
    writeln!(
        out,
        "{} on {}, {} s to {} s at {} frames a second",
        counted(keys, "key"),
        counted(rows.len(), "track"),
        trimmed(start, 3),
        trimmed(end, 3),
        trimmed(scene.frames_per_sec, 3),
    )?;
    let mut table = Table::new(&[
        ("of", Align::Left),
        ("property", Align::Left),
        ("keys", Align::Right),
        ("from s", Align::Right),
        ("to s", Align::Right),
        ("curves", Align::Left),
        ("beyond", Align::Left),
    ]);
    for row in &rows {
        let curves: BTreeSet<&str> = row.keys.iter().map(|(_, curve, _)| word(*curve)).collect();
        let time = |key: Option<&(f64, Interpolation, Vec<f64>)>| {
            trimmed(key.map_or(0.0, |(time, ..)| *time), 3)
        };
        table.row(vec![
            row.of.clone(),
            row.property.clone(),
            row.keys.len().to_string(),
            time(row.keys.first()),
            time(row.keys.last()),
            curves.into_iter().collect::<Vec<_>>().join(", "),
            row.beyond.clone(),
        ]);
    }
    table.write(&mut out)?;
    Ok(out.flush()?)
}

/// A track of anything in the scene.
struct Row {
    of: String,
    property: String,
    beyond: String,
    keys: Vec<(f64, Interpolation, Vec<f64>)>,
}

fn rows(scene: &Scene) -> Vec<Row> {
    let mut rows = Vec::new();
    for track in &scene.tracks {
        rows.push(match &track.values {
            JointValues::Rotation { track: keys, .. } => {
                row(&track.joint, "rotation", keys, |q: DQuat| {
                    q.to_array().to_vec()
                })
            }
            JointValues::EulerRotation(curves) => {
                // The values are angles in this order: columns of a CSV hold either.
                let property = format!("rotation {} deg", curves.order());
                row(&track.joint, &property, curves.angles_deg(), |v: DVec3| {
                    v.to_array().to_vec()
                })
            }
            JointValues::Translation(keys) => row(&track.joint, "translation", keys, |v: DVec3| {
                v.to_array().to_vec()
            }),
        });
    }
    let vector = |v: DVec3| v.to_array().to_vec();
    for camera in &scene.cameras {
        let (name, view) = (format!("camera {}", camera.name), &camera.view);
        rows.extend(keyed(&name, "position", &view.position, vector));
        rows.extend(keyed(&name, "target", &view.target, vector));
        rows.extend(keyed(
            &name,
            "vertical_fov_deg",
            &view.vertical_fov_deg,
            |v| vec![v],
        ));
    }
    for light in &scene.lights {
        let (name, shine) = (format!("light {}", light.name), &light.shine);
        rows.extend(keyed(&name, "position", &shine.position, vector));
        rows.extend(keyed(&name, "color", &shine.color, vector));
        rows.extend(keyed(&name, "strength", &shine.strength, |v| vec![v]));
    }
    for prop in &scene.props {
        let (name, transform) = (format!("prop {}", prop.name), &prop.transform);
        rows.extend(keyed(&name, "translation", &transform.translation, vector));
        rows.extend(keyed(&name, "rotation", &transform.rotation, |q| {
            q.to_array().to_vec()
        }));
        rows.extend(keyed(&name, "scale", &transform.scale, vector));
    }
    rows
}

fn keyed<V: KeyValue>(
    of: &str,
    property: &str,
    value: &Property<V>,
    numbers: impl Fn(V) -> Vec<f64>,
) -> Option<Row> {
    value.track().map(|track| row(of, property, track, numbers))
}

fn row<V: KeyValue>(
    of: &str,
    property: &str,
    track: &Track<V>,
    numbers: impl Fn(V) -> Vec<f64>,
) -> Row {
    let ways = [track.before(), track.after()].map(beyond);
    let keys = track.keys().iter();
    Row {
        of: of.to_owned(),
        property: property.to_owned(),
        beyond: if ways[0] == ways[1] {
            ways[0].to_owned()
        } else {
            format!("{} / {}", ways[0], ways[1])
        },
        keys: keys
            .map(|key| (key.time_secs, key.interpolation, numbers(key.value)))
            .collect(),
    }
}

fn beyond(way: Extrapolation) -> &'static str {
    match way {
        Extrapolation::Cycle => "cycle",
        Extrapolation::CycleWithOffset => "cycle with offset",
        Extrapolation::PingPong => "ping-pong",
        _ => "hold",
    }
}

fn word(curve: Interpolation) -> &'static str {
    match curve {
        Interpolation::Step => "step",
        Interpolation::Linear => "linear",
        Interpolation::Squad => "squad",
        _ => "cubic",
    }
}
