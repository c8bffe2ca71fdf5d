//! Rows of channel values as files have them: any channels in any order, and both policies for
//! OFFSETs. Elementary rotations are multiplied as matrices in double precision to compare with.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Vec3};
use posekit::motion::{
    Channel, ChannelLayout, FrameTime, Motion, PositionPolicies, PositionPolicy,
};
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::Axis;
use posekit::skeleton::{JointId, SkeletonBuilder};
use proptest::prelude::*;

use crate::figures::{angle_rad, any_skeleton, hand_drawn};

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

fn elementary(axis: Axis, degrees: f64) -> DMat3 {
    let angle = degrees.to_radians();
    match axis {
        Axis::X => DMat3::from_rotation_x(angle),
        Axis::Y => DMat3::from_rotation_y(angle),
        Axis::Z => DMat3::from_rotation_z(angle),
    }
}

/// The local rotation and translation that one row gives a joint.
fn expected(
    motion: &Motion,
    layout: &ChannelLayout,
    row: &[f64],
    joint: JointId,
    policies: PositionPolicies,
) -> (DQuat, DVec3) {
    let skeleton = motion.skeleton();
    let offset = skeleton.rest_translation(joint).as_dvec3();
    let policy = match skeleton.parent(joint) {
        None => policies.root,
        Some(_) => policies.others,
    };
    let mut translation = offset;
    let mut rotation = None;
    let columns = layout.columns().iter().zip(row);
    for (&(_, channel), &value) in columns.filter(|((other, _), _)| *other == joint) {
        match channel {
            Channel::Position(axis) => match policy {
                PositionPolicy::Replace => translation[axis.index()] = value,
                PositionPolicy::Add => {
                    translation[axis.index()] = offset[axis.index()] + value;
                }
                PositionPolicy::Ignore => {}
            },
            Channel::Rotation(axis) => {
                rotation = Some(rotation.unwrap_or(DMat3::IDENTITY) * elementary(axis, value));
            }
        }
    }
    let at_rest = skeleton.rest_rotation(joint).as_dquat().normalize();
    (
        rotation.map_or(at_rest, |matrix| DQuat::from_mat3(&matrix)),
        translation,
    )
}

/// Up to seven channels on any joint that is no End Site, in any order, repeats among them.
fn any_layout(joints: Vec<JointId>) -> impl Strategy<Value = ChannelLayout> {
    let channel = (any::<bool>(), 0_usize..3).prop_map(|(moves, axis)| match moves {
        true => Channel::Position(AXES[axis]),
        false => Channel::Rotation(AXES[axis]),
    });
    let columns = proptest::collection::vec((proptest::sample::select(joints), channel), 1..40);
    columns.prop_map(ChannelLayout::new)
}

/// A motion's skeleton, what its columns mean, and whole rows of values.
fn any_rows() -> impl Strategy<Value = (Arc<posekit::skeleton::Skeleton>, ChannelLayout, Vec<f64>)>
{
    any_skeleton().prop_flat_map(|skeleton| {
        let joints = skeleton
            .joints()
            .filter(|&joint| !skeleton.is_end_site(joint));
        any_layout(joints.collect()).prop_flat_map(move |layout| {
            let skeleton = Arc::clone(&skeleton);
            (0_usize..19).prop_flat_map(move |frame_count| {
                let values = frame_count * layout.column_count();
                let rows = proptest::collection::vec(-720.0_f64..720.0, values);
                (Just(Arc::clone(&skeleton)), Just(layout.clone()), rows)
            })
        })
    })
}

