//! Shortest decimals, without exponents where that is reasonable.

/// Numbers whose first digit stands beyond this power of ten, either way, get an exponent.
const PLAIN_WITHIN: i32 = 20;

/// Turns numbers into text: the fewest digits that read back as the same `f64`.
///
/// The digits are those of the `zmij` crate (after Schubfach: Giulietti, 2020); this only lays them out in
/// plain notation, since many BVH readers do not take exponents.
pub(super) struct Decimals {
    buffer: zmij::Buffer,
}

impl Decimals {
    pub(super) fn new() -> Self {
        Self {
            buffer: zmij::Buffer::new(),
        }
    }

    /// Appends a finite number.
    pub(super) fn append(&mut self, text: &mut Vec<u8>, value: f64) {
        let shortest = self.buffer.format_finite(value);
        match shortest.split_once('e') {
            None => {
                text.extend_from_slice(shortest.strip_suffix(".0").unwrap_or(shortest).as_bytes())
            }
            Some((mantissa, exponent)) => match exponent.parse::<i32>() {
                Ok(exponent) if exponent.abs() <= PLAIN_WITHIN => {
                    append_plain(text, mantissa, exponent);
                }
                _ => text.extend_from_slice(shortest.as_bytes()),
            },
        }
    }
}

/// Appends `mantissa`, which has one digit before its point if it has a point, times ten to `exponent`.
fn append_plain(text: &mut Vec<u8>, mantissa: &str, exponent: i32) {
    let unsigned = mantissa.strip_prefix('-').unwrap_or(mantissa);
    if unsigned.len() < mantissa.len() {
        text.push(b'-');
    }
    let (first, rest) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    let rest = if rest == "0" { "" } else { rest };
    let shift = exponent.unsigned_abs() as usize;
    if exponent < 0 {
        text.extend_from_slice(b"0.");
        text.resize(text.len() + shift - 1, b'0');
        text.extend_from_slice(first.as_bytes());
        text.extend_from_slice(rest.as_bytes());
    } else {
        text.extend_from_slice(first.as_bytes());
        let (whole, fraction) = rest.split_at(shift.min(rest.len()));
        text.extend_from_slice(whole.as_bytes());
        text.resize(text.len() + shift - whole.len(), b'0');
        if !fraction.is_empty() {
            text.push(b'.');
            text.extend_from_slice(fraction.as_bytes());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(value: f64) -> String {
        let mut text = Vec::new();
        Decimals::new().append(&mut text, value);
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn numbers_are_short_and_plain() {
        let cases = [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.0, "1"),
            (-12.5, "-12.5"),
            (0.1 + 0.2, "0.30000000000000004"),
            (4.3199e-7, "0.00000043199"),
            (-1e-20, "-0.00000000000000000001"),
            (1e-21, "1e-21"),
            (1e16, "10000000000000000"),
            (1e20, "100000000000000000000"),
            (1.25e17, "125000000000000000"),
            (1.2345678901234567e19, "12345678901234567000"),
            (f64::MAX, "1.7976931348623157e+308"),
            (5e-324, "5e-324"),
        ];
        for (value, text) in cases {
            assert_eq!(written(value), text);
        }
    }

    #[test]
    fn every_power_of_ten_reads_back() {
        for exponent in -330..=308 {
            for digits in ["1", "-7", "1.234567890123456", "9.999999999999999"] {
                let value: f64 = format!("{digits}e{exponent}").parse().unwrap();
                assert_eq!(
                    written(value).parse::<f64>().unwrap().to_bits(),
                    value.to_bits()
                );
            }
        }
    }
}
