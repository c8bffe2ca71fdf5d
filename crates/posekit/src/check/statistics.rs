//! Statistics that a few wild values do not sway.

use std::collections::BTreeMap;

use crate::skeleton::JointId;

/// Scales a median absolute deviation to the standard deviation of a normal distribution.
const MAD_TO_SIGMA: f64 = 1.4826;

/// The median, or 0 of nothing. Reorders the values.
pub(super) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The median plus three robust standard deviations: where usual values end. Reorders the values.
pub(super) fn usual_limit(values: &mut [f64]) -> f64 {
    let center = median(values);
    for value in values.iter_mut() {
        *value = (*value - center).abs();
    }
    center + 3.0 * MAD_TO_SIGMA * median(values)
}

/// The middle of the narrowest interval that holds the given share of the values: an estimate of
/// their mode that ignores outliers on both sides (the shorth, Andrews et al. 1972, for a half).
/// 0 of nothing. Sorts the values.
pub(super) fn densest(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    values.sort_unstable_by(f64::total_cmp);
    let wanted = super::whole(share * values.len() as f64).clamp(1, values.len());
    let interval = values
        .windows(wanted)
        .min_by(|a, b| (a[wanted - 1] - a[0]).total_cmp(&(b[wanted - 1] - b[0])));
    interval.map_or(0.0, |interval| 0.5 * (interval[0] + interval[wanted - 1]))
}

/// The joint that occurs most often, the first of several; `None` of nothing.
pub(super) fn most_frequent(joints: impl Iterator<Item = JointId>) -> Option<JointId> {
    let mut counts: BTreeMap<JointId, usize> = BTreeMap::new();
    for joint in joints {
        *counts.entry(joint).or_default() += 1;
    }
    let most = counts.values().copied().max()?;
    counts
        .into_iter()
        .find(|&(_, count)| count == most)
        .map(|(joint, _)| joint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_and_even_counts() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 3.0);
        assert_eq!(median(&mut []), 0.0);
    }

    #[test]
    fn one_outlier_does_not_move_the_usual_limit() {
        let mut steady = vec![1.0; 11];
        steady.push(1000.0);
        assert_eq!(usual_limit(&mut steady), 1.0);
    }

    #[test]
    fn densest_finds_the_floor_among_flights_and_dips() {
        let mut heights = vec![
            -5.0, -4.0, 0.01, 0.0, 0.02, 0.01, 0.0, 3.0, 4.0, 5.0, 6.0, 7.0,
        ];
        assert!(densest(&mut heights, 0.3).abs() < 0.03);
    }
}
