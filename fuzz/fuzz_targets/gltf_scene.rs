//! A scene that plays a glTF file, as the command reads it: any bytes as that file make no panic, and what is read
//! is sampled, baked within bounds, written as BVH and read back with as many joints and frames.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit::rotation::EulerOrder;
use posekit_formats::bvh::{self, Bvh};
use posekit_formats::report::{ImportReport, WARNINGS_KEPT_PER_CODE, WarningCode};
use posekit_formats::scene::{self, MotionFileError, Shot};

const SCENE: &str = "format = \"posekit scene\"
version = 1
range_secs = [0, 1]
frames_per_sec = 4
skeleton = { file = \"rig.glb\" }
motion = [{ file = \"rig.glb\" }, { file = \"rig.glb#B\", start_secs = 0.5, clip_secs = [0.1, 3] }]
";

/// The same without the second motion, whose animation few files have.
const ONE_MOTION: &str = "format = \"posekit scene\"
version = 1
range_secs = [0, 1]
frames_per_sec = 4
skeleton = { file = \"rig.glb\" }
motion = [{ file = \"rig.glb\" }]
";

/// A scene takes longer to bake than to read: frames times joints of a case.
const MOST_BAKED: usize = 20_000;

fuzz_target!(|bytes: &[u8]| {
    for text in [SCENE, ONE_MOTION] {
        check(text, bytes);
    }
});

fn check(text: &str, bytes: &[u8]) {
    let scene = scene::read(text.as_bytes()).expect("the scene is right");
    let buffer: Vec<u8> = (0..64_u8).map(|n| n.wrapping_mul(5)).collect();
    let mut report = ImportReport::default();
    let shot = Shot::new(&scene, |named| {
        let import = scene::import_of(named, scene.role_of(named), |file| match file {
            "rig.glb" => Ok(bytes.to_vec()),
            _ => Ok(buffer.clone()),
        })?;
        report.take_in("rig.glb", import.report);
        Ok::<_, MotionFileError>(import.document)
    });
    match shot {
        Ok(shot) => {
            let most = 2 * WarningCode::ALL.len() * (WARNINGS_KEPT_PER_CODE + 1);
            assert!(report.warnings.len() <= most);
            let frames = 5;
            if shot.skeleton().joint_count() * frames > MOST_BAKED {
                return;
            }
            let motion = shot.bake(None);
            assert_eq!(motion.frame_count(), frames);
            let written = Bvh::from_motion(&motion, EulerOrder::ZXY);
            // Keys near the end of single precision may leave it when they are scaled or between each other.
            let is_finite = |pose: posekit::pose::LocalPose| {
                pose.translations.iter().all(|v| v.is_finite())
                    && pose.rotations.iter().all(|q| q.is_finite())
            };
            if (0..frames).all(|frame| is_finite(motion.pose(frame))) {
                let again = bvh::read(&bvh::write(&written)).expect("what was written reads back");
                assert_eq!(again.document.frame_count(), frames);
                assert_eq!(again.document.joints.len(), written.joints.len());
            }
        }
        Err(error) => assert!(error.to_string().len() < 4000),
    }
}
