//! What is sent: bytes at hand, or a file a piece at a time.

use std::fs::File;
use std::io::{self, Read};
use std::pin::Pin;
use std::task::{Context, Poll, ready};

use hyper::body::{Body, Bytes, Frame, SizeHint};
use tokio::task::JoinHandle;

/// A piece of a file: small enough that many slow readers cost little memory.
const PIECE_BYTES: usize = 1 << 16;

/// What is sent.
#[derive(Debug)]
pub(super) enum Content {
    /// Bytes, once.
    Bytes(Option<Bytes>),
    /// Bytes of a file.
    File(Pieces),
}

/// Bytes of a file, from where it stands.
#[derive(Debug)]
pub(super) struct Pieces {
    /// Nothing while a piece is being read.
    file: Option<File>,
    left: u64,
    reading: Option<JoinHandle<io::Result<(File, Bytes)>>>,
}

impl Content {
    /// Text.
    pub(super) fn text(text: impl Into<Bytes>) -> Self {
        Self::Bytes(Some(text.into()))
    }

    /// Nothing.
    pub(super) fn nothing() -> Self {
        Self::Bytes(None)
    }

    /// A file's next `length` bytes.
    pub(super) fn file(file: File, length: u64) -> Self {
        Self::File(Pieces {
            file: Some(file),
            left: length,
            reading: None,
        })
    }

    fn left(&self) -> u64 {
        match self {
            Self::Bytes(bytes) => bytes.as_ref().map_or(0, |bytes| bytes.len() as u64),
            Self::File(pieces) => pieces.left,
        }
    }
}

impl Pieces {
    /// The next piece. It is read away from the thread that serves: a folder may be on another machine.
    fn poll_piece(&mut self, context: &mut Context<'_>) -> Poll<Option<io::Result<Bytes>>> {
        if let Some(file) = self.file.take_if(|_| self.left > 0) {
            let wanted = usize::try_from(self.left).unwrap_or(PIECE_BYTES);
            let wanted = wanted.min(PIECE_BYTES);
            self.reading = Some(tokio::task::spawn_blocking(move || {
                read_piece(file, wanted)
            }));
        }
        let Some(reading) = &mut self.reading else {
            return Poll::Ready(None);
        };
        let outcome = ready!(Pin::new(reading).poll(context));
        self.reading = None;
        let (file, piece) = outcome.unwrap_or_else(|lost| Err(io::Error::other(lost)))?;
        self.file = Some(file);
        self.left -= piece.len() as u64;
        Poll::Ready(Some(Ok(piece)))
    }
}

fn read_piece(mut file: File, wanted: usize) -> io::Result<(File, Bytes)> {
    let mut piece = vec![0; wanted];
    let read = file.read(&mut piece)?;
    if read == 0 {
        // Its length was promised already: the connection ends rather than lie.
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    piece.truncate(read);
    Ok((file, piece.into()))
}

impl Body for Content {
    type Data = Bytes;
    type Error = io::Error;

    fn poll_frame(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<io::Result<Frame<Bytes>>>> {
        let piece = match self.get_mut() {
            Self::Bytes(bytes) => bytes.take().map(Ok),
            Self::File(pieces) => ready!(pieces.poll_piece(context)),
        };
        Poll::Ready(piece.map(|piece| piece.map(Frame::data)))
    }

    fn is_end_stream(&self) -> bool {
        self.left() == 0
    }

    fn size_hint(&self) -> SizeHint {
        SizeHint::with_exact(self.left())
    }
}
