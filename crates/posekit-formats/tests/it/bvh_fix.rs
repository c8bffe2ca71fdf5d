//! Repairs: the same motion, written better, and nothing else touched.

use posekit::check::CheckConfig;
use posekit::motion::PositionPolicy;
use posekit_formats::bvh::{self, Bvh, ChangeCode, FixConfig, NameRepair};
use posekit_formats::report::{Import, ImportReport};

use crate::bvh_real_files::files;
use crate::walker::{self, Channels};

/// Positions may differ by this share of the figure's size: what the f32 of poses resolves.
const TOLERANCE: f32 = 1e-6;

fn import(document: Bvh) -> Import<Bvh> {
    Import {
        document,
        report: ImportReport::default(),
    }
}

fn flip_codes(bvh: &Bvh) -> usize {
    let config = CheckConfig::default();
    let policy = PositionPolicy::default();
    let found = bvh::check(bvh, &ImportReport::default(), policy, &config).unwrap();
    found
        .iter()
        .filter(|entry| entry.code == "euler-flip")
        .count()
}

/// Requires the same poses in every frame.
fn assert_same_motion(a: &Bvh, b: &Bvh, name: &str) {
    let (a, b) = (
        a.to_motion(PositionPolicy::default()),
        b.to_motion(PositionPolicy::default()),
    );
    let (a, b) = (a.unwrap(), b.unwrap());
    let (global_a, global_b) = (a.to_global(), b.to_global());
    let (low, high) = global_a.bounds();
    let size = (high - low).max_element().max(low.abs().max_element());
    for frame in 0..a.frame_count() {
        for joint in a.skeleton().joints() {
            let apart = global_a.position(frame, joint) - global_b.position(frame, joint);
            assert!(
                apart.length() <= 2.0 * TOLERANCE * size,
                "{name}: frame {frame}, {apart}"
            );
            let alike = a.rotation(frame, joint).dot(b.rotation(frame, joint)).abs();
            assert!(alike > 1.0 - TOLERANCE, "{name}: frame {frame}, {alike}");
        }
    }
}

#[test]
fn flips_of_real_files_are_unwrapped_without_moving_a_joint() {
    for path in files() {
        let name = path.display().to_string();
        let bytes = std::fs::read(&path).unwrap();
        let import = bvh::read(&bytes).unwrap();
        let fixed = bvh::fix(&bytes, &import, &FixConfig::default()).unwrap();
        let flipping = flip_codes(&import.document);
        let unwrapped = fixed
            .changes
            .iter()
            .filter(|change| change.code == ChangeCode::FlipsUnwrapped);
        assert_eq!(unwrapped.count(), flipping, "{name}");
        assert_eq!(flip_codes(&fixed.document), 0, "{name}");
        assert_same_motion(&import.document, &fixed.document, &name);
        let again = bvh::fix(
            &[],
            &self::import(fixed.document.clone()),
            &FixConfig::default(),
        )
        .unwrap();
        assert!(again.changes.is_empty(), "{name}: {:?}", again.changes);
    }
}

#[test]
fn values_that_no_repair_touches_stay_the_same_to_the_bit() {
    let clean = walker::walk(Channels::Three);
    let untouched = bvh::fix(&[], &import(clean.clone()), &FixConfig::default()).unwrap();
    assert_eq!(untouched.document, clean);
    assert!(untouched.changes.is_empty());

    let columns = clean.channel_count();
    let column = clean.joint_columns(1).start;
    let mut flipped = clean.clone();
    for frame in 40..60 {
        flipped.motion.as_mut().unwrap().values[frame * columns + column] += 360.0;
    }
    let fixed = bvh::fix(&[], &import(flipped.clone()), &FixConfig::default()).unwrap();
    let [change] = fixed.changes.as_slice() else {
        panic!("{:?}", fixed.changes)
    };
    let frames = change.frames.unwrap();
    assert_eq!(
        (change.joint.as_deref(), frames.first, frames.last),
        (Some("Chest"), 40, 59)
    );
    assert_eq!(change.count, 20);
    let values = &fixed.document.motion.as_ref().unwrap().values;
    for (index, (fixed, given)) in values
        .iter()
        .zip(&flipped.motion.unwrap().values)
        .enumerate()
    {
        let (frame, at) = (index / columns, index % columns);
        if (40..60).contains(&frame) && at == column {
            assert!((given - fixed - 360.0).abs() < 1e-9);
        } else {
            assert_eq!(fixed.to_bits(), given.to_bits());
        }
    }
}

#[test]
fn what_the_reader_put_right_is_written_right() {
    let bytes = b"HIERARCHY\r\nROOT a\r\n{\r\nOFFSET 0 0 0\r\nCHANNELS 1 Zrotation\r\n}\r\n\
        MOTION\r\nFrames: 5\r\nFrame Time: 0.1\r\n1\r\n2.25\r\n";
    let import = bvh::read(bytes).unwrap();
    let fixed = bvh::fix(bytes, &import, &FixConfig::default()).unwrap();
    let codes: Vec<&str> = fixed
        .changes
        .iter()
        .map(|change| change.code.code())
        .collect();
    assert_eq!(codes, ["written-right", "line-ends"]);
    let written = bvh::write(&fixed.document);
    assert!(!written.contains(&b'\r'));
    let again = bvh::read(&written).unwrap();
    assert_eq!(again.document, import.document);
    assert!(again.report.first_repair().is_none());
    assert!(
        bvh::fix(&written, &again, &FixConfig::default())
            .unwrap()
            .changes
            .is_empty()
    );
}

#[test]
fn blanks_in_names_become_underscores_on_request_only() {
    let mut document = walker::walk(Channels::Three);
    document.joints[1].name = b"Upper \t Chest".to_vec();
    document.joints[2].name = b"Left Arm".to_vec();
    document.joints[12].name = b"Left_Arm".to_vec();
    let given = import(document);
    assert!(
        bvh::fix(&[], &given, &FixConfig::default())
            .unwrap()
            .changes
            .is_empty()
    );
    let config = FixConfig {
        names: NameRepair::BlanksToUnderscores,
        frame_time_secs: None,
        check: CheckConfig::default(),
    };
    let fixed = bvh::fix(&[], &given, &config).unwrap();
    let codes: Vec<ChangeCode> = fixed.changes.iter().map(|change| change.code).collect();
    assert_eq!(codes, [ChangeCode::NameBlanks, ChangeCode::NameKept]);
    assert_eq!(fixed.document.joints[1].name(), "Upper_Chest");
    assert_eq!(fixed.document.joints[2].name(), "Left Arm");
}
