//! From an input and the options to a stage and the moments of it that are drawn.

use std::ffi::OsString;
use std::ops::Range;
use std::sync::Arc;

use posekit::keyframe::KeyedCamera;
use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::scene;
use posekit_render::character::MOST_BODY_JOINTS;
use posekit_render::output::{even_size, spread_times};
use posekit_render::scene::{Background, MOST_LAMPS, Scene};
use posekit_render::stage::{
    Actor, Arrangement, Ghosts, Labels, Prop, PropShape, Stage, StageOptions, Surroundings, Trails,
    keyed_camera,
};
use posekit_render::theme::CharacterColors;

use crate::args::Global;
use crate::failure::Failure;
use crate::inputs::{self, Input, Source};
use crate::load;
use crate::reading::is_scene;
use crate::scene_file;
use crate::select;
use crate::text::{counted, decimals_to_show, grouped, trimmed};

use super::args::{RenderArgs, Size};
use super::camera::{self, Chosen};
use super::format::Product;

/// Films are no faster than this unless asked: more frames than a screen shows.
const MOST_FRAMES_PER_SEC: f64 = 60.0;
/// What GIF shows evenly: four hundredths of a second a frame.
const GIF_FRAMES_PER_SEC: f64 = 25.0;
/// How many ghosts go before and come after.
const GHOSTS_EACH_WAY: usize = 4;
/// More frames than this is a mistake in the rate: hours of film.
const MOST_FRAMES: f64 = 1e7;

/// A stage and what of it is drawn.
#[derive(Debug)]
pub(super) struct Shot {
    stage: Stage,
    /// When the stage's motion begins: later than its scene where only a part of that is baked.
    motion_start_secs: f64,
    /// A camera of the scene file, in place of the stage's view.
    camera: Option<KeyedCamera>,
    /// Of one picture.
    pub(super) size: Size,
    /// Of a film.
    pub(super) frames_per_sec: f64,
    /// The moments that are drawn, seconds.
    pub(super) times_secs: Vec<f64>,
    /// What the reader repaired, and what else the user should know.
    pub(super) warnings: Vec<String>,
    /// What is worth knowing and needs no action.
    pub(super) notes: Vec<String>,
}

impl Shot {
    /// The scene at a time.
    pub(super) fn scene(&self, time_secs: f64) -> Scene {
        let aspect = self.size.width as f32 / self.size.height as f32;
        let time_secs = time_secs - self.motion_start_secs;
        match &self.camera {
            Some(camera) => {
                let at = self.stage.surroundings().start_secs + time_secs;
                let camera = keyed_camera(camera, at, self.stage.stature());
                self.stage.scene_from(time_secs, camera)
            }
            None => self.stage.scene(time_secs, aspect),
        }
    }

    /// The stage's options.
    pub(super) fn options(&self) -> &StageOptions {
        self.stage.options()
    }
}

/// A motion that is shown with every input.
#[derive(Clone, Debug)]
pub(super) struct Companion {
    /// What messages call it.
    name: String,
    motion: Arc<Motion>,
}

/// The motions that are shown with every input.
pub(super) fn companions(args: &RenderArgs, global: &Global) -> Result<Vec<Companion>, Failure> {
    let mut companions = Vec::new();
    for name in args.overlay.iter().chain(&args.beside) {
        companions.extend(named_motions(args, name, global)?);
    }
    Ok(companions)
}

fn named_motions(
    args: &RenderArgs,
    name: &OsString,
    global: &Global,
) -> Result<Vec<Companion>, Failure> {
    let inputs = inputs::expand(std::slice::from_ref(name));
    if let Some((_, failure)) = inputs.failures.into_iter().next() {
        return Err(failure);
    }
    let motions = inputs.list.iter().map(|input| {
        let (motion, _) = motion_of(args, input, global)?;
        Ok(Companion {
            name: input.name(),
            motion: Arc::new(motion),
        })
    });
    motions.collect()
}

