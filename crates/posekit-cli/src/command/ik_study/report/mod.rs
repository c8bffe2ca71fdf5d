//! The report's text, made from the numbers: what was asked, how, what came out, what it means.

mod again;
mod asked;
mod effort;
mod findings;
mod how;
mod influence;
mod iterations;
mod moving;
mod ranking;
mod summary;
mod worst;

use super::document::{Document, Entry, Mark};
use super::experiment::{Results, Run};
use super::moving::Following;
use super::setup::Study;
use super::statistics::{Quantiles, median, share};
use super::targets::{Kind, Target};
use crate::text::{fixed, grouped};

/// All numbers of a study.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers<'a> {
    /// What was studied.
    pub(super) study: &'a Study,
    /// What came out.
    pub(super) results: &'a Results,
    /// How moving targets were followed.
    pub(super) following: &'a [Following],
}

/// Writes the report.
pub(super) fn compose(numbers: Numbers<'_>, command: &str) -> Document {
    let study = numbers.study;
    let solvers = study.methods.len();
    let mut document = Document {
        title: format!(
            "Inverse kinematics: {} compared on {}",
            counted(solvers, "solver"),
            study.input
        ),
        subtitle: format!(
            "{}, {}, {} of iterations: {} runs. Written by posekit {}.",
            crate::text::counted(study.chains.len(), "chain"),
            crate::text::counted(study.targets.iter().map(Vec::len).sum(), "target"),
            crate::text::counted(study.counts.len(), "number"),
            grouped(numbers.results.all().len()),
            env!("CARGO_PKG_VERSION"),
        ),
        summary: summary::write(numbers),
        blocks: Vec::new(),
        shots: Vec::new(),
    };
    document.chapter("What was asked");
    asked::write(&mut document, numbers);
    document.chapter("How it was done");
    how::write(&mut document, numbers);
    document.chapter("Results");
    iterations::write_one_target(&mut document, numbers);
    iterations::write_many_targets(&mut document, numbers);
    influence::write_place(&mut document, numbers);
    influence::write_chain(&mut document, numbers);
    effort::write(&mut document, numbers);
    moving::write(&mut document, numbers);
    worst::write(&mut document, numbers);
    document.chapter("What it means");
    findings::write(&mut document, numbers);
    ranking::write(&mut document, numbers);
    document.chapter("To do it again");
    again::write(&mut document, numbers, command);
    document
}

impl<'a> Numbers<'a> {
    /// The runs of a chain, a solver and a count over the targets that are wanted.
    fn over(
        self,
        at: (usize, usize, usize),
        is_wanted: impl Fn(&Target) -> bool + 'a,
    ) -> impl Iterator<Item = &'a Run> + 'a {
        self.results.over_targets(self.study, at, is_wanted)
    }

    /// The share of targets that were reached.
    fn success(
        self,
        at: (usize, usize, usize),
        is_wanted: impl Fn(&Target) -> bool + 'a,
    ) -> Option<f64> {
        let tolerance = self.study.chains[at.0].tolerance;
        share(self.over(at, is_wanted).map(|run| run.miss <= tolerance))
    }

    /// The median miss.
    fn median_miss(
        self,
        at: (usize, usize, usize),
        is_wanted: impl Fn(&Target) -> bool + 'a,
    ) -> Option<f64> {
        median(self.over(at, is_wanted).map(|run| run.miss))
    }

    /// The quantiles of the miss.
    fn misses(
        self,
        at: (usize, usize, usize),
        is_wanted: impl Fn(&Target) -> bool + 'a,
    ) -> Option<Quantiles> {
        Quantiles::of(self.over(at, is_wanted).map(|run| run.miss))
    }

    /// Index of the largest number of iterations.
    fn last(self) -> usize {
        self.study.counts.len() - 1
    }

    /// A solver's short name.
    fn name(self, method: usize) -> String {
        self.study.methods[method].name().to_owned()
    }

    /// How many iterations took a solver to the judged targets of a chain: of each in order, infinite where it
    /// did not come to it.
    fn needed(self, chain: usize, method: usize) -> impl Iterator<Item = f64> + 'a {
        let is_judged = is_judged(self.study);
        let targets = self.study.targets[chain].iter().enumerate();
        targets
            .filter(move |(_, target)| is_judged(target))
            .map(move |(target, _)| {
                let arrival = self.results.arrival(chain, target, method);
                arrival.iterations.map_or(f64::INFINITY, f64::from)
            })
    }

    /// Whether a solver never fell behind a moving target by more than so many tolerances.
    fn keeps_up(self, following: &Following, tolerances: f64) -> bool {
        let largest = following.misses.iter().copied().fold(0.0, f64::max);
        largest <= tolerances * self.study.chains[0].tolerance
    }
}

/// Whether a target is one of those that chains and solvers are judged by: random ones within reach, or,
/// where there are none, all that are within reach.
fn is_judged(study: &Study) -> impl Fn(&Target) -> bool + Copy + use<> {
    let has_random = study
        .targets
        .iter()
        .flatten()
        .any(|target| target.kind == Kind::Reachable);
    move |target: &Target| {
        if has_random {
            target.kind == Kind::Reachable
        } else {
            !target.is_out_of_reach()
        }
    }
}

/// What [`is_judged`] means, in words.
fn judged_words(study: &Study) -> &'static str {
    if study
        .targets
        .iter()
        .flatten()
        .any(|target| target.kind == Kind::Reachable)
    {
        "random targets within reach"
    } else {
        "targets within reach"
    }
}

