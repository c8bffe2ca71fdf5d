//! `posekit serve`: the viewer as a web page, and a folder of clips for it, on this machine.

mod answer;
mod body;
mod files;
mod gate;
mod list;
mod listen;
mod lists;
mod policy;
mod seats;
mod validity;
mod watched;

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::Mutex;
use std::time::Duration;

use clap::Args;

use crate::args::Global;
use crate::console;
use crate::failure::Failure;
use crate::output;
use gate::Gate;
use list::{Extent, List};
use listen::Site;
use lists::Lists;
use policy::{Origin, Policy};

/// The viewer as a web page, with a folder of clips, for a machine without a desktop
///
/// Serves the page that `cargo xtask web` builds and the .bvh files of FOLDER, and prints the address to
/// open. Only this machine reaches it. With --host others do too; then the address carries a token, made
/// anew at every start, without which nothing is given out. Nothing outside the two folders is ever given
/// out, and nothing is written.
#[allow(
    clippy::doc_markdown,
    reason = "this is the help text, in which backticks would show"
)]
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ServeArgs {
    /// The folder of clips
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// Port; 0 is any free one
    #[arg(long, value_name = "N", default_value_t = 8631)]
    port: u16,
    /// Address to listen on, so that others can reach it; they then need the token in the printed address
    #[arg(long, value_name = "ADDRESS")]
    host: Option<IpAddr>,
    /// The folder of the built page [default: target/page, or page beside this program]
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
    /// Let pages of this origin show the viewer in a frame; may be given several times
    #[arg(long, value_name = "ORIGIN")]
    embed: Vec<Origin>,
    #[command(flatten)]
    limits: Limits,
}

/// Limits of the server. Nobody needs to change these except tests.
#[derive(Debug, Args)]
struct Limits {
    /// List at most this many clips
    #[arg(long, hide = true, value_name = "N", default_value_t = 20_000)]
    most_clips: usize,
    /// Stop looking for clips after this many names
    #[arg(long, hide = true, value_name = "N", default_value_t = 1_000_000)]
    most_names: usize,
    /// How long a list of clips stays current
    #[arg(long, hide = true, value_name = "SECS", default_value = "1", value_parser = seconds)]
    list_time: Duration,
    /// Most connections open at a time
    #[arg(long, hide = true, value_name = "N", default_value_t = 256)]
    most_connections: usize,
    /// Drop clients that read nothing for this long
    #[arg(long, hide = true, value_name = "SECS", default_value = "30", value_parser = seconds)]
    stall_time: Duration,
}

fn seconds(text: &str) -> Result<Duration, String> {
    let secs: f64 = text
        .parse()
        .map_err(|_not_a_number| "not a number of seconds".to_owned())?;
    Duration::try_from_secs_f64(secs).map_err(|error| error.to_string())
}

const EXAMPLES: &str = "\
Examples:
  posekit serve takes/                       this machine only
  ssh -L 8631:127.0.0.1:8631 studio          ... and this, on yours, brings it to your browser
  posekit serve takes/ --host 0.0.0.0        everyone who knows the address with its token
  posekit serve --page /srv/posekit --port 0
  posekit serve takes/ --embed https://lectures.example
                                             ... whose pages may show the viewer in a frame";

/// Runs the command until it is interrupted.
pub(crate) fn run(args: &ServeArgs, global: &Global) -> Result<(), Failure> {
    let clips = real_folder(&args.folder)?;
    let page = match &args.page {
        Some(page) => real_folder(page)?,
        None => built_page().ok_or_else(|| no_page("the viewer's page is not built"))?,
    };
    if !page.join("index.html").is_file() {
        return Err(no_page(&format!(
            "{}: there is no index.html in it",
            page.display()
        )));
    }
    let gate = match args.host {
        None => Gate::this_machine(),
        Some(_) => Gate::with_new_token()?,
    };
    let address = args.host.unwrap_or(IpAddr::V4(Ipv4Addr::LOCALHOST));
    // An interrupt is how a server is ended: no failure.
    output::interrupt_is_no_failure();
    let site = Site {
        page,
        lists: lists(clips.clone(), args, global.quiet),
        clips,
        gate,
        policy: Policy::new(&args.embed),
        most_connections: args.limits.most_connections,
        stall_time: args.limits.stall_time,
    };
    listen::serve(site, (address, args.port), global)
}

/// The lists of the folder. When one is cut in another way than the one before, that is said.
fn lists(clips: PathBuf, args: &ServeArgs, quiet: bool) -> Arc<Lists> {
    let extent = Extent {
        most_clips: args.limits.most_clips,
        most_names: args.limits.most_names,
    };
    let said = Mutex::new(None);
    Lists::new(args.limits.list_time, move || {
        let list = List::of(&clips, extent).write();
        let mut said = said
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        if *said != list.shortage {
            said.clone_from(&list.shortage);
            if let Some(shortage) = said.as_ref().filter(|_| !quiet) {
                console::warning(&format!(
                    "{}: {shortage}; serve a subfolder to see the others",
                    clips.display()
                ));
            }
        }
        list
    })
}

fn real_folder(folder: &Path) -> Result<PathBuf, Failure> {
    let real = folder
        .canonicalize()
        .map_err(|error| Failure::cannot_read(folder, &error))?;
    if real.is_dir() {
        Ok(real)
    } else {
        Err(Failure::new(format!(
            "{}: is a file, not a folder",
            folder.display()
        )))
    }
}

/// Where the build task puts the page, seen from a program under `target`; or a `page` beside an
/// installed program.
fn built_page() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?.canonicalize().ok()?;
    let beside = program.parent()?;
    let candidates = [beside.join("page"), beside.parent()?.join("page")];
    let found = candidates
        .into_iter()
        .find(|page| page.join("index.html").is_file());
    found?.canonicalize().ok()
}

fn no_page(what: &str) -> Failure {
    Failure::new(what)
        .try_next("'cargo xtask web' builds it into target/page; --page names another folder")
}
