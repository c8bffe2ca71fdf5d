//! Reading away from the window: what arrives, what fails, what is stopped.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_kittest::kittest::Queryable as _;
use posekit_viewer::load::{Event, Input, Loader, Purpose};
use posekit_viewer::state::settings::Settings;
use posekit_viewer::{Viewer, ViewerOptions};

use super::clips::arm_text;
use super::window::{until, viewer};

/// Long enough for a busy machine; a test that waits so long has failed.
const PATIENCE: Duration = Duration::from_secs(60);

fn loader() -> Loader {
    Loader::new(&egui::Context::default())
}

fn wait(loader: &mut Loader) -> Event {
    wait_first(loader).0
}

/// The next event, and those that came with it.
fn wait_first(loader: &mut Loader) -> (Event, Vec<Event>) {
    let start = Instant::now();
    loop {
        let mut events = loader.take_events();
        if !events.is_empty() {
            let first = events.remove(0);
            return (first, events);
        }
        assert!(start.elapsed() < PATIENCE, "nothing happened");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn bytes(name: &str, text: &str) -> Input {
    Input::Bytes {
        name: name.to_owned(),
        bytes: Arc::from(text.as_bytes()),
    }
}

#[test]
fn a_clip_arrives_with_its_preview() {
    let mut loader = loader();
    loader.read(bytes("arm.bvh", &arm_text(5)), Purpose::Beside);
    match wait(&mut loader) {
        Event::Read {
            purpose: Purpose::Beside,
            clip,
            thumbnail,
            ..
        } => {
            assert_eq!((clip.name.as_str(), clip.frame_count()), ("arm.bvh", 5));
            let first = thumbnail.pixels[0];
            assert!(
                thumbnail.pixels.iter().any(|&pixel| pixel != first),
                "it shows something"
            );
        }
        other => panic!("{other:?}"),
    }
    assert!(loader.take_events().is_empty() && loader.jobs().is_empty());
}

#[test]
fn what_is_no_motion_is_told_with_its_place() {
    let mut loader = loader();
    loader.read(bytes("notes.bvh", "dear diary"), Purpose::Beside);
    match wait(&mut loader) {
        Event::GivenUp {
            message: Some(message),
            ..
        } => {
            assert!(message.starts_with("notes.bvh: line 1"), "{message}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_missing_file_and_a_folder_are_told() {
    let mut loader = loader();
    for (path, says) in [("no/such.bvh", "no such file"), (".", "is a folder")] {
        loader.read(Input::Path(PathBuf::from(path)), Purpose::Beside);
        match wait(&mut loader) {
            Event::GivenUp {
                message: Some(message),
                ..
            } => assert!(message.contains(says), "{message}"),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_file_with_problems_opens_and_says_what_was_wrong() {
    let mut loader = loader();
    let text = arm_text(5).replace("Frames: 5", "Frames: 4");
    loader.read(bytes("short.bvh", &text), Purpose::Beside);
    match wait(&mut loader) {
        Event::Read { clip, .. } => {
            assert_eq!(clip.frame_count(), 5, "what is there counts");
            assert!(!clip.report.is_empty());
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn reading_can_be_stopped() {
    let mut loader = loader();
    // Some 40 MB: enough to be stopped on the way.
    let text = arm_text(2_000_000);
    loader.read(bytes("long.bvh", &text), Purpose::Beside);
    loader.jobs()[0].progress.cancel();
    let mut events = Vec::new();
    let start = Instant::now();
    while !loader.jobs().is_empty() {
        events.extend(loader.take_events());
        assert!(start.elapsed() < PATIENCE, "it was not stopped");
        std::thread::sleep(Duration::from_millis(5));
    }
    // Its beginning may have been read by then; the end says that nothing follows.
    let read = |event: &Event| matches!(event, Event::Read { .. });
    assert!(!events.iter().any(read), "{} events", events.len());
    assert!(matches!(
        events.last(),
        Some(Event::GivenUp { message: None, .. })
    ));
}

/// A pipe that nobody writes to, as a disk that does not answer: what is stopped is gone at once, not when the
/// system lets go of it.
#[cfg(unix)]
#[test]
fn a_file_that_never_comes_can_be_stopped() {
    let path = std::env::temp_dir().join(format!("posekit-pipe-{}.bvh", std::process::id()));
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    if !made.is_ok_and(|status| status.success()) {
        eprintln!("skipped: there is no mkfifo");
        return;
    }
    let mut loader = loader();
    loader.read(Input::Path(path.clone()), Purpose::Beside);
    assert!(loader.take_events().is_empty());
    assert_eq!(loader.jobs().len(), 1);
    let progress = Arc::clone(&loader.jobs()[0].progress);
    progress.cancel();
    let events = loader.take_events();
    assert!(matches!(events[..], [Event::GivenUp { message: None, .. }]));
    assert!(loader.jobs().is_empty() && !progress.is_finished());
    // When it comes after all, nobody is told.
    // It may have hung up already: then there is nobody to write to.
    let _written = std::fs::write(&path, arm_text(3));
    let start = Instant::now();
    while !progress.is_finished() {
        assert!(start.elapsed() < PATIENCE, "it does not end");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(loader.take_events().is_empty());
    std::fs::remove_file(&path).expect("removed");
}

#[test]
fn a_large_file_begins_before_it_is_read() {
    let frames = 400_000;
    let path = std::env::temp_dir().join(format!("posekit-begin-{}.bvh", std::process::id()));
    std::fs::write(&path, arm_text(frames)).expect("written");
    let mut loader = loader();
    loader.read(Input::Path(path.clone()), Purpose::Beside);
    let (begun_by, begun) = match wait_first(&mut loader) {
        (Event::Begun { job, clip, .. }, rest) => {
            assert!(clip.frame_count() > 100 && clip.frame_count() < frames);
            (job, rest)
        }
        _ => panic!("the beginning comes first"),
    };
    let whole = begun.into_iter().next();
    match whole.unwrap_or_else(|| wait(&mut loader)) {
        Event::Read { job, clip, .. } => {
            assert_eq!((job, clip.frame_count()), (begun_by, frames));
            assert!(clip.report.is_empty(), "the cut is no fault of the file");
        }
        _ => panic!("the whole follows"),
    }
    std::fs::remove_file(&path).expect("removed");
}

#[test]
fn a_folder_is_looked_at_file_by_file() {
    let folder = std::env::temp_dir().join(format!("posekit-library-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let good = folder.join("good.bvh");
    let bad = folder.join("bad.bvh");
    std::fs::write(&good, arm_text(5)).expect("written");
    std::fs::write(&bad, "nothing").expect("written");
    let mut loader = loader();
    loader.look_at(vec![good.clone().into(), bad.clone().into()]);
    let mut outcomes = Vec::new();
    let start = Instant::now();
    while loader.is_looking() {
        for event in loader.take_events() {
            if let Event::Summary(summary) = event {
                outcomes.push((
                    summary.path.clone(),
                    summary.outcome.map(|n| n.joint_count).ok(),
                ));
            }
        }
        assert!(start.elapsed() < PATIENCE, "it did not end");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(outcomes, [(good, Some(3)), (bad, None)]);
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// As by `posekit view . one.bvh`: a dot is no name, and one file has one path.
#[cfg(unix)]
#[test]
fn a_folder_given_by_a_relative_path_has_a_name_and_lists_nothing_twice() {
    let name = format!("posekit-relative-{}", std::process::id());
    let folder = std::env::temp_dir().join(&name);
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    for file in ["one.bvh", "two.bvh"] {
        std::fs::write(folder.join(file), arm_text(5)).expect("written");
    }
    let here = std::env::current_dir().expect("a folder");
    let mut relative = std::path::PathBuf::new();
    for _ in here.components().skip(1) {
        relative.push("..");
    }
    relative.push(folder.strip_prefix("/").expect("from the root"));
    let mut options = Some(ViewerOptions {
        paths: vec![relative.join("."), relative.join("one.bvh")],
        ..ViewerOptions::default()
    });
    let show = move |ui: &mut egui::Ui, viewer: &mut Option<Viewer>| {
        let viewer = viewer.get_or_insert_with(|| {
            let options = options.take().unwrap_or_default();
            Viewer::new(ui.ctx(), None, &Settings::default(), options)
        });
        viewer.show(ui);
    };
    let mut window = egui_kittest::Harness::builder()
        .with_size(egui::Vec2::new(1000.0, 700.0))
        .build_ui_state(show, None);
    until(&mut window, |viewer| {
        !viewer.is_working() && !viewer.session().clips().is_empty()
    });
    window.get_by_label(&name);
    assert_eq!(viewer(&window).settings().folder.as_deref(), Some(&*folder));
    // One is open, the other is listed.
    for file in ["one.bvh", "two.bvh"] {
        assert_eq!(window.query_all_by_label(file).count(), 1, "{file}");
    }
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_file_of_another_kind_is_told_by_its_kind_and_a_broken_motion_by_its_place() {
    let told = |name: &str, text: &str| {
        let mut loader = loader();
        loader.read(bytes(name, text), Purpose::Beside);
        match wait(&mut loader) {
            Event::Failed { message }
            | Event::GivenUp {
                message: Some(message),
                ..
            } => message,
            other => panic!("{name}: {other:?}"),
        }
    };
    for (name, text) in [
        ("figure.fbx", "Kaydara FBX Binary  \0\u{1a}\0"),
        ("photo.png", "\u{89}PNG\r\n\u{1a}\n\0"),
        ("notes.txt", "walk again on Tuesday"),
        ("nothing", ""),
    ] {
        let message = told(name, text);
        assert!(
            message.starts_with(&format!("{name} is no motion")),
            "{message}"
        );
        assert!(
            message.contains(".bvh") && message.contains(".urdf"),
            "{message}"
        );
        assert!(!message.contains("line"), "{message}");
    }
    let broken = arm_text(3).replacen("OFFSET 0", "OFFSET x", 1);
    for name in ["arm.bvh", "ARM.BVH", "arm.txt", "arm"] {
        let message = told(name, &broken);
        assert!(message.starts_with(&format!("{name}: line ")), "{message}");
    }
    assert!(told("empty.bvh", "").contains("empty file"));
}
