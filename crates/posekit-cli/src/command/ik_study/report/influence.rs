//! What the place of the target changes, and what the chain does.

use super::super::document::{
    Block, Document, Entry, PictureEntry, PictureTable, Shot, Table, code,
};
use super::super::experiment::Cell;
use super::super::statistics::median;
use super::super::targets::{Kind, Target};
use super::summary::agree;
use super::{
    Numbers, capitalized, counted, is_judged, judged_words, length, mark_best, number,
    outcome_mark, outcome_words, percent, roughly, scientific,
};

/// Rings around the base into which targets fall, as shares of the reach.
const RINGS: [(f64, f64, &str); 4] = [
    (0.0, 0.5, "to 50 % of reach"),
    (0.5, 0.75, "50 to 75 %"),
    (0.75, 0.9, "75 to 90 %"),
    (0.9, 1.0, "90 to 100 %"),
];

pub(super) fn write_place(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.section("The influence of the target's place");
    picture_grid(document, numbers);
    let chain = &study.chains[0];
    let ring = |target: &Target| {
        let share = chain.base().distance(target.place) / chain.reach;
        RINGS
            .iter()
            // Straight to the target, but for rounding.
            .position(|&(low, high, _)| {
                !target.is_out_of_reach() && (low..=high + 1e-9).contains(&share)
            })
    };
    let mut columns: Vec<(String, Vec<bool>)> = Vec::new();
    for (index, &(_, _, name)) in RINGS.iter().enumerate() {
        let inside: Vec<bool> = study.targets[0]
            .iter()
            .map(|target| ring(target) == Some(index))
            .collect();
        columns.push((name.to_owned(), inside));
    }
    columns.retain(|(_, inside)| inside.iter().any(|&is_inside| is_inside));
    let shown = study.shown;
    let mut rows: Vec<Vec<Entry>> = study
        .methods
        .iter()
        .map(|method| vec![Entry::new(method.name())])
        .collect();
    let mut titles = vec!["distance from the base".to_owned()];
    for (column, (name, inside)) in columns.iter().enumerate() {
        let size = inside.iter().filter(|&&is_inside| is_inside).count();
        titles.push(format!("{name} ({size})"));
        let mut shares = Vec::new();
        for (method, row) in rows.iter_mut().enumerate() {
            let runs: Vec<_> = inside
                .iter()
                .enumerate()
                .filter(|&(_, &is_inside)| is_inside)
                .map(|(target, _)| {
                    *numbers.results.run(Cell {
                        chain: 0,
                        target,
                        method,
                        count: shown,
                    })
                })
                .collect();
            let reached = super::share(runs.iter().map(|run| run.miss <= chain.tolerance));
            let middle = median(runs.iter().map(|run| run.miss)).unwrap_or(0.0);
            row.push(Entry::new(format!(
                "{} · {}",
                percent(reached.unwrap_or(0.0)),
                roughly(middle)
            )));
            shares.push(reached);
        }
        mark_best(&mut rows, column + 1, &shares, false);
    }
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "All targets within reach of {} by their distance from its base (in brackets, how many): the share that was reached after \
             {}, and the median residual.",
            code(&chain.name),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns: titles,
        is_text: false,
        rows,
    }));
    out_of_reach_table(document, numbers);
}

/// How near solvers come where the target cannot be reached.
fn out_of_reach_table(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    let count = study.targets[0]
        .iter()
        .filter(|target| target.is_out_of_reach())
        .count();
    if count == 0 {
        return;
    }
    let mut keys = Vec::new();
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let at = (0, method, study.shown);
        let near = numbers.success(at, Target::is_out_of_reach);
        let middle = numbers.median_miss(at, Target::is_out_of_reach);
        rows.push(vec![
            Entry::new(solver.name()),
            Entry::new(near.map_or_else(String::new, percent)),
            Entry::new(middle.map_or_else(String::new, scientific)),
        ]);
        keys.push((near, middle));
    }
    let near: Vec<_> = keys.iter().map(|keys| keys.0).collect();
    let middle: Vec<_> = keys.iter().map(|keys| keys.1).collect();
    mark_best(&mut rows, 1, &near, false);
    mark_best(&mut rows, 2, &middle, true);
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "The {} out of reach of {}, which are left out of every success rate: the share for which the end came within the tolerance of the nearest \
             place that there is after {}, and the median miss, which is how much farther from the target it stayed than it has to.",
            counted(count, "target"),
            code(&chain.name),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns: ["solver", "as near as can be", "median miss"].map(str::to_owned).to_vec(),
        is_text: false,
        rows,
    }));
}

