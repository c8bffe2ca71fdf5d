//! Quantiles and shares of samples.

/// A sample's quantiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quantiles {
    /// A tenth of the sample is no larger.
    pub(super) low: f64,
    /// The median.
    pub(super) median: f64,
    /// A tenth of the sample is no smaller.
    pub(super) high: f64,
    /// The largest of all.
    pub(super) most: f64,
}

impl Quantiles {
    /// The quantiles of a sample; `None` of an empty one.
    pub(super) fn of(sample: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = sample.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            low: quantile(&sorted, 0.1)?,
            median: quantile(&sorted, 0.5)?,
            high: quantile(&sorted, 0.9)?,
            most: *sorted.last()?,
        })
    }
}

/// The median of a sample; `None` of an empty one.
pub(super) fn median(sample: impl IntoIterator<Item = f64>) -> Option<f64> {
    Quantiles::of(sample).map(|quantiles| quantiles.median)
}

/// A quantile of a sorted sample, straight between the values on both sides: definition 7 of Hyndman and Fan
/// (1996, "Sample Quantiles in Statistical Packages"), which is NumPy's.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share * last as f64;
    let below = (0..=last).rev().find(|&index| index as f64 <= place)?;
    let low = sorted[below];
    let high = sorted[(below + 1).min(last)];
    let rest = place - below as f64;
    // Equal ends give themselves, infinite ones too.
    Some(if low == high {
        low
    } else {
        low + (high - low) * rest
    })
}

/// The share of a sample for which something holds; `None` of an empty one.
pub(super) fn share(sample: impl IntoIterator<Item = bool>) -> Option<f64> {
    let (held, count) = sample
        .into_iter()
        .fold((0u32, 0u32), |(held, count), holds| {
            (held + u32::from(holds), count + 1)
        });
    (count > 0).then(|| f64::from(held) / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy 2: np.quantile([3, 1, 4, 1, 5, 9, 2, 6], [.1, .5, .9]); of [2, 7] and of [5] likewise.
        let found = Quantiles::of([3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0]).unwrap();
        for (ours, numpys) in [
            (found.low, 1.0),
            (found.median, 3.5),
            (found.high, 6.9),
            (found.most, 9.0),
        ] {
            assert!((ours - numpys).abs() < 1e-12, "{found:?}");
        }
        let two = Quantiles::of([7.0, 2.0]).unwrap();
        assert!((two.low - 2.5).abs() < 1e-12 && (two.high - 6.5).abs() < 1e-12);
        assert_eq!(median([5.0]), Some(5.0));
        assert_eq!(median([]), None);
    }

    #[test]
    fn shares_count() {
        assert_eq!(share([true, false, true, true]), Some(0.75));
        assert_eq!(share([]), None);
    }
}
