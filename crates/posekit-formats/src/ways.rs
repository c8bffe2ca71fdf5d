//! Ways between two orientations as comma-separated values, for spreadsheets and data frames.
//!
//! One row for each method and step: the quaternion of the (nearest) rotation, how far it is from slerp and
//! how fast it turns in degrees, the determinant and the shear of what the method makes, and its nine
//! elements row by row. Numbers are the shortest that read back the same; lines end in a line feed.

use std::fmt::Write as _;

use posekit::inbetween::{Ends, Method, path};

/// The methods between two orientations, in so many equal steps.
#[must_use]
pub fn csv(ends: &Ends, methods: &[Method], steps: usize) -> String {
    let mut text = String::from(
        "method,t,x,y,z,w,deviation_deg,speed_deg,determinant,shear_deg,\
         m00,m01,m02,m10,m11,m12,m20,m21,m22\n",
    );
    for &method in methods {
        for step in path(method, ends, steps) {
            let numbers = step.rotation.to_array();
            let measures = [
                step.deviation_deg,
                step.speed_deg,
                step.blend.determinant(),
                step.blend.shear_deg(),
            ];
            let matrix = step.blend.matrix.transpose().to_cols_array();
            let numbers = numbers.iter().chain(&measures).chain(&matrix);
            let cells: Vec<String> = numbers.map(ToString::to_string).collect();
            // Writing to a string does not fail.
            let _ = writeln!(text, "{method},{},{}", step.t, cells.join(","));
        }
    }
    text
}
