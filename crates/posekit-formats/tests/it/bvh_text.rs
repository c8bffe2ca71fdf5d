//! Small BVH texts for tests, and short ways to read them.

use posekit_formats::bvh::{self, Bvh};
use posekit_formats::report::{Import, Location, Place, ReadError, ReadErrorKind, WarningCode};

/// A sound two-joint file whose rows have four values.
pub(crate) const HEAD: &str = "HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 3 Xposition Zrotation Yrotation
  JOINT Chest
  {
    OFFSET 0 5.5 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 2 0
    }
  }
}
MOTION
";

/// [`HEAD`] with `Frames:` and `Frame Time:`, then rows as given.
pub(crate) fn with_rows(frames: usize, rows: &str) -> String {
    format!("{HEAD}Frames: {frames}\nFrame Time: 0.1\n{rows}")
}

pub(crate) fn import(text: impl AsRef<[u8]>) -> Import<Bvh> {
    bvh::read(text.as_ref()).unwrap()
}

/// The file's values; panics when there is any warning but the expected ones.
pub(crate) fn values_with(text: impl AsRef<[u8]>, expected: &[WarningCode]) -> Vec<f64> {
    let import = import(text);
    assert_codes(&import, expected);
    import.document.motion.unwrap().values
}

/// The codes of the report, each once and sorted, are these.
pub(crate) fn assert_codes(import: &Import<Bvh>, expected: &[WarningCode]) {
    let mut found: Vec<_> = import
        .report
        .warnings
        .iter()
        .map(|warning| warning.code)
        .collect();
    found.sort();
    found.dedup();
    let mut expected = expected.to_vec();
    expected.sort();
    assert_eq!(found, expected, "{:#?}", import.report);
}

/// The code is reported at this line and column, with a message that has these words.
pub(crate) fn assert_at(
    import: &Import<Bvh>,
    code: WarningCode,
    line: usize,
    column: usize,
    words: &str,
) {
    let warning = import
        .report
        .warnings
        .iter()
        .find(|warning| warning.code == code)
        .unwrap();
    let place = Place::Text(Location { line, column });
    assert_eq!(warning.place, place, "{warning}");
    assert!(warning.message.contains(words), "{warning}");
}

/// The line and column of an error.
pub(crate) fn place(error: &ReadError) -> (usize, usize) {
    let location = error.place.location().expect("a place in a text");
    (location.line, location.column)
}

/// The text is refused for this reason, at this place.
pub(crate) fn assert_refused(
    text: impl AsRef<[u8]>,
    kind: ReadErrorKind,
    message: &str,
) -> ReadError {
    let error = bvh::read(text.as_ref()).unwrap_err();
    assert_eq!(error.kind, kind, "{error}");
    assert_eq!(error.to_string(), message);
    error
}
