//! The glTF reader on any bytes, as they are and as the nodes of a file: it does not panic, its warnings are few and
//! short, and what it reads makes a skeleton that forward kinematics goes through and motions within bounds.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit_formats::gltf;
use posekit_formats::report::{WARNINGS_KEPT_PER_CODE, WarningCode};

/// Around the bytes of a case, so that what is inside a file is reached, too.
const BEFORE: &[u8] = b"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"a\"},";
const AFTER: &[u8] = b"],\"buffers\":[{\"byteLength\":64}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":64}]}";

fuzz_target!(|bytes: &[u8]| {
    check(bytes);
    check(&[BEFORE, bytes, AFTER].concat());
});

fn check(bytes: &[u8]) {
    let buffer: Vec<u8> = (0..64_u8).map(|n| n.wrapping_mul(5)).collect();
    match gltf::read_with(bytes, |_| Some(buffer.clone())) {
        Ok(import) => {
            let most = WarningCode::ALL.len() * (WARNINGS_KEPT_PER_CODE + 1);
            assert!(import.report.warnings.len() <= most);
            for warning in &import.report.warnings {
                assert!(warning.place.location().is_none(), "{warning}");
                assert!(warning.to_string().len() < 1000);
            }
            let document = import.document;
            for animation in &document.animations {
                let pose = animation.tracks.sample(0.3);
                let global = pose.to_global(&document.skeleton);
                assert_eq!(global.positions.len(), document.skeleton.joint_count());
                // Long ones are refused; those within bounds would still take this machine's memory.
                if animation.duration_secs() < 100.0 {
                    drop(animation.bake(animation.frames_per_sec()));
                }
            }
        }
        Err(error) => assert!(error.to_string().len() < 1000),
    }
}
