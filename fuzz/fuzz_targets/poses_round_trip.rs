//! The reader of saved poses on any bytes: it does not panic, its places are inside the file, and what it
//! reads is written and read as the same poses.
#![no_main]

use libfuzzer_sys::fuzz_target;
use posekit_formats::poses;

fuzz_target!(|bytes: &[u8]| match poses::read(bytes) {
    Ok(first) => {
        let written = poses::write(&first);
        let second = poses::read(&written).expect("what was written reads back");
        assert_eq!(first, second);
        assert_eq!(written, poses::write(&second));
    }
    Err(error) => {
        let is_break = |byte: &&u8| matches!(byte, b'\n' | b'\r');
        let line_count = 1 + bytes.iter().filter(is_break).count();
        assert!(!error.problems.is_empty());
        for problem in error.problems {
            let line = problem.location.line;
            assert!((1..=line_count).contains(&line), "{problem}");
            assert!(problem.to_string().len() < 4000);
        }
    }
});
