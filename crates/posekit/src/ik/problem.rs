//! What is asked of a solver: targets, what is held, what may move and when to stop.

use std::sync::Arc;

use glam::DVec3;

use super::limit::JointLimits;
use super::target::{IkTarget, Pole};
use crate::pose::LocalPose;
use crate::skeleton::{Chain, JointId, Skeleton};

/// What stays in place while the figure moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The roots keep their positions; one that may move only turns.
    Root,
    /// This joint keeps its place and its orientation, and the root moves: a planted foot. If the joint
    /// may move, the link between it and its parent turns about it. What hangs from it keeps still.
    Joint(JointId),
    /// Nothing: roots may be carried anywhere, and turned if they may move.
    Free,
}

/// Which joints a solver may turn (or slide, where their limits say so).
#[derive(Clone, Debug, PartialEq)]
pub enum Movable {
    /// Every joint on the paths from the base to the effectors.
    Paths,
    /// Of the joints on the paths from the base to the effectors, these.
    Joints(Vec<JointId>),
}

/// Whether the joint at which a chain starts may turn. It keeps its place in any case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartJoint {
    /// It turns: a shoulder. At the start of a chain that climbs the joint's own link stays and its
    /// parent's turns about it: an ankle over a planted foot.
    Turns,
    /// It does not: the hips while an arm reaches out, the tip of a planted toe.
    Held,
}

impl StartJoint {
    /// What suits a chain: every joint turns, except a root, which would turn the whole figure, and an
    /// End Site, over which the figure would roll.
    pub fn suited_to(skeleton: &Skeleton, chain: &Chain) -> Self {
        let start = chain.start();
        if skeleton.parent(start).is_none() || skeleton.is_end_site(start) {
            Self::Held
        } else {
            Self::Turns
        }
    }
}

/// When an iterative solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopRule {
    /// A target counts as reached when its point is this near, in the file's unit. Zero asks for every
    /// iteration that still gains something.
    pub position_tolerance: f64,
    /// What tells a solver at rest that is stuck from one that has arrived, where `position_tolerance` is
    /// zero: beyond this distance from its target, in the file's unit, joints are bent or other starts
    /// tried; within it the pose stays as it is. It ends no iterations.
    pub rest_tolerance: f64,
    /// A target's orientation counts as reached when it is this near.
    pub orientation_tolerance_rad: f64,
    /// The most iterations. A solver that comes to rest short of its targets and starts again elsewhere takes
    /// more, some dozens from each start.
    pub max_iterations: u32,
}

/// How strongly joints are drawn back to a pose that is preferred.
#[derive(Clone, Debug, PartialEq)]
pub struct RestPull {
    /// The share of each joint's way back that it is drawn in the first iteration, from 0 to 1; it fades
    /// in those that follow (solvers of least squares use it as a weight), so that targets win.
    pub strength: f64,
    /// The pose that is preferred.
    pub toward: PreferredPose,
}

/// The pose that joints are drawn to.
#[derive(Clone, Debug, PartialEq)]
pub enum PreferredPose {
    /// The skeleton's rest pose.
    Rest,
    /// The pose in which the solver starts.
    Start,
    /// This pose.
    Pose(Arc<LocalPose>),
}

/// How much of a solver's way is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TraceDetail {
    /// Nothing.
    #[default]
    None,
    /// Every joint's update in every iteration ([`IkTrace`](super::IkTrace)). Allocates.
    Updates,
}

/// One problem of inverse kinematics: any number of targets on one figure.
///
/// Targets, poles and the stop rule may be changed between calls (a target that moves); nothing of the
/// problem is kept by a solver.
#[derive(Clone, Debug, PartialEq)]
pub struct IkProblem {
    /// What stays in place.
    pub base: Base,
    /// Which joints may move. Joints whose limit is [`Fixed`](super::JointLimit::Fixed) or whose
    /// stiffness is 1 do not in any case, nor do End Sites.
    pub movable: Movable,
    /// What is to be reached.
    pub targets: Vec<IkTarget>,
    /// Which way chains should bend.
    pub poles: Vec<Pole>,
    /// What each joint can do. Shared, since many problems have one figure's table.
    pub limits: Arc<JointLimits>,
    /// What joints are drawn back to.
    pub rest_pull: Option<RestPull>,
    /// When to stop.
    pub stop: StopRule,
    /// What to record.
    pub trace: TraceDetail,
}

impl IkProblem {
    /// A problem without limits, whose tolerance is a ten-thousandth of `reach` and a milliradian, with
    /// at most 100 iterations.
    pub fn new(base: Base, movable: Movable, targets: Vec<IkTarget>, reach: f64) -> Self {
        Self {
            base,
            movable,
            targets,
            poles: Vec::new(),
            limits: Arc::new(JointLimits::default()),
            rest_pull: None,
            stop: StopRule {
                position_tolerance: 1e-4 * reach,
                rest_tolerance: 1e-4 * reach,
                orientation_tolerance_rad: 1e-3,
                max_iterations: 100,
            },
            trace: TraceDetail::None,
        }
    }

    /// The problem of bringing the end of a chain to a position. Its start keeps its place: where the
    /// chain climbs the root moves instead.
    ///
    /// The end itself does not turn, since that does not move it; give the target an orientation or a
    /// point and add the end to [`movable`](Self::movable), or use [`for_target`](Self::for_target).
    pub fn for_chain(skeleton: &Skeleton, chain: &Chain, position_in_world: DVec3) -> Self {
        let start = StartJoint::suited_to(skeleton, chain);
        let target = IkTarget::position(chain.end(), position_in_world);
        Self::for_target(skeleton, chain, start, target)
    }

    /// The problem of bringing the end of a chain to a target, with a choice for its start.
    ///
    /// The end turns if the target has an orientation or a point off the joint.
    ///
    /// # Panics
    /// If the target's effector is not the chain's end.
    pub fn for_target(
        skeleton: &Skeleton,
        chain: &Chain,
        start: StartJoint,
        target: IkTarget,
    ) -> Self {
        assert_eq!(target.effector, chain.end(), "the end of this chain");
        let climbs = chain.climbing().len() > 1;
        let joints = chain.joints().iter().copied();
        let end_turns =
            target.orientation_in_world.is_some() || target.point_in_effector != DVec3::ZERO;
        let movable = joints.filter(|&joint| {
            // No joint bends at the top of a chain that climbs: both limbs hang from one rigid link.
            let is_hinge_of_chain = !climbs || joint != chain.top();
            let may_start = joint != chain.start() || start == StartJoint::Turns;
            let may_end = joint != chain.end() || end_turns;
            is_hinge_of_chain && may_start && may_end
        });
        let base = if climbs {
            Base::Joint(chain.start())
        } else {
            Base::Root
        };
        let reach = f64::from(chain.rest_length(skeleton));
        Self::new(
            base,
            Movable::Joints(movable.collect()),
            vec![target],
            reach,
        )
    }

    /// The problem of bringing several effectors to their targets with the whole figure, whose root is
    /// free. The tolerance is a thousandth of the figure's height.
    pub fn for_whole_body(skeleton: &Skeleton, targets: Vec<IkTarget>) -> Self {
        let height = f64::from(skeleton.height());
        let mut problem = Self::new(Base::Free, Movable::Paths, targets, height);
        problem.stop.position_tolerance = 1e-3 * height;
        problem
    }
}
