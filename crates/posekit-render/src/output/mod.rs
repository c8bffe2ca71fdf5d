//! Pictures and films as bytes: PNG, sequences of PNG, animated PNG, GIF, H.264 in MP4, contact sheets.
//!
//! Everything is written to an [`io::Write`](std::io::Write) of the caller's, who gives it a name
//! only when it is whole. Films are drawn and encoded as they go, with a progress callback that can
//! stop the work.

mod apng;
mod film;
mod gif;
#[cfg(feature = "h264")]
mod mp4;
mod png;
mod sequence;
mod sheet;
mod stepwise;
#[cfg(feature = "h264")]
mod yuv;

pub use self::png::write_png;
pub use apng::write_apng;
pub use film::{Film, FilmError, Progress, SceneAt, even_size};
pub use gif::write_gif;
#[cfg(feature = "h264")]
pub use mp4::write_mp4;
pub use sequence::write_png_sequence;
pub use sheet::{ContactSheet, render_contact_sheet, spread_times};
pub use stepwise::{StepwiseFilm, StepwiseFormat};
