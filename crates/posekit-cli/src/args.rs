//! The command line: what is common to all commands, and the list of commands.

use std::error::Error as _;
use std::ffi::OsString;
use std::num::{NonZeroUsize, ParseFloatError, ParseIntError};

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use posekit_render::render::RendererChoice;

use crate::command;
use crate::console::ColorWhen;
use crate::output::Guard;

/// Skeletal character animation from motion data
///
/// Reads BVH motion capture files, shows them moving, says what is in them, turns them into joint positions,
/// and converts them. Without a command it shows a walking figure: in a window, or, where there is no
/// display, as a film in this folder. A FILE may be a file, a folder (all the .bvh files in it and below), a pattern such as
/// 'takes/**/*.bvh', '-' for standard input, or a clip that posekit makes itself: sample:walk,
/// sample:run, sample:wave, sample:arm.
#[derive(Debug, Parser)]
#[command(name = "posekit", version, max_term_width = 100, after_help = EXAMPLES)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) global: Global,
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

const EXAMPLES: &str = "\
Examples:
  posekit view walk.bvh                   a window in which it moves
  posekit info walk.bvh                   what is in the file
  posekit fk walk.bvh                     where every joint goes, as a table
  posekit fk walk.bvh -o walk.npz         ... as NumPy arrays
  posekit fk takes/ -o arrays/            ... for a folder, on all cores
  posekit check walk.bvh                  what is suspicious in it
  posekit convert walk.bvh w30.bvh --fps 30
  posekit ik walk.bvh --end LeftHand --offset 0,0.2,0 -o out.bvh
  posekit render walk.bvh -o walk.mp4     a film of it

Exit codes: 0 done, 1 something could not be done, 2 wrong usage";

/// Options that every command takes.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Options of every command")]
pub(crate) struct Global {
    /// Number of files worked on at once [default: one per core]
    #[arg(long, short = 'j', global = true, value_name = "N")]
    pub(crate) jobs: Option<NonZeroUsize>,
    /// No progress, notes or warnings; errors are still shown
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
    /// Treat a file that needs repair as an error
    #[arg(long, global = true)]
    pub(crate) strict: bool,
    /// When output is coloured
    #[arg(
        long,
        global = true,
        value_name = "WHEN",
        default_value = "auto",
        hide_possible_values = true
    )]
    pub(crate) color: ColorWhen,
    /// The files that the command reads and writes.
    #[arg(skip)]
    pub(crate) guard: Guard,
}

/// The command line in the program's terms, or what it is answered with: help, the version, or what is wrong.
pub(crate) fn parse(words: impl IntoIterator<Item = OsString>) -> Result<Cli, clap::Error> {
    let matches = with_negative_numbers(Cli::command()).try_get_matches_from(words)?;
    Cli::from_arg_matches(&matches)
}

/// A value such as -1 is what its option makes of it: not an option of its own, which nobody meant.
fn with_negative_numbers(command: clap::Command) -> clap::Command {
    command
        .mut_args(|arg| {
            let takes_value = arg.get_action().takes_values() && !arg.is_positional();
            match takes_value && !arg.is_allow_hyphen_values_set() {
                true => arg.allow_negative_numbers(true),
                false => arg,
            }
        })
        .mut_subcommands(with_negative_numbers)
}

/// What is wrong with the command line, with plain words in place of those that numbers are refused with.
pub(crate) fn plain(answer: &clap::Error) -> String {
    let text = answer.render().ansi().to_string();
    let Some(refused) = answer.source() else {
        return text;
    };
    let words = if refused.is::<ParseFloatError>() {
        "expected a number"
    } else if refused.is::<ParseIntError>() {
        "expected a whole number, without a sign"
    } else {
        return text;
    };
    text.replace(&refused.to_string(), words)
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Info(command::info::InfoArgs),
    Check(command::check::CheckArgs),
    Fix(command::fix::FixArgs),
    Fk(command::fk::FkArgs),
    Convert(command::convert::ConvertArgs),
    Ik(Box<command::ik::IkArgs>),
    IkStudy(Box<command::ik_study::IkStudyArgs>),
    #[cfg(feature = "window")]
    View(command::view::ViewArgs),
    Serve(command::serve::ServeArgs),
    Render(Box<command::render::RenderArgs>),
    Keys(command::keys::KeysArgs),
    Inbetween(command::inbetween::InbetweenArgs),
    Slerp(command::slerp::SlerpArgs),
    Sample(command::sample::SampleArgs),
    Completions(command::completions::CompletionsArgs),
    Man(command::man::ManArgs),
}

