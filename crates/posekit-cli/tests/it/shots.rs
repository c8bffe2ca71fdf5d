//! A film of the window is what the command makes of the files: frame for frame, byte for byte.

use glam::DVec3;
use posekit_formats::scene::{self, AUTHORED_WALK};
use posekit_render::camera::View;
use posekit_render::cpu;
use posekit_render::output::write_png;
use posekit_viewer::load::read_clip;
use posekit_viewer::state::animate::{Authored, Files, Lane, LaneValue};
use posekit_viewer::state::clip::Clip;
use posekit_viewer::state::display::{Compare, Look, Style};
use posekit_viewer::state::mode::Mode;
use posekit_viewer::state::session::{KeyWhat, NewThing, Session};
use posekit_viewer::work::export::{ExportCamera, ExportOptions, ExportSize, Take};

use crate::harness::Folder;

/// Every style of the window, and what the command calls it.
const STYLES: [(Style, &str); 4] = [
    (Style::Body, "body"),
    (Style::Bones, "bones"),
    (Style::Octahedra, "octahedra"),
    (Style::Lines, "lines"),
];

const SIZE: ExportSize = ExportSize::Small;

fn display(
    session: &mut Session,
    change: impl FnOnce(&mut posekit_viewer::state::display::Display),
) {
    let mut display = session.display().clone();
    change(&mut display);
    session.set_display(display);
}

/// The frames of a film that the window would export, as PNG files.
fn frames_of_window(session: &Session, camera: ExportCamera) -> Vec<Vec<u8>> {
    let options = ExportOptions {
        size: SIZE,
        camera,
        ..ExportOptions::default()
    };
    let take = Take::of(session, &options);
    let (width, height) = SIZE.pixels();
    let frame = |time: &f64| {
        let mut bytes = Vec::new();
        let image = cpu::render(&take.scene(*time), width, height);
        write_png(&image, &mut bytes).unwrap();
        bytes
    };
    take.film().times_secs.iter().map(frame).collect()
}

/// The frames of the command's film of a file, with these options beside.
fn frames_of_command(
    folder: &Folder,
    file: &str,
    last_frame: usize,
    args: &[&str],
) -> Vec<Vec<u8>> {
    let (width, height) = SIZE.pixels();
    let size = format!("{width}x{height}");
    let frames = format!("0..{}", last_frame + 1);
    let mut all = vec!["render", file, "-o", "frames/f_####.png", "--quiet"];
    all.extend(["--renderer", "cpu", "--size", &size]);
    all.extend(["--frames", &frames, "--fps", "30"]);
    all.extend(args);
    let path = folder.path().join("frames");
    let _there_may_be_none = std::fs::remove_dir_all(&path);
    folder.succeed(&all);
    let mut names: Vec<_> = std::fs::read_dir(&path)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    names.sort();
    names
        .iter()
        .map(|name| std::fs::read(name).unwrap())
        .collect()
}

fn assert_same(of_window: &[Vec<u8>], of_command: &[Vec<u8>], what: &str) {
    assert_eq!(
        of_window.len(),
        of_command.len(),
        "{what}: number of frames"
    );
    assert!(of_window.len() > 1, "{what}: a film, not a picture");
    for (index, (window, command)) in of_window.iter().zip(of_command).enumerate() {
        assert!(window == command, "{what}: frame {index} differs");
    }
}

// --- A scene by its own camera ---

fn open_scene(session: &mut Session, name: &str) {
    let walk = scene::read(AUTHORED_WALK.as_bytes()).unwrap();
    let authored = Authored::new(walk, Files::new()).unwrap();
    let id = session.open(Clip::from_motion(name, authored.bake()));
    session.put_authored(id, authored);
    session.transport.pause();
}

/// The authored walk as the last of several clips, with a camera of its own that moves, a light and a
/// ball, edited after it was opened.
fn scene_after_others() -> Session {
    let mut session = Session::default();
    session.open(Clip::of_sample("run", "run").unwrap());
    let arm = session.open(Clip::of_sample("arm", "arm").unwrap());
    open_scene(&mut session, "walk");
    session.set_shown(arm, true);
    session.set_mode(Mode::Animate);
    session.transport.go_to_frame(0);
    for what in [NewThing::Camera, NewThing::Light, NewThing::Sphere] {
        session.add_thing(what);
    }
    let mut settings = session.animate();
    settings.auto_key = true;
    session.set_animate(settings);
    let camera = camera_of(&session);
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
    session.insert_keys(KeyWhat::Whole);
    session.transport.set_range(0, 9);
    session
}

fn camera_of(session: &Session) -> usize {
    session.authored().unwrap().scene().cameras.len() - 1
}

