//! Files in parts and in versions, downloads, and what browsers may do with answers.

use std::time::{Duration, SystemTime};

use super::{Server, body, header, status};
use crate::harness::ARM;

const CLIP: &str = "/clips/a%20b.bvh";

/// A server whose clip was last changed long ago.
fn server_with_an_old_clip() -> Server {
    let server = Server::start(&[]);
    let clip = server.folder.path().join("clips/a b.bvh");
    let long_ago = SystemTime::UNIX_EPOCH + Duration::from_secs(784_111_777);
    let file = std::fs::File::options().write(true).open(clip).unwrap();
    file.set_modified(long_ago).unwrap();
    server
}

#[test]
fn a_part_of_a_file_is_given_out() {
    let server = server_with_an_old_clip();
    let whole = server.get(CLIP);
    assert_eq!(header(&whole, "accept-ranges"), Some("bytes"));
    // The date of RFC 9110's examples.
    assert_eq!(
        header(&whole, "last-modified"),
        Some("Sun, 06 Nov 1994 08:49:37 GMT")
    );
    let length = ARM.len();
    let ask = |headers: &str| server.ask("GET", CLIP, headers);
    for (range, from, to) in [
        ("bytes=0-8", 0, 9),
        ("bytes=10-", 10, length),
        ("bytes=-7", length - 7, length),
        ("bytes=5-999999", 5, length),
    ] {
        let part = ask(&format!("Range: {range}\r\n"));
        assert_eq!(
            (status(&part), body(&part)),
            (206, &ARM[from..to]),
            "{range}"
        );
        let told = format!("bytes {from}-{}/{length}", to - 1);
        assert_eq!(header(&part, "content-range"), Some(&*told));
        assert_eq!(
            header(&part, "content-length"),
            Some(&*(to - from).to_string())
        );
        assert_eq!(header(&part, "etag"), header(&whole, "etag"));
    }
    for beyond in [format!("bytes={length}-"), "bytes=-0".into()] {
        let answer = ask(&format!("Range: {beyond}\r\n"));
        assert_eq!(status(&answer), 416, "{beyond}");
        assert_eq!(
            header(&answer, "content-range"),
            Some(&*format!("bytes */{length}"))
        );
    }
    for ignored in [
        "bytes=0-1,3-4",
        "bytes=9-3",
        "pages=1-2",
        "bytes",
        "Range: bytes=0-0",
    ] {
        let answer = ask(&format!("Range: {ignored}\r\n"));
        assert_eq!((status(&answer), body(&answer)), (200, ARM), "{ignored}");
    }
    let head = server.ask("HEAD", CLIP, "Range: bytes=0-1\r\n");
    assert_eq!((status(&head), body(&head)), (200, ""));
    assert_eq!(header(&head, "content-length"), Some(&*length.to_string()));
}

#[test]
fn a_part_is_of_the_version_that_was_begun_or_it_is_all() {
    let server = server_with_an_old_clip();
    let tag = header(&server.get(CLIP), "etag").unwrap().to_owned();
    assert!(tag.starts_with('"'), "strong: {tag}");
    let ask = |condition: &str| {
        server.ask(
            "GET",
            CLIP,
            &format!("Range: bytes=0-1\r\nIf-Range: {condition}\r\n"),
        )
    };
    for same in [&*tag, "Sun, 06 Nov 1994 08:49:37 GMT"] {
        assert_eq!(status(&ask(same)), 206, "{same}");
    }
    for other in ["\"other\"", "Sun, 06 Nov 1994 08:49:38 GMT"] {
        assert_eq!(status(&ask(other)), 200, "{other}");
    }
    server
        .folder
        .write("clips/a b.bvh", ARM.replace("90", "45"));
    assert_eq!(status(&ask(&tag)), 200, "it was changed");
}

