//! Arms and legs of a fitted body.

use glam::Vec3;

use posekit::body::{Limb, Side};
use posekit::skeleton::{JointId, Skeleton};

use crate::mesh::{LoftRing, MaterialId, Shape};

use super::fitter::{Fitter, Mannequin, SEGMENTS, domed};

// Radii along the limbs, in statures, at even steps.
const THIGH: [f32; 5] = [0.046, 0.050, 0.0465, 0.038, 0.0275];
const SHIN: [f32; 6] = [0.0255, 0.0340, 0.0350, 0.0290, 0.0220, 0.0170];
const UPPER_ARM: [f32; 5] = [0.031, 0.0305, 0.0280, 0.0245, 0.0190];
const FOREARM: [f32; 5] = [0.0180, 0.0250, 0.0235, 0.0185, 0.0130];
const KNEE: f32 = 0.0315;
const ANKLE: f32 = 0.0205;
const ELBOW: f32 = 0.0228;
const WRIST: f32 = 0.0165;

fn limb_material(side: Side) -> MaterialId {
    match side {
        Side::Left => MaterialId::Left,
        Side::Right => MaterialId::Right,
    }
}

pub(super) fn add_legs(fitter: &mut Fitter<'_>, figure: &Mannequin<'_>) {
    let stature = figure.stature;
    let sole = sole_height(fitter, figure);
    for leg in &figure.anatomy.legs {
        let material = limb_material(leg.side);
        let (hip, knee, ankle) = (
            fitter.at(leg.upper),
            fitter.at(leg.middle),
            fitter.at(leg.lower),
        );
        fitter.turned(
            leg.upper,
            (hip, knee),
            &THIGH.map(|r| r * stature),
            material,
        );
        fitter.ball(leg.middle, KNEE * stature, MaterialId::Accent);
        fitter.turned(
            leg.middle,
            (knee, ankle),
            &SHIN.map(|r| r * stature),
            material,
        );
        fitter.ball(leg.lower, ANKLE * stature, MaterialId::Accent);
        add_foot(fitter, figure, leg, sole);
    }
}

/// How far the sole lies under the ankle, along the figure's up: as the toes say, within reason.
fn sole_height(fitter: &Fitter<'_>, figure: &Mannequin<'_>) -> f32 {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let drop = |leg: &Limb| {
        let ankle = fitter.at(leg.lower);
        let toe = fitter.at(leg.tip.unwrap_or(leg.end));
        (ankle - toe).dot(axes.up)
    };
    let mean = anatomy.legs.iter().map(drop).sum::<f32>() * 0.5;
    (mean + 0.012 * stature).clamp(0.036 * stature, 0.062 * stature)
}

/// Heel to ball on the ankle's joint; the toes on their own joint if they have one.
fn add_foot(fitter: &mut Fitter<'_>, figure: &Mannequin<'_>, leg: &Limb, sole: f32) {
    let Mannequin { axes, stature, .. } = *figure;
    let up = axes.up;
    let ankle = fitter.at(leg.lower);
    let level = |v: Vec3| v - up * v.dot(up);
    let toward = leg
        .tip
        .map(|tip| level(fitter.at(tip) - ankle))
        .unwrap_or_default();
    let least = 0.02 * stature;
    let ahead = if toward.length() > least {
        toward.normalize()
    } else {
        axes.forward
    };
    let across = up.cross(ahead);
    let ground = ankle - up * sole;
    let reach = toward.length();
    let toe_joint = leg
        .tip
        .filter(|&tip| tip != leg.end && reach > least && reach < 0.13 * stature);
    // Distance from the ankle to the ball of the foot, and from there to the tip of the toes.
    let ball = if toe_joint.is_some() {
        reach
    } else {
        0.085 * stature
    };
    let toes = match toe_joint {
        Some(tip) => level(fitter.at(leg.end) - fitter.at(tip))
            .length()
            .max(0.048 * stature),
        None => (reach - ball).max(0.05 * stature),
    };
    let toes = toes.min(0.075 * stature);
    let ring = |along: f32, half_width: f32, top: f32| LoftRing {
        center: ground + ahead * along + up * (top * 0.5),
        half_side: half_width * stature,
        half_front: top * 0.5,
    };
    let instep = (sole * 1.12).min(0.058 * stature);
    let (s, toe_top) = (stature, 0.024 * stature);
    let mut rings = vec![
        ring(-0.026 * s, 0.019, instep * 0.80),
        ring(-0.012 * s, 0.0215, instep),
        ring(0.008 * s, 0.022, instep * 1.02),
        ring(ball * 0.45, 0.0235, instep * 0.80),
        ring(ball * 0.75, 0.026, (instep * 0.62).max(toe_top)),
        ring(ball, 0.0275, toe_top),
    ];
    let front = [
        ring(ball + toes * 0.35, 0.027, toe_top * 0.90),
        ring(ball + toes * 0.65, 0.024, toe_top * 0.78),
        ring(ball + toes * 0.82, 0.020, toe_top * 0.66),
    ];
    let dome = toes * 0.18;
    let loft = |rings: &[LoftRing], start: f32, end: f32| {
        Shape::loft(&domed(rings, start, end), across, up, 2.9, SEGMENTS)
    };
    for ring in &rings {
        fitter.contact(leg.lower, ring.center, ring.half_front);
    }
    let toe_carrier = toe_joint.unwrap_or(leg.lower);
    for ring in &front {
        fitter.contact(toe_carrier, ring.center, ring.half_front);
    }
    if let Some(toe) = toe_joint {
        fitter.add(
            leg.lower,
            loft(&rings, 0.012 * s, 0.010 * s),
            MaterialId::Accent,
        );
        let mut toe_rings = vec![rings[rings.len() - 1]];
        toe_rings.extend(front);
        fitter.add(toe, loft(&toe_rings, 0.010 * s, dome), MaterialId::Accent);
    } else {
        rings.extend(front);
        fitter.add(leg.lower, loft(&rings, 0.012 * s, dome), MaterialId::Accent);
    }
}

