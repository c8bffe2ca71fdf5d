//! What lies beside the report: all runs as CSV, and the poses of the targets that have names as BVH.

use std::fmt::Write;

use posekit::pose::LocalPose;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{self, Bvh};

use super::experiment::{Cell, Results, Run, pose_of};
use super::setup::{Study, motion_of};
use super::targets::Kind;

/// The cells whose poses are written: all of the named targets.
fn posed_cells<'a>(study: &'a Study, results: &'a Results) -> impl Iterator<Item = Cell> + 'a {
    let cells = results.all().iter().map(|run| run.cell);
    cells.filter(|cell| study.targets[cell.chain][cell.target].kind == Kind::Named)
}

/// One line for every run.
pub(super) fn csv(study: &Study, results: &Results) -> String {
    let mut out = "chain,target,kind,x,y,z,reach,beyond_reach,tolerance,solver,iterations,iterations_made,residual,\
                   reached,as_near_as_can_be,joint_motion_deg,iterations_to_tolerance,joint_motion_to_tolerance_deg,pose_frame"
        .to_owned();
    out.push_str(if study.has_times {
        ",time_us,time_to_tolerance_us\n"
    } else {
        "\n"
    });
    let mut frame = 0;
    for run in results.all() {
        push_line(&mut out, study, results, run, &mut frame);
    }
    out
}

fn push_line(out: &mut String, study: &Study, results: &Results, run: &Run, frame: &mut usize) {
    let cell = run.cell;
    let chain = &study.chains[cell.chain];
    let target = &study.targets[cell.chain][cell.target];
    let pose_frame = if target.kind == Kind::Named {
        *frame += 1;
        (*frame - 1).to_string()
    } else {
        String::new()
    };
    let arrival = results.arrival(cell.chain, cell.target, cell.method);
    let (arrival_iterations, arrival_deg) = match arrival.iterations {
        Some(count) => (
            count.to_string(),
            format!("{:.4}", arrival.motion_rad.to_degrees()),
        ),
        None => (String::new(), String::new()),
    };
    let is_near = run.miss <= chain.tolerance;
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "{},{},{},{},{},{},{},{},{},{},{},{},{:e},{},{},{:.4},{arrival_iterations},{arrival_deg},{pose_frame}",
        field(&chain.name),
        field(&target.name),
        target.kind.name(),
        target.place.x,
        target.place.y,
        target.place.z,
        chain.reach,
        target.beyond,
        chain.tolerance,
        study.methods[cell.method].option(),
        study.counts[cell.count],
        run.iterations,
        run.residual,
        u8::from(is_near && !target.is_out_of_reach()),
        u8::from(is_near),
        run.motion_rad.to_degrees(),
    );
    if study.has_times {
        let secs = arrival.iterations.map(|_| arrival.secs * 1e6);
        let secs = secs.map_or_else(String::new, |micros| format!("{micros:.2}"));
        let _ = write!(out, ",{:.2},{secs}", run.secs * 1e6);
    }
    out.push('\n');
}

/// A name as RFC 4180 has it.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// The poses, a frame each, in the order of the CSV's `pose_frame`.
pub(super) fn poses(study: &Study, results: &Results) -> Vec<u8> {
    let poses: Vec<LocalPose> = posed_cells(study, results)
        .map(|cell| pose_of(study, cell))
        .collect();
    let motion = motion_of(&study.skeleton, &poses);
    bvh::write(&Bvh::from_motion(&motion, EulerOrder::ZXY))
}