fn motion_of(
    args: &RenderArgs,
    input: &Input,
    global: &Global,
) -> Result<(Motion, Vec<String>), Failure> {
    args.said().refuse_scene(input)?;
    let loaded = load::load(input, global)?;
    let mut warnings = loaded.repairs(input);
    let policies = args.positions.policies();
    let motion = loaded
        .motion(policies)
        .map_err(|failure| failure.in_file(&input.name()))?;
    if !args.positions.is_given() {
        warnings.extend(loaded.relative_positions(input, &motion, policies));
    }
    if is_scene(input) {
        // It stands in its world as it does among its own lights and things.
        return Ok((motion, warnings));
    }
    let (motion, remark) = args.up.stand(&input.name(), motion);
    warnings.extend(remark);
    Ok((motion, warnings))
}

/// Reads an input and sets its stage.
pub(super) fn prepare(
    args: &RenderArgs,
    product: Product,
    companions: &[Companion],
    input: &Input,
    global: &Global,
) -> Result<Shot, Failure> {
    let name = input.name();
    args.said().refuse_scene(input)?;
    let scene = match &input.source {
        Source::File(path) if scene_file::is_scene(path) => {
            Some((path, scene_file::read(path, &global.guard)?))
        }
        _ => None,
    };
    let mut part = None;
    let (mut motion, mut warnings) = match &scene {
        Some((path, scene)) => {
            let import = scene_file::shot(path, scene, &global.guard)?;
            load::refuse_repairs(&name, &import.report, global)?;
            let warnings = load::repair_lines(&name, &import.report.warnings);
            let shot = import.document;
            part = part_of(args, product, companions, &shot)
                .map_err(|failure| failure.in_file(&name))?;
            let motion = match &part {
                Some(part) => shot.bake_frames(None, part.baked.clone()),
                None => shot.bake(None),
            };
            let first = part.as_ref().map_or(0, |part| part.baked.start);
            scene_file::refuse_too_far(&motion, |place| first + place)
                .map_err(|failure| failure.in_file(&name))?;
            (motion, warnings)
        }
        None => motion_of(args, input, global)?,
    };
    let scene = scene.map(|(_, scene)| scene);
    let in_file = |failure: Failure| failure.in_file(&name);
    if motion.skeleton().joint_count() == 0 {
        return Err(in_file(Failure::new("has no joints to draw")));
    }
    if motion.frame_count() == 0 && !args.rest {
        warnings.push(format!("{name}: has no frames; this is its rest pose"));
    }
    if args.rest || motion.frame_count() == 0 {
        let skeleton = Arc::clone(motion.skeleton());
        let frame_time = match motion.frame_time() {
            FrameTime::NONE => FrameTime::of_fps(30),
            frame_time => frame_time,
        };
        motion = Motion::at_rest(skeleton, 1, frame_time, []);
    }
    let (size, size_warning) = size(args, product);
    warnings.extend(size_warning.map(|text| format!("{name}: {text}")));
    let frames_per_sec = args
        .fps
        .unwrap_or_else(|| default_rate(product, motion.frame_time_secs()));
    let longest = companions.iter().map(|it| it.motion.duration_secs());
    let end_secs = longest.fold(motion.duration_secs(), f64::max);
    let frame_count = part
        .as_ref()
        .map_or(motion.frame_count(), |part| part.frame_count);
    let past_the_end = args
        .frames
        .as_ref()
        .and_then(|frames| frames.past_the_end(frame_count));
    let mut notes: Vec<String> = past_the_end.into_iter().collect();
    let mut motion_start_secs = 0.0;
    if let Some(Part { baked, .. }) = part.as_ref().filter(|part| !part.baked.is_empty()) {
        motion_start_secs = baked.start as f64 * motion.frame_time_secs();
        notes.push(format!(
            "only {1}..{2} of {0} are used, and the camera is placed for them",
            counted(frame_count, "frame"),
            baked.start,
            baked.end
        ));
    }
    let frame_time_secs = motion.frame_time_secs();
    let whole = (frame_count, frame_time_secs, end_secs);
    let times_secs = times(args, product, whole, frames_per_sec).map_err(in_file)?;
    let mut options = options(args, &motion, companions).map_err(in_file)?;
    let style = options.style;
    let camera = match camera::choose(args.camera.as_deref(), scene.as_ref()).map_err(in_file)? {
        Chosen::OfScene(camera) => Some(camera),
        Chosen::View(choice) => {
            options.camera = choice;
            None
        }
    };
    let first = Actor::new(Arc::new(motion), style, CharacterColors::of(0));
    let stature = first.stature();
    let mut actors = vec![first];
    for (companion, color) in companions.iter().zip(1..) {
        let motion = Arc::clone(&companion.motion);
        let actor = Actor::new(motion, style, CharacterColors::of(color));
        let (actor, scale) = actor.beside(stature);
        actors.push(actor);
        notes.extend(scale.map(|factor| {
            format!(
                "beside it {} is drawn {} times as large as its file says: it is told in another unit of length",
                companion.name,
                trimmed(factor.into(), decimals_to_show(factor.into()))
            )
        }));
    }
    if actors.first().is_some_and(Actor::has_too_many_joints) {
        let most = grouped(MOST_BODY_JOINTS);
        warnings.push(format!(
            "{name}: drawn as bones, not as a body: it has more than {most} joints"
        ));
    } else if let Some(why) = actors.first().and_then(Actor::doubt) {
        warnings.push(format!("{name}: drawn as bones, not as a body: {why}"));
    }
    let mut stage = Stage::new(actors, options);
    if let Some(scene) = &scene {
        let mut surroundings = surroundings(scene, &name, &mut warnings);
        surroundings.start_secs += motion_start_secs;
        stage.set_surroundings(surroundings);
    }
    Ok(Shot {
        stage,
        motion_start_secs,
        camera,
        size,
        frames_per_sec,
        times_secs,
        warnings,
        notes: notes.iter().map(|note| format!("{name}: {note}")).collect(),
    })
}

