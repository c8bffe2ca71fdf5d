//! Plain rows, eight bytes at a time in ordinary integers.
//!
//! A run of digits is loaded as a word, its length found by one subtraction and one addition for all
//! eight bytes, and turned to a number by three multiplications (after Lemire, "Quickly parsing eight
//! digits", 2018), with no branch on how many digits there are.

use super::super::scan::Comma;
use super::{Rows, exact};

/// How many bytes a token may be looked at without asking for the end again: a sign, a word of digits,
/// a point, two words of digits, an exponent's letter, its sign and a word of digits.
const READ_AHEAD: usize = 1 + 8 + 1 + 16 + 2 + 8;

/// See [`super::read_plain`].
pub(super) fn read_plain(
    rows: &mut Rows,
    bytes: &[u8],
    mut pos: usize,
    limit: usize,
    comma: Comma,
) -> usize {
    let stop = limit.min(bytes.len().saturating_sub(READ_AHEAD));
    while pos < stop {
        match bytes[pos] {
            b' ' | b'\t' => pos += 1,
            b'\n' => {
                rows.end_line(pos);
                rows.note_range();
                pos += 1;
            }
            b'\r' if bytes[pos + 1] == b'\n' => pos += 1,
            _ => {
                let Some((value, end)) = number(bytes, pos, comma) else {
                    return pos;
                };
                rows.push(value, bytes.len() - end);
                pos = end;
            }
        }
    }
    pos
}

/// The number that begins at `start`, and where it ends; `None` when it is not plain or the file ends
/// within [`READ_AHEAD`].
#[inline]
pub(super) fn number(bytes: &[u8], start: usize, comma: Comma) -> Option<(f64, usize)> {
    let token: &[u8; READ_AHEAD] = bytes.get(start..)?.first_chunk()?;
    let is_negative = token[0] == b'-';
    let mut at = usize::from(is_negative);
    let (whole, mut mantissa) = digits(token, at);
    if whole == 8 {
        return slow_number(bytes, start, comma);
    }
    at += whole;
    let mut fraction = 0;
    let next = token[at];
    if next == b'.' || (next == b',' && comma == Comma::Decimal) {
        let (first, value) = digits(token, at + 1);
        fraction = first;
        mantissa = mantissa * POWERS[first] + value;
        if first == 8 {
            let (second, value) = digits(token, at + 9);
            if whole + 8 + second > 18 {
                return slow_number(bytes, start, comma);
            }
            fraction = 8 + second;
            mantissa = mantissa * POWERS[second] + value;
        }
        at += 1 + fraction;
        // A comma needs digits on both sides: without them it separates.
        if next == b',' && (fraction == 0 || whole == 0) {
            return None;
        }
    }
    if whole + fraction == 0 {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "at most 16 digits")]
    #[expect(clippy::cast_possible_wrap, reason = "at most 16 digits")]
    let mut scale = fraction as i32;
    if token[at] | 0x20 == b'e' {
        let (length, exponent) = exponent(&token[at + 1..])?;
        at += 1 + length;
        scale -= exponent;
    }
    if !is_token_end(token[at]) {
        return None;
    }
    match exact::from_decimal(mantissa, scale, is_negative) {
        Some(value) => Some((value, start + at)),
        None => slow_number(bytes, start, comma),
    }
}

/// Powers of ten that a run of up to eight digits shifts what is before it by.
const POWERS: [u64; 9] = [
    1,
    10,
    100,
    1_000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
];

const fn is_token_end(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r')
}

/// How many of the eight bytes at `at` are digits before the first that is not, and their number.
#[inline(always)]
fn digits(token: &[u8; READ_AHEAD], at: usize) -> (usize, u64) {
    let mut word = [0; 8];
    word.copy_from_slice(&token[at..at + 8]);
    let word = u64::from_le_bytes(word);
    // The high bit of a byte is set where it is below '0' or above '9'; a carry or borrow only spoils
    // bytes after the first such.
    let not_digit = (word.wrapping_add(0x4646_4646_4646_4646)
        | word.wrapping_sub(0x3030_3030_3030_3030))
        & 0x8080_8080_8080_8080;
    let count = not_digit.trailing_zeros() / 8;
    // The digits move to the high end, as if zeros were before them.
    let aligned = if count == 8 {
        word
    } else {
        (word << (56 - 8 * count)) << 8
    };
    let pairs = ((aligned & 0x0f0f_0f0f_0f0f_0f0f).wrapping_mul(10 << 8 | 1)) >> 8;
    let fours = ((pairs & 0x00ff_00ff_00ff_00ff).wrapping_mul(100 << 16 | 1)) >> 16;
    let eight = ((fours & 0x0000_ffff_0000_ffff).wrapping_mul(10_000 << 32 | 1)) >> 32;
    (count as usize, eight)
}

/// The exponent after its letter: how long it is, and its value. `None` when it has no digits or more
/// than three.
#[inline]
pub(super) fn exponent(text: &[u8]) -> Option<(usize, i32)> {
    let sign = *text.first()?;
    let signed = usize::from(matches!(sign, b'+' | b'-'));
    let mut value = 0;
    let mut at = signed;
    while let Some(digit) = text
        .get(at)
        .map(|byte| byte.wrapping_sub(b'0'))
        .filter(|&d| d < 10)
    {
        if at == signed + 3 {
            return None;
        }
        value = value * 10 + i32::from(digit);
        at += 1;
    }
    (at > signed).then_some((at, if sign == b'-' { -value } else { value }))
}

/// A plain number of any length.
#[cold]
fn slow_number(bytes: &[u8], start: usize, comma: Comma) -> Option<(f64, usize)> {
    if comma == Comma::Decimal {
        return None;
    }
    let rest = &bytes[start..];
    let length = rest.iter().position(|&byte| is_token_end(byte))?;
    let token = &rest[..length];
    let is_plain = token.iter().enumerate().all(|(at, byte)| match byte {
        b'0'..=b'9' | b'.' | b'e' | b'E' => true,
        b'-' => at == 0 || matches!(token[at - 1], b'e' | b'E'),
        b'+' => at > 0 && matches!(token[at - 1], b'e' | b'E'),
        _ => false,
    });
    if !is_plain {
        return None;
    }
    exact::from_text(token).map(|value| (value, start + length))
}
