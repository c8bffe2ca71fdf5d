//! How a linkage moves: from turns to positions and back to joints.

use glam::{DQuat, DVec3};

use super::{Linkage, NONE, Pivot};
use crate::ik::limit::JointLimit;
use crate::ik::report::IkResidual;
use crate::ik::target::IkTarget;
use crate::ik::trace::MovedJoint;
use crate::pose::LocalPose;
use crate::rotation::angle_between;
use crate::skeleton::{JointId, Skeleton};

impl Linkage {
    /// The turn of the link on the base's side of a pivot.
    pub(crate) fn inner_turn(&self, pivot: usize) -> DQuat {
        match self.pivots[pivot].parent {
            NONE => DQuat::IDENTITY,
            parent => self.turns[parent as usize],
        }
    }

    /// The pivots from the base to an effector.
    pub(crate) fn path(&self, effector: usize) -> &[u32] {
        let effector = &self.effectors[effector];
        &self.paths[effector.path_start..effector.path_end]
    }

    /// Recomputes all positions from turns, slides and shifts: forward kinematics.
    pub(crate) fn place(&mut self) {
        for k in 0..self.pivots.len() {
            let pivot = &self.pivots[k];
            let mut position = match pivot.parent {
                NONE => pivot.offset,
                parent => {
                    let parent = parent as usize;
                    self.positions[parent] + self.turns[parent] * pivot.offset
                }
            };
            if !pivot.turns {
                position += self.turns[k] * (pivot.slide_axis * self.slides[k]);
            }
            if pivot.is_afloat {
                position += self.shifts[k];
            }
            self.positions[k] = position;
        }
    }

    /// Where the point of an effector is.
    pub(crate) fn effector_position(&self, effector: usize) -> DVec3 {
        let effector = &self.effectors[effector];
        match effector.pivot {
            NONE => effector.offset,
            pivot => {
                let pivot = pivot as usize;
                self.positions[pivot] + self.turns[pivot] * effector.offset
            }
        }
    }

    /// How an effector is turned.
    pub(crate) fn effector_orientation(&self, effector: usize) -> DQuat {
        let effector = &self.effectors[effector];
        match effector.pivot {
            NONE => effector.orientation_start,
            pivot => self.turns[pivot as usize] * effector.orientation_start,
        }
    }

    /// How far an effector is from its target.
    pub(crate) fn residual(&self, effector: usize, target: &IkTarget) -> IkResidual {
        let angle_rad = target.orientation_in_world.map_or(0.0, |wanted| {
            angle_between(self.effector_orientation(effector), wanted.normalize())
        });
        let position = self.effector_position(effector);
        IkResidual {
            distance: position.distance(target.position_in_world),
            angle_rad,
        }
    }

    /// The turn of pivot `k`'s outer link that is within the joint's limits and nearest to `turn`, given
    /// the turn of the inner link.
    pub(crate) fn limited_turn(&self, k: usize, turn: DQuat) -> DQuat {
        let pivot = &self.pivots[k];
        if matches!(pivot.limit, JointLimit::Free) {
            return turn;
        }
        let inner = self.inner_turn(k);
        let motion = pivot.motion(inner, turn);
        let allowed = pivot.limit.project(motion);
        if allowed == motion {
            return turn;
        }
        pivot.turn_of_motion(inner, allowed)
    }

    /// The joint's motion from its rest orientation.
    pub(crate) fn motion(&self, k: usize) -> DQuat {
        self.pivots[k].motion(self.inner_turn(k), self.turns[k])
    }

    /// The local transform of a pivot's joint as it is now.
    pub(crate) fn moved_joint(&self, k: usize, start: &LocalPose) -> MovedJoint {
        let pivot = &self.pivots[k];
        let index = pivot.joint.index();
        let start_rotation = start.rotations[index].as_dquat();
        // An End Site over which its link rolls has no rotation: it goes with the link.
        let rotation = if pivot.turns && !pivot.is_end_site {
            pivot
                .local_rotation(self.inner_turn(k), self.turns[k])
                .normalize()
        } else {
            start_rotation
        };
        let mut translation = start.translations[index].as_dvec3();
        if let JointLimit::Slide { axis, .. } = pivot.limit {
            translation += pivot.rest * axis * self.slides[k];
        }
        if pivot.is_afloat {
            translation += self.shifts[k];
        }
        MovedJoint {
            joint: pivot.joint,
            rotation,
            translation,
        }
    }

