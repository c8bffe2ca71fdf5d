//! Channels and samplers to tracks.

use std::ops::Range;

use glam::{DQuat, DVec3};
use gltf::json::Root;
use gltf::json::animation::{Channel, Interpolation as Said, Property, Sampler};
use gltf::json::buffer::View;
use gltf::json::validation::Checked;
use posekit::keyframe::{
    Animation, Extrapolation, Interpolation, KeyValue, Keyframe, Tangents, Track,
};
use posekit::skeleton::JointId;

use super::accessor::{Source, Viewed, vectors};
use super::container::Buffers;
use super::json_path::Step;
use super::nodes::Rig;
use super::{GltfAnimation, Notes, animation};
use crate::report::{ReadError, ReadErrorKind, WarningCode, quote};

/// How many keys a file may have for each of its bytes, every animation counting one for each joint as well. A
/// key takes four bytes at least, but many tracks may share them; exporters come nowhere near.
pub const MAX_KEYS_PER_BYTE: usize = 1;

/// A scale that moves by less than this does so by rounding.
const SCALE_TOLERANCE: f64 = 1e-3;

/// The keys of a sampler as the file has them.
struct Keys<const N: usize> {
    times: Vec<[f32; 1]>,
    values: Vec<[f32; N]>,
    said: Said,
}

/// Reads the animations of these indices.
pub(super) fn animations<F: FnMut(&str) -> Option<Vec<u8>>>(
    root: &Root,
    rig: &Rig,
    wanted: Range<usize>,
    buffers: Buffers<'_, F>,
    (byte_count, notes): (usize, &mut Notes),
) -> Result<Vec<GltfAnimation>, ReadError> {
    let mut reader = Reader {
        root,
        rig,
        buffers,
        keys_left: byte_count.saturating_mul(MAX_KEYS_PER_BYTE),
    };
    let mut animations = Vec::with_capacity(wanted.len());
    for index in wanted {
        let said = &root.animations[index];
        let animation_path = [Step::Key("animations"), Step::Index(index)];
        let too_many = |notes: &mut Notes| {
            let wanted = format!("at most {byte_count} keys in all");
            notes.error(
                ReadErrorKind::LimitExceeded,
                &animation_path,
                wanted,
                "more",
            )
        };
        if reader.take(rig.skeleton.joint_count()).is_err() {
            return Err(too_many(notes));
        }
        let mut tracks = Animation::new(std::sync::Arc::clone(&rig.skeleton));
        for (place, channel) in said.channels.iter().enumerate() {
            let path = [
                Step::Key("animations"),
                Step::Index(index),
                Step::Key("channels"),
                Step::Index(place),
            ];
            let sampler = said.samplers.get(channel.sampler.value());
            match reader.channel(channel, sampler, &tracks, notes) {
                Ok(Moved::Rotation(joint, track)) => {
                    tracks = tracks.with_rotation(joint, Some(track));
                }
                Ok(Moved::Translation(joint, track)) => {
                    tracks = tracks.with_translation(joint, Some(track));
                }
                Ok(Moved::NoJoint) => {}
                Err(Trouble::TooManyKeys) => return Err(too_many(notes)),
                Err(Trouble::AnimatedScale) => {
                    notes.warn(WarningCode::AnimatedScale, &path, || {
                        "the scale of a joint is animated, which a skeleton cannot".to_owned()
                    });
                }
                Err(Trouble::Unreadable(why)) => {
                    notes.warn(WarningCode::UnreadableTrack, &path, || {
                        format!("a channel was left out: {why}")
                    });
                }
            }
        }
        let name = animation::name_of(root, index);
        if let Some(start) = tracks.range_secs().map(|[start, _]| start)
            && start > 0.0
        {
            notes.warn(WarningCode::LateFirstKey, &animation_path, || {
                format!(
                    "the first key of {} is at {start:.4} s; it starts there",
                    quote(name.as_bytes())
                )
            });
        }
        animations.push(GltfAnimation { name, tracks });
    }
    Ok(animations)
}

