//! The worst cases, shown.

use super::super::document::{
    Block, Document, Entry, Mark, PictureEntry, PictureTable, Shot, code,
};
use super::super::experiment::Run;
use super::{Numbers, counted, is_judged, judged_words, scientific};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.section("The worst cases");
    let mut row = Vec::new();
    let mut kept = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let Some((run, share)) = worst(numbers, method) else {
            continue;
        };
        let (cell, chain) = (run.cell, &study.chains[run.cell.chain]);
        if run.miss <= chain.tolerance {
            kept.push(solver.name().to_owned());
        }
        let target = &study.targets[cell.chain][cell.target];
        let mark = super::outcome_mark(study, run);
        row.push(PictureEntry {
            shot: document.shot(Shot::Run(cell)),
            alt: format!("the worst case of {}", solver.name()),
            lines: vec![
                Entry {
                    text: scientific(run.residual),
                    mark,
                },
                Entry {
                    text: if share < 5e-5 {
                        "< 0.01 % of reach".to_owned()
                    } else {
                        format!("{:.2} % of reach", share * 100.0)
                    },
                    mark: Mark::None,
                },
                Entry::new(code(&chain.name)),
                Entry::new(target.name.clone()),
            ],
        });
    }
    if row.is_empty() {
        document.paragraph("No target within reach was tried.");
        return;
    }
    let names = row
        .iter()
        .zip(&study.methods)
        .map(|(_, method)| method.name().to_owned())
        .collect();
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The worst run of each solver: the one that stays farthest from its target, as a share of the reach of its chain, after {}, of \
             all {} of all chains.",
            counted(study.counts[numbers.last()] as usize, "iteration"),
            judged_words(study)
        ),
        columns: names,
        rows: vec![(String::new(), row)],
    }));
    if !kept.is_empty() {
        document.paragraph(format!(
            "Even in the worst case within the tolerance: {}.",
            super::listed(&kept)
        ));
    }
}

/// The run of a solver that missed by the largest share of the reach with the most iterations, and that share.
pub(super) fn worst<'a>(numbers: Numbers<'a>, method: usize) -> Option<(&'a Run, f64)> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let mut worst: Option<(&Run, f64)> = None;
    for (chain, of) in study.chains.iter().enumerate() {
        for run in numbers.over((chain, method, numbers.last()), is_judged) {
            let share = run.miss / of.reach;
            if worst.is_none_or(|(_, most)| share > most) {
                worst = Some((run, share));
            }
        }
    }
    worst
}
