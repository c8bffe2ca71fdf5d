//! A scene as text.

use std::fmt::Write as _;
use std::io::{self, Write};

use glam::{DQuat, DVec3};
use posekit::keyframe::{
    Extrapolation, Handle, HandlePair, Interpolation, KeyValue, Keyframe, Property, Tangents, Track,
};

use super::document::{
    EulerNotation, JointTrack, JointValues, Scene, SceneWriteError, SkeletonSource, check,
};
use super::{FORMAT, VERSION};
use crate::number_text::NumberText;

/// How much text is gathered before it goes out.
const CHUNK_BYTES: usize = 1 << 16;

/// The bytes of a scene's file: always the same for the same scene.
///
/// # Errors
/// [`SceneWriteError`] when the scene has a number that its file may not have, so that it could not be read again
/// ([`check()`]).
pub fn write(scene: &Scene) -> Result<Vec<u8>, SceneWriteError> {
    check(scene)?;
    let mut bytes = Vec::new();
    let none = std::iter::empty();
    // Writing to memory does not fail, and there is no track that could.
    let _ = write_checked(scene, none, &mut bytes);
    Ok(bytes)
}

/// Why a scene was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// Its file could not be read again.
    #[error(transparent)]
    Scene(#[from] SceneWriteError),
    /// The bytes could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Writes a scene's file with more tracks after its own, each taken when those before it are written: many keys are
/// written in the memory that one track takes.
///
/// # Errors
/// [`WriteError`] when the scene has a number that its file may not have (then nothing is written), `out` cannot be
/// written, or a track is an error itself.
pub fn write_with_tracks(
    scene: &Scene,
    tracks: impl IntoIterator<Item = io::Result<JointTrack>>,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    check(scene)?;
    Ok(write_checked(scene, tracks, out)?)
}

fn write_checked(
    scene: &Scene,
    tracks: impl IntoIterator<Item = io::Result<JointTrack>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut text = Text::to(out);
    text.line(&format!("format = \"{FORMAT}\""));
    text.line(&format!("version = {VERSION}"));
    if !scene.title.is_empty() {
        text.field("title", &quoted(&scene.title));
    }
    let range = text.numbers(&scene.range_secs);
    text.field("range_secs", &range);
    let rate = text.number(scene.frames_per_sec);
    text.field("frames_per_sec", &rate);
    if scene.studio_light != scene.lights.is_empty() {
        text.field("studio_light", &scene.studio_light.to_string());
    }
    text.skeleton(&scene.skeleton);
    for layer in &scene.motions {
        text.head("[[motion]]");
        text.field("file", &quoted(&layer.file));
        let start = text.number(layer.start_secs);
        text.field("start_secs", &start);
        if let Some(range) = layer.clip_secs {
            let range = text.numbers(&range);
            text.field("clip_secs", &range);
        }
    }
    for track in &scene.tracks {
        text.joint_track(track);
    }
    for track in tracks {
        text.joint_track(&track?);
    }
    for camera in &scene.cameras {
        text.named("camera", &camera.name);
        let view = &camera.view;
        text.properties(
            "camera",
            &[
                ("position", &view.position),
                ("target", &view.target),
                ("vertical_fov_deg", &view.vertical_fov_deg),
            ],
        );
    }
    for light in &scene.lights {
        text.named("light", &light.name);
        let shine = &light.shine;
        text.properties(
            "light",
            &[
                ("position", &shine.position),
                ("color", &shine.color),
                ("strength", &shine.strength),
            ],
        );
    }
    for prop in &scene.props {
        text.named("prop", &prop.name);
        text.field("shape", &quoted(&prop.shape));
        let transform = &prop.transform;
        text.properties(
            "prop",
            &[
                ("translation", &transform.translation),
                ("rotation", &transform.rotation),
                ("scale", &transform.scale),
            ],
        );
    }
    text.finish()
}

struct Text<'a> {
    /// What is to go out.
    out: String,
    numbers: NumberText,
    sink: &'a mut dyn Write,
    /// The first thing that went wrong; nothing is written after it.
    result: io::Result<()>,
}

