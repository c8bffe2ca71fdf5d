//! A method's way from one orientation to another, step by step.

use glam::DQuat;

use super::between::{Between, Blend, Ends};
use super::method::Method;
use crate::rotation::angle_between;

/// One step of a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStep {
    /// The share of the way, 0 to 1.
    pub t: f64,
    /// What the method makes there.
    pub blend: Blend,
    /// The rotation nearest to it.
    pub rotation: DQuat,
    /// How far that is from slerp, in degrees.
    pub deviation_deg: f64,
    /// How fast it turns there, in degrees for the whole way: slerp's is the angle between the ends all
    /// along.
    pub speed_deg: f64,
}

/// The way of a method in so many equal steps, both ends included.
pub fn path(method: Method, ends: &Ends, steps: usize) -> Vec<PathStep> {
    /// Half the span over which a speed is measured.
    const NEAR: f64 = 1e-4;
    let way = Between::new(method, ends);
    let slerp = Between::new(Method::Slerp, ends);
    let count = u32::try_from(steps).unwrap_or(u32::MAX).max(1);
    let at = |step: u32| {
        let t = f64::from(step) / f64::from(count);
        // At the ends the speed is that of the part inside, which is what is seen.
        let [from, to] = [(t - NEAR).max(0.0), (t + NEAR).min(1.0)];
        let turned = angle_between(way.rotation_at(from), way.rotation_at(to));
        let rotation = way.rotation_at(t);
        PathStep {
            t,
            blend: way.at(t),
            rotation,
            deviation_deg: angle_between(rotation, slerp.rotation_at(t)).to_degrees(),
            speed_deg: turned.to_degrees() / (to - from),
        }
    };
    (0..=count).map(at).collect()
}
