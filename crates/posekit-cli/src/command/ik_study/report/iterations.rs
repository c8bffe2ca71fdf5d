//! How the number of iterations counts: for one target, and for many.

use super::super::chart::{Axis, Chart, Panel, Series, draw};
use super::super::document::{
    Block, Document, Entry, PictureEntry, PictureTable, Shot, Table, code,
};
use super::super::experiment::{Cell, Run};
use super::super::targets::Kind;
use super::{
    Numbers, counted, is_judged, judged_words, listed, mark_best, outcome_mark, outcome_words,
    percent, roughly, scientific,
};

pub(super) fn write_one_target(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.section("One target, iteration by iteration");
    for (index, target) in study.targets[0].iter().enumerate() {
        if target.kind == Kind::Named {
            write_named(document, numbers, index);
        }
    }
    let bold = match study.methods.len() {
        1 => "",
        _ => "The bold number of a column is its smallest. ",
    };
    document.paragraph(format!(
        "{bold}Pictures of the same runs show what numbers do not: which joints a solver uses."
    ));
    picture_steps(document, numbers);
}

fn write_named(document: &mut Document, numbers: Numbers<'_>, target: usize) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let target_of = &study.targets[0][target];
    let name = &target_of.name;
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
            "Residual of {} at the target {} by the number of iterations. Before the first it is {}.{}",
            code(&chain.name),
            code(name),
            scientific(before),
            if target_of.is_out_of_reach() {
                format!(" The target is out of reach: no pose leaves less than {}.", scientific(target_of.beyond))
            } else {
                String::new()
            }
        ),
        columns,
        is_text: false,
        rows,
    }.fitted()));
    document.paragraph(arrivals_sentence(numbers, target));
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
        y: Axis::powers_of_ten("residual", values.chain([chain.tolerance]), super::ROUNDING),
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
            "Residual at the target {} against iterations, both axes logarithmic. Curves end at {:.0e}: rounding in double precision allows no less.",
            code(name),
            super::ROUNDING
        ),
    });
}

/// How many iterations took each solver to a named target.
fn arrivals_sentence(numbers: Numbers<'_>, target: usize) -> String {
    let study = numbers.study;
    let chain = &study.chains[0];
    let methods = 0..study.methods.len();
    if study.targets[0][target].is_out_of_reach() {
        let nearest: Vec<String> = methods
            .filter(|&method| {
                let cell = Cell {
                    chain: 0,
                    target,
                    method,
                    count: numbers.last(),
                };
                numbers.results.run(cell).miss <= chain.tolerance
            })
            .map(|method| numbers.name(method))
            .collect();
        return format!(
            "As near to the target as possible, within the tolerance of {}, in {}: {}.",
            scientific(chain.tolerance),
            counted(study.last_count() as usize, "iteration"),
            if nearest.is_empty() {
                "no solver".to_owned()
            } else {
                listed(&nearest)
            }
        );
    }
    let arrival = |method| numbers.results.arrival(0, target, method).iterations;
    let mut there: Vec<(u32, usize)> = methods
        .clone()
        .filter_map(|method| Some((arrival(method)?, method)))
        .collect();
    there.sort_unstable();
    let never: Vec<String> = methods
        .filter(|&method| arrival(method).is_none())
        .map(|method| numbers.name(method))
        .collect();
    let each: Vec<String> = there
        .iter()
        .map(|&(count, method)| format!("{} after {count}", numbers.name(method)))
        .collect();
    let never = if never.is_empty() {
        String::new()
    } else {
        let last = counted(study.last_count() as usize, "iteration");
        format!("; not in {last}: {}", listed(&never))
    };
    format!(
        "Iterations until the end is within the tolerance of {}: {}{never}.",
        scientific(chain.tolerance),
        if each.is_empty() {
            "no solver gets there".to_owned()
        } else {
            listed(&each)
        }
    )
}

/// Solvers by counts, at the first target.
fn picture_steps(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let shown = pictured_counts(study.counts.len(), study.shown);
    let mut rows = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let mut row = Vec::new();
        for &count in &shown {
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
                    mark: outcome_mark(study, run),
                }],
            });
        }
        rows.push((solver.name().to_owned(), row));
    }
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The pose of {} on its way to {}, by the number of iterations; under each the residual, {}.",
            code(&chain.name),
            code(&study.targets[0][0].name),
            outcome_words(study.targets[0][0].is_out_of_reach())
        ),
        columns: shown
            .iter()
            .map(|&count| crate::text::counted(study.counts[count] as usize, "iteration"))
            .collect(),
        rows,
    }));
}

