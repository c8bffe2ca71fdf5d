//! Each edit against what it promises to keep.

use posekit::motion::{Channel, PositionPolicy};
use posekit::rotation::{Axis, EulerOrder, angle_between};
use posekit::skeleton::JointId;
use proptest::prelude::*;

use super::*;
use crate::bvh::{Bvh, read};

/// A root with six channels, a joint with three, one with one, and an End Site.
fn document(rows: &str, frame_count: usize) -> Bvh {
    let text = format!(
        "HIERARCHY ROOT a {{ OFFSET 0 1 0 CHANNELS 6 Zrotation Xrotation Yrotation Xposition Yposition \
         Zposition JOINT b {{ OFFSET 0 93.9241 0.5 CHANNELS 3 Zrotation Xrotation Yrotation JOINT c {{ \
         OFFSET 0 1 0 CHANNELS 1 Xrotation End Site {{ OFFSET 0 1 0 }} }} }} }}\n\
         MOTION\nFrames: {frame_count}\nFrame Time: 0.0333333\n{rows}\n"
    );
    let import = read(text.as_bytes()).unwrap();
    import.document.validate().unwrap();
    import.document
}

fn one_frame(values: &[f64]) -> Bvh {
    let row: Vec<String> = values.iter().map(f64::to_string).collect();
    document(&row.join(" "), 1)
}

/// The largest distance between joints of the same index over all frames.
fn gap(a: &Bvh, b: &Bvh) -> f32 {
    let global = |bvh: &Bvh| bvh.to_motion(PositionPolicy::Replace).unwrap().to_global();
    let (a, b) = (global(a), global(b));
    let frames = 0..a.frame_count();
    let joints: Vec<JointId> = a.skeleton().joints().collect();
    let gaps = frames.flat_map(|frame| {
        let (a, b) = (&a, &b);
        joints
            .iter()
            .map(move |&joint| a.position(frame, joint).distance(b.position(frame, joint)))
    });
    gaps.fold(0.0, f32::max)
}

proptest! {
    #[test]
    fn another_rotation_order_makes_the_same_poses(
        values in proptest::collection::vec(-400.0..400.0f64, 10),
        order in proptest::sample::select(vec![
            EulerOrder::XYZ, EulerOrder::XZY, EulerOrder::YXZ, EulerOrder::YZX, EulerOrder::ZYX,
        ]),
    ) {
        let before = one_frame(&values);
        let mut after = before.clone();
        set_rotation_order(&mut after, order).unwrap();
        after.validate().unwrap();
        prop_assert_eq!(after.joints[2].channels.clone(), vec![Channel::Rotation(Axis::X)]);
        // Positions and the joint of one channel keep their bits.
        prop_assert_eq!(&after.row(0)[3..6], &before.row(0)[3..6]);
        prop_assert_eq!(after.row(0)[9], before.row(0)[9]);
        prop_assert!(gap(&before, &after) < 1e-3, "{}", gap(&before, &after));
    }

    #[test]
    fn six_channels_and_back_is_the_same_document(
        values in proptest::collection::vec(-400.0..400.0f64, 10),
    ) {
        let before = one_frame(&values);
        let mut after = before.clone();
        set_channels(&mut after, ChannelSet::PositionsAndRotations);
        after.validate().unwrap();
        prop_assert_eq!(after.channel_count(), 18);
        prop_assert!(gap(&before, &after) < 1e-4);
        let kept = set_channels(&mut after, ChannelSet::RotationsAndMovingRoots);
        prop_assert!(kept.is_empty());
        prop_assert_eq!(&after.row(0)[..9], &before.row(0)[..9]);
        prop_assert!(gap(&before, &after) < 1e-4);
    }

    #[test]
    fn turning_up_and_back_is_the_same_document(
        values in proptest::collection::vec(-400.0..400.0f64, 10),
    ) {
        let before = one_frame(&values);
        let mut after = before.clone();
        turn_up(&mut after, UpAxis::Y, UpAxis::Z);
        let place = |bvh: &Bvh| {
            let global = bvh.to_motion(PositionPolicy::Replace).unwrap().to_global();
            global.position(0, JointId::new(3))
        };
        let (y_up, z_up) = (place(&before), place(&after));
        prop_assert!(z_up.distance(glam::Vec3::new(y_up.x, -y_up.z, y_up.y)) < 1e-3);
        turn_up(&mut after, UpAxis::Z, UpAxis::Y);
        prop_assert_eq!(after, before);
    }
}

#[test]
fn a_joint_that_moves_keeps_its_position_channels() {
    let mut bvh = document("0 0 0 1 2 3 0 0 0 0\n0 0 0 4 5 6 0 0 0 0", 2);
    set_channels(&mut bvh, ChannelSet::PositionsAndRotations);
    let before = bvh.clone();
    // Joint b slides along X by a length that is no rounding.
    let columns = bvh.joint_columns(1);
    let width = bvh.channel_count();
    bvh.motion.as_mut().unwrap().values[width + columns.start] = 2.5;
    let mut after = bvh.clone();
    let kept = set_channels(&mut after, ChannelSet::RotationsAndMovingRoots);
    assert_eq!(
        kept,
        [KeptTranslation {
            joint: 1,
            range: 2.5
        }]
    );
    assert_eq!(gap(&bvh, &after), 0.0);
    assert!(gap(&before, &after) > 2.0);
}