#[test]
fn what_did_not_change_is_not_sent_again() {
    let server = server_with_an_old_clip();
    let tag = header(&server.get(CLIP), "etag").unwrap().to_owned();
    for condition in [
        format!("If-None-Match: {tag}\r\n"),
        format!("If-None-Match: \"x\", W/{tag}\r\n"),
        "If-Modified-Since: Sun, 06 Nov 1994 08:49:37 GMT\r\n".to_owned(),
    ] {
        for method in ["GET", "HEAD"] {
            let answer = server.ask(method, CLIP, &condition);
            assert_eq!((status(&answer), body(&answer)), (304, ""), "{condition}");
            assert_eq!(header(&answer, "etag"), Some(&*tag));
        }
    }
    assert_eq!(
        status(&server.ask("GET", CLIP, "If-Match: \"other\"\r\n")),
        412
    );
    server.folder.write("clips/a b.bvh", "changed");
    let answer = server.ask("GET", CLIP, &format!("If-None-Match: {tag}\r\n"));
    assert_eq!((status(&answer), body(&answer)), (200, "changed"));
    assert!(
        header(&answer, "etag").unwrap().starts_with("W/"),
        "just written"
    );
    assert_eq!(header(&answer, "cache-control"), Some("private, no-cache"));
}

#[test]
fn a_clip_is_saved_under_its_own_name() {
    let server = Server::start(&[]);
    server.folder.write(
        "clips/sub/c\u{e9} \"1\".bvh",
        "bytes as they are \u{0}\u{1}",
    );
    let shown = server.get("/clips/sub/c%C3%A9%20%221%22.bvh");
    assert_eq!(header(&shown, "content-disposition"), None);
    let saved = server.get("/clips/sub/c%C3%A9%20%221%22.bvh?download");
    assert_eq!(
        header(&saved, "content-disposition"),
        Some("attachment; filename=\"c_ _1_.bvh\"; filename*=UTF-8''c%C3%A9%20%221%22.bvh")
    );
    assert_eq!(body(&saved), "bytes as they are \u{0}\u{1}");
    // The page's own files are not for saving.
    assert_eq!(
        header(&server.get("/?download"), "content-disposition"),
        None
    );
}

#[test]
fn every_answer_says_what_a_browser_may_do_with_it() {
    let server = Server::start(&[]);
    let not_modified = {
        let tag = header(&server.get("/"), "etag").unwrap().to_owned();
        server.ask("GET", "/", &format!("If-None-Match: {tag}\r\n"))
    };
    assert_eq!(status(&not_modified), 304);
    let answers = [
        server.get("/"),
        server.get("/clips/"),
        server.get("/clips.json"),
        server.get(CLIP),
        server.get("/gone"),
        server.ask("POST", "/", ""),
        server.ask("GET", CLIP, "Range: bytes=99999-\r\n"),
        not_modified,
        server.raw(b"GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"),
    ];
    for answer in &answers {
        let policy = header(answer, "content-security-policy").unwrap();
        assert!(policy.starts_with("default-src 'none';"), "{policy}");
        assert!(policy.ends_with("; frame-ancestors 'self'"), "{policy}");
        assert!(
            !policy.contains("script-src 'self' 'unsafe-inline'"),
            "{policy}"
        );
        assert_eq!(
            header(answer, "cross-origin-resource-policy"),
            Some("same-origin")
        );
        assert_eq!(header(answer, "x-content-type-options"), Some("nosniff"));
        assert_eq!(header(answer, "referrer-policy"), Some("no-referrer"));
    }
    assert!(
        header(&answers[0], "content-security-policy")
            .unwrap()
            .contains("script-src 'self' 'wasm-unsafe-eval'")
    );
    assert!(
        !header(&answers[3], "content-security-policy")
            .unwrap()
            .contains("script-src")
    );
}

#[test]
fn only_pages_that_were_named_may_show_the_viewer() {
    let server = Server::start(&[
        "--embed",
        "https://lectures.example",
        "--embed",
        "http://localhost:3000/",
    ]);
    let page = server.get("/");
    let policy = header(&page, "content-security-policy").unwrap();
    let end = "; frame-ancestors 'self' https://lectures.example http://localhost:3000";
    assert!(policy.ends_with(end), "{policy}");
    assert_eq!(
        header(&page, "cross-origin-resource-policy"),
        Some("cross-origin")
    );
    let clip = server.get(CLIP);
    assert_eq!(
        header(&clip, "cross-origin-resource-policy"),
        Some("same-origin")
    );
    let error = server
        .folder
        .fail(2, &["serve", "clips", "--embed", "https://a; script-src *"]);
    assert!(
        error.contains("write it like https://lectures.example"),
        "{error}"
    );
}
