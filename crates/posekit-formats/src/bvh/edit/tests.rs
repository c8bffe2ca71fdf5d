//! Each edit against what it promises to keep.

use posekit::figure::{UpAxis, UpEvidence};
use posekit::motion::{Channel, PositionPolicies, PositionPolicy};
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
        Err(EditError::FrameTime(_))
    ));
    assert!(matches!(
        resample(&mut bvh, f64::NAN),
        Err(EditError::FrameTime(_))
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
    let guess = |bvh: &Bvh| guess_up_axis(bvh).map(|guess| (guess.up, guess.evidence));
    assert_eq!(guess(&bvh), Some((UpAxis::Y, UpEvidence::Extent)));
    turn_up(&mut bvh, UpAxis::Y, UpAxis::Z);
    assert_eq!(guess(&bvh), Some((UpAxis::Z, UpEvidence::Extent)));
    let flat = document("0 0 90 0 0 0 0 0 0 0", 1);
    let mut lying = flat.clone();
    lying.joints[1].offset = [5.0, 0.0, 0.0];
    lying.joints[2].offset = [5.0, 0.0, 0.0];
    lying.joints[3].offset = [5.0, 0.1, 0.1];
    lying.motion = None;
    assert_eq!(guess_up_axis(&lying), None);
}

fn names(bvh: &Bvh) -> Vec<String> {
    bvh.joints
        .iter()
        .map(|joint| joint.name().into_owned())
        .collect()
}

#[test]
fn a_pattern_renames_every_joint_that_it_fits() {
    let plain = document("0 0 0 0 0 0 0 0 0 0", 1);
    let with = |names: [&str; 3]| {
        let mut bvh = plain.clone();
        for (joint, name) in bvh.joints.iter_mut().zip(names) {
            joint.name = name.into();
        }
        bvh.joints[3].name = format!("{}_end", names[2]).into();
        bvh
    };
    let prefixed = ["rig:Hips", "rig:left:Leg", "Tail"];
    for (from, to, wanted) in [
        ("rig:*", "*", ["Hips", "left:Leg", "Tail"]),
        ("*:*", "*", ["Hips", "left:Leg", "Tail"]),
        (
            "*",
            "rig_*",
            ["rig_rig:Hips", "rig_rig:left:Leg", "rig_Tail"],
        ),
        ("*:*:*", "*_*_*", ["rig:Hips", "rig_left_Leg", "Tail"]),
        ("*e*", "*E*", ["rig:Hips", "rig:lEft:Leg", "Tail"]),
        ("rig:*s", "*", ["Hip", "rig:left:Leg", "Tail"]),
    ] {
        let mut bvh = with(prefixed);
        rename(&mut bvh, from, to).unwrap();
        let end = format!("{}_end", wanted[2]);
        assert_eq!(
            names(&bvh),
            [wanted[0], wanted[1], wanted[2], &end],
            "{from}={to}"
        );
    }
    let refused = |bvh: &Bvh, from, to| {
        let mut after = bvh.clone();
        let error = rename(&mut after, from, to).unwrap_err();
        assert_eq!(&after, bvh);
        error
    };
    let bvh = with(["l:Leg", "r:Leg", "Tail"]);
    let error = refused(&bvh, "*:*", "*");
    assert!(matches!(error, EditError::MergedNames { name } if name == "Leg"));
    let error = refused(&bvh, "l:*", "Tail");
    assert!(matches!(error, EditError::MergedNames { .. }));
    let error = refused(&bvh, "l:Leg", "Tail");
    assert!(matches!(error, EditError::MergedNames { name } if name == "Tail"));
    assert!(matches!(
        refused(&bvh, "q*", "*"),
        EditError::NoSuchJoint { .. }
    ));
    assert!(matches!(
        refused(&bvh, "l:*", "*_*"),
        EditError::TooManyStars { .. }
    ));
    assert!(matches!(
        refused(&bvh, "Tail*", "*"),
        EditError::BadName { .. }
    ));
    // A star in a name is a letter of it.
    let mut starred = with(["a*", "ab", "Tail"]);
    rename(&mut starred, "a*", "root").unwrap();
    assert_eq!(names(&starred)[..2], ["root", "ab"]);
}

#[test]
fn a_named_end_site_is_renamed_by_its_own_name() {
    let mut bvh = document("0 0 0 0 0 0 0 0 0 0", 1);
    bvh.joints[3].name = b"tip".to_vec();
    bvh.joints[3].end_name = crate::bvh::EndName::Comment;
    rename(&mut bvh, "c", "hand").unwrap();
    assert_eq!(names(&bvh)[2..], ["hand", "tip"]);
    rename(&mut bvh, "tip", "finger").unwrap();
    assert_eq!(names(&bvh)[2..], ["hand", "finger"]);
}

#[test]
fn a_frame_time_is_set_and_no_value_changes() {
    let before = document("0 0 0 0 0 0 0 0 0 0", 1);
    let mut bvh = before.clone();
    set_frame_time(&mut bvh, 0.01).unwrap();
    assert_eq!(bvh.motion.as_ref().unwrap().frame_time_secs, 0.01);
    assert_eq!(bvh.row(0), before.row(0));
    for secs in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-320] {
        let refused = set_frame_time(&mut bvh, secs);
        assert!(matches!(refused, Err(EditError::FrameTime(_))), "{secs}");
    }
}

