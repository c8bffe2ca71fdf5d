//! The outside of a file: the chunks of a `.glb`, and the buffers.

use std::borrow::Cow;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::json::Root;

use super::Notes;
use super::json_place::Step;
use crate::report::{Location, ReadError, ReadErrorKind, WarningCode, quote};

/// What a `.glb` starts with.
const MAGIC: &[u8] = b"glTF";

/// The parts of a file.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
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
        return Ok(Container { json, binary: None });
    }
    let version = number_at(bytes, 4);
    if version != Some(2) {
        let found = version.map_or("the end of the file".to_owned(), |v| format!("version {v}"));
        let kind = ReadErrorKind::Unexpected;
        return Err(at_byte(4, kind, "a binary glTF of version 2", found));
    }
    let mut chunks = Chunks { bytes, at: 12 };
    let json = match chunks.next() {
        Some((b"JSON", json)) => json,
        _ => {
            let kind = ReadErrorKind::Unexpected;
            return Err(at_byte(
                12,
                kind,
                "a chunk of JSON",
                quote(&bytes[12.min(bytes.len())..]),
            ));
        }
    };
    // Chunks of other kinds are for extensions.
    let binary = chunks.find_map(|(kind, chunk)| (kind == b"BIN\0").then_some(chunk));
    Ok(Container { json, binary })
}

/// The error of a text that is not what the format wants.
pub(super) fn not_gltf(json: &[u8], error: &gltf::json::Error) -> ReadError {
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or_default();
    let is_text = std::str::from_utf8(json).is_ok() && !json.contains(&0);
    let shown: String = what.chars().take(200).collect();
    ReadError {
        kind: match is_text {
            true => ReadErrorKind::Unexpected,
            false => ReadErrorKind::NotText,
        },
        location: Location {
            line: error.line().max(1),
            column: error.column().max(1),
        },
        expected: "glTF 2.0 as JSON".to_owned(),
        found: match is_text {
            true => shown,
            false => "bytes that are no text".to_owned(),
        },
    }
}

fn at_byte(
    byte: usize,
    kind: ReadErrorKind,
    expected: &str,
    found: impl Into<String>,
) -> ReadError {
    ReadError {
        kind,
        location: Location {
            line: 1,
            column: byte + 1,
        },
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
        let kind = self.bytes.get(self.at + 4..self.at + 8)?;
        let rest = &self.bytes[self.at + 8..];
        let chunk = &rest[..length.min(rest.len())];
        self.at += 8 + chunk.len();
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

    /// The bytes of a buffer, if they can be had. That they cannot is warned of once.
    pub(super) fn get(
        &mut self,
        root: &Root,
        index: usize,
        notes: &mut Notes<'_>,
    ) -> Option<&[u8]> {
        self.held.resize(root.buffers.len(), None);
        let held = self.held.get_mut(index)?;
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
                    format!("buffer {index} ({name}) is not to be had; what is in it was left out")
                });
            }
            *held = Some(bytes);
        }
        held.as_ref()?.as_deref()
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
