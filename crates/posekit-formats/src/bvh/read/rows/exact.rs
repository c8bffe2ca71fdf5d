//! From digits to the nearest double.
//!
//! A mantissa up to 2^53 and a power of ten up to 10^22 are doubles without error, so one division or
//! multiplication of them is rounded once, and right (Clinger, "How to read floating point numbers
//! accurately", PLDI 1990). Motion files hold hardly anything else. The rest goes to `fast-float2`.

/// The powers of ten that are exact doubles.
pub(super) const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Up to here every integer is a double.
const EXACT_INTEGERS: u64 = 1 << 53;

/// `mantissa` times ten to the power of `-scale`, with the sign; `None` when this is not the case that
/// one operation solves.
#[inline(always)]
pub(super) fn from_decimal(mantissa: u64, scale: i32, is_negative: bool) -> Option<f64> {
    let integer = signed(mantissa, is_negative)?;
    let power = POWERS_OF_TEN.get(scale.unsigned_abs() as usize)?;
    Some(if scale >= 0 {
        integer / power
    } else {
        integer * power
    })
}

/// An integer as the same double with a sign, zero's included.
#[inline(always)]
fn signed(mantissa: u64, is_negative: bool) -> Option<f64> {
    if mantissa > EXACT_INTEGERS {
        return None;
    }
    #[expect(
        clippy::cast_possible_wrap,
        reason = "at most 2^53; a signed integer converts faster"
    )]
    let integer = mantissa as i64 as f64;
    Some(f64::from_bits(
        integer.to_bits() | u64::from(is_negative) << 63,
    ))
}

/// Any number in the plain grammar, with a point; `None` when it is none or not finite.
#[cold]
pub(super) fn from_text(text: &[u8]) -> Option<f64> {
    fast_float2::parse::<f64, _>(text)
        .ok()
        .filter(|value| value.is_finite())
}
