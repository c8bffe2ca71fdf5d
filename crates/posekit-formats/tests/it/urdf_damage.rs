//! Damaged URDF files: whatever is cut, doubled or overwritten, the reader answers, and what it gives
//! can be used.

use posekit_formats::urdf::{self, UpAxis};
use proptest::prelude::*;

fn sources() -> Vec<Vec<u8>> {
    let golden = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/golden/all_joint_kinds.urdf"
    );
    let mut sources = vec![std::fs::read(golden).unwrap()];
    let samples = urdf::sample::names();
    sources.extend(samples.map(|(name, _)| urdf::sample::by_name(name).unwrap().into()));
    sources
}

fn read_and_use(bytes: &[u8]) {
    let lines = 1 + bytes
        .iter()
        .filter(|byte| matches!(byte, b'\n' | b'\r'))
        .count();
    match urdf::read(bytes) {
        Err(error) => {
            assert!(
                error
                    .place
                    .location()
                    .is_some_and(|at| (1..=lines).contains(&at.line)),
                "{error}"
            );
            assert!(error.to_string().len() < 1000);
        }
        Ok(import) => {
            if let Ok(robot) = import.document.to_robot(UpAxis::Y) {
                let values = vec![0.1; robot.value_count()];
                assert_eq!(
                    robot.global_frames(&values).len(),
                    import.document.links.len()
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_files_are_answered(
        which in 0_usize..4,
        cuts in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..60, any::<u8>()), 1..4),
    ) {
        let mut bytes = sources()[which].clone();
        for (at, length, how) in cuts {
            let start = at.index(bytes.len());
            let end = (start + length).min(bytes.len());
            match how % 4 {
                0 => drop(bytes.drain(start..end)),
                1 => bytes[start..end].fill(how),
                2 => {
                    let again = bytes[start..end].to_vec();
                    bytes.splice(start..start, again);
                }
                _ => bytes.truncate(end.max(1)),
            }
            if bytes.is_empty() {
                break;
            }
        }
        read_and_use(&bytes);
    }

    #[test]
    fn any_text_is_answered(text in "[<>/='\"a-z! &;\\[\\]?-]{0,200}") {
        read_and_use(text.as_bytes());
        read_and_use(format!("<robot>{text}</robot>").as_bytes());
    }
}
