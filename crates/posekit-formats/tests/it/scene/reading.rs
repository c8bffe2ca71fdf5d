//! What the fields of a file mean.

use glam::DVec3;
use posekit::keyframe::{Extrapolation, Interpolation, Property, Tangents};
use posekit_formats::scene::{self, JointValues, SkeletonSource};

use super::{NOD, nod};

#[test]
fn a_file_of_version_1_reads_as_it_was_meant() {
    let scene = nod();
    assert_eq!(
        (scene.title.as_str(), scene.frames_per_sec),
        ("A nod", 24.0)
    );
    assert_eq!(scene.range_secs, [0.0, 2.5]);
    let skeleton = scene.skeleton.inline_skeleton().unwrap().unwrap();
    assert_eq!(skeleton.joint_count(), 3);
    assert!(skeleton.is_end_site(skeleton.find("Top").unwrap()));
    assert_eq!(scene.motions[0].clip_secs, Some([0.25, 1.5]));
    let JointValues::Translation(body) = &scene.tracks[0].values else {
        panic!("a translation");
    };
    assert_eq!(body.after(), Extrapolation::CycleWithOffset);
    assert_eq!(body.keys()[0].tangents, Tangents::Smooth);
    assert_eq!(body.keys()[1].tangents, Tangents::Aligned(DVec3::Z));
    assert_eq!(body.keys()[0].interpolation, Interpolation::Cubic);
    let JointValues::Rotation { track, euler } = &scene.tracks[1].values else {
        panic!("a rotation");
    };
    let euler = euler.as_ref().unwrap();
    assert_eq!(euler.order.to_string(), "ZXY");
    assert_eq!(euler.angles_deg[1], [0.0, 35.0, 370.0]);
    let expected = euler
        .order
        .to_quat([0.0, 35_f64.to_radians(), 370_f64.to_radians()]);
    assert_eq!(track.keys()[1].value, expected);
    assert_eq!(track.keys()[1].tangents, Tangents::Flat);
    assert!(matches!(track.keys()[3].tangents, Tangents::Broken { .. }));
    assert_eq!(
        scene.cameras[0].view.vertical_fov_deg,
        Property::Fixed(35.0)
    );
    assert_eq!(scene.cameras[0].view.target.at(1.0).y, 1.0);
    assert_eq!(scene.lights[0].shine.strength.at(1.0), 1.0);
    assert_eq!(scene.props[0].transform.scale.at(0.0), DVec3::splat(0.5));
}

#[test]
fn a_byte_order_mark_and_crlf_do_no_harm() {
    let text = format!("\u{feff}{}", NOD.replace('\n', "\r\n"));
    assert_eq!(scene::read(text.as_bytes()).unwrap(), nod());
}

#[test]
fn the_least_scene_has_defaults() {
    let text = "format = \"posekit scene\"\nversion = 1\nskeleton = { file = \"walk.bvh\" }\n";
    let scene = scene::read(text.as_bytes()).unwrap();
    assert_eq!(
        scene,
        scene::Scene::new(SkeletonSource::File("walk.bvh".into()))
    );
    assert_eq!(scene.files(), ["walk.bvh"]);
}

#[test]
fn names_of_scenes_are_told_by_their_ending() {
    assert!(scene::is_scene_name("a/shot.POSEKIT.toml"));
    assert!(!scene::is_scene_name("posekit.toml"));
    assert!(!scene::is_scene_name("shot.bvh"));
}
