//! `posekit ik-study`: solvers of inverse kinematics compared on a figure, as a report.
//!
//! Options and file become a [`setup::Study`]; [`experiment`] and [`moving`] run it; [`report`] says in a
//! [`document::Document`] what came out; [`pictures`] takes the pictures that it refers to; [`html`] and
//! [`markdown`] write it, with the `posekit ik` commands of [`reproduce`]. All but times is the same for the same options, byte for byte.

mod args;
mod chart;
mod document;
mod experiment;
mod html;
mod linkage;
mod markdown;
mod method;
mod moving;
mod pictures;
mod report;
mod reproduce;
mod setup;
mod statistics;
mod table_files;
mod targets;

use std::io::Write;

use crate::args::Global;
use crate::console;
use crate::failure::Failure;
use crate::jobs;
use crate::output::{Target, write_whole};
use crate::text::grouped;
pub(crate) use args::IkStudyArgs;

/// Runs the command.
pub(crate) fn run(args: &IkStudyArgs, global: &Global) -> Result<(), Failure> {
    let is_html = args
        .output
        .extension()
        .is_some_and(|extension| extension == "html" || extension == "htm");
    if !is_html {
        return Err(Failure::usage("the report's name ends in .html")
            .try_next("its .csv, .md and .bvh go beside it"));
    }
    let beside = |extension: &str, of: &str| {
        let path = args.output.with_extension(extension);
        global.guard.target(&path, of)
    };
    let page = global.guard.target(&args.output, "the report")?;
    let numbers_file = beside("csv", "the report's numbers")?;
    let poses_file = beside("bvh", "the report's poses")?;
    let text_file = beside("md", "the report's text")?;
    let study = setup::study(args, global)?;
    let workers = global.jobs.unwrap_or_else(jobs::default_workers);
    let results = experiment::run(&study, workers, global.quiet)?;
    let following = moving::run(&study);
    let numbers = report::Numbers {
        study: &study,
        results: &results,
        following: &following,
    };
    let document = report::compose(numbers, &command_line());
    let pictures = pictures::take(&study, &document.shots, workers, global.quiet)?;
    let write = |target: &Target, bytes: &[u8]| write_whole(target, |file| file.write_all(bytes));
    write(&numbers_file, table_files::csv(&study, &results).as_bytes())?;
    write(&poses_file, &table_files::poses(&study, &results))?;
    write(&text_file, markdown::write(&document).as_bytes())?;
    write(&page, html::write(&document, &pictures).as_bytes())?;
    if !global.quiet {
        let runs = grouped(results.all().len());
        console::note(&format!(
            "wrote {}: {runs} runs of solvers; with .csv, .md and .bvh beside it",
            args.output.display()
        ));
    }
    Ok(())
}

/// What was typed.
fn command_line() -> String {
    let typed = std::env::args_os().skip(1);
    let typed = typed.map(|word| word.to_string_lossy().into_owned());
    reproduce::line(std::iter::once("posekit".to_owned()).chain(typed))
}
