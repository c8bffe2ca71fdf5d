//! The URDF reader on any bytes: it does not panic, its places lie inside the file, and what it reads makes
//! a tree that forward kinematics goes through.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit_formats::report::{WARNINGS_KEPT_PER_CODE, WarningCode};
use posekit_formats::urdf::{self, UpAxis};

fuzz_target!(|bytes: &[u8]| {
    let line_count = 1 + bytes
        .iter()
        .filter(|byte| matches!(byte, b'\n' | b'\r'))
        .count();
    match urdf::read(bytes) {
        Ok(import) => {
            let most = WarningCode::ALL.len() * (WARNINGS_KEPT_PER_CODE + 1);
            assert!(import.report.warnings.len() <= most);
            for warning in &import.report.warnings {
                let location = warning.place.location().expect("a place in a text");
                assert!((1..=line_count).contains(&location.line), "{warning}");
                assert!(warning.message.len() < 1000);
            }
            let document = import.document;
            assert_eq!(document.joints.len() + 1, document.links.len());
            assert_eq!(document.links_from_root().len(), document.links.len());
            // Numbers beyond single precision make no robot, and that is all that may go wrong.
            if let Ok(robot) = document.to_robot(UpAxis::Y) {
                let frames = robot.global_frames(&vec![0.5; robot.value_count()]);
                assert_eq!(frames.len(), document.links.len());
            }
        }
        Err(error) => {
            let location = error.place.location().expect("a place in a text");
            assert!((1..=line_count).contains(&location.line), "{error}");
            assert!(error.to_string().len() < 1000);
        }
    }
});
