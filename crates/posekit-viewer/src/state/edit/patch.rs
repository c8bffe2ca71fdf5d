//! New values for some joints over some frames of a clip: in its motion and in its document at once,
//! so that what is seen is what is saved, and every digit that was not edited stays as it is.

use std::sync::Arc;

use glam::{DQuat, Quat, Vec3};
use posekit::figure::UpAxis;
use posekit::motion::{Channel, Motion};
use posekit::pose::LocalPose;
use posekit::rotation::{Axis, EulerOrder};
use posekit::skeleton::JointId;
use posekit_formats::bvh::Bvh;
use posekit_formats::bvh::edit::{set_rotation, set_translation};

use super::spread::Spread;
use crate::state::clip::{Clip, Reading};

/// What the file lets a joint do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Freedom {
    /// The order of its rotation channels; `None` where it has none.
    pub turns: Option<EulerOrder>,
    /// Whether it has all three position channels.
    pub moves: bool,
}

/// What a document lets a joint do.
///
/// # Panics
/// If there is no such joint.
#[must_use]
pub fn freedom(document: &Bvh, joint: JointId) -> Freedom {
    let channels = &document.joints[joint.index()].channels;
    let axes: Vec<Axis> = channels
        .iter()
        .filter_map(|channel| match channel {
            Channel::Rotation(axis) => Some(*axis),
            Channel::Position(_) => None,
        })
        .collect();
    let moves = Axis::ALL
        .into_iter()
        .all(|axis| channels.contains(&Channel::Position(axis)));
    let order = EulerOrder::new(&axes).ok();
    Freedom {
        turns: order.filter(|order| !order.axes().is_empty()),
        moves,
    }
}

/// The rotation nearest to `rotation` that a joint's channels can make.
#[must_use]
pub fn reachable(order: EulerOrder, rotation: Quat) -> Quat {
    if order.is_complete() {
        return rotation;
    }
    let angles = order.from_quat(double(rotation)).angles_rad;
    order.to_quat(angles).as_quat()
}

fn double(rotation: Quat) -> DQuat {
    rotation.as_dquat().normalize()
}

/// New local transforms for some joints over consecutive frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    first: usize,
    /// The joints that turn, and for each frame the rotation of each.
    turned: Vec<JointId>,
    rotations: Vec<Quat>,
    /// The joints that move, and for each frame the translation of each.
    moved: Vec<JointId>,
    translations: Vec<Vec3>,
    frame_count: usize,
}

