//! What a picture and a film cost on the CPU: the walking sample at 1280x720.
//!
//! `cargo bench -p posekit-render --bench picture [SECONDS]`
//!
//! The tables tell the time of one thread on the processor. The last line tells how a film goes on all
//! cores by the clock on the wall, which other load on the machine slows, and by the processor's.
#![allow(clippy::print_stdout, reason = "a bench prints its figures")]

#[path = "../../../benches/harness.rs"]
mod harness;

use std::hint::black_box;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use cpu_time::ProcessTime;
use harness::{Table, Unit, time_asked};
use posekit::sample::{WalkConfig, walk};
use posekit_render::cpu::{CpuRenderer, available_threads};
use posekit_render::image::Image;
use posekit_render::output::{Film, write_mp4, write_png};
use posekit_render::render::Renderer;
use posekit_render::scene::{Scene, Shadow};
use posekit_render::stage::{Actor, Ghosts, Labels, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::CharacterColors;

const SIZE: (u32, u32) = (1280, 720);
const ASPECT: f32 = 16.0 / 9.0;
/// A moment in the middle of a step.
const TIME_SECS: f64 = 0.7;
/// Frames of the films: a second's worth.
const FILM_FRAMES: u32 = 30;

fn main() {
    pictures();
    films();
}

fn stage(options: StageOptions) -> Stage {
    let motion = walk(&WalkConfig::default()).expect("the default walk");
    let actor = Actor::new(Arc::new(motion), options.style, CharacterColors::of(0));
    Stage::new(vec![actor], options)
}

fn without_shadows(mut scene: Scene) -> Scene {
    for model in &mut scene.models {
        model.shadow = Shadow::None;
    }
    scene
}

fn pictures() {
    let body = stage(StageOptions::default());
    let scene = body.scene(TIME_SECS, ASPECT);
    let mut empty = scene.clone();
    empty.models.clear();
    let bones = stage(StageOptions {
        style: SkeletonStyle::Bones,
        ..StageOptions::default()
    });
    let ghosts = stage(StageOptions {
        ghosts: Some(Ghosts {
            every_frames: 10,
            before: 6,
            after: 3,
        }),
        ..StageOptions::default()
    });
    let labels = stage(StageOptions {
        labels: Labels::All,
        ..StageOptions::default()
    });
    let image = CpuRenderer::new(NonZeroUsize::MIN).render(&scene, SIZE.0, SIZE.1);
    let mut table = Table::new(
        "Pictures, 1280x720, one thread",
        Unit::NanosecondsPer("frame"),
    );
    let picture = |scene: Scene| {
        let mut renderer = CpuRenderer::new(NonZeroUsize::MIN);
        let mut image = Image::default();
        move || {
            renderer.render_into(black_box(&scene), SIZE.0, SIZE.1, &mut image);
            black_box(image.as_rgba().as_ptr());
        }
    };
    table.reference("body", 1, picture(scene.clone()));
    table.job(
        "body, without shadows",
        1,
        picture(without_shadows(scene.clone())),
    );
    table.job("floor alone", 1, picture(empty));
    table.job("bones", 1, picture(bones.scene(TIME_SECS, ASPECT)));
    table.job(
        "body with nine ghosts",
        1,
        picture(ghosts.scene(TIME_SECS, ASPECT)),
    );
    table.job(
        "body with labels",
        1,
        picture(labels.scene(TIME_SECS, ASPECT)),
    );
    table.job("the scene itself, nothing drawn", 1, || {
        black_box(body.scene(black_box(TIME_SECS), ASPECT));
    });
    table.job("PNG of a picture", 1, || {
        let mut bytes = Vec::new();
        write_png(black_box(&image), &mut bytes).expect("memory takes it");
        black_box(bytes.len());
    });
    table.measure(time_asked());
}

fn film() -> Film {
    Film {
        width: SIZE.0,
        height: SIZE.1,
        frames_per_sec: 30.0,
        times_secs: (0..FILM_FRAMES).map(|i| f64::from(i) / 30.0).collect(),
    }
}

fn films() {
    let stage = stage(StageOptions::default());
    let (film, frames) = (film(), FILM_FRAMES as usize);
    let mut one = renderer(NonZeroUsize::MIN);
    let mut frame = CpuRenderer::new(NonZeroUsize::MIN);
    let mut image = Image::default();
    let mut table = Table::new("Films, 1280x720, one thread", Unit::NanosecondsPer("frame"));
    table.job("frames drawn, not encoded", frames, || {
        for &time in &film.times_secs {
            frame.render_into(&stage.scene(time, ASPECT), SIZE.0, SIZE.1, &mut image);
            black_box(image.as_rgba().as_ptr());
        }
    });
    table.reference("film", frames, || write(&film, &stage, &mut one));
    table.measure(time_asked());
    let mut all = renderer(available_threads());
    let (wall, processor) = (Instant::now(), ProcessTime::now());
    write(&film, &stage, &mut all);
    let (wall, processor) = (wall.elapsed(), processor.elapsed());
    println!(
        "\nFilm on {} threads: {:.1} frames/s by the wall's clock, {:.1} ms of processor a frame",
        available_threads(),
        f64::from(FILM_FRAMES) / wall.as_secs_f64(),
        processor.as_secs_f64() * 1e3 / f64::from(FILM_FRAMES),
    );
}

fn renderer(threads: NonZeroUsize) -> Renderer {
    Renderer::cpu(threads)
}

fn write(film: &Film, stage: &Stage, renderer: &mut Renderer) {
    let mut bytes = Vec::new();
    write_mp4(
        film,
        &|time| stage.scene(time, ASPECT),
        renderer,
        &mut bytes,
        &mut |_| ControlFlow::Continue(()),
    )
    .expect("memory takes the film");
    black_box(bytes.len());
}
