//! Which version of a file is asked for, and which part of it: validators, preconditions and ranges, as
//! RFC 9110 has them in chapters 8.8, 13 and 14.

use std::fs::Metadata;
use std::ops::Range;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use hyper::header::{
    HeaderMap, IF_MATCH, IF_MODIFIED_SINCE, IF_NONE_MATCH, IF_RANGE, IF_UNMODIFIED_SINCE, RANGE,
};

use super::files::Packing;

/// Within this after a change there may be another one that the file's time does not show.
const SETTLED_AFTER: Duration = Duration::from_secs(2);

/// What tells one version of something from another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Validity {
    /// The value of `ETag`.
    pub(super) tag: String,
    /// When it was last changed, to the second.
    pub(super) modified: Option<SystemTime>,
    /// Whether the time is far enough back that no other version has it.
    is_settled: bool,
}

impl Validity {
    /// Of a file as it was opened.
    pub(super) fn of_file(metadata: &Metadata, packing: Packing, now: SystemTime) -> Self {
        let modified = metadata.modified().ok();
        let since_epoch = |time: SystemTime| time.duration_since(UNIX_EPOCH).unwrap_or_default();
        let nanos = modified
            .map(|time| since_epoch(time).as_nanos())
            .unwrap_or_default();
        let packed = if packing == Packing::Brotli {
            "-br"
        } else {
            ""
        };
        let (changed, number) = identity(metadata);
        let is_settled = modified
            .and_then(|time| now.duration_since(time).ok())
            .is_some_and(|age| age >= SETTLED_AFTER);
        let weak = if is_settled { "" } else { "W/" };
        Self {
            tag: format!(
                "{weak}\"{:x}-{nanos:x}-{changed:x}-{number:x}{packed}\"",
                metadata.len()
            ),
            modified: modified
                .map(|time| UNIX_EPOCH + Duration::from_secs(since_epoch(time).as_secs())),
            is_settled,
        }
    }

    /// Of something that is made, by a mark of its bytes.
    pub(super) fn of_mark(mark: &str) -> Self {
        Self {
            tag: format!("W/\"{mark}\""),
            modified: None,
            is_settled: false,
        }
    }

    /// What the request's conditions come to.
    pub(super) fn judge(&self, headers: &HeaderMap) -> Outcome {
        let matching = headers
            .contains_key(IF_MATCH)
            .then(|| self.is_among(headers, &IF_MATCH, strong));
        let unmodified = || Some(self.modified? <= date(headers, &IF_UNMODIFIED_SINCE)?);
        if matching.or_else(unmodified) == Some(false) {
            return Outcome::Failed;
        }
        let none_matching = headers
            .contains_key(IF_NONE_MATCH)
            .then(|| self.is_among(headers, &IF_NONE_MATCH, weak));
        let not_modified = || Some(self.modified? <= date(headers, &IF_MODIFIED_SINCE)?);
        if none_matching.or_else(not_modified) == Some(true) {
            return Outcome::NotModified;
        }
        Outcome::Send
    }

    /// Which part of `length` bytes a request wants; `None` is all of it, and so is a range that is
    /// malformed, in other units, or more than one.
    pub(super) fn part(&self, headers: &HeaderMap, length: u64) -> Option<Part> {
        let mut ranges = headers.get_all(RANGE).iter();
        let (Some(range), None) = (ranges.next(), ranges.next()) else {
            return None;
        };
        if !self.range_applies(headers) {
            return None;
        }
        parse_range(range.to_str().ok()?, length)
    }

    /// Whether the version is the one that `If-Range` names; a part of another would not fit.
    fn range_applies(&self, headers: &HeaderMap) -> bool {
        let Some(value) = headers.get(IF_RANGE) else {
            return true;
        };
        let Some(value) = value.to_str().ok().map(str::trim) else {
            return false;
        };
        if value.starts_with(['"', 'W']) && value.ends_with('"') {
            return strong(value, &self.tag);
        }
        self.is_settled
            && httpdate::parse_http_date(value).ok() == self.modified
            && self.modified.is_some()
    }