proptest! {
    #[test]
    fn every_joint_of_every_frame_is_the_product_of_its_channels(
        (skeleton, layout, rows) in any_rows(),
        root in 0_usize..3,
        others in 0_usize..3,
    ) {
        const POLICIES: [PositionPolicy; 3] =
            [PositionPolicy::Replace, PositionPolicy::Add, PositionPolicy::Ignore];
        let policy = PositionPolicies { root: POLICIES[root], others: POLICIES[others] };
        let motion = Motion::from_channel_rows(Arc::clone(&skeleton), FrameTime::of_fps(25), &layout, &rows, policy).unwrap();
        prop_assert_eq!(motion.frame_count(), rows.len() / layout.column_count());
        for (frame, row) in rows.chunks_exact(layout.column_count()).enumerate() {
            for joint in skeleton.joints() {
                let (rotation, translation) = expected(&motion, &layout, row, joint, policy);
                let angle = angle_rad(motion.rotation(frame, joint), rotation.as_quat());
                prop_assert!(angle < 5e-6, "{} rad at frame {}, {:?}", angle, frame, joint);
                let apart = motion.translation(frame, joint).as_dvec3().distance(translation);
                prop_assert!(apart < 1e-4, "{} apart", apart);
            }
        }
    }

    /// Values after the last whole row are not used.
    #[test]
    fn a_partial_last_row_is_left_out((skeleton, layout, mut rows) in any_rows(), more in 1_usize..40) {
        let whole = rows.len() / layout.column_count();
        rows.extend(std::iter::repeat_n(1.0, more % layout.column_count()));
        let motion = Motion::from_channel_rows(skeleton, FrameTime::of_fps(25), &layout, &rows, PositionPolicy::Replace).unwrap();
        prop_assert_eq!(motion.frame_count(), whole);
    }
}

/// The root of a figure with OFFSET (3, -2, 1), its channels at (10, 20, 30).
fn root_translation(channels: &[Channel], policy: PositionPolicy) -> Vec3 {
    let mut builder = SkeletonBuilder::new();
    let root = builder.joint("root", None, Vec3::new(3.0, -2.0, 1.0));
    let layout = ChannelLayout::new(channels.iter().map(|&channel| (root, channel)));
    let row: Vec<f64> = channels
        .iter()
        .map(|channel| match channel {
            Channel::Position(Axis::X) => 10.0,
            Channel::Position(Axis::Y) => 20.0,
            Channel::Position(Axis::Z) => 30.0,
            Channel::Rotation(_) => 0.0,
        })
        .collect();
    let skeleton = Arc::new(builder.build().unwrap());
    Motion::from_channel_rows(skeleton, FrameTime::of_fps(25), &layout, &row, policy)
        .unwrap()
        .translation(0, root)
}

#[test]
fn channels_replace_the_offset_or_are_added_to_it() {
    let all = AXES.map(Channel::Position);
    let (replace, add) = (PositionPolicy::Replace, PositionPolicy::Add);
    assert_eq!(root_translation(&all, replace), Vec3::new(10.0, 20.0, 30.0));
    assert_eq!(root_translation(&all, add), Vec3::new(13.0, 18.0, 31.0));
    let ignore = PositionPolicy::Ignore;
    assert_eq!(root_translation(&all, ignore), Vec3::new(3.0, -2.0, 1.0));
    // A coordinate without a channel stays at the OFFSET, whatever the policy.
    let two = [Channel::Position(Axis::Z), Channel::Position(Axis::X)];
    assert_eq!(root_translation(&two, replace), Vec3::new(10.0, -2.0, 30.0));
    assert_eq!(root_translation(&two, add), Vec3::new(13.0, -2.0, 31.0));
    let none = [Channel::Rotation(Axis::Z)];
    assert_eq!(root_translation(&none, replace), Vec3::new(3.0, -2.0, 1.0));
    assert_eq!(root_translation(&none, add), Vec3::new(3.0, -2.0, 1.0));
}

#[test]
fn roots_and_other_joints_each_have_their_own_policy() {
    let skeleton = Arc::new(hand_drawn());
    let (foot, prop) = (JointId::new(5), JointId::new(8));
    let offset = |joint| skeleton.rest_translation(joint);
    let layout = ChannelLayout::new([
        (foot, Channel::Position(Axis::Y)),
        (prop, Channel::Position(Axis::X)),
    ]);
    let rows = [-7.0, 7.0];
    let places = |root, others| {
        let policies = PositionPolicies { root, others };
        let motion = Motion::from_channel_rows(
            Arc::clone(&skeleton),
            FrameTime::of_fps(25),
            &layout,
            &rows,
            policies,
        )
        .unwrap();
        (motion.translation(0, foot), motion.translation(0, prop))
    };
    use PositionPolicy::{Add, Ignore, Replace};
    assert_eq!(
        places(Add, Replace),
        (Vec3::new(0.0, -7.0, 0.0), Vec3::new(10.0, 0.0, 0.0))
    );
    assert_eq!(
        places(Replace, Add),
        (offset(foot) + Vec3::Y * -7.0, Vec3::new(7.0, 0.0, 0.0))
    );
    assert_eq!(
        places(Replace, Ignore),
        (offset(foot), Vec3::new(7.0, 0.0, 0.0))
    );
    assert_eq!(places(Ignore, Ignore), (offset(foot), offset(prop)));
}

