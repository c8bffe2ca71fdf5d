//! `posekit man`: the manual pages, made from the same text as `--help`.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;

use crate::args::{Cli, Global};
use crate::console;
use crate::failure::Failure;
use crate::output::{Guard, write_whole};

/// Print the manual page, or write a page for every command into a folder
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ManArgs {
    /// Write posekit.1 and a page for every command into this folder
    #[arg(long, value_name = "FOLDER")]
    out_dir: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  posekit man | man -l -
  posekit man --out-dir ~/.local/share/man/man1";

/// Writes the pages.
pub(crate) fn run(args: &ManArgs, global: &Global) -> Result<(), Failure> {
    let mut command = Cli::command();
    command.build();
    let Some(folder) = &args.out_dir else {
        let mut out = console::binary_stdout();
        out.write_all(&page(command)?)?;
        return Ok(out.flush()?);
    };
    for sub in command
        .get_subcommands()
        .filter(|sub| sub.get_name() != "help")
    {
        let name = format!("posekit-{}", sub.get_name());
        write_page(folder, &name, page(sub.clone())?, &global.guard)?;
    }
    write_page(folder, "posekit", page(command)?, &global.guard)
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    Ok(page)
}

fn write_page(folder: &Path, name: &str, page: Vec<u8>, guard: &Guard) -> Result<(), Failure> {
    let path = folder.join(format!("{name}.1"));
    let target = guard.target(&path, &format!("the page of {name}"))?;
    write_whole(&target, |file| file.write_all(&page))
}