    fn is_among(
        &self,
        headers: &HeaderMap,
        name: &hyper::header::HeaderName,
        same: fn(&str, &str) -> bool,
    ) -> bool {
        let lines = headers
            .get_all(name)
            .iter()
            .filter_map(|line| line.to_str().ok());
        // A tag of ours has no comma in it, so that one of another's that has is no match anyway.
        let mut tags = lines.flat_map(|line| line.split(',')).map(str::trim);
        tags.any(|tag| tag == "*" || same(tag, &self.tag))
    }
}

/// What conditions come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It is to be sent.
    Send,
    /// Who asks has it.
    NotModified,
    /// It is not the version that who asks wants something of.
    Failed,
}

/// A part of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// These bytes.
    Bytes(Range<u64>),
    /// Beyond the end.
    Nowhere,
}

/// The same version to the byte.
fn strong(one: &str, other: &str) -> bool {
    one == other && one.starts_with('"')
}

/// The same version, near enough.
fn weak(one: &str, other: &str) -> bool {
    one.trim_start_matches("W/") == other.trim_start_matches("W/")
}

/// A date; one that is none is as if it were not there.
fn date(headers: &HeaderMap, name: &hyper::header::HeaderName) -> Option<SystemTime> {
    httpdate::parse_http_date(headers.get(name)?.to_str().ok()?).ok()
}

/// A `Range` of one range of bytes.
fn parse_range(range: &str, length: u64) -> Option<Part> {
    let (unit, range) = range.split_once('=')?;
    if !unit.trim().eq_ignore_ascii_case("bytes") {
        return None;
    }
    let (first, last) = range.trim().split_once('-')?;
    let number = |text: &str| {
        let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        // More digits than a number has are more bytes than any file has.
        is_number.then(|| text.parse().unwrap_or(u64::MAX))
    };
    let (start, end) = if first.is_empty() {
        (length - number(last)?.min(length), length)
    } else {
        let first = number(first)?;
        let end = if last.is_empty() {
            length
        } else {
            let last = number(last)?;
            if last < first {
                return None;
            }
            last.saturating_add(1).min(length)
        };
        (first, end)
    };
    if start >= end {
        return Some(Part::Nowhere);
    }
    Some(Part::Bytes(start..end))
}

/// When the system last changed anything about a file, and its number: they tell versions apart that were
/// given the same time and size.
#[cfg(unix)]
fn identity(metadata: &Metadata) -> (i128, u64) {
    use std::os::unix::fs::MetadataExt;
    let nanos = i128::from(metadata.ctime()) * 1_000_000_000 + i128::from(metadata.ctime_nsec());
    (nanos, metadata.ino())
}

