//! Which files of the two folders are given out, and which are not.
//!
//! A file is given out when its real path, links followed, lies inside the folder, no part of that path
//! is hidden, and its kind is one of a list. So a link adds no file to those that can be had by their own
//! names.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Path, PathBuf};

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// What may stand in a part of an address as it is.
const KEPT: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~')
    .remove(b'/');

/// The kinds of files that the page consists of, and their media types.
const PAGE_KINDS: &[(&str, &str)] = &[
    ("html", "text/html; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("wasm", "application/wasm"),
    ("css", "text/css; charset=utf-8"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("ico", "image/x-icon"),
];

/// The page's files as the build task packs them.
const PACKED_KINDS: &[(&str, &str)] = &[("br", "application/octet-stream")];

/// The kinds of files that the page opens: clips, and robots.
const CLIP_KINDS: &[(&str, &str)] = &[
    ("bvh", "text/plain; charset=utf-8"),
    // XML as text: as XML a browser would run what scripts it holds.
    ("urdf", "text/plain; charset=utf-8"),
];

/// A file that may be given out.
#[derive(Debug)]
pub(super) struct Found {
    /// Open, at its start.
    pub(super) file: File,
    /// What the system says of it, as it was opened.
    pub(super) metadata: Metadata,
    /// Its media type.
    pub(super) media_type: &'static str,
    /// How its bytes are packed.
    pub(super) packing: Packing,
}

/// Why a file is not given out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Missing {
    /// There is none of that name, or none that may be given out: which of the two is not told.
    NoSuchFile,
    /// It is there, and the system does not let this program read it.
    Unreadable,
}

/// How a file's bytes are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Packing {
    /// As they are.
    None,
    /// By brotli.
    Brotli,
}

/// A file of the page, by the path in the address; packed, if it lies there packed and may be sent so.
pub(super) fn page_file(root: &Path, address: &str, allowed: Packing) -> Result<Found, Missing> {
    let address = if address.is_empty() {
        "index.html"
    } else {
        address
    };
    let found = find(root, address, PAGE_KINDS)?;
    if allowed == Packing::Brotli
        && let Ok(packed) = find(root, &format!("{address}.br"), PACKED_KINDS)
    {
        return Ok(Found {
            media_type: found.media_type,
            packing: Packing::Brotli,
            ..packed
        });
    }
    Ok(found)
}

/// A clip, by the path in the address.
pub(super) fn clip(root: &Path, address: &str) -> Result<Found, Missing> {
    find(root, address, CLIP_KINDS)
}

/// Opens what an address names below `root`, which is canonical, if it may be given out.
fn find(root: &Path, address: &str, kinds: &[(&str, &'static str)]) -> Result<Found, Missing> {
    let asked = relative(address).ok_or(Missing::NoSuchFile)?;
    let (real, media_type) = real_file(root, &asked, kinds).ok_or(Missing::NoSuchFile)?;
    let file = File::open(&real).map_err(|error| why_missing(&error))?;
    let metadata = file.metadata().map_err(|error| why_missing(&error))?;
    Ok(Found {
        file,
        metadata,
        media_type,
        packing: Packing::None,
    })
}

fn why_missing(error: &io::Error) -> Missing {
    match error.kind() {
        io::ErrorKind::PermissionDenied => Missing::Unreadable,
        _ => Missing::NoSuchFile,
    }
}

/// The real path and the media type of the file that a path of plain names leads to, if it may be given
/// out.
fn real_file(
    root: &Path,
    asked: &Path,
    kinds: &[(&str, &'static str)],
) -> Option<(PathBuf, &'static str)> {
    media_type(asked, kinds)?;
    let real = root.join(asked).canonicalize().ok()?;
    let inside = real.strip_prefix(root).ok()?;
    if inside
        .iter()
        .any(|name| !name.to_str().is_some_and(is_plain))
    {
        return None;
    }
    // A link of a harmless name may lead to another kind of file.
    let media_type = media_type(&real, kinds)?;
    // Asked before opening: a named pipe would not come back from being opened.
    fs::symlink_metadata(&real).ok()?.is_file().then_some(())?;
    Some((real, media_type))
}

/// The size of the clip that a link leads to, if it may be given out.
pub(super) fn linked_clip_bytes(root: &Path, link: &Path) -> Option<u64> {
    let (real, _) = real_file(root, link.strip_prefix(root).ok()?, CLIP_KINDS)?;
    Some(fs::metadata(real).ok()?.len())
}

/// Whether a file's name says that it is a clip.
pub(super) fn is_clip(path: &Path) -> bool {
    media_type(path, CLIP_KINDS).is_some()
}

/// Whether a name may stand in an address: not hidden, not `.` or `..`, without what separates names on
/// some system, and without control characters.
pub(super) fn is_plain(name: &str) -> bool {
    !name.is_empty()
        && !name.starts_with('.')
        && !name.contains(['/', '\\', ':'])
        && !name.chars().any(char::is_control)
}

/// An address as a path of plain names, or nothing: no `..`, no root, no backslash, no drive, no
/// hidden file.
fn relative(address: &str) -> Option<PathBuf> {
    let decoded = percent_decode_str(address).decode_utf8().ok()?;
    let names = decoded.split('/');
    names.map(|name| is_plain(name).then_some(name)).collect()
}

fn media_type(path: &Path, kinds: &[(&str, &'static str)]) -> Option<&'static str> {
    let extension = path.extension()?.to_str()?;
    let kind = kinds
        .iter()
        .find(|(kind, _)| extension.eq_ignore_ascii_case(kind))?;
    Some(kind.1)
}

/// A name as a part of an address.
pub(super) fn encoded(name: &str) -> String {
    utf8_percent_encode(name, KEPT).to_string()
}

/// What a part of an address stands for.
pub(super) fn decoded(address: &str) -> String {
    percent_decode_str(address).decode_utf8_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_plain_names_or_nothing() {
        assert_eq!(relative("a%20b/c.bvh"), Some(PathBuf::from("a b/c.bvh")));
        for bad in [
            "",
            "/",
            "../a",
            "a/../b",
            "a//b",
            "%2e%2e/a",
            "a%2f..%2fb",
            "..%5ca",
            "a\\b",
            "c:a",
            "%00",
            "a%0a",
            ".git/config",
            "%ff",
            "a/.",
            "a/",
        ] {
            assert_eq!(relative(bad), None, "{bad}");
        }
    }
}
