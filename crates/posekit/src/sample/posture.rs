//! Trunk and arms of the figure, in the terms of a clinician: lean, list, flexion, abduction.

use glam::DQuat;

use super::curve::{about_x, about_y, about_z};
use super::humanoid::{CHEST, Figure, HEAD, HIPS, LEFT_ARM, RIGHT_ARM, SPINE, mirror_rotation};

/// Turns the trunk so that chest and head have these orientations in the world; spine and chest
/// share the way from the pelvis, which is turned already.
pub(super) fn turn_trunk(figure: &mut Figure, chest: DQuat, head: DQuat) {
    let chest_from_pelvis = figure.rotations[HIPS].inverse() * chest;
    let half = half_way(chest_from_pelvis);
    figure.rotations[SPINE] = half;
    figure.rotations[CHEST] = half.inverse() * chest_from_pelvis;
    figure.rotations[HEAD] = chest.inverse() * head;
}

/// An orientation of the pelvis, the chest or the head in the world. Angles in degrees.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bearing {
    /// Left side forward.
    pub(super) yaw: f64,
    /// Left side up.
    pub(super) list: f64,
    /// Leaning or nodding forward.
    pub(super) lean: f64,
}

impl Bearing {
    pub(super) fn rotation(&self) -> DQuat {
        about_y(-self.yaw.to_radians())
            * about_z(self.list.to_radians())
            * about_x(self.lean.to_radians())
    }
}

/// The rotation that gives `rotation` when it is done twice.
fn half_way(rotation: DQuat) -> DQuat {
    let same = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    DQuat::from_xyzw(same.x, same.y, same.z, same.w + 1.0).normalize()
}

/// The joint angles of an arm, in degrees; all zero is the arm hanging straight down with the palm
/// towards the body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ArmPose {
    /// Upper arm forward.
    pub(super) flexion: f64,
    /// Upper arm away from the body.
    pub(super) abduction: f64,
    /// Upper arm turned inwards about itself.
    pub(super) inward: f64,
    pub(super) elbow: f64,
    /// Hand bent towards the palm.
    pub(super) wrist: f64,
    /// Hand bent towards the thumb.
    pub(super) deviation: f64,
    /// Shoulder girdle forward.
    pub(super) girdle_forward: f64,
    /// Shoulder girdle up.
    pub(super) girdle_up: f64,
}

impl ArmPose {
    /// Local rotations of shoulder girdle, shoulder, elbow and wrist of a left arm.
    fn rotations(&self) -> [DQuat; 4] {
        let upper = about_x(-self.flexion.to_radians())
            * about_z((self.abduction - 90.0).to_radians())
            * about_x(self.inward.to_radians());
        [
            about_y(-self.girdle_forward.to_radians()) * about_z(self.girdle_up.to_radians()),
            upper,
            about_y(-self.elbow.to_radians()),
            about_y(-self.deviation.to_radians()) * about_z(-self.wrist.to_radians()),
        ]
    }

    pub(super) fn turn_left(&self, figure: &mut Figure) {
        for (joint, rotation) in LEFT_ARM.0.into_iter().zip(self.rotations()) {
            figure.rotations[joint] = rotation;
        }
    }

    pub(super) fn turn_right(&self, figure: &mut Figure) {
        for (joint, rotation) in RIGHT_ARM.0.into_iter().zip(self.rotations()) {
            figure.rotations[joint] = mirror_rotation(rotation);
        }
    }
}
