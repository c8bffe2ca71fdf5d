//! How far a run has come, shown on a terminal and nowhere else.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::console;
use crate::failure::one_line;

/// A bar with the time left, or nothing when nobody would see it.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// A bar for `total` files; hidden for a single file, in a pipe, and when `quiet`.
    pub(crate) fn new(total: usize, quiet: bool) -> Self {
        Self::of(total, "files", quiet)
    }

    /// A bar for the frames of a film; hidden for a single picture, in a pipe, and when `quiet`.
    pub(crate) fn frames(total: usize, quiet: bool) -> Self {
        Self::of(total, "frames", quiet)
    }

    /// A bar for so many of any other things.
    pub(crate) fn steps(total: usize, things: &str, quiet: bool) -> Self {
        Self::of(total, things, quiet)
    }

    fn of(total: usize, things: &str, quiet: bool) -> Self {
        if quiet || total < 2 || !console::stderr_is_terminal() {
            return Self { bar: None };
        }
        let bar = ProgressBar::new(total as u64);
        let style = ProgressStyle::with_template(&format!(
            "{{bar:32.cyan/dim}} {{human_pos}}/{{human_len}} {things}  {{elapsed}} gone, \
             {{eta}} left  {{wide_msg:.dim}}"
        ))
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("━━─");
        bar.set_style(style);
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar: Some(bar) }
    }

    /// One more is done; `name` is what it is called, if anything.
    pub(crate) fn advance(&self, name: &str) {
        if let Some(bar) = &self.bar {
            if !name.is_empty() {
                bar.set_message(one_line(name));
            }
            bar.inc(1);
        }
    }

    /// Runs `write` with the bar out of the way of what it prints.
    pub(crate) fn suspend<R>(&self, write: impl FnOnce() -> R) -> R {
        match &self.bar {
            Some(bar) => bar.suspend(write),
            None => write(),
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
