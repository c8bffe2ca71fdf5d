//! One number, read with care: the grammar, the wild forms of it, and exact conversion.

use super::scan::{Comma, Scanner, is_blank};
use crate::report::{ReadError, ReadErrorKind, WarningCode, quote};

/// Where a number's parts end, relative to its first byte.
struct Extent {
    /// Where a comma stands for the decimal point.
    comma: Option<usize>,
    length: usize,
}

/// Reads the number at the current position, which must not be a blank.
///
/// The grammar: a sign, digits with a point among, before or after them, an exponent. A number ends at a
/// blank, a brace, a comma or a semicolon, at the end of the file, or where a sign begins the next one.
pub(super) fn read(scanner: &mut Scanner<'_>, expected: &str) -> Result<f64, ReadError> {
    let start = scanner.pos;
    let Some(extent) = extent(scanner) else {
        return Err(not_a_number(scanner, expected));
    };
    let end = start + extent.length;
    let text = &scanner.bytes[start..end];
    let parsed = match extent.comma {
        None => fast_float2::parse::<f64, _>(text),
        Some(comma) => {
            let mut with_point = text.to_vec();
            with_point[comma] = b'.';
            fast_float2::parse::<f64, _>(&with_point)
        }
    };
    match parsed {
        Ok(value) if value.is_finite() => {
            scanner.pos = end;
            note_glue(scanner);
            Ok(value)
        }
        Ok(_) => {
            let found = format!("{}, too large for a number", quote(text));
            Err(scanner.error(ReadErrorKind::NotFinite, start, expected, found))
        }
        Err(_) => Err(not_a_number(scanner, expected)),
    }
}

/// Skips what stands where a number belongs, to the next blank, comma or brace.
pub(super) fn skip(scanner: &mut Scanner<'_>) {
    let rest = &scanner.bytes[scanner.pos..];
    let ends = |&byte: &u8| is_blank(byte) || matches!(byte, b',' | b';' | b'{' | b'}');
    scanner.pos += rest.iter().position(ends).unwrap_or(rest.len());
}

/// Measures the number at the current position; `None` when there is none or it runs into other text.
fn extent(scanner: &mut Scanner<'_>) -> Option<Extent> {
    let text = &scanner.bytes[scanner.pos..];
    let byte = |at: usize| text.get(at).copied().unwrap_or(b' ');
    let digits_from = |at: usize| text[at..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut at = usize::from(matches!(byte(0), b'+' | b'-'));
    let whole = digits_from(at);
    at += whole;
    let mut fraction = 0;
    let mut comma = None;
    if byte(at) == b'.' {
        fraction = digits_from(at + 1);
        at += 1 + fraction;
    } else if byte(at) == b',' && byte(at + 1).is_ascii_digit() {
        let after = at + 1 + digits_from(at + 1);
        if comma_is_decimal(scanner, at, byte(after)) {
            comma = Some(at);
            fraction = after - at - 1;
            at = after;
        }
    }
    if whole + fraction == 0 {
        return None;
    }
    if matches!(byte(at), b'e' | b'E') {
        let sign = usize::from(matches!(byte(at + 1), b'+' | b'-'));
        let exponent = digits_from((at + 1 + sign).min(text.len()));
        if exponent == 0 {
            return None;
        }
        at += 1 + sign + exponent;
    }
    let next = byte(at);
    let ends = is_blank(next) || matches!(next, b'+' | b'-' | b',' | b'{' | b'}' | b';');
    ends.then_some(Extent { comma, length: at })
}

/// Whether a comma between digits is a decimal comma, which the file's first such comma decides: it is
/// when neither a point nor another comma follows the digits after it.
fn comma_is_decimal(scanner: &mut Scanner<'_>, comma: usize, after_digits: u8) -> bool {
    if scanner.comma == Comma::Unknown {
        if matches!(after_digits, b'.' | b',') {
            scanner.comma = Comma::Separator;
        } else {
            scanner.comma = Comma::Decimal;
            let at = scanner.pos + comma;
            scanner.warn(WarningCode::DecimalComma, at, || {
                "a decimal comma, read as a point here and in the whole file".into()
            });
        }
    }
    scanner.comma == Comma::Decimal
}

fn note_glue(scanner: &mut Scanner<'_>) {
    let at = scanner.pos;
    if matches!(scanner.peek(), Some(b'+' | b'-')) {
        scanner.warn(WarningCode::GluedNumbers, at, || {
            "two numbers without a blank between them, split at the sign".into()
        });
    }
}

fn not_a_number(scanner: &mut Scanner<'_>, expected: &str) -> ReadError {
    let rest = &scanner.bytes[scanner.pos..];
    let word = rest.trim_ascii_start();
    let unsigned = word
        .strip_prefix(b"-")
        .or(word.strip_prefix(b"+"))
        .unwrap_or(word);
    let is_special = [&b"nan"[..], b"inf", b"1.#"].iter().any(|special| {
        unsigned
            .get(..special.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(special))
    });
    let mut error = scanner.unexpected(expected);
    if is_special {
        error.kind = ReadErrorKind::NotFinite;
    }
    error
}
