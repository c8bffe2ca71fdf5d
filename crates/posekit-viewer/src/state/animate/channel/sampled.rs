//! Channels as lines to be drawn.

use std::ops::Range;

use super::Channels;
use crate::state::clip::{index_to_f64, nearest_index};

/// A line has at most this many places beside the keys: more than a screen has dots across.
const MOST_PLACES: usize = 8192;

/// The values of channels at places in time, in rising order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sampled {
    /// When, in seconds.
    pub times_secs: Vec<f64>,
    /// All channels' values then.
    pub values: Vec<[f64; 3]>,
    /// Which of the places are from the first to the last key; those outside are extrapolated.
    pub within: Range<usize>,
}

impl Sampled {
    pub(super) fn of(channels: &Channels, [start, end]: [f64; 2], step_secs: f64) -> Self {
        let times_secs = places(channels.times_secs(), [start, end], step_secs);
        let keys = channels.times_secs();
        let (first, last) = (keys[0], keys[keys.len() - 1]);
        let from = times_secs.partition_point(|&time| time < first);
        let to = times_secs.partition_point(|&time| time <= last);
        Self {
            values: times_secs.iter().map(|&time| channels.at(time)).collect(),
            within: from..to,
            times_secs,
        }
    }

    /// The lowest and the highest value of a channel; `None` when there is no place.
    #[must_use]
    pub fn extent(&self, channel: usize) -> Option<[f64; 2]> {
        self.values.iter().fold(None, |extent, values| {
            let value = values[channel];
            let [low, high] = extent.unwrap_or([value; 2]);
            Some([low.min(value), high.max(value)])
        })
    }
}

/// Places in time: evenly over the span, at each key, and just before it, where a step still has its value.
fn places(keys: &[f64], [start, end]: [f64; 2], step_secs: f64) -> Vec<f64> {
    let is_span = start.is_finite() && end.is_finite() && end > start;
    if !is_span {
        return vec![start];
    }
    let count = ((end - start) / step_secs).ceil().max(1.0);
    let count = nearest_index(count, MOST_PLACES);
    let step = (end - start) / index_to_f64(count);
    let even = (0..=count).map(|place| start + step * index_to_f64(place));
    let seen = keys.iter().filter(|&&key| key >= start && key <= end);
    let mut places: Vec<f64> = even.chain(seen.flat_map(|&k| [k.next_down(), k])).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}