/// What is baked of a scene that is too long to be baked whole.
struct Part {
    baked: Range<usize>,
    /// How many frames the whole scene has.
    frame_count: usize,
}

/// The frames of a scene that are drawn, where all of them would be too many; fails where these are, too.
fn part_of(
    args: &RenderArgs,
    product: Product,
    companions: &[Companion],
    shot: &scene::Shot,
) -> Result<Option<Part>, Failure> {
    if args.rest {
        return Ok(Some(Part {
            baked: 0..0,
            frame_count: 1,
        }));
    }
    let frame_count = shot.frame_count(None);
    if scene_file::fits(shot, frame_count) {
        return Ok(None);
    }
    let drawn = match (&args.frames, product) {
        // They are drawn at the same time, from their own beginnings.
        _ if !companions.is_empty() => 0..frame_count,
        (None, Product::Picture) => {
            let middle = (frame_count - 1) / 2;
            middle..middle + 1
        }
        (None, _) => 0..frame_count,
        (Some(selection), _) => selection.span(frame_count)?,
    };
    scene_file::refuse_large(shot, drawn.len())?;
    Ok(Some(Part {
        baked: drawn,
        frame_count,
    }))
}

/// The lights and objects of a scene, and what must be said of them.
fn surroundings(scene: &scene::Scene, file: &str, warnings: &mut Vec<String>) -> Surroundings {
    if scene.lights.len() > MOST_LAMPS {
        warnings.push(format!(
            "{file}: only the first {MOST_LAMPS} lights are drawn"
        ));
    }
    let prop = |prop: &scene::Prop| {
        let shape = PropShape::named(&prop.shape).unwrap_or_else(|| {
            let (name, shape) = (&prop.name, &prop.shape);
            let why = match shape.contains('.') {
                true => "mesh files are not read",
                false => "the shapes are box and sphere",
            };
            warnings.push(format!(
                "{file}: prop '{name}': {why}; a box is drawn in place of {shape}"
            ));
            PropShape::Box
        });
        Prop::new(&shape, prop.transform.clone())
    };
    Surroundings {
        studio_light: scene.studio_light,
        props: scene.props.iter().map(prop).collect(),
        lights: scene
            .lights
            .iter()
            .map(|light| light.shine.clone())
            .collect(),
        start_secs: scene.range_secs[0],
    }
}

