//! The stable codes of everything a reader may notice, in one list.

use std::fmt;

/// How much a warning means.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Unusual but right, or harmless: nothing was repaired.
    Note,
    /// The file contradicts itself or the format, and was read as far as it makes sense.
    Warning,
}

macro_rules! warning_codes {
    ($($(#[doc = $doc:literal])+ $variant:ident, $code:literal, $severity:ident;)+) => {
        /// What kind of thing a reader noticed. The code's name never changes once released.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum WarningCode {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl WarningCode {
            /// Every code, in the order of their declaration.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The stable name, in kebab case, such as `frame-count-mismatch`.
            pub const fn code(self) -> &'static str {
                match self { $(Self::$variant => $code),+ }
            }

            /// Whether the file needed repair or is merely unusual.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity),+ }
            }

            /// What it means, as the documentation of the variant says.
            pub const fn summary(self) -> &'static str {
                match self { $(Self::$variant => concat!($($doc),+).trim_ascii()),+ }
            }
        }
    };
}

warning_codes! {
    /// The file begins with a UTF-8 byte order mark, which was skipped.
    ByteOrderMark, "byte-order-mark", Note;
    /// The keyword HIERARCHY is missing.
    MissingHierarchy, "missing-hierarchy", Warning;
    /// A comment (from `#`, `//` or `;` to the end of the line) was skipped; a writer does not bring it back.
    CommentSkipped, "comment-skipped", Note;
    /// The file has more than one ROOT.
    SeveralRoots, "several-roots", Note;
    /// A ROOT stands inside a joint, or a JOINT outside the root; it was read by where it stands.
    MisplacedJoint, "misplaced-joint", Warning;
    /// A joint has no name.
    MissingName, "missing-name", Warning;
    /// Two joints have the same name.
    DuplicateName, "duplicate-name", Note;
    /// A joint's name is not UTF-8 text; its bytes are kept.
    NonUtf8Name, "non-utf8-name", Note;
    /// A joint has no OFFSET; zero is used.
    MissingOffset, "missing-offset", Warning;
    /// A joint has more than one OFFSET, or one of more than three numbers.
    ExtraOffset, "extra-offset", Warning;
    /// A joint has no CHANNELS; it does not move.
    MissingChannels, "missing-channels", Note;
    /// CHANNELS announces a different number of channels than it lists; the list is used.
    ChannelCountMismatch, "channel-count-mismatch", Warning;
    /// A joint lists the same channel twice; both columns are kept.
    DuplicateChannel, "duplicate-channel", Warning;
    /// A joint has more than one CHANNELS; the lists are joined.
    RepeatedChannels, "repeated-channels", Warning;
    /// A joint has no children and no End Site.
    MissingEndSite, "missing-end-site", Note;
    /// An End Site coincides with its joint.
    ZeroLengthEndSite, "zero-length-end-site", Note;
    /// An End Site has channels or children; it was read as a joint.
    EndSiteAsJoint, "end-site-as-joint", Warning;
    /// The word after `End` is not `Site`; it was ignored.
    EndSiteWords, "end-site-words", Note;
    /// A root has position channels and an OFFSET that is not zero: programs differ on whether they add up.
    NonzeroRootOffset, "nonzero-root-offset", Note;
    /// A closing brace closes nothing; it was ignored.
    ExtraClosingBrace, "extra-closing-brace", Warning;
    /// There is no MOTION: the file is a skeleton alone.
    MissingMotion, "missing-motion", Note;
    /// There is no usable `Frames:` number; the rows were counted.
    MissingFrameCount, "missing-frame-count", Warning;
    /// There is no `Frame Time:`; 1/30 s is used.
    MissingFrameTime, "missing-frame-time", Warning;
    /// The frame time is zero, negative, or so short or long that no motion has it; it is kept as the file says.
    BadFrameTime, "bad-frame-time", Warning;
    /// A length or an angle is too large for a motion; it is kept as the file says.
    ValueOutOfRange, "value-out-of-range", Warning;
    /// `Frames:` announces a different number of rows than there are; the rows are used.
    FrameCountMismatch, "frame-count-mismatch", Warning;
    /// The last row is not complete; it was dropped.
    PartialLastRow, "partial-last-row", Warning;
    /// Lines hold less or more than one frame; values were counted and line ends ignored.
    WrappedRows, "wrapped-rows", Note;
    /// A line among whole rows has too few or too many values; it was dropped so that later rows stay in step.
    DamagedRow, "damaged-row", Warning;
    /// Numbers follow each other without a blank, as in `0.0-7.5`; they were split at the sign.
    GluedNumbers, "glued-numbers", Warning;
    /// The file writes decimals with a comma.
    DecimalComma, "decimal-comma", Warning;
    /// Commas separate values; they were read as blanks.
    CommaSeparator, "comma-separator", Warning;
    /// Something that is not a number follows the last row; it was ignored.
    TrailingText, "trailing-text", Warning;
    /// A joint's axis is not of unit length; its direction is used.
    AxisNotUnit, "axis-not-unit", Note;
    /// A revolute or prismatic joint has no limit; it moves freely.
    MissingJointLimit, "missing-joint-limit", Warning;
    /// A joint's lower limit is above its upper one; they are swapped.
    ReversedJointLimit, "reversed-joint-limit", Warning;
    /// A joint mimics another in a way that cannot work; it keeps its own value.
    BrokenMimic, "broken-mimic", Warning;
    /// Links of a robot that move have no mass; simulators refuse them.
    MissingInertia, "missing-inertia", Note;
    /// A visual names a material that nothing describes; it has no colour.
    UnknownMaterial, "unknown-material", Warning;
    /// A visual has no shape, or one that the format does not have; it is left out.
    UnknownShape, "unknown-shape", Warning;
    /// A buffer of numbers is missing; its contents were left out.
    MissingBuffer, "missing-buffer", Warning;
    /// A glTF file has another skin with joints that the first one lacks; they were left out.
    OtherSkin, "other-skin", Note;
    /// A glTF node has no name; it is called by its number.
    UnnamedNode, "unnamed-node", Note;
    /// A glTF node is scaled; the scale was applied to the translations below it.
    NodeScale, "node-scale", Note;
    /// A glTF node has a scale that differs between axes, or a matrix that shears or flattens; what is below it is in its place at rest only.
    UnevenScale, "uneven-scale", Warning;
    /// The quaternion of a glTF node is not of unit length; its direction is used.
    RotationNotUnit, "rotation-not-unit", Warning;
    /// An animation changes the scale of a joint; its scale at rest was used.
    AnimatedScale, "animated-scale", Warning;
    /// The first key of an animation comes after the time 0; the motion starts with that key.
    LateFirstKey, "late-first-key", Note;
    /// A channel of an animation could not be read and was left out.
    UnreadableTrack, "unreadable-track", Warning;
}

impl fmt::Display for WarningCode {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.code())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_kebab_case_and_in_order() {
        let mut codes: Vec<_> = WarningCode::ALL.iter().map(|code| code.code()).collect();
        assert!(codes.iter().all(|code| {
            code.bytes()
                .all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-')
        }));
        for (index, code) in WarningCode::ALL.iter().enumerate() {
            assert_eq!(*code as usize, index);
            assert!(code.summary().ends_with('.') && !code.summary().starts_with(' '));
        }
        codes.sort_unstable();
        codes.dedup();
        assert_eq!(codes.len(), WarningCode::ALL.len());
    }
}
