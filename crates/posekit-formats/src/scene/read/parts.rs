//! The scene and what stands in it.

use std::collections::HashMap;

use glam::DQuat;
use posekit::keyframe::{KeyedCamera, KeyedLight, KeyedTransform, Property};
use posekit::range::{LONGEST_LENGTH, LONGEST_SECS, are_lengths};
use posekit::skeleton::SkeletonError;

use super::SceneProblemKind;
use super::fields::{Fields, Node, Problems};
use super::tracks::{NUMBER, QUATERNION, VECTOR, joint_track, property};
use crate::scene::document::{
    Camera, FASTEST, InlineJoint, Light, MOST_FRAMES, MotionLayer, Prop, Scene, SkeletonSource,
    frame_time,
};

/// The whole document, `format` and `version` already looked at.
pub(super) fn scene(
    fields: &mut Fields<'_>,
    version: u32,
    problems: &mut Problems,
) -> Option<Scene> {
    let title = fields.take_or("title", String::new(), "text", problems, owned);
    let range_secs = fields.take_or("range_secs", [0.0, 1.0], &times(), problems, range);
    let rate = format!("a rate from {:e} to {FASTEST}", 1.0 / LONGEST_SECS);
    let frames_per_sec = fields.take_or("frames_per_sec", 30.0, &rate, problems, |node| {
        node.number().filter(|&rate| frame_time(rate).is_some())
    });
    let frames = (range_secs[1] - range_secs[0]) * frames_per_sec;
    if frames.is_nan() || frames > MOST_FRAMES {
        let message = format!("the range is {frames:e} frames long, of at most {MOST_FRAMES:e}");
        fields.problem(problems, SceneProblemKind::Inconsistent, message);
    }
    let studio_light = fields.optional("studio_light").map(|node| {
        let on = node.truth();
        if on.is_none() {
            problems.expected(&node, "true or false");
        }
        on.unwrap_or(true)
    });
    let source = fields.required("skeleton", problems);
    let skeleton = source.and_then(|node| skeleton(&node, problems));
    let mut motions = Vec::new();
    for mut table in fields.tables("motion", problems) {
        motions.extend(motion(&mut table, problems));
    }
    let mut tracks = Vec::new();
    for mut table in fields.tables("track", problems) {
        tracks.extend(joint_track(&mut table, version, problems));
    }
    let mut cameras = Vec::new();
    for mut table in fields.tables("camera", problems) {
        let camera = camera(&mut table, problems);
        let same = |other: &Camera| {
            camera
                .as_ref()
                .is_some_and(|camera| camera.name == other.name)
        };
        if cameras.iter().any(same)
            && let Some(node) = table.again("name")
        {
            let message =
                "another camera has this name, and is the one that it stands for".to_owned();
            problems.warn(&node, SceneProblemKind::Doubtful, message);
        }
        cameras.extend(camera);
    }
    let mut lights = Vec::new();
    for mut table in fields.tables("light", problems) {
        lights.extend(light(&mut table, problems));
    }
    let mut props = Vec::new();
    for mut table in fields.tables("prop", problems) {
        props.extend(prop(&mut table, problems));
    }
    fields.finish(problems);
    Some(Scene {
        title,
        range_secs,
        frames_per_sec,
        skeleton: skeleton?,
        motions,
        tracks,
        cameras,
        // Files from before the switch go without where they have lights.
        studio_light: studio_light.unwrap_or(lights.is_empty()),
        lights,
        props,
    })
}

fn owned(node: &Node<'_>) -> Option<String> {
    node.text().map(str::to_owned)
}

fn path(node: &Node<'_>) -> Option<String> {
    owned(node).filter(|path| !path.is_empty())
}

/// What a range is expected to be.
fn times() -> String {
    format!(
        "a start and an end in seconds, within {LONGEST_SECS:e} of 0, the end not before the start"
    )
}

fn range(node: &Node<'_>) -> Option<[f64; 2]> {
    let range = node.numbers().filter(|[start, end]| start <= end)?;
    range.into_iter().all(is_time).then_some(range)
}

fn is_time(secs: f64) -> bool {
    secs.abs() <= LONGEST_SECS
}

fn skeleton(node: &Node<'_>, problems: &mut Problems) -> Option<SkeletonSource> {
    let Some(mut fields) = node.fields() else {
        problems.expected(node, "a table with `file` or `joints`");
        return None;
    };
    let file = fields.optional("file");
    let joints = fields.optional("joints");
    fields.finish(problems);
    match (file, joints) {
        (Some(file), None) => {
            let named = path(&file);
            if named.is_none() {
                problems.expected(&file, "the path of a motion file");
            }
            named.map(SkeletonSource::File)
        }
        (None, Some(joints)) => inline_joints(&joints, problems),
        _ => {
            let message = "expected either `file` or `joints`".to_owned();
            problems.at(node, SceneProblemKind::Inconsistent, message);
            None
        }
    }
}

