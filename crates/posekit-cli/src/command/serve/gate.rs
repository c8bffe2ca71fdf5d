//! Who is let in.
//!
//! A server for this machine only looks at the name it was called by: a page of somebody else's that
//! made its own name point here (DNS rebinding) is turned away. A server for others asks for a token,
//! in the address the first time and in a cookie from then on, so that the page's own requests have it.

use std::net::IpAddr;

use hyper::header::{COOKIE, HOST};
use hyper::http::request::Parts;
use subtle::ConstantTimeEq;

use crate::failure::Failure;

/// The cookie's name, and the address's parameter.
pub(super) const TOKEN_NAME: &str = "posekit_token";
/// 128 bits cannot be guessed.
const TOKEN_BYTES: usize = 16;

/// Who is let in.
#[derive(Clone, Debug)]
pub(super) struct Gate {
    token: Option<String>,
}

/// What the gate says to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Come in.
    Admitted,
    /// Come in, and have a cookie: the address had the token.
    AdmittedByAddress,
    /// Stay out.
    Refused,
}

impl Gate {
    /// For a server that listens on a loopback address.
    pub(super) fn this_machine() -> Self {
        Self { token: None }
    }

    /// For a server that others reach.
    pub(super) fn with_new_token() -> Result<Self, Failure> {
        let mut bytes = [0; TOKEN_BYTES];
        getrandom::fill(&mut bytes).map_err(|error| {
            Failure::new(format!(
                "the system could not supply a random token: {error}"
            ))
        })?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { token: Some(token) })
    }

    /// What the address to open ends in.
    pub(super) fn query(&self) -> String {
        match &self.token {
            Some(token) => format!("?{TOKEN_NAME}={token}"),
            None => String::new(),
        }
    }

    /// The cookie that stands for the token from now on.
    pub(super) fn cookie(&self) -> Option<String> {
        let token = self.token.as_ref()?;
        Some(format!(
            "{TOKEN_NAME}={token}; Path=/; HttpOnly; SameSite=Strict"
        ))
    }

    /// Judges a request by its head.
    pub(super) fn judge(&self, head: &Parts) -> Verdict {
        let Some(token) = &self.token else {
            return if is_called_by_a_local_name(head) {
                Verdict::Admitted
            } else {
                Verdict::Refused
            };
        };
        let parameters = head.uri.query().unwrap_or_default().split('&');
        if parameters.filter_map(value).any(|given| same(given, token)) {
            return Verdict::AdmittedByAddress;
        }
        let cookies = head.headers.get_all(COOKIE).iter();
        let cookies = cookies.filter_map(|line| line.to_str().ok());
        let mut pairs = cookies.flat_map(|line| line.split(';')).map(str::trim);
        if pairs.any(|pair| value(pair).is_some_and(|given| same(given, token))) {
            return Verdict::Admitted;
        }
        Verdict::Refused
    }
}

/// The token in `posekit_token=...`.
fn value(pair: &str) -> Option<&str> {
    pair.strip_prefix(TOKEN_NAME)?.strip_prefix('=')
}

/// Compares in a time that does not tell how much was right.
fn same(given: &str, token: &str) -> bool {
    given.as_bytes().ct_eq(token.as_bytes()).into()
}

fn is_called_by_a_local_name(head: &Parts) -> bool {
    let mut hosts = head.headers.get_all(HOST).iter();
    let (Some(host), None) = (hosts.next(), hosts.next()) else {
        return false;
    };
    host.to_str().is_ok_and(|host| is_local(without_port(host)))
}

fn without_port(host: &str) -> &str {
    match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) => name,
        _ => host,
    }
}

fn is_local(name: &str) -> bool {
    let bare = name.trim_start_matches('[').trim_end_matches(']');
    name.eq_ignore_ascii_case("localhost")
        || bare
            .parse::<IpAddr>()
            .is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyper::Request;

    fn head(uri: &str, headers: &[(&str, &str)]) -> Parts {
        let mut request = Request::builder().uri(uri);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        request.body(()).unwrap().into_parts().0
    }

    #[test]
    fn on_this_machine_only_local_names_are_let_in() {
        let gate = Gate::this_machine();
        for host in ["127.0.0.1:8631", "localhost", "LOCALHOST:1", "[::1]:80"] {
            assert_eq!(gate.judge(&head("/", &[("host", host)])), Verdict::Admitted);
        }
        for host in [
            "evil.example:8631",
            "192.168.1.5",
            "",
            "127.0.0.1.evil.example",
        ] {
            let verdict = gate.judge(&head("/", &[("host", host)]));
            assert_eq!(verdict, Verdict::Refused, "{host}");
        }
        assert_eq!(gate.judge(&head("/", &[])), Verdict::Refused);
    }

    #[test]
    fn others_need_the_token_in_address_or_cookie() {
        let gate = Gate::with_new_token().unwrap();
        let token = gate.token.clone().unwrap();
        assert_eq!(token.len(), 2 * TOKEN_BYTES);
        let uri = format!("/{}", gate.query());
        assert_eq!(gate.judge(&head(&uri, &[])), Verdict::AdmittedByAddress);
        let cookie = format!("a=b; {TOKEN_NAME}={token}");
        assert_eq!(
            gate.judge(&head("/x", &[("cookie", &cookie)])),
            Verdict::Admitted
        );
        let short = format!("/?{TOKEN_NAME}={}", &token[1..]);
        for uri in ["/", "/?posekit_token=", short.as_str()] {
            assert_eq!(gate.judge(&head(uri, &[])), Verdict::Refused, "{uri}");
        }
        assert_ne!(Gate::with_new_token().unwrap().token, gate.token);
    }
}
