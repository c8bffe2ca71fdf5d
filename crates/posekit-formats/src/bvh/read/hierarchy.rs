//! The HIERARCHY section: joints, without recursion.

use super::motion::warn_out_of_range;
use super::scan::Scanner;
use super::{MAX_DEPTH, MAX_JOINTS, MAX_NAME_BYTES, number};
use crate::bvh::document::implied_end_name;
use crate::bvh::{BvhJoint, EndName};
use crate::report::{ReadError, ReadErrorKind, WarningCode, quote};
use posekit::motion::Channel;
use posekit::range::LONGEST_LENGTH;
use posekit::rotation::Axis;
use std::collections::HashMap;
use std::ops::Range;

/// The joints, and whether MOTION follows; the scanner then stands after that keyword.
pub(super) struct Hierarchy {
    pub(super) joints: Vec<BvhJoint>,
    /// Of each joint, where its own lines stand: from its keyword to the end of its CHANNELS or OFFSET.
    pub(super) texts: Vec<Range<usize>>,
    pub(super) has_motion: bool,
}

/// A joint whose closing brace has not come yet.
struct Open {
    joint: usize,
    /// Where its keyword stands.
    at: usize,
    has_offset: bool,
    has_channels: bool,
    has_children: bool,
}

#[derive(Default)]
struct Builder {
    joints: Vec<BvhJoint>,
    texts: Vec<Range<usize>>,
    open: Vec<Open>,
    /// Every name seen so far and its first joint. Only looked up, never walked over.
    names: HashMap<Vec<u8>, usize>,
}

pub(super) fn read(scanner: &mut Scanner<'_>) -> Result<Hierarchy, ReadError> {
    take_hierarchy_keyword(scanner)?;
    let mut builder = Builder::default();
    let has_motion = loop {
        let word = scanner.peek_word();
        let at = scanner.pos;
        if word.is_empty() {
            match scanner.peek() {
                Some(b'}') => builder.close(scanner),
                None => break false,
                Some(_) => return Err(scanner.unexpected(builder.expected_here())),
            }
            continue;
        }
        scanner.pos += word.len();
        match word.to_ascii_uppercase().as_slice() {
            b"ROOT" => builder.open_joint(scanner, at, Keyword::Root)?,
            b"JOINT" => builder.open_joint(scanner, at, Keyword::Joint)?,
            b"END" => builder.open_end_site(scanner, at)?,
            b"OFFSET" if !builder.open.is_empty() => builder.read_offset(scanner, at)?,
            b"CHANNELS" if !builder.open.is_empty() => builder.read_channels(scanner, at)?,
            b"MOTION" => {
                scanner.pos = at;
                builder.check_closed(scanner)?;
                builder.check_has_root(scanner)?;
                scanner.pos = at + word.len();
                break true;
            }
            _ => {
                scanner.pos = at;
                return Err(scanner.unexpected(builder.expected_here()));
            }
        }
    };
    builder.check_closed(scanner)?;
    builder.check_has_root(scanner)?;
    if !has_motion {
        let at = scanner.pos;
        scanner.warn(WarningCode::MissingMotion, at, || {
            "the file ends without MOTION, read as a skeleton alone".into()
        });
    }
    Ok(Hierarchy {
        joints: builder.joints,
        texts: builder.texts,
        has_motion,
    })
}

