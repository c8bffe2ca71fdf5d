//! Files whose up axis and position channels are read in another way than they seem to say.

use glam::Vec3;
use posekit::figure::UpAxis;
use posekit::motion::{PositionPolicies, PositionPolicy};
use posekit_formats::bvh::edit::turn_up;
use posekit_viewer::load::read_clip;
use posekit_viewer::state::clip::{Clip, Reading, check};
use posekit_viewer::state::edit::{Patch, Spread};
use posekit_viewer::state::session::Session;

use crate::clips;

/// The walk in a file that stands on Z.
fn walk_on_z() -> Clip {
    let mut document = (*clips::walking().document).clone();
    turn_up(&mut document, UpAxis::Y, UpAxis::Z);
    read_clip("z.bvh", &posekit_formats::bvh::write(&document)).expect("a valid file")
}

fn height(clip: &Clip) -> Vec3 {
    posekit::figure::body_extent(&clip.motion).expect("frames")
}

#[test]
fn a_figure_that_stands_on_z_is_stood_up_and_its_file_stays() {
    let clip = walk_on_z();
    assert_eq!(clip.reading.up, UpAxis::Z);
    let sides = height(&clip);
    assert!(sides.y > 1.5 * sides.z, "{sides}");
    let mut session = Session::default();
    let id = session.open(clip.clone());
    let as_it_is = Reading {
        up: UpAxis::Y,
        ..clip.reading
    };
    session.set_reading(id, as_it_is);
    let lying = session.clip(id).expect("it is open");
    let sides = height(lying);
    assert!(sides.z > 1.5 * sides.y, "{sides}");
    assert_eq!(lying.document, clip.document);
}

/// What is set on a figure that was stood up is in the file as the file stands.
#[test]
fn an_edit_of_a_stood_figure_is_turned_back_for_the_file() {
    let mut clip = walk_on_z();
    let root = clip.skeleton().roots().next().expect("a root");
    let before = clip.motion.pose(3);
    let mut after = before.clone();
    after.rotations[root.index()] =
        glam::Quat::from_rotation_y(0.5) * before.rotations[root.index()];
    after.translations[root.index()] += Vec3::new(0.1, 0.2, 0.3);
    let only_here = Spread::default();
    let patch = Patch::of_edit(&clip.motion, 3, (&before, &after), only_here).expect("a change");
    patch.write(&mut clip);
    let again = clip.reading.motion_of(&clip.document).expect("a skeleton");
    let (shown, read) = (clip.motion.pose(3), again.pose(3));
    let (a, b) = (shown.rotations[root.index()], read.rotations[root.index()]);
    assert!(a.angle_between(b) < 1e-3);
    let (a, b) = (
        shown.translations[root.index()],
        read.translations[root.index()],
    );
    assert!(a.distance(b) < 1e-4, "{a} {b}");
}

#[test]
fn position_channels_are_read_as_was_said() {
    let text = clips::arm_text(4).replace("OFFSET 0 0 0", "OFFSET 5 0 0");
    let clip = read_clip("arm.bvh", text.as_bytes()).expect("a valid file");
    let root = clip.skeleton().roots().next().expect("a root");
    assert_eq!(clip.motion.translation(1, root), Vec3::new(1.0, 0.0, 0.0));
    let added = Reading {
        positions: PositionPolicies {
            root: PositionPolicy::Add,
            ..PositionPolicies::default()
        },
        ..clip.reading
    };
    let clip = clip.read_as(added).expect("a skeleton");
    assert_eq!(clip.motion.translation(1, root), Vec3::new(6.0, 0.0, 0.0));
    // The checks look at the motion as it is read.
    let _ = check(&clip);
}
