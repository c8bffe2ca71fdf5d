//! Files that go out: the range as BVH.

use posekit_viewer::load::read_clip;
use posekit_viewer::state::session::Session;
use posekit_viewer::work::export::{ExportOptions, Take};
use posekit_viewer::work::files::{range_document, range_parcel, stem_of};

use super::clips::{arm, walking};

#[test]
fn the_range_is_saved_to_the_digit() {
    let clip = arm(10);
    let parcel = range_parcel(&clip, (3, 6)).expect("a valid document");
    assert_eq!(parcel.name, "arm_3-6.bvh");
    let again = read_clip("again", &parcel.bytes).expect("what we write we read");
    let (before, after) = (clip.document, again.document);
    assert_eq!(after.frame_count(), 4);
    for frame in 0..4 {
        assert_eq!(after.row(frame), before.row(frame + 3));
    }
    assert_eq!(after.joints, before.joints);
}

#[test]
fn a_range_beyond_the_clip_is_cut() {
    let document = range_document(&arm(10), (8, 99));
    assert_eq!(document.frame_count(), 2);
    assert_eq!(range_document(&arm(0), (0, 0)).frame_count(), 0);
}

#[test]
fn a_sample_is_saved_as_a_file_that_moves_the_same() {
    let clip = walking();
    let last = clip.frame_count() - 1;
    let parcel = range_parcel(&clip, (0, last)).expect("a valid document");
    assert_eq!(parcel.name, "Sample_walk.bvh");
    let again = read_clip("again", &parcel.bytes).expect("what we write we read");
    for joint in clip.skeleton().joints() {
        let (a, b) = (
            clip.global.position(30, joint),
            again.global.position(30, joint),
        );
        assert!(a.distance(b) < 1e-4, "{a} {b}");
    }
}

#[test]
fn names_are_fit_for_files() {
    assert_eq!(stem_of("a/b:c.bvh"), "a_b_c");
    assert_eq!(stem_of(""), "clip");
}

#[test]
fn a_video_shows_the_range_at_the_speed_played() {
    let mut session = Session::default();
    session.open(arm(11));
    session.transport.set_range(2, 6);
    session.transport.set_speed(2.0);
    let options = ExportOptions {
        fps: 30,
        ..ExportOptions::default()
    };
    let take = Take::of(&session, &options);
    // Two seconds of motion, played in one, at 30 frames a second, ends included.
    let times = &take.film().times_secs;
    assert_eq!(times.len(), 31);
    assert!((times[0] - 1.0).abs() < 1e-9 && (times[30] - 3.0).abs() < 1e-9);
    assert_eq!(take.scene(1.0).models.len(), 1);
}

#[test]
fn a_video_is_written_whole_or_not_at_all() {
    use posekit_viewer::work::files::write_beside;
    let folder = std::env::temp_dir().join(format!("posekit-viewer-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join("out.bin");
    std::fs::write(&path, b"old").expect("written");
    let failed = write_beside(&path, |file| {
        std::io::Write::write_all(file, b"half")?;
        Err(std::io::Error::other("stopped"))
    });
    assert!(failed.is_err());
    assert_eq!(std::fs::read(&path).expect("read"), b"old");
    write_beside(&path, |file| std::io::Write::write_all(file, b"new")).expect("written");
    assert_eq!(std::fs::read(&path).expect("read"), b"new");
    assert_eq!(
        std::fs::read_dir(&folder).expect("listed").count(),
        1,
        "nothing is left beside"
    );
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn a_video_is_exported_in_the_background() {
    use posekit_viewer::load::{Event, Loader};
    use posekit_viewer::work::export::{ExportSize, VideoFormat, start};
    let mut session = Session::default();
    session.open(arm(2));
    let options = ExportOptions {
        format: VideoFormat::Gif,
        size: ExportSize::Small,
        fps: 24,
        ..ExportOptions::default()
    };
    let take = Take::of(&session, &options);
    let frames = take.frame_count();
    let path = std::env::temp_dir().join(format!("posekit-video-{}.gif", std::process::id()));
    let mut loader = Loader::new(&egui::Context::default());
    let running = start(take, options.format, path.clone(), loader.outbox());
    let began = std::time::Instant::now();
    while !running.is_finished() {
        assert!(began.elapsed().as_secs() < 120, "it does not end");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    std::thread::sleep(std::time::Duration::from_millis(50));
    assert_eq!(running.frames(), (frames, frames));
    let events = loader.take_events();
    assert!(
        matches!(events.as_slice(), [Event::Written { .. }]),
        "{events:?}"
    );
    let bytes = std::fs::read(&path).expect("the video is there");
    assert!(bytes.starts_with(b"GIF89a"));
    std::fs::remove_file(&path).expect("removed");
}

#[test]
fn a_cancelled_video_leaves_nothing() {
    use posekit_viewer::load::Loader;
    use posekit_viewer::work::export::{VideoFormat, start};
    let mut session = Session::default();
    session.open(walking());
    let options = ExportOptions {
        format: VideoFormat::Apng,
        ..ExportOptions::default()
    };
    let folder = std::env::temp_dir().join(format!("posekit-cancelled-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let mut loader = Loader::new(&egui::Context::default());
    let take = Take::of(&session, &options);
    let running = start(
        take,
        options.format,
        folder.join("out.png"),
        loader.outbox(),
    );
    running.cancel();
    let began = std::time::Instant::now();
    while !running.is_finished() {
        assert!(began.elapsed().as_secs() < 120, "it does not end");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(loader.take_events().is_empty());
    assert_eq!(std::fs::read_dir(&folder).expect("listed").count(), 0);
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
#[cfg(unix)]
fn what_the_system_refuses_is_said_in_plain_words() {
    use posekit_viewer::load::{Event, Loader};
    use posekit_viewer::work::export::{VideoFormat, start};
    let mut session = Session::default();
    session.open(arm(2));
    let options = ExportOptions {
        format: VideoFormat::Gif,
        ..ExportOptions::default()
    };
    let file = std::env::temp_dir().join(format!("posekit-in-the-way-{}", std::process::id()));
    std::fs::write(&file, "a file").expect("a temporary file");
    let path = file.join("out.gif");
    let mut loader = Loader::new(&egui::Context::default());
    let take = Take::of(&session, &options);
    let running = start(take, options.format, path.clone(), loader.outbox());
    let began = std::time::Instant::now();
    let mut events = Vec::new();
    while events.is_empty() {
        assert!(began.elapsed().as_secs() < 120, "it does not end");
        std::thread::sleep(std::time::Duration::from_millis(10));
        events = loader.take_events();
    }
    assert!(running.is_finished());
    let [Event::Failed { message }] = events.as_slice() else {
        panic!("{events:?}");
    };
    let why = "not saved: part of this path is a file, not a folder";
    assert_eq!(*message, format!("{}: {why}", path.display()));
    std::fs::remove_file(&file).expect("removed");
}
