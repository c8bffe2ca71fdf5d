//! The list of the clips: kept, renewed, cut, and not in the way of other answers.

use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::time::Instant;

use super::{PATIENCE, Server, body, header, status};
use crate::harness::Folder;

/// The names in the list.
fn names(server: &Server) -> Vec<String> {
    let list: serde_json::Value = serde_json::from_str(body(&server.get("/clips.json"))).unwrap();
    let clips = list["clips"].as_array().unwrap();
    clips
        .iter()
        .map(|clip| clip["name"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn a_list_is_kept_for_its_time() {
    let server = Server::start(&["--list-time", "3600"]);
    let before = names(&server);
    server.folder.write("clips/new.bvh", "new");
    assert_eq!(names(&server), before);
    // The file itself is there at once.
    assert_eq!(body(&server.get("/clips/new.bvh")), "new");
}

#[test]
fn a_file_that_comes_changes_and_goes_is_noticed() {
    let server = Server::start(&["--list-time", "0"]);
    let becomes = |what: &dyn Fn(&str) -> bool| {
        let start = Instant::now();
        while !what(body(&server.get("/clips.json"))) {
            assert!(start.elapsed() < PATIENCE);
        }
    };
    assert!(!names(&server).contains(&"sub/new.bvh".to_owned()));
    server.folder.write("clips/sub/new.bvh", "new");
    becomes(&|list| list.contains("sub/new.bvh"));
    server
        .folder
        .write("clips/sub/new.bvh", "longer than before");
    becomes(&|list| list.contains("\"bytes\":18"));
    std::fs::remove_file(server.folder.path().join("clips/sub/new.bvh")).unwrap();
    becomes(&|list| !list.contains("sub/new.bvh"));
}

#[test]
fn a_list_that_did_not_change_is_not_sent_again() {
    let server = Server::start(&["--list-time", "0"]);
    for target in ["/clips.json", "/clips/"] {
        let first = server.get(target);
        let again = format!("If-None-Match: {}\r\n", header(&first, "etag").unwrap());
        let second = server.ask("GET", target, &again);
        assert_eq!((status(&second), body(&second)), (304, ""), "{target}");
    }
}

#[test]
fn the_list_is_built_once_for_many_who_ask() {
    let server = Server::start(&["--list-time", "3600"]);
    let answers: Vec<String> = std::thread::scope(|scope| {
        let asking: Vec<_> = (0..30)
            .map(|_| scope.spawn(|| server.get("/clips.json")))
            .collect();
        asking.into_iter().map(|one| one.join().unwrap()).collect()
    });
    let first = body(&answers[0]);
    assert!(
        answers
            .iter()
            .all(|answer| status(answer) == 200 && body(answer) == first)
    );
}

#[test]
fn page_and_terminal_say_that_the_list_is_cut() {
    let server = Server::start(&["--most-clips", "2"]);
    let list: serde_json::Value = serde_json::from_str(body(&server.get("/clips.json"))).unwrap();
    assert_eq!(list["clips"].as_array().unwrap().len(), 2);
    // One of the three is a link that is listed, and those not to be followed are counted too.
    let shortage = list["shortage"].as_str().unwrap();
    assert!(shortage.starts_with("only the first 2 of "), "{shortage}");
    assert!(server.get("/clips/").contains("Only the first 2 of"));

    let folder = Folder::with_arm();
    folder.write("page/index.html", "");
    folder.write("b.bvh", "b");
    let mut command = folder.command();
    command.args([
        "serve",
        ".",
        "--page",
        "page",
        "--port",
        "0",
        "--most-clips",
        "1",
    ]);
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let said = lines
        .map_while(Result::ok)
        .find(|line| line.contains("only the first 1 of 2 clips are listed"));
    let _ = child.kill();
    let _ = child.wait();
    assert!(said.is_some_and(|line| line.starts_with("warning: ")));
}

#[test]
fn the_list_for_people_shows_saves_and_opens() {
    let server = Server::start(&[]);
    let page = server.get("/clips/");
    for link in [
        "href=\"/?url=/clips/a%2520b.bvh\">a b.bvh</a>",
        "href=\"/clips/a%20b.bvh\">text</a>",
        "href=\"/clips/a%20b.bvh?download\" download>download</a>",
    ] {
        assert!(page.contains(link), "{link} in {page}");
    }
}
