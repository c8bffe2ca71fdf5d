//! The mirror image of poses and keys: left becomes right.
//!
//! **Method.** A joint's rotation is taken as what it turns the rest pose by, in world axes; that turn
//! is mirrored and given to the joint's partner, again on top of its rest pose. So it does not matter
//! how the bones' own axes lie, as long as the rest pose itself is symmetric; for skeletons whose rest
//! rotations are all zero (every BVH) it is the plain reflection of the local rotation. Partners are
//! [`Skeleton::symmetric_pairs`]; a joint in no pair is mirrored onto itself.
//!
//! **Euler curves** keep their order. Where both joints' axes at rest are mirror images of each other (every
//! BVH), the angle about the axis across the figure keeps its sign and the other two change theirs, keys,
//! slopes and handles alike; whole turns stay. Where the axes lie otherwise, no change of signs does it: the
//! image is taken rotation by rotation, as [`to_euler`](super::super::to_euler) does, with keys added until it
//! is within a tenth of a degree.

use glam::{DQuat, DVec3};

use super::time::EditError;
use crate::keyframe::animation::Animation;
use crate::keyframe::convert::{ConvertConfig, Source, euler_of_curve};
use crate::keyframe::euler::{EulerTrack, RotationTrack};
use crate::keyframe::key::{Handle, Keyframe, Tangents};
use crate::keyframe::track::Track;
use crate::keyframe::value::KeyValue;
use crate::pose::{GlobalPose, LocalPose};
use crate::rotation::{Axis, angle_between};
use crate::skeleton::{JointId, Skeleton};

/// The axis, in world space, that points from one side of a figure to the other.
pub type MirrorAxis = Axis;

/// The axis that most separates a skeleton's symmetric pairs at rest; X where there are none, which is
/// right for a figure that faces along Z.
pub fn mirror_axis(skeleton: &Skeleton) -> MirrorAxis {
    let rest = GlobalPose::rest(skeleton);
    let apart = skeleton
        .symmetric_pairs()
        .iter()
        .fold(DVec3::ZERO, |sum, pair| {
            let [left, right] = [pair.left, pair.right].map(|joint| rest.positions[joint.index()]);
            sum + (left - right).as_dvec3()
        });
    let size = apart.abs();
    Axis::ALL
        .into_iter()
        .rev()
        .max_by(|a, b| size[a.index()].total_cmp(&size[b.index()]))
        .unwrap_or(Axis::X)
}

/// The mirror image of a pose across the plane through the origin, at right angles to an axis.
///
/// # Panics
/// If the pose has not as many joints as the skeleton.
pub fn mirror_pose(skeleton: &Skeleton, axis: MirrorAxis, pose: &LocalPose) -> LocalPose {
    assert_eq!(
        pose.joint_count(),
        skeleton.joint_count(),
        "a pose of this skeleton"
    );
    let mirror = Mirror::new(skeleton, axis);
    let mut image = pose.clone();
    for joint in skeleton.joints() {
        let way = mirror.way(joint);
        let rotation = pose.rotations[joint.index()].as_dquat();
        image.rotations[way.to.index()] = way.rotation(rotation).as_quat();
        let translation = pose.translations[joint.index()].as_dvec3();
        image.translations[way.to.index()] = way.vector(translation).as_vec3();
    }
    image
}

/// The mirror image of all tracks across the plane through the origin, at right angles to an axis:
/// each joint gets its partner's track reflected, its keys moved by `later_secs`. Half a cycle later,
/// a step of one leg becomes the step of the other.
///
/// # Errors
/// [`EditError::Track`] when `later_secs` is not finite.
pub fn mirror_animation(
    animation: &Animation,
    axis: MirrorAxis,
    later_secs: f64,
) -> Result<Animation, EditError> {
    let skeleton = animation.skeleton();
    let mirror = Mirror::new(skeleton, axis);
    let mut image = Animation::new(skeleton.clone());
    for (joint, track) in animation.rotations() {
        let way = mirror.way(joint);
        let track: RotationTrack = match track {
            RotationTrack::Quaternion(track) => mapped(
                track,
                later_secs,
                |rotation| way.rotation(rotation),
                |none| none,
            )?
            .into(),
            RotationTrack::Euler(track) => way.euler(track, later_secs)?.into(),
        };
        image = image.with_rotation(way.to, Some(track));
    }
    for (joint, track) in animation.translations() {
        let way = mirror.way(joint);
        let size = |secs| way.size(secs);
        let track = mapped(track, later_secs, |vector| way.vector(vector), size)?;
        image = image.with_translation(way.to, Some(track));
    }
    Ok(image)
}

