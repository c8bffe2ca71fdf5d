//! A shot of the window is what the command makes of its file.

use glam::DVec3;
use posekit_formats::scene::{self, AUTHORED_WALK};
use posekit_render::cpu;
use posekit_render::output::write_png;
use posekit_viewer::state::animate::{Authored, Files, Lane, LaneValue};
use posekit_viewer::state::clip::Clip;
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{NewThing, Session};
use posekit_viewer::work::export::{ExportCamera, ExportOptions, ExportSize, Take};

use crate::harness::Folder;

/// The authored walk in a session, with a camera of its own that moves, a light and a ball, edited after
/// it was opened.
fn session() -> Session {
    let walk = scene::read(AUTHORED_WALK.as_bytes()).unwrap();
    let authored = Authored::new(walk, Files::new()).unwrap();
    let mut session = Session::default();
    let id = session.open(Clip::from_motion("walk", authored.bake()));
    session.put_authored(id, authored);
    session.set_mode(Mode::Animate);
    session.transport.pause();
    session.transport.go_to_frame(0);
    for what in [NewThing::Camera, NewThing::Light, NewThing::Sphere] {
        session.add_thing(what);
    }
    let mut settings = session.animate();
    settings.auto_key = true;
    session.set_animate(settings);
    let camera = session.authored().unwrap().scene().cameras.len() - 1;
    for (frame, x) in [(0, 2.0), (20, -1.0)] {
        session.transport.go_to_frame(frame);
        let values = [
            (
                Lane::CameraPosition(camera),
                LaneValue::Vector(DVec3::new(x, 1.2, 4.5)),
            ),
            (
                Lane::LightColor(0),
                LaneValue::Vector(DVec3::new(1.0, 0.5, 0.25 * x.abs())),
            ),
        ];
        session.set_values("Set", &values, None);
    }
    session
}

#[test]
fn a_frame_of_the_windows_video_is_the_commands_frame() {
    let session = session();
    let shot = session.authored().unwrap().scene();
    let camera = shot.cameras.len() - 1;
    let folder = Folder::with_arm();
    folder.write("shot.posekit.toml", scene::write(shot).unwrap());
    let options = ExportOptions {
        size: ExportSize::Small,
        camera: ExportCamera::Scene(camera),
        ..ExportOptions::default()
    };
    let take = Take::of(&session, &options);
    let (width, height) = options.size.pixels();
    let size = format!("{width}x{height}");
    let name = shot.cameras[camera].name.clone();
    for frame in [0_u8, 13] {
        let time = f64::from(frame) / shot.frames_per_sec;
        let mut of_window = Vec::new();
        write_png(
            &cpu::render(&take.scene(time), width, height),
            &mut of_window,
        )
        .unwrap();
        let frame = frame.to_string();
        folder.succeed(&[
            "render",
            "shot.posekit.toml",
            "-o",
            "frame.png",
            "--renderer",
            "cpu",
            "--size",
            &size,
            "--camera",
            &name,
            "--frames",
            &frame,
            "--quiet",
        ]);
        let of_command = std::fs::read(folder.path().join("frame.png")).unwrap();
        assert!(of_window == of_command, "frame {frame} differs");
    }
}