fn take_hierarchy_keyword(scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
    if scanner.take_keyword("HIERARCHY") {
        return Ok(());
    }
    let at = scanner.pos;
    if !scanner.peek_word().eq_ignore_ascii_case(b"ROOT") {
        return Err(scanner.unexpected("HIERARCHY"));
    }
    scanner.warn(WarningCode::MissingHierarchy, at, || {
        "ROOT without HIERARCHY before it, read as if it were there".into()
    });
    Ok(())
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Keyword {
    Root,
    Joint,
}

impl Builder {
    /// What may stand where the scanner is, for an error message.
    fn expected_here(&self) -> &'static str {
        match (self.open.is_empty(), self.joints.is_empty()) {
            (false, _) => "OFFSET, CHANNELS, JOINT, End Site or `}`",
            (true, true) => "ROOT",
            (true, false) => "MOTION or ROOT",
        }
    }

    fn check_closed(&self, scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
        let Some(open) = self.open.last() else {
            return Ok(());
        };
        let opened = scanner.reporter.locate(open.at).line;
        let name = quote(&self.joints[open.joint].name);
        let expected = format!("`}}` to close the joint {name} of line {opened}");
        let at = scanner.pos;
        let found = scanner.describe_here();
        Err(scanner.error(ReadErrorKind::UnclosedBrace, at, expected, found))
    }

    fn check_has_root(&self, scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
        if self.joints.is_empty() {
            Err(scanner.unexpected("ROOT"))
        } else {
            Ok(())
        }
    }

    fn open_joint(
        &mut self,
        scanner: &mut Scanner<'_>,
        at: usize,
        keyword: Keyword,
    ) -> Result<(), ReadError> {
        let name_at = scanner.pos;
        let name = scanner.take_name();
        self.note_place(scanner, at, keyword);
        if name.is_empty() {
            scanner.warn(WarningCode::MissingName, at, || {
                "a joint without a name, kept so".into()
            });
        }
        self.note_name(scanner, (at, name_at), name)?;
        self.push(scanner, at, name.to_vec(), None)
    }

    /// Notes what is odd about the name of the joint whose keyword is at `at`, and keeps it in mind;
    /// refuses one that is too long or no text, at `name_at`.
    fn note_name(
        &mut self,
        scanner: &mut Scanner<'_>,
        (at, name_at): (usize, usize),
        name: &[u8],
    ) -> Result<(), ReadError> {
        if std::str::from_utf8(name).is_err() {
            scanner.warn(WarningCode::NonUtf8Name, at, || {
                format!("the name {} is not UTF-8, its bytes are kept", quote(name))
            });
        }
        if name.contains(&0) {
            let found = "a name with a NUL byte in it";
            return Err(scanner.error(ReadErrorKind::NotText, name_at, "text", found));
        }
        if name.len() > MAX_NAME_BYTES {
            let expected = format!("a name of at most {MAX_NAME_BYTES} bytes");
            let found = format!("one of {} bytes", name.len());
            return Err(scanner.error(ReadErrorKind::LimitExceeded, name_at, expected, found));
        }
        if let Some(&first) = self.names.get(name) {
            let joint = self.joints.len();
            scanner.warn(WarningCode::DuplicateName, at, || {
                format!(
                    "joint {joint} has the name {} of joint {first}, both kept",
                    quote(name)
                )
            });
        } else {
            self.names.insert(name.to_vec(), self.joints.len());
        }
        Ok(())
    }

    /// Notes a ROOT inside a joint, a JOINT outside, and a second ROOT.
    fn note_place(&self, scanner: &mut Scanner<'_>, at: usize, keyword: Keyword) {
        match (keyword, self.open.is_empty()) {
            (Keyword::Root, false) => scanner.warn(WarningCode::MisplacedJoint, at, || {
                "a ROOT inside a joint, read as its child".into()
            }),
            (Keyword::Joint, true) => scanner.warn(WarningCode::MisplacedJoint, at, || {
                "a JOINT outside every joint, read as a root".into()
            }),
            _ => {}
        }
        if self.open.is_empty() && !self.joints.is_empty() {
            scanner.warn(WarningCode::SeveralRoots, at, || {
                "another root, kept as a skeleton of several".into()
            });
        }
    }

    fn open_end_site(&mut self, scanner: &mut Scanner<'_>, at: usize) -> Result<(), ReadError> {
        let Some(parent) = self.open.last() else {
            scanner.pos = at;
            return Err(scanner.unexpected(self.expected_here()));
        };
        let parent = parent.joint;
        let written = scanner.take_end_name();
        if !written.is_site {
            scanner.warn(WarningCode::EndSiteWords, at, || {
                let words = quote(written.words);
                format!("`End` is followed by {words}, read as an End Site")
            });
        }
        let name = match written.end_name {
            EndName::Implied => implied_end_name(&self.joints[parent].name),
            EndName::Comment | EndName::Word => {
                self.note_name(scanner, (at, at), written.name)?;
                written.name.to_vec()
            }
        };
        self.push(scanner, at, name, Some(written.end_name))
    }

    fn push(
        &mut self,
        scanner: &mut Scanner<'_>,
        at: usize,
        name: Vec<u8>,
        end_site: Option<EndName>,
    ) -> Result<(), ReadError> {
        if self.open.len() >= MAX_DEPTH {
            let expected = format!("joints nested at most {MAX_DEPTH} deep");
            return Err(scanner.error(ReadErrorKind::LimitExceeded, at, expected, "a deeper one"));
        }
        if self.joints.len() >= MAX_JOINTS {
            let expected = format!("at most {MAX_JOINTS} joints");
            return Err(scanner.error(ReadErrorKind::LimitExceeded, at, expected, "one more"));
        }
        scanner.skip_blanks();
        if scanner.peek() != Some(b'{') {
            return Err(scanner.unexpected("`{`"));
        }
        scanner.pos += 1;
        let joint = self.joints.len();
        let parent = self.open.last().map(|open| open.joint);
        if let Some(open) = self.open.last_mut() {
            open.has_children = true;
            self.demote_end_site(scanner, at, "children");
        }
        self.joints.push(BvhJoint {
            name,
            parent,
            offset: [0.0; 3],
            channels: Vec::new(),
            is_end_site: end_site.is_some(),
            end_name: end_site.unwrap_or_default(),
        });
        self.texts.push(at..scanner.pos);
        self.open.push(Open {
            joint,
            at,
            has_offset: false,
            has_channels: false,
            has_children: false,
        });
        Ok(())
    }

    /// Makes the innermost open End Site a joint, because it has what only joints have.
    fn demote_end_site(&mut self, scanner: &mut Scanner<'_>, at: usize, what: &str) {
        let Some(open) = self.open.last() else { return };
        let joint = &mut self.joints[open.joint];
        if joint.is_end_site {
            joint.is_end_site = false;
            joint.end_name = EndName::Implied;
            let name = quote(&joint.name);
            scanner.warn(WarningCode::EndSiteAsJoint, at, || {
                format!("an End Site with {what}, read as a joint named {name}")
            });
        }
    }

    fn read_offset(&mut self, scanner: &mut Scanner<'_>, at: usize) -> Result<(), ReadError> {
        let Some(open) = self.open.last_mut() else {
            return Ok(());
        };
        if open.has_offset {
            scanner.warn(WarningCode::ExtraOffset, at, || {
                "another OFFSET, the last is used".into()
            });
        }
        open.has_offset = true;
        let mut offset = [0.0; 3];
        for coordinate in &mut offset {
            scanner.skip_blanks();
            let at = scanner.pos;
            *coordinate = number::read(scanner, "a number of OFFSET")?;
            if coordinate.abs() > LONGEST_LENGTH {
                warn_out_of_range(scanner, at, *coordinate);
            }
        }
        self.joints[open.joint].offset = offset;
        self.texts[open.joint].end = scanner.pos;
        skip_extra_numbers(scanner)
    }

    fn read_channels(&mut self, scanner: &mut Scanner<'_>, at: usize) -> Result<(), ReadError> {
        let Some(open) = self.open.last_mut() else {
            return Ok(());
        };
        let joint = open.joint;
        if open.has_channels {
            scanner.warn(WarningCode::RepeatedChannels, at, || {
                "another CHANNELS, its list is added to the first".into()
            });
        }
        open.has_channels = true;
        let announced = take_count(scanner);
        let mut listed = 0;
        while let Some(channel) = take_channel(scanner)? {
            if self.joints[joint].channels.contains(&channel) {
                let at = scanner.pos - channel.name().len();
                scanner.warn(WarningCode::DuplicateChannel, at, || {
                    format!("{} is listed twice, both columns kept", channel.name())
                });
            }
            self.joints[joint].channels.push(channel);
            self.texts[joint].end = scanner.pos;
            listed += 1;
        }
        if announced != Some(listed) {
            scanner.warn(WarningCode::ChannelCountMismatch, at, || {
                let announced = announced.map_or("no number".into(), |count| count.to_string());
                format!("CHANNELS says {announced} and lists {listed}, the list is used")
            });
        }
        if listed > 0 {
            self.demote_end_site(scanner, at, "channels");
        }
        Ok(())
    }

    fn close(&mut self, scanner: &mut Scanner<'_>) {
        let at = scanner.pos;
        scanner.pos += 1;
        let Some(open) = self.open.pop() else {
            scanner.warn(WarningCode::ExtraClosingBrace, at, || {
                "a `}` that closes nothing, ignored".into()
            });
            return;
        };
        let joint = &self.joints[open.joint];
        let name = || quote(&joint.name);
        if !open.has_offset {
            scanner.warn(WarningCode::MissingOffset, open.at, || {
                format!("{} has no OFFSET, zero is used", name())
            });
        }
        if joint.is_end_site {
            if open.has_offset && joint.offset.iter().all(|&number| number == 0.0) {
                scanner.warn(WarningCode::ZeroLengthEndSite, open.at, || {
                    format!("{} has no length, kept", name())
                });
            }
            return;
        }
        if !open.has_channels {
            scanner.warn(WarningCode::MissingChannels, open.at, || {
                format!("{} has no CHANNELS, it does not move", name())
            });
        }
        if !open.has_children {
            scanner.warn(WarningCode::MissingEndSite, open.at, || {
                format!("{} has neither children nor an End Site, kept", name())
            });
        }
        let has_position = joint
            .channels
            .iter()
            .any(|channel| matches!(channel, Channel::Position(_)));
        if joint.parent.is_none()
            && has_position
            && joint.offset.iter().any(|&number| number != 0.0)
        {
            let [x, y, z] = joint.offset;
            scanner.warn(WarningCode::NonzeroRootOffset, open.at, || {
                format!(
                    "{} has position channels and the OFFSET {x} {y} {z}, both kept",
                    name()
                )
            });
        }
    }
}

