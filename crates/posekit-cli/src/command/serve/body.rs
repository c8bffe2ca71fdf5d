//! What is sent: bytes at hand, or a file a piece at a time.

use std::fs::File;
use std::io::{self, Read};
use std::pin::Pin;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame, SizeHint};

/// A piece of a file: small enough that many slow readers cost little memory.
const PIECE_BYTES: usize = 1 << 16;

/// What is sent.
#[derive(Debug)]
pub(super) enum Content {
    /// Bytes, once.
    Bytes(Option<Bytes>),
    /// A file's first `left` bytes from where it stands.
    File { file: File, left: u64 },
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

    fn next_piece(file: &mut File, left: &mut u64) -> io::Result<Bytes> {
        let wanted = usize::try_from(*left)
            .unwrap_or(PIECE_BYTES)
            .min(PIECE_BYTES);
        let mut piece = vec![0; wanted];
        let read = file.read(&mut piece)?;
        if read == 0 {
            // Its length was promised already: the connection ends rather than lie.
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        piece.truncate(read);
        *left -= read as u64;
        Ok(piece.into())
    }
}

impl Body for Content {
    type Data = Bytes;
    type Error = io::Error;

    fn poll_frame(
        self: Pin<&mut Self>,
        _context: &mut Context<'_>,
    ) -> Poll<Option<io::Result<Frame<Bytes>>>> {
        let piece = match self.get_mut() {
            Self::Bytes(bytes) => bytes.take().map(Ok),
            Self::File { left: 0, .. } => None,
            // A file of this machine: reading 64 KiB does not keep others waiting.
            Self::File { file, left } => Some(Self::next_piece(file, left)),
        };
        Poll::Ready(piece.map(|piece| piece.map(Frame::data)))
    }

    fn is_end_stream(&self) -> bool {
        matches!(self, Self::Bytes(None) | Self::File { left: 0, .. })
    }

    fn size_hint(&self) -> SizeHint {
        SizeHint::with_exact(match self {
            Self::Bytes(bytes) => bytes.as_ref().map_or(0, |bytes| bytes.len() as u64),
            Self::File { left, .. } => *left,
        })
    }
}
