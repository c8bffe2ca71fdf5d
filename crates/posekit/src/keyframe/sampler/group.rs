//! Tracks that share a clock, and which of their pieces a time falls into.

use glam::{DVec4, Vec4};

use super::piece::Piece;
use crate::keyframe::extrapolation::{Extrapolation, Place};
use crate::skeleton::JointId;

/// The most buckets that a group has: beyond that, keys are so unevenly spread that steps are cheaper.
const MOST_BUCKETS: u32 = 1 << 16;

/// How many entries of the table there may be for each piece.
const ENTRIES_PER_PIECE: usize = 16;

/// More pieces in a bucket than are tried one by one: they are searched by halving.
const MANY: usize = usize::MAX;

/// When tracks start, end, and how they go on: what they must share to be looked up together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    pub(super) range_secs: [f64; 2],
    pub(super) ways: [Extrapolation; 2],
}

/// Tracks of one clock.
///
/// The clock's range is divided in buckets of equal length, with a row for each that holds the piece of
/// every track in which it starts. So a time is found with one look into the table and, where a piece
/// ends inside the bucket, a step; a search over the keys would miss its branches and the cache.
#[derive(Clone, Debug)]
pub(super) struct Group {
    clock: Clock,
    /// The joint of each track.
    joints: Vec<JointId>,
    /// All pieces, track after track, each track's followed by one that never starts.
    pieces: Vec<Piece>,
    /// When each starts, seconds.
    starts: Vec<f64>,
    /// The index of each track's first and last piece.
    spans: Vec<[u32; 2]>,
    /// Bucket after bucket, for each track the index of the piece in which the bucket starts.
    first_pieces: Vec<u32>,
    buckets_per_sec: f64,
    last_bucket: f64,
    /// The most pieces that end inside one bucket.
    steps: u32,
}

impl Group {
    pub(super) fn new(clock: Clock, tracks: Vec<(JointId, Vec<Piece>)>) -> Self {
        let mut group = Self {
            clock,
            joints: Vec::with_capacity(tracks.len()),
            pieces: Vec::new(),
            starts: Vec::new(),
            spans: Vec::with_capacity(tracks.len()),
            first_pieces: Vec::new(),
            buckets_per_sec: 0.0,
            last_bucket: 0.0,
            steps: 0,
        };
        for (joint, pieces) in tracks {
            group.joints.push(joint);
            let first = to_u32(group.pieces.len());
            group
                .starts
                .extend(pieces.iter().map(|piece| piece.start_secs));
            group.pieces.extend(pieces);
            group.spans.push([first, to_u32(group.pieces.len()) - 1]);
            // No time is past the start of what follows a track's last piece.
            group.starts.push(f64::INFINITY);
            group
                .pieces
                .push(Piece::constant(f64::INFINITY, DVec4::ZERO));
        }
        group.make_table();
        group
    }

    /// Doubles the buckets until a piece at most ends in each, or the table is large enough.
    fn make_table(&mut self) {
        let [start, end] = self.clock.range_secs;
        let affordable = self.pieces.len() * ENTRIES_PER_PIECE / self.joints.len().max(1);
        let mut buckets = 1;
        self.fill(buckets);
        while self.steps > 1
            && end > start
            && 2 * buckets <= MOST_BUCKETS
            && 2 * buckets as usize <= affordable
        {
            buckets *= 2;
            self.fill(buckets);
        }
    }

    fn fill(&mut self, buckets: u32) {
        let [start, end] = self.clock.range_secs;
        let span = end - start;
        self.buckets_per_sec = if span > 0.0 {
            f64::from(buckets) / span
        } else {
            0.0
        };
        self.last_bucket = f64::from(buckets - 1);
        let count = self.spans.len();
        self.first_pieces.clear();
        self.first_pieces.resize(buckets as usize * count, 0);
        self.steps = 0;
        for (track, &[first, last]) in self.spans.iter().enumerate() {
            let mut piece = first;
            for bucket in 0..buckets as usize {
                self.first_pieces[bucket * count + track] = piece;
                let before = piece;
                // A start is put where a time equal to it is looked up, so that both round alike.
                while piece < last && self.bucket(self.starts[piece as usize + 1]) <= bucket {
                    piece += 1;
                }
                self.steps = self.steps.max(piece - before);
            }
        }
    }

    #[inline(always)]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the buckets"
    )]
    fn bucket(&self, time_secs: f64) -> usize {
        let place = (time_secs - self.clock.range_secs[0]) * self.buckets_per_sec;
        place.clamp(0.0, self.last_bucket) as usize
    }

    /// Gives each track's joint and components at a time; returns the clock's place of that time.
    #[inline(always)]
    pub(super) fn each(&self, time_secs: f64, give: impl FnMut([JointId; 4], [Vec4; 4])) -> Place {
        let place = Place::of(time_secs, self.clock.range_secs, self.clock.ways);
        // The number of steps is known to the compiler where it is small: no branch is left.
        match self.steps {
            0 => self.each_at::<0>(place.time_secs, give),
            1 => self.each_at::<1>(place.time_secs, give),
            2 => self.each_at::<2>(place.time_secs, give),
            _ => self.each_at::<MANY>(place.time_secs, give),
        }
        place
    }

    /// Four tracks at a time, so that they are normalised together; the last one fills up the rest.
    #[inline(always)]
    fn each_at<const STEPS: usize>(
        &self,
        time_secs: f64,
        mut give: impl FnMut([JointId; 4], [Vec4; 4]),
    ) {
        let count = self.joints.len();
        let row = &self.first_pieces[self.bucket(time_secs) * count..][..count];
        let (joints, more_joints) = self.joints.as_chunks::<4>();
        let (firsts, more_firsts) = row.as_chunks::<4>();
        for (four, (joints, firsts)) in joints.iter().zip(firsts).enumerate() {
            let [a, b, c, d] = *firsts;
            let at = |lane: usize, first: u32| {
                self.piece_at::<STEPS>(4 * four + lane, first, time_secs)
                    .at(time_secs)
            };
            give(*joints, [at(0, a), at(1, b), at(2, c), at(3, d)]);
        }
        let done = count - more_joints.len();
        for (lane, (&joint, &first)) in more_joints.iter().zip(more_firsts).enumerate() {
            let piece = self.piece_at::<STEPS>(done + lane, first, time_secs);
            give([joint; 4], [piece.at(time_secs); 4]);
        }
    }

    /// The last piece of a track that starts at or before a time, from the bucket's first one on.
    #[inline(always)]
    fn piece_at<const STEPS: usize>(&self, track: usize, first: u32, time_secs: f64) -> &Piece {
        let mut at = first as usize;
        if STEPS == MANY {
            let last = self.spans[track][1] as usize;
            let later = &self.starts[at + 1..=last];
            at += later.partition_point(|&start| start <= time_secs);
        } else {
            for _ in 0..STEPS {
                at += usize::from(self.starts[at + 1] <= time_secs);
            }
        }
        &self.pieces[at]
    }
}

fn to_u32(index: usize) -> u32 {
    u32::try_from(index).expect("the pieces of an animation fit in 32 bits")
}