/// Skips numbers after the third of an OFFSET, as some exporters put a rotation there.
fn skip_extra_numbers(scanner: &mut Scanner<'_>) -> Result<(), ReadError> {
    scanner.skip_blanks();
    let at = scanner.pos;
    while scanner
        .peek()
        .is_some_and(|byte| byte.is_ascii_digit() || b"+-.".contains(&byte))
    {
        number::read(scanner, "a number of OFFSET")?;
        scanner.skip_blanks();
    }
    if scanner.pos > at {
        scanner.warn(WarningCode::ExtraOffset, at, || {
            "more than three numbers after OFFSET, the first three are used".into()
        });
    }
    Ok(())
}

/// Takes the number of channels, if the next word is one.
fn take_count(scanner: &mut Scanner<'_>) -> Option<usize> {
    let word = scanner.peek_word();
    let count = std::str::from_utf8(word).ok()?.parse().ok()?;
    scanner.pos += word.len();
    Some(count)
}

/// Takes the next word if it is a channel; `None` at a keyword or a brace.
fn take_channel(scanner: &mut Scanner<'_>) -> Result<Option<Channel>, ReadError> {
    let word = scanner.peek_word();
    let upper = word.to_ascii_uppercase();
    let is_keyword = matches!(
        upper.as_slice(),
        b"" | b"ROOT" | b"JOINT" | b"END" | b"OFFSET" | b"CHANNELS" | b"MOTION"
    );
    if is_keyword {
        return Ok(None);
    }
    let Some(channel) = channel(&upper) else {
        return Err(unknown_channel(scanner, word, &upper));
    };
    scanner.pos += word.len();
    Ok(Some(channel))
}

