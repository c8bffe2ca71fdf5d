//! The answer to a request.
//!
//! `/` and the page's files, `/clips.json` the list, `/clips/NAME.bvh` a clip, with `?download` to be saved
//! under its name, `/clips/` the list for people. Only `GET` and `HEAD`. Clips, lists and the page's files
//! may be kept by who asked, and are asked for again with what is needed to answer that nothing has
//! changed; files are also given out in parts.

use std::io::{Seek, SeekFrom};
use std::sync::Arc;
use std::time::SystemTime;

use hyper::header::{
    ACCEPT_ENCODING, ACCEPT_RANGES, ALLOW, CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_ENCODING,
    CONTENT_LENGTH, CONTENT_RANGE, CONTENT_TYPE, ETAG, HeaderMap, HeaderName, HeaderValue,
    LAST_MODIFIED, SET_COOKIE, VARY,
};
use hyper::http::request::Parts;
use hyper::{Method, Response, StatusCode};

use super::body::Content;
use super::files::{self, Found, Missing, Packing};
use super::gate::Verdict;
use super::listen::Site;
use super::policy::Kind;
use super::validity::{Outcome, Part, Validity};

/// The answer to a request.
pub(super) async fn answer(site: &Arc<Site>, head: Parts) -> Response<Content> {
    let verdict = site.gate.judge(&head);
    let is_head = head.method == Method::HEAD;
    let (mut response, kind) = match verdict {
        Verdict::Refused => other(refusal(
            StatusCode::FORBIDDEN,
            "open the full address, with its token\n",
        )),
        Verdict::Admitted | Verdict::AdmittedByAddress => match head.method {
            Method::GET | Method::HEAD => content(site, head).await,
            _ => other(only_reading()),
        },
    };
    if verdict == Verdict::AdmittedByAddress
        && let Some(cookie) = site
            .gate
            .cookie()
            .and_then(|c| HeaderValue::try_from(c).ok())
    {
        response.headers_mut().insert(SET_COOKIE, cookie);
    }
    site.policy.apply(kind, response.headers_mut());
    if is_head {
        *response.body_mut() = Content::nothing();
    }
    response
}

fn other(response: Response<Content>) -> (Response<Content>, Kind) {
    (response, Kind::Other)
}

async fn content(site: &Arc<Site>, head: Parts) -> (Response<Content>, Kind) {
    match head.uri.path() {
        "/clips.json" => other(list(site, &head, ListKind::Json).await),
        "/clips/" | "/clips" => other(list(site, &head, ListKind::Html).await),
        _ => {
            // The folder may be on a slow disk, or on another machine.
            let site = Arc::clone(site);
            let found = tokio::task::spawn_blocking(move || file(&site, &head)).await;
            found.unwrap_or_else(|_lost| {
                let status = StatusCode::INTERNAL_SERVER_ERROR;
                other(refusal(status, "the file could not be read\n"))
            })
        }
    }
}

#[derive(Clone, Copy)]
enum ListKind {
    Json,
    Html,
}

async fn list(site: &Site, head: &Parts, kind: ListKind) -> Response<Content> {
    let Some(list) = site.lists.current().await else {
        let status = StatusCode::INTERNAL_SERVER_ERROR;
        return refusal(status, "the folder could not be listed\n");
    };
    let (media_type, bytes) = match kind {
        ListKind::Json => ("application/json", &list.json),
        ListKind::Html => ("text/html; charset=utf-8", &list.html),
    };
    let validity = Validity::of_mark(&list.mark);
    match validity.judge(&head.headers) {
        Outcome::NotModified => not_modified(&validity),
        Outcome::Failed => refusal(StatusCode::PRECONDITION_FAILED, "the file has changed\n"),
        Outcome::Send => {
            let mut response = text(StatusCode::OK, media_type, bytes.clone());
            validate(&validity, response.headers_mut());
            response
        }
    }
}

fn file(site: &Site, head: &Parts) -> (Response<Content>, Kind) {
    let path = head.uri.path();
    let path = path.strip_prefix('/').unwrap_or(path);
    let (found, kind) = match path.strip_prefix("clips/") {
        Some(name) => (files::clip(&site.clips, name), Kind::Other),
        None => (
            files::page_file(&site.page, path, unpacks(head)),
            Kind::Page,
        ),
    };
    match found {
        Ok(found) => {
            let mut response = version_of(found, head);
            if kind == Kind::Other && wants_download(head) {
                let name = path.rsplit('/').next().unwrap_or(path);
                insert(
                    response.headers_mut(),
                    CONTENT_DISPOSITION,
                    &attachment(name),
                );
            }
            (response, kind)
        }
        Err(Missing::NoSuchFile) => {
            other(refusal(StatusCode::NOT_FOUND, "there is no such file\n"))
        }
        Err(Missing::Unreadable) => other(refusal(
            StatusCode::FORBIDDEN,
            "the server may not read this file\n",
        )),
    }
}