/// A property of any kind, as the writer sees it.
trait Writable {
    /// `None` for a fixed one, which is a field; a keyed one is a table of its own.
    fn fixed(&self, text: &mut Text<'_>) -> Option<String>;
    fn keyed(&self, text: &mut Text<'_>);
}

/// The numbers that a value or a slope is made of.
trait Components: KeyValue {
    fn components(self, text: &mut Text<'_>) -> String;

    /// A handle as pairs of seconds and value, seen from its key; `sign` is -1 for the one before the key.
    fn handle(handle: Handle<Self>, sign: f64, text: &mut Text<'_>) -> String;
}

impl Components for f64 {
    fn components(self, text: &mut Text<'_>) -> String {
        text.number(self)
    }

    fn handle(handle: Handle<Self>, sign: f64, text: &mut Text<'_>) -> String {
        text.numbers(&[handle.secs * sign, handle.value])
    }
}

impl Components for DVec3 {
    fn components(self, text: &mut Text<'_>) -> String {
        text.numbers(&self.to_array())
    }

    fn handle(handle: Handle<Self>, sign: f64, text: &mut Text<'_>) -> String {
        let pairs = [0, 1, 2].map(|axis| {
            let pair = [handle.secs[axis] * sign, handle.value[axis]];
            text.numbers(&pair)
        });
        format!("[{}]", pairs.join(", "))
    }
}

impl Components for DQuat {
    fn components(self, text: &mut Text<'_>) -> String {
        text.numbers(&self.to_array())
    }

    /// A track of quaternions has no such handles.
    fn handle(handle: Handle<Self>, _sign: f64, text: &mut Text<'_>) -> String {
        handle.value.components(text)
    }
}

impl<V: Components> Writable for Property<V> {
    fn fixed(&self, text: &mut Text<'_>) -> Option<String> {
        match self {
            Self::Fixed(value) => Some(value.components(text)),
            Self::Keyed(_) => None,
        }
    }

    fn keyed(&self, text: &mut Text<'_>) {
        if let Self::Keyed(track) = self {
            text.track(track, |key, text| key.value.components(text));
        }
    }
}

impl<'a> Text<'a> {
    fn to(sink: &'a mut dyn Write) -> Self {
        Self {
            out: String::new(),
            numbers: NumberText::default(),
            sink,
            result: Ok(()),
        }
    }

    fn line(&mut self, line: &str) {
        self.out.push_str(line);
        self.out.push('\n');
        if self.out.len() >= CHUNK_BYTES {
            self.flush();
        }
    }

    fn flush(&mut self) {
        if self.result.is_ok() {
            self.result = self.sink.write_all(self.out.as_bytes());
        }
        self.out.clear();
    }

    fn finish(mut self) -> io::Result<()> {
        self.flush();
        self.result
    }

    fn joint_track(&mut self, track: &JointTrack) {
        self.head("[[track]]");
        self.field("joint", &quoted(&track.joint));
        self.joint_values(&track.values);
    }

    fn head(&mut self, head: &str) {
        self.out.push('\n');
        self.line(head);
    }

    fn named(&mut self, kind: &str, name: &str) {
        self.head(&format!("[[{kind}]]"));
        self.field("name", &quoted(name));
    }

    fn field(&mut self, name: &str, value: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.out, "{name} = {value}");
    }

    /// A whole number without a point; TOML's integers have no negative zero.
    fn number(&mut self, value: f64) -> String {
        match self.numbers.of(value) {
            "-0" => "-0.0".to_owned(),
            text => text.to_owned(),
        }
    }

    fn numbers(&mut self, values: &[f64]) -> String {
        let parts: Vec<String> = values.iter().map(|&value| self.number(value)).collect();
        format!("[{}]", parts.join(", "))
    }

    fn skeleton(&mut self, source: &SkeletonSource) {
        self.head("[skeleton]");
        match source {
            SkeletonSource::File(path) => self.field("file", &quoted(path)),
            SkeletonSource::Inline(joints) => {
                self.line("joints = [");
                for joint in joints {
                    let mut line = format!("  {{ name = {}", quoted(&joint.name));
                    if let Some(parent) = joint.parent {
                        // A name that two joints share does not say which one.
                        let named = joints.get(parent).map(|joint| &joint.name);
                        let namesakes = joints.iter().filter(|joint| Some(&joint.name) == named);
                        let parent = match named {
                            Some(name) if namesakes.count() == 1 => quoted(name),
                            _ => parent.to_string(),
                        };
                        line += &format!(", parent = {parent}");
                    }
                    line += &format!(", translation = {}", joint.translation.components(self));
                    if joint.rotation != DQuat::IDENTITY {
                        line += &format!(", rotation = {}", joint.rotation.components(self));
                    }
                    if joint.is_end_site {
                        line += ", end_site = true";
                    }
                    self.line(&(line + " },"));
                }
                self.line("]");
            }
        }
    }

    fn joint_values(&mut self, values: &JointValues) {
        match values {
            JointValues::Translation(track) => {
                self.field("property", "\"translation\"");
                self.track(track, |key, text| key.value.components(text));
            }
            JointValues::Rotation { track, euler: None } => {
                self.field("property", "\"rotation\"");
                self.track(track, |key, text| key.value.components(text));
            }
            JointValues::Rotation {
                track,
                euler: Some(notation),
            } => {
                self.field("property", "\"rotation\"");
                self.field("euler_deg", &format!("\"{}\"", notation.order));
                self.field("mode", "\"quaternion\"");
                let mut angles = angles_of_keys(track, notation).into_iter();
                let axes = notation.order.axes().len();
                self.track(track, |_, text| {
                    text.numbers(&angles.next().unwrap_or_default()[..axes])
                });
            }
            JointValues::EulerRotation(track) => {
                self.field("property", "\"rotation\"");
                self.field("euler_deg", &format!("\"{}\"", track.order()));
                self.track(track.angles_deg(), |key, text| key.value.components(text));
            }
        }
    }

    fn properties(&mut self, kind: &str, properties: &[(&str, &dyn Writable)]) {
        for (name, property) in properties {
            if let Some(value) = property.fixed(self) {
                self.field(name, &value);
            }
        }
        // In TOML what follows a table's head belongs to that table: tables come last.
        for (name, property) in properties {
            if property.fixed(self).is_none() {
                self.head(&format!("[{kind}.{name}]"));
                property.keyed(self);
            }
        }
    }

    fn track<V: Components>(
        &mut self,
        track: &Track<V>,
        mut value: impl FnMut(&Keyframe<V>, &mut Self) -> String,
    ) {
        for (name, beyond) in [("before", track.before()), ("after", track.after())] {
            if beyond != Extrapolation::Hold {
                self.field(name, &format!("\"{}\"", extrapolation_name(beyond)));
            }
        }
        self.line("keys = [");
        for key in track.keys() {
            let at = self.number(key.time_secs);
            let value = value(key, self);
            let mut line = format!("  {{ at = {at}, value = {value}");
            if key.interpolation != Interpolation::default() {
                line += &format!(", curve = \"{}\"", interpolation_name(key.interpolation));
            }
            match key.tangents {
                Tangents::Smooth => line += ", slope = \"smooth\"",
                Tangents::Flat => line += ", slope = \"flat\"",
                Tangents::Aligned(slope) => {
                    line += &format!(", slope = {}", slope.components(self));
                }
                Tangents::Broken { incoming, outgoing } => {
                    line += &format!(", slope_in = {}", incoming.components(self));
                    line += &format!(", slope_out = {}", outgoing.components(self));
                }
                Tangents::Handles {
                    incoming,
                    outgoing,
                    pair,
                } => {
                    let before = V::handle(incoming, -1.0, self);
                    let after = V::handle(outgoing, 1.0, self);
                    line += &format!(", handle_in = {before}, handle_out = {after}");
                    if pair == HandlePair::Broken {
                        line += ", handles = \"broken\"";
                    }
                }
                _ => {}
            }
            self.line(&(line + " },"));
        }
        self.line("]");
    }
}

/// Degrees of a new angle are rounded to this many parts of a degree: finer than a pose can tell, and
/// 30 comes out as 30.
const PARTS_OF_A_DEGREE: f64 = 1e9;

/// The angles of each key: those of the file where they still make the key's orientation, otherwise
/// those nearest to the key before.
fn angles_of_keys(track: &Track<DQuat>, notation: &EulerNotation) -> Vec<[f64; 3]> {
    let mut known = notation.angles_deg.iter().peekable();
    let mut previous_deg = [0.0; 3];
    let quat = |angles: [f64; 3]| notation.order.to_quat(angles.map(f64::to_radians));
    let one = |key: &Keyframe<DQuat>| {
        // Keys and angles are in the same order; some of either may be gone.
        let mut ahead = known.clone();
        let kept = ahead.position(|&angles| quat(angles) == key.value);
        let angles = match kept {
            Some(skipped) => known.nth(skipped).copied().unwrap_or_default(),
            None => {
                let previous_rad = previous_deg.map(f64::to_radians);
                let euler = notation.order.from_quat_near(key.value, previous_rad);
                let rounded =
                    |angle: f64| (angle * PARTS_OF_A_DEGREE).round() / PARTS_OF_A_DEGREE + 0.0;
                euler.angles_rad.map(|angle| rounded(angle.to_degrees()))
            }
        };
        previous_deg = angles;
        angles
    };
    track.keys().iter().map(one).collect()
}

pub(super) fn extrapolation_name(beyond: Extrapolation) -> &'static str {
    match beyond {
        Extrapolation::Cycle => "cycle",
        Extrapolation::CycleWithOffset => "cycle with offset",
        Extrapolation::PingPong => "ping-pong",
        _ => "hold",
    }
}

pub(super) fn interpolation_name(way: Interpolation) -> &'static str {
    match way {
        Interpolation::Step => "step",
        Interpolation::Linear => "linear",
        Interpolation::Squad => "squad",
        _ => "cubic",
    }
}

/// A basic string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
