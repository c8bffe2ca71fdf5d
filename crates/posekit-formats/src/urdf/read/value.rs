//! Attributes as names and numbers, with errors that show the place of the value.

use std::borrow::Cow;

use posekit::range::LONGEST_LENGTH;

use super::xml::Element;
use crate::report::{ReadError, ReadErrorKind, Reporter, WarningCode, quote};
use crate::urdf::UrdfOrigin;

/// An attribute that must be there and not be blank.
pub(super) fn required<'a>(
    element: Element<'_, 'a>,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<(Cow<'a, str>, usize), ReadError> {
    match element.attribute(name, reporter)? {
        Some((value, at)) if value.trim().is_empty() => {
            Err(reporter.unexpected(at, format!("a value of `{name}`"), "nothing"))
        }
        Some(found) => Ok(found),
        None => {
            let found = format!("{} without it", quote(element.name().as_bytes()));
            Err(reporter.unexpected(element.at(), format!("an attribute `{name}`"), found))
        }
    }
}

/// An element directly inside another one that must be there.
pub(super) fn required_child<'d, 'a>(
    element: Element<'d, 'a>,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<Element<'d, 'a>, ReadError> {
    element.child(name).ok_or_else(|| {
        let found = format!("{} without it", quote(element.name().as_bytes()));
        reporter.unexpected(element.at(), format!("an element `<{name}>`"), found)
    })
}

/// Exactly so many finite numbers between blanks, or `None` where the attribute is missing.
pub(super) fn numbers<const COUNT: usize>(
    element: Element<'_, '_>,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<Option<[f64; COUNT]>, ReadError> {
    let Some((text, at)) = element.attribute(name, reporter)? else {
        return Ok(None);
    };
    let mut numbers = [0.0; COUNT];
    let mut words = text.split_ascii_whitespace();
    for number in &mut numbers {
        let Some(word) = words.next() else {
            let found = quote(text.as_bytes());
            return Err(reporter.unexpected(at, counted(COUNT, name), found));
        };
        *number = finite(word, at, name, reporter)?;
    }
    if words.next().is_some() {
        let found = quote(text.as_bytes());
        return Err(reporter.unexpected(at, counted(COUNT, name), found));
    }
    Ok(Some(numbers))
}

/// One finite number, or `None` where the attribute is missing.
pub(super) fn number(
    element: Element<'_, '_>,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<Option<f64>, ReadError> {
    Ok(numbers::<1>(element, name, reporter)?.map(|[number]| number))
}

/// One number that is not negative and must be there: a length.
pub(super) fn length(
    element: Element<'_, '_>,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<f64, ReadError> {
    let (text, at) = required(element, name, reporter)?;
    let length = number(element, name, reporter)?.unwrap_or(0.0);
    if length < 0.0 {
        let found = quote(text.as_bytes());
        return Err(reporter.unexpected(at, format!("a `{name}` that is not negative"), found));
    }
    Ok(length)
}

/// The `<origin>` inside an element; the frame itself where there is none.
pub(super) fn origin(
    element: Element<'_, '_>,
    reporter: &mut Reporter<'_>,
) -> Result<UrdfOrigin, ReadError> {
    let Some(origin) = element.child("origin") else {
        return Ok(UrdfOrigin::default());
    };
    let xyz = numbers(origin, "xyz", reporter)?.unwrap_or_default();
    if let Some(value) = xyz.iter().find(|value| value.abs() > LONGEST_LENGTH) {
        reporter.warn(WarningCode::ValueOutOfRange, origin.at(), || {
            format!("an origin {value:?} away, which is not within {LONGEST_LENGTH:e}, kept as the file says: too large for a robot")
        });
    }
    Ok(UrdfOrigin {
        xyz,
        rpy: numbers(origin, "rpy", reporter)?.unwrap_or_default(),
    })
}

fn finite(
    word: &str,
    at: usize,
    name: &str,
    reporter: &mut Reporter<'_>,
) -> Result<f64, ReadError> {
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => {
            let expected = format!("a finite number in `{name}`");
            Err(reporter.error(
                ReadErrorKind::NotFinite,
                at,
                expected,
                quote(word.as_bytes()),
            ))
        }
        Err(_) if word.contains("${") => {
            let found = format!("{}, a xacro macro: run xacro first", quote(word.as_bytes()));
            Err(reporter.unexpected(at, format!("a number in `{name}`"), found))
        }
        Err(_) => {
            let expected = format!("a number in `{name}`");
            Err(reporter.unexpected(at, expected, quote(word.as_bytes())))
        }
    }
}

fn counted(count: usize, name: &str) -> String {
    let noun = if count == 1 { "number" } else { "numbers" };
    format!("{count} {noun} in `{name}`")
}