/// The refusal of a word that is no Euler channel, which says so where it is one of a quaternion.
#[cold]
fn unknown_channel(scanner: &mut Scanner<'_>, word: &[u8], upper: &[u8]) -> ReadError {
    let at = scanner.pos;
    let kind = ReadErrorKind::UnknownChannel;
    if is_quaternion(upper) {
        let expected = "Euler channels such as `Xrotation`";
        let found = format!(
            "the quaternion channel {}, which BVH does not have",
            quote(word)
        );
        return scanner.error(kind, at, expected, found);
    }
    let found = scanner.describe_here();
    scanner.error(kind, at, "a channel name such as `Xrotation`", found)
}

/// Whether a word in upper case is a channel of the quaternions that some programs write into BVH:
/// `Wrotation` after the three of an axis each, `Quaternion` for all four, `Qx` or `Xquaternion` for one.
fn is_quaternion(upper: &[u8]) -> bool {
    const PARTS: [&[u8]; 4] = [b"X", b"Y", b"Z", b"W"];
    upper == b"WROTATION"
        || upper.starts_with(b"QUAT")
        || upper.ends_with(b"QUATERNION")
        || upper.ends_with(b"QUAT")
        || upper
            .strip_prefix(b"Q")
            .is_some_and(|part| PARTS.contains(&part.strip_suffix(b"ROTATION").unwrap_or(part)))
}

/// The channel of a name in upper case.
fn channel(upper: &[u8]) -> Option<Channel> {
    let (letter, kind) = upper.split_first()?;
    let axis = match letter {
        b'X' => Axis::X,
        b'Y' => Axis::Y,
        b'Z' => Axis::Z,
        _ => return None,
    };
    match kind {
        b"POSITION" => Some(Channel::Position(axis)),
        b"ROTATION" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}