impl Cli {
    /// Whether the command may ask a graphics driver to draw.
    pub(crate) fn may_use_graphics(&self) -> bool {
        match &self.command {
            // The window, or a film.
            None => true,
            #[cfg(feature = "window")]
            Some(Command::View(args)) => args.may_use_graphics(),
            Some(Command::Render(args)) => args.may_use_graphics(),
            Some(_) => false,
        }
    }
}

/// What draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RendererArg {
    /// The fastest there is
    Auto,
    /// The CPU: the same bytes on every machine
    Cpu,
    /// A graphics driver, be it a software one
    Gpu,
}

impl From<RendererArg> for RendererChoice {
    fn from(arg: RendererArg) -> Self {
        match arg {
            RendererArg::Auto => Self::Fastest,
            RendererArg::Cpu => Self::Cpu,
            RendererArg::Gpu => Self::Gpu,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::*;

    /// A line that is broken where the help is is no command that somebody can copy.
    #[test]
    fn examples_fit_the_width_of_the_help() {
        fn look(command: &clap::Command) {
            let examples = command.get_after_help().map(ToString::to_string);
            for line in examples.unwrap_or_default().lines() {
                assert!(line.chars().count() <= 98, "{}: {line}", command.get_name());
            }
            command.get_subcommands().for_each(look);
        }
        look(&Cli::command());
    }

    /// Every option that takes a value, as `keys bake | --output`, and every name without an option, as `fk | FILE`.
    fn valued(prefix: &str, command: &clap::Command, found: &mut BTreeSet<String>) {
        let args = command.get_arguments().filter(|arg| {
            arg.get_action().takes_values() && !arg.is_global_set() && arg.get_id() != "help"
        });
        for arg in args {
            let name = match arg.get_long() {
                Some(long) => format!("--{long}"),
                None => arg
                    .get_value_names()
                    .map_or_else(String::new, |names| names[0].to_string()),
            };
            found.insert(format!("{} | {name}", prefix.trim()));
        }
        let commands = command
            .get_subcommands()
            .filter(|sub| sub.get_name() != "help");
        for sub in commands {
            valued(&format!("{prefix} {}", sub.get_name()), sub, found);
        }
    }

    #[test]
    fn it_is_known_of_every_option_whether_it_names_a_file() {
        let mut command = Cli::command();
        command.build();
        let mut found = BTreeSet::new();
        valued("", &command, &mut found);
        let table = include_str!("../tests/it/options.txt");
        let rows = table.lines().filter(|line| !line.starts_with('#'));
        let known: BTreeSet<String> = rows
            .map(|row| {
                let (option, role) = row.rsplit_once(" | ").unwrap();
                assert!(["reads", "writes", "makes", "-"].contains(&role), "{row}");
                option.to_owned()
            })
            .collect();
        let window = |option: &String| cfg!(feature = "window") || !option.starts_with("view ");
        let known: BTreeSet<String> = known.into_iter().filter(window).collect();
        let unknown: Vec<_> = found.difference(&known).collect();
        assert!(
            unknown.is_empty(),
            "say in tests/it/options.txt what they name: {unknown:#?}"
        );
        let gone: Vec<_> = known.difference(&found).collect();
        assert!(
            gone.is_empty(),
            "there is no such option any more: {gone:#?}"
        );
    }
}
