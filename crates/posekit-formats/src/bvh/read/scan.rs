//! The scanner: bytes to words, and what lies between them.

use crate::bvh::EndName;
use crate::report::{ImportReport, ReadError, ReadErrorKind, Reporter, WarningCode, quote};

/// What commas mean in this file, decided at the first one that tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Comma {
    /// None seen yet.
    Unknown,
    /// `0,5` is a half.
    Decimal,
    /// `0,5` is two numbers.
    Separator,
}

/// A position in the bytes, and the report that grows on the way.
#[derive(Debug)]
pub(super) struct Scanner<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) pos: usize,
    pub(super) comma: Comma,
    pub(super) reporter: Reporter<'a>,
}

/// Blanks between words, line ends included. NUL and other control characters are not among them.
pub(super) const fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c)
}

impl<'a> Scanner<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            pos: 0,
            comma: Comma::Unknown,
            reporter: Reporter::new(bytes),
        }
    }

    pub(super) fn finish(self) -> ImportReport {
        self.reporter.finish()
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.pos).copied()
    }

    pub(super) fn warn(&mut self, code: WarningCode, at: usize, message: impl FnOnce() -> String) {
        self.reporter.warn(code, at, message);
    }

    pub(super) fn error(
        &mut self,
        kind: ReadErrorKind,
        at: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        self.reporter.error(kind, at, expected, found)
    }

    /// The error for a word that should have been something else.
    pub(super) fn unexpected(&mut self, expected: &str) -> ReadError {
        let at = self.pos;
        let found = self.describe_here();
        self.error(ReadErrorKind::Unexpected, at, expected, found)
    }

    /// What stands at the current position, as a message says it.
    pub(super) fn describe_here(&self) -> String {
        match self.peek() {
            None => "the end of the file".into(),
            Some(brace @ (b'{' | b'}')) => quote(&[brace]),
            Some(_) => quote(self.text_here()),
        }
    }

    /// The bytes up to the next blank or brace.
    fn text_here(&self) -> &'a [u8] {
        let rest = &self.bytes[self.pos..];
        let is_end = |&byte: &u8| is_blank(byte) || matches!(byte, b'{' | b'}');
        &rest[..rest.iter().position(is_end).unwrap_or(rest.len())]
    }

    pub(super) fn skip_byte_order_mark(&mut self) {
        if self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.pos = 3;
            self.warn(WarningCode::ByteOrderMark, 0, || {
                "a UTF-8 byte order mark, skipped".into()
            });
        }
    }

    /// Moves to the next word, brace or number, over blanks, commas that separate and comments.
    pub(super) fn skip_blanks(&mut self) {
        while let Some(byte) = self.peek() {
            if is_blank(byte) {
                self.pos += 1;
            } else if !self.skip_separator(byte) {
                return;
            }
        }
    }

    /// Skips a separating comma or a comment at the current position; says whether there was one.
    pub(super) fn skip_separator(&mut self, byte: u8) -> bool {
        match byte {
            b',' => {
                let at = self.pos;
                self.pos += 1;
                self.warn(WarningCode::CommaSeparator, at, || {
                    "a comma between values, read as a blank".into()
                });
            }
            b'#' | b';' => self.skip_comment(),
            b'/' if self.bytes.get(self.pos + 1) == Some(&b'/') => self.skip_comment(),
            _ => return false,
        }
        true
    }

    fn skip_comment(&mut self) {
        let at = self.pos;
        let rest = &self.bytes[at..];
        let length = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        self.pos += length;
        self.warn(WarningCode::CommentSkipped, at, || {
            format!(
                "the comment {}, skipped",
                quote(rest[..length].trim_ascii())
            )
        });
    }

    /// The next word, without moving: bytes up to a blank, a brace or a colon. Empty at a brace, at a
    /// colon and at the end.
    pub(super) fn peek_word(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.pos..];
        let is_end = |&byte: &u8| is_blank(byte) || matches!(byte, b'{' | b'}' | b':' | b',');
        &rest[..rest.iter().position(is_end).unwrap_or(rest.len())]
    }

    /// Takes the next word if it is this keyword, in any case.
    pub(super) fn take_keyword(&mut self, keyword: &str) -> bool {
        let word = self.peek_word();
        let is_it = word.eq_ignore_ascii_case(keyword.as_bytes());
        if is_it {
            self.pos += word.len();
        }
        is_it
    }

    /// Takes the rest of a joint's opening line as its name: all bytes up to a brace, a line end or a
    /// comment after a blank, without blanks around them. The name may stand on the next line.
    pub(super) fn take_name(&mut self) -> &'a [u8] {
        while self.peek().is_some_and(is_blank) {
            self.pos += 1;
        }
        let rest = &self.bytes[self.pos..];
        let length = memchr::memchr3(b'{', b'\n', b'\r', rest).unwrap_or(rest.len());
        let length = comment_start(&rest[..length]).unwrap_or(length);
        self.pos += length;
        rest[..length].trim_ascii()
    }
}

/// What stands after `End`.
pub(super) struct WrittenEnd<'a> {
    /// Whether the first word is `Site`.
    pub(super) is_site: bool,
    /// All words, without a comment.
    pub(super) words: &'a [u8],
    /// Where the name comes from.
    pub(super) end_name: EndName,
    /// The name, empty where there is none.
    pub(super) name: &'a [u8],
}

impl<'a> Scanner<'a> {
    /// Takes what stands after `End` up to the brace or the line's end: `Site`, a name after it, or a name
    /// in a comment, as `#name: LeftToeTip`. Another comment is left where it is.
    pub(super) fn take_end_name(&mut self) -> WrittenEnd<'a> {
        let words = self.take_name();
        let length = words
            .iter()
            .position(|&b| is_blank(b))
            .unwrap_or(words.len());
        let (first, rest) = words.split_at(length);
        let is_site = first.eq_ignore_ascii_case(b"Site");
        let word = rest.trim_ascii();
        let mut end = WrittenEnd {
            is_site,
            words,
            end_name: EndName::Implied,
            name: b"",
        };
        if is_site && !word.is_empty() {
            (end.end_name, end.name) = (EndName::Word, word);
        } else if is_site && let Some((name, length)) = name_in_comment(&self.bytes[self.pos..]) {
            (end.end_name, end.name) = (EndName::Comment, name);
            self.pos += length;
        }
        end
    }
}

/// The name in a comment `#name: LeftToeTip`, and how many bytes it takes up to the brace or the line's
/// end.
fn name_in_comment(text: &[u8]) -> Option<(&[u8], usize)> {
    const LABEL: &[u8] = b"name";
    let length = memchr::memchr3(b'{', b'\n', b'\r', text).unwrap_or(text.len());
    let comment = text[..length].trim_ascii_start().strip_prefix(b"#")?;
    let comment = comment.trim_ascii_start();
    let label = comment.get(..LABEL.len())?;
    let after = comment[LABEL.len()..].trim_ascii_start();
    let name = after.strip_prefix(b":")?.trim_ascii();
    (label.eq_ignore_ascii_case(LABEL) && !name.is_empty()).then_some((name, length))
}

/// Where a comment begins in a line that starts with a name: a `#` or `//` after a blank.
fn comment_start(line: &[u8]) -> Option<usize> {
    (1..line.len())
        .find(|&at| is_blank(line[at - 1]) && (line[at] == b'#' || line[at..].starts_with(b"//")))
}
