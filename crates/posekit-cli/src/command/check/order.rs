//! Which finding is worse than which.

use std::cmp::Reverse;

use posekit::check::{FindingCode, Unit};
use posekit_formats::bvh::CheckEntry;

/// Codes of equal severity, the worst first: what spoils the whole motion for whoever looks at it, then what
/// spoils a part of it, then what only programs notice. What is not listed here is about the file itself or
/// its numbers and comes before all of them.
const WORST_FIRST: [FindingCode; 19] = [
    FindingCode::FrameTimeImplausible,
    FindingCode::PlaybackSpeedImplausible,
    FindingCode::ReferenceFirstFrame,
    FindingCode::Teleport,
    FindingCode::PositionSpike,
    FindingCode::RotationJump,
    FindingCode::RotationSpike,
    FindingCode::BoneLengthChanges,
    FindingCode::OffsetUnlikeMotion,
    FindingCode::FootSliding,
    FindingCode::FootBelowFloor,
    FindingCode::FrozenFrames,
    FindingCode::DuplicateFrames,
    FindingCode::RestPoseUnlikeMotion,
    FindingCode::FloorNotAtZero,
    FindingCode::StaticMotion,
    FindingCode::EulerFlip,
    FindingCode::GimbalLock,
    FindingCode::ConstantChannels,
];

/// The place of a code among those of its severity; smaller is worse.
pub(super) fn rank(code: &str) -> usize {
    let at = WORST_FIRST.iter().position(|known| known.code() == code);
    at.map_or(0, |index| index + 1)
}

/// How much worse a finding is than another of its code; only the order means something.
pub(super) fn badness(entry: &CheckEntry) -> f64 {
    match (entry.unit, entry.share_of_height) {
        // Twice too slow is as bad as twice too fast.
        (Unit::TimesTooFast, _) => entry.value.ln().abs(),
        (_, Some(share)) => share.abs(),
        _ => entry.value.abs(),
    }
}

/// The findings of a file: the most serious first, those of one code together and the largest of them first,
/// otherwise as they were.
pub(super) fn worst_first<'a>(entries: &[&'a CheckEntry]) -> Vec<&'a CheckEntry> {
    let first_of_code = |code: &str| entries.iter().position(|entry| entry.code == code);
    let mut keyed: Vec<_> = entries
        .iter()
        .map(|&entry| {
            let code = (rank(entry.code), first_of_code(entry.code));
            ((Reverse(entry.severity), code), entry)
        })
        .collect();
    keyed.sort_by(|(a_key, a), (b_key, b)| {
        a_key
            .cmp(b_key)
            .then_with(|| badness(b).total_cmp(&badness(a)))
    });
    keyed.into_iter().map(|(_, entry)| entry).collect()
}
