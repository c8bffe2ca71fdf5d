//! How cost grows with size: the same work on files of one shape, each ten times as large as the one before.
//! The time for each joint or frame should hardly change; where it grows tenfold, a walk is quadratic.
//!
//! `cargo bench -p posekit-formats --bench growth [SECONDS]`

#[path = "../../../benches/harness.rs"]
#[allow(dead_code, reason = "each bench uses a part of it")]
mod harness;

use std::fmt::Write as _;
use std::hint::black_box;

use harness::{Table, Unit, time_asked};
use posekit::body::Anatomy;
use posekit::check::CheckConfig;
use posekit::figure::{RestPose, body_extent, guess_up};
use posekit::motion::{Motion, PositionPolicy};
use posekit_formats::bvh;
use posekit_formats::report::ImportReport;
use posekit_formats::scene::{self, Shot};

/// Joints of the smallest file; the largest has a hundred times as many, the most that are read.
const JOINTS: usize = 1_000;
/// Frames of the smallest file.
const FRAMES: usize = 10_000;
/// Tracks of the smallest scene.
const TRACKS: usize = 100;

fn main() {
    type Written = fn(usize) -> String;
    let shapes: [(&str, Written); 4] = [
        ("branches in one place", |n| branches(n, |_| (0.0, 1.0))),
        ("branches in a row", |n| branches(n, |i| (i as f64, 1.0))),
        ("roots", roots),
        ("links of one rope", rope),
    ];
    for (what, text) in shapes {
        let files = [1, 10, 100].map(|times| {
            let text = text(JOINTS * times);
            let read = bvh::read(text.as_bytes());
            (JOINTS * times, text, read.map(|import| import.document))
        });
        let mut table = Table::new(what, Unit::NanosecondsPer("joint"));
        for (joints, text, document) in &files {
            // A rope may be longer than what is read.
            let Ok(document) = document else { continue };
            table
                .job(format!("read {joints}"), *joints, || {
                    black_box(bvh::read(text.as_bytes()).is_ok());
                })
                // A skeleton keeps the pairs that were found: each time it is another one.
                .job(format!("symmetric pairs of {joints}"), *joints, || {
                    black_box(motion_of(document).skeleton().symmetric_pairs().len());
                })
                .job(format!("all that info asks of {joints}"), *joints, || {
                    let motion = motion_of(document);
                    black_box(motion.skeleton().symmetric_pairs().len());
                    black_box(RestPose::of(motion.skeleton()));
                    black_box((guess_up(&motion), body_extent(&motion)));
                    black_box(Anatomy::of_motion(&motion).is_ok());
                })
                .job(format!("check {joints}"), *joints, || check(document));
        }
        table.measure(time_asked());
    }
    let files = [1, 10, 100].map(|times| {
        let text = frames(FRAMES * times);
        let document = bvh::read(text.as_bytes()).expect("readable").document;
        (FRAMES * times, text, document)
    });
    let mut table = Table::new("frames of one channel", Unit::NanosecondsPer("frame"));
    for (frames, text, document) in &files {
        table
            .job(format!("read {frames}"), *frames, || {
                black_box(bvh::read(text.as_bytes()).is_ok());
            })
            .job(format!("check {frames}"), *frames, || check(document));
    }
    table.measure(time_asked());
    let files = [1, 10, 100].map(|times| (TRACKS * times, tracks(TRACKS * times)));
    let mut table = Table::new("tracks of a scene", Unit::NanosecondsPer("track"));
    for (tracks, text) in &files {
        let scene = scene::read(text.as_bytes()).expect("readable");
        table
            .job(format!("read {tracks}"), *tracks, || {
                black_box(scene::read(text.as_bytes()).is_ok());
            })
            .job(format!("put together {tracks}"), *tracks, move || {
                let none =
                    |_: &str| Err::<scene::FileMotion, _>(scene::MotionFileError(String::new()));
                black_box(Shot::new(&scene, none).is_ok());
            });
    }
    table.measure(time_asked());
}

fn motion_of(document: &bvh::Bvh) -> Motion {
    let motion = document.to_motion(PositionPolicy::Replace);
    motion.expect("a motion")
}

fn check(document: &bvh::Bvh) {
    let (report, config) = (ImportReport::default(), CheckConfig::default());
    let found = bvh::check(document, &report, PositionPolicy::Replace, &config);
    black_box(found.is_ok());
}

const MOTION: &str = "MOTION\nFrames: 0\nFrame Time: 0.1\n";

fn branches(count: usize, place: impl Fn(usize) -> (f64, f64)) -> String {
    let mut text = String::from("HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\n");
    for branch in 0..count / 2 {
        let (x, y) = place(branch);
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "JOINT j{branch}\n{{\nOFFSET {x} {y} 0\nCHANNELS 1 Yrotation\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n"
        );
    }
    text + "}\n" + MOTION
}

fn roots(count: usize) -> String {
    let mut text = String::from("HIERARCHY\n");
    for root in 0..count / 2 {
        let _ = write!(
            text,
            "ROOT r{root}\n{{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n"
        );
    }
    text + MOTION
}

fn rope(count: usize) -> String {
    let mut text = String::from("HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\n");
    for joint in 1..count {
        let _ = write!(
            text,
            "JOINT j{joint}\n{{\nOFFSET 0 1 0\nCHANNELS 1 Yrotation\n"
        );
    }
    text + &"}\n".repeat(count) + MOTION
}

fn frames(count: usize) -> String {
    let mut text = format!(
        "HIERARCHY\nROOT r\n{{\nOFFSET 0 0 0\nCHANNELS 1 Yrotation\n}}\nMOTION\nFrames: {count}\nFrame Time: 0.1\n"
    );
    for frame in 0..count {
        let _ = writeln!(text, "{}", frame % 90);
    }
    text
}

fn tracks(count: usize) -> String {
    let mut text = String::from(
        "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nframes_per_sec = 30\n[skeleton]\njoints = [\n",
    );
    for joint in 0..count {
        let parent = match joint {
            0 => String::new(),
            _ => format!(" parent = \"j{}\",", (joint - 1) / 2),
        };
        let _ = writeln!(
            text,
            "{{ name = \"j{joint}\",{parent} translation = [0, 1, 0] }},"
        );
    }
    text += "]\n";
    for joint in 0..count {
        let _ = write!(
            text,
            "[[track]]\njoint = \"j{joint}\"\nproperty = \"rotation\"\nkeys = [ {{ at = 0, value = [0, 0, 0, 1] }} ]\n"
        );
    }
    text
}
