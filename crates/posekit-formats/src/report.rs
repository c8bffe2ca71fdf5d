//! What a reader has to say about a file: warnings when it was read, one error when it could not be.
//!
//! A file that needed repair is an outcome with data in it, not an error. Every liberty that a reader
//! takes is a [`Warning`] with a stable [`WarningCode`], a place, what was found and what was done.
//! Repeated warnings are kept in full for the first [`WARNINGS_KEPT_PER_CODE`] of a code; the rest are
//! folded into one more that carries their count, so a report stays small however bad the file.

use std::fmt;

pub use crate::warning_code::{Severity, WarningCode};

/// How many warnings of one code are kept one by one before the rest are only counted.
///
/// Enough to see a pattern (every finger of a hand, say), small enough to read.
pub const WARNINGS_KEPT_PER_CODE: usize = 16;

/// A place in a text file, for people: both numbers count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Location {
    /// The line, counted from 1. A line ends with LF, CRLF or a lone CR.
    pub line: usize,
    /// The byte within the line, counted from 1. A tab is one byte.
    pub column: usize,
}

impl fmt::Display for Location {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "line {}, column {}", self.line, self.column)
    }
}

/// A place in a file of any format, as its readers can name it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Place {
    /// In a text, by line and column.
    Text(Location),
    /// In a binary file, or in one that is broken: the byte, counted from 0.
    Byte(usize),
    /// In JSON, the way to the value: `animations[0].channels[2]`; empty for the whole document.
    Json(String),
}

impl Place {
    /// The line and column, where it has them.
    pub fn location(&self) -> Option<Location> {
        match self {
            Self::Text(location) => Some(*location),
            Self::Byte(_) | Self::Json(_) => None,
        }
    }

    /// What follows a file's name in front of a message: `:12:5: ` in a text, which editors and terminals make a
    /// link of, else `: nodes[3]: `.
    pub fn after_name(&self) -> String {
        match self {
            Self::Text(Location { line, column }) => format!(":{line}:{column}: "),
            Self::Json(path) if path.is_empty() => ": ".to_owned(),
            Self::Byte(_) | Self::Json(_) => format!(": {self}: "),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(location) => location.fmt(out),
            Self::Byte(byte) => write!(out, "byte {byte}"),
            Self::Json(path) if path.is_empty() => out.write_str("the whole document"),
            Self::Json(path) => out.write_str(path),
        }
    }
}

/// Something a reader noticed or repaired.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// What kind of thing it is; stable across versions.
    pub code: WarningCode,
    /// The file it is about, as the one that was read names it; `None` when it is about that one itself.
    pub file: Option<String>,
    /// Where it is in the file.
    pub place: Place,
    /// What was found and what was done about it, lower case, one sentence.
    pub message: String,
    /// How many occurrences this stands for: 1, or more where repeats were folded together. The place
    /// and the message are those of the first.
    pub count: usize,
}

impl fmt::Display for Warning {
    /// `line 12, column 5: the message [its-code]`, the file before it if it is another one, and `(and 40 more)` where
    /// repeats were folded.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.file {
            Some(file) => write!(out, "{file}{}", self.place.after_name())?,
            None => write!(out, "{}: ", self.place)?,
        }
        write!(out, "{} [{}]", self.message, self.code)?;
        if self.count > 1 {
            write!(out, " (and {} more)", self.count - 1)?;
        }
        Ok(())
    }
}

/// Everything a reader noticed about a file that it could read, in the order of discovery.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImportReport {
    /// The warnings and notes. See [`Warning::count`] for repeats.
    pub warnings: Vec<Warning>,
}

impl ImportReport {
    /// Whether nothing at all was noticed.
    pub fn is_empty(&self) -> bool {
        self.warnings.is_empty()
    }

    /// How often a code occurred, folded repeats included.
    pub fn count(&self, code: WarningCode) -> usize {
        self.warnings
            .iter()
            .filter(|warning| warning.code == code)
            .map(|warning| warning.count)
            .sum()
    }

    /// Whether a code occurred.
    pub fn has(&self, code: WarningCode) -> bool {
        self.count(code) > 0
    }