fn picture_grid(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    if study.grid == 0 {
        return;
    }
    let chain = &study.chains[0];
    let (method, solver) = (0, study.methods[0]);
    let mut rows = Vec::new();
    // Within reach and out of reach: how many, and how many of them the solver did all it could for.
    let (mut within, mut outside) = ([0, 0], [0, 0]);
    for (target, of) in study.targets[0].iter().enumerate() {
        let Kind::Grid { column, .. } = of.kind else {
            continue;
        };
        if column == 0 {
            rows.push((
                format!("y = {}", length(of.place.y, chain.reach)),
                Vec::new(),
            ));
        }
        let cell = Cell {
            chain: 0,
            target,
            method,
            count: study.shown,
        };
        let run = numbers.results.run(cell);
        let tally = if of.is_out_of_reach() {
            &mut outside
        } else {
            &mut within
        };
        tally[0] += 1;
        tally[1] += usize::from(run.miss <= chain.tolerance);
        let mut lines = vec![Entry {
            text: scientific(run.residual),
            mark: outcome_mark(study, run),
        }];
        lines.push(Entry::new(if of.is_out_of_reach() {
            format!("{} out of reach", length(of.beyond, chain.reach))
        } else {
            format!("x = {}", length(of.place.x, chain.reach))
        }));
        let picture = PictureEntry {
            shot: document.shot(Shot::Run(cell)),
            alt: format!("{} at {}", solver.name(), of.name),
            lines,
        };
        if let Some((_, row)) = rows.last_mut() {
            row.push(picture);
        }
    }
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "{} with {} after {} at the targets of the grid, laid out as they lie in front of the figure; under each the residual, \
             {}.",
            solver.name(),
            code(&chain.name),
            counted(study.shown_count() as usize, "iteration"),
            outcome_words(outside[0] > 0)
        ),
        columns: Vec::new(),
        rows,
    }));
    let out = if outside[0] > 0 {
        format!(
            " {} of the grid {} out of reach; it comes as near as can be to {} of them.",
            capitalized(&counted(outside[0], "target")),
            agree(outside[0], "is", "are"),
            number(outside[1])
        )
    } else {
        String::new()
    };
    document.paragraph(format!(
        "In {} {} reaches {} of the {} of the grid that {} within reach.{out}",
        counted(study.shown_count() as usize, "iteration"),
        solver.name(),
        number(within[1]),
        counted(within[0], "target"),
        agree(within[0], "is", "are"),
    ));
}

pub(super) fn write_chain(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    document.section("The influence of the chain");
    if study.chains.len() == 1 {
        document.paragraph(
            "There is only one chain in this study; `--chain`, repeated, compares several.",
        );
    }
    let shown = study.shown;
    let mut rows: Vec<Vec<Entry>> = study
        .methods
        .iter()
        .map(|method| vec![Entry::new(method.name())])
        .collect();
    let mut columns = vec!["solver".to_owned()];
    for (index, chain) in study.chains.iter().enumerate() {
        columns.push(code(&chain.name));
        let mut shares = Vec::new();
        for (method, row) in rows.iter_mut().enumerate() {
            let at = (index, method, shown);
            let reached = numbers.success(at, is_judged);
            let middle = numbers.median_miss(at, is_judged);
            let turned = median(numbers.over(at, is_judged).map(|run| run.motion_rad));
            row.push(match (reached, middle, turned) {
                (Some(reached), Some(middle), Some(turned)) => Entry::new(format!(
                    "{} · {:.2} % · {}",
                    percent(reached),
                    100.0 * middle / chain.reach,
                    super::degrees(turned)
                )),
                _ => Entry::default(),
            });
            shares.push(reached);
        }
        mark_best(&mut rows, index + 1, &shares, false);
    }
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "Each chain and its own {} after {}: the share that was reached; the median residual in percent of the chain's \
             reach; the median joint motion.",
            judged_words(study),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns,
        is_text: false,
        rows,
    }));
    picture_chains(document, numbers);
}

/// Chains by solvers, at the first target.
fn picture_chains(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let mut any_is_out = false;
    let mut rows = Vec::new();
    for (index, chain) in study.chains.iter().enumerate() {
        let mut row = Vec::new();
        for (method, solver) in study.methods.iter().enumerate() {
            let cell = Cell {
                chain: index,
                target: 0,
                method,
                count: study.shown,
            };
            let run = numbers.results.run(cell);
            row.push(PictureEntry {
                shot: document.shot(Shot::Run(cell)),
                alt: format!("{} with the chain {}", solver.name(), chain.name),
                lines: vec![Entry {
                    text: scientific(run.residual),
                    mark: outcome_mark(study, run),
                }],
            });
        }
        let beyond = study.targets[index][0].beyond;
        let out = if beyond > 0.0 {
            any_is_out = true;
            format!(" ({} out of reach)", length(beyond, chain.reach))
        } else {
            String::new()
        };
        rows.push((format!("{}{out}", code(&chain.name)), row));
    }
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The same target, {}, with each chain after {}; under each the residual, {}.",
            code(&study.targets[0][0].name),
            counted(study.shown_count() as usize, "iteration"),
            outcome_words(any_is_out)
        ),
        columns: study
            .methods
            .iter()
            .map(|method| method.name().to_owned())
            .collect(),
        rows,
    }));
}
