//! Pelvis, spine, neck and head of a fitted body.

use glam::{Mat3, Vec3};

use posekit::body::Limb;
use posekit::skeleton::{JointId, Skeleton};

use crate::mesh::{LoftRing, MaterialId, Shape};

use super::fitter::{DOME, Fitter, LARGE_SEGMENTS, Mannequin, SEGMENTS, curve, domed};

/// Half depth of the trunk from the crotch (-0.2) over the hips (0) to the neck (1), in statures.
const DEPTH: &[(f32, f32)] = &[
    (-0.22, 0.040),
    (-0.08, 0.060),
    (0.06, 0.064),
    (0.25, 0.058),
    (0.42, 0.052),
    (0.60, 0.058),
    (0.78, 0.066),
    (0.90, 0.056),
    (1.0, 0.040),
];

/// Head rings from the chin to the crown, in statures: height, half width, half depth, how far
/// forward.
const HEAD: &[[f32; 4]] = &[
    [-0.066, 0.015, 0.018, 0.022],
    [-0.062, 0.024, 0.029, 0.019],
    [-0.050, 0.032, 0.039, 0.014],
    [-0.034, 0.038, 0.046, 0.009],
    [-0.012, 0.043, 0.053, 0.004],
    [0.010, 0.0455, 0.0565, 0.0],
    [0.030, 0.0435, 0.0545, -0.002],
    [0.047, 0.036, 0.046, -0.003],
    [0.058, 0.026, 0.033, -0.004],
    [0.0645, 0.014, 0.018, -0.004],
];

/// Half the head's height, in statures.
const HEAD_HALF: f32 = 0.067;

/// From the joint at the base of the skull to the crown, in statures.
const CROWN: f32 = 0.118;

/// A joint of the head that ends the figure and is this far from the one before, in statures, is the
/// middle of the skull: depth cameras see no other. From the neck's base to the skull's it is 0.05 to 0.07.
const TO_MIDDLE_OF_SKULL: f32 = 0.08;

/// How far the trunk goes down from the hips, by the measure of [`DEPTH`].
const CROTCH: f32 = -0.2;

/// How far it goes down at most, as a share of the thigh: a short-legged figure would have its knees in the trunk.
const CROTCH_OF_THIGH: f32 = 0.3;

/// Half the length of skin that bends between two joints of the spine, as a share of the trunk.
const BEND: f32 = 0.045;
/// From ring to ring of the trunk's skin, by the same measure.
const RING_DISTANCE: f32 = 0.05;

/// Places of the trunk that everything else hangs on.
struct Frame {
    hips: Vec3,
    top: Vec3,
    hip_half_width: f32,
    chest_half_width: f32,
    /// How far the trunk goes down from the hips; less than 0, as a share of its height above them.
    crotch: f32,
}

pub(super) fn add_trunk(fitter: &mut Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>) {
    let frame = frame(fitter, figure);
    add_torso(fitter, figure, &frame);
    add_neck(fitter, figure, &frame);
    add_head(fitter, skeleton, figure);
}

fn frame(fitter: &Fitter<'_>, figure: &Mannequin<'_>) -> Frame {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let middle = |a: JointId, b: JointId| (fitter.at(a) + fitter.at(b)) * 0.5;
    let half_span =
        |a: JointId, b: JointId| (fitter.at(a) - fitter.at(b)).dot(axes.left).abs() * 0.5;
    let [left_leg, right_leg] = &anatomy.legs;
    let hips = middle(left_leg.upper, right_leg.upper);
    let hip_half_width = half_span(left_leg.upper, right_leg.upper) + 0.036 * stature;
    let neck = anatomy.neck();
    let toward = fitter.at(neck) - hips;
    let along = toward.dot(axes.up).max(1e-6);
    let (top, chest_half_width) = match &anatomy.arms {
        Some([l, r]) => {
            let shoulders = middle(l.upper, r.upper);
            let rise = (shoulders - hips).dot(axes.up) + 0.030 * stature;
            // The neck's base is a little over the shoulders, on the line to the neck or the head; of
            // one who carries the head before high shoulders, the shoulders'.
            let top = if rise < 1.25 * along {
                hips + toward * (rise / along)
            } else {
                shoulders + axes.up * (0.030 * stature)
            };
            (top, half_span(l.upper, r.upper) * 0.98)
        }
        None => (hips + toward, 0.09 * stature),
    };
    let widest_chest = (0.108 * stature).max(0.6 * chest_half_width);
    let height = trunk_height(hips, top, figure);
    let thigh = |leg: &Limb| fitter.at(leg.upper).distance(fitter.at(leg.middle));
    let thigh = thigh(left_leg).min(thigh(right_leg));
    Frame {
        crotch: CROTCH.max(-CROTCH_OF_THIGH * thigh / height),
        hips,
        top,
        hip_half_width: hip_half_width.clamp(0.07 * stature, 0.12 * stature),
        chest_half_width: chest_half_width.clamp(0.066 * stature, widest_chest),
    }
}

