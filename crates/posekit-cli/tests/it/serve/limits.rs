//! Clients that are slow, silent, many, or do not read.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

use super::{PATIENCE, Server, status};

/// More than the system takes of an answer that nobody reads.
const LARGE: u64 = 1 << 28;

fn with_a_large_clip(extra: &[&str]) -> Server {
    let server = Server::start(extra);
    let file = std::fs::File::create(server.folder.path().join("clips/large.bvh")).unwrap();
    file.set_len(LARGE).unwrap();
    server
}

/// Asks for the large clip and reads the beginning of the answer, no more.
fn asks_and_does_not_read(server: &Server) -> TcpStream {
    let mut stream = server.connect();
    let request = "GET /clips/large.bvh HTTP/1.1\r\nHost: localhost\r\n\r\n";
    stream.write_all(request.as_bytes()).unwrap();
    let mut beginning = [0; 12];
    stream.read_exact(&mut beginning).unwrap();
    assert_eq!(&beginning, b"HTTP/1.1 200");
    stream
}

#[test]
fn who_does_not_read_is_hung_up_on() {
    let server = with_a_large_clip(&["--stall-time", "0.3"]);
    let stream = asks_and_does_not_read(&server);
    let start = Instant::now();
    // The system tells of a connection that was cut without anything being read from it.
    while stream.take_error().unwrap().is_none() {
        assert!(start.elapsed() < PATIENCE, "the connection is still there");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(status(&server.get("/")), 200);
}

#[test]
fn who_reads_slowly_gets_everything() {
    let server = Server::start(&["--stall-time", "30"]);
    let whole = "0123456789abcdef".repeat(1 << 16);
    server.folder.write("clips/slow.bvh", &whole);
    let mut stream = server.connect();
    let request = "GET /clips/slow.bvh HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    let mut piece = [0; 1 << 16];
    loop {
        let read = stream.read(&mut piece).unwrap();
        if read == 0 {
            break;
        }
        answer.extend_from_slice(&piece[..read]);
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(answer.ends_with(whole.as_bytes()));
}

#[test]
fn those_who_do_not_read_or_say_nothing_keep_nobody_out() {
    let server = with_a_large_clip(&["--most-connections", "4", "--stall-time", "3600"]);
    let mut idle: Vec<TcpStream> = (0..6).map(|_| asks_and_does_not_read(&server)).collect();
    idle.extend((0..6).map(|_| server.connect()));
    for _ in 0..3 {
        assert_eq!(status(&server.get("/")), 200);
        assert_eq!(status(&server.get("/clips.json")), 200);
    }
    drop(idle);
}

#[test]
fn slow_clients_keep_nobody_waiting() {
    let server = Server::start(&[]);
    // Some say nothing, some begin and stop, some ask and do not read.
    let mut idle: Vec<TcpStream> = (0..40).map(|_| server.connect()).collect();
    for (index, stream) in idle.iter_mut().enumerate() {
        match index % 3 {
            0 => {}
            1 => stream.write_all(b"GET / HT").unwrap(),
            _ => stream
                .write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
                .unwrap(),
        }
    }
    assert_eq!(status(&server.get("/clips.json")), 200);
    for stream in idle {
        let _ = stream.shutdown(Shutdown::Both);
    }
}

#[test]
fn one_connection_serves_many_requests() {
    let server = Server::start(&[]);
    let mut stream = server.connect();
    for _ in 0..3 {
        stream
            .write_all(b"GET /clips/sub/c.bvh HTTP/1.1\r\nHost: localhost\r\n\r\n")
            .unwrap();
        let mut answer = Vec::new();
        let mut byte = [0];
        while !answer.ends_with(b"\r\n\r\nc") {
            stream.read_exact(&mut byte).unwrap();
            answer.push(byte[0]);
        }
        assert!(answer.starts_with(b"HTTP/1.1 200"));
    }
}
