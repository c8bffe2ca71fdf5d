//! The way of every command over its inputs: read each, do the work on all cores, hand the results
//! over in order, carry on past a bad file, and say at the end which ones failed.

use std::ops::ControlFlow;

use crate::args::Global;
use crate::console;
use crate::failure::Failure;
use crate::inputs::{Input, Inputs};
use crate::jobs::{self, Worked};
use crate::progress::Progress;

/// How many warnings of one file are shown before the rest are only counted.
const WARNINGS_SHOWN: usize = 3;
/// How many failed files are named at the end.
const FAILURES_NAMED: usize = 8;

/// What came out of one input.
#[derive(Debug)]
pub(crate) struct Done<T> {
    /// The result.
    pub(crate) value: T,
    /// Lines to show as warnings.
    pub(crate) warnings: Vec<String>,
    /// Lines to show as notes, which need no action.
    pub(crate) notes: Vec<String>,
}

/// What became of one thing that the user named.
pub(crate) enum Outcome<'a, T> {
    /// The work was done.
    Done(&'a Input, T),
    /// It could not be read, or the work on it could not be done.
    Failed {
        /// What messages call it.
        name: &'a str,
        /// Why.
        failure: &'a Failure,
    },
}

/// Works on every input with `work`, on several threads, and gives the results to `emit` in the
/// order of the inputs, on this thread.
///
/// A failure of one input is shown and the rest carried on with; then the run as a whole fails. A
/// failure of `emit` (standard output is gone) ends the run.
pub(crate) fn run<T: Send>(
    inputs: Inputs,
    global: &Global,
    work: impl Fn(usize, &Input) -> Result<Done<T>, Failure> + Sync,
    mut emit: impl FnMut(&Input, T) -> Result<(), Failure>,
) -> Result<(), Failure> {
    run_telling(inputs, global, work, |outcome| match outcome {
        Outcome::Done(input, value) => emit(input, value),
        Outcome::Failed { .. } => Ok(()),
    })
}

/// As [`run`], and `emit` is told of failures too: output for programs has a line for every input.
pub(crate) fn run_telling<T: Send>(
    inputs: Inputs,
    global: &Global,
    work: impl Fn(usize, &Input) -> Result<Done<T>, Failure> + Sync,
    mut emit: impl FnMut(Outcome<'_, T>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let Inputs { list, failures, .. } = inputs;
    let mut tally = Tally {
        total: list.len() + failures.len(),
        failed: Vec::new(),
    };
    let progress = Progress::new(list.len(), global.quiet);
    for (name, failure) in failures {
        progress.suspend(|| {
            emit(Outcome::Failed {
                name: &name,
                failure: &failure,
            })?;
            tally.add(&name, failure)
        })?;
    }
    let workers = global.jobs.unwrap_or_else(jobs::default_workers);
    let mut result = Ok(());
    jobs::in_order(
        list.len(),
        workers,
        |index| work(index, &list[index]),
        |index, worked| {
            let input = &list[index];
            progress.advance(&input.name());
            let outcome = progress.suspend(|| match settle(worked, input) {
                Ok(done) => {
                    if !global.quiet {
                        show_warnings(&done.warnings);
                        done.notes.iter().for_each(|note| console::note(note));
                    }
                    emit(Outcome::Done(input, done.value))
                }
                Err(failure) => {
                    let name = input.name();
                    let told = match failure {
                        Failure::ClosedPipe => Ok(()),
                        _ => emit(Outcome::Failed {
                            name: &name,
                            failure: &failure,
                        }),
                    };
                    told.and_then(|()| tally.add(&name, failure))
                }
            });
            match outcome {
                Ok(()) => ControlFlow::Continue(()),
                Err(failure) => {
                    result = Err(failure);
                    ControlFlow::Break(())
                }
            }
        },
    );
    drop(progress);
    result?;
    tally.verdict()
}

/// A panic is a mistake of ours: the file fails, the others are carried on with.
fn settle<T>(worked: Worked<Result<Done<T>, Failure>>, input: &Input) -> Result<Done<T>, Failure> {
    worked.unwrap_or_else(|_panic| {
        Err(Failure::new("an internal error, which is a bug in posekit")
            .in_file(&input.name())
            .try_next("please report it with this file"))
    })
}

fn show_warnings(warnings: &[String]) {
    for warning in warnings.iter().take(WARNINGS_SHOWN) {
        console::warning(warning);
    }
    if let Some(more) = warnings
        .len()
        .checked_sub(WARNINGS_SHOWN)
        .filter(|&more| more > 0)
    {
        console::warning(&format!("... and {more} more; posekit info lists them all"));
    }
}

/// The failures so far.
struct Tally {
    total: usize,
    failed: Vec<String>,
}

impl Tally {
    /// Notes a failure and shows it; the failure of a run's only input is the run's.
    fn add(&mut self, name: &str, failure: Failure) -> Result<(), Failure> {
        if self.total == 1 || matches!(failure, Failure::ClosedPipe) {
            return Err(failure);
        }
        failure.say();
        self.failed.push(name.to_owned());
        Ok(())
    }

    fn verdict(self) -> Result<(), Failure> {
        if self.failed.is_empty() {
            return Ok(());
        }
        let count = self.failed.len();
        let mut named = self.failed;
        named.truncate(FAILURES_NAMED);
        let more = count - named.len();
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        let what = format!(
            "{count} of {} failed: {}{more}",
            self.total,
            named.join(", ")
        );
        Err(Failure::new(what))
    }
}
