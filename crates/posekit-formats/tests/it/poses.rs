//! Files of saved poses: what is written reads back, what is wrong is told with its place.

use glam::{DQuat, DVec3};
use posekit_formats::poses::{SavedJoint, SavedPose, is_poses_name, read, write};
use posekit_formats::scene::SceneProblemKind;
use proptest::prelude::*;

fn joint() -> impl Strategy<Value = SavedJoint> {
    let number = -1.0..1.0f64;
    let quaternion = [
        number.clone(),
        number.clone(),
        number.clone(),
        number.clone(),
    ]
    .prop_map(DQuat::from_array)
    .prop_filter("a direction", |q| q.length() > 0.1)
    .prop_map(|q| q.normalize());
    let place = [-1e3..1e3f64, -1e3..1e3f64, -1e3..1e3f64].prop_map(DVec3::from_array);
    ("\\PC*", quaternion, prop::option::of(place)).prop_map(|(name, rotation, translation)| {
        SavedJoint {
            name,
            rotation,
            translation,
        }
    })
}

proptest! {
    #[test]
    fn what_is_written_reads_back_to_the_bit(
        poses in prop::collection::vec(
            ("\\PC*", 0.01..1e4f64, prop::collection::vec(joint(), 1..5)),
            0..4,
        )
    ) {
        let poses: Vec<SavedPose> = poses
            .into_iter()
            .map(|(name, height, joints)| SavedPose { name, height, joints })
            .collect();
        let bytes = write(&poses);
        let again = read(&bytes).expect("it is well formed");
        prop_assert_eq!(&again, &poses);
        prop_assert_eq!(write(&again), bytes);
    }

    #[test]
    fn no_text_makes_it_panic(text in "\\PC*") {
        let _ = read(text.as_bytes());
        let _ = read(format!("format = \"posekit poses\"\nversion = 1\n{text}").as_bytes());
    }
}

fn problems(text: &str) -> Vec<(SceneProblemKind, usize, String)> {
    let error = read(text.as_bytes()).expect_err("it is wrong");
    let told = error.problems.into_iter();
    told.map(|problem| (problem.kind, problem.location.line, problem.path))
        .collect()
}

#[test]
fn a_newer_file_is_refused_by_its_number() {
    let text = "format = \"posekit poses\"\nversion = 2\nfuture = true\n";
    assert_eq!(
        problems(text),
        [(SceneProblemKind::NewerVersion, 2, "version".to_owned())]
    );
    let scene = "format = \"posekit scene\"\nversion = 1\n";
    assert_eq!(problems(scene)[0].0, SceneProblemKind::NotAScene);
}

#[test]
fn all_that_is_wrong_is_told_at_once() {
    let text = "format = \"posekit poses\"\nversion = 1\n\n[[pose]]\nname = \"A\"\nheight = 0\n\
                joints = [\n  { name = \"Hips\", rotation = [0, 0, 0, 2] },\n  { rotation = [0, 0, 0, 1] },\n]\n";
    let told = problems(text);
    let paths: Vec<&str> = told.iter().map(|problem| problem.2.as_str()).collect();
    assert_eq!(
        paths,
        [
            "pose[0].height",
            "pose[0].joints[0].rotation",
            "pose[0].joints[1]"
        ]
    );
    assert_eq!(told[1].1, 8);
}

#[test]
fn files_are_known_by_the_end_of_their_names() {
    assert!(is_poses_name("walk.poses.toml") && is_poses_name("WALK.POSES.TOML"));
    assert!(!is_poses_name("walk.posekit.toml") && !is_poses_name("poses.toml"));
}

#[test]
fn the_file_of_the_guide_is_one() {
    let page = include_str!("../../../../docs/pose-library.md");
    let (_, rest) = page.split_once("```toml\n").expect("it shows a file");
    let (text, _) = rest.split_once("```").expect("it ends");
    let poses = read(text.as_bytes()).expect("it is one");
    assert_eq!((poses.len(), poses[0].joints.len()), (1, 1));
}
