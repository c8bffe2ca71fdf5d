//! Numbers for random restarts: the same for the same seed, everywhere.

use glam::{DQuat, DVec4};

/// `SplitMix64` (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
#[derive(Clone, Copy, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Evenly from `low` up to `high`.
    #[allow(clippy::cast_precision_loss, reason = "53 bits are exact in an f64")]
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.next() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0);
        low + (high - low) * share
    }

    /// Any orientation, each as likely as any other: a direction in four dimensions, by rejection.
    pub(crate) fn orientation(&mut self) -> DQuat {
        loop {
            let v = DVec4::from_array(core::array::from_fn(|_| self.between(-1.0, 1.0)));
            let length_sq = v.length_squared();
            if length_sq > 1e-4 && length_sq <= 1.0 {
                return DQuat::from_vec4(v / length_sq.sqrt());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_reference() {
        // The first outputs of the authors' C code for the seed 1234567.
        let mut random = Random::seeded(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| random.next()).collect();
        assert_eq!(
            first,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
        let mean = (0..4000).map(|_| random.between(-1.0, 3.0)).sum::<f64>() / 4000.0;
        assert!((mean - 1.0).abs() < 0.05);
        assert!((random.orientation().length() - 1.0).abs() < 1e-12);
    }
}
