//! How the number of iterations counts: for one target, and for many.

use super::super::chart::{Axis, Chart, Panel, Series, draw};
use super::super::document::{
    Block, Document, Entry, Mark, PictureEntry, PictureTable, Shot, Table, code,
};
use super::super::experiment::{Cell, Run};
use super::super::targets::Kind;
use super::{
    Numbers, counted, is_judged, judged_words, listed, mark_best, percent, roughly, scientific,
};

/// Below this share of the reach, curves end: single precision, in which poses are kept, shows no less.
const FLOOR_SHARE: f64 = 1e-8;

pub(super) fn write_one_target(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.section("One target, iteration by iteration");
    for (index, target) in study.targets[0].iter().enumerate() {
        if target.kind == Kind::Named {
            write_named(document, numbers, index);
        }
    }
    document.paragraph(
        "The bold number of a column is the smallest of it. The same runs as pictures show what the numbers do not: which \
         joints a solver uses.",
    );
    picture_steps(document, numbers);
}

fn write_named(document: &mut Document, numbers: Numbers<'_>, target: usize) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let name = &study.targets[0][target].name;
    let run = |method, count| -> &Run {
        numbers.results.run(Cell {
            chain: 0,
            target,
            method,
            count,
        })
    };
    let rows = study.methods.iter().enumerate().map(|(method, solver)| {
        let mut row = vec![Entry::new(solver.name())];
        row.extend(
            (0..study.counts.len())
                .map(|count| Entry::new(scientific(run(method, count).residual))),
        );
        row
    });
    let mut rows: Vec<_> = rows.collect();
    for count in 0..study.counts.len() {
        let column = (0..study.methods.len()).map(|method| Some(run(method, count).residual));
        mark_best(&mut rows, count + 1, &column.collect::<Vec<_>>(), true);
    }
    let before = chain.points[chain.points.len() - 1].distance(study.targets[0][target].place);
    let mut columns = vec!["iterations".to_owned()];
    columns.extend(study.counts.iter().map(u32::to_string));
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Residual of {} at the target {} after so many iterations. Before the first it is {}.",
            code(&chain.name),
            code(name),
            scientific(before)
        ),
        columns,
        is_text: false,
        rows,
    }));
    let shown = study.shown;
    let mut order: Vec<usize> = (0..study.methods.len()).collect();
    order.sort_by(|&a, &b| run(a, shown).residual.total_cmp(&run(b, shown).residual));
    if let (Some(&best), Some(&worst)) = (order.first(), order.last()) {
        let word = |method: usize| study.methods[method].name();
        let rest = if order.len() > 1 {
            format!(
                ", {} is the farthest with {}",
                word(worst),
                scientific(run(worst, shown).residual)
            )
        } else {
            String::new()
        };
        let at_target = order
            .iter()
            .filter(|&&method| run(method, shown).residual < super::ROUNDING);
        let at_target: Vec<String> = at_target.map(|&method| word(method).to_owned()).collect();
        let nearest = match at_target.len() {
            0 | 1 => format!(
                "{} is nearest with a residual of {}",
                word(best),
                scientific(run(best, shown).residual)
            ),
            _ => format!("{} are at the target but for rounding", listed(&at_target)),
        };
        document.paragraph(format!(
            "After {} {nearest}{rest}. Within the tolerance of {} by then: {}.",
            counted(study.shown_count() as usize, "iteration"),
            scientific(chain.tolerance),
            reached_names(numbers, target)
        ));
    }
    let floor = FLOOR_SHARE * chain.reach;
    let series = study
        .methods
        .iter()
        .enumerate()
        .map(|(method, solver)| Series {
            name: solver.name().to_owned(),
            style: solver.index(),
            has_marks: true,
            points: (0..study.counts.len())
                .map(|count| [f64::from(study.counts[count]), run(method, count).residual])
                .collect(),
            ..Series::default()
        });
    let series: Vec<Series> = series.collect();
    let values = series
        .iter()
        .flat_map(|series| &series.points)
        .map(|point| point[1]);
    let svg = draw(&Chart {
        alt: format!("residual against iterations at the target {name}"),
        x: Axis::log_of("iterations", &study.counts),
        y: Axis::powers_of_ten("residual", values.chain([chain.tolerance]), floor),
        panels: vec![Panel {
            title: String::new(),
            series,
        }],
        columns: 1,
        bound: Some((chain.tolerance, "tolerance".to_owned())),
    });
    document.blocks.push(Block::Drawing {
        svg,
        caption: format!(
            "Residual at the target {} against iterations, both axes logarithmic. Curves end at {}: poses are kept in \
             single precision, which shows no less.",
            code(name),
            scientific(floor)
        ),
    });
}

fn reached_names(numbers: Numbers<'_>, target: usize) -> String {
    let study = numbers.study;
    let reached = study.methods.iter().enumerate().filter(|&(method, _)| {
        let cell = Cell {
            chain: 0,
            target,
            method,
            count: study.shown,
        };
        numbers.results.run(cell).miss <= study.chains[0].tolerance
    });
    let names: Vec<String> = reached
        .map(|(_, method)| method.name().to_owned())
        .collect();
    if names.is_empty() {
        "none".to_owned()
    } else {
        listed(&names)
    }
}

