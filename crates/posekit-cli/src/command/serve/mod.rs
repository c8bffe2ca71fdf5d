//! `posekit serve`: the viewer as a web page, and a folder of clips for it, on this machine.

mod answer;
mod body;
mod clips;
mod gate;
mod listen;

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::Global;
use crate::failure::Failure;
use crate::output;
use gate::Gate;
use listen::Site;

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
    /// Address to listen on, for others to reach; asks for the token in the address
    #[arg(long, value_name = "ADDRESS")]
    host: Option<IpAddr>,
    /// The folder of the built page [default: target/page, or page beside this program]
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  posekit serve takes/                       this machine only
  ssh -L 8631:127.0.0.1:8631 studio          ... and this, on yours, brings it to your browser
  posekit serve takes/ --host 0.0.0.0        everyone who knows the address with its token
  posekit serve --page /srv/posekit --port 0";

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
    listen::serve(Site { page, clips, gate }, (address, args.port), global)
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
