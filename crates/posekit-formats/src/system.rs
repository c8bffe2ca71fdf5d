//! What the operating system refused, in plain words: the same ones in the command and the window.

use std::error::Error;
use std::io::{self, ErrorKind};

/// Why something could not be read or written, lower case, without a full stop and without the number that Rust
/// appends to what the system says. Where the system's own words are not plain they are replaced.
///
/// `error` may be a [`std::io::Error`] or have one inside.
///
/// ```
/// use posekit_formats::system::in_words;
/// use std::io::{Error, ErrorKind};
///
/// assert_eq!(in_words(&Error::from(ErrorKind::StorageFull)), "the disk is full");
/// ```
pub fn in_words(error: &(dyn Error + 'static)) -> String {
    let mut inner = Some(error);
    while let Some(at) = inner {
        let refused = at.downcast_ref::<io::Error>();
        if let Some(words) = refused.and_then(|refused| of_kind(refused.kind())) {
            return words.to_owned();
        }
        // The error inside another is not its source, but what that is the source of.
        inner = match refused.and_then(io::Error::get_ref) {
            Some(wrapped) => Some(wrapped),
            None => at.source(),
        };
    }
    without_number(&error.to_string())
}

fn of_kind(kind: ErrorKind) -> Option<&'static str> {
    Some(match kind {
        ErrorKind::StorageFull => "the disk is full",
        ErrorKind::QuotaExceeded => "no more may be stored here: the quota is used up",
        ErrorKind::FileTooLarge => "the file is too large for this disk",
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only",
        ErrorKind::PermissionDenied => "no permission",
        ErrorKind::NotFound => "no such file or folder",
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "part of this path is a file, not a folder"
        }
        ErrorKind::IsADirectory => "is a folder, not a file",
        ErrorKind::InvalidFilename => "no file can have this name",
        ErrorKind::OutOfMemory => "there is not enough memory",
        _ => return None,
    })
}

/// The system's words as they are, but for their number, capital letter and full stop.
fn without_number(text: &str) -> String {
    let mut words = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(" (os error ") {
        let Some(length) = rest[start..].find(')') else {
            break;
        };
        words.push_str(&rest[..start]);
        rest = &rest[start + length + 1..];
    }
    words.push_str(rest);
    if words.len() == text.len() {
        return words;
    }
    words.trim_end_matches('.').to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error("{0}")]
    struct Wrapped(#[source] io::Error);

    #[test]
    fn a_full_disk_is_told_from_wherever_the_error_comes() {
        let full = || io::Error::from(ErrorKind::StorageFull);
        assert_eq!(in_words(&full()), "the disk is full");
        assert_eq!(in_words(&Wrapped(full())), "the disk is full");
        assert_eq!(in_words(&io::Error::other(full())), "the disk is full");
        assert_eq!(
            in_words(&io::Error::other(Wrapped(full()))),
            "the disk is full"
        );
    }

    #[test]
    fn the_systems_words_lose_their_number_and_others_stay() {
        let text = in_words(&io::Error::from_raw_os_error(5));
        assert!(!text.contains("os error") && !text.ends_with('.'), "{text}");
        assert_eq!(
            without_number("a.png: Input/output error (os error 5); again"),
            "a.png: input/output error; again"
        );
        assert_eq!(in_words(&io::Error::other("Not drawn.")), "Not drawn.");
    }
}
