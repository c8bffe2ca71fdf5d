//! Scenes as files: opened with what they name, refused with the place, recovered after a fall, asked about
//! before they are closed.

use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use posekit_formats::scene::{self, Scene};
use posekit_viewer::load::Input;
use posekit_viewer::state::clip::Source;
use posekit_viewer::state::display::Look;
use posekit_viewer::state::settings::Settings;
use posekit_viewer::{Viewer, ViewerOptions};

use super::animate::{authored, blank, block_three_poses, folder, save_to};
use super::window::{Window, laptop, press, settle, until, viewer};

#[test]
fn scenes_without_a_folder_take_the_files_along_that_came_with_them() {
    let mut scene = Scene::new(scene::SkeletonSource::File("arm.bvh".into()));
    scene.title = "arm".into();
    let named = |name: &str, bytes: Vec<u8>| Input::Bytes {
        name: name.into(),
        bytes: bytes.into(),
    };
    let text = scene::write(&scene).unwrap();
    let arm = super::clips::arm_text(4).into_bytes();
    let inputs = vec![
        named("shot.posekit.toml", text.clone()),
        named("arm.bvh", arm.clone()),
        named("other.bvh", arm),
    ];
    let mut window = laptop(inputs);
    until(&mut window, |viewer| viewer.session().clips().len() == 2);
    let names: Vec<_> = viewer(&window)
        .session()
        .clips()
        .iter()
        .map(|open| open.clip.name.clone())
        .collect();
    assert_eq!(names, ["shot.posekit.toml", "other.bvh"]);
    assert_eq!(authored(&window).scene(), &scene);
    let alone = laptop(vec![named("shot.posekit.toml", text)]);
    let told = viewer(&alone).notices().shown();
    assert!(told.iter().any(|notice| notice.text.contains("arm.bvh")));
}

#[test]
fn what_is_wrong_with_a_scene_is_told_with_its_place() {
    let text = "format = \"posekit scene\"\nversion = 1\nframes = 30\n[skeleton]\nfile = \"sample:walk\"\n";
    let input = Input::Bytes {
        name: "bad.posekit.toml".into(),
        bytes: text.as_bytes().into(),
    };
    let window = laptop(vec![input]);
    let told = viewer(&window).notices().shown();
    let has_place = |text: &str| text.contains("bad.posekit.toml:3:1: unknown field `frames`");
    assert!(
        told.iter().any(|notice| has_place(&notice.text)),
        "{told:?}"
    );
}