    /// Where the root of the figure is now, if the base lies elsewhere and the root moves.
    pub(crate) fn moved_root(&self, start: &LocalPose, skeleton: &Skeleton) -> Option<MovedJoint> {
        let k = match self.root_pivot {
            NONE => return None,
            pivot => pivot as usize,
        };
        let joint = self.pivots[k].joint;
        let root = skeleton.ancestors(joint).last()?;
        let index = root.index();
        let position = start.translations[index].as_dvec3();
        let from_pivot = position - self.pivots[k].position_start;
        Some(MovedJoint {
            joint: root,
            rotation: (self.turns[k] * start.rotations[index].as_dquat()).normalize(),
            translation: self.positions[k] + self.turns[k] * from_pivot,
        })
    }

    /// Lists the local transforms of all joints that may have moved, the root last if it was carried
    /// along.
    pub(crate) fn list_moved(
        &self,
        start: &LocalPose,
        skeleton: &Skeleton,
        moved: &mut Vec<MovedJoint>,
    ) {
        moved.clear();
        moved.extend((0..self.pivots.len()).map(|k| self.moved_joint(k, start)));
        moved.extend(self.moved_root(start, skeleton));
    }

    /// Lists the joints that are at an end of a range, within `tolerance_rad` (or as much of a length
    /// unit, for a slide).
    pub(crate) fn list_at_limit(&self, tolerance: f64, joints: &mut Vec<JointId>) {
        joints.extend(
            (0..self.pivots.len())
                .filter(|&k| {
                    let pivot = &self.pivots[k];
                    match pivot.limit {
                        JointLimit::Free | JointLimit::Fixed => false,
                        JointLimit::Slide { distance, .. } => {
                            let slid = pivot.slid_at_start + self.slides[k];
                            slid <= distance.min + tolerance || slid >= distance.max - tolerance
                        }
                        limit => limit.is_at_end(self.motion(k), tolerance),
                    }
                })
                .map(|k| self.pivots[k].joint),
        );
    }
}

impl Pivot {
    /// The joint's local rotation, given the turns of both links since the start.
    pub(crate) fn local_rotation(&self, inner_turn: DQuat, outer_turn: DQuat) -> DQuat {
        let inner = inner_turn * self.inner_start;
        let outer = outer_turn * self.outer_start;
        if self.climbs {
            outer.conjugate() * inner
        } else {
            inner.conjugate() * outer
        }
    }

    /// The joint's motion from its rest orientation.
    pub(crate) fn motion(&self, inner_turn: DQuat, outer_turn: DQuat) -> DQuat {
        self.rest.conjugate() * self.local_rotation(inner_turn, outer_turn)
    }

    /// The turn of the outer link that gives the joint this motion.
    pub(crate) fn turn_of_motion(&self, inner_turn: DQuat, motion: DQuat) -> DQuat {
        let local = self.rest * motion;
        let inner = inner_turn * self.inner_start;
        let outer = if self.climbs {
            inner * local.conjugate()
        } else {
            inner * local
        };
        outer * self.outer_start.conjugate()
    }

    /// The axis of a hinge, in the world, given the turn of the link on the base's side; about it the
    /// outer link turns. `None` for other joints.
    pub(crate) fn hinge_axis(&self, inner_turn: DQuat) -> Option<DVec3> {
        let JointLimit::Hinge { axis, .. } = self.limit else {
            return None;
        };
        let inner = inner_turn * self.inner_start;
        // Turning about its own axis does not move it: the axis is the same seen from either link.
        Some(if self.climbs {
            -(inner * axis)
        } else {
            inner * self.rest * axis
        })
    }

    /// The turn of the inner link that gives the joint this motion.
    pub(crate) fn inner_turn_of_motion(&self, outer_turn: DQuat, motion: DQuat) -> DQuat {
        let local = self.rest * motion;
        let outer = outer_turn * self.outer_start;
        let inner = if self.climbs {
            outer * local
        } else {
            outer * local.conjugate()
        };
        inner * self.inner_start.conjugate()
    }
}