/// Which of the numbers of iterations are pictured: all, or, of more than fit side by side, the first, the usual
/// one, the last, and some between them.
fn pictured_counts(count: usize, usual: usize) -> Vec<usize> {
    const MOST: usize = 7;
    if count <= MOST {
        return (0..count).collect();
    }
    let mut chosen: Vec<usize> = (0..MOST - 1)
        .map(|index| index * (count - 1) / (MOST - 2))
        .chain([usual])
        .collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// From so many targets on a tenth of them is at least one.
const FEW: usize = 10;

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
    let (targets, name) = (counted(sample, "target"), code(&chain.name));
    document.paragraph(format!(
        "One target may suit a solver by chance. {}",
        match sample {
            FEW.. => format!("Medians and tenths over {targets} within reach of {name} say more."),
            1 => format!("There is one more within reach of {name}; `--random` makes more."),
            _ => format!("There are {targets} within reach of {name}; `--random` makes more."),
        }
    ));
    success_table(document, numbers);
    quantile_table(document, numbers);
    quantile_panels(document, numbers);
    loss_table(document, numbers);
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
            "Success by the number of iterations: the share of {} to which the end of {} came within {}.",
            judged_words(study),
            code(&study.chains[0].name),
            scientific(study.chains[0].tolerance)
        ),
        columns,
        is_text: false,
        rows,
    }.fitted()));
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
    document.blocks.push(Block::Table(
        Table {
            caption: "The median residual of the same runs.".to_owned(),
            columns,
            is_text: false,
            rows,
        }
        .fitted(),
    ));
}

fn quantile_panels(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let is_judged = is_judged(study);
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
        y: Axis::powers_of_ten("residual", values, super::ROUNDING),
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

/// What more iterations made worse, over all targets of all chains.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Losses {
    /// Targets that were within the tolerance after some number of iterations and not after a larger one.
    pub(super) lost: usize,
    /// Targets whose residual rose from one number of iterations to the next.
    pub(super) rose: usize,
    /// The largest such rise, as a share of the chain's reach.
    largest_share: f64,
}

/// What more iterations made worse with a solver.
pub(super) fn losses(numbers: Numbers<'_>, method: usize) -> Losses {
    let study = numbers.study;
    let mut losses = Losses::default();
    for (chain, list) in study.targets.iter().enumerate() {
        let of = &study.chains[chain];
        for target in 0..list.len() {
            let misses: Vec<f64> = (0..study.counts.len())
                .map(|count| {
                    let cell = Cell {
                        chain,
                        target,
                        method,
                        count,
                    };
                    numbers.results.run(cell).miss
                })
                .collect();
            let first_near = misses.iter().position(|&miss| miss <= of.tolerance);
            let is_lost = first_near
                .is_some_and(|first| misses[first..].iter().any(|&miss| miss > of.tolerance));
            let rises = misses.windows(2).map(|pair| pair[1] - pair[0]);
            let rise = rises.fold(0.0, f64::max);
            losses.lost += usize::from(is_lost);
            if rise > super::ROUNDING {
                losses.rose += 1;
                losses.largest_share = losses.largest_share.max(rise / of.reach);
            }
        }
    }
    losses
}

fn loss_table(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    if study.counts.len() < 2 {
        return;
    }
    let all: usize = study.targets.iter().map(Vec::len).sum();
    let rows = study.methods.iter().enumerate().map(|(method, solver)| {
        let losses = losses(numbers, method);
        vec![
            Entry::new(solver.name()),
            Entry::new(losses.lost.to_string()),
            Entry::new(losses.rose.to_string()),
            Entry::new(if losses.rose == 0 {
                "–".to_owned()
            } else {
                format!("{:.1e} %", 100.0 * losses.largest_share)
            }),
        ]
    });
    let rows = rows.collect();
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Do more iterations ever make it worse? Over the {} targets of all chains: at how many the end was within the tolerance \
             after one number of iterations and not after a larger one; at how many the residual rose from one number to the \
             next by more than rounding; and the largest such rise, in percent of the reach.",
            crate::text::grouped(all)
        ),
        columns: ["solver", "targets lost again", "targets with a rise", "largest rise"].map(str::to_owned).to_vec(),
        is_text: false,
        rows,
    }));
}

#[cfg(test)]
mod tests {
    use super::pictured_counts;

    #[test]
    fn as_many_counts_are_pictured_as_fit() {
        assert_eq!(pictured_counts(3, 1), [0, 1, 2]);
        assert_eq!(pictured_counts(16, 10), [0, 3, 6, 9, 10, 12, 15]);
        assert_eq!(pictured_counts(16, 15), [0, 3, 6, 9, 12, 15]);
    }
}
