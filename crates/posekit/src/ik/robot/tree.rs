//! The moving part of a robot between its root and its effectors, as elementary pivots: hinges, slides and
//! balls. What lies between two of them is one fixed transform.

use core::f64::consts::PI;

use glam::{DQuat, DVec3};

use crate::ik::least_squares::{Degree, Model, System, Taken};
use crate::ik::problem::StopRule;
use crate::ik::random::Random;
use crate::ik::report::IkResidual;
use crate::ik::target::IkTarget;
use crate::mechanism::{Frame, Freedom, Mechanism, ValueRange};
use crate::rotation::{exp, log};

const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
enum Kind {
    Hinge(DVec3),
    Slide(DVec3),
    Ball,
}

#[derive(Clone, Copy, Debug)]
struct Pivot {
    /// The next pivot towards the root.
    parent: u32,
    /// From there to this pivot's frame before its own motion.
    before: Frame,
    kind: Kind,
    /// The first of its values, or the one that it follows.
    value: usize,
    multiplier: f64,
    offset: f64,
}

#[derive(Clone, Copy, Debug)]
struct Effector {
    pivot: u32,
    /// From the pivot's frame to the effector's point.
    offset: DVec3,
    /// From the pivot's frame to the effector's.
    turn: DQuat,
}

/// A value (or a ball's three) that some effector depends on.
#[derive(Clone, Copy, Debug)]
struct Scalar {
    value: usize,
    range: ValueRange,
    /// The pivots that it moves: `movers[first..end]`.
    first: usize,
    end: usize,
    is_ball: bool,
    is_hinge: bool,
}

/// A robot compiled for some effectors, and where it stands.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    pivots: Vec<Pivot>,
    effectors: Vec<Effector>,
    scalars: Vec<Scalar>,
    movers: Vec<u32>,
    /// Whether pivot `k` moves effector `e`, at `k * effectors + e`.
    moves: Vec<bool>,
    reach: f64,
    ranges: Vec<ValueRange>,
    on_path: Vec<bool>,
    /// By joint: the pivot that carries it, and the fixed transform from there.
    carried: Vec<(u32, Frame)>,
    values: Vec<f64>,
    saved: Vec<f64>,
    balls: Vec<DQuat>,
    saved_balls: Vec<DQuat>,
    frames: Vec<Frame>,
    axes: Vec<DVec3>,
}

fn compose(outer: Frame, inner: Frame) -> Frame {
    Frame {
        position: outer.position + outer.orientation * inner.position,
        orientation: outer.orientation * inner.orientation,
    }
}

impl Tree {
    /// Finds the pivots between the root and the effectors of the targets.
    pub(super) fn compile(&mut self, mechanism: &Mechanism, targets: &[IkTarget]) {
        let skeleton = mechanism.skeleton();
        self.on_path.clear();
        self.on_path.resize(skeleton.joint_count(), false);
        for target in targets {
            self.on_path[target.effector.index()] = true;
            for ancestor in skeleton.ancestors(target.effector) {
                self.on_path[ancestor.index()] = true;
            }
        }
        self.pivots.clear();
        self.carried.clear();
        self.ranges = mechanism.value_ranges();
        for joint in skeleton.joints() {
            if !self.on_path[joint.index()] {
                self.carried.push((NONE, Frame::IDENTITY));
                continue;
            }
            let described = mechanism.joint(joint);
            let rest = Frame {
                position: described.rest_translation,
                orientation: described.rest_rotation,
            };
            let (parent, before) = match skeleton.parent(joint) {
                None => (NONE, rest),
                Some(parent) => {
                    let (pivot, frame) = self.carried[parent.index()];
                    (pivot, compose(frame, rest))
                }
            };
            let (value, multiplier, offset) = match mechanism.followed_value(joint) {
                Some(followed) => (followed.index, followed.multiplier, followed.offset),
                None => (mechanism.values_of_joint(joint).start, 1.0, 0.0),
            };
            let first = Pivot {
                parent,
                before,
                kind: Kind::Ball,
                value,
                multiplier,
                offset,
            };
            let carried = self.push_pivots(first, described.freedom);
            self.carried.push(carried);
        }
        self.find_effectors(targets);
        self.find_scalars(mechanism);
        let count = self.pivots.len();
        self.frames.resize(count, Frame::IDENTITY);
        self.axes.resize(count, DVec3::ZERO);
        self.balls.clear();
        self.balls.resize(count, DQuat::IDENTITY);
    }

