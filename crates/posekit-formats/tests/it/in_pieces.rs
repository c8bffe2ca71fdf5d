//! Long motions in little memory: parts of a scene, and files that are written a piece at a time.

use std::io;

use posekit::motion::{FrameTime, Motion};
use posekit::rotation::EulerOrder;
use posekit_formats::arrays::MotionArrays;
use posekit_formats::bvh::edit::{EditError, scale};
use posekit_formats::bvh::{Bvh, WriteOptions, write, write_motion_to};
use posekit_formats::csv;
use posekit_formats::scene::{self, AUTHORED_WALK, FileMotion, MotionFileError, Shot};

/// The walk that is authored in keys, which needs no other file.
fn shot() -> Shot {
    let scene = scene::read(AUTHORED_WALK.as_bytes()).unwrap();
    let none = |_: &str| Err::<FileMotion, _>(MotionFileError("no file".to_owned()));
    Shot::new(&scene, none).unwrap()
}

#[test]
fn some_frames_of_a_scene_are_those_of_all() {
    let shot = shot();
    for rate in [None, Some(FrameTime::of_fps(7))] {
        let whole = shot.bake(rate);
        assert_eq!(shot.frame_count(rate), whole.frame_count());
        let chosen = [5, 0, 3, 3, whole.frame_count() - 1];
        let part = shot.bake_frames(rate, chosen.into_iter());
        assert_eq!(part.frame_count(), chosen.len());
        for (place, frame) in chosen.into_iter().enumerate() {
            assert_eq!(part.pose(place), whole.pose(frame), "{rate:?} {frame}");
        }
        assert_eq!(shot.bake_frames(rate, 0..0).frame_count(), 0);
    }
}

/// A motion in pieces of so many frames.
fn pieces(shot: &Shot, frames: usize) -> impl Iterator<Item = Motion> {
    let count = shot.frame_count(None);
    (0..count)
        .step_by(frames)
        .map(move |first| shot.bake_frames(None, first..(first + frames).min(count)))
}

#[test]
fn a_file_written_in_pieces_is_the_same_file() {
    let shot = shot();
    let count = shot.frame_count(None);
    let head = shot.bake_frames(None, 0..0);
    for order in [EulerOrder::ZXY, EulerOrder::XYZ] {
        let whole = write(&Bvh::from_motion(&shot.bake(None), order));
        for frames in [1, 10, count, 3 * count] {
            let mut text = Vec::new();
            let options = WriteOptions::default();
            write_motion_to(
                &head,
                count,
                pieces(&shot, frames),
                order,
                options,
                &mut text,
            )
            .unwrap();
            assert!(text == whole, "{order} in pieces of {frames}");
        }
    }
    let too_many = count + 1;
    let options = WriteOptions::default();
    let order = EulerOrder::ZXY;
    let error = write_motion_to(
        &head,
        too_many,
        pieces(&shot, 10),
        order,
        options,
        io::sink(),
    );
    assert_eq!(error.unwrap_err().kind(), io::ErrorKind::InvalidInput);
}

#[test]
fn arrays_of_a_part_have_the_numbers_and_times_of_the_whole() {
    let shot = shot();
    let whole = shot.bake(None).to_global();
    let joints: Vec<_> = whole.skeleton().joints().collect();
    let table = |motion, frames: &[usize], numbers| {
        let mut text = Vec::new();
        let arrays = MotionArrays {
            motion,
            joints: &joints,
            frames,
            numbers,
            points: &[],
        };
        csv::write(&arrays, &mut text).unwrap();
        String::from_utf8(text).unwrap()
    };
    let part = shot.bake_frames(None, [4, 9].into_iter()).to_global();
    let of_part = table(&part, &[0, 1], Some(&[4, 9]));
    assert_eq!(of_part, table(&whole, &[4, 9], None));
}

#[test]
fn a_scale_beyond_all_numbers_names_the_length() {
    let mut bvh = Bvh::from_motion(&shot().bake_frames(None, 0..1), EulerOrder::ZXY);
    bvh.joints[1].offset = [0.0, 1e300, 0.0];
    let before = bvh.clone();
    let error = scale(&mut bvh, 1e10).unwrap_err();
    let (factor, length) = (1e10, 1e300);
    assert_eq!(error, EditError::TooLarge { factor, length });
    let text = error.to_string();
    assert!(text.contains("1e300") && text.contains("1.797"), "{text}");
    assert_eq!(bvh, before);
}
