//! What it costs: iterations, time, motion.

use super::super::document::{Block, Document, Entry, Table, code};
use super::super::experiment::Cell;
use super::super::statistics::{Quantiles, median};
use super::{Numbers, counted, degrees, is_judged, judged_words, mark_best, micros};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let chain = &study.chains[0];
    document.section("Effort: iterations, motion, time");
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut keys: Vec<[Option<f64>; 4]> = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let needed: Vec<Option<u32>> = study.targets[0]
            .iter()
            .enumerate()
            .filter(|(_, target)| is_judged(target))
            .map(|(target, _)| first_count(numbers, method, target))
            .collect();
        // Half of the targets were reached with so many; none if fewer were.
        let reached = needed
            .iter()
            .map(|count| count.map_or(f64::INFINITY, f64::from));
        let middle = median(reached).filter(|count| count.is_finite());
        let at = (0, method, study.shown);
        let turned = Quantiles::of(numbers.over(at, is_judged).map(|run| run.motion_rad));
        let shown_secs = median(numbers.over(at, is_judged).map(|run| run.secs));
        let last_secs = median(
            numbers
                .over((0, method, numbers.last()), is_judged)
                .map(|run| run.secs),
        );
        let text = |value: Option<f64>, write: fn(f64) -> String| {
            value.map_or_else(|| "–".to_owned(), write)
        };
        let mut row = vec![
            Entry::new(solver.name()),
            Entry::new(middle.map_or_else(|| "not half".to_owned(), |count| format!("{count:.0}"))),
            Entry::new(text(turned.map(|q| q.median), degrees)),
            Entry::new(turned.map_or_else(String::new, |q| {
                format!("{} to {}", degrees(q.low), degrees(q.high))
            })),
        ];
        if study.has_times {
            row.push(Entry::new(text(shown_secs, micros)));
            row.push(Entry::new(text(last_secs, micros)));
        }
        rows.push(row);
        keys.push([middle, turned.map(|q| q.median), shown_secs, last_secs]);
    }
    let columns_of = [(1, 0), (2, 1), (4, 2), (5, 3)];
    for (column, key) in columns_of {
        let values: Vec<_> = keys.iter().map(|keys| keys[key]).collect();
        mark_best(&mut rows, column, &values, true);
    }
    let (shown, last) = (study.shown_count(), study.counts[numbers.last()]);
    let mut columns = vec![
        "solver".to_owned(),
        "iterations".to_owned(),
        "joint motion".to_owned(),
        "10 to 90 %".to_owned(),
    ];
    let mut times = "";
    if study.has_times {
        columns.push(format!("time of {shown}"));
        columns.push(format!("time of {last}"));
        times = " The last columns are the median time of a call with so many iterations.";
    }
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Effort on {} of {}: the fewest iterations of those tried with which half of the targets are reached; the \
             median angle by which all joints together turned after {}, and that of all but the lowest and the highest tenth.{times}",
            judged_words(study),
            code(&chain.name),
            counted(shown as usize, "iteration")
        ),
        columns,
        is_text: false,
        rows,
    }));
    if study.has_times {
        document.paragraph(
            "An iteration of one solver is not worth an iteration of another: CCD and FABRIK pass over the chain, the \
             others solve for all joints at once, and a solver that comes to rest stops before its iterations are used \
             up.",
        );
    }
}

/// The fewest iterations that reached a target.
fn first_count(numbers: Numbers<'_>, method: usize, target: usize) -> Option<u32> {
    let study = numbers.study;
    let reached = (0..study.counts.len()).find(|&count| {
        let cell = Cell {
            chain: 0,
            target,
            method,
            count,
        };
        numbers.results.run(cell).miss <= study.chains[0].tolerance
    })?;
    Some(study.counts[reached])
}
