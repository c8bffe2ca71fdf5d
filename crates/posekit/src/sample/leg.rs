//! Legs: where hip and knee turn so that the foot is where it must be.

use glam::{DQuat, DVec3};

use super::curve::{about_x, about_y, from_axes};
use super::foot::FootPose;
use super::humanoid::{Figure, HIP_DOWN, HIP_SIDE, HIPS, LEFT_LEG, RIGHT_LEG, SHANK, THIGH};
use super::humanoid::{mirror_point, mirror_rotation};

/// Turns both legs of a figure, whose hips are placed and turned already, to the two feet. The
/// right foot is given as its mirror image, as a left one.
pub(super) fn reach_feet(figure: &mut Figure, left: &FootPose, right_mirrored: &FootPose) {
    let pelvis = figure.rotations[HIPS];
    let rotations = leg_rotations(figure.hips, pelvis, left);
    for (joint, rotation) in LEFT_LEG.0.into_iter().zip(rotations) {
        figure.rotations[joint] = rotation;
    }
    let (hips, pelvis) = (mirror_point(figure.hips), mirror_rotation(pelvis));
    let rotations = leg_rotations(hips, pelvis, right_mirrored);
    for (joint, rotation) in RIGHT_LEG.0.into_iter().zip(rotations) {
        figure.rotations[joint] = mirror_rotation(rotation);
    }
}

/// The left hip joint in pelvis space, metres.
pub(super) fn hip_in_pelvis() -> DVec3 {
    DVec3::new(HIP_SIDE, -HIP_DOWN, 0.0)
}

/// From hip to ankle when the knee bends by this much: the law of cosines.
pub(super) fn leg_length(knee_flexion_rad: f64) -> f64 {
    let square = THIGH * THIGH + SHANK * SHANK + 2.0 * THIGH * SHANK * libm::cos(knee_flexion_rad);
    libm::sqrt(square)
}

/// Local rotations of hip, knee, ankle and toes of a left leg: two links in closed form, the knee a
/// hinge whose axis follows the foot half-way and the pelvis half-way. An ankle out of reach is
/// reached for with the leg stretched.
fn leg_rotations(hips: DVec3, pelvis: DQuat, foot: &FootPose) -> [DQuat; 4] {
    let to_ankle = foot.ankle - (hips + pelvis * hip_in_pelvis());
    let distance = to_ankle
        .length()
        .clamp((THIGH - SHANK).abs() + 1e-6, THIGH + SHANK - 1e-9);
    let along = to_ankle.normalize();
    let side = pelvis * DVec3::X + about_y(foot.yaw) * DVec3::X;
    let axis = (side - side.dot(along) * along).normalize();
    let forward = axis.cross(-along);
    let cos_hip = (THIGH * THIGH + distance * distance - SHANK * SHANK) / (2.0 * THIGH * distance);
    let sin_hip = libm::sqrt((1.0 - cos_hip * cos_hip).max(0.0));
    let thigh = along * cos_hip + forward * sin_hip;
    let shank = (along * distance - thigh * THIGH) / SHANK;
    let thigh = from_axes(axis, -thigh);
    let shank = from_axes(axis, -shank.normalize());
    let orientation = foot.orientation();
    [
        pelvis.inverse() * thigh,
        thigh.inverse() * shank,
        shank.inverse() * orientation,
        about_x(foot.pitch - foot.toe_pitch),
    ]
}
