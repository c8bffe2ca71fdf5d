//! Solves random reachable poses of a robot's tip and prints what was found, a JSON object a line, for
//! another program to check.
//!
//! `cargo run --release -p posekit-formats --example robot_poses -- arm.urdf TIP_LINK [COUNT]`, with `arm6` or
//! `arm7` for our own. `tools/check_robot_poses.py` does the checking.
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use std::f64::consts::PI;

use glam::DVec3;
use posekit::ik::IkTarget;
use posekit::ik::robot::{RobotConfig, RobotWorkspace, solve_robot};
use posekit_formats::urdf::{self, UpAxis};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which file?")?;
    let tip = arguments.next().ok_or("which tip link?")?;
    let count: usize = arguments.next().map_or(Ok(1000), |count| count.parse())?;
    let text = match urdf::sample::by_name(&file) {
        Some(text) => text.into(),
        None => std::fs::read(&file)?,
    };
    let document = urdf::read(&text)?.document;
    // The file's own world, which other programs use.
    let robot = document.to_robot(UpAxis::Z)?;
    let tip = document
        .joint_of_link(&tip)
        .ok_or("there is no such link")?;
    let ranges = robot.value_ranges();
    let ends: Vec<(f64, f64)> = ranges
        .iter()
        .map(|range| (range.lower.max(-PI), range.upper.min(PI)))
        .collect();
    let mut state = 1_u64;
    let mut share = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).unwrap_or(0)) / f64::from(u32::MAX)
    };
    let mut workspace = RobotWorkspace::new();
    for _ in 0..count {
        let goal: Vec<f64> = ends
            .iter()
            .map(|(low, high)| low + (high - low) * share())
            .collect();
        let goal = robot.global_frames(&goal)[tip.index()];
        let target = IkTarget::position(tip, goal.position).with_orientation(goal.orientation);
        let mut values: Vec<f64> = ends.iter().map(|(low, high)| 0.5 * (low + high)).collect();
        let config = RobotConfig::default();
        let report = solve_robot(&robot, &mut values, &[target], &config, &mut workspace);
        let named: Vec<String> = robot
            .moving_joints()
            .map(|joint| {
                let slots = &values[robot.values_of_joint(joint)];
                format!("\"{}\": {slots:?}", robot.skeleton().name(joint))
            })
            .collect();
        let DVec3 { x, y, z } = goal.position;
        println!(
            "{{\"solved\": {}, \"position\": [{x:?}, {y:?}, {z:?}], \"orientation\": {:?}, \"values\": {{{}}}}}",
            report.outcome.is_reached(),
            goal.orientation.to_array(),
            named.join(", ")
        );
    }
    Ok(())
}
