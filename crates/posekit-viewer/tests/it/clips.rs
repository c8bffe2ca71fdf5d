//! Clips that tests are made of.

use posekit::sample::{WalkConfig, walk};
use posekit_viewer::load::read_clip;
use posekit_viewer::state::clip::Clip;
use posekit_viewer::state::session::Session;

/// An arm of two links along Y that turns about Z by 10 degrees a frame, half a second a frame;
/// its root moves along X by 1 a frame. Z comes first in the shoulder's channels.
pub(crate) fn arm_text(frames: usize) -> String {
    let mut text = String::from(
        "HIERARCHY\nROOT Shoulder\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition \
         Zrotation Xrotation Yrotation\n JOINT Elbow\n {\n  OFFSET 0 2 0\n  CHANNELS 3 Zrotation \
         Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 1 0\n  }\n }\n}\nMOTION\n",
    );
    text.push_str(&format!("Frames: {frames}\nFrame Time: 0.5\n"));
    for frame in 0..frames {
        text.push_str(&format!("{frame} 0 0 {} 0 0 0 0 0\n", 10 * frame));
    }
    text
}

/// The arm as a clip.
pub(crate) fn arm(frames: usize) -> Clip {
    read_clip("arm.bvh", arm_text(frames).as_bytes()).expect("a valid file")
}

/// The walking sample.
pub(crate) fn walking() -> Clip {
    let motion = walk(&WalkConfig::default()).expect("the defaults are in range");
    Clip::from_motion("Sample walk", motion)
}

/// A session with the arm open.
pub(crate) fn session() -> Session {
    let mut session = Session::default();
    session.open(arm(10));
    session
}
