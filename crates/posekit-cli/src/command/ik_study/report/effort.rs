//! What it costs: iterations, time, motion.

use super::super::document::{Block, Document, Entry, Table, code};
use super::super::experiment::Arrival;
use super::super::method::Method;
use super::super::statistics::{Quantiles, median};
use super::{
    Numbers, counted, degrees, is_judged, judged_words, listed, mark_best, micros, percent,
};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    if arrivals(numbers, 0).next().is_none() {
        return;
    }
    document.section("Effort: iterations, motion, time");
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut keys: Vec<[Option<f64>; 4]> = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let reached =
            super::share(arrivals(numbers, method).map(|arrival| arrival.iterations.is_some()));
        // Those that were not reached are infinite, so that a median is only there if half of them were.
        let middle = median(numbers.needed(0, method)).filter(|count| count.is_finite());
        let turned = Quantiles::of(
            arrivals(numbers, method)
                .filter(|arrival| arrival.iterations.is_some())
                .map(|arrival| arrival.motion_rad),
        );
        let secs = time_to_arrive(numbers, method);
        let dash = || "–".to_owned();
        let mut row = vec![
            Entry::new(solver.name()),
            Entry::new(reached.map_or_else(dash, percent)),
            Entry::new(middle.map_or_else(dash, |count| format!("{count:.0}"))),
            Entry::new(turned.map_or_else(dash, |turned| degrees(turned.median))),
            Entry::new(turned.map_or_else(dash, |turned| {
                format!("{} to {}", degrees(turned.low), degrees(turned.high))
            })),
        ];
        let each = time_of_iteration(numbers, method);
        if study.has_times {
            row.push(Entry::new(secs.map_or_else(dash, micros)));
            row.push(Entry::new(each.map_or_else(dash, micros)));
        }
        rows.push(row);
        keys.push([reached, middle, secs, each]);
    }
    // Joint motion is over the targets that each solver reached, which are not the same: nobody is best.
    for (column, key, is_least) in [(1, 0, false), (2, 1, true), (5, 2, true), (6, 3, true)] {
        let values: Vec<_> = keys.iter().map(|keys| keys[key]).collect();
        mark_best(&mut rows, column, &values, is_least);
    }
    let mut columns = [
        "solver",
        "reached",
        "iterations",
        "joint motion",
        "10 to 90 %",
    ]
    .map(str::to_owned)
    .to_vec();
    let mut times = "";
    if study.has_times {
        columns.extend(["time", "an iteration"].map(str::to_owned));
        times = "; the median time until then, and of one iteration";
    }
    let last = counted(study.last_count() as usize, "iteration");
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Effort on {} of {}, when a solver stops as soon as the end is within the tolerance, or after {last}: the share that was \
             reached; the median number of iterations until then; how much all joints together turned on the way to the targets that \
             were reached, the median and the range without the lowest and the highest tenth{times}. A dash stands where fewer than \
             half were reached.",
            judged_words(study),
            code(&chain.name),
        ),
        columns,
        is_text: false,
        rows,
    }));
    if study.has_times && study.methods.len() > 1 {
        document.paragraph(format!(
            "An iteration of one solver is not worth an iteration of another: {}.",
            what_an_iteration_is(&study.methods).join("; ")
        ));
    }
}

/// What solvers do in an iteration, as parts of a sentence.
fn what_an_iteration_is(methods: &[Method]) -> Vec<String> {
    let of = |kind: fn(&Method) -> bool, one: &str, several: &str| {
        let names: Vec<String> = methods
            .iter()
            .filter(|method| kind(method))
            .map(|method| method.name().to_owned())
            .collect();
        match names.len() {
            0 => None,
            1 => Some(format!("{} {one}", listed(&names))),
            _ => Some(format!("{} {several}", listed(&names))),
        }
    };
    let goes = "over the chain joint by joint";
    let parts = [
        of(
            |method| matches!(method, Method::Ccd | Method::Fabrik),
            &format!("passes {goes}"),
            &format!("pass {goes}"),
        ),
        of(
            |method| {
                matches!(
                    method,
                    Method::Transpose | Method::Dls | Method::Sdls | Method::Lm
                )
            },
            "solves for all joints at once",
            "solve for all joints at once",
        ),
        of(
            |method| matches!(method, Method::TwoBone),
            "is done in one step",
            "are done in one step",
        ),
    ];
    parts.into_iter().flatten().collect()
}

/// How a solver came to the targets of the first chain by which solvers are judged.
fn arrivals(numbers: Numbers<'_>, method: usize) -> impl Iterator<Item = &Arrival> {
    let is_judged = is_judged(numbers.study);
    let targets = numbers.study.targets[0].iter().enumerate();
    targets
        .filter(move |(_, target)| is_judged(target))
        .map(move |(target, _)| numbers.results.arrival(0, target, method))
}

/// The median time to those targets, if it came to half of them.
pub(super) fn time_to_arrive(numbers: Numbers<'_>, method: usize) -> Option<f64> {
    let secs = arrivals(numbers, method).map(|arrival| match arrival.iterations {
        Some(_) => arrival.secs,
        None => f64::INFINITY,
    });
    median(secs).filter(|secs| secs.is_finite())
}

/// The median time of an iteration, in the runs with the most of them.
fn time_of_iteration(numbers: Numbers<'_>, method: usize) -> Option<f64> {
    let is_judged = is_judged(numbers.study);
    let runs = numbers.over((0, method, numbers.last()), is_judged);
    let runs = runs.filter(|run| run.iterations > 0);
    median(runs.map(|run| run.secs / f64::from(run.iterations)))
}