/// The track with a linear map done to values and slopes, keys moved in time. `map_size` does it to how far
/// handles reach in time.
fn mapped<V: KeyValue>(
    track: &Track<V>,
    later_secs: f64,
    map: impl Fn(V) -> V,
    map_size: impl Fn(V) -> V,
) -> Result<Track<V>, EditError> {
    let keys = track.keys().iter().map(|key| Keyframe {
        time_secs: key.time_secs + later_secs,
        value: map(key.value),
        interpolation: key.interpolation,
        tangents: match key.tangents {
            Tangents::Aligned(tangent) => Tangents::Aligned(map(tangent)),
            Tangents::Broken { incoming, outgoing } => Tangents::Broken {
                incoming: map(incoming),
                outgoing: map(outgoing),
            },
            Tangents::Handles {
                incoming,
                outgoing,
                pair,
            } => {
                let image = |handle: Handle<V>| Handle {
                    secs: map_size(handle.secs),
                    value: map(handle.value),
                };
                Tangents::Handles {
                    incoming: image(incoming),
                    outgoing: image(outgoing),
                    pair,
                }
            }
            by_neighbours => by_neighbours,
        },
    });
    Ok(Track::with_ends(
        keys.collect(),
        track.before(),
        track.after(),
    )?)
}

struct Mirror {
    axis: Axis,
    partners: Vec<JointId>,
    /// World orientation at rest of each joint, and of its parent.
    rest: Vec<[DQuat; 2]>,
    /// Rest rotation in the parent's space.
    rest_local: Vec<DQuat>,
}

impl Mirror {
    fn new(skeleton: &Skeleton, axis: Axis) -> Self {
        let mut partners: Vec<JointId> = skeleton.joints().collect();
        for pair in skeleton.symmetric_pairs() {
            partners[pair.left.index()] = pair.right;
            partners[pair.right.index()] = pair.left;
        }
        let global = GlobalPose::rest(skeleton);
        let orientation = |joint: JointId| global.orientations[joint.index()].as_dquat();
        let rest = skeleton.joints().map(|joint| {
            let parent = skeleton.parent(joint).map_or(DQuat::IDENTITY, orientation);
            [orientation(joint), parent]
        });
        let local = skeleton.rest_rotations().iter();
        Self {
            axis,
            partners,
            rest: rest.collect(),
            rest_local: local.map(|rotation| rotation.as_dquat()).collect(),
        }
    }

    fn way(&self, from: JointId) -> Way {
        let to = self.partners[from.index()];
        Way {
            to,
            axis: self.axis,
            parents: [from, to].map(|joint| self.rest[joint.index()][1]),
            locals: [from, to].map(|joint| self.rest_local[joint.index()]),
        }
    }
}

/// From a joint to its partner.
struct Way {
    to: JointId,
    axis: Axis,
    /// World orientations of both joints' parents at rest.
    parents: [DQuat; 2],
    /// Rest rotations of both joints in their parents' space.
    locals: [DQuat; 2],
}

impl Way {
    fn rotation(&self, rotation: DQuat) -> DQuat {
        let [parent, parent_to] = self.parents;
        let [local, local_to] = self.locals;
        let in_world = parent * rotation * local.conjugate() * parent.conjugate();
        let image = mirrored_rotation(in_world, self.axis);
        parent_to.conjugate() * image * parent_to * local_to
    }

    fn vector(&self, vector: DVec3) -> DVec3 {
        let [parent, parent_to] = self.parents;
        let mut in_world = parent * vector;
        in_world[self.axis.index()] *= -1.0;
        parent_to.conjugate() * in_world
    }

    /// How far in time the image's handles reach. Where a component is made of several, so is its reach.
    fn size(&self, secs: DVec3) -> DVec3 {
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let image = self.vector(axis);
            image * image
        });
        x * secs.x + y * secs.y + z * secs.z
    }

    /// Euler curves in the same order. See the module's documentation for the signs.
    fn euler(&self, track: &EulerTrack, later_secs: f64) -> Result<EulerTrack, EditError> {
        /// Rest axes this far from each other's images are not meant to be so; a file's digits are finer.
        const SAME_AXES_RAD: f64 = 1e-4;
        let order = track.order();
        let angles = track.angles_deg();
        let is_of_signs = [
            DQuat::IDENTITY,
            DQuat::from_rotation_x(1.0),
            DQuat::from_rotation_y(1.0),
            DQuat::from_rotation_z(1.0),
        ]
        .into_iter()
        .all(|turn| {
            let by_signs = mirrored_rotation(turn, self.axis);
            angle_between(self.rotation(turn), by_signs) < SAME_AXES_RAD
        });
        if is_of_signs {
            let mut signs = DVec3::ONE;
            for (slot, axis) in order.axes().iter().enumerate() {
                if *axis != self.axis {
                    signs[slot] = -1.0;
                }
            }
            let image = mapped(angles, later_secs, |angles| angles * signs, |secs| secs)?;
            return Ok(track.with_angles_deg(image));
        }
        let times: Vec<f64> = angles.times_secs().iter().map(|t| t + later_secs).collect();
        let source = Source {
            times_secs: &times,
            ways: angles.keys().iter().map(|key| key.interpolation).collect(),
            beyond: [angles.before(), angles.after()],
        };
        let image = |time: f64| self.rotation(track.sample(time - later_secs));
        let near = angles.sample(angles.start_secs());
        let converted = euler_of_curve(&source, image, order, near, &ConvertConfig::default())?;
        Ok(converted.track)
    }
}

/// A reflection turns the axis of a rotation like a point and its sense round: the component along the
/// mirror's axis keeps its sign, the other two change it.
fn mirrored_rotation(rotation: DQuat, axis: Axis) -> DQuat {
    let mut image = -rotation.xyz();
    image[axis.index()] *= -1.0;
    DQuat::from_vec4(image.extend(rotation.w))
}
