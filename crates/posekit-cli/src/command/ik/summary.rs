//! What came of it, for people and for programs.

use std::io::{self, Write};

use posekit::ik::{IkOutcome, IkReport};
use serde_json::{Value, json};

use super::figure::Figure;
use super::steps::{FrameResult, Results, Task};
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::text::{Align, Table, counted, fixed, trimmed};

/// One outcome as one word, for counts and for programs.
fn word(outcome: IkOutcome) -> &'static str {
    match outcome {
        IkOutcome::Reached => "reached",
        IkOutcome::OutOfReach { .. } => "out of reach",
        IkOutcome::IterationLimit => "iteration limit",
        IkOutcome::LimitsInTheWay => "limits in the way",
        IkOutcome::Stalled => "stalled",
        IkOutcome::InvalidTarget { .. } => "invalid target",
        _ => "other",
    }
}

/// A residual with four digits, or as it is counted where it is small.
fn small(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.abs() < 0.1 {
        format!("{value:.3e}")
    } else {
        format!("{value:.4}")
    }
}

fn solver_word(task: &Task) -> String {
    clap::ValueEnum::to_possible_value(&task.solver_name)
        .map_or_else(String::new, |value| value.get_name().to_owned())
}

/// Writes the summary for people.
pub(super) fn write(
    name: &str,
    figure: &Figure,
    task: &Task,
    results: &Results,
    out: &mut dyn Write,
) -> io::Result<()> {
    let frames = counted(results.frames.len(), "frame");
    let targets = counted(task.goals.len(), "target");
    let solver = solver_word(task);
    let heading = styled(HEADING, &one_line(name));
    writeln!(out, "{heading}  {targets}, {frames}, {solver}")?;
    writeln!(out, "{}", outcomes(results))?;
    writeln!(out)?;
    target_table(figure, task, results).write(out)?;
    let limited = at_limit(figure, results);
    if !limited.is_empty() {
        writeln!(out)?;
        writeln!(
            out,
            "{} {}",
            styled(DIM, "at their limits"),
            limited.join(", ")
        )?;
    }
    writeln!(out)?;
    writeln!(out, "{}", motion_line(figure, results))?;
    writeln!(
        out,
        "{}",
        styled(
            DIM,
            "distances in the file's unit, from effector to target; angles in degrees"
        )
    )
}

/// How many frames came out how, and the iterations they took.
fn outcomes(results: &Results) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for frame in &results.frames {
        let word = word(frame.report.outcome);
        match counts.iter_mut().find(|(known, _)| *known == word) {
            Some((_, count)) => *count += 1,
            None => counts.push((word, 1)),
        }
    }
    let beyond = results
        .frames
        .iter()
        .filter_map(|frame| match frame.report.outcome {
            IkOutcome::OutOfReach { by } => Some(by),
            _ => None,
        })
        .fold(0.0, f64::max);
    let parts = counts.iter().map(|&(word, count)| {
        let frames = if results.frames.len() == 1 {
            String::new()
        } else {
            format!(" in {}", counted(count, "frame"))
        };
        let by = if word == "out of reach" {
            format!(" by up to {}", small(beyond))
        } else {
            String::new()
        };
        format!("{word}{frames}{by}")
    });
    let parts: Vec<String> = parts.collect();
    let iterations: Vec<u32> = results.frames.iter().map(|f| f.report.iterations).collect();
    let (least, most) = (iterations.iter().min(), iterations.iter().max());
    let iterations = match (least, most) {
        (Some(least), Some(most)) if least == most => {
            counted(usize::try_from(*most).unwrap_or(0), "iteration")
        }
        (Some(least), Some(most)) => format!("{least} to {most} iterations"),
        _ => String::new(),
    };
    format!("{}; {iterations}", parts.join(", "))
}

