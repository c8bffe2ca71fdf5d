//! The server, asked with raw bytes over TCP as a browser, a stranger and an attacker would.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::harness::{ARM, Folder};

mod limits;
mod lists;
mod versions;

/// Longer than any answer takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running server over a folder with clips and a page in it.
struct Server {
    folder: Folder,
    child: Child,
    port: u16,
    /// What follows the `?` of the address it printed.
    query: String,
}

impl Server {
    fn start(extra: &[&str]) -> Self {
        let folder = Folder::with_arm();
        folder.write("clips/a b.bvh", ARM);
        folder.write("clips/sub/c.bvh", "c");
        folder.write("clips/notes.txt", "private");
        folder.write("clips/.hidden.bvh", "private");
        folder.write("secret.bvh", "private");
        folder.write("page/index.html", "<!doctype html>hello");
        folder.write("page/posekit_viewer_bg.wasm", b"\0asm");
        folder.write("page/passwords", "private");
        let link = |to: &str, name: &str| {
            std::os::unix::fs::symlink(folder.path().join(to), folder.path().join(name)).unwrap();
        };
        link("secret.bvh", "clips/leak.bvh");
        link("clips/notes.txt", "clips/notes.bvh");
        link("clips/sub/c.bvh", "clips/inside.bvh");
        link("", "clips/up");
        folder.write("clips/.private/d.bvh", "private");
        link("clips/.hidden.bvh", "clips/shown.bvh");
        link("clips/.private/d.bvh", "clips/deep.bvh");
        link("clips/.private", "clips/folder");
        let mut command = folder.command();
        command.args(["serve", "clips", "--page", "page", "--port", "0", "--quiet"]);
        let mut child = command.args(extra).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let stdout = child.stdout.take().unwrap();
        BufReader::new(stdout).read_line(&mut line).unwrap();
        let (_, address) = line.trim().split_once("http://").expect("an address");
        let (place, query) = address.split_once('/').unwrap();
        let port = place.rsplit(':').next().unwrap().parse().unwrap();
        let query = query.trim_start_matches('?').to_owned();
        Self {
            folder,
            child,
            port,
            query,
        }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// Sends bytes and reads until the server closes.
    fn raw(&self, request: &[u8]) -> String {
        let mut stream = self.connect();
        // A server that has heard enough closes while it is still being written to.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn ask(&self, method: &str, target: &str, headers: &str) -> String {
        let request = format!(
            "{method} {target} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{headers}\r\n",
            self.port
        );
        self.raw(request.as_bytes())
    }

    fn get(&self, target: &str) -> String {
        self.ask("GET", target, "")
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn status(answer: &str) -> u16 {
    let code = answer.split(' ').nth(1).unwrap_or_default();
    code.parse()
        .unwrap_or_else(|_| panic!("no status in {answer:?}"))
}

fn body(answer: &str) -> &str {
    answer.split_once("\r\n\r\n").expect("a head").1
}

/// A header of an answer.
fn header<'a>(answer: &'a str, name: &str) -> Option<&'a str> {
    let (head, _) = answer.split_once("\r\n\r\n")?;
    head.lines().find_map(|line| {
        let (found, value) = line.split_once(": ")?;
        found.eq_ignore_ascii_case(name).then_some(value)
    })
}

#[test]
fn the_page_the_list_and_the_clips_are_given_out() {
    let server = Server::start(&[]);
    let page = server.get("/");
    assert_eq!((status(&page), body(&page)), (200, "<!doctype html>hello"));
    assert!(page.contains("content-type: text/html"), "{page}");
    let module = server.get("/posekit_viewer_bg.wasm");
    assert!(
        module.contains("content-type: application/wasm"),
        "{module}"
    );
    assert_eq!(body(&server.get("/clips/a%20b.bvh")), ARM);
    assert_eq!(body(&server.get("/clips/sub/c.bvh?x=1")), "c");
    assert_eq!(body(&server.get("/clips/inside.bvh")), "c");
    let list: serde_json::Value = serde_json::from_str(body(&server.get("/clips.json"))).unwrap();
    let entries = list["clips"].as_array().unwrap();
    let names: Vec<_> = entries
        .iter()
        .map(|clip| clip["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["a b.bvh", "inside.bvh", "sub/c.bvh"]);
    assert_eq!(list["folder"], "clips");
    assert_eq!(entries[0]["url"], "/clips/a%20b.bvh");
    assert_eq!(entries[0]["bytes"], ARM.len());
    assert!(server.get("/clips/").contains("/?url=/clips/a%2520b.bvh"));
}

#[test]
fn the_page_is_sent_packed_to_who_unpacks_it() {
    let server = Server::start(&[]);
    server.folder.write("page/index.html.br", "packed");
    let ask = |headers: &str| server.ask("GET", "/", headers);
    for accepts in [
        "Accept-Encoding: gzip, br\r\n",
        "Accept-Encoding: br;q=0.5\r\n",
    ] {
        let packed = ask(accepts);
        assert_eq!(body(&packed), "packed");
        assert!(packed.contains("content-encoding: br"), "{packed}");
        assert!(packed.contains("content-type: text/html"), "{packed}");
    }
    for refuses in [
        "",
        "Accept-Encoding: gzip\r\n",
        "Accept-Encoding: br;q=0\r\n",
    ] {
        let plain = ask(refuses);
        assert_eq!(body(&plain), "<!doctype html>hello");
        assert!(!plain.contains("content-encoding"), "{plain}");
    }
    assert_eq!(status(&server.get("/index.html.br")), 404);
    assert_eq!(status(&server.get("/passwords.br")), 404);
}

#[test]
fn nothing_else_is_given_out() {
    let server = Server::start(&[]);
    for target in [
        "/clips/notes.txt",
        "/clips/.hidden.bvh",
        "/clips/leak.bvh",
        "/clips/notes.bvh",
        "/clips/up/secret.bvh",
        "/clips/shown.bvh",
        "/clips/deep.bvh",
        "/clips/folder/d.bvh",
        "/clips/.private/d.bvh",
        "/clips/sub",
        "/clips/sub/",
        "/clips/../secret.bvh",
        "/clips/%2e%2e/secret.bvh",
        "/clips/%2E%2E%2Fsecret.bvh",
        "/clips/..%2fsecret.bvh",
        "/clips/..%5csecret.bvh",
        "/clips/sub/../../secret.bvh",
        "/clips//etc/passwd",
        "/clips/%2fetc%2fpasswd",
        "/clips/a%20b.bvh%00.bvh",
        "/clips/%ff.bvh",
        "/../secret.bvh",
        "/passwords",
        "/secret.bvh",
        "/%2e%2e/secret.bvh",
        "//etc/passwd",
    ] {
        let answer = server.get(target);
        assert!(status(&answer) >= 400, "{target}: {answer}");
        assert!(
            !answer.contains("private") && !answer.contains("root:"),
            "{target}"
        );
    }
}

#[test]
fn only_reading_is_answered() {
    let server = Server::start(&[]);
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "PATCH", "BREW"] {
        let answer = server.ask(method, "/clips/sub/c.bvh", "");
        assert_eq!(status(&answer), 405, "{method}");
        assert!(answer.contains("allow: GET, HEAD"), "{answer}");
    }
    let head = server.ask("HEAD", "/clips/sub/c.bvh", "");
    assert_eq!((status(&head), body(&head)), (200, ""));
    assert!(head.contains("content-length: 1"), "{head}");
    assert_eq!(fs_text(&server, "clips/sub/c.bvh"), "c");
}

fn fs_text(server: &Server, name: &str) -> String {
    server.folder.read(name)
}

#[test]
fn a_name_that_is_not_this_machines_is_turned_away() {
    let server = Server::start(&[]);
    for host in ["evil.example", "127.0.0.1.evil.example"] {
        let request = format!("GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        assert_eq!(status(&server.raw(request.as_bytes())), 403, "{host}");
    }
}

#[test]
fn others_need_the_token() {
    let server = Server::start(&["--host", "127.0.0.1"]);
    assert!(
        server.query.starts_with("posekit_token="),
        "{}",
        server.query
    );
    let token = server.query.strip_prefix("posekit_token=").unwrap();
    assert_eq!(token.len(), 32);
    let wrong = "0".repeat(32);
    for target in [
        "/".to_owned(),
        "/clips.json".to_owned(),
        "/clips/sub/c.bvh?posekit_token=".to_owned(),
        format!("/?posekit_token={wrong}"),
        format!("/?posekit_token={}", &token[..31]),
    ] {
        assert_eq!(status(&server.get(&target)), 403, "{target}");
    }
    let page = server.get(&format!("/?{}", server.query));
    assert_eq!(status(&page), 200);
    assert!(page.contains("HttpOnly; SameSite=Strict"), "{page}");
    let cookie = format!("Cookie: posekit_token={token}\r\n");
    let clip = server.ask("GET", "/clips/sub/c.bvh", &cookie);
    assert_eq!((status(&clip), body(&clip)), (200, "c"));
}

#[test]
fn huge_and_broken_requests_are_refused_and_the_server_lives() {
    let server = Server::start(&[]);
    let long = "x".repeat(1 << 20);
    for request in [
        format!("GET /{long} HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        format!("GET / HTTP/1.1\r\nHost: localhost\r\nX: {long}\r\n\r\n"),
        format!(
            "GET / HTTP/1.1\r\nHost: localhost\r\n{}\r\n",
            "A: b\r\n".repeat(5000)
        ),
        "\0\0\0\0\r\n\r\n".to_owned(),
        "GET\r\n\r\n".to_owned(),
        "GET / HTTP/9.9\r\n\r\n".to_owned(),
    ] {
        let answer = server.raw(request.as_bytes());
        let ok = answer.starts_with("HTTP/1.1 200");
        assert!(!ok, "{}", &request[..request.len().min(60)]);
    }
    assert_eq!(status(&server.get("/")), 200);
}

#[test]
fn an_interrupt_ends_it_without_failure() {
    let mut server = Server::start(&[]);
    let _open = server.connect();
    let pid = server.child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &pid]).status();
    assert!(kill.unwrap().success());
    assert_eq!(server.child.wait().unwrap().code(), Some(0));
}

#[test]
fn what_cannot_be_served_is_said() {
    let folder = Folder::with_arm();
    folder.write("page/index.html", "");
    let page = ["--page", "page", "--port", "0"];
    let fail = |args: &[&str]| folder.fail(1, &[&["serve"], args].concat());
    assert!(fail(&[&["gone"], &page[..]].concat()).contains("gone: no such file"));
    assert!(fail(&[&["arm.bvh"], &page[..]].concat()).contains("is a file, not a folder"));
    let error = fail(&[".", "--page", "."]);
    assert!(
        error.contains("index.html") && error.contains("cargo xtask web"),
        "{error}"
    );
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let error = fail(&[".", "--page", "page", "--port", &port]);
    assert!(error.contains("already in use"), "{error}");
}