    /// Takes over what was noticed in a file that this one names; what is known already is left out, as when a scene
    /// names a file twice.
    pub fn take_in(&mut self, file: &str, theirs: Self) {
        for warning in theirs.warnings {
            let warning = Warning {
                file: Some(warning.file.unwrap_or_else(|| file.to_owned())),
                ..warning
            };
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// The first warning that means the file is wrong, not merely unusual: what `--strict` reports.
    pub fn first_repair(&self) -> Option<&Warning> {
        self.warnings
            .iter()
            .find(|warning| warning.code.severity() == Severity::Warning)
    }
}

/// A document and what was noticed while it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Import<T> {
    /// The file's content.
    pub document: T,
    /// What the reader noticed and repaired.
    pub report: ImportReport,
}

/// Why a file could not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ReadErrorKind {
    /// The file holds nothing but blanks.
    Empty,
    /// The file is not text: it has NUL bytes, or is UTF-16.
    NotText,
    /// Something else stands where the format demands a certain thing.
    Unexpected,
    /// A number is `nan`, `inf` or too large for a double.
    NotFinite,
    /// A length is so large that nothing can be made of it.
    OutOfRange,
    /// A channel has a name nobody knows.
    UnknownChannel,
    /// The file ends, or the motion begins, inside a joint.
    UnclosedBrace,
    /// The file promises more frames than its bytes could hold.
    ImpossibleFrameCount,
    /// Joints are nested deeper, are more, or have longer names than the reader's documented limits.
    LimitExceeded,
    /// Two things have one name, where names tell things apart.
    DuplicateName,
    /// A name refers to something that is not there.
    UnknownName,
    /// Things that must form a tree do not: a cycle, several roots, two parents.
    NotATree,
    /// The file needs an extension of its format that is not read.
    UnknownExtension,
    /// The caller asked to stop.
    Cancelled,
}

/// The one error of a file that could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: expected {expected}, found {found}")]
pub struct ReadError {
    /// What kind of error it is.
    pub kind: ReadErrorKind,
    /// Where it is.
    pub place: Place,
    /// What the format wants there.
    pub expected: String,
    /// What is there instead; a quotation is in backquotes and shortened.
    pub found: String,
}

/// Gathers warnings and folds repeats.
#[derive(Clone, Debug)]
pub(crate) struct Gathered {
    report: ImportReport,
    /// Per code, in the order of [`WarningCode::ALL`]: occurrences so far, and where the folded one is.
    seen: Vec<(usize, usize)>,
}

impl Gathered {
    pub(crate) fn new() -> Self {
        Self {
            report: ImportReport::default(),
            seen: vec![(0, 0); WarningCode::ALL.len()],
        }
    }

    /// Notes an occurrence; place and message are only made when they are kept.
    pub(crate) fn add(
        &mut self,
        code: WarningCode,
        place: impl FnOnce() -> Place,
        message: impl FnOnce() -> String,
    ) {
        let (occurrences, folded_at) = self.seen[code as usize];
        if occurrences > WARNINGS_KEPT_PER_CODE {
            self.report.warnings[folded_at].count += 1;
        } else {
            self.seen[code as usize].1 = self.report.warnings.len();
            self.report.warnings.push(Warning {
                code,
                file: None,
                place: place(),
                message: message(),
                count: 1,
            });
        }
        self.seen[code as usize].0 += 1;
    }

    /// The report, its work done.
    pub(crate) fn finish(self) -> ImportReport {
        self.report
    }
}

/// Gathers warnings while a reader walks over the bytes of a text, and turns byte offsets into lines and columns only
/// for those that are kept.
#[derive(Clone, Debug)]
pub(crate) struct Reporter<'a> {
    lines: Lines<'a>,
    gathered: Gathered,
}

/// Where the lines of a text are.
#[derive(Clone, Debug)]
struct Lines<'a> {
    bytes: &'a [u8],
    /// The last place that was located: offset, line, offset of the line's first byte.
    mark: (usize, usize, usize),
}

impl Lines<'_> {
    fn locate(&mut self, at: usize) -> Location {
        let at = at.min(self.bytes.len());
        if at < self.mark.0 {
            self.mark = (0, 1, 0);
        }
        let (from, mut line, mut line_start) = self.mark;
        for end in memchr::memchr2_iter(b'\n', b'\r', &self.bytes[from..at]) {
            let next = from + end + 1;
            let is_first_half_of_crlf =
                self.bytes[next - 1] == b'\r' && self.bytes.get(next) == Some(&b'\n');
            if !is_first_half_of_crlf {
                line += 1;
                line_start = next;
            }
        }
        self.mark = (at, line, line_start);
        Location {
            line,
            column: at - line_start + 1,
        }
    }
}