    /// Adds the elementary pivots of a joint; what carries its frame.
    fn push_pivots(&mut self, first: Pivot, freedom: Freedom) -> (u32, Frame) {
        let kinds: &[Kind] = match freedom {
            Freedom::Fixed => return (first.parent, first.before),
            Freedom::Hinge { axis } => &[Kind::Hinge(axis)],
            Freedom::Slide { axis } => &[Kind::Slide(axis)],
            Freedom::Planar { normal } => {
                let plane = DQuat::from_rotation_arc(DVec3::Z, normal);
                &[
                    Kind::Slide(plane * DVec3::X),
                    Kind::Slide(plane * DVec3::Y),
                    Kind::Hinge(normal),
                ]
            }
            Freedom::Ball => &[Kind::Ball],
            Freedom::Free => &[
                Kind::Slide(DVec3::X),
                Kind::Slide(DVec3::Y),
                Kind::Slide(DVec3::Z),
                Kind::Ball,
            ],
        };
        let (mut parent, mut before) = (first.parent, first.before);
        for (index, &kind) in kinds.iter().enumerate() {
            self.pivots.push(Pivot {
                parent,
                before,
                kind,
                value: first.value + index,
                ..first
            });
            parent = u32::try_from(self.pivots.len() - 1).unwrap_or(NONE);
            before = Frame::IDENTITY;
        }
        (parent, before)
    }

    fn find_effectors(&mut self, targets: &[IkTarget]) {
        self.effectors.clear();
        self.moves.clear();
        self.moves.resize(self.pivots.len() * targets.len(), false);
        self.reach = 0.0;
        for (index, target) in targets.iter().enumerate() {
            let (pivot, frame) = self.carried[target.effector.index()];
            let offset = frame.position + frame.orientation * target.point_in_effector;
            self.effectors.push(Effector {
                pivot,
                offset,
                turn: frame.orientation,
            });
            let (mut next, mut reach) = (pivot, offset.length());
            while next != NONE {
                let k = next as usize;
                self.moves[k * targets.len() + index] = true;
                next = self.pivots[k].parent;
                if next != NONE {
                    reach += self.pivots[k].before.position.length();
                }
            }
            self.reach = self.reach.max(reach);
        }
        let has_extent = self.reach > 0.0 && self.reach < f64::INFINITY;
        if !has_extent {
            self.reach = 1.0;
        }
    }

    /// Lists each value once, with all the pivots that it moves.
    fn find_scalars(&mut self, mechanism: &Mechanism) {
        self.scalars.clear();
        self.movers.clear();
        for value in 0..mechanism.value_count() {
            let first = self.movers.len();
            let (mut is_ball, mut is_hinge) = (false, false);
            for (k, pivot) in self.pivots.iter().enumerate() {
                if pivot.value == value {
                    is_ball |= matches!(pivot.kind, Kind::Ball);
                    is_hinge |= matches!(pivot.kind, Kind::Hinge(_));
                    self.movers.push(u32::try_from(k).unwrap_or(NONE));
                }
            }
            let end = self.movers.len();
            if end > first {
                self.scalars.push(Scalar {
                    value,
                    range: self.ranges[value],
                    first,
                    end,
                    is_ball,
                    is_hinge,
                });
            }
        }
    }

    /// Where pivots are and which way their axes point, from values and balls.
    fn place(&mut self) {
        for k in 0..self.pivots.len() {
            let pivot = &self.pivots[k];
            let before = match pivot.parent {
                NONE => pivot.before,
                parent => compose(self.frames[parent as usize], pivot.before),
            };
            let value = pivot.multiplier * self.values[pivot.value] + pivot.offset;
            self.frames[k] = match pivot.kind {
                Kind::Hinge(axis) => {
                    self.axes[k] = before.orientation * axis;
                    let (sin, cos) = libm::sincos(0.5 * value);
                    let turn = DQuat::from_vec4((axis * sin).extend(cos));
                    Frame {
                        position: before.position,
                        orientation: before.orientation * turn,
                    }
                }
                Kind::Slide(axis) => {
                    let axis = before.orientation * axis;
                    self.axes[k] = axis;
                    Frame {
                        position: before.position + axis * value,
                        orientation: before.orientation,
                    }
                }
                Kind::Ball => Frame {
                    position: before.position,
                    orientation: before.orientation * self.balls[k],
                },
            };
        }
    }

    fn effector(&self, index: usize) -> Frame {
        let effector = &self.effectors[index];
        let offset = Frame {
            position: effector.offset,
            orientation: effector.turn,
        };
        match effector.pivot {
            NONE => offset,
            pivot => compose(self.frames[pivot as usize], offset),
        }
    }
}

/// A robot with its targets.
pub(super) struct RobotModel<'a> {
    tree: &'a mut Tree,
    targets: &'a [IkTarget],
    stop: StopRule,
    per_length: f64,
    per_radian: f64,
}

