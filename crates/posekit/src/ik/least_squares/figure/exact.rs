//! Ball joints with limits, in coordinates whose bounds the limits are.
//!
//! A ball joint that is turned back into its limits after every step knows of one direction that is refused. Where
//! several limits hold at once, as in a corner of Euler ranges, it would come to rest before its time. Here a joint
//! with Euler ranges goes through its angles, and one with a cone through the rotation vector of its swing (outward
//! and around) and its twist: every limit is a bound of one degree of freedom. Near gimbal lock angles make large
//! turns of small ones, which is why this is not the first way.

use core::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::{Figure, bounded_degree, is_bounded};
use crate::ik::least_squares::{Degree, System};
use crate::ik::limit::{JointLimit, clamp_angle};
use crate::ik::turn::perpendicular;
use crate::rotation::{compose_elementary, exp, log, swing_twist};

/// A swing of less than this has no direction.
const STRAIGHT_RAD: f64 = 1e-9;

/// A swing as its size, its direction, and the direction around: both across the cone's axis.
struct Swing {
    size_rad: f64,
    outward: DVec3,
    around: DVec3,
}

impl Swing {
    fn new(axis: DVec3, values: [f64; 3]) -> Self {
        let vector = swing_vector(axis, values);
        let size_rad = vector.length();
        let outward = if size_rad > STRAIGHT_RAD {
            vector / size_rad
        } else {
            perpendicular(axis)
        };
        Self {
            size_rad,
            outward,
            around: axis.cross(outward),
        }
    }
}

fn swing_vector(axis: DVec3, [first, second, _]: [f64; 3]) -> DVec3 {
    let side = perpendicular(axis);
    side * first + axis.cross(side) * second
}

impl Figure<'_> {
    /// From here on limits of ball joints are bounds of coordinates.
    pub(in crate::ik::least_squares) fn be_exact(&mut self) {
        self.memory.is_exact = true;
        self.begin_anew();
    }

    /// Reads the coordinates of all joints with limits from the linkage.
    pub(super) fn measure(&mut self) {
        for k in 0..self.linkage.pivots.len() {
            let limit = self.linkage.pivots[k].limit;
            let values = &mut self.memory.values[k];
            match limit {
                JointLimit::Hinge { axis, angle_rad } => {
                    let twist = swing_twist(self.linkage.motion(k), axis).twist_angle_rad;
                    values[0] = clamp_angle(twist, angle_rad);
                }
                JointLimit::Euler { order, angles_rad } if self.memory.is_exact => {
                    let motion = self.linkage.motion(k);
                    *values = JointLimit::euler_angles(motion, order, &angles_rad);
                }
                JointLimit::Cone {
                    axis, twist_rad, ..
                } if self.memory.is_exact => {
                    let parts = swing_twist(self.linkage.motion(k), axis);
                    let vector = log(parts.swing);
                    let side = perpendicular(axis);
                    *values = [
                        vector.dot(side),
                        vector.dot(axis.cross(side)),
                        clamp_angle(parts.twist_angle_rad, twist_rad),
                    ];
                }
                _ => {}
            }
        }
    }

    /// Adds the coordinates of a ball joint with limits; `false` for other joints.
    pub(super) fn push_exact(&mut self, system: &mut System, k: usize, wish: DVec3) -> bool {
        let pivot = &self.linkage.pivots[k];
        let (limit, give) = (pivot.limit, pivot.give);
        let values = self.memory.values[k];
        match limit {
            JointLimit::Euler { order, angles_rad } => {
                let motion = order.to_quat(values);
                let mut before = DQuat::IDENTITY;
                for (index, &axis) in order.axes().iter().enumerate() {
                    let turned = self.in_world(k, before * axis.unit(), motion);
                    let mut degree = Degree::free(give);
                    if is_bounded(angles_rad[index]) {
                        degree = bounded_degree(give, angles_rad[index], values[index]);
                    }
                    degree.wish = wish.dot(turned) * give;
                    self.push_turn(system, k, turned, degree);
                    before *= compose_elementary([(axis, values[index])]);
                }
            }
            JointLimit::Cone {
                axis,
                swing_max_rad,
                twist_rad,
            } => {
                let swing = Swing::new(axis, values);
                let rotation = exp(swing.outward * swing.size_rad);
                let motion = rotation * exp(axis * values[2]);
                // The derivative of the exponential map: along the vector it is 1.
                let size = swing.size_rad;
                let (along, aside) = if size > STRAIGHT_RAD {
                    (libm::sin(size) / size, (1.0 - libm::cos(size)) / size)
                } else {
                    (1.0, 0.0)
                };
                let mut twist = Degree::free(give);
                if is_bounded(twist_rad) {
                    twist = bounded_degree(give, twist_rad, values[2]);
                }
                let outward = Degree {
                    lower: -(swing_max_rad + size),
                    upper: (swing_max_rad - size).max(0.0),
                    ..Degree::free(give)
                };
                let around = swing.around * along + axis * aside;
                for (turned, mut degree) in [
                    (swing.outward, outward),
                    (around, Degree::free(give)),
                    (rotation * axis, twist),
                ] {
                    let turned = self.in_world(k, turned, motion);
                    degree.wish = wish.dot(turned) * give;
                    self.push_turn(system, k, turned, degree);
                }
            }
            _ => return false,
        }
        true
    }

    /// Moves a ball joint with limits along its coordinates; how its outer link turned in all. `None` for other
    /// joints, and where they are not gone through.
    pub(super) fn turn_exact(&mut self, k: usize, step: &[f64]) -> Option<DQuat> {
        if !self.memory.is_exact {
            return None;
        }
        let values = &mut self.memory.values[k];
        let motion = match self.linkage.pivots[k].limit {
            JointLimit::Euler { order, angles_rad } => {
                let ranges = angles_rad.iter().take(order.axes().len());
                for ((value, step), range) in values.iter_mut().zip(step).zip(ranges) {
                    *value += step;
                    *value = if is_bounded(*range) {
                        range.clamp(*value)
                    } else {
                        *value % TAU
                    };
                }
                order.to_quat(*values)
            }
            JointLimit::Cone {
                axis,
                swing_max_rad,
                twist_rad,
            } => {
                let swing = Swing::new(axis, *values);
                let vector = swing.outward * (swing.size_rad + step[0]) + swing.around * step[1];
                let vector = vector.clamp_length_max(swing_max_rad);
                let mut twist = values[2] + step[2];
                if is_bounded(twist_rad) {
                    twist = twist_rad.clamp(twist);
                }
                let side = perpendicular(axis);
                *values = [vector.dot(side), vector.dot(axis.cross(side)), twist];
                exp(vector) * exp(axis * twist)
            }
            _ => return None,
        };
        let turn = self.linkage.pivots[k].turn_of_motion(self.linkage.inner_turn(k), motion);
        Some(turn * self.linkage.turns[k].conjugate())
    }

    /// The axis in the world about which pivot `k`'s outer link turns when its motion turns about `axis`, given in
    /// the joint's rest frame.
    fn in_world(&self, k: usize, axis: DVec3, motion: DQuat) -> DVec3 {
        let pivot = &self.linkage.pivots[k];
        let inner = self.linkage.inner_turn(k) * pivot.inner_start;
        if pivot.climbs {
            -(inner * (motion.conjugate() * axis))
        } else {
            inner * (pivot.rest * axis)
        }
    }
}
