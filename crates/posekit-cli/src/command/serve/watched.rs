//! A connection's bytes, watched: a client that stops reading is dropped.

use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::Sleep;

use super::seats::Activity;

/// A connection that ends when the other side takes nothing for a while.
#[derive(Debug)]
pub(super) struct Watched {
    stream: TcpStream,
    activity: Arc<Activity>,
    /// How long the other side may take nothing.
    stall_time: Duration,
    /// Runs while there is something to send and no room for it.
    stalled: Option<Pin<Box<Sleep>>>,
}

impl Watched {
    /// Watches a connection.
    pub(super) fn new(stream: TcpStream, activity: Arc<Activity>, stall_time: Duration) -> Self {
        Self {
            stream,
            activity,
            stall_time,
            stalled: None,
        }
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        if self.activity.is_cut() {
            // Without it the system would keep what was not taken, and go on offering it for minutes.
            let _ = self.stream.set_zero_linger();
        }
    }
}

impl AsyncRead for Watched {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let watched = self.get_mut();
        let before = buffer.filled().len();
        let outcome = ready!(Pin::new(&mut watched.stream).poll_read(context, buffer));
        if buffer.filled().len() > before {
            watched.activity.move_on();
        }
        Poll::Ready(outcome)
    }
}

impl AsyncWrite for Watched {
    fn poll_write(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let watched = self.get_mut();
        if let Poll::Ready(outcome) = Pin::new(&mut watched.stream).poll_write(context, bytes) {
            watched.stalled = None;
            watched.activity.move_on();
            return Poll::Ready(outcome);
        }
        let stall_time = watched.stall_time;
        let stalled = watched
            .stalled
            .get_or_insert_with(|| Box::pin(tokio::time::sleep(stall_time)));
        ready!(stalled.as_mut().poll(context));
        watched.activity.cut();
        Poll::Ready(Err(io::ErrorKind::TimedOut.into()))
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}
