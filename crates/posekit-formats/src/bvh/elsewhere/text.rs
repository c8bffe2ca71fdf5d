//! How a file is spelled and laid out, which the document no longer says.

/// What stands in the text otherwise than most programs expect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Spelling {
    /// A channel is spelled with other capitals than `Xposition`.
    pub(super) has_odd_channels: bool,
    /// A keyword has other capitals, or a blank too few, as `Frames:6`.
    pub(super) has_odd_keywords: bool,
    /// Statements share a line, or OFFSET and CHANNELS are not in this order right after the brace.
    pub(super) has_odd_layout: bool,
    /// `End Site` is followed by a name.
    pub(super) has_end_site_names: bool,
    /// `End` is followed by something else than `Site`.
    pub(super) has_other_ends: bool,
    /// What `Frames:` says, where it makes sense.
    pub(super) announced_frames: Option<usize>,
}

/// What the next statement of a joint must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Due {
    /// The opening brace of a joint; of an End Site.
    Brace { is_end: bool },
    /// OFFSET.
    Offset { is_end: bool },
    /// CHANNELS.
    Channels,
    /// Anything.
    Anything,
}

const CHANNELS: [&[u8]; 6] = [
    b"Xposition",
    b"Yposition",
    b"Zposition",
    b"Xrotation",
    b"Yrotation",
    b"Zrotation",
];

/// Reads the spelling of a file, line by line, up to its first row; any bytes are taken.
pub(super) fn spelling(bytes: &[u8]) -> Spelling {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut spelling = Spelling::default();
    let mut due = Due::Anything;
    let mut lines = bytes
        .split(|byte| matches!(byte, b'\n' | b'\r'))
        .map(words)
        .filter(|words| !words.is_empty());
    for line in lines.by_ref() {
        if is_keyword(line[0], b"MOTION", &mut spelling) {
            spelling.has_odd_layout |= line.len() > 1;
            break;
        }
        due = read_statement(&line, due, &mut spelling);
    }
    read_motion_header(lines, &mut spelling);
    spelling
}

/// More words than this on a line are not looked at: no joint has so many channels.
const WORDS_MAX: usize = 4096;

fn words(line: &[u8]) -> Vec<&[u8]> {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
        .take(WORDS_MAX)
        .collect()
}

/// Whether a word is a keyword in any capitals; other ones than `keyword` has are noted.
fn is_keyword(word: &[u8], keyword: &[u8], spelling: &mut Spelling) -> bool {
    let is_it = word.eq_ignore_ascii_case(keyword);
    spelling.has_odd_keywords |= is_it && word != keyword;
    is_it
}

fn read_statement(line: &[&[u8]], due: Due, spelling: &mut Spelling) -> Due {
    let word = line[0];
    if is_keyword(word, b"OFFSET", spelling) {
        spelling.has_odd_layout |= line.len() != 4;
        return match due {
            Due::Offset { is_end: true } => Due::Anything,
            Due::Offset { is_end: false } => Due::Channels,
            Due::Brace { .. } | Due::Channels | Due::Anything => odd(spelling),
        };
    }
    if is_keyword(word, b"CHANNELS", spelling) {
        read_channels(line, spelling);
        return if due == Due::Channels {
            Due::Anything
        } else {
            odd(spelling)
        };
    }
    if word == b"{" {
        spelling.has_odd_layout |= line.len() > 1;
        return match due {
            Due::Brace { is_end } => Due::Offset { is_end },
            Due::Offset { .. } | Due::Channels | Due::Anything => odd(spelling),
        };
    }
    // What comes next begins something new: nothing may be missing.
    spelling.has_odd_layout |= due != Due::Anything;
    if is_keyword(word, b"End", spelling) {
        let is_site = line
            .get(1)
            .is_some_and(|word| is_keyword(word, b"Site", spelling));
        spelling.has_other_ends |= !is_site;
        spelling.has_end_site_names |= is_site && line.len() > 2;
        spelling.has_odd_layout |= has_brace(line);
        return Due::Brace { is_end: true };
    }
    if is_keyword(word, b"ROOT", spelling) || is_keyword(word, b"JOINT", spelling) {
        spelling.has_odd_layout |= has_brace(line);
        return Due::Brace { is_end: false };
    }
    let is_known = word == b"}" || is_keyword(word, b"HIERARCHY", spelling);
    spelling.has_odd_layout |= is_known && line.len() > 1;
    Due::Anything
}