impl<'a> Reporter<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self {
            lines: Lines {
                bytes,
                mark: (0, 1, 0),
            },
            gathered: Gathered::new(),
        }
    }

    /// Notes an occurrence at a byte offset; the message is only made when it is kept.
    pub(crate) fn warn(&mut self, code: WarningCode, at: usize, message: impl FnOnce() -> String) {
        let lines = &mut self.lines;
        let place = || Place::Text(lines.locate(at));
        self.gathered.add(code, place, message);
    }

    /// The line and column of a byte offset. Cheap when offsets rise.
    pub(crate) fn locate(&mut self, at: usize) -> Location {
        self.lines.locate(at)
    }

    /// The error at a byte offset.
    pub(crate) fn error(
        &mut self,
        kind: ReadErrorKind,
        at: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        ReadError {
            kind,
            place: Place::Text(self.locate(at)),
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// The error for something else than what the format demands, at a byte offset.
    pub(crate) fn unexpected(
        &mut self,
        at: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        self.error(ReadErrorKind::Unexpected, at, expected, found)
    }

    /// The report, its work done.
    pub(crate) fn finish(self) -> ImportReport {
        self.gathered.finish()
    }
}

/// A piece of a file as a message quotes it: in backquotes, shortened, without control characters.
pub(crate) fn quote(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    let shown = &bytes[..bytes.len().min(LONGEST)];
    let text: String = String::from_utf8_lossy(shown)
        .chars()
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    let more = if bytes.len() > LONGEST { "..." } else { "" };
    format!("`{text}{more}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_with_lf_crlf_or_cr() {
        let mut reporter = Reporter::new(b"a\nb\r\nc\rd");
        let places: Vec<_> = [0, 2, 5, 7, 2].map(|at| reporter.locate(at).line).into();
        assert_eq!(places, [1, 2, 3, 4, 2]);
        assert_eq!(reporter.locate(8), Location { line: 4, column: 2 });
        assert_eq!(reporter.locate(99), Location { line: 4, column: 2 });
    }

    #[test]
    fn a_place_between_cr_and_lf_is_still_on_the_old_line() {
        let mut reporter = Reporter::new(b"a\r\nb");
        assert_eq!(reporter.locate(2), Location { line: 1, column: 3 });
        assert_eq!(reporter.locate(3), Location { line: 2, column: 1 });
    }

    #[test]
    fn repeats_are_folded_and_counted() {
        let mut reporter = Reporter::new(b"x");
        for _ in 0..1000 {
            reporter.warn(WarningCode::GluedNumbers, 0, || "again".into());
        }
        let report = reporter.finish();
        assert_eq!(report.warnings.len(), WARNINGS_KEPT_PER_CODE + 1);
        assert_eq!(report.count(WarningCode::GluedNumbers), 1000);
        assert!(
            report
                .warnings
                .last()
                .is_some_and(|w| w.to_string().contains("more)"))
        );
    }

    #[test]
    fn what_was_noticed_in_a_named_file_is_taken_in_once_with_its_name() {
        let mut gathered = Gathered::new();
        let place = || Place::Json("buffers[0]".to_owned());
        gathered.add(WarningCode::MissingBuffer, place, || "it is missing".into());
        let theirs = gathered.finish();
        let mut report = ImportReport::default();
        report.take_in("rig.gltf", theirs.clone());
        report.take_in("rig.gltf", theirs);
        let shown: Vec<_> = report.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            shown,
            ["rig.gltf: buffers[0]: it is missing [missing-buffer]"]
        );
    }

    #[test]
    fn places_are_told_as_their_format_has_them() {
        let text = Place::Text(Location { line: 3, column: 7 });
        assert_eq!(text.after_name(), ":3:7: ");
        assert_eq!(Place::Byte(12).after_name(), ": byte 12: ");
        assert_eq!(Place::Json(String::new()).after_name(), ": ");
        assert_eq!(Place::Json("nodes[1]".into()).to_string(), "nodes[1]");
    }

    #[test]
    fn quotations_are_short_and_printable() {
        assert_eq!(quote(b"a\x07b\xff"), "`a\u{fffd}b\u{fffd}`");
        assert!(quote(&[b'x'; 500]).len() < 60);
    }
}