/// What a channel moves.
enum Moved {
    Rotation(JointId, Track<DQuat>),
    Translation(JointId, Track<DVec3>),
    /// A camera, the mesh, or a scale that stays as it is.
    NoJoint,
}

/// Why a channel is no track.
enum Trouble {
    TooManyKeys,
    AnimatedScale,
    Unreadable(String),
}

impl From<&str> for Trouble {
    fn from(why: &str) -> Self {
        Self::Unreadable(why.to_owned())
    }
}

struct Reader<'a, F> {
    root: &'a Root,
    rig: &'a Rig,
    buffers: Buffers<'a, F>,
    keys_left: usize,
}

impl<'a, F: FnMut(&str) -> Option<Vec<u8>>> Reader<'a, F> {
    /// Counts keys.
    fn take(&mut self, count: usize) -> Result<(), Trouble> {
        let left = self.keys_left.checked_sub(count);
        self.keys_left = left.ok_or(Trouble::TooManyKeys)?;
        Ok(())
    }

    fn channel(
        &mut self,
        channel: &Channel,
        sampler: Option<&Sampler>,
        tracks: &Animation,
        notes: &mut Notes,
    ) -> Result<Moved, Trouble> {
        let node = channel.target.node.value();
        let joints = &self.rig.joint_of_node;
        let joint = *joints.get(node).ok_or("there is no such node")?;
        let Some(joint) = joint else {
            return Ok(Moved::NoJoint);
        };
        let Checked::Valid(property) = &channel.target.path else {
            return Err("what it moves is unknown".into());
        };
        let sampler = sampler.ok_or("there is no such sampler")?;
        let (space, id) = (self.rig.spaces[joint], JointId::new(joint));
        match property {
            Property::MorphTargetWeights => Ok(Moved::NoJoint),
            Property::Scale => {
                let keys = self.keys::<3>(sampler, notes)?;
                let rest = self.rig.scales[joint];
                let stays = |at: [[f32; 3]; 3]| {
                    let tolerance = SCALE_TOLERANCE * rest.abs().max_element();
                    vector(at[1]).abs_diff_eq(rest, tolerance)
                };
                if !(0..keys.times.len()).all(|key| stays(keys.at(key))) {
                    return Err(Trouble::AnimatedScale);
                }
                Ok(Moved::NoJoint)
            }
            Property::Translation => {
                let keys = self.keys::<3>(sampler, notes)?;
                let key = |[incoming, value, outgoing]: [[f32; 3]; 3]| {
                    let slope = |given| space.translation_slope(vector(given));
                    let value = space.translation(vector(value));
                    Some([slope(incoming), value, slope(outgoing)])
                };
                let is_new = tracks.translation(id).is_none();
                Ok(Moved::Translation(id, keys.track(is_new, key)?))
            }
            Property::Rotation => {
                let keys = self.keys::<4>(sampler, notes)?;
                let key = |given: [[f32; 4]; 3]| {
                    let [incoming, value, outgoing] =
                        given.map(|q| DQuat::from_array(q.map(f64::from)));
                    let length = value.length();
                    let is_rotation = length.is_finite() && length > 1e-6;
                    is_rotation
                        .then(|| [incoming, value, outgoing].map(|q| space.rotation(q) / length))
                };
                let is_new = tracks.rotation(id).is_none();
                Ok(Moved::Rotation(id, keys.track(is_new, key)?))
            }
        }
    }

    fn keys<const N: usize>(
        &mut self,
        sampler: &Sampler,
        notes: &mut Notes,
    ) -> Result<Keys<N>, Trouble> {
        let Checked::Valid(said) = sampler.interpolation else {
            return Err("its interpolation is unknown".into());
        };
        let times = self.numbers::<1>(sampler.input.value(), self.keys_left, notes)?;
        self.take(times.len())?;
        let for_each = if said == Said::CubicSpline { 3 } else { 1 };
        let wanted = for_each * times.len();
        let values = self.numbers::<N>(sampler.output.value(), wanted, notes)?;
        if times.is_empty() || values.len() != wanted {
            let (times, values) = (times.len(), values.len());
            let why = format!("there are {values} values for {times} times");
            return Err(Trouble::Unreadable(why));
        }
        Ok(Keys {
            times,
            values,
            said,
        })
    }

