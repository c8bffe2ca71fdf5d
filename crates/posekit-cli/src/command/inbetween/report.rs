//! The report's files: Markdown, comma-separated values and a page.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::compare::Comparison;
use super::html;
use crate::args::Global;
use crate::console;
use crate::failure::Failure;
use crate::output::{Guard, Target, write_whole};
use crate::text::fixed;

/// Where the report's files go: `STEM.html`, `STEM.md` and `STEM.csv`.
pub(super) fn targets(stem: &Path, guard: &Guard) -> Result<[Target; 3], Failure> {
    let target = |extension: &str, what: &str| {
        let what = format!("the report's {what}");
        guard.target(&with_extension(stem, extension), &what)
    };
    Ok([
        target("html", "page")?,
        target("md", "text")?,
        target("csv", "table")?,
    ])
}

/// Writes the report's files.
pub(super) fn write(
    comparison: &Comparison,
    targets: &[Target; 3],
    global: &Global,
) -> Result<(), Failure> {
    let texts = [
        html::page(comparison),
        markdown(comparison),
        csv(comparison),
    ];
    for (target, text) in targets.iter().zip(texts) {
        write_whole(target, |file| file.write_all(text.as_bytes()))?;
        if !global.quiet {
            console::note(&format!("wrote {}", target.display()));
        }
    }
    Ok(())
}

/// The stem with an extension added; a dot in the stem is part of it.
fn with_extension(stem: &Path, extension: &str) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    PathBuf::from(name)
}

/// One row for each method and joint; joint `*` is all of them.
fn csv(comparison: &Comparison) -> String {
    let mut text =
        String::from("method,joint,mean_deg,max_deg,worst_frame,mean_distance,max_distance\n");
    for (method, error) in &comparison.methods {
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{method},*,{},{},,{},{}",
            error.mean_deg, error.max_deg, error.mean_distance, error.max_distance
        );
        for (joint, name) in error.joints.iter().zip(&comparison.joints) {
            let _ = writeln!(
                text,
                "{method},\"{}\",{},{},{},{},{}",
                name.replace('"', "\"\""),
                joint.mean_deg,
                joint.max_deg,
                joint.worst_frame,
                joint.mean_distance,
                joint.max_distance
            );
        }
    }
    text
}

fn markdown(comparison: &Comparison) -> String {
    let mut text = format!(
        "# In-betweens of {}\n\n{}.\n\n{EXPLANATION}\n\n",
        plain(&comparison.name),
        comparison.summary()
    );
    let (heads, rows) = comparison.table();
    row(&mut text, heads.iter().map(ToString::to_string));
    row(&mut text, heads.iter().map(|_| "---".to_owned()));
    for cells in rows {
        row(&mut text, cells.iter().map(|cell| plain(cell)));
    }
    text.push_str("\n## Joint by joint: mean and largest angle, in degrees\n\n");
    let methods = comparison.methods.iter();
    row(
        &mut text,
        std::iter::once("joint".to_owned()).chain(methods.map(|(method, _)| method.to_string())),
    );
    let width = comparison.methods.len() + 1;
    row(&mut text, std::iter::repeat_n("---".to_owned(), width));
    for (index, name) in comparison.joints.iter().enumerate() {
        let cells = comparison.methods.iter().map(|(_, error)| {
            let joint = &error.joints[index];
            format!("{} / {}", fixed(joint.mean_deg, 3), fixed(joint.max_deg, 2))
        });
        row(&mut text, std::iter::once(plain(name)).chain(cells));
    }
    text
}

/// How the numbers come about: the same words in all forms of the report.
pub(super) const EXPLANATION: &str = "Angles are between the local rotations of the filled-in and the \
    original motion, over all joints that turn and all frames that were filled in; distances are \
    between global positions, in parts of the skeleton's height. Frames that were kept are not counted.";

fn row(text: &mut String, cells: impl Iterator<Item = String>) {
    text.push('|');
    for cell in cells {
        let _ = write!(text, " {cell} |");
    }
    text.push('\n');
}

/// A name that does not end a cell of Markdown or start markup.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '|' | '*' | '_' | '`' | '\\' | '<' | '[' | '#' => {
                out.push('\\');
                out.push(c);
            }
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