/// Here the system does not say.
#[cfg(not(unix))]
fn identity(_metadata: &Metadata) -> (i128, u64) {
    (0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyper::header::{HeaderName, HeaderValue};

    fn headers(pairs: &[(HeaderName, &str)]) -> HeaderMap {
        pairs
            .iter()
            .map(|(name, value)| (name.clone(), HeaderValue::from_str(value).unwrap()))
            .collect()
    }

    /// RFC 9110's own date, and a tag.
    fn settled() -> Validity {
        Validity {
            tag: "\"abc\"".into(),
            modified: httpdate::parse_http_date("Sun, 06 Nov 1994 08:49:37 GMT").ok(),
            is_settled: true,
        }
    }

    #[test]
    fn ranges_are_those_of_the_specification() {
        // RFC 9110, 14.1.2: a representation of 10,000 bytes.
        for (range, part) in [
            ("bytes=0-499", Some(Part::Bytes(0..500))),
            ("bytes=500-999", Some(Part::Bytes(500..1000))),
            ("bytes=-500", Some(Part::Bytes(9500..10000))),
            ("bytes=9500-", Some(Part::Bytes(9500..10000))),
            ("bytes=0-0", Some(Part::Bytes(0..1))),
            ("bytes=0-99999", Some(Part::Bytes(0..10000))),
            ("bytes=-99999", Some(Part::Bytes(0..10000))),
            (
                "bytes=0-99999999999999999999999999",
                Some(Part::Bytes(0..10000)),
            ),
            ("bytes=0-18446744073709551615", Some(Part::Bytes(0..10000))),
            ("Bytes=1-2", Some(Part::Bytes(1..3))),
            ("bytes=10000-", Some(Part::Nowhere)),
            ("bytes=-0", Some(Part::Nowhere)),
            ("bytes=99999999999999999999-", Some(Part::Nowhere)),
            ("bytes=0-0,-1", None),
            ("bytes=2-1", None),
            ("bytes=-", None),
            ("bytes=", None),
            ("bytes=+1-2", None),
            ("bytes=1-2-3", None),
            ("lines=1-2", None),
            ("1-2", None),
        ] {
            assert_eq!(parse_range(range, 10_000), part, "{range}");
        }
        assert_eq!(parse_range("bytes=0-", 0), Some(Part::Nowhere));
    }

    #[test]
    fn a_range_of_another_version_is_all_of_this_one() {
        for (condition, applies) in [
            ("\"abc\"", true),
            ("\"xyz\"", false),
            ("W/\"abc\"", false),
            ("Sun, 06 Nov 1994 08:49:37 GMT", true),
            ("Sun, 06 Nov 1994 08:49:38 GMT", false),
            ("nonsense", false),
        ] {
            let asked = headers(&[(RANGE, "bytes=0-0"), (IF_RANGE, condition)]);
            assert_eq!(settled().part(&asked, 10).is_some(), applies, "{condition}");
        }
        let fresh = Validity {
            tag: "W/\"abc\"".into(),
            is_settled: false,
            ..settled()
        };
        for condition in ["W/\"abc\"", "\"abc\"", "Sun, 06 Nov 1994 08:49:37 GMT"] {
            let asked = headers(&[(RANGE, "bytes=0-0"), (IF_RANGE, condition)]);
            assert_eq!(fresh.part(&asked, 10), None, "{condition}");
        }
    }

    #[test]
    fn conditions_are_judged_in_the_order_of_the_specification() {
        const BEFORE: &str = "Sun, 06 Nov 1994 08:49:36 GMT";
        const AT: &str = "Sun, 06 Nov 1994 08:49:37 GMT";
        for (pairs, outcome) in [
            (vec![], Outcome::Send),
            (vec![(IF_NONE_MATCH, "\"abc\"")], Outcome::NotModified),
            (
                vec![(IF_NONE_MATCH, "\"x\", W/\"abc\"")],
                Outcome::NotModified,
            ),
            (vec![(IF_NONE_MATCH, "*")], Outcome::NotModified),
            (
                vec![(IF_NONE_MATCH, "\"x\""), (IF_MODIFIED_SINCE, AT)],
                Outcome::Send,
            ),
            (vec![(IF_MODIFIED_SINCE, AT)], Outcome::NotModified),
            (vec![(IF_MODIFIED_SINCE, BEFORE)], Outcome::Send),
            (vec![(IF_MODIFIED_SINCE, "yesterday")], Outcome::Send),
            (vec![(IF_MATCH, "\"abc\"")], Outcome::Send),
            (vec![(IF_MATCH, "\"x\"")], Outcome::Failed),
            (vec![(IF_MATCH, "W/\"abc\"")], Outcome::Failed),
            (
                vec![(IF_MATCH, "*"), (IF_UNMODIFIED_SINCE, BEFORE)],
                Outcome::Send,
            ),
            (vec![(IF_UNMODIFIED_SINCE, BEFORE)], Outcome::Failed),
            (vec![(IF_UNMODIFIED_SINCE, AT)], Outcome::Send),
        ] {
            assert_eq!(settled().judge(&headers(&pairs)), outcome, "{pairs:?}");
        }
    }

    #[test]
    fn a_file_just_written_has_no_strong_tag() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let metadata = file.as_file().metadata().unwrap();
        let modified = metadata.modified().unwrap();
        let of = |packing, age| Validity::of_file(&metadata, packing, modified + age);
        let fresh = of(Packing::None, Duration::from_secs(1));
        let old = of(Packing::None, Duration::from_secs(3));
        assert!(fresh.tag.starts_with("W/\"") && old.tag.starts_with('"'));
        assert!(weak(&fresh.tag, &old.tag) && !strong(&fresh.tag, &old.tag));
        assert_ne!(of(Packing::Brotli, Duration::from_secs(3)).tag, old.tag);
    }
}
