//! Every real motion file can be opened, shown and inspected. Skips where the data is missing.

use std::path::Path;

use posekit_render::cpu::CpuRenderer;
use posekit_viewer::load::read_clip;
use posekit_viewer::state::readout::readout;
use posekit_viewer::state::session::Session;

/// The names of the real files: more may be put beside them.
const REAL_FILES: &str = include_str!("../../../posekit-formats/tests/real_files.txt");

#[test]
fn every_real_file_is_shown_in_the_picture() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        eprintln!("skipped: {} is missing", folder.display());
        return;
    }
    let mut renderer = CpuRenderer::new(std::num::NonZeroUsize::MIN);
    for file in REAL_FILES.lines().map(|name| folder.join(name)) {
        let name = file.display().to_string();
        let bytes = std::fs::read(&file).expect("the file is readable");
        let clip = read_clip(&name, &bytes).expect("a real file opens");
        let mut session = Session::default();
        session.open(clip);
        session.transport.pause();
        let middle = session.transport.last_frame() / 2;
        session.transport.go_to_frame(middle);
        all_joints_are_in_the_picture(&session, &name);
        something_is_drawn(&mut renderer, &session, &name);
        let clip = session.active_clip().expect("it is open");
        for joint in clip.skeleton().joints() {
            let numbers = readout(clip, joint, session.transport.time_secs(), 0.0);
            assert!(
                numbers.position.is_finite() && numbers.local.vector_deg.is_finite(),
                "{name}"
            );
        }
    }
}

fn all_joints_are_in_the_picture(session: &Session, name: &str) {
    let camera = session.view_camera();
    for (_, pose) in session.poses_on_stage() {
        for position in pose.positions {
            let place = camera.project(position, (1600, 900));
            let inside = place
                .is_some_and(|p| (0.0..=1600.0).contains(&p.x) && (0.0..=900.0).contains(&p.y));
            assert!(inside, "{name}: {position} is at {place:?}");
        }
    }
}

fn something_is_drawn(renderer: &mut CpuRenderer, session: &Session, name: &str) {
    let mut empty = session.scene();
    let full = renderer.render(&session.scene(), 160, 90);
    empty.models.clear();
    let empty = renderer.render(&empty, 160, 90);
    let differs = full
        .as_rgba()
        .chunks(4)
        .zip(empty.as_rgba().chunks(4))
        .filter(|(a, b)| a != b)
        .count();
    assert!(differs > 100, "{name}: {differs} pixels");
}
