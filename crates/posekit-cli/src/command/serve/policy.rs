//! What a browser may do with an answer: the headers that every answer has.

use std::str::FromStr;

use hyper::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HeaderMap, HeaderName, HeaderValue, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};

const CROSS_ORIGIN_RESOURCE_POLICY: HeaderName =
    HeaderName::from_static("cross-origin-resource-policy");

/// What the viewer's page does: it runs its own scripts and its own module, styles itself, shows pictures
/// that it made, and asks this server alone.
const OF_THE_PAGE: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; \
     style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; \
     connect-src 'self'; base-uri 'none'; form-action 'none'";

/// What everything else does: nothing; the list for people has a style.
const OF_OTHERS: &str =
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// An origin whose pages may show the viewer in a frame: `https://lectures.example` or
/// `http://localhost:3000`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Origin(String);

impl FromStr for Origin {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const WRONG: &str =
            "not an origin: write it like https://lectures.example or http://localhost:3000";
        let (scheme, place) = text.split_once("://").ok_or(WRONG)?;
        let place = place.strip_suffix('/').unwrap_or(place);
        let is_place = !place.is_empty()
            && place
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || b".-_:[]".contains(&byte));
        if !matches!(scheme, "http" | "https") || !is_place {
            return Err(WRONG);
        }
        Ok(Self(format!("{scheme}://{place}")))
    }
}

/// The headers that every answer has.
#[derive(Debug)]
pub(super) struct Policy {
    of_the_page: HeaderValue,
    of_others: HeaderValue,
    is_embedded: bool,
}

/// What an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A file of the viewer's page.
    Page,
    /// A clip, a list, a refusal.
    Other,
}

impl Policy {
    /// A policy under which pages of these origins may show the viewer in a frame, and those of its own.
    pub(super) fn new(embedding: &[Origin]) -> Self {
        let mut ancestors = "frame-ancestors 'self'".to_owned();
        for Origin(origin) in embedding {
            ancestors += &format!(" {origin}");
        }
        let value = |policy: &str| {
            // An origin consists of characters that a header may have.
            HeaderValue::from_str(&format!("{policy}; {ancestors}")).unwrap_or_else(|_| {
                HeaderValue::from_static("default-src 'none'; frame-ancestors 'none'")
            })
        };
        Self {
            of_the_page: value(OF_THE_PAGE),
            of_others: value(OF_OTHERS),
            is_embedded: !embedding.is_empty(),
        }
    }

    /// Puts them in.
    pub(super) fn apply(&self, kind: Kind, headers: &mut HeaderMap) {
        let policy = match kind {
            Kind::Page => &self.of_the_page,
            Kind::Other => &self.of_others,
        };
        headers.insert(CONTENT_SECURITY_POLICY, policy.clone());
        // A page that isolates itself shows in its frames only what says that others may have it.
        let who = if kind == Kind::Page && self.is_embedded {
            "cross-origin"
        } else {
            "same-origin"
        };
        headers.insert(CROSS_ORIGIN_RESOURCE_POLICY, HeaderValue::from_static(who));
        headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
        // The address has the token in it: it is told to nobody.
        headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
        // What may be kept says so itself.
        headers
            .entry(CACHE_CONTROL)
            .or_insert(HeaderValue::from_static("no-store"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_is_scheme_host_and_port() {
        for (text, origin) in [
            ("https://lectures.example", "https://lectures.example"),
            ("http://localhost:3000/", "http://localhost:3000"),
            ("http://[::1]:80", "http://[::1]:80"),
        ] {
            assert_eq!(text.parse(), Ok(Origin(origin.into())));
        }
        for text in [
            "",
            "*",
            "lectures.example",
            "https://",
            "ftp://a",
            "https://a/b",
            "https://a; script-src *",
            "https://a b",
            "https://*",
            "https://a,b",
            "https://a\nb",
            "'self'",
        ] {
            assert!(text.parse::<Origin>().is_err(), "{text}");
        }
    }
}
