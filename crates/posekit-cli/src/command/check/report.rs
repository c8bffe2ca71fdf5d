//! What `posekit check` prints for people about a file: its findings, the worst first.

use std::collections::BTreeMap;

use anstyle::{AnsiColor, Style};
use posekit::check::{FindingCode, Severity};
use posekit_formats::bvh::CheckEntry;
use posekit_formats::report::WarningCode;

use super::order;
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::text::{counted, width};

/// Warnings and errors of one code are printed one by one up to this many; `--json` has them all.
const SHOWN_PER_CODE: usize = 4;
/// Of information one line a code is enough.
const INFOS_SHOWN_PER_CODE: usize = 1;

/// How many findings there are of each severity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) errors: usize,
    pub(super) warnings: usize,
    pub(super) infos: usize,
}

impl Counts {
    pub(super) fn of<'a>(entries: impl IntoIterator<Item = &'a CheckEntry>) -> Self {
        let mut counts = Self::default();
        for entry in entries {
            match entry.severity {
                Severity::Error => counts.errors += 1,
                Severity::Warning => counts.warnings += 1,
                Severity::Info => counts.infos += 1,
            }
        }
        counts
    }

    pub(super) fn add(&mut self, other: Self) {
        self.errors += other.errors;
        self.warnings += other.warnings;
        self.infos += other.infos;
    }

    /// `1 error, 2 warnings, 3 infos`, without those that are none.
    pub(super) fn text(self) -> String {
        let counts = [
            (self.errors, "error"),
            (self.warnings, "warning"),
            (self.infos, "info"),
        ];
        let parts: Vec<String> = counts
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, noun)| counted(count, noun))
            .collect();
        if parts.is_empty() {
            "nothing suspicious".to_owned()
        } else {
            parts.join(", ")
        }
    }
}

/// Whether `posekit fix` repairs what an entry is about: what the reader had to put right, and flips.
pub(super) fn is_fixable(entry: &CheckEntry) -> bool {
    let was_repaired = entry.file.is_none()
        && entry.place.is_some()
        && entry.severity == Severity::Warning
        && entry.code != WarningCode::BadFrameTime.code();
    was_repaired || entry.code == FindingCode::EulerFlip.code()
}

/// How many findings a file has, what was taken as up if that needs a word, and the findings that are shown, the
/// worst first.
pub(super) fn readable(
    name: &str,
    entries: &[&CheckEntry],
    counts: Counts,
    up: Option<String>,
) -> String {
    let name = styled(HEADING, &one_line(name));
    let mut text = format!("{name}: {}\n", counts.text());
    if let Some(up) = up {
        text += &format!("  {}\n", styled(DIM, &up));
    }
    let lines = lines(&order::worst_first(entries));
    let place_width = lines.iter().map(|line| width(&line.place)).max();
    for line in &lines {
        text += &line.text(place_width.unwrap_or(0));
    }
    text
}

/// One line of a file's findings.
struct Line<'a> {
    severity: Severity,
    place: String,
    message: String,
    code: &'a str,
}

impl Line<'_> {
    fn text(&self, place_width: usize) -> String {
        let style = match self.severity {
            Severity::Error => AnsiColor::Red.on_default().bold(),
            Severity::Warning => AnsiColor::Yellow.on_default().bold(),
            Severity::Info => Style::new().dimmed(),
        };
        let padding = " ".repeat(place_width - width(&self.place));
        let between = if place_width > 0 { "  " } else { "" };
        format!(
            "  {}  {}{padding}{between}{} {}\n",
            styled(style, &format!("{:<7}", self.severity.name())),
            self.place,
            self.message,
            styled(DIM, &format!("[{}]", self.code))
        )
    }
}

/// A line for each entry, and one for all of a code that are too many.
fn lines<'a>(entries: &[&'a CheckEntry]) -> Vec<Line<'a>> {
    let mut lines = Vec::new();
    let kind = |entry: &CheckEntry| (entry.severity, entry.code);
    let mut counts: BTreeMap<(Severity, &str), usize> = BTreeMap::new();
    for entry in entries {
        *counts.entry(kind(entry)).or_default() += 1;
    }
    let mut seen: BTreeMap<(Severity, &str), usize> = BTreeMap::new();
    for entry in entries {
        let count = counts.get(&kind(entry)).copied().unwrap_or(0);
        let so_far = seen.entry(kind(entry)).or_default();
        let earlier = *so_far;
        *so_far += 1;
        let limit = match entry.severity {
            Severity::Info => INFOS_SHOWN_PER_CODE,
            Severity::Warning | Severity::Error => SHOWN_PER_CODE,
        };
        let is_shown = earlier < limit || count == limit + 1;
        if is_shown {
            lines.push(Line {
                severity: entry.severity,
                place: place(entry),
                message: one_line(&entry.message),
                code: entry.code,
            });
        } else if earlier == limit {
            lines.push(Line {
                severity: entry.severity,
                place: String::new(),
                message: format!("... and {} more, which --json lists", count - limit),
                code: entry.code,
            });
        }
    }
    lines
}

/// Where it is: a line of the file, or frames.
pub(super) fn place(entry: &CheckEntry) -> String {
    match (&entry.place, entry.frames) {
        (Some(place), _) => match &entry.file {
            Some(file) => one_line(&format!("{file}, {place}")),
            None => place.to_string(),
        },
        (None, Some(frames)) => frames.to_string(),
        (None, None) => String::new(),
    }
}