impl<'a> RobotModel<'a> {
    pub(super) fn new(
        tree: &'a mut Tree,
        targets: &'a [IkTarget],
        stop: StopRule,
        radian_share: f64,
    ) -> Self {
        let per_length = 1.0 / tree.reach;
        Self {
            tree,
            targets,
            stop,
            per_length,
            per_radian: radian_share,
        }
    }

    /// Takes the robot to these values, each brought within its range.
    pub(super) fn set_values(&mut self, values: &[f64]) {
        let tree = &mut *self.tree;
        assert_eq!(
            values.len(),
            tree.ranges.len(),
            "all values of the mechanism"
        );
        tree.values.clear();
        tree.values.extend_from_slice(values);
        for scalar in &tree.scalars {
            let value = &mut tree.values[scalar.value];
            *value = scalar.range.clamp(*value);
        }
        for (k, pivot) in tree.pivots.iter().enumerate() {
            if let Kind::Ball = pivot.kind {
                tree.balls[k] = exp(DVec3::from_slice(&values[pivot.value..pivot.value + 3]));
            }
        }
        tree.place();
    }

    /// Writes the values that targets depend on; turns without bounds within half a turn of zero.
    pub(super) fn write_values(&self, values: &mut [f64]) {
        for scalar in &self.tree.scalars {
            let at = scalar.value;
            if scalar.is_ball {
                let vector = log(self.tree.balls[self.tree.movers[scalar.first] as usize]);
                values[at..at + 3].copy_from_slice(&vector.to_array());
                continue;
            }
            let mut value = self.tree.values[at];
            let is_endless = scalar.is_hinge && scalar.range == ValueRange::FREE;
            // A follower that turns half as far would not come back with the other.
            let is_alone = scalar.end - scalar.first == 1;
            if is_endless && is_alone && value.abs() > PI {
                value -= (value / (2.0 * PI)).round() * (2.0 * PI);
            }
            values[at] = value;
        }
    }

    /// Takes the robot to random values within the ranges: of endless turns any angle; slides without
    /// bounds stay.
    pub(super) fn randomize(&mut self, random: &mut Random) {
        let tree = &mut *self.tree;
        for scalar in &tree.scalars {
            if scalar.is_ball {
                tree.balls[tree.movers[scalar.first] as usize] = random.orientation();
                continue;
            }
            let range = scalar.range;
            let (low, high) = match (range.is_bounded(), scalar.is_hinge) {
                // Ranges of several turns have the same poses again.
                (true, true) => {
                    let middle = 0.5 * (range.lower + range.upper);
                    let half = (0.5 * (range.upper - range.lower)).min(PI);
                    (middle - half, middle + half)
                }
                (true, false) => (range.lower, range.upper),
                (false, true) => (range.lower.max(-PI), range.upper.min(PI)),
                (false, false) => continue,
            };
            tree.values[scalar.value] = range.clamp(random.between(low, high));
        }
        tree.place();
    }

    /// Whether something that targets depend on is at an end of its range, or no further from it than `near`.
    pub(super) fn is_at_limit(&self, near: f64) -> bool {
        self.tree.scalars.iter().any(|scalar| {
            let value = self.tree.values[scalar.value];
            !scalar.is_ball && (value - scalar.range.lower).min(scalar.range.upper - value) <= near
        })
    }

    /// Lets everything that targets depend on move without end, until the robot is compiled again.
    pub(super) fn forget_ranges(&mut self) {
        for scalar in &mut self.tree.scalars {
            scalar.range = ValueRange::FREE;
        }
    }

    /// How far each effector is from its target.
    pub(super) fn residuals(&self) -> Vec<IkResidual> {
        let targets = self.targets.iter().enumerate();
        targets
            .map(|(index, target)| self.residual(index, target))
            .collect()
    }

    fn residual(&self, index: usize, target: &IkTarget) -> IkResidual {
        let frame = self.tree.effector(index);
        let angle_rad = target.orientation_in_world.map_or(0.0, |wanted| {
            crate::rotation::angle_between(frame.orientation, wanted)
        });
        IkResidual {
            distance: frame.position.distance(target.position_in_world),
            angle_rad,
        }
    }
}

