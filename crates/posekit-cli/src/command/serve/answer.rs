//! The answer to a request.
//!
//! `/` and the page's files, `/clips.json` the list, `/clips/NAME.bvh` a clip, `/clips/` the list for
//! people. Only `GET` and `HEAD`.

use hyper::header::{
    ACCEPT_ENCODING, ALLOW, CACHE_CONTROL, CONTENT_ENCODING, CONTENT_LENGTH, CONTENT_TYPE,
    HeaderValue, REFERRER_POLICY, SET_COOKIE, VARY, X_CONTENT_TYPE_OPTIONS,
};
use hyper::http::request::Parts;
use hyper::{Method, Response, StatusCode};

use super::body::Content;
use super::clips::{self, Found, Packing};
use super::gate::Verdict;
use super::listen::Site;

/// The answer to a request.
pub(super) fn answer(site: &Site, head: &Parts) -> Response<Content> {
    let verdict = site.gate.judge(head);
    let mut response = match verdict {
        Verdict::Refused => refusal(
            StatusCode::FORBIDDEN,
            "this needs the address with its token\n",
        ),
        Verdict::Admitted | Verdict::AdmittedByAddress => match head.method {
            Method::GET | Method::HEAD => content(site, head),
            _ => only_reading(),
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
    let headers = response.headers_mut();
    headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    // The address has the token in it: it is told to nobody.
    headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    // A clip that was changed on disk is fetched anew.
    headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    if head.method == Method::HEAD {
        *response.body_mut() = Content::nothing();
    }
    response
}

fn content(site: &Site, head: &Parts) -> Response<Content> {
    let path = head.uri.path();
    let path = path.strip_prefix('/').unwrap_or(path);
    if path == "clips.json" {
        let list = clips::list(&site.clips).to_string();
        return text(StatusCode::OK, "application/json", list);
    }
    if path == "clips/" || path == "clips" {
        return text(
            StatusCode::OK,
            "text/html; charset=utf-8",
            list_for_people(site),
        );
    }
    let found = match path.strip_prefix("clips/") {
        Some(name) => clips::clip(&site.clips, name),
        None => clips::page_file(&site.page, path, unpacks(head)),
    };
    match found {
        Some(found) => whole_file(found),
        None => refusal(StatusCode::NOT_FOUND, "there is no such file\n"),
    }
}

fn whole_file(found: Found) -> Response<Content> {
    let Found {
        file,
        length,
        media_type,
        packing,
    } = found;
    let mut response = Response::new(Content::File { file, left: length });
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media_type));
    headers.insert(CONTENT_LENGTH, HeaderValue::from(length));
    if packing == Packing::Brotli {
        headers.insert(CONTENT_ENCODING, HeaderValue::from_static("br"));
        headers.insert(VARY, HeaderValue::from_static("accept-encoding"));
    }
    response
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

fn text(status: StatusCode, media_type: &'static str, text: String) -> Response<Content> {
    let length = text.len();
    let mut response = Response::new(Content::text(text));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(media_type));
    headers.insert(CONTENT_LENGTH, HeaderValue::from(length));
    response
}

fn refusal(status: StatusCode, why: &str) -> Response<Content> {
    text(status, "text/plain; charset=utf-8", why.to_owned())
}

fn only_reading() -> Response<Content> {
    let mut response = refusal(
        StatusCode::METHOD_NOT_ALLOWED,
        "this server is only read from\n",
    );
    let headers = response.headers_mut();
    headers.insert(ALLOW, HeaderValue::from_static("GET, HEAD"));
    response
}

/// Every clip as a link that opens it in the viewer.
fn list_for_people(site: &Site) -> String {
    let list = clips::list(&site.clips);
    let mut page = String::from(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Clips</title>\
         <style>body{font:16px/1.6 system-ui,sans-serif;margin:2rem}</style><h1>Clips</h1><ul>",
    );
    for clip in list["clips"].as_array().into_iter().flatten() {
        let name = clip["name"].as_str().unwrap_or_default();
        page += &format!(
            "<li><a href=\"/?url=/clips/{}\">{}</a></li>",
            clips::encoded(&clips::encoded(name)),
            escaped(name)
        );
    }
    page + "</ul></html>\n"
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => html += "&amp;",
            '<' => html += "&lt;",
            '>' => html += "&gt;",
            '"' => html += "&quot;",
            '\'' => html += "&#39;",
            _ => html.push(c),
        }
    }
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_no_markup() {
        assert_eq!(
            escaped("<a href='\"&'>"),
            "&lt;a href=&#39;&quot;&amp;&#39;&gt;"
        );
    }
}