fn inline_joints(list: &Node<'_>, problems: &mut Problems) -> Option<SkeletonSource> {
    let Some(items) = list.items() else {
        problems.expected(list, "a list of joints");
        return None;
    };
    let count = items.len();
    let mut joints: Vec<InlineJoint> = Vec::with_capacity(count);
    let mut index_of: HashMap<String, usize> = HashMap::new();
    for item in items {
        let Some(mut fields) = item.fields() else {
            problems.expected(
                &item,
                "a joint such as { name = \"Hips\", translation = [0, 1, 0] }",
            );
            continue;
        };
        let name = fields.take("name", "text", problems, owned);
        let parent = fields.optional("parent").map(|node| {
            let by_name = node.text().and_then(|name| index_of.get(name).copied());
            let index = node
                .whole_number()
                .and_then(|index| usize::try_from(index).ok());
            let found = by_name.or(index).filter(|&index| index < joints.len());
            if found.is_none() {
                problems.expected(&node, "the name or number of a joint before this one");
            }
            found.unwrap_or(0)
        });
        let place = format!("three numbers within {LONGEST_LENGTH:e}");
        let at = fields.take("translation", &place, problems, |node| {
            node.numbers::<3>().filter(|&at| are_lengths(at))
        });
        let quaternion = "a quaternion of four numbers x, y, z, w";
        let turn = [0.0, 0.0, 0.0, 1.0];
        let turn = fields.take_or("rotation", turn, quaternion, problems, |node| {
            node.numbers::<4>().filter(|&turn| are_lengths(turn))
        });
        let is_end_site = fields.take_or("end_site", false, "true or false", problems, Node::truth);
        fields.finish(problems);
        if let (Some(name), Some(at)) = (name, at) {
            index_of.insert(name.clone(), joints.len());
            joints.push(InlineJoint {
                name,
                parent,
                translation: at.into(),
                rotation: DQuat::from_array(turn),
                is_end_site,
            });
        }
    }
    if joints.len() < count {
        return None;
    }
    let source = SkeletonSource::Inline(joints);
    let refused: Option<SkeletonError> = source.inline_skeleton().and_then(Result::err);
    if let Some(error) = refused {
        problems.at(list, SceneProblemKind::Inconsistent, error.to_string());
        return None;
    }
    Some(source)
}

fn motion(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<MotionLayer> {
    let file = fields.take("file", "the path of a motion file", problems, path);
    let time = format!("a time in seconds, within {LONGEST_SECS:e} of 0");
    let start_secs = fields.take_or("start_secs", 0.0, &time, problems, |node| {
        node.number().filter(|&secs| is_time(secs))
    });
    let clip_secs = fields.take_or("clip_secs", None, &times(), problems, |node| {
        range(node).map(Some)
    });
    fields.finish(problems);
    Some(MotionLayer {
        file: file?,
        start_secs,
        clip_secs,
    })
}

fn name(fields: &mut Fields<'_>, problems: &mut Problems) -> String {
    fields.take_or("name", String::new(), "text", problems, owned)
}

fn camera(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<Camera> {
    let name = name(fields, problems);
    let default = KeyedCamera::default();
    let view = KeyedCamera {
        position: or_default(fields, "position", &VECTOR, &default.position, problems),
        target: or_default(fields, "target", &VECTOR, &default.target, problems),
        vertical_fov_deg: or_default(
            fields,
            "vertical_fov_deg",
            &NUMBER,
            &default.vertical_fov_deg,
            problems,
        ),
    };
    fields.finish(problems);
    let [least, most] = LENSES_DEG;
    doubt(
        fields,
        "vertical_fov_deg",
        &view.vertical_fov_deg,
        problems,
        |&deg| {
            (!(least..=most).contains(&deg)).then(|| {
                format!(
                    "an angle of {deg} degrees is drawn as {} degrees",
                    deg.clamp(least, most)
                )
            })
        },
    );
    Some(Camera { name, view })
}

fn light(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<Light> {
    let name = name(fields, problems);
    let default = KeyedLight::default();
    let shine = KeyedLight {
        position: or_default(fields, "position", &VECTOR, &default.position, problems),
        color: or_default(fields, "color", &VECTOR, &default.color, problems),
        strength: or_default(fields, "strength", &NUMBER, &default.strength, problems),
    };
    fields.finish(problems);
    doubt(fields, "strength", &shine.strength, problems, |&strength| {
        (strength < 0.0).then(|| format!("a strength of {strength} is drawn as 0, no light"))
    });
    doubt(fields, "color", &shine.color, problems, |color| {
        let most = color.max_element();
        (most >= LIKE_BYTES)
            .then(|| format!("{most} is {most} times as bright as full light, which is 1"))
    });
    Some(Light { name, shine })
}

fn prop(fields: &mut Fields<'_>, problems: &mut Problems) -> Option<Prop> {
    let name = name(fields, problems);
    let shape = fields.take("shape", "`box`, `sphere` or a path", problems, path);
    let default = KeyedTransform::default();
    let transform = KeyedTransform {
        translation: or_default(
            fields,
            "translation",
            &VECTOR,
            &default.translation,
            problems,
        ),
        rotation: or_default(fields, "rotation", &QUATERNION, &default.rotation, problems),
        scale: or_default(fields, "scale", &VECTOR, &default.scale, problems),
    };
    fields.finish(problems);
    Some(Prop {
        name,
        shape: shape?,
        transform,
    })
}

/// Angles of lenses that are drawn as they are.
const LENSES_DEG: [f64; 2] = [1.0, 170.0];

/// Parts of a colour from here on look like those that go up to 255.
const LIKE_BYTES: f64 = 16.0;

/// Warns of a value that is the same at all times and not drawn as it says.
fn doubt<V: posekit::keyframe::KeyValue>(
    fields: &Fields<'_>,
    name: &str,
    property: &Property<V>,
    problems: &mut Problems,
    why: impl FnOnce(&V) -> Option<String>,
) {
    if let (Property::Fixed(value), Some(node)) = (property, fields.again(name))
        && let Some(message) = why(value)
    {
        problems.warn(&node, SceneProblemKind::Doubtful, message);
    }
}

fn or_default<V: posekit::keyframe::KeyValue + std::ops::Neg<Output = V>>(
    fields: &mut Fields<'_>,
    name: &'static str,
    kind: &super::tracks::Kind<V>,
    default: &Property<V>,
    problems: &mut Problems,
) -> Property<V> {
    property(fields, name, kind, default.at(0.0), problems)
}
