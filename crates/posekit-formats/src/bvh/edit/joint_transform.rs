//! One joint's transform in one frame.

use glam::{DQuat, DVec3};
use posekit::ik::{Interval, JointLimit};
use posekit::motion::{Channel, PositionPolicies, PositionPolicy};
use posekit::rotation::{Axis, EulerOrder};

use super::EditError;
use super::columns::rotation_columns;
use crate::bvh::{Bvh, BvhJoint};

/// Decimals that new angles in degrees and new lengths are rounded to: far beyond what can be seen, and
/// about what single precision holds.
const DECIMALS_KEPT: f64 = 1e6;

/// Gives a joint a rotation in one frame: the angles of its channels, in their order, that are closest to
/// those of `near_frame`. The angle that is left because the channels cannot make the rotation: 0 for
/// three axes.
///
/// # Errors
/// When there is no such joint or frame, or the joint has more than three rotation channels.
pub fn set_rotation(
    bvh: &mut Bvh,
    joint: usize,
    frame: usize,
    rotation: DQuat,
    near_frame: usize,
) -> Result<f64, EditError> {
    check_place(bvh, joint, frame.max(near_frame))?;
    let start = bvh.joint_columns(joint).start;
    let turns = rotation_columns(&bvh.joints[joint].channels, start);
    let axes: Vec<Axis> = turns.iter().map(|&(_, axis)| axis).collect();
    let order = EulerOrder::new(&axes).map_err(|_more_than_three| EditError::CannotMove {
        name: bvh.joints[joint].name().into_owned(),
        what: "more than three rotation channels",
    })?;
    let mut near_rad = [0.0; 3];
    let near_row = bvh.row(near_frame);
    for (angle, &(column, _)) in near_rad.iter_mut().zip(&turns) {
        *angle = near_row[column].to_radians();
    }
    let euler = order.from_quat_near(rotation, near_rad);
    let row = row_mut(bvh, frame);
    for (&(column, _), angle) in turns.iter().zip(euler.angles_rad) {
        row[column] = rounded(angle.to_degrees());
    }
    Ok(euler.residual_rad)
}

/// Moves a joint in one frame: its position channels take the translation in its parent's space, as
/// `policies` read them.
///
/// # Errors
/// When there is no such joint or frame, or the joint lacks a position channel for a coordinate that
/// differs from its OFFSET.
pub fn set_translation(
    bvh: &mut Bvh,
    joint: usize,
    frame: usize,
    translation: DVec3,
    policies: impl Into<PositionPolicies>,
) -> Result<(), EditError> {
    check_place(bvh, joint, frame)?;
    let BvhJoint {
        channels,
        offset,
        parent,
        ..
    } = &bvh.joints[joint];
    let policy = policies.into().of_joint_below(*parent);
    let wanted = translation.to_array();
    let mut values = Vec::new();
    for axis in Axis::ALL {
        let place = channels
            .iter()
            .position(|&channel| channel == Channel::Position(axis))
            .filter(|_| policy != PositionPolicy::Ignore);
        let i = axis.index();
        match place {
            Some(place) if policy == PositionPolicy::Add => {
                values.push((place, wanted[i] - offset[i]));
            }
            Some(place) => values.push((place, wanted[i])),
            // Single precision is what poses have.
            None if (wanted[i] - offset[i]).abs() <= 1e-6 * (1.0 + wanted[i].abs()) => {}
            None => {
                return Err(EditError::CannotMove {
                    name: bvh.joints[joint].name().into_owned(),
                    what: match policy {
                        PositionPolicy::Ignore => "its position channels ignored",
                        _ => "no position channels for all axes",
                    },
                });
            }
        }
    }
    let start = bvh.joint_columns(joint).start;
    let row = row_mut(bvh, frame);
    for (place, value) in values {
        row[start + place] = rounded(value);
    }
    Ok(())
}

