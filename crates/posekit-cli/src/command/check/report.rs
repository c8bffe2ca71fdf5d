//! What `posekit check` prints for people: the findings of a file, the worst first, and a summary.

use std::cmp::Reverse;

use anstyle::{AnsiColor, Style};
use posekit::check::{FindingCode, Severity};
use posekit_formats::bvh::CheckEntry;
use posekit_formats::report::WarningCode;

use super::Outcome;
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::text::{counted, grouped, width};

/// Findings of one code are printed one by one up to this many; `--json` has them all.
const SHOWN_PER_CODE: usize = 4;

/// How many findings there are of each severity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    errors: usize,
    warnings: usize,
    infos: usize,
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

    fn add(&mut self, other: Self) {
        self.errors += other.errors;
        self.warnings += other.warnings;
        self.infos += other.infos;
    }

    /// `1 error, 2 warnings, 3 infos`, without those that are none.
    fn text(self) -> String {
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

/// What all files come to.
#[derive(Debug, Default)]
pub(super) struct Total {
    file_count: usize,
    /// Files with a warning or an error.
    suspicious_count: usize,
    counts: Counts,
    fixable: Vec<String>,
}

impl Total {
    /// Counts one more file.
    pub(super) fn add(&mut self, outcome: &Outcome, name: String) {
        self.file_count += 1;
        let counts = outcome.counts;
        self.suspicious_count += usize::from(counts.errors + counts.warnings > 0);
        self.counts.add(counts);
        if outcome.is_fixable {
            self.fixable.push(name);
        }
    }

    /// What to do next, and a summary of several files; empty when there is nothing to say.
    pub(super) fn text(&self) -> String {
        let mut text = String::new();
        if self.file_count > 1 {
            text += &format!(
                "\n{}: {}; {} with warnings or errors\n",
                styled(
                    HEADING,
                    &format!("{} checked", counted(self.file_count, "file"))
                ),
                self.counts.text(),
                grouped(self.suspicious_count)
            );
        }
        if self.counts != Counts::default() {
            let next = "what a code means and what to do: docs/check/CODE.md";
            text += &format!("{}\n", styled(DIM, next));
        }
        match self.fixable.as_slice() {
            [] => {}
            [name] => {
                let next = format!("some of it is repaired by: posekit fix '{name}' -o fixed.bvh");
                text += &format!("{}\n", styled(DIM, &one_line(&next)));
            }
            names => {
                let next = format!(
                    "posekit fix repairs some of it in {}",
                    counted(names.len(), "file")
                );
                text += &format!("{}\n", styled(DIM, &next));
            }
        }
        text
    }
}

/// Whether `posekit fix` repairs what an entry is about: what the reader had to put right, and flips.
pub(super) fn is_fixable(entry: &CheckEntry) -> bool {
    let was_repaired = entry.location.is_some()
        && entry.severity == Severity::Warning
        && entry.code != WarningCode::BadFrameTime.code();
    was_repaired || entry.code == FindingCode::EulerFlip.code()
}

/// The findings of a file, the worst first and otherwise in their order; `hidden` more of them are not
/// serious enough to be shown.
pub(super) fn readable(name: &str, entries: &[&CheckEntry], hidden: usize) -> String {
    let counts = Counts::of(entries.iter().copied()).text();
    let not_shown = match hidden {
        0 => String::new(),
        _ if entries.is_empty() => format!(" above --min ({} below it)", grouped(hidden)),
        _ => format!(" ({} below --min)", grouped(hidden)),
    };
    let mut text = format!(
        "{}: {counts}{not_shown}\n",
        styled(HEADING, &one_line(name))
    );
    let lines = lines(&worst_first(entries));
    let place_width = lines.iter().map(|line| width(&line.place)).max();
    for line in &lines {
        text += &line.text(place_width.unwrap_or(0));
    }
    text
}

/// The errors first, and findings of one code together, where the first of them is.
fn worst_first<'a>(entries: &[&'a CheckEntry]) -> Vec<&'a CheckEntry> {
    let first_of_code = |code: &str| entries.iter().position(|entry| entry.code == code);
    let mut sorted = entries.to_vec();
    sorted.sort_by_key(|entry| (Reverse(entry.severity), first_of_code(entry.code)));
    sorted
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
    for (index, entry) in entries.iter().enumerate() {
        let is_same =
            |other: &&&CheckEntry| other.code == entry.code && other.severity == entry.severity;
        let earlier = entries[..index].iter().filter(is_same).count();
        let count = entries.iter().filter(is_same).count();
        let is_shown = earlier < SHOWN_PER_CODE || count == SHOWN_PER_CODE + 1;
        if is_shown {
            lines.push(Line {
                severity: entry.severity,
                place: place(entry),
                message: one_line(&entry.message),
                code: entry.code,
            });
        } else if earlier == SHOWN_PER_CODE {
            lines.push(Line {
                severity: entry.severity,
                place: String::new(),
                message: format!(
                    "... and {} more, which --json lists",
                    count - SHOWN_PER_CODE
                ),
                code: entry.code,
            });
        }
    }
    lines
}

/// Where it is: a line of the file, or frames.
fn place(entry: &CheckEntry) -> String {
    match (entry.location, entry.frames) {
        (Some(location), _) => location.to_string(),
        (None, Some(frames)) => frames.to_string(),
        (None, None) => String::new(),
    }
}
