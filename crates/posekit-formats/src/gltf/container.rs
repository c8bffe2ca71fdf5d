//! The outside of a file: the chunks of a `.glb`, and the buffers.

use std::borrow::Cow;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::json::Root;

use super::Notes;
use super::json_path::{Step, path_at};
use crate::report::{Place, ReadError, ReadErrorKind, WarningCode, quote};

/// What a `.glb` starts with.
const MAGIC: &[u8] = b"glTF";

/// The bytes before the first chunk of a `.glb`: magic, version, length.
const HEADER: usize = 12;

/// The bytes before what is in a chunk: its length, its kind.
const CHUNK_HEADER: usize = 8;

/// The parts of a file.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// At which byte of the file that begins.
    json_start: usize,
    /// The buffer that a `.glb` carries.
    pub(super) binary: Option<&'a [u8]>,
}

/// Takes a file apart.
pub(super) fn open(bytes: &[u8]) -> Result<Container<'_>, ReadError> {
    if bytes.trim_ascii().is_empty() {
        return Err(at_byte(0, ReadErrorKind::Empty, "a glTF file", "nothing"));
    }
    if !bytes.starts_with(MAGIC) {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok(Container {
            json,
            json_start: bytes.len() - json.len(),
            binary: None,
        });
    }
    let version = number_at(bytes, 4);
    if version != Some(2) {
        let found = version.map_or("the end of the file".to_owned(), |v| format!("version {v}"));
        let kind = ReadErrorKind::Unexpected;
        return Err(at_byte(4, kind, "a binary glTF of version 2", found));
    }
    let mut chunks = Chunks { bytes, at: HEADER };
    let json = match chunks.next() {
        Some((b"JSON", json)) => json,
        _ => {
            let kind = ReadErrorKind::Unexpected;
            let found = quote(&bytes[HEADER.min(bytes.len())..]);
            return Err(at_byte(HEADER, kind, "a chunk of JSON", found));
        }
    };
    // Chunks of other kinds are for extensions.
    let binary = chunks.find_map(|(kind, chunk)| (kind == b"BIN\0").then_some(chunk));
    Ok(Container {
        json,
        json_start: HEADER + CHUNK_HEADER,
        binary,
    })
}

/// The error of a text that is not what the format wants: placed by the way to the value where it is JSON, else by
/// the byte.
pub(super) fn not_gltf(container: &Container<'_>, error: &gltf::json::Error) -> ReadError {
    let json = container.json;
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or_default();
    let is_text = std::str::from_utf8(json).is_ok() && !json.contains(&0);
    let shown: String = what.chars().take(200).collect();
    let byte = byte_of(json, error.line(), error.column());
    ReadError {
        kind: match is_text {
            true => ReadErrorKind::Unexpected,
            false => ReadErrorKind::NotText,
        },
        place: match is_text && error.is_data() {
            true => Place::Json(path_at(json, byte)),
            false => Place::Byte(container.json_start + byte),
        },
        expected: "glTF 2.0 as JSON".to_owned(),
        found: match is_text {
            true => shown,
            false => "bytes that are not text".to_owned(),
        },
    }
}

/// The byte that a parser which counts lines, and bytes in them, read last.
fn byte_of(json: &[u8], line: usize, column: usize) -> usize {
    let before = line.saturating_sub(2);
    let line_start = match line {
        0 | 1 => 0,
        _ => memchr::memchr_iter(b'\n', json)
            .nth(before)
            .map_or(0, |end| end + 1),
    };
    (line_start + column.saturating_sub(1)).min(json.len())
}

fn at_byte(
    byte: usize,
    kind: ReadErrorKind,
    expected: &str,
    found: impl Into<String>,
) -> ReadError {
    ReadError {
        kind,
        place: Place::Byte(byte),
        expected: expected.to_owned(),
        found: found.into(),
    }
}

fn number_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*four))
}

