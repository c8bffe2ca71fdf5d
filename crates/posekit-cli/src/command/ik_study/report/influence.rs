//! What the place of the target changes, and what the chain does.

use super::super::document::{
    Block, Document, Entry, PictureEntry, PictureTable, Shot, Table, code,
};
use super::super::experiment::Cell;
use super::super::statistics::median;
use super::super::targets::{Kind, Target};
use super::iterations::reached_mark;
use super::{
    Numbers, counted, is_judged, judged_words, length, mark_best, percent, roughly, scientific,
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
            .position(|&(low, high, _)| target.beyond == 0.0 && (low..=high).contains(&share))
    };
    let mut columns: Vec<(String, Vec<bool>)> = Vec::new();
    for (index, &(_, _, name)) in RINGS.iter().enumerate() {
        let inside: Vec<bool> = study.targets[0]
            .iter()
            .map(|target| ring(target) == Some(index))
            .collect();
        columns.push((name.to_owned(), inside));
    }
    let outside = study.targets[0].iter().map(|target| target.beyond > 0.0);
    columns.push(("out of reach".to_owned(), outside.collect()));
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
            "All targets of {} by their distance from its base, in brackets how many: the share that was reached after \
             {}, and the median miss. Out of reach, reached means stretched out to within the tolerance of the nearest \
             place there is.",
            code(&chain.name),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns: titles,
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
    let mut failures = Vec::new();
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
        let is_reached = run.miss <= chain.tolerance;
        if !is_reached {
            failures.push(of.beyond > 0.0);
        }
        let mut lines = vec![Entry {
            text: scientific(run.residual),
            mark: reached_mark(is_reached),
        }];
        lines.push(Entry::new(if of.beyond > 0.0 {
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
    let out = failures.iter().filter(|&&is_out| is_out).count();
    let (count, missed) = ((study.grid * study.grid) as usize, failures.len());
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "{} of {} after {} at the targets of the grid, laid out as they lie in front of the figure; under each the \
             residual, green where the target was reached as nearly as it can be.",
            solver.name(),
            code(&chain.name),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns: Vec::new(),
        rows,
    }));
    document.paragraph(format!(
        "Of {} of the grid {} came as near as can be to {} within {}; of those that it missed, {out} lie out of reach.",
        counted(count, "target"),
        solver.name(),
        count - missed,
        counted(study.shown_count() as usize, "iteration"),
    ));
}

pub(super) fn write_chain(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let is_judged = is_judged(study);
    document.section("The influence of the chain");
    if study.chains.len() == 1 {
        document.paragraph("Only one chain was asked for; `--chain`, repeated, compares several.");
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
            "Each chain's {} after {}: the share that was reached; the median residual in percent of the reach; the \
             median of the joint motion.",
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
                    mark: reached_mark(run.miss <= chain.tolerance),
                }],
            });
        }
        let beyond = study.targets[index][0].beyond;
        let out = if beyond > 0.0 {
            format!(" ({} out of reach)", length(beyond, chain.reach))
        } else {
            String::new()
        };
        rows.push((format!("{}{out}", code(&chain.name)), row));
    }
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The same target, {}, with each chain after {}; under each the residual, green where it is as small as it \
             can be.",
            code(&study.targets[0][0].name),
            counted(study.shown_count() as usize, "iteration")
        ),
        columns: study.methods.iter().map(|method| method.name().to_owned()).collect(),
        rows,
    }));
}
