//! The scene reader on any bytes: it does not panic, its places are inside the file, and what it reads
//! is written and read as the same scene.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit_formats::scene;

fuzz_target!(|bytes: &[u8]| {
    match scene::read(bytes) {
        Ok(first) => {
            let written = scene::write(&first).expect("what was read can be written");
            let second = scene::read(&written).expect("what was written reads back");
            assert_eq!(first, second);
            assert_eq!(Ok(written), scene::write(&second), "zeros keep their sign");
        }
        Err(error) => {
            let line_count = 1 + bytes
                .iter()
                .filter(|byte| matches!(byte, b'\n' | b'\r'))
                .count();
            assert!(!error.problems.is_empty());
            for problem in error.problems {
                assert!(
                    (1..=line_count).contains(&problem.location.line),
                    "{problem}"
                );
                assert!(problem.to_string().len() < 4000);
            }
        }
    }
});
