//! What ends the output of `posekit check`: a line for each code over all files, the worst first.

use std::cmp::Reverse;
use std::io::{self, Write};

use posekit::check::{Severity, Unit};
use posekit_formats::bvh::CheckEntry;
use serde_json::{Value, json};

use super::axes::Axes;
use super::report::{self, Counts};
use super::{Checked, order};
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::text::{Align, Table, counted, fixed, grouped, trimmed};

/// What all files come to.
#[derive(Debug, Default)]
pub(super) struct Total {
    file_count: usize,
    failed_count: usize,
    /// Files with a warning or an error.
    suspicious_count: usize,
    counts: Counts,
    /// In the order of their first finding.
    codes: Vec<CodeTotal>,
    fixable: Vec<String>,
    axes: Axes,
}

/// The findings of one code and one severity in all files.
#[derive(Debug)]
struct CodeTotal {
    severity: Severity,
    finding_count: usize,
    file_count: usize,
    worst: CheckEntry,
    worst_file: String,
}

impl Total {
    /// Counts one more file.
    pub(super) fn add(&mut self, name: &str, checked: Checked) {
        self.file_count += 1;
        let counts = Counts::of(&checked.entries);
        self.suspicious_count += usize::from(counts.errors + counts.warnings > 0);
        self.counts.add(counts);
        if let Some(up) = checked.up {
            self.axes.add(name, up);
        }
        if checked.is_fixable {
            self.fixable.push(name.to_owned());
        }
        let known_before: Vec<usize> = self.codes.iter().map(|code| code.finding_count).collect();
        for entry in checked.entries {
            self.add_entry(name, entry);
        }
        for (index, code) in self.codes.iter_mut().enumerate() {
            let before = known_before.get(index).copied().unwrap_or(0);
            code.file_count += usize::from(code.finding_count > before);
        }
    }

    /// Counts a file that could not be read.
    pub(super) fn add_failed(&mut self) {
        self.failed_count += 1;
    }

    fn add_entry(&mut self, name: &str, entry: CheckEntry) {
        let same = self
            .codes
            .iter_mut()
            .find(|code| code.worst.code == entry.code && code.severity == entry.severity);
        match same {
            None => self.codes.push(CodeTotal {
                severity: entry.severity,
                finding_count: 1,
                file_count: 0,
                worst: entry,
                worst_file: name.to_owned(),
            }),
            Some(code) => {
                code.finding_count += 1;
                if order::badness(&entry) > order::badness(&code.worst) {
                    code.worst = entry;
                    name.clone_into(&mut code.worst_file);
                }
            }
        }
    }

    fn worst_first(&self) -> Vec<&CodeTotal> {
        let mut codes: Vec<&CodeTotal> = self.codes.iter().collect();
        codes.sort_by_key(|code| (Reverse(code.severity), order::rank(code.worst.code)));
        codes
    }

    /// After the files: the table where there were several, and what to do next.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.file_count + self.failed_count > 1 {
            writeln!(out)?;
            self.write_summary(out)?;
        }
        if self.counts != Counts::default() {
            let next = "what a code means and what to do: docs/check/CODE.md";
            writeln!(out, "{}", styled(DIM, next))?;
        }
        let next = match self.fixable.as_slice() {
            [] => return Ok(()),
            [name] => format!("to repair some of it: posekit fix '{name}' -o fixed.bvh"),
            names => format!(
                "posekit fix repairs some of it in {}",
                counted(names.len(), "file")
            ),
        };
        writeln!(out, "{}", styled(DIM, &one_line(&next)))
    }

    /// The table alone.
    pub(super) fn write_summary(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut heading = format!(
            "{}: {}",
            styled(
                HEADING,
                &format!("{} checked", counted(self.file_count, "file"))
            ),
            self.counts.text()
        );
        if self.file_count > 1 {
            heading += &format!(
                "; {} with warnings or errors",
                grouped(self.suspicious_count)
            );
        }
        if self.failed_count > 0 {
            heading += &format!("; {} could not be read", grouped(self.failed_count));
        }
        writeln!(out, "{heading}")?;
        for line in self.axes.lines() {
            writeln!(out, "{line}")?;
        }
        if self.codes.is_empty() {
            return Ok(());
        }
        let mut table = Table::new(&[
            ("severity", Align::Left),
            ("code", Align::Left),
            ("files", Align::Right),
            ("findings", Align::Right),
            ("the worst", Align::Left),
        ]);
        for code in self.worst_first() {
            table.row(vec![
                code.severity.name().to_owned(),
                code.worst.code.to_owned(),
                grouped(code.file_count),
                grouped(code.finding_count),
                code.worst_text(),
            ]);
        }
        table.write(out)
    }

    /// The same for programs, as one object.
    pub(super) fn json(&self) -> Value {
        let codes: Vec<Value> = self
            .worst_first()
            .into_iter()
            .map(|code| {
                let mut worst = super::finding_object(&code.worst);
                worst["file"] = json!(code.worst_file);
                json!({
                    "code": code.worst.code,
                    "severity": code.severity.name(),
                    "files": code.file_count,
                    "findings": code.finding_count,
                    "worst": worst,
                })
            })
            .collect();
        json!({
            "files": self.file_count,
            "failed": self.failed_count,
            "suspicious": self.suspicious_count,
            "up": self.axes.json(),
            "codes": codes,
        })
    }
}

impl CodeTotal {
    /// How much, in which file, where in it.
    fn worst_text(&self) -> String {
        let place = report::place(&self.worst);
        let place = if place.is_empty() {
            place
        } else {
            format!(", {place}")
        };
        format!(
            "{} in {}{place}",
            amount(&self.worst),
            one_line(&self.worst_file)
        )
    }
}

/// What was measured, in words.
fn amount(entry: &CheckEntry) -> String {
    let value = entry.value;
    let number = |decimals| trimmed(value, decimals);
    match (entry.unit, entry.share_of_height) {
        (_, Some(share)) => format!("{} of the height", fixed(share, 2)),
        (Unit::Degrees, _) => format!("{} degrees", number(0)),
        (Unit::FileUnits, _) => format!("{} file units", number(3)),
        (Unit::Frames, _) => many(value, "frame"),
        (Unit::Seconds, _) => format!("{} s", number(6)),
        (Unit::Occurrences, _) => many(value, "time"),
        (Unit::Channels, _) => many(value, "channel"),
        (Unit::Fraction, _) => format!("{} %", trimmed(100.0 * value, 0)),
        (Unit::TimesTooFast, _) if value < 1.0 => {
            format!("{} times too slow", trimmed(1.0 / value, 1))
        }
        (Unit::TimesTooFast, _) => format!("{} times too fast", number(1)),
        (unit, _) => format!("{} {}", number(3), unit.name()),
    }
}

/// `1 frame`, `12 frames`.
fn many(value: f64, noun: &str) -> String {
    let number = trimmed(value, 0);
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} {noun}{plural}")
}
