//! A scene from text.

pub(crate) mod fields;
mod parts;
mod tracks;

use std::fmt;
use std::ops::Range;

use toml::de::DeTable;

use super::document::Scene;
use super::{FORMAT, VERSION};
use crate::report::{Location, Reporter};
use fields::{Fields, Problems};

/// Problems that are told one by one; the rest are counted.
const PROBLEMS_KEPT: usize = 32;

/// What kind of problem it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SceneProblemKind {
    /// The bytes are no text, or no TOML.
    Syntax,
    /// The file does not say that it is a scene.
    NotAScene,
    /// It is of a version newer than [`VERSION`].
    NewerVersion,
    /// A field that must be there is not.
    Missing,
    /// A field that the format does not have.
    UnknownField,
    /// A value is of another kind than the field's, or not one of its words.
    WrongValue,
    /// Keys that make no track, joints that make no skeleton.
    Inconsistent,
    /// Angles that turn further than quaternions do between two keys: a warning.
    LostTurn,
    /// A value that is drawn as another, or a name that stands for something else: a warning.
    Doubtful,
}

/// One thing that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneProblem {
    /// What kind of thing.
    pub kind: SceneProblemKind,
    /// Where it is in the text.
    pub location: Location,
    /// Where it is in the document, as `track[2].keys[0].value`; empty for the document itself.
    pub path: String,
    /// What was expected and what was found, lower case.
    pub message: String,
}

impl fmt::Display for SceneProblem {
    /// `line 12, column 5: track[2].joint: the message`.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: ", self.location)?;
        if !self.path.is_empty() {
            write!(out, "{}: ", self.path)?;
        }
        out.write_str(&self.message)
    }
}

/// Why a file is no scene: all that is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneReadError {
    /// The problems in the order of the text, at least one; at most 32 of them.
    pub problems: Vec<SceneProblem>,
    /// How many more there are.
    pub more: usize,
}

impl fmt::Display for SceneReadError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(first) = self.problems.first() {
            write!(out, "{first}")?;
        }
        match self.problems.len() + self.more {
            0 | 1 => Ok(()),
            2 => out.write_str(" (and 1 more problem)"),
            all => write!(out, " (and {} more problems)", all - 1),
        }
    }
}

impl std::error::Error for SceneReadError {}

/// Reads a scene from the bytes of its file.
///
/// # Errors
/// [`SceneReadError`] with every problem: text that is no TOML, a newer version, and fields that are
/// missing, unknown, of another kind or inconsistent.
pub fn read(bytes: &[u8]) -> Result<Scene, SceneReadError> {
    read_with_warnings(bytes).map(|(scene, _)| scene)
}

/// Reads a scene, and says what in it will not come out as it may have been meant: at most 32 warnings, in
/// the order of the text.
///
/// # Errors
/// As [`read`].
pub fn read_with_warnings(bytes: &[u8]) -> Result<(Scene, Vec<SceneProblem>), SceneReadError> {
    let mut warnings = Vec::new();
    let scene = read_as(bytes, FORMAT, VERSION, |fields, version, problems| {
        let scene = parts::scene(fields, version, problems);
        warnings = std::mem::take(&mut problems.warnings);
        scene
    })?;
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let warnings = Problems {
        list: warnings,
        ..Problems::default()
    };
    Ok((scene, located(text, warnings).problems))
}

/// Reads what a file of a format and a version up to `newest` holds.
pub(crate) fn read_as<T>(
    bytes: &[u8],
    format: &str,
    newest: u32,
    parts: impl FnOnce(&mut Fields<'_>, u32, &mut Problems) -> Option<T>,
) -> Result<T, SceneReadError> {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let at = error.valid_up_to();
            return Err(one(
                bytes,
                at,
                SceneProblemKind::Syntax,
                "expected UTF-8 text",
            ));
        }
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let document = DeTable::parse(text).map_err(|error| {
        let at = error.span().map_or(text.len(), |span| span.start);
        let message = error.message().replace('\n', " ");
        one(text.as_bytes(), at, SceneProblemKind::Syntax, &message)
    })?;
    let mut problems = Problems::default();
    let mut fields = Fields::new(document.get_ref(), 0..0, String::new());
    let version = readable_version(&mut fields, (format, newest), &mut problems);
    let whole = version.and_then(|version| parts(&mut fields, version, &mut problems));
    match whole {
        Some(whole) if problems.list.is_empty() => Ok(whole),
        _ => Err(located(text.as_bytes(), problems)),
    }
}

/// The file's version, if it is of a format, in a version that is known.
fn readable_version(
    fields: &mut Fields<'_>,
    (expected, newest): (&str, u32),
    problems: &mut Problems,
) -> Option<u32> {
    let format = fields.required("format", problems)?;
    if format.text() != Some(expected) {
        let message = format!("expected \"{expected}\", found {}", format.shown());
        problems.at(&format, SceneProblemKind::NotAScene, message);
        return None;
    }
    let version = fields.required("version", problems)?;
    match version.whole_number() {
        Some(found) if (1..=i64::from(newest)).contains(&found) => u32::try_from(found).ok(),
        Some(found) if found > i64::from(newest) => {
            let message = format!(
                "this file is of version {found} of the format; this program reads up to \
                 {newest}: a newer posekit can open it"
            );
            problems.at(&version, SceneProblemKind::NewerVersion, message);
            None
        }
        _ => {
            let message = format!("expected a version from 1 on, found {}", version.shown());
            problems.at(&version, SceneProblemKind::WrongValue, message);
            None
        }
    }
}

/// A problem before its place is a line and a column.
struct Found {
    kind: SceneProblemKind,
    span: Range<usize>,
    path: String,
    message: String,
}

fn located(bytes: &[u8], mut problems: Problems) -> SceneReadError {
    problems.list.sort_by_key(|problem| problem.span.start);
    let mut reporter = Reporter::new(bytes);
    let more = problems.list.len().saturating_sub(PROBLEMS_KEPT);
    let kept = problems.list.into_iter().take(PROBLEMS_KEPT);
    let kept = kept.map(|problem| SceneProblem {
        kind: problem.kind,
        location: reporter.locate(problem.span.start),
        path: problem.path,
        message: problem.message,
    });
    SceneReadError {
        problems: kept.collect(),
        more,
    }
}

fn one(bytes: &[u8], at: usize, kind: SceneProblemKind, message: &str) -> SceneReadError {
    let list = vec![Found {
        kind,
        span: at..at,
        path: String::new(),
        message: message.to_owned(),
    }];
    let problems = Problems {
        list,
        ..Problems::default()
    };
    located(bytes, problems)
}
