//! Scenes with their files: what plays when.

use std::convert::Infallible;
use std::sync::Arc;

use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::sample;
use posekit_formats::scene::{MotionLayer, Scene, SceneError, Shot, ShotError, SkeletonSource};

use super::nod;

fn sample_motion(path: &str) -> Result<Arc<Motion>, Infallible> {
    let name = path.strip_prefix("sample:").expect("a sample");
    Ok(Arc::new(
        sample::by_name(name).expect("a sample of that name"),
    ))
}

fn pose(shot: &Shot, time_secs: f64) -> LocalPose {
    let mut pose = LocalPose::rest(shot.skeleton());
    shot.sample_into(time_secs, &mut pose);
    pose
}

#[test]
fn motions_play_one_after_the_other_and_keys_go_over_them() {
    let mut scene = Scene::new(SkeletonSource::File("sample:walk".into()));
    let layer = |file: &str, start_secs, clip_secs| MotionLayer {
        file: file.into(),
        start_secs,
        clip_secs,
    };
    scene.motions = vec![
        layer("sample:run", 1.0, None),
        layer("sample:walk", 0.0, Some([0.5, 0.75])),
    ];
    scene.range_secs = [0.0, 2.0];
    scene.frames_per_sec = 60.0;
    let mut asked = Vec::new();
    let shot = Shot::new(&scene, |path| {
        asked.push(path.to_owned());
        sample_motion(path)
    })
    .unwrap();
    assert_eq!(asked, ["sample:walk", "sample:run"], "each file once");
    let [walk, run] = ["walk", "run"].map(|name| sample::by_name(name).unwrap());
    assert_eq!(pose(&shot, -1.0), walk.sample(0.5));
    assert_eq!(pose(&shot, 0.1), walk.sample(0.6));
    assert_eq!(pose(&shot, 0.9), walk.sample(0.75));
    assert_eq!(pose(&shot, 1.2), run.sample(1.2 - 1.0));
    let baked = shot.bake(None);
    assert_eq!(baked.frame_count(), 121);
    let apart = (baked.rotation(72, baked.rotated_joints()[3]))
        .dot(run.rotation(12, run.rotated_joints()[3]));
    assert!(apart.abs() > 0.99999);
    assert_eq!(shot.bake(Some(FrameTime::of_fps(10))).frame_count(), 21);
}

#[test]
fn keyed_joints_take_the_place_of_the_motion() {
    let mut scene = nod();
    scene.skeleton = SkeletonSource::File("sample:walk".into());
    scene.tracks.remove(0);
    let shot = Shot::new(&scene, sample_motion).unwrap();
    let walk = sample::by_name("walk").unwrap();
    let head = walk.skeleton().find("Head").unwrap();
    let posed = pose(&shot, 0.8);
    let track = shot.animation().rotation(head).unwrap();
    assert_eq!(posed.rotations[head.index()], track.sample(0.8).as_quat());
    let others = walk.sample(0.25 + 0.3);
    for joint in walk.skeleton().joints().filter(|&joint| joint != head) {
        let turned = posed.rotations[joint.index()].dot(others.rotations[joint.index()]);
        assert!(turned.abs() > 0.999_999);
    }
}

#[test]
fn a_scene_that_does_not_fit_says_what_does_not() {
    let mut scene = nod();
    scene.skeleton = SkeletonSource::File("sample:arm".into());
    let error = Shot::new(&scene, sample_motion).unwrap_err();
    let ShotError::Scene(SceneError::NoSuchJoint { joint, joints }) = error else {
        panic!("{error}");
    };
    assert_eq!((joint.as_str(), joints[0].as_str()), ("Body", "Base"));
    let mut scene = nod();
    scene.tracks[1].joint = "Top".into();
    assert!(matches!(
        Shot::new(&scene, sample_motion),
        Err(ShotError::Scene(SceneError::EndSiteTurns { .. }))
    ));
}

#[test]
fn motions_that_move_nothing_are_remarked_on() {
    let remarks = |change: &dyn Fn(&mut MotionLayer)| {
        let mut scene = Scene::new(SkeletonSource::File("sample:walk".into()));
        scene.range_secs = [0.0, 2.0];
        let mut layer = MotionLayer {
            file: "sample:walk".into(),
            start_secs: 0.0,
            clip_secs: None,
        };
        change(&mut layer);
        scene.motions.push(layer);
        Shot::new(&scene, sample_motion).unwrap().remarks().to_vec()
    };
    assert!(remarks(&|_| ()).is_empty());
    assert!(remarks(&|layer| layer.clip_secs = Some([1.0, 4.34])).is_empty());
    for (change, wanted) in [
        (
            &(|layer: &mut MotionLayer| layer.file = "sample:arm".into())
                as &dyn Fn(&mut MotionLayer),
            "motion[0], sample:arm: no joint of it has the name",
        ),
        (&|layer| layer.start_secs = 3.0, "it starts at 3 s, after"),
        (
            &|layer| layer.clip_secs = Some([1.0, 9.0]),
            "it ends at 4.333 s, and its last pose stays until 9 s",
        ),
        (
            &|layer| layer.clip_secs = Some([5.0, 9.0]),
            "it has nothing from 5 s on",
        ),
    ] {
        let found = remarks(change);
        assert!(found.len() == 1 && found[0].contains(wanted), "{found:?}");
    }
}