fn odd(spelling: &mut Spelling) -> Due {
    spelling.has_odd_layout = true;
    Due::Anything
}

fn has_brace(line: &[&[u8]]) -> bool {
    line.iter()
        .any(|word| word.contains(&b'{') || word.contains(&b'}'))
}

fn read_channels(line: &[&[u8]], spelling: &mut Spelling) {
    let names = line.get(2..).unwrap_or_default();
    let count = line
        .get(1)
        .and_then(|count| core::str::from_utf8(count).ok()?.parse().ok());
    let is_channel = |name: &&[u8]| {
        CHANNELS
            .iter()
            .any(|known| name.eq_ignore_ascii_case(known))
    };
    spelling.has_odd_layout |= count != Some(names.len()) || !names.iter().all(is_channel);
    spelling.has_odd_channels |= names
        .iter()
        .any(|name| is_channel(name) && !CHANNELS.contains(name));
}

fn read_motion_header<'a>(mut lines: impl Iterator<Item = Vec<&'a [u8]>>, spelling: &mut Spelling) {
    let Some(frames) = lines.next() else {
        return;
    };
    match frames.as_slice() {
        [b"Frames:", count] => {
            spelling.announced_frames = core::str::from_utf8(count)
                .ok()
                .and_then(|text| text.parse().ok());
        }
        _ => spelling.has_odd_keywords = true,
    }
    if let Some(time) = lines.next() {
        spelling.has_odd_keywords |= !matches!(time.as_slice(), [b"Frame", b"Time:", _]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: &str = "HIERARCHY\nROOT hip\n{\n\tOFFSET 0 0 0\n\tCHANNELS 1 Yrotation\n\tEnd Site\n\t{\n\t\tOFFSET 0 1 0\n\t}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.5\n10\n20\n";

    fn after(from: &str, to: &str) -> Spelling {
        assert!(PLAIN.contains(from), "{from}");
        spelling(PLAIN.replace(from, to).as_bytes())
    }

    #[test]
    fn a_plain_file_has_nothing_odd() {
        let plain = Spelling {
            announced_frames: Some(2),
            ..Spelling::default()
        };
        assert_eq!(spelling(PLAIN.as_bytes()), plain);
        assert_eq!(spelling(PLAIN.replace('\n', "\r\n\r\n").as_bytes()), plain);
    }

    #[test]
    fn each_oddity_is_seen() {
        assert!(after("Yrotation", "YROTATION").has_odd_channels);
        for (from, to) in [
            ("HIERARCHY", "Hierarchy"),
            ("OFFSET", "Offset"),
            ("Site", "site"),
            ("Frames: ", "Frames:"),
            ("Frame Time", "Frame time"),
            ("MOTION", "Motion"),
        ] {
            let spelling = after(from, to);
            assert!(
                spelling.has_odd_keywords && !spelling.has_odd_layout,
                "{to}"
            );
        }
        for (from, to) in [
            ("hip\n{", "hip {"),
            ("\n\tCHANNELS", " CHANNELS"),
            ("\tCHANNELS 1 Yrotation\n", ""),
            ("1 Yrotation", "2 Yrotation"),
            (
                "\tOFFSET 0 0 0\n\tCHANNELS 1 Yrotation\n",
                "CHANNELS 1 Yrotation\nOFFSET 0 0 0\n",
            ),
            ("\t}\n}", "\t} }"),
        ] {
            assert!(after(from, to).has_odd_layout, "{to}");
        }
        assert!(after("End Site", "End Site Tip").has_end_site_names);
        assert!(after("End Site", "End Tip").has_other_ends);
    }

    #[test]
    fn any_bytes_are_taken() {
        for text in [
            "",
            "MOTION",
            "CHANNELS",
            "End",
            "OFFSET\u{0}",
            "MOTION\nFrames:",
            "{ } {",
        ] {
            let _ = spelling(text.as_bytes());
        }
        let _ = spelling(&[0xff, 0xfe, b'\n', b'{']);
    }
}
