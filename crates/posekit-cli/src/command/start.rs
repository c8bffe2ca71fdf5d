//! `posekit` alone: shows a walking figure, in a window or, with no display, as a film.

use std::path::{Path, PathBuf};

use clap::Parser;

use crate::args::{Cli, Command, Global};
use crate::console;
use crate::failure::Failure;

/// Names that are tried when `walk.mp4` and its successors are there already.
const MOST_NAMES: usize = 10_000;

/// Shows the sample clip moving.
pub(crate) fn run(global: &Global) -> Result<(), Failure> {
    match window() {
        Ok(()) => Ok(()),
        Err(why) => film(&why, global),
    }
}

/// Opens the window, or says why there is none.
#[cfg(feature = "window")]
fn window() -> Result<(), String> {
    if !super::view::has_display() {
        return Err("there is no display to open a window on".to_owned());
    }
    posekit_viewer::run_native(posekit_viewer::ViewerOptions::default())
        .map_err(|error| error.to_string())
}

#[cfg(not(feature = "window"))]
fn window() -> Result<(), String> {
    Err("this posekit was built without its window".to_owned())
}

fn film(why: &str, global: &Global) -> Result<(), Failure> {
    let extension = if cfg!(feature = "h264") { "mp4" } else { "gif" };
    let path = free_name("walk", extension)?;
    if !global.quiet {
        console::note(&format!("{why}, so this makes a film of a walking figure"));
    }
    let words = [
        "posekit".as_ref(),
        "render".as_ref(),
        "sample:walk".as_ref(),
        "-o".as_ref(),
        path.as_os_str(),
    ];
    let cli = Cli::try_parse_from(words)
        .map_err(|error| Failure::new(format!("cannot render the sample: {error}")))?;
    let Some(Command::Render(args)) = cli.command else {
        return Err(Failure::new("cannot render the sample"));
    };
    super::render::run(&args, global)
}

/// `walk.mp4`, or `walk-2.mp4` and so on: no file is ever replaced unasked.
fn free_name(stem: &str, extension: &str) -> Result<PathBuf, Failure> {
    let first = format!("{stem}.{extension}");
    let others = (2..MOST_NAMES).map(|number| format!("{stem}-{number}.{extension}"));
    std::iter::once(first)
        .chain(others)
        .map(PathBuf::from)
        // A link that leads nowhere is a name that is taken too.
        .find(|path| Path::new(path).symlink_metadata().is_err())
        .ok_or_else(|| {
            Failure::new("every name for the film is taken")
                .try_next("posekit render sample:walk -o NAME.mp4")
        })
}
