//! The GPU back end: a shader that compiles for every API, and pictures like the CPU's.

use posekit_render::cpu;
use posekit_render::gpu::GpuHeadless;
use posekit_render::image::Image;
use posekit_render::scene::Scene;
use posekit_render::stage::{AxesShown, Ghosts, Labels, StageOptions, Trails};

use crate::figures::{STYLES, stage_of, waving};

const SHADER: &str = include_str!("../../src/gpu/shader.wgsl");

fn validated() -> (naga::Module, naga::valid::ModuleInfo) {
    let module = naga::front::wgsl::parse_str(SHADER)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(SHADER)));
    let flags = naga::valid::ValidationFlags::all();
    // No capability beyond the core of WebGPU.
    let capabilities = naga::valid::Capabilities::empty();
    let info = naga::valid::Validator::new(flags, capabilities)
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(SHADER)));
    (module, info)
}

#[test]
fn the_shader_is_valid() {
    validated();
}

/// WebGL2 gets GLSL ES 3.00.
#[test]
fn every_entry_point_can_be_said_in_the_glsl_of_webgl2() {
    let (module, info) = validated();
    let options = naga::back::glsl::Options {
        version: naga::back::glsl::Version::Embedded {
            version: 300,
            is_webgl: true,
        },
        ..naga::back::glsl::Options::default()
    };
    for entry in &module.entry_points {
        let pipeline = naga::back::glsl::PipelineOptions {
            shader_stage: entry.stage,
            entry_point: entry.name.clone(),
            multiview: None,
        };
        let mut source = String::new();
        naga::back::glsl::Writer::new(
            &mut source,
            &module,
            &info,
            &options,
            &pipeline,
            naga::proc::BoundsCheckPolicies::default(),
        )
        .and_then(|mut writer| writer.write().map(|_reflection| ()))
        .unwrap_or_else(|error| panic!("{}: {error}", entry.name));
        assert!(source.contains("void main()"), "{}", entry.name);
    }
}

/// The GPU back end, or `None` with a word about it where there is no driver.
fn open() -> Option<GpuHeadless> {
    match GpuHeadless::open() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            println!("skipped: {error}");
            None
        }
    }
}

/// Mean difference of a channel, and the share of pixels that differ visibly.
fn difference(a: &Image, b: &Image) -> (f64, f64) {
    let pairs = a.as_rgba().chunks_exact(4).zip(b.as_rgba().chunks_exact(4));
    let (mut sum, mut far, mut count) = (0u64, 0u64, 0u64);
    for (p, q) in pairs {
        let distance = (0..3)
            .map(|c| u64::from(p[c].abs_diff(q[c])))
            .max()
            .unwrap_or(0);
        sum += distance;
        far += u64::from(distance > 24);
        count += 1;
    }
    (sum as f64 / count as f64, far as f64 / count as f64)
}

/// How far both back ends are apart on a scene: the mean difference of a channel, and the share of pixels
/// that differ visibly. `None` where there is no driver.
pub(crate) fn difference_of_back_ends(
    scene: &Scene,
    width: u32,
    height: u32,
) -> Option<(f64, f64)> {
    let mut gpu = open()?;
    let from_cpu = cpu::render(scene, width, height);
    let mut from_gpu = Image::default();
    gpu.render_into(scene, width, height, &mut from_gpu)
        .unwrap();
    Some(difference(&from_cpu, &from_gpu))
}

#[test]
fn both_back_ends_draw_the_same_picture() {
    let Some(mut gpu) = open() else { return };
    for style in STYLES {
        let motion = waving(1.0);
        let hand = motion.skeleton().find("leftWrist").unwrap();
        let options = StageOptions {
            style,
            axes: AxesShown::Joints,
            trails: Some(Trails {
                joints: vec![hand],
                seconds: 0.5,
            }),
            ghosts: Some(Ghosts {
                every_frames: 5,
                before: 2,
                after: 1,
            }),
            labels: Labels::All,
            ..StageOptions::default()
        };
        let scene = stage_of(motion, options).scene(0.4, 1.5);
        let (width, height) = (600, 400);
        let from_cpu = cpu::render(&scene, width, height);
        let mut from_gpu = Image::default();
        gpu.render_into(&scene, width, height, &mut from_gpu)
            .unwrap();
        let (mean, far) = difference(&from_cpu, &from_gpu);
        println!(
            "{style:?} on {}: mean {mean:.3}, far {:.4}%",
            gpu.adapter_name(),
            far * 100.0
        );
        assert!(
            mean < 1.0 && far < 0.01,
            "{style:?}: mean {mean}, far {far}"
        );
    }
}

#[test]
fn the_gpu_draws_the_same_bytes_twice() {
    let Some(mut gpu) = open() else { return };
    let scene = stage_of(waving(1.0), StageOptions::default()).scene(0.3, 1.0);
    let (mut first, mut second) = (Image::default(), Image::default());
    gpu.render_into(&scene, 128, 128, &mut first).unwrap();
    gpu.render_into(&scene, 64, 200, &mut second).unwrap();
    gpu.render_into(&scene, 128, 128, &mut second).unwrap();
    assert!(first == second);
}
