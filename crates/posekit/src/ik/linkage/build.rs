//! From a skeleton, a pose and a problem to the linkage that a solver moves.

use glam::{DQuat, DVec3, Quat};

use super::{Effector, Linkage, NONE, Pivot};
use crate::ik::limit::JointLimit;
use crate::ik::problem::{Base, IkProblem, Movable};
use crate::ik::target::IkTarget;
use crate::pose::LocalPose;
use crate::skeleton::{JointId, Skeleton};

/// What is known of a joint while the linkage is built.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Of the joint in the world.
    position: DVec3,
    orientation: DQuat,
    /// The pivot that this joint became.
    pivot: u32,
    /// In which run the place was found, the joint named as movable, and made a pivot: what was written
    /// in another run counts as unwritten, so that nothing need be cleared.
    known_in: u32,
    movable_in: u32,
    pivot_in: u32,
}

const UNKNOWN: Place = Place {
    position: DVec3::ZERO,
    orientation: DQuat::IDENTITY,
    pivot: NONE,
    known_in: 0,
    movable_in: 0,
    pivot_in: 0,
};

/// Memory that is used again.
#[derive(Clone, Debug, Default)]
pub(super) struct Builder {
    places: Vec<Place>,
    /// The number of this run, from 1.
    run: u32,
    pending: Vec<JointId>,
    /// The way from the base to an effector: joints, and whether each is climbed over.
    way: Vec<(JointId, bool)>,
}

impl Builder {
    /// Makes room for so many joints, of which nothing is known.
    fn begin(&mut self, joint_count: usize) {
        self.run = self.run.wrapping_add(1);
        if self.run == 0 {
            self.places.clear();
            self.run = 1;
        }
        if self.places.len() < joint_count {
            self.places.resize(joint_count, UNKNOWN);
        }
    }
}

struct Job<'a> {
    skeleton: &'a Skeleton,
    pose: &'a LocalPose,
    problem: &'a IkProblem,
    builder: Builder,
}

/// Makes the linkage of a problem, with the figure in `pose`. Memory of the linkage is used again.
///
/// # Panics
/// If the pose has not as many joints as the skeleton, or the problem names a joint that the skeleton
/// has not.
pub(crate) fn build(
    linkage: &mut Linkage,
    skeleton: &Skeleton,
    pose: &LocalPose,
    problem: &IkProblem,
) {
    let joint_count = skeleton.joint_count();
    assert_eq!(pose.joint_count(), joint_count, "a pose of this skeleton");
    let mut job = Job {
        skeleton,
        pose,
        problem,
        builder: core::mem::take(&mut linkage.builder),
    };
    job.builder.begin(joint_count);
    if let Movable::Joints(joints) = &problem.movable {
        for joint in joints {
            job.builder.places[joint.index()].movable_in = job.builder.run;
        }
    }
    linkage.pivots.clear();
    linkage.effectors.clear();
    linkage.paths.clear();
    linkage.root_pivot = NONE;
    for target in &problem.targets {
        job.add_target(linkage, target);
    }
    let count = linkage.pivots.len();
    linkage.turns.clear();
    linkage.turns.resize(count, DQuat::IDENTITY);
    linkage.slides.clear();
    linkage.slides.resize(count, 0.0);
    linkage.shifts.clear();
    linkage.shifts.resize(count, DVec3::ZERO);
    linkage.positions.clear();
    linkage
        .positions
        .extend(linkage.pivots.iter().map(|pivot| pivot.position_start));
    linkage.builder = job.builder;
}

