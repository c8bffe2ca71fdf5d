//! Everything has its room in windows of every size: the window goes through all its modes and panels, and what
//! was painted is measured.
//!
//! `POSEKIT_LOOK_AT=folder cargo test -p posekit-viewer --test it fits` draws each state into a folder, to be
//! looked at.

mod faults;
mod resize;
mod seen;
mod states;

use std::collections::BTreeSet;

use egui::{Rect, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;
use posekit_viewer::state::display::Look;

use super::window::viewer;
use faults::Loose;
use seen::Watched;

/// Whether the states are drawn, to be looked at.
fn is_drawn() -> bool {
    std::env::var_os("POSEKIT_LOOK_AT").is_some()
}

/// What was found in the states of a window of one size.
struct Tour {
    watched: Watched,
    size: Vec2,
    faults: Vec<String>,
    known: BTreeSet<String>,
    count: usize,
}

impl Tour {
    fn new(watched: Watched, size: Vec2) -> Self {
        Self {
            watched,
            size,
            faults: Vec::new(),
            known: BTreeSet::new(),
            count: 0,
        }
    }

    /// Looks at the window as it is.
    fn look(&mut self, name: &str) {
        self.watched.window.run_steps(3);
        // A panel that grows to what is in it grows with every picture.
        let before = self.view_place();
        self.watched.window.run_steps(2);
        let after = self.view_place();
        if before != after {
            let fault = format!("{name}: the view goes from {before:?} to {after:?} by itself");
            self.faults.push(fault);
        }
        self.look_now(name);
    }

    /// Where the view of the stage, or of a lab, is.
    fn view_place(&self) -> Option<Rect> {
        let mut views = self
            .watched
            .window
            .query_all_by_label_contains("View of the");
        views.next().map(|view| view.rect())
    }

    /// The same without letting time pass.
    fn look_now(&mut self, name: &str) {
        let window = &self.watched.window;
        let seen = self.watched.seen();
        let widgets = seen.widgets(window);
        assert!(!widgets.is_empty() && !seen.layers.is_empty());
        let names = loose_names(window);
        let loose = Loose { names: &names };
        for fault in faults::of(&seen, &widgets, &loose) {
            if self.known.insert(fault.clone()) {
                self.faults.push(format!("{name}: {fault}"));
            }
        }
        self.count += 1;
        self.draw(name);
    }

    fn draw(&mut self, name: &str) {
        let Some(folder) = std::env::var_os("POSEKIT_LOOK_AT") else {
            return;
        };
        super::window::settle(&mut self.watched.window);
        let look = viewer(&self.watched.window).session().look();
        let folder = std::path::PathBuf::from(folder)
            .join(format!("{}x{}-{look:?}", self.size.x, self.size.y));
        std::fs::create_dir_all(&folder).expect("a folder to draw into");
        let picture = self.watched.window.render().expect("the driver draws");
        let name = format!("{:03} {name}.png", self.count).replace([' ', '/'], "-");
        let file = std::fs::File::create(folder.join(name)).expect("written");
        let mut encoder = png::Encoder::new(file, picture.width(), picture.height());
        encoder.set_color(png::ColorType::Rgba);
        let mut writer = encoder.write_header().expect("written");
        writer.write_image_data(picture.as_raw()).expect("written");
    }

    fn end(mut self) {
        let faults = std::mem::take(&mut self.faults);
        let size = self.size;
        assert!(self.count > 30, "the tour was cut short: {}", self.count);
        let many = faults.len();
        assert!(many == 0, "{many} faults at {size}:\n{}", faults.join("\n"));
    }
}

/// What was found until the tour came to a sudden end is told, too.
impl Drop for Tour {
    fn drop(&mut self) {
        if std::thread::panicking() && !self.faults.is_empty() {
            eprintln!("until then at {}:\n{}", self.size, self.faults.join("\n"));
        }
    }
}

/// What is written at places of the world: names of joints, cameras, lights, props, angles, the tips on the
/// sphere. They go where those go, over each other and out of the view.
fn loose_names(window: &super::window::Window) -> BTreeSet<String> {
    let session = viewer(window).session();
    let mut names: BTreeSet<String> = ["t1", "t2", "start", "end"].map(str::to_owned).into();
    for open in session.clips() {
        let skeleton = open.clip.skeleton();
        names.extend(
            skeleton
                .joints()
                .map(|joint| skeleton.unique_name(joint).to_owned()),
        );
    }
    names
}

fn tour(size: Vec2, scale: f32, look: Look) {
    let watched = Watched::new(states::inputs(), size, scale, look);
    let mut tour = Tour::new(watched, size);
    states::all(&mut tour);
    tour.end();
}

#[test]
fn in_a_large_window() {
    tour(vec2(1280.0, 800.0), 1.0, Look::Light);
}

#[test]
fn at_800_by_600() {
    tour(vec2(800.0, 600.0), 1.0, Look::Dark);
}

#[test]
fn at_960_by_540_points_of_a_fine_screen() {
    tour(vec2(960.0, 540.0), 2.0, Look::Light);
}

#[test]
fn at_480_by_400() {
    tour(vec2(480.0, 400.0), 1.0, Look::Light);
}

#[test]
fn on_an_upright_phone() {
    tour(vec2(390.0, 844.0), 2.0, Look::Light);
}