/// A file, or the part of it that is wanted, or that it is the one that who asks has.
fn version_of(found: Found, head: &Parts) -> Response<Content> {
    let Found {
        mut file,
        metadata,
        media_type,
        packing,
    } = found;
    let validity = Validity::of_file(&metadata, packing, SystemTime::now());
    match validity.judge(&head.headers) {
        Outcome::NotModified => return not_modified(&validity),
        Outcome::Failed => {
            return refusal(StatusCode::PRECONDITION_FAILED, "the file has changed\n");
        }
        Outcome::Send => {}
    }
    let length = metadata.len();
    // Parts are defined for GET alone.
    let part = match head.method {
        Method::GET => validity.part(&head.headers, length),
        _ => None,
    };
    let (status, bytes) = match part {
        None => (StatusCode::OK, 0..length),
        Some(Part::Bytes(bytes)) => (StatusCode::PARTIAL_CONTENT, bytes),
        Some(Part::Nowhere) => {
            let status = StatusCode::RANGE_NOT_SATISFIABLE;
            let mut response = refusal(status, "the requested range is outside the file\n");
            insert(
                response.headers_mut(),
                CONTENT_RANGE,
                &format!("bytes */{length}"),
            );
            return response;
        }
    };
    if file.seek(SeekFrom::Start(bytes.start)).is_err() {
        return refusal(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the file could not be read\n",
        );
    }
    let mut response = Response::new(Content::file(file, bytes.end - bytes.start));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    validate(&validity, headers);
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media_type));
    headers.insert(CONTENT_LENGTH, HeaderValue::from(bytes.end - bytes.start));
    headers.insert(ACCEPT_RANGES, HeaderValue::from_static("bytes"));
    if status == StatusCode::PARTIAL_CONTENT {
        let range = format!("bytes {}-{}/{length}", bytes.start, bytes.end - 1);
        insert(headers, CONTENT_RANGE, &range);
    }
    if packing == Packing::Brotli {
        headers.insert(CONTENT_ENCODING, HeaderValue::from_static("br"));
    }
    response
}

/// Says which version it is, and that it is to be asked for again before it is used again.
fn validate(validity: &Validity, headers: &mut HeaderMap) {
    insert(headers, ETAG, &validity.tag);
    if let Some(modified) = validity.modified {
        insert(headers, LAST_MODIFIED, &httpdate::fmt_http_date(modified));
    }
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("private, no-cache"));
    // With another one the page's files come packed, or not.
    headers.insert(VARY, HeaderValue::from_static("accept-encoding"));
}

/// Inserts a value that is known to be one.
fn insert(headers: &mut HeaderMap, name: HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        headers.insert(name, value);
    }
}

fn not_modified(validity: &Validity) -> Response<Content> {
    let mut response = Response::new(Content::nothing());
    *response.status_mut() = StatusCode::NOT_MODIFIED;
    validate(validity, response.headers_mut());
    response
}

/// Whether a clip is to be saved, not shown.
fn wants_download(head: &Parts) -> bool {
    let parameters = head.uri.query().unwrap_or_default().split('&');
    let mut names = parameters.map(|parameter| parameter.split('=').next().unwrap_or(parameter));
    names.any(|name| name == "download")
}

/// `Content-Disposition` for a file to be saved under the name that an address ends in: RFC 6266, with a
/// name of plain characters for who reads no others.
fn attachment(encoded: &str) -> String {
    let name = files::decoded(encoded);
    let plain: String = name
        .chars()
        .map(|c| match c {
            // In a quoted string these are written with what some readers do not understand.
            '"' | '\\' | '%' => '_',
            ' '..='~' => c,
            _ => '_',
        })
        .collect();
    let exact = files::encoded(&name);
    format!("attachment; filename=\"{plain}\"; filename*=UTF-8''{exact}")
}

/// Whether who asks says that it unpacks brotli.
fn unpacks(head: &Parts) -> Packing {
    let lines = head.headers.get_all(ACCEPT_ENCODING).iter();
    let mut codings = lines
        .filter_map(|line| line.to_str().ok())
        .flat_map(|line| line.split(','));
    // `br;q=0` refuses it; other weights do not matter where there are two ways.
    if codings.any(|coding| {
        let (name, weight) = coding.split_once(';').unwrap_or((coding, ""));
        let weight = weight.trim().trim_start_matches("q=");
        name.trim() == "br" && weight.parse() != Ok(0.0)
    }) {
        Packing::Brotli
    } else {
        Packing::None
    }
}

fn text(
    status: StatusCode,
    media_type: &'static str,
    text: impl Into<hyper::body::Bytes>,
) -> Response<Content> {
    let text = text.into();
    let length = text.len();
    let mut response = Response::new(Content::text(text));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media_type));
    headers.insert(CONTENT_LENGTH, HeaderValue::from(length));
    response
}

fn refusal(status: StatusCode, why: &'static str) -> Response<Content> {
    text(status, "text/plain; charset=utf-8", why)
}

fn only_reading() -> Response<Content> {
    let mut response = refusal(StatusCode::METHOD_NOT_ALLOWED, "this server is read-only\n");
    let headers = response.headers_mut();
    headers.insert(ALLOW, HeaderValue::from_static("GET, HEAD"));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_download_has_its_name_in_two_ways() {
        for (address, header) in [
            ("a.bvh", "filename=\"a.bvh\"; filename*=UTF-8''a.bvh"),
            (
                "a%20b.bvh",
                "filename=\"a b.bvh\"; filename*=UTF-8''a%20b.bvh",
            ),
            (
                "%22%25.bvh",
                "filename=\"__.bvh\"; filename*=UTF-8''%22%25.bvh",
            ),
            (
                "d%C3%A9fil%C3%A9.bvh",
                "filename=\"d_fil_.bvh\"; filename*=UTF-8''d%C3%A9fil%C3%A9.bvh",
            ),
            (
                "it's.bvh",
                "filename=\"it's.bvh\"; filename*=UTF-8''it%27s.bvh",
            ),
        ] {
            assert_eq!(attachment(address), format!("attachment; {header}"));
        }
    }
}