fn size(args: &RenderArgs, product: Product) -> (Size, Option<String>) {
    let (width, height) = match product {
        Product::Gif => (640, 360),
        Product::ContactSheet { .. } => (360, 480),
        Product::Picture | Product::Numbered | Product::Mp4 | Product::Apng => (1280, 720),
    };
    let asked = args.size.unwrap_or(Size { width, height });
    if product != Product::Mp4 {
        return (asked, None);
    }
    let (width, height) = even_size(asked.width, asked.height);
    let made = Size { width, height };
    let warning = (made != asked)
        .then(|| format!("sides of .mp4 are even: the film is {width}x{height} pixels"));
    (made, warning)
}

/// The motion's own rate, or the greatest whole part of it that is not too fast.
fn default_rate(product: Product, frame_time_secs: f64) -> f64 {
    if product == Product::Gif {
        return GIF_FRAMES_PER_SEC;
    }
    let own = 1.0 / frame_time_secs;
    if !(own.is_finite() && own > 0.0) {
        return 30.0;
    }
    // 60 frames a second are often written as a frame time of 0.016667.
    let part = (own / (MOST_FRAMES_PER_SEC * 1.01)).ceil().max(1.0);
    let rate = own / part;
    let whole = rate.round();
    if whole >= 1.0 && (rate - whole).abs() < 0.005 * whole {
        whole
    } else {
        rate
    }
}

fn times(
    args: &RenderArgs,
    product: Product,
    (frame_count, frame_time, end_secs): (usize, f64, f64),
    frames_per_sec: f64,
) -> Result<Vec<f64>, Failure> {
    let at = |frame: usize| frame as f64 * frame_time;
    let chosen = args
        .frames
        .as_ref()
        .map(|selection| selection.frames(frame_count))
        .transpose()?;
    let (start, end) = match chosen.as_deref() {
        Some([first, .., last]) => (at(*first), at(*last)),
        Some([only]) => (at(*only), at(*only)),
        Some([]) | None => (0.0, end_secs),
    };
    match (product, chosen) {
        (Product::Picture, None) => Ok(vec![at((frame_count - 1) / 2)]),
        (Product::Picture, Some(frames)) if frames.len() > 1 => {
            Err(Failure::new("one picture cannot show several frames")
                .try_next("give --contact-sheet N, or number the pictures: -o 'name_####.png'"))
        }
        (Product::ContactSheet { count }, _) => Ok(spread_times(usize::from(count), start, end)),
        (Product::Numbered, None) if args.fps.is_none() => Ok((0..frame_count).map(at).collect()),
        (_, Some(frames)) if args.fps.is_none() && product != Product::Gif || !is_run(&frames) => {
            Ok(frames.into_iter().map(at).collect())
        }
        _ => even_times(start, end, frames_per_sec),
    }
}

/// Whether frames follow one another, so that another rate can be put in their place.
fn is_run(frames: &[usize]) -> bool {
    frames.windows(2).all(|pair| pair[1] == pair[0] + 1)
}

