//! The BVH reader on any bytes: it does not panic, gives a valid document, says the same with every row
//! parser, keeps its report small and its places inside the file.
#![no_main]

use std::ops::ControlFlow;

use libfuzzer_sys::fuzz_target;
use posekit_formats::bvh::{self, Bvh, ReadOptions, RowParser};
use posekit_formats::report::{Import, ReadError, WARNINGS_KEPT_PER_CODE, WarningCode};

fn read(bytes: &[u8], row_parser: RowParser) -> Result<Import<Bvh>, ReadError> {
    bvh::read_with(
        bytes,
        ReadOptions {
            row_parser,
            ..ReadOptions::default()
        },
        |_| ControlFlow::Continue(()),
    )
}

fuzz_target!(|bytes: &[u8]| {
    let fastest = read(bytes, RowParser::Fastest);
    let careful = read(bytes, RowParser::Careful);
    assert!(fastest == careful && careful == read(bytes, RowParser::Portable));
    let line_count = 1 + bytes
        .iter()
        .filter(|byte| matches!(byte, b'\n' | b'\r'))
        .count();
    match fastest {
        Ok(import) => {
            assert_eq!(import.document.validate(), Ok(()));
            let most = WarningCode::ALL.len() * (WARNINGS_KEPT_PER_CODE + 1);
            assert!(import.report.warnings.len() <= most);
            for warning in import.report.warnings {
                let location = warning.place.location().expect("a place in a text");
                assert!((1..=line_count).contains(&location.line), "{warning}");
                assert!((1..=bytes.len() + 1).contains(&location.column), "{warning}");
                assert!(warning.count >= 1 && warning.message.len() < 1000);
            }
        }
        Err(error) => {
            let location = error.place.location().expect("a place in a text");
            assert!((1..=line_count).contains(&location.line), "{error}");
            assert!(error.to_string().len() < 1000);
        }
    }
});
