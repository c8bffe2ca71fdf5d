//! What went wrong, as the one line that is shown for it.

use std::fmt;
use std::io;
use std::path::Path;

use posekit_formats::system::in_words;

use crate::console;

/// Exit code when everything asked for was done.
pub(crate) const EXIT_DONE: u8 = 0;
/// Exit code when something could not be done.
pub(crate) const EXIT_COULD_NOT: u8 = 1;
/// Exit code when the command line itself makes no sense; clap uses the same number.
pub(crate) const EXIT_WRONG_USAGE: u8 = 2;

/// Why a command, or its work on one input, stopped.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The work could not be done: a bad file, a full disk.
    CouldNot(Message),
    /// The command line asks for something that makes no sense.
    Usage(Message),
    /// Whoever read our output stopped reading, as `head` does: not an error.
    ClosedPipe,
}

/// One line for people: lower case, no full stop.
#[derive(Debug)]
pub(crate) struct Message {
    what: String,
    next: Option<String>,
    /// More that is wrong, a line each.
    also: Vec<String>,
}

impl Failure {
    /// Something could not be done.
    pub(crate) fn new(what: impl Into<String>) -> Self {
        Self::CouldNot(Message {
            what: what.into(),
            next: None,
            also: Vec::new(),
        })
    }

    /// The command line asks for something that makes no sense.
    pub(crate) fn usage(what: impl Into<String>) -> Self {
        Self::Usage(Message {
            what: what.into(),
            next: None,
            also: Vec::new(),
        })
    }

    /// Adds what the user may do next.
    pub(crate) fn try_next(mut self, next: impl Into<String>) -> Self {
        if let Self::CouldNot(message) | Self::Usage(message) = &mut self {
            message.next = Some(next.into());
        }
        self
    }

    /// Adds more that is wrong with the same file, each on a line of its own.
    pub(crate) fn and(mut self, more: impl IntoIterator<Item = String>) -> Self {
        if let Self::CouldNot(message) | Self::Usage(message) = &mut self {
            message.also.extend(more);
        }
        self
    }

    /// Writes the message to standard error, a line for each thing that is wrong.
    pub(crate) fn say(&self) {
        if let Self::CouldNot(message) | Self::Usage(message) = self {
            console::error(&message.first());
            for more in &message.also {
                console::error(more);
            }
        } else {
            console::error(&self.to_string());
        }
    }

    /// Puts the input's name in front of the message.
    pub(crate) fn in_file(mut self, name: &str) -> Self {
        if let Self::CouldNot(message) | Self::Usage(message) = &mut self {
            message.what = format!("{name}: {}", message.what);
        }
        self
    }

    /// An operating system's refusal to read a path, in plain words.
    pub(crate) fn cannot_read(path: &Path, error: &io::Error) -> Self {
        let name = path.display();
        match error.kind() {
            io::ErrorKind::NotFound => Self::new(format!("{name}: no such file")),
            io::ErrorKind::PermissionDenied => {
                Self::new(format!("{name}: no permission to read this file"))
                    .try_next("check its permissions")
            }
            io::ErrorKind::IsADirectory => Self::new(format!("{name}: is a folder, not a file")),
            _ => Self::new(format!("{name}: cannot read: {}", in_words(error))),
        }
    }

    /// An operating system's refusal to write a path, in plain words.
    pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Self {
        let name = path.display();
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ClosedPipe,
            io::ErrorKind::NotFound => Self::new(format!("{name}: its folder does not exist")),
            io::ErrorKind::PermissionDenied => {
                Self::new(format!("{name}: no permission to write here"))
            }
            _ => Self::new(format!("{name}: cannot write: {}", in_words(error))),
        }
    }

    /// The failure as output for programs has it: a line with an object of file and error.
    pub(crate) fn json_line(&self, name: &str) -> String {
        format!(
            "{}\n",
            serde_json::json!({ "file": name, "error": self.to_string() })
        )
    }

    /// The process's exit code for this failure.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::CouldNot(_) => EXIT_COULD_NOT,
            Self::Usage(_) => EXIT_WRONG_USAGE,
            Self::ClosedPipe => EXIT_DONE,
        }
    }
}

impl From<io::Error> for Failure {
    /// For writes to standard output; files have [`Failure::cannot_write`].
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::ClosedPipe
        } else {
            Self::new(format!(
                "cannot write to standard output: {}",
                in_words(&error)
            ))
        }
    }
}

impl Message {
    /// What is wrong and what to do next: one line, whatever a file name or a file's text brought with it.
    fn first(&self) -> String {
        let what = one_line(&self.what);
        match &self.next {
            Some(next) => format!("{what}; {}", one_line(next)),
            None => what,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CouldNot(message) | Self::Usage(message) => {
                f.write_str(&message.first())?;
                message
                    .also
                    .iter()
                    .try_for_each(|more| write!(f, "; {}", one_line(more)))
            }
            Self::ClosedPipe => f.write_str("the program that was reading the output stopped"),
        }
    }
}

/// `text` with escapes in place of what moves the cursor, ends the line or turns the direction of writing: names
/// that come out of a file stay one line, and read as they are.
pub(crate) fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if is_shown(c) {
            line.push(c);
        } else {
            line.extend(c.escape_default());
        }
    }
    line
}

/// Whether a terminal shows a character and does nothing else with it.
///
/// Left alone are the joiners U+200C and U+200D, which words and emoji are written with.
fn is_shown(c: char) -> bool {
    let does_something = c.is_control()
        || matches!(c,
            // The direction of writing: marks, embeddings, overrides, isolates (Unicode Standard Annex 9).
            '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{206f}'
            // Ends of lines and paragraphs.
            | '\u{2028}' | '\u{2029}'
            // What has no width, so that two names look the same.
            | '\u{ad}' | '\u{200b}' | '\u{2060}'..='\u{2065}' | '\u{feff}' | '\u{180e}'
            | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}');
    !does_something
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_one_line_with_the_next_step_after_it() {
        let failure = Failure::new("bad\nname")
            .in_file("a.bvh")
            .try_next("look again");
        assert_eq!(failure.to_string(), "a.bvh: bad\\nname; look again");
    }

    #[test]
    fn what_would_move_the_cursor_or_turn_the_text_is_escaped_and_the_rest_stays() {
        for (text, shown) in [
            ("a\u{202e}b", "a\\u{202e}b"),
            (
                "\u{1b}[31mred\u{1b}]0;t\u{7}",
                "\\u{1b}[31mred\\u{1b}]0;t\\u{7}",
            ),
            ("a\tb\u{9b}", "a\\tb\\u{9b}"),
            ("a\u{2028}b\u{feff}", "a\\u{2028}b\\u{feff}"),
            (
                "Hüfte \u{5e9}\u{5dc} 手 \u{1f468}\u{200d}\u{1f469}",
                "Hüfte \u{5e9}\u{5dc} 手 \u{1f468}\u{200d}\u{1f469}",
            ),
        ] {
            assert_eq!(one_line(text), shown);
        }
    }

    #[test]
    fn the_operating_systems_words_lose_their_number_and_full_stop() {
        let error = io::Error::from_raw_os_error(5);
        let text = Failure::cannot_read(Path::new("a.bvh"), &error).to_string();
        assert!(text.starts_with("a.bvh: cannot read: "), "{text}");
        assert!(!text.contains("os error"), "{text}");
    }
}
