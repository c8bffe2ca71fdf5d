//! What forward kinematics found, for people.

use std::io::{self, Write};

use glam::Vec3;
use posekit_formats::arrays::MotionArrays;

use super::statistics::JointTravel;
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::inputs::Inputs;
use crate::text::{self, Align, Table, counted, decimals_for, fixed, trimmed};

/// The numbers of one input, small enough to wait in line.
#[derive(Debug)]
pub(super) struct Summary {
    name: String,
    joints: Vec<(String, JointTravel)>,
    points: Vec<(String, Vec3, Vec3)>,
    frame_count: usize,
    frame_time_secs: f64,
    duration_secs: f64,
}

impl Summary {
    /// Goes over the selected joints and frames.
    pub(super) fn of(arrays: &MotionArrays<'_>, name: String) -> Self {
        let names = arrays.joint_names();
        let joints = arrays
            .joints
            .iter()
            .zip(names)
            .map(|(&joint, name)| (one_line(name), JointTravel::of(arrays, joint)));
        let ends = arrays.frames.first().zip(arrays.frames.last());
        let points = arrays.points.iter().map(|point| {
            let place = |frame: usize| {
                arrays
                    .motion
                    .transform_point(frame, point.joint, point.point_in_joint)
            };
            let Vec3 { x, y, z } = point.point_in_joint;
            let carrier = arrays.motion.skeleton().unique_name(point.joint);
            let name = format!("{} at {x}, {y}, {z}", one_line(carrier));
            let (first, last) = ends.map_or((Vec3::ZERO, Vec3::ZERO), |(&first, &last)| {
                (place(first), place(last))
            });
            (name, first, last)
        });
        let numbers = arrays.numbers().first().zip(arrays.numbers().last());
        let duration_secs = numbers.map_or(0.0, |(&first, &last)| {
            arrays.time_secs(last) - arrays.time_secs(first)
        });
        Self {
            name,
            joints: joints.collect(),
            points: points.collect(),
            frame_count: arrays.frames.len(),
            frame_time_secs: arrays.motion.frame_time_secs(),
            duration_secs: duration_secs.abs(),
        }
    }

    /// Writes a heading, the bounds and a row for every joint.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let (low, high) = self.bounds();
        let decimals = decimals_for(f64::from((high - low).max_element()));
        let rate = if self.frame_time_secs > 0.0 {
            format!(
                " at {} fps, {}",
                trimmed(1.0 / self.frame_time_secs, 2),
                text::duration(self.duration_secs)
            )
        } else {
            String::new()
        };
        let frames = counted(self.frame_count, "frame");
        let joints = counted(self.joints.len(), "joint");
        writeln!(
            out,
            "{}  {joints}, {frames}{rate}",
            styled(HEADING, &one_line(&self.name))
        )?;
        let range = |axis: usize| {
            let ends = (f64::from(low[axis]), f64::from(high[axis]));
            format!("{} to {}", fixed(ends.0, decimals), fixed(ends.1, decimals))
        };
        let (x, y, z) = (range(0), range(1), range(2));
        writeln!(out, "{} x {x}, y {y}, z {z}", styled(DIM, "bounds"))?;
        writeln!(out)?;
        self.joint_table(decimals).write(out)?;
        if !self.points.is_empty() {
            writeln!(out)?;
            self.point_table(decimals).write(out)?;
        }
        writeln!(out)?;
        writeln!(
            out,
            "{}",
            styled(
                DIM,
                "lengths in the file's unit, speeds in that unit per second, Y up; -o FILE.npz writes everything"
            )
        )
    }

    fn joint_table(&self, decimals: usize) -> Table {
        let mut table = Table::new(&[
            ("joint", Align::Left),
            ("first x", Align::Right),
            ("y", Align::Right),
            ("z", Align::Right),
            ("last x", Align::Right),
            ("y", Align::Right),
            ("z", Align::Right),
            ("lowest y", Align::Right),
            ("highest y", Align::Right),
            ("path", Align::Right),
            ("top speed", Align::Right),
        ]);
        for (name, travel) in &self.joints {
            let mut cells = vec![name.clone()];
            cells.extend(coordinates(travel.first, decimals));
            cells.extend(coordinates(travel.last, decimals));
            cells.push(fixed(f64::from(travel.low.y), decimals));
            cells.push(fixed(f64::from(travel.high.y), decimals));
            cells.push(fixed(travel.path_length, decimals));
            cells.push(speed(travel.top_speed, decimals));
            table.row(cells);
        }
        table
    }

    fn point_table(&self, decimals: usize) -> Table {
        let mut table = Table::new(&[
            ("point", Align::Left),
            ("first x", Align::Right),
            ("y", Align::Right),
            ("z", Align::Right),
            ("last x", Align::Right),
            ("y", Align::Right),
            ("z", Align::Right),
        ]);
        for (name, first, last) in &self.points {
            let mut cells = vec![name.clone()];
            cells.extend(coordinates(*first, decimals));
            cells.extend(coordinates(*last, decimals));
            table.row(cells);
        }
        table
    }

    fn bounds(&self) -> (Vec3, Vec3) {
        let travels = self
            .joints
            .iter()
            .map(|(_, travel)| (travel.low, travel.high));
        travels
            .reduce(|(low, high), (l, h)| (low.min(l), high.max(h)))
            .unwrap_or((Vec3::ZERO, Vec3::ZERO))
    }

    /// The way of the first joint that moves: the root, or the hips below a root that stands still.
    fn body_path(&self) -> f64 {
        let mut paths = self.joints.iter().map(|(_, travel)| travel.path_length);
        paths.find(|&path| path > 0.0).unwrap_or(0.0)
    }

    /// The fastest joint and its speed.
    fn fastest(&self) -> Option<(&str, f64)> {
        let speeds = self
            .joints
            .iter()
            .filter_map(|(name, travel)| Some((name.as_str(), travel.top_speed?)));
        speeds.reduce(|best, next| if next.1 > best.1 { next } else { best })
    }
}

