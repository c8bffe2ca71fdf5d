//! The `posekit` command: arguments, files, threads, progress and exit codes around the library.

mod args;
mod batch;
mod bytes;
mod command;
mod console;
mod extension;
mod failure;
mod graphics_env;
mod inputs;
mod jobs;
mod kind;
mod load;
mod output;
mod positions;
mod program;
mod progress;
mod reading;
mod sample;
mod scene_file;
mod select;
mod similar;
mod text;
mod up;

use std::io::{self, Write};
use std::process::ExitCode;

use args::Command;
use failure::{EXIT_DONE, EXIT_WRONG_USAGE, Failure};

fn main() -> ExitCode {
    let cli = match args::parse(std::env::args_os()) {
        Ok(cli) => cli,
        Err(answer) => return tell(&answer),
    };
    if cli.may_use_graphics() {
        graphics_env::keep_quiet();
    }
    console::set_color(cli.global.color);
    console::set_quiet(cli.global.quiet);
    output::remove_unfinished_on_interrupt();
    let Some(command) = cli.command else {
        return finish(command::start::run(&cli.global));
    };
    finish(match command {
        Command::Info(args) => command::info::run(&args, &cli.global),
        Command::Check(args) => command::check::run(&args, &cli.global),
        Command::Fix(args) => command::fix::run(&args, &cli.global),
        Command::Fk(args) => command::fk::run(&args, &cli.global),
        Command::Convert(args) => command::convert::run(&args, &cli.global),
        Command::Ik(args) => command::ik::run(&args, &cli.global),
        Command::IkStudy(args) => command::ik_study::run(&args, &cli.global),
        #[cfg(feature = "window")]
        Command::View(args) => command::view::run(&args, &cli.global),
        Command::Serve(args) => command::serve::run(&args, &cli.global),
        Command::Render(args) => command::render::run(&args, &cli.global),
        Command::Keys(args) => command::keys::run(&args, &cli.global),
        Command::Inbetween(args) => command::inbetween::run(&args, &cli.global),
        Command::Slerp(args) => command::slerp::run(&args),
        Command::Sample(args) => command::sample::run(&args, &cli.global),
        Command::Completions(args) => command::completions::run(&args),
        Command::Man(args) => command::man::run(&args, &cli.global),
    })
}

/// Prints what the command line alone is answered with: help, the version, or what is wrong with it.
fn tell(answer: &clap::Error) -> ExitCode {
    if answer.use_stderr() {
        console::styled_error(&args::plain(answer));
        return ExitCode::from(EXIT_WRONG_USAGE);
    }
    let told = answer.print().and_then(|()| io::stdout().flush());
    finish(told.map_err(Failure::from))
}

/// Says what went wrong, if anything, and gives the exit code.
fn finish(result: Result<(), Failure>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::from(EXIT_DONE),
        Err(failure) => {
            if !matches!(failure, Failure::ClosedPipe) {
                failure.say();
            }
            ExitCode::from(failure.exit_code())
        }
    }
}
