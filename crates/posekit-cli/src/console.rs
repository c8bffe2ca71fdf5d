//! The one door to standard output and standard error.
//!
//! Colours are written where they are shown and stripped where they are not: `anstream` looks at the
//! terminal, at `NO_COLOR` and at `--color`.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use anstyle::{AnsiColor, Style};
use clap::ValueEnum;

use crate::failure::one_line;

/// Marks an error.
const ERROR: Style = AnsiColor::Red.on_default().bold();
/// Marks a warning.
const WARNING: Style = AnsiColor::Yellow.on_default().bold();
/// Marks what is worth knowing and needs no action.
const NOTE: Style = AnsiColor::Cyan.on_default().bold();
/// A heading, or the name of the thing that a block of text is about.
pub(crate) const HEADING: Style = Style::new().bold();
/// Text that frames other text: labels, tree lines, units.
pub(crate) const DIM: Style = Style::new().dimmed();

/// When output is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorWhen {
    /// On a terminal, unless told otherwise by the environment
    Auto,
    /// Even in a pipe
    Always,
    /// Not at all
    Never,
}

/// Whether warnings and notes are left out.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves out warnings and notes from here on, whoever writes them.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// Makes `when` hold for everything written from here on.
pub(crate) fn set_color(when: ColorWhen) {
    match when {
        ColorWhen::Auto => anstream::ColorChoice::Auto,
        ColorWhen::Always => anstream::ColorChoice::Always,
        ColorWhen::Never => anstream::ColorChoice::Never,
    }
    .write_global();
}

/// `text` in a style on one line, for writing to standard output or standard error.
pub(crate) fn styled(style: Style, text: &str) -> String {
    let text = one_line(text);
    format!("{style}{text}{style:#}")
}

/// Standard output for people, locked and buffered, without colours where they would not be shown.
pub(crate) fn stdout() -> impl Write {
    BufWriter::with_capacity(1 << 16, anstream::stdout().lock())
}

/// Standard output for people, or for programs, which get every byte as it is.
pub(crate) fn stdout_for(reader: Reader) -> Box<dyn Write> {
    match reader {
        Reader::Person => Box::new(stdout()),
        Reader::Program => Box::new(binary_stdout()),
    }
}

/// Who reads standard output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reader {
    /// Somebody at a terminal.
    Person,
    /// A program: JSON and comma-separated values are exact.
    Program,
}

impl Reader {
    /// Who reads what is written with or without `--json`.
    pub(crate) fn of_json(is_json: bool) -> Self {
        match is_json {
            true => Self::Program,
            false => Self::Person,
        }
    }
}

/// Standard output for bytes as they are: files, and what programs read.
pub(crate) fn binary_stdout() -> impl Write {
    BufWriter::with_capacity(1 << 16, io::stdout().lock())
}

/// Whether standard output is a terminal, which binary data should not be written to.
pub(crate) fn stdout_is_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Whether standard error is a terminal, where progress may be shown.
pub(crate) fn stderr_is_terminal() -> bool {
    io::stderr().is_terminal()
}

/// Writes `error: ...` to standard error, on one line whatever names are in it, as [`warning`] and [`note`] do.
pub(crate) fn error(text: &str) {
    line(ERROR, "error", text);
}

/// Writes text that has its own styles and lines to standard error.
pub(crate) fn styled_error(text: &str) {
    // A standard error that cannot be written to leaves nobody to tell.
    let _ = write!(anstream::stderr().lock(), "{text}");
}

/// Writes `warning: ...` to standard error, unless that is to be quiet.
pub(crate) fn warning(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        line(WARNING, "warning", text);
    }
}

/// Writes `note: ...` to standard error, unless that is to be quiet.
pub(crate) fn note(text: &str) {
    if !QUIET.load(Ordering::Relaxed) {
        line(NOTE, "note", text);
    }
}

fn line(style: Style, label: &str, text: &str) {
    let text = one_line(text);
    // A standard error that cannot be written to leaves nobody to tell.
    let _ = writeln!(anstream::stderr().lock(), "{style}{label}{style:#}: {text}");
}