impl Job<'_> {
    fn add_target(&mut self, linkage: &mut Linkage, target: &IkTarget) {
        let joint = target.effector;
        self.locate(joint);
        let Place {
            position,
            orientation,
            ..
        } = self.builder.places[joint.index()];
        // An End Site has no rotation of its own: it is a point of its parent's link.
        let body = match self.skeleton.parent(joint) {
            Some(parent) if self.skeleton.is_end_site(joint) => parent,
            _ => joint,
        };
        self.find_way(body);
        let path_start = linkage.paths.len();
        let mut last = NONE;
        let way = core::mem::take(&mut self.builder.way);
        for &(joint, climbs) in &way {
            if let Some(pivot) = self.pivot(linkage, joint, climbs, last) {
                last = pivot;
                linkage.paths.push(pivot);
            }
        }
        self.builder.way = way;
        let from = match last {
            NONE => DVec3::ZERO,
            pivot => linkage.pivots[pivot as usize].position_start,
        };
        let point = position + orientation * target.point_in_effector;
        linkage.effectors.push(Effector {
            pivot: last,
            offset: point - from,
            orientation_start: self.builder.places[body.index()].orientation,
            is_own_pivot: last != NONE && {
                let pivot = &linkage.pivots[last as usize];
                pivot.joint == body && !pivot.climbs && pivot.turns
            },
            path_start,
            path_end: linkage.paths.len(),
        });
    }

    /// Finds the way from the base to the link of `body`, from the base on.
    fn find_way(&mut self, body: JointId) {
        let way = &mut self.builder.way;
        way.clear();
        let start = match self.problem.base {
            Base::Joint(start) => start,
            Base::Root | Base::Free => {
                way.push((body, false));
                way.extend(self.skeleton.ancestors(body).map(|joint| (joint, false)));
                way.reverse();
                return;
            }
        };
        // Up from the start, then what is not shared of the way down to the body.
        let Some(chain) = self.skeleton.chain(start, body) else {
            return;
        };
        let climbing = chain.climbing();
        way.extend(
            climbing[..climbing.len() - 1]
                .iter()
                .map(|&joint| (joint, true)),
        );
        way.extend(chain.descending()[1..].iter().map(|&joint| (joint, false)));
    }

    /// The pivot of a joint on the way, made if it is new; `None` if the joint does not move.
    fn pivot(
        &mut self,
        linkage: &mut Linkage,
        joint: JointId,
        climbs: bool,
        parent: u32,
    ) -> Option<u32> {
        let known = self.builder.places[joint.index()];
        if known.pivot_in == self.builder.run {
            return Some(known.pivot);
        }
        let is_root = self.skeleton.parent(joint).is_none();
        let is_afloat = is_root && self.problem.base == Base::Free;
        // An End Site has no rotation that could be limited.
        let limit = if self.skeleton.is_end_site(joint) {
            JointLimit::Free
        } else {
            self.problem.limits.limit(joint)
        };
        let slides = matches!(limit, JointLimit::Slide { .. });
        // What floats is not held to a rail.
        let limit = if is_afloat && slides {
            JointLimit::Fixed
        } else {
            limit
        };
        let give = 1.0 - self.problem.limits.stiffness(joint);
        // An End Site at the start of a chain that climbs is the tip over which its link may roll.
        let is_joint = climbs || !self.skeleton.is_end_site(joint);
        let is_listed = match self.problem.movable {
            Movable::Paths => true,
            Movable::Joints(_) => known.movable_in == self.builder.run,
        };
        let may_move = is_joint && is_listed && give > 0.0 && limit != JointLimit::Fixed;
        if !may_move && !is_afloat {
            return None;
        }
        self.locate(joint);
        let place = self.builder.places[joint.index()];
        let inner = self
            .skeleton
            .parent(joint)
            .map_or(DQuat::IDENTITY, |parent| {
                self.builder.places[parent.index()].orientation
            });
        let index = joint.index();
        let rest = self.skeleton.rest_rotation(joint);
        // As in every BVH.
        let rest = if rest == Quat::IDENTITY {
            DQuat::IDENTITY
        } else {
            rest.as_dquat().normalize()
        };
        let (slide_axis, slid_at_start) = match limit {
            JointLimit::Slide { axis, .. } if may_move => {
                let in_world = inner * rest * axis;
                let moved = self.pose.translations[index] - self.skeleton.rest_translation(joint);
                (
                    if climbs { -in_world } else { in_world },
                    moved.as_dvec3().dot(rest * axis),
                )
            }
            _ => (DVec3::ZERO, 0.0),
        };
        let from = match parent {
            NONE => DVec3::ZERO,
            pivot => linkage.pivots[pivot as usize].position_start,
        };
        let id = u32::try_from(linkage.pivots.len()).ok()?;
        linkage.pivots.push(Pivot {
            joint,
            parent,
            climbs,
            is_afloat,
            is_end_site: self.skeleton.is_end_site(joint),
            turns: may_move && limit.turns(),
            limit,
            give: if may_move { give } else { 0.0 },
            inner_start: if climbs { place.orientation } else { inner },
            outer_start: if climbs { inner } else { place.orientation },
            rest,
            position_start: place.position,
            offset: place.position - from,
            slide_axis,
            slid_at_start,
        });
        if climbs {
            linkage.root_pivot = id;
        }
        let run = self.builder.run;
        let place = &mut self.builder.places[index];
        (place.pivot, place.pivot_in) = (id, run);
        Some(id)
    }

    /// Finds where a joint and all its ancestors are in the world.
    fn locate(&mut self, joint: JointId) {
        let Builder {
            places,
            pending,
            run,
            ..
        } = &mut self.builder;
        pending.clear();
        let mut next = Some(joint);
        while let Some(joint) = next {
            if places[joint.index()].known_in == *run {
                break;
            }
            pending.push(joint);
            next = self.skeleton.parent(joint);
        }
        while let Some(joint) = pending.pop() {
            let index = joint.index();
            let rotation = self.pose.rotations[index].as_dquat().normalize();
            let translation = self.pose.translations[index].as_dvec3();
            let (position, orientation) = match self.skeleton.parent(joint) {
                None => (translation, rotation),
                Some(parent) => {
                    let parent = &places[parent.index()];
                    (
                        parent.position + parent.orientation * translation,
                        parent.orientation * rotation,
                    )
                }
            };
            let place = &mut places[index];
            place.position = position;
            place.orientation = orientation;
            place.known_in = *run;
        }
    }
}
