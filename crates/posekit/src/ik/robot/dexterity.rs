//! How well a robot can move its tip from where it stands: Jacobian, singular values, manipulability, and
//! what is left of the ranges of its joints.

use glam::DVec3;

use crate::ik::least_squares::Svd;
use crate::mechanism::{Freedom, Mechanism, ValueRange};
use crate::skeleton::JointId;

/// The Jacobian of a point of a link: how it moves and turns for each value of the mechanism.
#[derive(Clone, Debug, PartialEq)]
pub struct TipJacobian {
    /// By value of the mechanism: the velocity of the point, and the angular velocity of the link, in the
    /// world, for one unit of that value a second. Zero for values that do not move the link.
    pub columns: Vec<(DVec3, DVec3)>,
}

/// The Jacobian of a point of a joint's link (in the joint's own frame) at these values.
///
/// A ball joint's three values count as the components, in the joint's frame at rest, of a turn that is
/// added to where it stands.
///
/// # Panics
/// If there are not as many values as the mechanism has.
pub fn jacobian(
    mechanism: &Mechanism,
    values: &[f64],
    joint: JointId,
    point_in_joint: DVec3,
) -> TipJacobian {
    let frames = mechanism.global_frames(values);
    let tip = &frames[joint.index()];
    let tip = tip.position + tip.orientation * point_in_joint;
    let mut columns = vec![(DVec3::ZERO, DVec3::ZERO); mechanism.value_count()];
    let skeleton = mechanism.skeleton();
    for mover in std::iter::once(joint).chain(skeleton.ancestors(joint)) {
        let described = mechanism.joint(mover);
        let frame = &frames[mover.index()];
        // The joint's own frame at rest: where its parent is, and how it is mounted there.
        let mount = match skeleton.parent(mover) {
            Some(parent) => frames[parent.index()].orientation * described.rest_rotation,
            None => described.rest_rotation,
        };
        let (first, multiplier) = match mechanism.followed_value(mover) {
            Some(followed) => (followed.index, followed.multiplier),
            None => (mechanism.values_of_joint(mover).start, 1.0),
        };
        let mut add = |offset: usize, slid: DVec3, turned: DVec3| {
            let column = &mut columns[first + offset];
            let slid = slid + turned.cross(tip - frame.position);
            column.0 += slid * multiplier;
            column.1 += turned * multiplier;
        };
        match described.freedom {
            Freedom::Fixed => {}
            Freedom::Hinge { axis } => add(0, DVec3::ZERO, mount * axis),
            Freedom::Slide { axis } => add(0, mount * axis, DVec3::ZERO),
            Freedom::Planar { normal } => {
                let plane = mount * glam::DQuat::from_rotation_arc(DVec3::Z, normal);
                add(0, plane * DVec3::X, DVec3::ZERO);
                add(1, plane * DVec3::Y, DVec3::ZERO);
                add(2, DVec3::ZERO, mount * normal);
            }
            Freedom::Ball => {
                for (index, axis) in DVec3::AXES.into_iter().enumerate() {
                    add(index, DVec3::ZERO, mount * axis);
                }
            }
            Freedom::Free => {
                for (index, axis) in DVec3::AXES.into_iter().enumerate() {
                    add(index, mount * axis, DVec3::ZERO);
                    add(3 + index, DVec3::ZERO, mount * axis);
                }
            }
        }
    }
    TipJacobian { columns }
}

/// What a tip is to do: which rows of the Jacobian count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Task {
    /// To be somewhere: three rows.
    Position,
    /// To be somewhere in a plane: two rows. For planar arms, which cannot leave theirs.
    PositionInPlane {
        /// The plane's unit normal in the world.
        normal: DVec3,
    },
    /// To be turned somehow: three rows.
    Orientation,
    /// Both: six rows.
    Pose {
        /// The length that a radian counts as much as.
        radian_length: f64,
    },
}

/// How well a tip can do its task in every direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Dexterity {
    /// The singular values of the Jacobian, largest first: the half axes of the ellipsoid of velocities
    /// that values of unit speed give.
    pub singular_values: Vec<f64>,
    /// The axes of that ellipsoid, in the order of the singular values, each of as many numbers as the task
    /// has rows.
    pub axes: Vec<Vec<f64>>,
}

