//! `posekit completions`: a script that makes a shell complete our commands and options.

use std::io::Write;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::args::Cli;
use crate::console;
use crate::failure::Failure;

/// Print a script that completes posekit's commands and options in a shell
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  bash:  posekit completions bash > ~/.local/share/bash-completion/completions/posekit
  zsh:   posekit completions zsh > ~/.zfunc/_posekit     (with ~/.zfunc in $fpath)
  fish:  posekit completions fish > ~/.config/fish/completions/posekit.fish";

/// Writes the script to standard output.
pub(crate) fn run(args: &CompletionsArgs) -> Result<(), Failure> {
    // Into memory first: the generator panics when its output goes away.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "posekit", &mut script);
    let mut out = console::binary_stdout();
    out.write_all(&script)?;
    Ok(out.flush()?)
}
