//! Numbers as the shortest text that reads back the same.

/// Turns numbers to text without allocating for each.
#[derive(Default)]
pub(crate) struct NumberText {
    buffer: zmij::Buffer,
}

impl NumberText {
    /// The shortest decimal that reads back as `value`; `nan`, `inf` and `-inf` as NumPy and R write
    /// them.
    pub(crate) fn of<F: zmij::Float + Into<f64>>(&mut self, value: F) -> &str {
        let wide: f64 = value.into();
        if wide.is_finite() {
            return plain(self.buffer.format_finite(value));
        }
        if wide.is_nan() {
            "nan"
        } else if wide > 0.0 {
            "inf"
        } else {
            "-inf"
        }
    }

    /// As [`of`](Self::of), with `null` where JSON has no number.
    pub(crate) fn of_json<F: zmij::Float + Into<f64>>(&mut self, value: F) -> &str {
        let wide: f64 = value.into();
        if wide.is_finite() {
            plain(self.buffer.format_finite(value))
        } else {
            "null"
        }
    }
}

/// `2` for `2.0`: a third of the numbers of an exported motion are whole.
fn plain(text: &str) -> &str {
    text.strip_suffix(".0").unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_the_shortest_and_reads_back() {
        let mut text = NumberText::default();
        for (value, wanted) in [
            (0.1f32, "0.1"),
            (-2.0, "-2"),
            (0.0, "0"),
            (16_777_216.0, "16777216"),
        ] {
            assert_eq!(text.of(value), wanted);
        }
        for value in [f32::MIN_POSITIVE, f32::MAX, 1e-5, 123_456.7, -0.0] {
            assert_eq!(
                text.of(value).parse::<f32>().unwrap().to_bits(),
                value.to_bits()
            );
        }
        assert_eq!(text.of(f64::NAN), "nan");
        assert_eq!(text.of_json(f32::INFINITY), "null");
    }
}
