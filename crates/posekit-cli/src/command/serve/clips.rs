//! What is in the two folders, and what is not.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use serde_json::{Value, json};
use walkdir::WalkDir;

/// Clips beyond this are not listed: a list of more is of no use to a page.
const MOST_CLIPS: usize = 20_000;
/// Below this many folders nothing is looked for.
const DEEPEST: usize = 32;

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
    /// Its size in bytes when it was opened.
    pub(super) length: u64,
    /// Its media type.
    pub(super) media_type: &'static str,
    /// How its bytes are packed.
    pub(super) packing: Packing,
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
pub(super) fn page_file(root: &Path, address: &str, allowed: Packing) -> Option<Found> {
    let address = if address.is_empty() {
        "index.html"
    } else {
        address
    };
    let found = find(root, address, PAGE_KINDS)?;
    if allowed == Packing::Brotli
        && let Some(packed) = find(root, &format!("{address}.br"), PACKED_KINDS)
    {
        return Some(Found {
            media_type: found.media_type,
            packing: Packing::Brotli,
            ..packed
        });
    }
    Some(found)
}

/// A clip, by the path in the address.
pub(super) fn clip(root: &Path, address: &str) -> Option<Found> {
    find(root, address, CLIP_KINDS)
}

/// Opens what an address names below `root`, which is canonical, if it is a file of one of the kinds
/// and lies, links followed, inside.
fn find(root: &Path, address: &str, kinds: &[(&str, &'static str)]) -> Option<Found> {
    let relative = relative(address)?;
    media_type(&relative, kinds)?;
    let real = root.join(relative).canonicalize().ok()?;
    if !real.starts_with(root) {
        return None;
    }
    // A link of a harmless name may lead to another kind of file.
    let media_type = media_type(&real, kinds)?;
    // Asked before opening: a named pipe would not come back from being opened.
    if !fs::symlink_metadata(&real).ok()?.is_file() {
        return None;
    }
    let file = File::open(&real).ok()?;
    let length = file.metadata().ok()?.len();
    Some(Found {
        file,
        length,
        media_type,
        packing: Packing::None,
    })
}

/// An address as a path of plain names, or nothing: no `..`, no root, no backslash, no drive, no
/// hidden file.
fn relative(address: &str) -> Option<PathBuf> {
    let decoded = percent_decode_str(address).decode_utf8().ok()?;
    let mut path = PathBuf::new();
    for name in decoded.split('/') {
        let is_plain = !name.is_empty()
            && !name.starts_with('.')
            && !name.contains(['\\', ':', '\0'])
            && !name.chars().any(char::is_control);
        if !is_plain {
            return None;
        }
        path.push(name);
    }
    Some(path)
}

fn media_type(path: &Path, kinds: &[(&str, &'static str)]) -> Option<&'static str> {
    let extension = path.extension()?.to_str()?;
    let kind = kinds
        .iter()
        .find(|(kind, _)| extension.eq_ignore_ascii_case(kind))?;
    Some(kind.1)
}

/// The clips in a folder and below, as JSON: the folder's own name, and of each clip its name, size in
/// bytes, and the address to fetch it from.
pub(super) fn list(root: &Path) -> Value {
    let entries = WalkDir::new(root)
        .max_depth(DEEPEST)
        .sort_by_file_name()
        .into_iter()
        .filter_entry(|entry| entry.depth() == 0 || !is_hidden(entry.path()));
    let clips: Vec<Value> = entries
        .flatten()
        .filter(|entry| media_type(entry.path(), CLIP_KINDS).is_some())
        .filter_map(|entry| {
            let name = address_name(root, entry.path())?;
            // The same question as when it is asked for: what is listed is given out.
            let found = clip(root, &encoded(&name))?;
            Some(json!({
                "name": name,
                "bytes": found.length,
                "url": format!("/clips/{}", encoded(&name)),
            }))
        })
        .take(MOST_CLIPS)
        .collect();
    let folder = root.file_name().unwrap_or(root.as_os_str());
    json!({ "folder": folder.to_string_lossy(), "clips": clips })
}

fn is_hidden(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|name| name.as_encoded_bytes().starts_with(b"."))
}

/// A path below `root` with slashes.
fn address_name(root: &Path, path: &Path) -> Option<String> {
    let relative = path.strip_prefix(root).ok()?;
    let names: Option<Vec<&str>> = relative
        .components()
        .map(|component| component.as_os_str().to_str())
        .collect();
    Some(names?.join("/"))
}

/// A name as a part of an address.
pub(super) fn encoded(name: &str) -> String {
    utf8_percent_encode(name, KEPT).to_string()
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

    #[test]
    fn only_clips_are_listed_and_their_addresses_find_them() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        fs::create_dir_all(root.join("sub")).unwrap();
        fs::create_dir_all(root.join(".hidden")).unwrap();
        for name in [
            "b é#1.bvh",
            "a.BVH",
            "notes.txt",
            "sub/c.bvh",
            "robot.urdf",
            ".hidden/d.bvh",
        ] {
            fs::write(root.join(name), "xyz").unwrap();
        }
        let list = list(&root);
        let clips = list["clips"].as_array().unwrap();
        let names: Vec<_> = clips
            .iter()
            .map(|clip| clip["name"].as_str().unwrap())
            .collect();
        assert_eq!(names, ["a.BVH", "b é#1.bvh", "robot.urdf", "sub/c.bvh"]);
        for entry in clips {
            let url = entry["url"]
                .as_str()
                .unwrap()
                .strip_prefix("/clips/")
                .unwrap();
            assert_eq!(clip(&root, url).unwrap().length, 3);
        }
        assert!(clip(&root, "notes.txt").is_none());
        assert!(clip(&root, "sub").is_none());
    }
}
