//! Several methods on one motion: what the table and the report show.

use std::io::Write;

use posekit::inbetween::{FillError, FillMethod, FillPlan};
use posekit::motion::Motion;

use crate::console;
use crate::failure::{Failure, one_line};
use crate::text::{Align, Table, counted, fixed};

/// What each method makes of the frames that were not kept.
pub(super) struct Comparison {
    /// What the input is called.
    pub(super) name: String,
    /// How many frames the motion has.
    pub(super) frame_count: usize,
    /// The kept frames.
    pub(super) kept: Vec<usize>,
    /// The frames that were filled in and compared.
    pub(super) filled: Vec<usize>,
    /// The joints' names, as the errors list the joints.
    pub(super) joints: Vec<String>,
    /// The skeleton's height, in the file's unit.
    pub(super) height: f64,
    /// The methods with their errors.
    pub(super) methods: Vec<(FillMethod, FillError)>,
}

impl Comparison {
    pub(super) fn new(
        motion: &Motion,
        plan: &FillPlan,
        methods: &[FillMethod],
        name: String,
        fill: impl Fn(FillMethod) -> Motion,
    ) -> Self {
        let filled = plan.filled();
        let skeleton = motion.skeleton();
        let joints = motion.rotated_joints().iter();
        Self {
            name,
            frame_count: motion.frame_count(),
            kept: plan.kept().to_vec(),
            joints: joints
                .map(|&joint| skeleton.unique_name(joint).to_owned())
                .collect(),
            height: f64::from(skeleton.height()),
            methods: methods
                .iter()
                .map(|&method| (method, FillError::between(motion, &fill(method), &filled)))
                .collect(),
            filled,
        }
    }

    /// What was kept and compared, in words.
    pub(super) fn summary(&self) -> String {
        format!(
            "{} of {} kept, {} filled in and compared",
            self.kept.len(),
            counted(self.frame_count, "frame"),
            self.filled.len(),
        )
    }

    /// The heading and the cells of the table of methods.
    pub(super) fn table(&self) -> (Vec<&'static str>, Vec<Vec<String>>) {
        let heads = vec![
            "method",
            "mean deg",
            "most deg",
            "at",
            "frame",
            "mean % of height",
            "most % of height",
        ];
        let percent = |distance: f64| {
            let height = if self.height > 0.0 { self.height } else { 1.0 };
            fixed(100.0 * distance / height, 3)
        };
        let rows = self.methods.iter().map(|(method, error)| {
            let worst = error.worst().and_then(|worst| {
                let mut joints = error.joints.iter().zip(&self.joints);
                joints.find(|(joint, _)| joint.joint == worst.joint)
            });
            vec![
                method.to_string(),
                fixed(error.mean_deg, 3),
                fixed(error.max_deg, 2),
                worst.map_or(String::new(), |(_, name)| name.clone()),
                worst.map_or(String::new(), |(joint, _)| joint.worst_frame.to_string()),
                percent(error.mean_distance),
                percent(error.max_distance),
            ]
        });
        (heads, rows.collect())
    }

    /// Prints the table of methods.
    pub(super) fn print(&self) -> Result<(), Failure> {
        let mut out = console::stdout();
        writeln!(out, "{}: {}", one_line(&self.name), self.summary())?;
        let (heads, rows) = self.table();
        let columns: Vec<(&str, Align)> = heads
            .into_iter()
            .enumerate()
            .map(|(at, head)| {
                (
                    head,
                    if matches!(at, 0 | 3) {
                        Align::Left
                    } else {
                        Align::Right
                    },
                )
            })
            .collect();
        let mut table = Table::new(&columns);
        rows.into_iter().for_each(|row| table.row(row));
        table.write(&mut out)?;
        Ok(out.flush()?)
    }
}