fn coordinates(place: Vec3, decimals: usize) -> [String; 3] {
    place
        .to_array()
        .map(|value| fixed(f64::from(value), decimals))
}

fn speed(speed: Option<f64>, decimals: usize) -> String {
    speed.map_or_else(|| "-".to_owned(), |speed| fixed(speed, decimals))
}

/// One row a file, for sets of files. The rows are written as they come, so the widths are settled
/// before the first.
#[derive(Debug)]
pub(super) struct FileTable {
    name_width: usize,
    has_heading: bool,
}

/// Names beyond this push their row to the right rather than everybody's.
const WIDEST_NAME: usize = 60;

impl FileTable {
    /// A table wide enough for the names of these inputs.
    pub(super) fn new(inputs: &Inputs) -> Self {
        let widths = inputs.list.iter().map(|input| text::width(&input.name()));
        let name_width = widths.max().unwrap_or(0).clamp(4, WIDEST_NAME);
        Self {
            name_width,
            has_heading: false,
        }
    }

    /// Writes a file's row.
    pub(super) fn write(&mut self, summary: &Summary, out: &mut dyn Write) -> io::Result<()> {
        if !self.has_heading {
            let titles = [
                "joints",
                "frames",
                "seconds",
                "height",
                "body path",
                "top speed",
            ];
            let [joints, frames, secs, height, path, top] = titles;
            let line = format!(
                "{:<width$}  {joints:>6}  {frames:>7}  {secs:>8}  {height:>9}  {path:>10}  {top:>10}  fastest joint",
                "file",
                width = self.name_width
            );
            writeln!(out, "{}", styled(DIM, &line))?;
            self.has_heading = true;
        }
        let (low, high) = summary.bounds();
        let decimals = decimals_for(f64::from((high - low).max_element()));
        let body_path = summary.body_path();
        let (fastest, top) = match summary.fastest() {
            Some((name, top)) => (name, fixed(top, decimals)),
            None => ("-", "-".to_owned()),
        };
        writeln!(
            out,
            "{:<width$}  {:>6}  {:>7}  {:>8}  {:>9}  {:>10}  {:>10}  {fastest}",
            one_line(&summary.name),
            summary.joints.len(),
            summary.frame_count,
            fixed(summary.duration_secs, 2),
            fixed(f64::from(high.y - low.y), decimals),
            fixed(body_path, decimals),
            top,
            width = self.name_width
        )
    }
}