    /// The vectors of an accessor, at most so many of them where the buffers do not bound their number.
    fn numbers<const N: usize>(
        &mut self,
        index: usize,
        most: usize,
        notes: &mut Notes,
    ) -> Result<Vec<[f32; N]>, Trouble> {
        let root = self.root;
        let accessor = root.accessors.get(index);
        let accessor = accessor.ok_or("there is no such accessor")?;
        let mut view = |view: usize| {
            let view = root.buffer_views.get(view);
            let view = view.ok_or("its accessor has no buffer")?;
            self.buffers.fetch(root, view.buffer.value(), notes);
            Ok::<_, Trouble>(view)
        };
        let own = accessor.buffer_view.as_ref();
        let own = own.map(|own| view(own.value())).transpose()?;
        let sparse = accessor.sparse.as_ref();
        let sparse = sparse.map(|sparse| {
            let indices = view(sparse.indices.buffer_view.value())?;
            Ok::<_, Trouble>([indices, view(sparse.values.buffer_view.value())?])
        });
        let sparse = sparse.transpose()?;
        let buffers = &self.buffers;
        let viewed = |view: &'a View| match buffers.get(view.buffer.value()) {
            Some(buffer) => Ok(Viewed { view, buffer }),
            None => Err(Trouble::from("its buffer is missing")),
        };
        let source = Source {
            elements: own.map(viewed).transpose()?,
            sparse: match sparse {
                Some([indices, values]) => Some([viewed(indices)?, viewed(values)?]),
                None => None,
            },
        };
        vectors(accessor, &source, most)
            .map_err(|why| Trouble::Unreadable(format!("accessor {index}: {why}")))
    }
}

impl<const N: usize> Keys<N> {
    /// The slope that comes in, the value, and the slope that goes out; the value alone where there are none.
    fn at(&self, key: usize) -> [[f32; N]; 3] {
        match self.said {
            Said::CubicSpline => [0, 1, 2].map(|part| self.values[3 * key + part]),
            Said::Linear | Said::Step => [self.values[key]; 3],
        }
    }

    fn track<V: KeyValue>(
        &self,
        is_new: bool,
        key: impl Fn([[f32; N]; 3]) -> Option<[V; 3]>,
    ) -> Result<Track<V>, Trouble> {
        if !is_new {
            return Err("another channel moves the same".into());
        }
        let interpolation = match self.said {
            Said::Step => Interpolation::Step,
            Said::Linear => Interpolation::Linear,
            Said::CubicSpline => Interpolation::Cubic,
        };
        let mut keys = Vec::with_capacity(self.times.len());
        for (index, time) in self.times.iter().enumerate() {
            let [incoming, value, outgoing] =
                key(self.at(index)).ok_or("a rotation is not a quaternion")?;
            keys.push(Keyframe {
                tangents: match self.said {
                    Said::CubicSpline => Tangents::Broken { incoming, outgoing },
                    Said::Linear | Said::Step => Tangents::Auto,
                },
                ..Keyframe::new(f64::from(time[0]), value, interpolation)
            });
        }
        // Appendix C: a cubic goes as the signs say; on straight ways the short one is taken.
        let track = match self.said {
            Said::CubicSpline => Track::with_signs_as_given(keys, Extrapolation::Hold),
            Said::Linear | Said::Step => Track::new(keys, Extrapolation::Hold),
        };
        track.map_err(|error| Trouble::Unreadable(error.to_string()))
    }
}

fn vector(given: [f32; 3]) -> DVec3 {
    DVec3::from(given.map(f64::from))
}
