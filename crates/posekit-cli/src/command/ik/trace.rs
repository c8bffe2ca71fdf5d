//! The solver's way, written down: a row or an object for every joint's update in every iteration.

use std::io::{self, Write};
use std::path::Path;

use posekit::ik::TraceUpdate;
use posekit::skeleton::Skeleton;
use serde_json::{Value, json};

use super::steps::{Results, Task};
use crate::failure::Failure;

/// How a trace is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    /// Nested objects.
    Json,
    /// A table.
    Csv,
}

impl Format {
    /// The format that a file's name says.
    pub(super) fn of_path(path: &Path) -> Result<Self, Failure> {
        let extension = path
            .extension()
            .map(|extension| extension.to_ascii_lowercase());
        match extension.as_ref().and_then(|extension| extension.to_str()) {
            Some("json") => Ok(Self::Json),
            Some("csv") => Ok(Self::Csv),
            _ => Err(Failure::usage(format!(
                "{}: a trace is written as .json or .csv",
                path.display()
            ))),
        }
    }
}

/// Writes the trace of all frames.
pub(super) fn write(
    format: Format,
    skeleton: &Skeleton,
    task: &Task,
    results: &Results,
    out: &mut impl Write,
) -> io::Result<()> {
    match format {
        Format::Json => write_json(skeleton, task, results, out),
        Format::Csv => write_csv(skeleton, task, results, out),
    }
}

fn write_json(
    skeleton: &Skeleton,
    task: &Task,
    results: &Results,
    out: &mut impl Write,
) -> io::Result<()> {
    let name = |joint| skeleton.unique_name(joint);
    writeln!(out, "{{\"frames\": [")?;
    for (index, frame) in results.frames.iter().enumerate() {
        let iterations = frame
            .report
            .trace
            .iter()
            .flat_map(|trace| &trace.iterations);
        let iterations: Vec<Value> = iterations
            .map(|iteration| {
                let updates = iteration.updates.iter().map(|update| {
                    json!({
                        "joint": name(update.joint),
                        "end": name(task.goals[update.target].end),
                        "pivot": update.pivot_in_world.to_array(),
                        "to_effector": update.to_effector.to_array(),
                        "to_target": update.to_target.to_array(),
                        "axis": update.axis_in_world.to_array(),
                        "angle": update.amount.to_degrees(),
                        "effector": update.effector_in_world.to_array(),
                        "distance": update.distance,
                        "rotation": update.moved.rotation.to_array(),
                    })
                });
                let pose = iteration.pose.iter().map(|moved| {
                    json!({
                        "joint": name(moved.joint),
                        "rotation": moved.rotation.to_array(),
                        "translation": moved.translation.to_array(),
                    })
                });
                let distances: Vec<f64> = iteration
                    .residuals
                    .iter()
                    .map(|residual| residual.distance)
                    .collect();
                json!({
                    "distances": distances,
                    "updates": updates.collect::<Vec<_>>(),
                    "pose": pose.collect::<Vec<_>>(),
                })
            })
            .collect();
        let comma = if index + 1 < results.frames.len() {
            ","
        } else {
            ""
        };
        let object = json!({ "frame": frame.frame, "iterations": iterations });
        writeln!(out, "{object}{comma}")?;
    }
    writeln!(out, "]}}")
}

fn write_csv(
    skeleton: &Skeleton,
    task: &Task,
    results: &Results,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(
        out,
        "frame,iteration,step,joint,end,pivot_x,pivot_y,pivot_z,a_x,a_y,a_z,b_x,b_y,b_z,\
         axis_x,axis_y,axis_z,angle_deg,effector_x,effector_y,effector_z,distance"
    )?;
    for frame in &results.frames {
        let iterations = frame
            .report
            .trace
            .iter()
            .flat_map(|trace| &trace.iterations);
        for (iteration, record) in iterations.enumerate() {
            for (step, update) in record.updates.iter().enumerate() {
                let place = format!("{},{},{}", frame.frame, iteration + 1, step + 1);
                let joint = quoted(skeleton.unique_name(update.joint));
                let end = quoted(skeleton.unique_name(task.goals[update.target].end));
                writeln!(out, "{place},{joint},{end},{}", numbers(update))?;
            }
        }
    }
    Ok(())
}

fn numbers(update: &TraceUpdate) -> String {
    let vectors = [
        update.pivot_in_world,
        update.to_effector,
        update.to_target,
        update.axis_in_world,
    ];
    let mut cells: Vec<String> = vectors
        .iter()
        .flat_map(|vector| vector.to_array())
        .map(|number| number.to_string())
        .collect();
    cells.push(update.amount.to_degrees().to_string());
    cells.extend(
        update
            .effector_in_world
            .to_array()
            .map(|number| number.to_string()),
    );
    cells.push(update.distance.to_string());
    cells.join(",")
}

/// A name as a CSV cell.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
