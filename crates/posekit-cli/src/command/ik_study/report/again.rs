//! How to do it again: the report, and any number in it.

use super::super::document::{Block, Document, code};
use super::super::experiment::Cell;
use super::super::reproduce;
use super::super::targets::Kind;
use super::worst::worst;
use super::{Numbers, scientific};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>, command: &str) {
    document
        .paragraph("This command writes this report again, with the same numbers and pictures:");
    document.blocks.push(Block::Code(command.to_owned()));
    let times = if numbers.study.has_times {
        "Times, which differ from run to run, are in the table of effort, in the ranking and in the CSV; with \
         `--no-times` they are left out, and all files are the same to the byte."
    } else {
        "It was written with `--no-times`: all files are the same to the byte whenever it is run."
    };
    document.paragraph(format!(
        "Beside the report lie all runs as CSV, a line each; this text as Markdown; and the poses of the named targets \
         as a BVH file, whose frames the CSV's column `pose_frame` names. Forward kinematics of those poses gives the \
         residuals of the CSV as nearly as single precision holds them: `posekit fk` and three lines of NumPy check this \
         report. {times}"
    ));
    document.section("One number at a time");
    let first = Cell {
        chain: 0,
        target: 0,
        method: 0,
        count: numbers.study.shown,
    };
    document.paragraph(format!(
        "Every residual in this report is what one `posekit ik` leaves, which prints it. The first of these commands leaves {}. \
         Another `--solver` or `--iterations` gives the other numbers of the same target, another `--start`, `--end` and \
         `--target` those of other chains and places; the CSV has them for every run. Two-bone also takes the two joints that turn.",
        scientific(numbers.results.run(first).residual)
    ));
    write_runs(document, numbers, named_cells(numbers));
    let worst: Vec<Cell> = (0..numbers.study.methods.len())
        .filter_map(|method| worst(numbers, method))
        .map(|(run, _)| run.cell)
        .collect();
    if !worst.is_empty() {
        document.paragraph("The worst cases:");
        write_runs(document, numbers, worst);
    }
}

/// The usual number of iterations at each named target: of the first chain with every solver, of the others with
/// the first solver.
fn named_cells(numbers: Numbers<'_>) -> Vec<Cell> {
    let study = numbers.study;
    let mut cells = Vec::new();
    for (chain, list) in study.targets.iter().enumerate() {
        for (target, of) in list.iter().enumerate() {
            if of.kind != Kind::Named {
                continue;
            }
            let methods = if chain == 0 && target == 0 {
                study.methods.len()
            } else {
                1
            };
            cells.extend((0..methods).map(|method| Cell {
                chain,
                target,
                method,
                count: study.shown,
            }));
        }
    }
    cells
}

fn write_runs(document: &mut Document, numbers: Numbers<'_>, cells: Vec<Cell>) {
    let study = numbers.study;
    let runs = cells.into_iter().map(|cell| {
        let title = format!(
            "{} of {} to {}: {}",
            numbers.name(cell.method),
            code(&study.chains[cell.chain].name),
            code(&study.target(cell).name),
            scientific(numbers.results.run(cell).residual)
        );
        (title, reproduce::command(study, cell))
    });
    document.blocks.push(Block::Commands(runs.collect()));
}
