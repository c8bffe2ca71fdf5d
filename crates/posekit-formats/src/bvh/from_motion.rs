//! From the library's motion to a document.

use std::sync::Arc;

use posekit::motion::{Channel, Motion};
use posekit::rotation::{Axis, EulerOrder};
use posekit::skeleton::{JointId, Skeleton};

use super::document::implied_end_name;
use super::{Bvh, BvhJoint, BvhMotion, EndName};

/// Decimals that lengths and angles in degrees are rounded to: beyond what the `f32` of a motion can
/// tell, for lengths up to ten units and any angle.
const DECIMALS_KEPT: f64 = 1e6;

impl Bvh {
    /// A document of a motion: position and rotation channels on the joints that are translated,
    /// rotation channels in `order` on the others, none on End Sites. Angles are those closest to the
    /// frame before, lengths and angles rounded to six decimals.
    ///
    /// Rest rotations, which BVH has no word for, become part of the motion. With an order that is
    /// not complete, rotations are the nearest that it can make. A leaf that is no End Site gets none.
    ///
    /// The joints stand in depth-first order, as the format has it, whatever their order in the
    /// skeleton.
    pub fn from_motion(motion: &Motion, order: EulerOrder) -> Self {
        Self::from_motion_with(motion, |_| order)
    }

    /// As [`from_motion`](Self::from_motion), with an order for each joint.
    pub fn from_motion_with(motion: &Motion, order_of: impl Fn(JointId) -> EulerOrder) -> Self {
        let mut rows = Rows::of(motion, order_of);
        let mut values = Vec::new();
        rows.append(motion, &mut values);
        Self {
            joints: rows.joints(),
            motion: Some(BvhMotion {
                frame_time_secs: motion.frame_time_secs(),
                frame_count: motion.frame_count(),
                values,
            }),
        }
    }
}

/// The rows of a motion that may come in pieces, one after the other.
pub(super) struct Rows {
    skeleton: Arc<Skeleton>,
    /// Of each joint of the skeleton.
    orders: Vec<EulerOrder>,
    /// Depth first, as the rows have them.
    ids: Vec<JointId>,
    is_translated: Vec<bool>,
    /// The angles of the last frame, which those of the next are closest to.
    previous_rad: Vec<[f64; 3]>,
}

impl Rows {
    /// Rows for the skeleton and the translated joints of a motion.
    pub(super) fn of(motion: &Motion, order_of: impl Fn(JointId) -> EulerOrder) -> Self {
        let skeleton = Arc::clone(motion.skeleton());
        let orders = skeleton.joints().map(order_of).collect();
        let ids = depth_first(&skeleton);
        let mut is_translated = vec![false; ids.len()];
        for joint in motion.translated_joints() {
            is_translated[joint.index()] = true;
        }
        Self {
            previous_rad: vec![[0.0; 3]; ids.len()],
            skeleton,
            orders,
            ids,
            is_translated,
        }
    }

    /// The joints of the document, in the order of the rows.
    pub(super) fn joints(&self) -> Vec<BvhJoint> {
        let skeleton = &*self.skeleton;
        let mut place_of = vec![0; self.ids.len()];
        for (place, id) in self.ids.iter().enumerate() {
            place_of[id.index()] = place;
        }
        let joints = self.ids.iter().map(|&id| {
            let is_end_site = skeleton.is_end_site(id);
            let is_translated = self.is_translated[id.index()];
            BvhJoint {
                name: name(skeleton, id),
                parent: skeleton.parent(id).map(|parent| place_of[parent.index()]),
                offset: skeleton
                    .rest_translation(id)
                    .as_dvec3()
                    .to_array()
                    .map(rounded),
                channels: channels(is_end_site, is_translated, self.orders[id.index()]),
                is_end_site,
                end_name: end_name(skeleton, id),
            }
        });
        joints.collect()
    }

    /// Appends the rows of a motion, which goes on where the one before ended.
    pub(super) fn append(&mut self, motion: &Motion, values: &mut Vec<f64>) {
        let with_channels = |&&id: &&JointId| !self.skeleton.is_end_site(id);
        for frame in 0..motion.frame_count() {
            for &id in self.ids.iter().filter(with_channels) {
                if self.is_translated[id.index()] {
                    let place = motion.translation(frame, id).as_dvec3();
                    values.extend(place.to_array().map(rounded));
                }
                let order = self.orders[id.index()];
                let previous = &mut self.previous_rad[id.index()];
                let rotation = motion.rotation(frame, id).as_dquat();
                *previous = order.from_quat_near(rotation, *previous).angles_rad;
                let angles = previous.iter().take(order.axes().len());
                values.extend(angles.map(|angle| rounded(angle.to_degrees())));
            }
        }
    }
}

fn depth_first(skeleton: &Skeleton) -> Vec<JointId> {
    skeleton
        .roots()
        .flat_map(|root| skeleton.subtree(root))
        .collect()
}

/// An End Site is named in the file where its name says more than its parent's; in a comment, since that
/// is what every reader reads past.
fn end_name(skeleton: &Skeleton, joint: JointId) -> EndName {
    match skeleton.parent(joint) {
        Some(parent) if skeleton.is_end_site(joint) => {
            let implied = implied_end_name(skeleton.name(parent).as_bytes());
            let name = skeleton.name(joint).as_bytes();
            if name.is_empty() || name == implied {
                EndName::Implied
            } else {
                EndName::Comment
            }
        }
        _ => EndName::Implied,
    }
}

fn name(skeleton: &Skeleton, joint: JointId) -> Vec<u8> {
    let own = skeleton.name(joint).as_bytes();
    match skeleton.parent(joint) {
        Some(parent) if skeleton.is_end_site(joint) && own.is_empty() => {
            implied_end_name(skeleton.name(parent).as_bytes())
        }
        _ => own.to_vec(),
    }
}

fn channels(is_end_site: bool, is_translated: bool, order: EulerOrder) -> Vec<Channel> {
    if is_end_site {
        return Vec::new();
    }
    let positions = Axis::ALL
        .into_iter()
        .filter(|_| is_translated)
        .map(Channel::Position);
    positions
        .chain(order.axes().iter().copied().map(Channel::Rotation))
        .collect()
}

/// Rounded, and never `-0`.
fn rounded(value: f64) -> f64 {
    (value * DECIMALS_KEPT).round() / DECIMALS_KEPT + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use posekit::motion::PositionPolicy;

    #[test]
    fn a_document_of_a_motion_makes_the_same_motion() {
        let motion = posekit::sample::by_name("walk").unwrap();
        let bvh = Bvh::from_motion(&motion, EulerOrder::ZXY);
        bvh.validate().unwrap();
        let again = bvh.to_motion(PositionPolicy::Replace).unwrap();
        assert_eq!(again.frame_count(), motion.frame_count());
        let (a, b) = (motion.to_global(), again.to_global());
        for frame in 0..motion.frame_count() {
            for joint in motion.skeleton().joints() {
                let name = motion.skeleton().unique_name(joint);
                let there = again.skeleton().find(name).unwrap();
                let gap = a.position(frame, joint).distance(b.position(frame, there));
                assert!(gap < 1e-5, "{name} at {frame}: {gap}");
            }
        }
        let read = crate::bvh::read(&crate::bvh::write(&bvh)).unwrap();
        assert_eq!(read.document, bvh);
        assert!(read.report.is_empty(), "{:?}", read.report);
    }
}
