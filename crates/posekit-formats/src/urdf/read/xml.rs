//! The elements of an XML file with their places, and nothing else of it: text, comments, processing
//! instructions and namespaces mean nothing in a URDF.
//!
//! The tokens come from the `quick-xml` crate, which reads once through the bytes and expands no
//! entities but the five that XML itself has. A document type is refused, so that no file can define
//! others. Elements are kept in one list in the file's order, each with where its subtree ends: no
//! recursion, whatever the nesting.

use std::borrow::Cow;
use std::ops::Range;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::{MAX_ATTRIBUTES, MAX_DEPTH, MAX_ELEMENTS};
use crate::report::{ReadError, ReadErrorKind, Reporter, quote};

/// An attribute: the place of its value, and name and value as the file has them.
struct Attribute<'a> {
    name: &'a str,
    value: &'a str,
    at: usize,
}

/// An element without its text.
struct Entry<'a> {
    name: &'a str,
    at: usize,
    attributes: Range<usize>,
    /// The index after its last descendant.
    end: usize,
}

/// All elements of a file, in the file's order.
pub(super) struct Document<'a> {
    entries: Vec<Entry<'a>>,
    attributes: Vec<Attribute<'a>>,
}

/// One element of a [`Document`].
#[derive(Clone, Copy)]
pub(super) struct Element<'d, 'a> {
    document: &'d Document<'a>,
    index: usize,
}

impl<'a> Document<'a> {
    /// Reads the elements of `text`.
    pub(super) fn read(text: &'a str, reporter: &mut Reporter<'_>) -> Result<Self, ReadError> {
        let mut document = Self {
            entries: Vec::new(),
            attributes: Vec::new(),
        };
        document.fill(text, reporter)?;
        Ok(document)
    }

    /// The outermost element.
    pub(super) fn root(&self) -> Element<'_, 'a> {
        Element {
            document: self,
            index: 0,
        }
    }

    fn fill(&mut self, text: &'a str, reporter: &mut Reporter<'_>) -> Result<(), ReadError> {
        let mut reader = Reader::from_str(text);
        let mut open: Vec<usize> = Vec::new();
        loop {
            let at = offset(reader.buffer_position());
            let event = reader.read_event().map_err(|error| {
                let at = offset(reader.error_position());
                let found = quote(error.to_string().as_bytes());
                reporter.error(ReadErrorKind::Unexpected, at, "well-formed XML", found)
            })?;
            match event {
                Event::Start(tag) => {
                    if open.len() == MAX_DEPTH {
                        let expected = format!("elements nested at most {MAX_DEPTH} deep");
                        let kind = ReadErrorKind::LimitExceeded;
                        return Err(reporter.error(kind, at, expected, "a deeper one"));
                    }
                    self.push(text, &tag, at, open.is_empty(), reporter)?;
                    open.push(self.entries.len() - 1);
                }
                Event::Empty(tag) => self.push(text, &tag, at, open.is_empty(), reporter)?,
                Event::End(_) => {
                    if let Some(index) = open.pop() {
                        self.entries[index].end = self.entries.len();
                    }
                }
                Event::DocType(_) => {
                    let expected = "a URDF file without a document type";
                    return Err(reporter.unexpected(at, expected, "`<!DOCTYPE`"));
                }
                Event::Eof => break,
                // Text between the elements of a URDF says nothing, but text and no element is no URDF.
                Event::Text(piece) if open.is_empty() && !piece.trim_ascii().is_empty() => {
                    let found = quote(piece.trim_ascii());
                    return Err(reporter.unexpected(at, "an element `<robot>`", found));
                }
                _ => {}
            }
        }
        if let Some(&index) = open.last() {
            let unclosed = &self.entries[index];
            let expected = format!("`</{}>`", shortened(unclosed.name));
            let found = format!("the end of the file, with {} elements open", open.len());
            let kind = ReadErrorKind::UnclosedBrace;
            return Err(reporter.error(kind, unclosed.at, expected, found));
        }
        if self.entries.is_empty() {
            let expected = "an element `<robot>`";
            return Err(reporter.unexpected(text.len(), expected, "no element at all"));
        }
        Ok(())
    }