fn target_table(figure: &Figure, task: &Task, results: &Results) -> Table {
    let has_orientation = task.goals.iter().any(|goal| goal.orientation.is_some());
    let mut columns = vec![
        ("target", Align::Left),
        ("median miss", Align::Right),
        ("largest", Align::Right),
        ("in frame", Align::Right),
    ];
    if has_orientation {
        columns.push(("largest turn missed", Align::Right));
    }
    let mut table = Table::new(&columns);
    for (index, goal) in task.goals.iter().enumerate() {
        let mut misses: Vec<(f64, usize)> = results
            .frames
            .iter()
            .filter_map(|frame| Some((frame.report.residuals.get(index)?.distance, frame.frame)))
            .collect();
        misses.sort_by(|a, b| a.0.total_cmp(&b.0));
        let median = misses.get(misses.len() / 2).map_or(0.0, |miss| miss.0);
        let (largest, frame) = misses.last().copied().unwrap_or_default();
        let mut row = vec![
            one_line(figure.skeleton.unique_name(goal.end)),
            small(median),
            small(largest),
            frame.to_string(),
        ];
        if has_orientation {
            let angle = results
                .frames
                .iter()
                .filter_map(|frame| Some(frame.report.residuals.get(index)?.angle_rad))
                .fold(0.0, f64::max);
            row.push(if goal.orientation.is_some() {
                fixed(angle.to_degrees(), 3)
            } else {
                "-".to_owned()
            });
        }
        table.row(row);
    }
    table
}

/// The joints that were at a limit in some frame, in the skeleton's order.
fn at_limit(figure: &Figure, results: &Results) -> Vec<String> {
    let skeleton = &figure.skeleton;
    let frames_of = |joint| {
        let is_at = |frame: &&FrameResult| frame.report.joints_at_limit.contains(&joint);
        results.frames.iter().filter(is_at).count()
    };
    skeleton
        .joints()
        .map(|joint| (joint, frames_of(joint)))
        .filter(|&(_, count)| count > 0)
        .map(|(joint, count)| {
            let name = one_line(skeleton.unique_name(joint));
            if results.frames.len() == 1 {
                name
            } else {
                format!("{name} ({})", counted(count, "frame"))
            }
        })
        .collect()
}

/// How far joints were turned, and how smoothly.
fn motion_line(figure: &Figure, results: &Results) -> String {
    let turns = results.frames.iter().filter_map(|frame| frame.largest_turn);
    let most = turns.reduce(|most, next| if next.1 > most.1 { next } else { most });
    let most = most.map_or_else(
        || "no joint turned".to_owned(),
        |(joint, angle_rad)| {
            let name = one_line(figure.skeleton.unique_name(joint));
            format!(
                "{name} turned most, by {}",
                trimmed(angle_rad.to_degrees(), 2)
            )
        },
    );
    match results.largest_step_rad {
        Some([now, before]) => format!(
            "{most}; from frame to frame joints turn by up to {}, {} before",
            trimmed(now.to_degrees(), 2),
            trimmed(before.to_degrees(), 2)
        ),
        None => most,
    }
}

/// The summary for programs: one JSON object.
pub(super) fn json(name: &str, figure: &Figure, task: &Task, results: &Results) -> Value {
    let skeleton = &figure.skeleton;
    let frames: Vec<Value> = results
        .frames
        .iter()
        .map(|frame| frame_json(figure, frame))
        .collect();
    let largest = |value: fn(&IkReport) -> f64| {
        let values = results.frames.iter().map(|frame| value(&frame.report));
        values.fold(0.0, f64::max)
    };
    let ends: Vec<&str> = task
        .goals
        .iter()
        .map(|goal| skeleton.unique_name(goal.end))
        .collect();
    json!({
        "file": name,
        "solver": solver_word(task),
        "ends": ends,
        "reached": results.frames.iter().all(|frame| frame.report.outcome.is_reached()),
        "worst": {
            "distance": largest(IkReport::largest_distance),
            "angle": largest(IkReport::largest_angle_rad).to_degrees(),
        },
        "largest_step": results.largest_step_rad.map(|[now, before]| json!({
            "now": now.to_degrees(),
            "before": before.to_degrees(),
        })),
        "values_changed": figure.changed_count(),
        "frames": frames,
    })
}

fn frame_json(figure: &Figure, frame: &FrameResult) -> Value {
    let targets = frame.targets.iter().zip(&frame.report.residuals);
    let targets: Vec<Value> = targets
        .map(|(target, residual)| {
            json!({
                "target": target.position_in_world.to_array(),
                "distance": residual.distance,
                "angle": target.orientation_in_world.map(|_| residual.angle_rad.to_degrees()),
            })
        })
        .collect();
    let at_limit = frame.report.joints_at_limit.iter();
    let at_limit: Vec<&str> = at_limit
        .map(|&joint| figure.skeleton.unique_name(joint))
        .collect();
    json!({
        "frame": frame.frame,
        "outcome": word(frame.report.outcome),
        "out_of_reach_by": match frame.report.outcome {
            IkOutcome::OutOfReach { by } => Some(by),
            _ => None,
        },
        "iterations": frame.report.iterations,
        "targets": targets,
        "joints_at_limit": at_limit,
    })
}
