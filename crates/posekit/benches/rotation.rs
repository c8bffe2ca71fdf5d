//! What rotations cost: Euler rows to quaternions, many lanes at a time against one at a time, and the
//! interpolations against glam's.
//!
//! `cargo bench -p posekit --bench rotation [SECONDS]`

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;

use glam::{DQuat, Quat};
use harness::{Table, Unit, time_asked};
use posekit::rotation::{
    Axis, EulerOrder, log, nlerp_f32, quats_from_euler_rows_deg, slerp, slerp_f32,
};

/// Rotations per run: rows and results fit in 20 KiB, so memory is not what is measured.
const COUNT: usize = 512;

/// Names of orders: usual, opposite parity, proper, incomplete.
const ORDERS: [&str; 5] = ["ZXY", "ZYX", "ZXZ", "ZX", "X"];

fn main() {
    euler_rows();
    interpolations();
}

fn euler_rows() {
    let rows = rows_deg(3);
    let mut one_by_one = vec![Quat::IDENTITY; COUNT];
    let orientations = orientations(&rows);
    let mut table = Table::new("Euler angles", Unit::NanosecondsPer("rotation"));
    table.reference("ZXY rows, one by one in f64", COUNT, || {
        for (row, rotation) in black_box(&rows).chunks_exact(3).zip(&mut one_by_one) {
            let angles = [row[0], row[1], row[2]].map(f64::to_radians);
            *rotation = EulerOrder::ZXY.to_quat(angles).as_quat();
        }
        black_box(one_by_one.as_ptr());
    });
    for order in ORDERS {
        let order: EulerOrder = order.parse().expect("an order");
        let axes: Vec<Axis> = order.axes().to_vec();
        let rows = rows_deg(axes.len());
        let mut rotations = vec![Quat::IDENTITY; COUNT];
        table.job(format!("{order} rows in lanes"), COUNT, move || {
            quats_from_euler_rows_deg(&axes, black_box(&rows), &mut rotations);
            black_box(rotations.as_ptr());
        });
    }
    table.job("ZXY angles of a quaternion", COUNT, || {
        for &q in black_box(&orientations) {
            black_box(EulerOrder::ZXY.from_quat(q));
        }
    });
    table.job("rotation vector of a quaternion", COUNT, || {
        for &q in black_box(&orientations) {
            black_box(log(q));
        }
    });
    table.measure(time_asked());
}

fn interpolations() {
    let rows = rows_deg(3);
    let far = orientations(&rows);
    let small: Vec<f64> = rows.iter().map(|angle| angle * 0.1).collect();
    let near = orientations(&small);
    for (what, orientations) in [("a few degrees", near), ("up to half a turn", far)] {
        let single: Vec<Quat> = orientations.iter().map(|q| q.as_quat()).collect();
        let title = format!("between orientations {what} apart");
        let mut table = Table::new(title, Unit::NanosecondsPer("rotation"));
        table.reference("glam's slerp, f32", COUNT - 1, || {
            neighbours(&single, Quat::slerp);
        });
        table.job("slerp_f32", COUNT - 1, || neighbours(&single, slerp_f32));
        table.job("nlerp_f32", COUNT - 1, || neighbours(&single, nlerp_f32));
        table.job("slerp, f64", COUNT - 1, || {
            for pair in black_box(&orientations).windows(2) {
                black_box(slerp(pair[0], pair[1], 0.3));
            }
        });
        table.measure(time_asked());
    }
}

fn neighbours(orientations: &[Quat], interpolate: impl Fn(Quat, Quat, f32) -> Quat) {
    for pair in black_box(orientations).windows(2) {
        black_box(interpolate(pair[0], pair[1], 0.3));
    }
}

/// Angles as motion has them: within one turn, unordered enough that no branch can learn them.
fn rows_deg(width: usize) -> Vec<f64> {
    (0..COUNT * width)
        .map(|i| ((i * 7919) % 3600) as f64 / 10.0 - 180.0)
        .collect()
}

fn orientations(rows: &[f64]) -> Vec<DQuat> {
    rows.chunks_exact(3)
        .map(|row| EulerOrder::ZXY.to_quat([row[0], row[1], row[2]].map(f64::to_radians)))
        .collect()
}
