//! Connections: each a task of its own, so that a slow one keeps nobody waiting.

use std::convert::Infallible;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Request, body::Incoming};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;

use crate::args::Global;
use crate::console;
use crate::failure::Failure;

use super::answer::answer;
use super::gate::Gate;

/// A request's head is a few hundred bytes; more than this is refused.
const MOST_HEAD_BYTES: usize = 16 * 1024;
/// Who has not said what is wanted after this long is hung up on.
const HEAD_TIME: Duration = Duration::from_secs(10);
/// Who reads a file for longer than this is hung up on.
const CONNECTION_TIME: Duration = Duration::from_secs(600);
/// More connections than this wait until others end.
const MOST_CONNECTIONS: usize = 256;
/// How long to wait when the system has no room for one more connection.
const BREATH: Duration = Duration::from_millis(100);

/// What is served, to whom.
#[derive(Debug)]
pub(super) struct Site {
    /// The folder of the page, canonical.
    pub(super) page: PathBuf,
    /// The folder of clips, canonical.
    pub(super) clips: PathBuf,
    /// Who is let in.
    pub(super) gate: Gate,
}

/// Serves until the process ends.
pub(super) fn serve(
    site: Site,
    (address, port): (IpAddr, u16),
    global: &Global,
) -> Result<(), Failure> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|error| Failure::new(format!("cannot start serving: {error}")))?;
    runtime.block_on(async {
        let listener = TcpListener::bind(SocketAddr::new(address, port))
            .await
            .map_err(|error| cannot_listen(address, port, &error))?;
        let local = listener
            .local_addr()
            .map_err(|error| cannot_listen(address, port, &error))?;
        announce(&site, local, global)?;
        accept_all(&listener, Arc::new(site)).await;
        Ok(())
    })
}

fn cannot_listen(address: IpAddr, port: u16, error: &io::Error) -> Failure {
    let place = SocketAddr::new(address, port);
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            Failure::new(format!("{place}: something else listens here already"))
                .try_next("choose another --port, or 0 for any free one")
        }
        io::ErrorKind::PermissionDenied => {
            Failure::new(format!("{place}: not allowed to listen here"))
                .try_next("choose a --port from 1024 on")
        }
        io::ErrorKind::AddrNotAvailable => {
            Failure::new(format!("{place}: this machine has no such address"))
        }
        _ => Failure::new(format!("{place}: cannot listen: {error}")),
    }
}

/// The address alone goes to standard output, for people and for scripts.
fn announce(site: &Site, local: SocketAddr, global: &Global) -> Result<(), Failure> {
    use std::io::Write;
    let mut out = console::stdout();
    writeln!(out, "http://{local}/{}", site.gate.query())?;
    out.flush()?;
    if !global.quiet {
        console::note(&format!(
            "serving the clips of {}, listed at http://{local}/clips/; ^C ends it",
            site.clips.display()
        ));
        if local.ip().is_unspecified() {
            console::note("others put this machine's own address in the place of the zeros");
        }
    }
    Ok(())
}

async fn accept_all(listener: &TcpListener, site: Arc<Site>) {
    let room = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let Ok(place) = Arc::clone(&room).acquire_owned().await else {
            return;
        };
        match listener.accept().await {
            Ok((stream, _)) => {
                let site = Arc::clone(&site);
                tokio::spawn(async move {
                    // A connection that breaks is its client's business.
                    let _ = tokio::time::timeout(CONNECTION_TIME, talk(stream, site)).await;
                    drop(place);
                });
            }
            Err(_no_room) => tokio::time::sleep(BREATH).await,
        }
    }
}

async fn talk(stream: TcpStream, site: Arc<Site>) -> hyper::Result<()> {
    let service = service_fn(move |request: Request<Incoming>| {
        let site = Arc::clone(&site);
        async move {
            let (head, _unread) = request.into_parts();
            Ok::<_, Infallible>(answer(&site, &head))
        }
    });
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME)
        .max_buf_size(MOST_HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), service)
        .await
}