#[test]
fn a_factor_that_is_one_over_a_number_divides() {
    let mut bvh = document("10 20 30 93.9241 2 3 0 0 0 45", 1);
    scale(&mut bvh, 0.01).unwrap();
    assert_eq!(bvh.joints[1].offset, [0.0, 0.939241, 0.005]);
    assert_eq!(
        bvh.row(0),
        [10.0, 20.0, 30.0, 0.939241, 0.02, 0.03, 0.0, 0.0, 0.0, 45.0]
    );
    for factor in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::MAX] {
        let before = bvh.clone();
        assert!(
            scale(&mut bvh, factor).is_err() || factor == f64::MAX,
            "{factor}"
        );
        if factor != f64::MAX {
            assert_eq!(bvh, before);
        }
    }
    assert!(bvh.validate().is_ok());
}

#[test]
fn half_the_rate_is_every_other_row_to_the_bit() {
    let rows: Vec<String> = (0..9)
        .map(|i| format!("{}.1 0 0 {i} 0 0 179.{i} 0 0 0", i * 50))
        .collect();
    let before = document(&rows.join("\n"), 9);
    let mut after = before.clone();
    resample(&mut after, 15.0).unwrap();
    assert_eq!(after.frame_count(), 5);
    for frame in 0..5 {
        assert_eq!(after.row(frame), before.row(2 * frame));
    }
    // 0.0333333 s is 30 frames a second: nothing to do, not even to the frame time.
    let mut same = before.clone();
    resample(&mut same, 30.0).unwrap();
    assert_eq!(same, before);
}

#[test]
fn between_frames_angles_go_the_short_way_without_flips() {
    // The root's Z angle wraps from 170 to -170 and the single channel of c from 179 to -179.
    let before = document(
        "170 0 0 0 0 0 0 0 0 179\n-170 0 0 1 0 0 0 0 0 -179\n-150 0 0 2 0 0 0 0 0 -177",
        3,
    );
    let mut after = before.clone();
    resample(&mut after, 120.0).unwrap();
    after.validate().unwrap();
    assert_eq!(after.frame_count(), 9);
    let zs: Vec<f64> = after.rows().map(|row| row[0]).collect();
    let cs: Vec<f64> = after.rows().map(|row| row[9]).collect();
    for (index, (z, c)) in (0u32..).zip(zs.iter().zip(&cs)) {
        assert!(
            (z - (170.0 + 5.0 * f64::from(index))).abs() < 1e-9,
            "{zs:?}"
        );
        assert!(
            (c - (179.0 + 0.5 * f64::from(index))).abs() < 1e-9,
            "{cs:?}"
        );
    }
    assert_eq!(after.row(2)[3], 0.5);
}

#[test]
fn between_frames_a_turn_is_even() {
    let before = document("0 0 0 0 0 0 0 0 0 0\n80 -60 40 0 0 0 0 0 0 0", 2);
    let mut after = before.clone();
    resample(&mut after, 90.0).unwrap();
    let turn = |row: &[f64]| EulerOrder::ZXY.to_quat([row[0], row[1], row[2]].map(f64::to_radians));
    let steps: Vec<f64> = (0..3)
        .map(|frame| angle_between(turn(after.row(frame)), turn(after.row(frame + 1))))
        .collect();
    assert!(
        (steps[0] - steps[1]).abs() < 1e-9 && (steps[1] - steps[2]).abs() < 1e-9,
        "{steps:?}"
    );
}

#[test]
fn what_cannot_be_done_says_why_and_changes_nothing() {
    let before = document("0 0 0 0 0 0 0 0 0 0", 1);
    let mut bvh = before.clone();
    assert!(matches!(
        resample(&mut bvh, 0.0),
        Err(EditError::BadRate { .. })
    ));
    assert!(matches!(
        resample(&mut bvh, f64::NAN),
        Err(EditError::BadRate { .. })
    ));
    assert!(matches!(
        trim(&mut bvh, 1..5),
        Err(EditError::EmptyTrim { .. })
    ));
    assert!(matches!(
        rename(&mut bvh, "x", "y"),
        Err(EditError::NoSuchJoint { .. })
    ));
    assert!(matches!(
        rename(&mut bvh, "a", "{"),
        Err(EditError::BadName { .. })
    ));
    let order = EulerOrder::new(&[Axis::X, Axis::Y]).unwrap();
    assert_eq!(
        set_rotation_order(&mut bvh, order),
        Err(EditError::IncompleteOrder)
    );
    assert_eq!(bvh, before);
    bvh.motion = None;
    assert_eq!(resample(&mut bvh, 30.0), Err(EditError::NoMotion));
    assert_eq!(trim(&mut bvh, 0..1), Err(EditError::NoMotion));
}

#[test]
fn the_up_axis_is_where_the_figure_stands() {
    let mut bvh = document("0 0 0 0 0 0 0 0 0 0", 1);
    assert_eq!(guess_up_axis(&bvh), Some(UpAxis::Y));
    turn_up(&mut bvh, UpAxis::Y, UpAxis::Z);
    assert_eq!(guess_up_axis(&bvh), Some(UpAxis::Z));
    let flat = document("0 0 90 0 0 0 0 0 0 0", 1);
    let mut lying = flat.clone();
    lying.joints[1].offset = [5.0, 0.0, 0.0];
    lying.joints[2].offset = [5.0, 0.0, 0.0];
    lying.joints[3].offset = [5.0, 0.1, 0.1];
    lying.motion = None;
    assert_eq!(guess_up_axis(&lying), None);
}