/// The chunks of a `.glb`, as far as there are bytes: the last may be cut off.
struct Chunks<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Chunks<'a> {
    type Item = (&'a [u8], &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let length = usize::try_from(number_at(self.bytes, self.at)?).ok()?;
        let kind = self.bytes.get(self.at + 4..self.at + CHUNK_HEADER)?;
        let rest = &self.bytes[self.at + CHUNK_HEADER..];
        let chunk = &rest[..length.min(rest.len())];
        self.at += CHUNK_HEADER + chunk.len();
        Some((kind, chunk))
    }
}

/// The buffers of a file, each fetched when it is needed first.
pub(super) struct Buffers<'a, F> {
    binary: Option<&'a [u8]>,
    fetch: F,
    held: Vec<Option<Option<Cow<'a, [u8]>>>>,
}

impl<'a, F: FnMut(&str) -> Option<Vec<u8>>> Buffers<'a, F> {
    pub(super) fn new(binary: Option<&'a [u8]>, fetch: F) -> Self {
        Self {
            binary,
            fetch,
            held: Vec::new(),
        }
    }

    /// Fetches a buffer if it was not yet. That it cannot be had is warned of once.
    pub(super) fn fetch(&mut self, root: &Root, index: usize, notes: &mut Notes) {
        self.held.resize(root.buffers.len(), None);
        let Some(held) = self.held.get_mut(index) else {
            return;
        };
        if held.is_none() {
            let uri = root.buffers[index].uri.as_deref();
            let bytes = match uri {
                None if index == 0 => self.binary.map(Cow::Borrowed),
                None => None,
                Some(uri) => match uri.strip_prefix("data:") {
                    Some(data) => decode(data).map(Cow::Owned),
                    None => (self.fetch)(&plain(uri)).map(Cow::Owned),
                },
            };
            if bytes.is_none() {
                let path = [Step::Key("buffers"), Step::Index(index)];
                notes.warn(WarningCode::MissingBuffer, &path, || {
                    let name = uri.map_or("in the file".to_owned(), |uri| quote(uri.as_bytes()));
                    format!("buffer {index} ({name}) is missing; its contents were left out")
                });
            }
            *held = Some(bytes);
        }
    }

    /// The bytes of a buffer that was [fetched](Self::fetch), if they could be had.
    pub(super) fn get(&self, index: usize) -> Option<&[u8]> {
        self.held.get(index)?.as_ref()?.as_deref()
    }
}

/// The bytes of what follows `data:`.
fn decode(data: &str) -> Option<Vec<u8>> {
    let (kind, text) = data.split_once(',')?;
    if !kind.ends_with(";base64") {
        return None;
    }
    STANDARD.decode(text).ok()
}

/// An address with its `%20` and the like as the characters that they stand for.
fn plain(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let hex = bytes.get(at + 1..at + 3).filter(|_| bytes[at] == b'%');
        let code = hex.and_then(|hex| std::str::from_utf8(hex).ok());
        match code.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                at += 3;
            }
            None => {
                out.push(bytes[at]);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_decoded() {
        assert_eq!(plain("a%20walk%2f1.bin"), "a walk/1.bin");
        assert_eq!(plain("100%"), "100%");
        assert_eq!(plain("%zz%4"), "%zz%4");
        assert_eq!(
            decode("application/octet-stream;base64,AAEC"),
            Some(vec![0, 1, 2])
        );
        assert_eq!(decode("text/plain,abc"), None);
    }

    #[test]
    fn a_cut_off_file_is_opened_as_far_as_it_goes() {
        let mut bytes = b"glTF\x02\0\0\0\xff\0\0\0\x02\0\0\0JSON{}\x09\0\0\0BIN\0abc".to_vec();
        let opened = open(&bytes).expect("a container");
        assert_eq!(
            (opened.json, opened.binary),
            (&b"{}"[..], Some(&b"abc"[..]))
        );
        bytes.truncate(15);
        assert!(open(&bytes).is_err());
        bytes.truncate(4);
        assert!(open(&bytes).is_err());
    }
}