fn trunk_height(hips: Vec3, top: Vec3, figure: &Mannequin<'_>) -> f32 {
    (top - hips).dot(figure.axes.up).max(0.1 * figure.stature)
}

/// One skin over pelvis and spine, wide at hips and chest, narrow at the waist: every ring of it
/// rides on the joint it surrounds.
fn add_torso(fitter: &mut Fitter<'_>, figure: &Mannequin<'_>, frame: &Frame) {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let carriers: Vec<JointId> = std::iter::once(anatomy.pelvis)
        .chain(anatomy.trunk[..anatomy.spine_count].iter().copied())
        .collect();
    let height = trunk_height(frame.hips, frame.top, figure);
    let param = |p: Vec3| (p - frame.hips).dot(axes.up) / height;
    let width = width_profile(frame, stature);
    // Profiles are told for the usual crotch.
    let usual = |t: f32| {
        if t < 0.0 {
            t * (CROTCH / frame.crotch)
        } else {
            t
        }
    };
    // A spine's first joint can sit right in the pelvis; the pelvis keeps a block of its own.
    let mut cuts: Vec<f32> = carriers.iter().map(|&j| param(fitter.at(j))).collect();
    // Where the hierarchy comes down to the pelvis, a joint carries what is below it.
    for climbed in (1..=anatomy.climbed_count.min(carriers.len() - 1)).rev() {
        cuts[climbed] = cuts[climbed - 1];
    }
    cuts[0] = frame.crotch;
    cuts.push(1.0);
    if cuts.len() > 2 {
        cuts[1] = cuts[1].max(0.16);
    }
    for i in 1..cuts.len() {
        cuts[i] = cuts[i].max(cuts[i - 1]).min(1.0);
    }
    let mut rings: Vec<LoftRing> = Vec::new();
    let mut joints: Vec<JointId> = Vec::new();
    for (i, &joint) in carriers.iter().enumerate() {
        let is_last = i + 1 == carriers.len();
        let (from, to) = (cuts[i], cuts[i + 1]);
        if to - from < 0.02 {
            continue;
        }
        // The skin bends in the gaps between one joint's rings and the next one's.
        let gap = ((to - from) * 0.3).min(BEND);
        let from = if i == 0 { from } else { from + gap };
        let to = if is_last { to } else { to - gap };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to a small number"
        )]
        let steps = ((to - from) / RING_DISTANCE).clamp(1.0, 12.0) as usize;
        for k in 0..=steps {
            let t = from + (to - from) * k as f32 / steps as f32;
            let ring = LoftRing {
                center: trunk_point(fitter, &carriers, frame, t, height, axes.up),
                half_side: curve(&width, usual(t)),
                half_front: curve(DEPTH, usual(t)) * stature,
            };
            fitter.contact(joint, ring.center, ring.half_front);
            rings.push(ring);
            joints.push(joint);
        }
    }
    let (Some(&first), Some(&last)) = (joints.first(), joints.last()) else {
        return;
    };
    let skin = Shape::loft(
        &domed(&rings, 0.012 * stature, 0.016 * stature),
        axes.left,
        -axes.forward,
        2.4,
        LARGE_SEGMENTS,
    );
    let around = |joint: JointId, rings: usize| std::iter::repeat_n(joint, rings * LARGE_SEGMENTS);
    // As the loft lays them out: a pole, the rings, a pole.
    let carried: Vec<JointId> = std::iter::once(first)
        .chain(around(first, DOME))
        .chain(joints.iter().flat_map(|&joint| around(joint, 1)))
        .chain(around(last, DOME))
        .chain(std::iter::once(last))
        .collect();
    fitter.add_over(&carried, &skin, MaterialId::Base);
}

/// Half width of the trunk, by the same measure as [`DEPTH`].
fn width_profile(frame: &Frame, stature: f32) -> [(f32, f32); 9] {
    let (hip, chest) = (frame.hip_half_width, frame.chest_half_width);
    let waist = (hip + chest) * 0.5 * 0.82;
    let neck = 0.036 * stature;
    [
        (-0.22, hip * 0.50),
        (-0.10, hip * 0.86),
        (0.04, hip),
        (0.22, hip * 0.90),
        (0.42, waist),
        (0.62, chest * 0.93),
        (0.80, chest),
        (0.92, chest * 0.80),
        (1.0, (chest * 0.45).max(neck)),
    ]
}