/// `none`, `one`, `24`.
fn number(count: usize) -> String {
    const WORDS: [&str; 10] = [
        "none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine",
    ];
    WORDS
        .get(count)
        .map_or_else(|| grouped(count), |&word| word.to_owned())
}

/// With a capital letter at its head.
fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// `no solver`, `one solver`, `seven solvers`, `24 targets`.
fn counted(count: usize, noun: &str) -> String {
    let number = match count {
        0 => "no".to_owned(),
        _ => number(count),
    };
    let plural = if count == 1 { "" } else { "s" };
    format!("{number} {noun}{plural}")
}

/// How a run is marked: green where the target was reached, red where it was missed. Where it is out of reach,
/// nothing marks a chain that came as near as can be.
fn outcome_mark(study: &Study, run: &Run) -> Mark {
    let is_nearest = run.miss <= study.chains[run.cell.chain].tolerance;
    match (study.target(run.cell).is_out_of_reach(), is_nearest) {
        (false, true) => Mark::Good,
        (true, true) => Mark::None,
        (_, false) => Mark::Bad,
    }
}

/// What the marks of [`outcome_mark`] mean, for captions; the second part only where a target is out of reach.
fn outcome_words(any_is_out: bool) -> &'static str {
    if any_is_out {
        "green where the target was reached, red where it was missed; black where it is out of reach and the chain came as \
         near as it can"
    } else {
        "green where the target was reached, red where it was missed"
    }
}

/// Lengths under this are what rounding in double precision leaves: no one of them is better than another.
const ROUNDING: f64 = 1e-12;

/// A length as `2.786e-2`: four digits, whatever its size.
fn scientific(value: f64) -> String {
    if value < ROUNDING {
        "< 1e-12".to_owned()
    } else {
        format!("{value:.3e}")
    }
}

/// As [`scientific`], with two digits.
fn roughly(value: f64) -> String {
    if value < ROUNDING {
        "< 1e-12".to_owned()
    } else {
        format!("{value:.1e}")
    }
}

/// A length with so many digits as matter beside a chain's reach.
fn length(value: f64, reach: f64) -> String {
    fixed(value, crate::text::decimals_for(reach))
}

/// A share in percent, without claiming a whole that it is not.
fn percent(share: f64) -> String {
    let percent = share * 100.0;
    if percent > 99.9 && percent < 100.0 {
        "> 99.9 %".to_owned()
    } else if percent == 100.0 || percent == 0.0 {
        format!("{percent:.0} %")
    } else {
        format!("{percent:.1} %")
    }
}

/// An angle in degrees.
fn degrees(angle_rad: f64) -> String {
    let angle = angle_rad.to_degrees();
    match angle {
        angle if angle >= 99.95 => format!("{angle:.0}°"),
        angle if angle >= 0.995 => format!("{angle:.1}°"),
        angle => format!("{angle:.2}°"),
    }
}

/// Seconds as microseconds.
fn micros(secs: f64) -> String {
    let micros = secs * 1e6;
    if micros >= 100.0 {
        format!("{micros:.0} µs")
    } else {
        format!("{micros:.1} µs")
    }
}

/// Marks the smallest or the largest of values, one for each row, in a column of a table; values that are
/// equal share it.
///
/// One alone is not the best of anything.
fn mark_best(rows: &mut [Vec<Entry>], column: usize, values: &[Option<f64>], is_least: bool) {
    if rows.len() < 2 {
        return;
    }
    let sign = if is_least { 1.0 } else { -1.0 };
    let best = values
        .iter()
        .flatten()
        .map(|value| value.max(ROUNDING) * sign)
        .fold(f64::INFINITY, f64::min);
    for (row, value) in rows.iter_mut().zip(values) {
        let is_best = value.is_some_and(|value| value.max(ROUNDING) * sign <= best);
        if let Some(entry) = row.get_mut(column).filter(|_| is_best) {
            entry.mark = Mark::Best;
        }
    }
}

/// `a`, `a and b`, `a, b and c`.
fn listed(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(scientific(0.027_861_2), "2.786e-2");
        assert_eq!(scientific(0.0), "< 1e-12");
        assert_eq!(roughly(0.027_861_2), "2.8e-2");
        assert_eq!(percent(0.9999), "> 99.9 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(percent(0.125), "12.5 %");
        assert_eq!(counted(1, "solver"), "one solver");
        assert_eq!(counted(1200, "run"), "1,200 runs");
        assert_eq!(counted(0, "run"), "no runs");
        assert_eq!(capitalized(&number(0)), "None");
        assert_eq!(micros(1.25e-6), "1.2 µs");
        let names = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(listed(&names), "a, b and c");
    }

    #[test]
    fn the_best_of_a_column_is_marked() {
        let mut rows = vec![
            vec![Entry::new("x")],
            vec![Entry::new("y")],
            vec![Entry::new("z")],
        ];
        mark_best(&mut rows, 0, &[Some(2.0), Some(1.0), None], true);
        let marks: Vec<Mark> = rows.iter().map(|row| row[0].mark).collect();
        assert_eq!(marks, [Mark::None, Mark::Best, Mark::None]);
        let mut alone = vec![vec![Entry::new("x")]];
        mark_best(&mut alone, 0, &[Some(2.0)], true);
        assert_eq!(alone[0][0].mark, Mark::None);
    }
}
