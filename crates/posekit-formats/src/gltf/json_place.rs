//! Where in a JSON text a value stands: what the parser of the format does not tell.

/// A step from a value into it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// To the member of an object.
    Key(&'a str),
    /// To an element of an array.
    Index(usize),
}

/// The byte offset of the value at the end of a path in a text that is valid JSON; where the path leads
/// nowhere, that of the last value on it. Goes over the text once, and does not recurse.
pub(super) fn place_of(text: &[u8], path: &[Step<'_>]) -> usize {
    let mut at = after_blanks(text, 0);
    for step in path {
        match enter(text, at, *step) {
            Some(inside) => at = inside,
            None => break,
        }
    }
    at
}

fn enter(text: &[u8], at: usize, step: Step<'_>) -> Option<usize> {
    let mut at = match (step, text.get(at)?) {
        (Step::Key(_), b'{') | (Step::Index(_), b'[') => after_blanks(text, at + 1),
        _ => return None,
    };
    let mut passed = 0;
    loop {
        let is_it = match step {
            Step::Index(index) => index == passed,
            Step::Key(name) => {
                let end = string_end(text, at)?;
                // The names that are looked for have nothing in them that is ever escaped.
                let is_it = text.get(at + 1..end - 1)? == name.as_bytes();
                let colon = after_blanks(text, end);
                at = after_blanks(text, colon + 1);
                is_it
            }
        };
        let end = value_end(text, at)?;
        if is_it {
            return Some(at);
        }
        let comma = after_blanks(text, end);
        if text.get(comma)? != &b',' {
            return None;
        }
        at = after_blanks(text, comma + 1);
        passed += 1;
    }
}

fn after_blanks(text: &[u8], at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + rest
        .iter()
        .take_while(|byte| byte.is_ascii_whitespace())
        .count()
}

/// The offset after the string that starts at `at`.
fn string_end(text: &[u8], at: usize) -> Option<usize> {
    if text.get(at)? != &b'"' {
        return None;
    }
    let mut at = at + 1;
    loop {
        match text.get(at)? {
            b'"' => return Some(at + 1),
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
}

/// The offset after the value that starts at `at`.
fn value_end(text: &[u8], mut at: usize) -> Option<usize> {
    let is_mark = |byte: u8| byte.is_ascii_whitespace() || b",:]}".contains(&byte);
    let mut depth = 0_usize;
    loop {
        match *text.get(at)? {
            b'"' => at = string_end(text, at)?,
            b'{' | b'[' => {
                depth += 1;
                at += 1;
            }
            b'}' | b']' => {
                depth = depth.checked_sub(1)?;
                at += 1;
            }
            byte if is_mark(byte) && depth == 0 => return None,
            byte if is_mark(byte) => at += 1,
            _ => {
                let rest = &text[at..];
                at += rest.iter().take_while(|byte| !is_mark(**byte)).count();
            }
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#" { "a\"]" : [1, {"x": "}"}, [ ] ], "nodes":[{"name":"hip"} ,{"children": [ 3,-1e4 ]}] }"#;

    fn from_there(path: &[Step<'_>]) -> &'static str {
        &TEXT[place_of(TEXT.as_bytes(), path)..]
    }

    #[test]
    fn values_are_found_whatever_stands_before_them() {
        let child = [
            Step::Key("nodes"),
            Step::Index(1),
            Step::Key("children"),
            Step::Index(1),
        ];
        assert!(from_there(&child).starts_with("-1e4 ]"));
        assert!(from_there(&child[..2]).starts_with("{\"children\""));
        assert!(from_there(&[Step::Key("nodes")]).starts_with("[{\"name\""));
        assert!(from_there(&[]).starts_with("{ "));
    }

    #[test]
    fn a_path_that_leads_nowhere_ends_where_it_could_go_last() {
        let beyond = [Step::Key("nodes"), Step::Index(7), Step::Key("name")];
        assert!(from_there(&beyond).starts_with("[{\"name\""));
        assert!(from_there(&[Step::Index(0)]).starts_with("{ "));
    }

    #[test]
    fn what_is_no_json_is_no_trouble() {
        for text in [
            "", "{", "{\"a", "{\"a\":", "[", "[1", "[1,", "]", "{]", "[\"\\",
        ] {
            let path = [Step::Key("a"), Step::Index(1)];
            for path in [&path[..], &path[1..]] {
                assert!(place_of(text.as_bytes(), path) <= text.len());
            }
        }
    }
}