    fn push(
        &mut self,
        text: &'a str,
        tag: &BytesStart<'_>,
        at: usize,
        is_outermost: bool,
        reporter: &mut Reporter<'_>,
    ) -> Result<(), ReadError> {
        if is_outermost && !self.entries.is_empty() {
            let found = quote(tag.name().as_ref());
            return Err(reporter.unexpected(at, "one outermost element", found));
        }
        if self.entries.len() == MAX_ELEMENTS {
            let expected = format!("at most {MAX_ELEMENTS} elements");
            let kind = ReadErrorKind::LimitExceeded;
            return Err(reporter.error(kind, at, expected, "more"));
        }
        let first = self.attributes.len();
        let mut attributes = tag.attributes();
        // The duplicates that XML forbids are looked for below, within the limit on their number.
        for attribute in attributes.with_checks(false) {
            let attribute = attribute.map_err(|error| {
                let found = quote(error.to_string().as_bytes());
                reporter.unexpected(at, "attributes like `name=\"value\"`", found)
            })?;
            let (name, _) = part_of(text, attribute.key.as_ref());
            let (value, value_at) = part_of(text, &attribute.value);
            if self.attributes.len() - first == MAX_ATTRIBUTES {
                let expected = format!("at most {MAX_ATTRIBUTES} attributes");
                let kind = ReadErrorKind::LimitExceeded;
                return Err(reporter.error(kind, at, expected, "more"));
            }
            if self.attributes[first..]
                .iter()
                .any(|other| other.name == name)
            {
                let found = format!("{} twice", quote(name.as_bytes()));
                return Err(reporter.unexpected(value_at, "every attribute once", found));
            }
            self.attributes.push(Attribute {
                name,
                value,
                at: value_at,
            });
        }
        let (name, _) = part_of(text, tag.name().as_ref());
        self.entries.push(Entry {
            name,
            at,
            attributes: first..self.attributes.len(),
            end: self.entries.len() + 1,
        });
        Ok(())
    }
}

impl<'d, 'a> Element<'d, 'a> {
    fn entry(self) -> &'d Entry<'a> {
        &self.document.entries[self.index]
    }

    /// The element's name.
    pub(super) fn name(self) -> &'a str {
        self.entry().name
    }

    /// The byte at which its tag begins.
    pub(super) fn at(self) -> usize {
        self.entry().at
    }

    /// The elements directly inside it, in the file's order.
    pub(super) fn children(self) -> impl Iterator<Item = Self> + use<'d, 'a> {
        let Self { document, index } = self;
        let end = self.entry().end;
        let mut next = index + 1;
        std::iter::from_fn(move || {
            let child = Element {
                document,
                index: next,
            };
            (next < end).then(|| {
                next = child.entry().end;
                child
            })
        })
    }

    /// The first element of that name directly inside it.
    pub(super) fn child(self, name: &str) -> Option<Self> {
        self.children().find(|child| child.name() == name)
    }

    /// An attribute's value, its entities resolved, and the byte at which it begins.
    pub(super) fn attribute(
        self,
        name: &str,
        reporter: &mut Reporter<'_>,
    ) -> Result<Option<(Cow<'a, str>, usize)>, ReadError> {
        let attributes = &self.document.attributes[self.entry().attributes.clone()];
        let Some(attribute) = attributes.iter().find(|attribute| attribute.name == name) else {
            return Ok(None);
        };
        let raw = quick_xml::events::attributes::Attribute {
            key: quick_xml::name::QName(attribute.name.as_bytes()),
            value: Cow::Borrowed(attribute.value.as_bytes()),
        };
        match raw.normalized_value(XmlVersion::Implicit1_0) {
            Ok(value) => Ok(Some((value, attribute.at))),
            Err(error) => {
                let found = quote(error.to_string().as_bytes());
                let expected = "no entities but those of XML itself";
                Err(reporter.unexpected(attribute.at, expected, found))
            }
        }
    }
}

/// The part of `text` that a slice borrowed from it covers, and where it begins.
///
/// The tokens of a reader over a string are slices of that string, but their types have forgotten it.
fn part_of<'a>(text: &'a str, slice: &[u8]) -> (&'a str, usize) {
    let at = (slice.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
    match text.get(at..at.saturating_add(slice.len())) {
        Some(part) => (part, at),
        None => ("", 0),
    }
}

fn offset(position: u64) -> usize {
    usize::try_from(position).unwrap_or(usize::MAX)
}

/// A name that fits into a message.
fn shortened(name: &str) -> Cow<'_, str> {
    const LONGEST: usize = 40;
    match name.char_indices().nth(LONGEST) {
        Some((at, _)) => format!("{}...", &name[..at]).into(),
        None => name.into(),
    }
}