/// Solvers by counts, at the first target.
fn picture_steps(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let mut rows = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let mut row = Vec::new();
        for count in 0..study.counts.len() {
            let cell = Cell {
                chain: 0,
                target: 0,
                method,
                count,
            };
            let run = numbers.results.run(cell);
            row.push(PictureEntry {
                shot: document.shot(Shot::Run(cell)),
                alt: format!("{} after {} iterations", solver.name(), study.counts[count]),
                lines: vec![Entry {
                    text: scientific(run.residual),
                    mark: reached_mark(run.miss <= chain.tolerance),
                }],
            });
        }
        rows.push((solver.name().to_owned(), row));
    }
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The pose of {} after so many iterations towards {}; under each the residual, green where it is within the \
             tolerance.",
            code(&chain.name),
            code(&study.targets[0][0].name)
        ),
        columns: study
            .counts
            .iter()
            .map(|&count| crate::text::counted(count as usize, "iteration"))
            .collect(),
        rows,
    }));
}

/// Green for what was reached, red for what was not.
pub(super) fn reached_mark(is_reached: bool) -> Mark {
    if is_reached { Mark::Good } else { Mark::Bad }
}

pub(super) fn write_many_targets(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let chain = &study.chains[0];
    let sample = study.targets[0]
        .iter()
        .filter(|target| is_judged(target))
        .count();
    if sample == 0 {
        return;
    }
    document.section("Many targets: the influence of the number of iterations");
    document.paragraph(format!(
        "One target may suit a solver by chance. Over {} for {}, medians and tenths say more.",
        counted(sample, "target") + " within reach",
        code(&chain.name)
    ));
    success_table(document, numbers);
    quantile_table(document, numbers);
    quantile_panels(document, numbers);
}

fn success_table(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let success = |method, count| numbers.success((0, method, count), is_judged);
    let rows = study.methods.iter().enumerate().map(|(method, solver)| {
        let mut row = vec![Entry::new(solver.name())];
        row.extend(
            (0..study.counts.len())
                .map(|count| Entry::new(success(method, count).map_or_else(String::new, percent))),
        );
        row
    });
    let mut rows: Vec<_> = rows.collect();
    for count in 0..study.counts.len() {
        let column: Vec<_> = (0..study.methods.len())
            .map(|method| success(method, count))
            .collect();
        mark_best(&mut rows, count + 1, &column, false);
    }
    let mut columns = vec!["iterations".to_owned()];
    columns.extend(study.counts.iter().map(u32::to_string));
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Success: the share of {} that {} reached within {} after so many iterations.",
            judged_words(study),
            code(&study.chains[0].name),
            scientific(study.chains[0].tolerance)
        ),
        columns,
        is_text: false,
        rows,
    }));
}

fn quantile_table(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let rows = study.methods.iter().enumerate().map(|(method, solver)| {
        let mut row = vec![Entry::new(solver.name())];
        row.extend((0..study.counts.len()).map(|count| {
            let found = numbers.misses((0, method, count), is_judged);
            Entry::new(found.map_or_else(String::new, |q| roughly(q.median)))
        }));
        row
    });
    let mut rows: Vec<_> = rows.collect();
    for count in 0..study.counts.len() {
        let column: Vec<_> = (0..study.methods.len())
            .map(|method| numbers.median_miss((0, method, count), is_judged))
            .collect();
        mark_best(&mut rows, count + 1, &column, true);
    }
    let mut columns = vec!["iterations".to_owned()];
    columns.extend(study.counts.iter().map(u32::to_string));
    document.blocks.push(Block::Table(Table {
        caption: "The median residual of the same runs.".to_owned(),
        columns,
        is_text: false,
        rows,
    }));
}

fn quantile_panels(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let is_judged = is_judged(study);
    let floor = FLOOR_SHARE * chain.reach;
    let mut values = vec![chain.tolerance];
    let mut panels = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let mut series = Series {
            style: solver.index(),
            has_marks: true,
            ..Series::default()
        };
        for (count, &iterations) in study.counts.iter().enumerate() {
            let x = f64::from(iterations);
            if let Some(found) = numbers.misses((0, method, count), is_judged) {
                series.points.push([x, found.median]);
                series.band.push([x, found.low, found.high]);
                values.extend([found.low, found.high]);
            }
        }
        panels.push(Panel {
            title: solver.name().to_owned(),
            series: vec![series],
        });
    }
    let svg = draw(&Chart {
        alt: "residual against iterations, median and tenths, a panel for each solver".to_owned(),
        x: Axis::log_of("iterations", &study.counts),
        y: Axis::powers_of_ten("residual", values, floor),
        columns: panels.len().min(4),
        panels,
        bound: Some((chain.tolerance, "tolerance".to_owned())),
    });
    document.blocks.push(Block::Drawing {
        svg,
        caption: "Residual against iterations over the same targets: the line is the median, the band holds all but the \
                  best and the worst tenth."
            .to_owned(),
    });
}