pub(super) fn add_arms(fitter: &mut Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>) {
    let stature = figure.stature;
    let Some(arms) = &figure.anatomy.arms else {
        return;
    };
    for arm in arms {
        let material = limb_material(arm.side);
        let (shoulder, elbow, wrist) = (
            fitter.at(arm.upper),
            fitter.at(arm.middle),
            fitter.at(arm.lower),
        );
        add_collar(fitter, skeleton, figure, arm);
        fitter.turned(
            arm.upper,
            (shoulder, elbow),
            &UPPER_ARM.map(|r| r * stature),
            material,
        );
        fitter.ball(arm.middle, ELBOW * stature, MaterialId::Accent);
        fitter.turned(
            arm.middle,
            (elbow, wrist),
            &FOREARM.map(|r| r * stature),
            material,
        );
        fitter.ball(arm.lower, WRIST * stature, MaterialId::Accent);
        add_hand(fitter, skeleton, figure, arm);
    }
}

/// From the neck's base to the shoulder, so that a raised shoulder takes its flesh along.
fn add_collar(fitter: &mut Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>, arm: &Limb) {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let shoulder = fitter.at(arm.upper);
    let carrier = arm
        .root
        .last()
        .copied()
        .or(skeleton.parent(arm.upper))
        .unwrap_or(arm.upper);
    let chest = fitter.at(anatomy.chest());
    let inward = (chest - shoulder).dot(axes.left);
    let start = shoulder + axes.left * (inward * 0.72) + axes.up * (0.010 * stature);
    let shape =
        Shape::tapered_capsule(start, 0.034 * stature, shoulder, 0.0325 * stature, SEGMENTS);
    fitter.add(carrier, shape, MaterialId::Base);
}

/// A mitten with a thumb, or a palm where the fingers have joints of their own.
fn add_hand(fitter: &mut Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>, arm: &Limb) {
    let Mannequin {
        axes, stature: s, ..
    } = *figure;
    let wrist = fitter.at(arm.lower);
    let along_arm = (wrist - fitter.at(arm.middle)).normalize_or(-axes.up);
    let out = arm
        .tip
        .map(|tip| fitter.at(tip) - wrist)
        .filter(|v| v.length() > 0.02 * s)
        .map_or(along_arm, |v| v.normalize_or(along_arm));
    // Hanging or held out, a hand at rest has its thumb to the front.
    let ahead = axes.forward - out * axes.forward.dot(out);
    let thumb_side = ahead.try_normalize().unwrap_or(axes.up);
    let back = out.cross(thumb_side);
    let fingers = has_fingers(skeleton, arm.lower);
    let length = if fingers { 0.055 * s } else { 0.098 * s };
    let ring = |t: f32, half_width: f32, half_thick: f32| LoftRing {
        center: wrist + out * (length * t),
        half_side: half_width * s,
        half_front: half_thick * s,
    };
    let rings = [
        ring(0.02, 0.0125, 0.0125),
        ring(0.22, 0.0195, 0.0125),
        ring(0.42, 0.0225, 0.0120),
        ring(0.62, 0.0220, 0.0105),
        ring(0.80, 0.0190, 0.0090),
        ring(0.92, 0.0155, 0.0075),
    ];
    let material = limb_material(arm.side);
    let shape = Shape::loft(
        &domed(&rings, 0.004 * s, length * 0.08),
        thumb_side,
        back,
        2.5,
        SEGMENTS,
    );
    fitter.add(arm.lower, shape, material);
    fitter.contact(arm.lower, wrist + out * (length * 0.5), 0.018 * s);
    if !fingers {
        let root = wrist + out * (length * 0.24) + thumb_side * (0.014 * s);
        let tip = wrist + out * (length * 0.60) + thumb_side * (0.032 * s);
        let thumb = Shape::tapered_capsule(root, 0.0090 * s, tip, 0.0065 * s, SEGMENTS / 2);
        fitter.add(arm.lower, thumb, material);
    }
}

/// Whether a hand has at least three fingers that have a joint each.
pub(super) fn has_fingers(skeleton: &Skeleton, hand: JointId) -> bool {
    skeleton
        .subtree(hand)
        .filter(|&j| !skeleton.is_end_site(j))
        .count()
        >= 7
}
