//! Connections: each a task of its own, so that a slow one keeps nobody waiting. Files are looked for and
//! read, and folders listed, on other threads.

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
use posekit_formats::system::in_words;
use tokio::net::{TcpListener, TcpSocket};

use crate::args::Global;
use crate::console;
use crate::failure::Failure;

use super::answer::answer;
use super::gate::Gate;
use super::lists::Lists;
use super::policy::Policy;
use super::seats::{Activity, Seats};
use super::watched::Watched;

/// A request's head is a few hundred bytes; more than this is refused.
const MOST_HEAD_BYTES: usize = 16 * 1024;
/// A client that has not sent its request after this long is dropped.
const HEAD_TIME: Duration = Duration::from_secs(10);
/// This much is handed to the system ahead of the client. It takes more when a third of that was read, and
/// a client that reads more slowly than that in the time for a stall is dropped: 3 kB a second.
const SEND_BUFFER_BYTES: u32 = 1 << 18;
/// Connections that the system holds until they are accepted.
const BACKLOG: u32 = 1024;
/// How long to wait when the system has no room for one more connection.
const BREATH: Duration = Duration::from_millis(100);

/// What is served, to whom.
#[derive(Debug)]
pub(super) struct Site {
    /// The folder of the page, canonical.
    pub(super) page: PathBuf,
    /// The folder of clips, canonical.
    pub(super) clips: PathBuf,
    /// The list of the clips.
    pub(super) lists: Arc<Lists>,
    /// Who is let in.
    pub(super) gate: Gate,
    /// What browsers may do with the answers.
    pub(super) policy: Policy,
    /// More connections than this are not open at a time.
    pub(super) most_connections: usize,
    /// A client that reads nothing for this long is dropped.
    pub(super) stall_time: Duration,
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
        .map_err(|error| Failure::new(format!("cannot start serving: {}", in_words(&error))))?;
    runtime.block_on(async {
        let listener = listen(SocketAddr::new(address, port))
            .map_err(|error| cannot_listen(address, port, &error))?;
        let local = listener
            .local_addr()
            .map_err(|error| cannot_listen(address, port, &error))?;
        announce(&site, local, global)?;
        // So that the first who asks does not wait for it.
        let lists = Arc::clone(&site.lists);
        tokio::spawn(async move { lists.current().await.map(|_| ()) });
        accept_all(&listener, Arc::new(site)).await;
        Ok(())
    })
}

fn listen(place: SocketAddr) -> io::Result<TcpListener> {
    let socket = match place {
        SocketAddr::V4(_) => TcpSocket::new_v4(),
        SocketAddr::V6(_) => TcpSocket::new_v6(),
    }?;
    // As the standard library has it: a port is free again as soon as its server has ended.
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    // The connections have it from here.
    socket.set_send_buffer_size(SEND_BUFFER_BYTES)?;
    socket.bind(place)?;
    socket.listen(BACKLOG)
}

fn cannot_listen(address: IpAddr, port: u16, error: &io::Error) -> Failure {
    let place = SocketAddr::new(address, port);
    match error.kind() {
        io::ErrorKind::AddrInUse => {
            Failure::new(format!("{place}: already in use by another program"))
                .try_next("choose another --port, or 0 for any free one")
        }
        io::ErrorKind::PermissionDenied => {
            Failure::new(format!("{place}: no permission to listen here"))
                .try_next("choose a --port of 1024 or more")
        }
        io::ErrorKind::AddrNotAvailable => {
            Failure::new(format!("{place}: this machine has no such address"))
        }
        _ => Failure::new(format!("{place}: cannot listen: {}", in_words(error))),
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
            "serving the clips of {}, listed at http://{local}/clips/; press Ctrl+C to stop",
            site.clips.display()
        ));
        if local.ip().is_unspecified() {
            console::note(
                "from other machines, write this machine's own address in place of the zeros",
            );
        }
    }
    Ok(())
}

async fn accept_all(listener: &TcpListener, site: Arc<Site>) {
    let seats = Seats::new(site.most_connections);
    for id in 0.. {
        let stream = loop {
            match listener.accept().await {
                Ok((stream, _)) => break stream,
                Err(_no_room) => tokio::time::sleep(BREATH).await,
            }
        };
        seats.make_room().await;
        let site = Arc::clone(&site);
        seats.seat(id, |activity| async move {
            let watched = Watched::new(stream, Arc::clone(&activity), site.stall_time);
            // A connection that breaks is its client's business.
            let _ = talk(watched, activity, site).await;
        });
    }
}

async fn talk(stream: Watched, activity: Arc<Activity>, site: Arc<Site>) -> hyper::Result<()> {
    let service = service_fn(move |request: Request<Incoming>| {
        let site = Arc::clone(&site);
        let answering = activity.answering();
        async move {
            let (head, _unread) = request.into_parts();
            let response = answer(&site, head).await;
            drop(answering);
            Ok::<_, Infallible>(response)
        }
    });
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME)
        .max_buf_size(MOST_HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), service)
        .await
}