#[test]
fn a_shot_is_the_film_of_its_file_whatever_else_is_open_and_shown() {
    let mut session = scene_after_others();
    // What helps at the work, and is no part of the shot.
    display(&mut session, |display| {
        display.labels = true;
        display.axes = true;
        display.trails = true;
        display.ghosts = true;
        display.ghosts_at_keys = false;
    });
    let shot = session.authored().unwrap().scene();
    let name = shot.cameras[camera_of(&session)].name.clone();
    let folder = Folder::with_arm();
    folder.write("shot.posekit.toml", scene::write(shot).unwrap());
    for (style, name_of_style) in STYLES {
        display(&mut session, |display| display.style = style);
        for (look, theme) in [(Look::Light, "light"), (Look::Dark, "dark")] {
            if look == Look::Dark && style != Style::Bones {
                continue;
            }
            session.set_look(look);
            let args = [
                "--camera",
                &name,
                "--style",
                name_of_style,
                "--theme",
                theme,
            ];
            let of_command = frames_of_command(&folder, "shot.posekit.toml", 9, &args);
            let camera = ExportCamera::Scene(camera_of(&session));
            let of_window = frames_of_window(&session, camera);
            assert_same(
                &of_window,
                &of_command,
                &format!("{name_of_style}, {theme}"),
            );
        }
    }
}

/// A pose that is held, and values that are not keyed, are in no file: nor are they in the film.
#[test]
fn what_is_not_keyed_is_not_in_the_film() {
    let mut session = scene_after_others();
    let mut settings = session.animate();
    settings.auto_key = false;
    session.set_animate(settings);
    let before = frames_of_window(&session, ExportCamera::View);
    let light = [(
        Lane::LightColor(0),
        LaneValue::Vector(DVec3::new(0.0, 1.0, 0.0)),
    )];
    session.set_values("Set", &light, None);
    assert!(session.has_pending_pose());
    assert!(before == frames_of_window(&session, ExportCamera::View));
}

// --- Clips as the view shows them ---

/// A session of two files beside each other, of which the second was opened last, seen as the command
/// sees it by itself.
fn two_clips(folder: &Folder) -> Session {
    let mut session = Session::default();
    let (width, height) = SIZE.pixels();
    session.set_aspect(width as f32 / height as f32);
    for name in ["a.bvh", "b.bvh"] {
        session.open(read_clip(name, folder.read(name).as_bytes()).unwrap());
    }
    session
}

fn look_as_the_command(session: &mut Session) {
    display(session, |display| {
        display.follow = posekit_viewer::state::display::FollowMode::Off;
    });
    session.look_from(View::ThreeQuarter);
    session.transport.pause();
    session.transport.set_range(0, 5);
}

fn folder_of_two() -> Folder {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "walk", "-o", "a.bvh"]);
    folder.succeed(&["sample", "run", "-o", "b.bvh"]);
    folder
}

#[test]
fn a_clip_that_was_opened_second_has_the_commands_colours() {
    let folder = folder_of_two();
    let mut session = two_clips(&folder);
    for (style, name) in STYLES {
        display(&mut session, |display| display.style = style);
        // The command frames what is drawn: a body has more around its joints than bones.
        look_as_the_command(&mut session);
        let args = ["--follow=never", "--style", name];
        let of_command = frames_of_command(&folder, "b.bvh", 5, &args);
        let of_window = frames_of_window(&session, ExportCamera::View);
        assert_same(&of_window, &of_command, name);
    }
}

#[test]
fn several_clips_stand_and_are_coloured_as_the_commands_are() {
    let folder = folder_of_two();
    let mut session = two_clips(&folder);
    let ids: Vec<_> = session.clips().iter().map(|open| open.id).collect();
    session.activate(ids[0]);
    session.set_shown(ids[1], true);
    for (compare, option) in [
        (Compare::SideBySide, "--beside"),
        (Compare::Overlaid, "--overlay"),
    ] {
        display(&mut session, |display| display.compare = compare);
        look_as_the_command(&mut session);
        let args = ["--follow=never", option, "b.bvh"];
        let of_command = frames_of_command(&folder, "a.bvh", 5, &args);
        let of_window = frames_of_window(&session, ExportCamera::View);
        assert_same(&of_window, &of_command, option);
    }
}

/// Files in metres and in centimetres: one rule makes the figures equally tall in the window, in its films and in
/// the command's, whichever of them is the active one.
#[test]
fn clips_of_very_different_sizes_are_drawn_as_the_commands_are() {
    let folder = folder_of_two();
    folder.succeed(&["convert", "b.bvh", "cm.bvh", "--scale", "100", "--quiet"]);
    folder.succeed(&["convert", "b.bvh", "tall.bvh", "--scale", "2", "--quiet"]);
    let files = ["a.bvh", "cm.bvh", "tall.bvh"];
    let orders: [[usize; 3]; 2] = [[0, 1, 2], [1, 0, 2]];
    for order in orders {
        let names = order.map(|index| files[index]);
        let mut session = Session::default();
        let (width, height) = SIZE.pixels();
        session.set_aspect(width as f32 / height as f32);
        for name in names {
            session.open_beside(read_clip(name, folder.read(name).as_bytes()).unwrap());
        }
        let ids: Vec<_> = session.clips().iter().map(|open| open.id).collect();
        for active in ids {
            session.activate_among(active);
            for (compare, option) in [
                (Compare::SideBySide, "--beside"),
                (Compare::Overlaid, "--overlay"),
            ] {
                display(&mut session, |display| display.compare = compare);
                look_as_the_command(&mut session);
                let args = ["--follow=never", option, names[1], option, names[2]];
                let of_command = frames_of_command(&folder, names[0], 5, &args);
                let of_window = frames_of_window(&session, ExportCamera::View);
                assert_same(&of_window, &of_command, &format!("{option} of {names:?}"));
            }
        }
    }
}