#[test]
fn angles_of_many_turns_keep_their_precision() {
    let skeleton = Arc::new(hand_drawn());
    let layout = ChannelLayout::new([(JointId::new(0), Channel::Rotation(Axis::Y))]);
    for turns in [1.0, 1e3, 1e6, -1e6] {
        let rows = [30.0 + 360.0 * turns];
        let motion = Motion::from_channel_rows(
            Arc::clone(&skeleton),
            FrameTime::of_fps(25),
            &layout,
            &rows,
            PositionPolicy::Replace,
        )
        .unwrap();
        let expected = glam::Quat::from_rotation_y(30.0_f32.to_radians());
        assert!(
            angle_rad(motion.rotation(0, JointId::new(0)), expected) < 1e-6,
            "{turns} turns"
        );
    }
}

#[test]
fn a_layout_without_columns_makes_no_frames() {
    let layout = ChannelLayout::default();
    let skeleton = Arc::new(hand_drawn());
    let motion = Motion::from_channel_rows(
        skeleton,
        FrameTime::of_fps(25),
        &layout,
        &[1.0, 2.0],
        PositionPolicy::Replace,
    )
    .unwrap();
    assert_eq!(motion.frame_count(), 0);
}

/// What is beyond the range is refused with its place, and a motion that was there stays what it was.
#[test]
fn values_that_no_motion_is_made_of_are_refused_with_their_place() {
    let skeleton = Arc::new(hand_drawn());
    let root = JointId::new(0);
    let layout = ChannelLayout::new([
        (root, Channel::Position(Axis::X)),
        (root, Channel::Rotation(Axis::Y)),
    ]);
    let mut rows = vec![0.5; 2 * 5000];
    let good = Motion::from_channel_rows(
        Arc::clone(&skeleton),
        FrameTime::of_fps(25),
        &layout,
        &rows,
        PositionPolicy::Add,
    )
    .unwrap();
    for value in [
        1e39,
        -1e300,
        LONGEST_LENGTH.next_up(),
        f64::INFINITY,
        f64::NAN,
    ] {
        for (column, channel) in ["Xposition", "Yrotation"].into_iter().enumerate() {
            rows[2 * 4321 + column] = value;
            let mut motion = good.clone();
            let error = motion
                .set_channel_rows(
                    FrameTime::of_fps(50),
                    &layout,
                    &rows,
                    PositionPolicy::Replace,
                )
                .unwrap_err();
            assert_eq!(
                (error.frame, error.column, error.joint),
                (4321, column, root)
            );
            assert_eq!(error.channel.name(), channel);
            assert!(error.to_string().contains("at frame 4321"), "{error}");
            assert_eq!(motion.frame_time(), good.frame_time());
            assert_eq!(motion.translation(4321, root), good.translation(4321, root));
            rows[2 * 4321 + column] = 0.5;
        }
    }
    // As large as it may be: what is made of it is finite, squares too.
    rows[0] = LONGEST_LENGTH;
    rows[1] = -LONGEST_LENGTH;
    let policy = PositionPolicy::Add;
    let motion =
        Motion::from_channel_rows(skeleton, FrameTime::of_fps(25), &layout, &rows, policy).unwrap();
    let global = motion.to_global();
    for joint in global.skeleton().joints() {
        assert!(global.position(0, joint).length_squared().is_finite());
        assert!((global.orientation(0, joint).length() - 1.0).abs() < 1e-5);
    }
}

#[test]
fn the_first_place_that_is_too_far_away_is_found() {
    let skeleton = Arc::new(hand_drawn());
    let (root, child) = (JointId::new(0), JointId::new(1));
    let mut motion = Motion::at_rest(skeleton, 43, FrameTime::of_fps(25), [root, child]);
    assert_eq!(motion.first_out_of_range(), None);
    motion.set_translation(42, root, Vec3::Y * f32::MAX);
    assert_eq!(motion.first_out_of_range(), Some((42, root)));
    motion.set_translation(17, child, Vec3::Z * f32::NAN);
    assert_eq!(motion.first_out_of_range(), Some((17, child)));
    motion.set_translation(16, root, Vec3::X * f32::NEG_INFINITY);
    assert_eq!(motion.first_out_of_range(), Some((16, root)));
}