impl Dexterity {
    /// Measures a Jacobian for a task.
    pub fn of(jacobian: &TipJacobian, task: Task) -> Self {
        let rows = rows(jacobian, task);
        let mut svd = Svd::default();
        svd.start(rows.len(), jacobian.columns.len());
        for (row, numbers) in svd
            .matrix_mut()
            .chunks_exact_mut(jacobian.columns.len().max(1))
            .zip(&rows)
        {
            row.copy_from_slice(numbers);
        }
        svd.decompose();
        let mut order: Vec<usize> = (0..svd.count()).collect();
        order.sort_by(|&a, &b| svd.value(b).total_cmp(&svd.value(a)));
        Self {
            singular_values: order.iter().map(|&index| svd.value(index)).collect(),
            axes: order
                .iter()
                .map(|&index| svd.left(index).to_vec())
                .collect(),
        }
    }

    /// The manipulability `sqrt(det(J J^T))` (Yoshikawa 1985, "Manipulability of Robotic Mechanisms", Int.
    /// J. Robotics Research 4(2), doi:10.1177/027836498500400201): the volume of the ellipsoid but for a
    /// constant. 0 at a singularity.
    pub fn manipulability(&self) -> f64 {
        self.singular_values.iter().product()
    }

    /// The least singular value over the largest, from 0 at a singularity to 1 where every direction is
    /// as easy as any other; one over the condition number. 0 for a tip that does not move at all.
    pub fn isotropy(&self) -> f64 {
        match (self.singular_values.first(), self.singular_values.last()) {
            (Some(&largest), Some(&least)) if largest > 0.0 => least / largest,
            _ => 0.0,
        }
    }

    /// The condition number; infinite at a singularity.
    pub fn condition(&self) -> f64 {
        1.0 / self.isotropy()
    }
}

fn rows(jacobian: &TipJacobian, task: Task) -> Vec<Vec<f64>> {
    let row = |of: &dyn Fn(&(DVec3, DVec3)) -> f64| jacobian.columns.iter().map(of).collect();
    let axes = DVec3::AXES;
    match task {
        Task::Position => axes.map(|axis| row(&|column| column.0.dot(axis))).into(),
        Task::Orientation => axes.map(|axis| row(&|column| column.1.dot(axis))).into(),
        Task::PositionInPlane { normal } => {
            let (side, other) = normal.any_orthonormal_pair();
            [side, other]
                .map(|axis| row(&|column| column.0.dot(axis)))
                .into()
        }
        Task::Pose { radian_length } => {
            let mut rows: Vec<Vec<f64>> = axes.map(|axis| row(&|column| column.0.dot(axis))).into();
            rows.extend(axes.map(|axis| row(&|column| column.1.dot(axis) * radian_length)));
            rows
        }
    }
}

/// What is left of a joint's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeMargin {
    /// The joint.
    pub joint: JointId,
    /// Index of its value in the list of all.
    pub value: usize,
    /// How far it may go down; negative outside the range, infinite without a bound.
    pub to_lower: f64,
    /// How far it may go up.
    pub to_upper: f64,
    /// The distance to the nearer end in half ranges: 1 in the middle, 0 at an end, negative outside; 1
    /// for a joint without two bounds.
    pub share: f64,
}

/// What is left of the ranges of all hinges and slides with values of their own, in the order of the values.
///
/// # Panics
/// If there are not as many values as the mechanism has.
pub fn range_margins(mechanism: &Mechanism, values: &[f64]) -> Vec<RangeMargin> {
    assert_eq!(
        values.len(),
        mechanism.value_count(),
        "all values of the mechanism"
    );
    let ranges = mechanism.value_ranges();
    mechanism
        .moving_joints()
        .filter_map(|joint| {
            let slots = mechanism.values_of_joint(joint);
            (slots.len() == 1).then(|| margin(joint, slots.start, ranges[slots.start], values))
        })
        .collect()
}

fn margin(joint: JointId, value: usize, range: ValueRange, values: &[f64]) -> RangeMargin {
    let (to_lower, to_upper) = (values[value] - range.lower, range.upper - values[value]);
    let half = 0.5 * (range.upper - range.lower);
    let share = if range.is_bounded() && half > 0.0 {
        to_lower.min(to_upper) / half
    } else {
        1.0
    };
    RangeMargin {
        joint,
        value,
        to_lower,
        to_upper,
        share,
    }
}