/// The middle of the trunk's cross-section at `t`: on the polyline through hips, spine and neck.
fn trunk_point(
    fitter: &Fitter<'_>,
    carriers: &[JointId],
    frame: &Frame,
    t: f32,
    height: f32,
    up: Vec3,
) -> Vec3 {
    let param = |p: Vec3| (p - frame.hips).dot(up) / height;
    let mut before = frame.hips;
    for &joint in &carriers[1..] {
        let p = fitter.at(joint);
        if param(p) <= param(before) + 1e-3 {
            continue;
        }
        if param(p) >= t {
            return on_line(before, p, param(before), param(p), t);
        }
        before = p;
    }
    on_line(before, frame.top, param(before), param(frame.top), t)
}

fn on_line(a: Vec3, b: Vec3, at_a: f32, at_b: f32, t: f32) -> Vec3 {
    a + (b - a) * ((t - at_a) / (at_b - at_a).max(1e-6))
}

/// A round neck: one piece for every joint from the neck's base to the head.
fn add_neck(fitter: &mut Fitter<'_>, figure: &Mannequin<'_>, frame: &Frame) {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let radius = 0.029 * stature;
    let neck_at = fitter.at(anatomy.neck());
    // A neck that begins below the shoulders' top leaves the trunk in front.
    let is_low = (neck_at - frame.top).dot(axes.up) < -0.02 * stature;
    let mut from = if is_low {
        let height = (frame.top - frame.hips).dot(axes.up).max(1e-6);
        let share = (neck_at - frame.hips).dot(axes.up) / height;
        on_line(frame.hips, frame.top, 0.0, 1.0, share)
    } else {
        frame.top - axes.up * (0.015 * stature)
    };
    let mut carrier = anatomy.chest();
    let neck = anatomy.trunk[anatomy.spine_count..].iter().copied();
    // The last piece reaches into the skull, from below or from behind.
    let into_skull = if is_low { 0.0 } else { 0.03 * stature };
    let skull = fitter.at(anatomy.head) + axes.up * into_skull;
    for (joint, to) in neck
        .map(|joint| (joint, fitter.at(joint)))
        .chain(std::iter::once((anatomy.head, skull)))
        .collect::<Vec<_>>()
    {
        let way = to - from;
        let is_long = if is_low {
            way.length()
        } else {
            way.dot(axes.up)
        };
        if is_long > 0.004 * stature {
            let shape = Shape::tapered_capsule(from, radius * 1.05, to, radius, SEGMENTS);
            fitter.add(carrier, shape, MaterialId::Base);
            from = to;
        }
        carrier = joint;
    }
}

fn is_middle_of_skull(fitter: &Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>) -> bool {
    let head = figure.anatomy.head;
    let from_neck = fitter.at(head) - fitter.at(figure.anatomy.neck());
    figure.anatomy.neck() != head
        && skeleton.children(head).is_empty()
        && from_neck.length() > TO_MIDDLE_OF_SKULL * figure.stature
}

fn add_head(fitter: &mut Fitter<'_>, skeleton: &Skeleton, figure: &Mannequin<'_>) {
    let Mannequin {
        anatomy,
        axes,
        stature,
    } = *figure;
    let joint = fitter.at(anatomy.head);
    let up = axes.up;
    let crown = if is_middle_of_skull(fitter, skeleton, figure) {
        HEAD_HALF
    } else {
        CROWN
    };
    let top = joint + up * (crown * stature);
    let center = top - up * (HEAD_HALF * stature);
    let (left, forward) = (axes.left, axes.forward);
    let rings: Vec<LoftRing> = HEAD
        .iter()
        .map(|&[height, half_width, half_depth, ahead]| LoftRing {
            center: center + up * (height * stature) + forward * ((ahead + 0.008) * stature),
            half_side: half_width * stature,
            half_front: half_depth * stature,
        })
        .collect();
    let head = Shape::loft(&rings, left, -forward, 2.15, LARGE_SEGMENTS);
    fitter.add(anatomy.head, head, MaterialId::Base);
    fitter.contact(anatomy.head, center, 0.055 * stature);
    // A visor, so that one sees where the head faces.
    let eyes = center + up * (0.004 * stature) + forward * (0.044 * stature);
    let axes = Mat3::from_cols(left * 0.0385, up * 0.0135, forward * 0.024) * stature;
    fitter.add(
        anatomy.head,
        Shape::ellipsoid(eyes, axes, LARGE_SEGMENTS),
        MaterialId::Accent,
    );
}