/// What a joint's channels let it do: a ball joint with three axes, a hinge with one, no turn without any.
/// More than three rotation channels cannot be set, so such a joint is fixed, too.
pub fn joint_limit(joint: &BvhJoint) -> JointLimit {
    let turns = rotation_columns(&joint.channels, 0);
    let axes: Vec<Axis> = turns.into_iter().map(|(_, axis)| axis).collect();
    match (EulerOrder::new(&axes), axes.as_slice()) {
        (Err(_), _) | (_, []) => JointLimit::Fixed,
        (Ok(order), _) if order.is_complete() => JointLimit::Free,
        (Ok(_), [axis]) => JointLimit::Hinge {
            axis: axis.unit(),
            angle_rad: Interval::ALL,
        },
        (Ok(order), _) => JointLimit::Euler {
            order,
            angles_rad: [Interval::ALL; 3],
        },
    }
}

fn check_place(bvh: &Bvh, joint: usize, frame: usize) -> Result<(), EditError> {
    if bvh.motion.is_none() {
        return Err(EditError::NoMotion);
    }
    if joint < bvh.joints.len() && frame < bvh.frame_count() {
        return Ok(());
    }
    Err(EditError::EmptyTrim {
        start: frame,
        end: frame + 1,
        frame_count: bvh.frame_count(),
    })
}

fn row_mut(bvh: &mut Bvh, frame: usize) -> &mut [f64] {
    let channels = bvh.channel_count();
    match &mut bvh.motion {
        Some(motion) => &mut motion.values[frame * channels..(frame + 1) * channels],
        None => &mut [],
    }
}

/// Rounded, and never `-0`.
fn rounded(value: f64) -> f64 {
    (value * DECIMALS_KEPT).round() / DECIMALS_KEPT + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use posekit::rotation::angle_between;

    fn document() -> Bvh {
        crate::bvh::read(
            b"HIERARCHY\nROOT a\n{\nOFFSET 1 2 3\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
              JOINT b\n{\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\nJOINT c\n{\nOFFSET 0 1 0\nCHANNELS 2 Yrotation Xrotation\n\
              End Site\n{\nOFFSET 0 1 0\n}\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n\
              1 2 3 10 20 30 40 50 60\n1 2 3 170.125 20 30 40 50 60\n",
        )
        .unwrap()
        .document
    }

    #[test]
    fn only_the_joint_in_the_frame_changes() {
        let mut bvh = document();
        let before = bvh.clone();
        let rotation = DQuat::from_rotation_z(-3.0) * DQuat::from_rotation_x(0.2);
        let left = set_rotation(&mut bvh, 0, 1, rotation, 1).unwrap();
        assert!(left < 1e-12);
        assert_eq!(bvh.row(0), before.row(0));
        assert_eq!(bvh.row(1)[..3], before.row(1)[..3]);
        assert_eq!(bvh.row(1)[6..], before.row(1)[6..]);
        let angles = [3, 4, 5].map(|column| bvh.row(1)[column].to_radians());
        assert!(angle_between(EulerOrder::ZXY.to_quat(angles), rotation) < 1e-7);
        assert!(
            bvh.row(1)[3] > 170.0,
            "closest to what was there: {:?}",
            bvh.row(1)
        );
    }

    #[test]
    fn channels_bound_what_a_joint_can_do() {
        let mut bvh = document();
        let rotation = DQuat::from_rotation_y(0.5);
        let left = set_rotation(&mut bvh, 1, 0, rotation, 0).unwrap();
        assert!((left - 0.5).abs() < 1e-9 && bvh.row(0)[6] == 0.0);
        assert_eq!(joint_limit(&bvh.joints[0]), JointLimit::Free);
        assert!(matches!(
            joint_limit(&bvh.joints[1]),
            JointLimit::Hinge { axis: DVec3::X, .. }
        ));
        assert!(matches!(
            joint_limit(&bvh.joints[2]),
            JointLimit::Euler { .. }
        ));
        assert_eq!(joint_limit(&bvh.joints[3]), JointLimit::Fixed);
        let moved = set_translation(&mut bvh, 1, 0, DVec3::ONE, PositionPolicy::Replace);
        assert!(matches!(moved, Err(EditError::CannotMove { .. })));
        set_translation(&mut bvh, 0, 0, DVec3::ONE, PositionPolicy::Add).unwrap();
        assert_eq!(bvh.row(0)[..3], [0.0, -1.0, -2.0]);
        let held = set_translation(&mut bvh, 0, 0, DVec3::ONE, PositionPolicy::Ignore);
        assert!(matches!(held, Err(EditError::CannotMove { .. })));
    }
}
