//! The window as it looks, held against pictures that were looked at.
//!
//! They are drawn by egui on a software driver, the figure in them by posekit's CPU back end. After a change that is
//! meant, `POSEKIT_UPDATE_PICTURES=1 cargo test -p posekit-viewer --test it pictures` draws them anew: look at them
//! before they are committed.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::PathBuf;

use egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use posekit_render::render::{Renderer, RendererChoice};
use posekit_viewer::Viewer;
use posekit_viewer::state::display::Look;

use super::window::{Window, input, press, settle, show, until};

/// Drivers round the edges of letters and lines differently: so much of a colour is no difference...
const SAME_COLOR: u8 = 40;

/// ... and so many pixels of a thousand may differ more.
const MOST_PER_THOUSAND: usize = 10;

/// A picture, four bytes a pixel.
#[derive(PartialEq, Eq)]
struct Picture {
    width: u32,
    height: u32,
    rgba: Vec<u8>,
}

/// A small window that can be drawn, paused at its first frame; `None` where there is no driver at all.
fn drawn_window(look: Look) -> Option<Window> {
    if Renderer::new(RendererChoice::Gpu).is_err() {
        eprintln!("skipped: there is no graphics driver, not even a software one");
        return None;
    }
    let mut window = Harness::builder()
        .with_size(Vec2::new(1200.0, 720.0))
        .wgpu()
        .build_ui_state(show(vec![input("arm.bvh", 20)], look), None);
    until(&mut window, |viewer: &Viewer| !viewer.is_working());
    press(&mut window, Modifiers::NONE, Key::Space);
    press(&mut window, Modifiers::NONE, Key::Home);
    Some(window)
}

fn golden_path(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/pictures");
    PathBuf::from(folder).join(format!("{name}.png"))
}

fn read(path: &PathBuf) -> Picture {
    let file = File::open(path).expect("the picture is in the repository");
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .expect("a PNG file");
    let mut rgba = vec![0; reader.output_buffer_size().expect("a small picture")];
    let info = reader.next_frame(&mut rgba).expect("a whole PNG file");
    Picture {
        width: info.width,
        height: info.height,
        rgba,
    }
}

fn write(path: &PathBuf, picture: &Picture) {
    let file = BufWriter::new(File::create(path).expect("the folder is there"));
    let mut encoder = png::Encoder::new(file, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("written");
    writer.write_image_data(&picture.rgba).expect("written");
}

/// How many pixels differ more than a driver may.
fn differing(a: &Picture, b: &Picture) -> usize {
    let pixels = a.rgba.chunks_exact(4).zip(b.rgba.chunks_exact(4));
    pixels
        .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > SAME_COLOR))
        .count()
}

fn assert_looks_like(window: &mut Window, name: &str) {
    settle(window);
    let drawn = window.render().expect("the driver draws");
    let drawn = Picture {
        width: drawn.width(),
        height: drawn.height(),
        rgba: drawn.into_raw(),
    };
    let path = golden_path(name);
    if std::env::var_os("POSEKIT_UPDATE_PICTURES").is_some() {
        write(&path, &drawn);
    }
    let golden = read(&path);
    assert_eq!((drawn.width, drawn.height), (golden.width, golden.height));
    let count = differing(&drawn, &golden);
    let most = MOST_PER_THOUSAND * golden.rgba.len() / 4 / 1000;
    if count > most {
        let seen = std::env::temp_dir().join(format!("posekit-{name}.png"));
        write(&seen, &drawn);
        panic!("{count} pixels differ, {most} may: see {}", seen.display());
    }
}

#[test]
fn a_selected_joint_in_the_light() {
    let Some(mut window) = drawn_window(Look::Light) else {
        return;
    };
    window.get_by_label("Elbow").click();
    window.run_steps(3);
    assert_looks_like(&mut window, "inspector-light");
}

#[test]
fn the_two_link_arm_in_the_dark() {
    let Some(mut window) = drawn_window(Look::Dark) else {
        return;
    };
    press(&mut window, Modifiers::NONE, Key::B);
    let viewer = window.state_mut().as_mut();
    viewer
        .expect("the window was shown")
        .lab_mut()
        .open_sample("planar2");
    window.run_steps(3);
    assert_looks_like(&mut window, "arm-lab-dark");
}
