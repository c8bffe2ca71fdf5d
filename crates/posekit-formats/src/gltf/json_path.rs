//! Ways to values of a JSON text: how a place in it is told, and which one a parser stopped at.

use std::fmt::Write as _;

/// A step from a value into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// To the member of an object.
    Key(&'a str),
    /// To an element of an array.
    Index(usize),
}

/// A way as people write it: `nodes[1].children[0]`.
pub(super) fn path_text(path: &[Step<'_>]) -> String {
    let mut text = String::new();
    for step in path {
        match step {
            Step::Key(key) if text.is_empty() => text += key,
            Step::Key(key) => {
                text.push('.');
                text += key;
            }
            Step::Index(index) => {
                // Writing to a string does not fail.
                let _ = write!(text, "[{index}]");
            }
        }
    }
    text
}

/// The way to the innermost value that a byte of a text is part of. The text may be broken after that byte. Goes over
/// it once, and does not recurse.
pub(super) fn path_at(text: &[u8], byte: usize) -> String {
    /// Names in files are short; those that are not are cut.
    const LONGEST_NAME: usize = 40;
    /// Deeper ways than this say nothing to people.
    const DEEPEST: usize = 16;
    let end = text.len().min(byte.saturating_add(1));
    let mut levels: Vec<Level> = Vec::new();
    let mut at = 0;
    while at < end {
        match text[at] {
            b'{' => levels.push(Level::Object(None)),
            b'[' => levels.push(Level::Array(0)),
            // At the bracket itself the value that it closes is the innermost one.
            b'}' | b']' if at == byte => {
                if let Some(inside) = levels.last_mut() {
                    *inside = Level::Closed;
                }
            }
            b'}' | b']' => {
                levels.pop();
            }
            b',' => match levels.last_mut() {
                Some(Level::Array(index)) => *index += 1,
                Some(Level::Object(key)) => *key = None,
                Some(Level::Closed) | None => {}
            },
            b'"' => {
                let close = string_end(text, at);
                let is_name = text[close.min(text.len())..]
                    .iter()
                    .find(|byte| !byte.is_ascii_whitespace())
                    == Some(&b':');
                if let Some(Level::Object(key @ None)) = levels.last_mut()
                    && is_name
                {
                    *key = Some((at + 1, close.saturating_sub(1)));
                }
                at = close;
                continue;
            }
            _ => {}
        }
        at += 1;
    }
    let mut path = String::new();
    for level in levels.iter().take(DEEPEST) {
        match level {
            Level::Object(Some((from, to))) => {
                let name = text.get(*from..*to).unwrap_or_default();
                let name = String::from_utf8_lossy(&name[..name.len().min(LONGEST_NAME)]);
                let name = name.replace(|c: char| c.is_control(), "\u{fffd}");
                path += &path_text(&[Step::Key(&name)]);
                path.push('.');
            }
            Level::Array(index) => {
                path.truncate(path.trim_end_matches('.').len());
                path += &format!("[{index}].");
            }
            Level::Object(None) | Level::Closed => {}
        }
    }
    path.truncate(path.trim_end_matches('.').len());
    path
}

/// An object or an array that a byte is in.
enum Level {
    /// With the bytes of the name of the member.
    Object(Option<(usize, usize)>),
    /// With the index of the element.
    Array(usize),
    /// Which ends at that byte.
    Closed,
}

/// The offset after the string that starts at `at`, or the end of the text.
fn string_end(text: &[u8], at: usize) -> usize {
    let mut at = at + 1;
    loop {
        match text.get(at) {
            None => return text.len(),
            Some(b'"') => return at + 1,
            Some(b'\\') => at += 2,
            Some(_) => at += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#" { "a\"]" : [1, {"x": "}"}, [ ] ], "nodes":[{"name":"hip"} ,{"children": [ 3,-1e4 ]}] }"#;

    fn path_of(part: &str) -> String {
        path_at(TEXT.as_bytes(), TEXT.find(part).expect("a part"))
    }

    #[test]
    fn ways_are_told_as_people_write_them() {
        let path = [Step::Key("nodes"), Step::Index(1), Step::Key("children")];
        assert_eq!(path_text(&path), "nodes[1].children");
        assert_eq!(path_text(&[]), "");
    }

    #[test]
    fn the_value_that_a_byte_is_in_is_found_whatever_stands_before_it() {
        assert_eq!(path_of("-1e4"), "nodes[1].children[1]");
        assert_eq!(path_of("3,"), "nodes[1].children[0]");
        assert_eq!(path_of("\"hip"), "nodes[0].name");
        assert_eq!(path_of("} ,{"), "nodes[0]");
        assert_eq!(path_of("]}]"), "nodes[1].children");
        assert_eq!(path_of("\"}\""), "a\\\"][1].x");
        assert_eq!(path_of(" {"), "");
    }

    #[test]
    fn what_is_no_json_is_no_trouble() {
        for text in [
            "", "{", "{\"a", "{\"a\":", "[", "[1", "[1,", "]", "{]", "[\"\\", "}}}", "\\\"",
        ] {
            for byte in 0..text.len() + 2 {
                assert!(path_at(text.as_bytes(), byte).len() < 9);
            }
        }
        let deep = [b'['; 10_000];
        assert_eq!(path_at(&deep, 9_999).len(), 16 * 3);
    }
}