/// What a [`Patch`] has replaced.
#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    patch: Patch,
    /// The columns of the document that changed, and for each frame their values.
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Patch {
    /// What an edited pose makes of a motion: `before` and `after` are its poses at `frame`. `None`
    /// when they are the same, or the motion has no frames.
    ///
    /// # Panics
    /// If the poses have not as many joints as the motion's skeleton.
    #[must_use]
    pub fn of_edit(
        motion: &Motion,
        frame: usize,
        (before, after): (&LocalPose, &LocalPose),
        spread: Spread,
    ) -> Option<Self> {
        let joint_count = motion.skeleton().joint_count();
        assert!(
            before.joint_count() == joint_count && after.joint_count() == joint_count,
            "poses of this skeleton"
        );
        if motion.frame_count() == 0 {
            return None;
        }
        let changed = |joints: &[JointId], differs: &dyn Fn(usize) -> bool| {
            let joints = joints.iter().copied();
            joints
                .filter(|joint| differs(joint.index()))
                .collect::<Vec<_>>()
        };
        let turned = changed(motion.rotated_joints(), &|j| {
            before.rotations[j] != after.rotations[j]
        });
        let moved = changed(motion.translated_joints(), &|j| {
            before.translations[j] != after.translations[j]
        });
        if turned.is_empty() && moved.is_empty() {
            return None;
        }
        let (first, last) = spread.frames(frame, motion.frame_count());
        let mut patch = Self {
            first,
            rotations: Vec::with_capacity(turned.len() * (last - first + 1)),
            translations: Vec::with_capacity(moved.len() * (last - first + 1)),
            turned,
            moved,
            frame_count: last - first + 1,
        };
        for there in first..=last {
            let weight = spread.weight(frame, there);
            for &joint in &patch.turned {
                let j = joint.index();
                let change = (before.rotations[j], after.rotations[j]);
                let here = motion.rotation(there, joint);
                // The edited frame itself gets exactly what was asked for.
                patch.rotations.push(if there == frame {
                    after.rotations[j]
                } else {
                    spread.blend.rotation(here, change, weight)
                });
            }
            for &joint in &patch.moved {
                let j = joint.index();
                let change = (before.translations[j], after.translations[j]);
                let here = motion.translation(there, joint);
                let translation = spread.blend.translation(here, change, weight);
                patch.translations.push(translation);
            }
        }
        Some(patch)
    }

    /// The joints it changes.
    pub fn joints(&self) -> impl Iterator<Item = JointId> + '_ {
        self.turned.iter().chain(&self.moved).copied()
    }

    /// First and last frame it changes.
    #[must_use]
    pub fn frames(&self) -> (usize, usize) {
        (self.first, self.first + self.frame_count - 1)
    }

    /// Writes it into a clip. Returns what was there, to put it back with [`Replaced::restore`].
    pub fn write(&self, clip: &mut Clip) -> Replaced {
        let document = Arc::make_mut(&mut clip.document);
        let starts = document.column_starts();
        let mut columns: Vec<usize> = self
            .joints()
            .flat_map(|joint| starts[joint.index()]..starts[joint.index() + 1])
            .collect();
        columns.sort_unstable();
        columns.dedup();
        let row = document.channel_count();
        let mut values = Vec::with_capacity(columns.len() * self.frame_count);
        if let Some(motion) = &document.motion {
            let rows = motion.values.chunks_exact(row.max(1));
            for frame in rows.skip(self.first).take(self.frame_count) {
                values.extend(columns.iter().map(|&column| frame[column]));
            }
        }
        self.write_document(document, clip.reading);
        let before = self.swap_motion(Arc::make_mut(&mut clip.motion));
        Arc::make_mut(&mut clip.global).update(&clip.motion);
        Replaced {
            patch: before,
            columns,
            values,
        }
    }

    /// Puts its values into a motion. Returns those that were there.
    fn swap_motion(&self, motion: &mut Motion) -> Self {
        let mut before = Self {
            rotations: Vec::with_capacity(self.rotations.len()),
            translations: Vec::with_capacity(self.translations.len()),
            ..self.clone()
        };
        before.rotations.clear();
        before.translations.clear();
        let frames = self.first..self.first + self.frame_count;
        let mut rotations = self.rotations.iter();
        let mut translations = self.translations.iter();
        for frame in frames {
            for (&joint, &rotation) in self.turned.iter().zip(&mut rotations) {
                before.rotations.push(motion.rotation(frame, joint));
                motion.set_rotation(frame, joint, rotation);
            }
            for (&joint, &translation) in self.moved.iter().zip(&mut translations) {
                before.translations.push(motion.translation(frame, joint));
                motion.set_translation(frame, joint, translation);
            }
        }
        before
    }

    /// What a joint's channels cannot say is left as it was: the motion has joints turn and move only
    /// where they can.
    ///
    /// The motion stands on Y and the document as its file does, so roots are turned back.
    fn write_document(&self, document: &mut Bvh, reading: Reading) {
        let file_from_y_up = reading.up.y_up_from_file().inverse();
        let turn_of = |document: &Bvh, joint: JointId| {
            let is_root = document.joints[joint.index()].parent.is_none();
            (is_root && reading.up != UpAxis::Y).then_some(file_from_y_up)
        };
        for step in 0..self.frame_count {
            let frame = self.first + step;
            let rotations = &self.rotations[step * self.turned.len()..];
            for (&joint, &rotation) in self.turned.iter().zip(rotations) {
                let rotation = turn_of(document, joint).map_or(rotation, |turn| turn * rotation);
                // The angles nearest to those that were there.
                set_rotation(document, joint.index(), frame, double(rotation), frame).ok();
            }
            let translations = &self.translations[step * self.moved.len()..];
            for (&joint, &translation) in self.moved.iter().zip(translations) {
                let translation =
                    turn_of(document, joint).map_or(translation, |turn| turn * translation);
                let (translation, positions) = (translation.as_dvec3(), reading.positions);
                set_translation(document, joint.index(), frame, translation, positions).ok();
            }
        }
    }
}

impl Replaced {
    /// Puts back what was there before the patch was written.
    pub fn restore(&self, clip: &mut Clip) {
        let document = Arc::make_mut(&mut clip.document);
        let row = document.channel_count();
        if let Some(motion) = &mut document.motion
            && !self.columns.is_empty()
        {
            let rows = motion.values.chunks_exact_mut(row.max(1));
            let rows = rows.skip(self.patch.first).take(self.patch.frame_count);
            for (frame, values) in rows.zip(self.values.chunks_exact(self.columns.len())) {
                for (&column, &value) in self.columns.iter().zip(values) {
                    frame[column] = value;
                }
            }
        }
        self.patch.swap_motion(Arc::make_mut(&mut clip.motion));
        Arc::make_mut(&mut clip.global).update(&clip.motion);
    }
}