/// OFFSETs of zero and places in the channels, which rounding makes tremble: the size of the figure is
/// that of its first frame.
#[test]
fn places_in_the_channels_of_a_figure_without_offsets_become_its_offsets() {
    let text = |noise: f64| {
        format!(
            "HIERARCHY ROOT a {{ OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation \
             Yrotation JOINT b {{ OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation \
             Yrotation End Site {{ OFFSET 0 0 0 }} }} }}\nMOTION\nFrames: 2\nFrame Time: 0.1\n\
             0 90 0 0 0 0 0 50 0 0 0 0\n5 90 0 0 0 0 {noise} 50 0 0 0 0\n"
        )
    };
    for noise in [0.0, 0.004] {
        let mut bvh = read(text(noise).as_bytes()).unwrap().document;
        let kept = set_channels(&mut bvh, ChannelSet::RotationsAndMovingRoots);
        assert_eq!(kept, []);
        assert_eq!(bvh.joints[1].offset, [0.0, 50.0, 0.0]);
        assert_eq!(bvh.joints[1].channels.len(), 3);
    }
    let mut moving = read(text(0.006).as_bytes()).unwrap().document;
    let kept = set_channels(&mut moving, ChannelSet::RotationsAndMovingRoots);
    assert_eq!(kept.len(), 1);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases");
    for name in ["zero_offsets.bvh", "zero_offsets_noise.bvh"] {
        let Ok(bytes) = std::fs::read(path.join(name)) else {
            return;
        };
        let mut bvh = read(&bytes).unwrap().document;
        let before = bvh.clone();
        assert_eq!(
            set_channels(&mut bvh, ChannelSet::RotationsAndMovingRoots),
            []
        );
        assert!(gap(&before, &bvh) < 2e-5, "{}", gap(&before, &bvh));
    }
}

/// Held against the turn as a quaternion, on a frame with every channel in use.
#[test]
fn every_pair_of_up_axes_turns_the_figure_from_one_to_the_other() {
    let before = one_frame(&[12.0, -30.0, 71.0, 3.0, -4.0, 5.0, 9.0, 33.0, -8.0, 20.0]);
    let places = |bvh: &Bvh| {
        let global = bvh
            .to_motion(PositionPolicies::default())
            .unwrap()
            .to_global();
        let joints: Vec<JointId> = global.skeleton().joints().collect();
        joints
            .iter()
            .map(|&joint| global.position(0, joint))
            .collect::<Vec<_>>()
    };
    for from in UpAxis::ALL {
        for to in UpAxis::ALL {
            let mut after = before.clone();
            turn_up(&mut after, from, to);
            let (old, new) = (places(&before), places(&after));
            for (old, new) in old.iter().zip(&new) {
                let height = |place: glam::Vec3, up: UpAxis| place.dot(up.unit());
                assert!(
                    (height(*old, from) - height(*new, to)).abs() < 1e-4,
                    "{from} to {to}"
                );
            }
            // A rotation and no mirror image: the volume that three bones span keeps its sign.
            let volume = |places: &[glam::Vec3]| {
                let [a, b, c] = [1, 2, 3].map(|i| places[i] - places[0]);
                a.cross(b).dot(c)
            };
            assert!((volume(&old) - volume(&new)).abs() < 1e-2, "{from} to {to}");
            turn_up(&mut after, to, from);
            assert_eq!(places(&after).len(), old.len());
        }
    }
    let mut stood = before.clone();
    turn_up(&mut stood, UpAxis::Z, UpAxis::Y);
    let turned = before.to_motion(PositionPolicies::default()).unwrap();
    let turned = turned.turned(UpAxis::Z.y_up_from_file()).to_global();
    for (joint, place) in turned.skeleton().joints().zip(places(&stood)) {
        assert!(turned.position(0, joint).distance(place) < 1e-4);
    }
}

#[test]
fn settled_positions_are_places_that_make_the_same_motion() {
    use posekit::motion::PositionPolicy::{Add, Ignore, Replace};
    let before = document("1 2 3 10.1 20.2 30.3 4 5 6 7", 1);
    for (root, others) in [(Add, Replace), (Ignore, Ignore), (Replace, Add), (Add, Add)] {
        let policies = PositionPolicies { root, others };
        let mut after = before.clone();
        // A joint below the root with a position channel of its own.
        set_channels(&mut after, ChannelSet::PositionsAndRotations);
        let meant = after.to_motion(policies).unwrap().to_global();
        settle_positions(&mut after, policies);
        let read = after.to_motion(Replace).unwrap().to_global();
        for joint in meant.skeleton().joints() {
            let gap = meant.position(0, joint).distance(read.position(0, joint));
            assert!(gap < 1e-4, "{root:?} {others:?}: {gap}");
        }
    }
    let mut added = before.clone();
    settle_positions(
        &mut added,
        PositionPolicies {
            root: Add,
            others: Replace,
        },
    );
    assert_eq!(added.row(0)[3..6], [10.1, 21.2, 30.3]);
    assert_eq!(added.joints, before.joints);
}