fn even_times(start: f64, end: f64, frames_per_sec: f64) -> Result<Vec<f64>, Failure> {
    // The last frame may miss its time by a hair of rounding.
    let span = ((end - start) * frames_per_sec + 1e-6).floor().max(0.0);
    if span > MOST_FRAMES {
        return Err(
            Failure::new(format!("{span} frames are too many for a film"))
                .try_next("choose fewer with --frames, or a lower --fps"),
        );
    }
    #[allow(clippy::cast_possible_truncation, reason = "bounded above")]
    let count = span as usize;
    Ok((0..=count)
        .map(|i| start + i as f64 / frames_per_sec)
        .collect())
}

fn options(
    args: &RenderArgs,
    motion: &Motion,
    companions: &[Companion],
) -> Result<StageOptions, Failure> {
    let skeleton = motion.skeleton();
    let trails = (!args.trails.is_empty())
        .then(|| select::joints(skeleton, &args.trails))
        .transpose()?;
    let labels = match args.labels.as_slice() {
        [] => Labels::None,
        [all] if all == "*" => Labels::All,
        names => Labels::Of(select::joints(skeleton, names)?),
    };
    if let Some(joints) = &trails {
        same_joints(skeleton, joints, companions)?;
    }
    if let Labels::Of(joints) = &labels {
        same_joints(skeleton, joints, companions)?;
    }
    if !(args.trail_seconds > 0.0 && args.trail_seconds.is_finite()) {
        return Err(Failure::usage("--trail-seconds must be a positive number"));
    }
    Ok(StageOptions {
        style: args.style.style(),
        axes: args.style.axes(),
        theme: args.theme.theme(),
        background: args.transparent.then_some(Background::Transparent),
        follow: args.follow.follow(),
        arrangement: if args.beside.is_empty() {
            Arrangement::AsRecorded
        } else {
            Arrangement::SideBySide
        },
        trails: trails.map(|joints| Trails {
            joints,
            seconds: args.trail_seconds,
        }),
        ghosts: args.ghosts.map(|every| Ghosts {
            every_frames: usize::try_from(every).unwrap_or(usize::MAX),
            before: GHOSTS_EACH_WAY,
            after: GHOSTS_EACH_WAY,
        }),
        labels,
        unit: args.unit.unit(),
        ..StageOptions::default()
    })
}

/// Trails and chosen labels go by a joint's place in the skeleton: it must be the same joint in all.
fn same_joints(
    skeleton: &Skeleton,
    joints: &[JointId],
    companions: &[Companion],
) -> Result<(), Failure> {
    for other in companions.iter().map(|it| it.motion.skeleton()) {
        let differs = joints.iter().find(|joint| {
            joint.index() >= other.joint_count() || other.name(**joint) != skeleton.name(**joint)
        });
        if let Some(joint) = differs {
            return Err(Failure::new(format!(
                "the other motion has no '{}' at this place in its skeleton",
                skeleton.name(*joint)
            ))
            .try_next("posekit convert --reorder-like gives both one order"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_is_the_motions_own_or_a_whole_part_of_it() {
        for (frame_time, wanted) in [
            (1.0 / 60.0, 60.0),
            (0.016_667, 60.0),
            (0.008_333, 60.0),
            (1.0 / 240.0, 60.0),
            (0.01, 50.0),
            (1.0 / 30.0, 30.0),
            (0.5, 2.0),
            (0.0, 30.0),
        ] {
            let rate = default_rate(Product::Mp4, frame_time);
            assert!((rate - wanted).abs() < 1e-9, "{frame_time}: {rate}");
        }
        assert!((default_rate(Product::Gif, 0.01) - 25.0).abs() < 1e-9);
    }

    #[test]
    fn a_film_ends_on_its_last_frame_and_is_never_endless() {
        let times = even_times(0.0, 1.0, 25.0).unwrap();
        assert_eq!(times.len(), 26);
        assert!((times[25] - 1.0).abs() < 1e-12);
        assert!(even_times(0.0, 1e9, 1000.0).is_err());
        assert!(even_times(0.0, f64::INFINITY, 30.0).is_err());
    }
}