impl Model for RobotModel<'_> {
    fn find_residual(&self, system: &mut System) {
        system.residual.clear();
        for (index, target) in self.targets.iter().enumerate() {
            let frame = self.tree.effector(index);
            if target.position_weight > 0.0 {
                let factor = self.per_length * target.position_weight.sqrt();
                let missing = (target.position_in_world - frame.position) * factor;
                system.residual.extend(missing.to_array());
            }
            if let Some(wanted) = target.orientation_in_world
                && target.orientation_weight > 0.0
            {
                let factor = self.per_radian * target.orientation_weight.sqrt();
                let missing = log(wanted.normalize() * frame.orientation.conjugate()) * factor;
                system.residual.extend(missing.to_array());
            }
        }
    }

    fn linearize(&mut self, system: &mut System) {
        system.clear_columns();
        let tree = &*self.tree;
        for scalar in &tree.scalars {
            if scalar.is_ball {
                let k = tree.movers[scalar.first] as usize;
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    system.push_degree(Degree::free(1.0));
                    self.push_entries(system, |effector, at| {
                        tree.moves[k * tree.effectors.len() + effector]
                            .then(|| (axis.cross(at - tree.frames[k].position), axis))
                    });
                }
                continue;
            }
            let value = tree.values[scalar.value];
            system.push_degree(Degree {
                lower: (scalar.range.lower - value).min(0.0),
                upper: (scalar.range.upper - value).max(0.0),
                ..Degree::free(1.0)
            });
            self.push_entries(system, |effector, at| {
                let mut sum: Option<(DVec3, DVec3)> = None;
                for &k in &tree.movers[scalar.first..scalar.end] {
                    let k = k as usize;
                    if !tree.moves[k * tree.effectors.len() + effector] {
                        continue;
                    }
                    let pivot = &tree.pivots[k];
                    let axis = tree.axes[k] * pivot.multiplier;
                    let (slid, turned) = match pivot.kind {
                        Kind::Slide(_) => (axis, DVec3::ZERO),
                        _ => (axis.cross(at - tree.frames[k].position), axis),
                    };
                    let so_far = sum.unwrap_or_default();
                    sum = Some((so_far.0 + slid, so_far.1 + turned));
                }
                sum
            });
        }
    }

    fn advance(&mut self, step: &[f64]) {
        let tree = &mut *self.tree;
        let mut at = 0;
        for scalar in &tree.scalars {
            if scalar.is_ball {
                let k = tree.movers[scalar.first] as usize;
                let turn = DVec3::from_slice(&step[at..at + 3]);
                let own = tree.frames[k].orientation.conjugate() * turn;
                tree.balls[k] = (tree.balls[k] * exp(own)).normalize();
                at += 3;
            } else {
                let value = &mut tree.values[scalar.value];
                *value = scalar.range.clamp(*value + step[at]);
                at += 1;
            }
        }
        tree.place();
    }

    fn save(&mut self) {
        let tree = &mut *self.tree;
        tree.saved.clone_from(&tree.values);
        tree.saved_balls.clone_from(&tree.balls);
    }

    fn restore(&mut self) {
        let tree = &mut *self.tree;
        tree.values.clone_from(&tree.saved);
        tree.balls.clone_from(&tree.saved_balls);
        tree.place();
    }

    fn is_reached(&self) -> bool {
        self.targets.iter().enumerate().all(|(index, target)| {
            let frame = self.tree.effector(index);
            let distance = frame.position.distance(target.position_in_world);
            let is_near = distance <= self.stop.position_tolerance;
            if target.position_weight > 0.0 && !is_near {
                return false;
            }
            target.orientation_weight == 0.0
                || self.residual(index, target).angle_rad <= self.stop.orientation_tolerance_rad
        })
    }

    fn is_short(&self) -> bool {
        !self.is_reached()
    }

    fn keep_saved(&mut self) {
        // Nothing leads uphill without a nudge.
    }

    fn restore_kept(&mut self) {}

    fn nudge(&mut self, _: usize) -> bool {
        // Another attempt is the better way out.
        false
    }

    fn record(&mut self, _: Taken) {}
}

impl RobotModel<'_> {
    /// Adds the rows of the last degree of freedom: for every effector that moves, how its point slides
    /// and how it turns.
    fn push_entries(
        &self,
        system: &mut System,
        motion: impl Fn(usize, DVec3) -> Option<(DVec3, DVec3)>,
    ) {
        let mut row = 0;
        for (index, target) in self.targets.iter().enumerate() {
            let motion = motion(index, self.tree.effector(index).position);
            if target.position_weight > 0.0 {
                if let Some((slid, _)) = motion {
                    let factor = self.per_length * target.position_weight.sqrt();
                    system.push_entry(row, slid * factor);
                }
                row += 3;
            }
            if target.orientation_in_world.is_some() && target.orientation_weight > 0.0 {
                if let Some((_, turned)) = motion {
                    let factor = self.per_radian * target.orientation_weight.sqrt();
                    system.push_entry(row, turned * factor);
                }
                row += 3;
            }
        }
    }
}
