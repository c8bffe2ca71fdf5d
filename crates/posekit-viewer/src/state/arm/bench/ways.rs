//! The ways in which the arm can reach its target: finding them all, and standing as one of them.

use posekit::ik::robot::{Ways, WaysConfig, ways_to};

use super::{Bench, SAME, Target};

impl Bench {
    /// The ways to the target, once they were looked for.
    #[must_use]
    pub fn ways(&self) -> Option<&Ways> {
        self.ways.as_ref()
    }

    /// Which of the ways the joints stand as.
    #[must_use]
    pub fn way_taken(&self) -> Option<usize> {
        let is_here = |way: &Vec<f64>| {
            let pairs = way.iter().zip(&self.values);
            pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) <= SAME
        };
        self.ways.as_ref()?.ways.iter().position(is_here)
    }

    /// Finds all ways to the target, or to where the tip is, where that was not done yet.
    pub fn find_ways(&mut self) {
        self.cancel_drag();
        if self.ways.is_some() {
            return;
        }
        let target = self.asked_target();
        let config = WaysConfig {
            robot: self.config(1),
            ..WaysConfig::default()
        };
        let wanted = self.wanted(target);
        let ways = ways_to(&self.robot.mechanism, &self.values, &wanted, &config);
        self.target = Some(target);
        self.ways = Some(ways);
    }

    /// Takes the next of all ways to the target, or to where the tip is. False where there is no other.
    pub fn take_next_way(&mut self) -> bool {
        self.find_ways();
        let count = self.ways.as_ref().map_or(0, |ways| ways.ways.len());
        let next = match self.way_taken() {
            Some(taken) => (taken + 1) % count.max(1),
            None => 0,
        };
        self.take_way(next)
    }

    /// Stands the joints as one of the ways has them. False where they do already, or there is no such way.
    pub fn take_way(&mut self, index: usize) -> bool {
        let way = self.ways.as_ref().and_then(|ways| ways.ways.get(index));
        let Some(mut values) = way.cloned().filter(|_| self.way_taken() != Some(index)) else {
            return false;
        };
        self.begin_step();
        let config = self.config(1);
        let target = self.asked_target();
        // It is there already: this is for the report.
        let report = self.solve(&mut values, target, &config);
        self.values = values;
        self.target = Some(target);
        self.report = Some(report);
        self.find_frames();
        true
    }

    /// The target, or where the tip is.
    fn asked_target(&self) -> Target {
        let frame = self.tip_frame();
        self.target.unwrap_or(Target {
            position: frame.position,
            orientation: self.tool.turns().then_some(frame.orientation),
        })
    }

    /// Stands the planar arm so.
    pub fn take_elbow(&mut self, angles: [f64; 2]) {
        let Some(indices) = self.planar().map(|arm| arm.values) else {
            return;
        };
        let target = self.target;
        let mut values = self.values.clone();
        for (index, angle) in indices.into_iter().zip(angles) {
            values[index] = angle;
        }
        self.set_values(&values);
        self.target = target;
    }
}
