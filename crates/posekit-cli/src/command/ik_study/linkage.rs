//! A chain as the study sees it: the points about which it bends, and how far it reaches.

use glam::{DVec3, Vec3};
use posekit::ik::{IkProblem, Movable};
use posekit::pose::{GlobalPose, LocalPose};
use posekit::skeleton::{Chain, JointId, Skeleton};

/// A chain that is studied.
#[derive(Clone, Debug)]
pub(super) struct StudiedChain {
    /// Its joints.
    pub(super) chain: Chain,
    /// What it is called: its ends' names.
    pub(super) name: String,
    /// The joints that turn, from the base on.
    pub(super) turning: Vec<JointId>,
    /// Where those joints are in the start pose, in the world, and after them the end.
    pub(super) points: Vec<DVec3>,
    /// Where the figure's root is in the start pose.
    pub(super) root_place: Vec3,
    /// How far the end gets from the first of the points.
    pub(super) reach: f64,
    /// How near the end can come to it.
    pub(super) inner_reach: f64,
    /// How near counts as reached.
    pub(super) tolerance: f64,
    /// The problem, with a target that is still to be set.
    problem: IkProblem,
}

impl StudiedChain {
    /// A chain in the pose in which solvers start. `None` if none of its joints turns.
    pub(super) fn new(
        skeleton: &Skeleton,
        start: &LocalPose,
        chain: Chain,
        tolerance: Option<f64>,
    ) -> Option<Self> {
        let problem = IkProblem::for_chain(skeleton, &chain, DVec3::ZERO);
        let turning = match &problem.movable {
            Movable::Joints(joints) => joints.clone(),
            Movable::Paths => return None,
        };
        let global = start.to_global(skeleton);
        let at = |joint: JointId| global.positions[joint.index()].as_dvec3();
        let points: Vec<DVec3> = turning
            .iter()
            .copied()
            .chain([chain.end()])
            .map(at)
            .collect();
        let links: Vec<f64> = points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .collect();
        let reach: f64 = links.iter().sum();
        let longest = links.iter().copied().fold(0.0, f64::max);
        if turning.is_empty() || !(reach > 0.0 && reach.is_finite()) {
            return None;
        }
        let name = |joint| skeleton.unique_name(joint);
        Some(Self {
            name: format!("{} → {}", name(chain.start()), name(chain.end())),
            chain,
            root_place: skeleton
                .roots()
                .next()
                .map_or(Vec3::ZERO, |root| global.positions[root.index()]),
            turning,
            points,
            reach,
            inner_reach: (2.0 * longest - reach).max(0.0),
            tolerance: tolerance.unwrap_or(1e-3 * reach),
            problem,
        })
    }

    /// The point that stays where it is.
    pub(super) fn base(&self) -> DVec3 {
        self.points[0]
    }

    /// How far a place is out of reach; 0 within.
    pub(super) fn beyond(&self, place: DVec3) -> f64 {
        let distance = self.base().distance(place);
        (distance - self.reach)
            .max(self.inner_reach - distance)
            .max(0.0)
    }

    /// The problem of bringing the end to a place, with a number of iterations and nothing that would stop
    /// them earlier but the solver's own rest.
    pub(super) fn problem(&self, place: DVec3, iterations: u32) -> IkProblem {
        let mut problem = self.problem.clone();
        problem.targets[0].position_in_world = place;
        problem.stop.position_tolerance = 0.0;
        problem.stop.rest_tolerance = self.tolerance;
        problem.stop.max_iterations = iterations;
        problem
    }

    /// The two joints of the chain, one after the other, that make the longest limb: from the one to the other,
    /// and from that to the end. `None` if it has but one.
    pub(super) fn two_bones(&self) -> Option<[JointId; 2]> {
        let upper = self.upper_of_two()?;
        Some([self.turning[upper], self.turning[upper + 1]])
    }

    /// Whether those two joints alone bring the end to a place within the tolerance, if all others stay.
    pub(super) fn two_bones_reach(&self, place: DVec3) -> bool {
        let Some(index) = self.upper_of_two() else {
            return false;
        };
        let (upper, middle) = (self.points[index], self.points[index + 1]);
        let end = self.points[self.points.len() - 1];
        let (first, second) = (upper.distance(middle), middle.distance(end));
        let distance = upper.distance(place);
        distance <= first + second + self.tolerance
            && distance >= (first - second).abs() - self.tolerance
    }

    /// Index of the upper one of the two joints.
    fn upper_of_two(&self) -> Option<usize> {
        let end = self.points[self.points.len() - 1];
        let shorter = |&index: &usize| {
            let (upper, middle) = (self.points[index], self.points[index + 1]);
            upper.distance(middle).min(middle.distance(end))
        };
        (0..self.turning.len().saturating_sub(1)).max_by(|a, b| shorter(a).total_cmp(&shorter(b)))
    }

    /// Where the end is in a pose.
    pub(super) fn end_in(&self, pose: &GlobalPose) -> DVec3 {
        pose.positions[self.chain.end().index()].as_dvec3()
    }

    /// Whether the way from start to end climbs before it goes down.
    pub(super) fn climbs(&self) -> bool {
        self.chain.climbing().len() > 1
    }
}