#[test]
fn what_the_reader_of_a_named_file_noticed_is_told_and_stays() {
    let named = |name: &str, text: &str| Input::Bytes {
        name: name.into(),
        bytes: text.as_bytes().into(),
    };
    let scene = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nskeleton = { file = \"rig.gltf\" }\nmotion = [{ file = \"rig.gltf\" }]\n";
    let rig = r#"{"asset": {"version": "2.0"}, "nodes": [{"name": "a", "children": [1]}, {"name": "b", "translation": [0, 1, 0]}],
        "animations": [{"samplers": [{"input": 0, "output": 1}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 1}, {"bufferView": 0, "componentType": 5126, "type": "VEC4", "count": 1}],
        "bufferViews": [{"buffer": 0, "byteLength": 16}], "buffers": [{"byteLength": 16, "uri": "gone.bin"}]}"#;
    let window = laptop(vec![
        named("shot.posekit.toml", scene),
        named("rig.gltf", rig),
    ]);
    let told = viewer(&window).notices().shown();
    let wanted = "rig.gltf: buffers[0]: buffer 0 (`gone.bin`) is missing";
    assert!(
        told.iter().any(|notice| notice.text.contains(wanted)),
        "{told:?}"
    );
    let clip = &viewer(&window).session().clips()[0].clip;
    let codes: Vec<_> = clip.report.warnings.iter().map(|w| w.code.code()).collect();
    assert_eq!(codes, ["missing-buffer", "unreadable-track"]);
    let shown = window.query_all_by_label_contains("gone.bin");
    assert!(shown.count() > 0);
}

/// A window that keeps what is not saved in a folder.
fn kept_in(folder: &Path, inputs: Vec<Input>) -> Window {
    let mut options = Some(ViewerOptions {
        inputs,
        kept_in: Some(folder.to_owned()),
        ..ViewerOptions::default()
    });
    let settings = Settings {
        look: Look::Dark,
        ..Settings::default()
    };
    let mut window = Harness::builder()
        .with_size(Vec2::new(1366.0, 768.0))
        .build_ui_state(
            move |ui: &mut egui::Ui, viewer: &mut Option<Viewer>| {
                let viewer = viewer.get_or_insert_with(|| {
                    let options = options.take().unwrap_or_default();
                    Viewer::new(ui.ctx(), None, &settings, options)
                });
                viewer.show(ui);
            },
            None,
        );
    until(&mut window, |viewer| !viewer.is_working());
    window
}

#[test]
fn what_a_run_left_that_fell_over_is_opened_again() {
    let folder = folder("kept");
    let mut window = kept_in(&folder, vec![Input::Sample("walk".into())]);
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::A);
    window.get_by_label("Blank, from this pose").click();
    settle(&mut window);
    block_three_poses(&mut window, ["LeftUpperArm", "RightUpperLeg"]);
    let lost = authored(&window).scene().clone();
    let kept = || {
        let listing = std::fs::read_dir(&folder).expect("a folder").flatten();
        let names = listing.map(|item| item.file_name().to_string_lossy().into_owned());
        names
            .filter(|name| name.ends_with("toml"))
            .collect::<Vec<_>>()
    };
    // Some seconds of the window's clock later it is kept.
    for _ in 0..600 {
        window.step();
        if !kept().is_empty() {
            break;
        }
    }
    window.run_steps(60);
    assert_eq!(kept().len(), 1);
    // Another window beside it offers nothing: the first one lives.
    let beside = kept_in(&folder, Vec::new());
    assert!(!viewer(&beside).is_asking());
    drop(beside);
    // The run falls over: nobody holds its lock any more, what it kept stays.
    let left = kept()[0].clone();
    let text = std::fs::read(folder.join(&left)).expect("kept");
    drop(window);
    assert!(kept().is_empty(), "who ends in good order leaves nothing");
    std::fs::write(folder.join(&left), text).expect("as after a fall");

    let mut again = kept_in(&folder, Vec::new());
    assert!(viewer(&again).is_asking());
    again.get_by_label("Open again").click();
    until(&mut again, |viewer| {
        !viewer.is_asking() && viewer.session().authored().is_some()
    });
    assert_eq!(authored(&again).scene(), &lost);
    assert!(authored(&again).is_dirty());
    assert_eq!(kept().len(), 1, "it is kept as this run's now");
    assert_ne!(kept()[0], left);
    drop(again);
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// Closes the clip in the list: its button is there while the pointer is over it.
fn close_clip(window: &mut Window) {
    let clip = viewer(window).session().active_clip().expect("open");
    let row = window
        .get_by_role_and_label(Role::Button, &clip.name)
        .rect();
    window.hover_at(row.center());
    window.run_steps(2);
    window.get_by_label("Close").click();
    window.run_steps(5);
}

#[test]
fn closing_asks_where_something_is_not_saved() {
    let mut window = blank(Input::Sample("walk".into()));
    block_three_poses(&mut window, ["LeftUpperArm", "RightUpperLeg"]);
    assert!(viewer(&window).title().starts_with("* "));
    let path = folder("closing").join("shot");
    save_to(&mut window, &path);
    let title = viewer(&window).title();
    assert_eq!(title, "shot.posekit.toml \u{2013} posekit");
    let source = viewer(&window)
        .session()
        .active_clip()
        .expect("open")
        .source
        .clone();
    let Source::Scene(Some(saved)) = source else {
        panic!("it has a file");
    };
    assert!(saved.ends_with("shot.posekit.toml"));
    press(&mut window, Modifiers::COMMAND, Key::Z);
    let info = window.input_mut().viewports.entry(egui::ViewportId::ROOT);
    info.or_default().events.push(egui::ViewportEvent::Close);
    window.run_steps(5);
    assert!(viewer(&window).is_asking(), "the window, too, asks");
    window.get_by_label("Cancel").click();
    window.run_steps(3);
    close_clip(&mut window);
    assert!(viewer(&window).is_asking());
    window.get_by_label("Cancel").click();
    window.run_steps(2);
    assert_eq!(viewer(&window).session().clips().len(), 1);
    close_clip(&mut window);
    window.get_by_label("Do not save").click();
    window.run_steps(2);
    assert!(viewer(&window).session().clips().is_empty());
    std::fs::remove_file(saved).expect("it was saved once");
}
