//! Turns that solvers are made of.

use core::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::linkage::{Effector, Linkage, NONE};
use super::problem::IkProblem;
use crate::rotation::{exp, slerp};

/// Below this share of the product of two lengths, one plus the cosine between them is noise.
const OPPOSITE: f64 = 1e-15;

/// Vectors shorter than this have no direction that would mean anything.
const SHORTEST_SQ: f64 = 1e-60;

/// In how many ways a chain that is stuck can be bent: joints that are no hinges about an axis across their line,
/// the axis of the next hinge, and an axis across both, each to one side and to the other.
pub(crate) const WAYS: usize = 6;

/// The shortest turn from the direction of `a` to that of `b`, or `None` if one of them has none.
///
/// Opposite directions are half a turn apart about [`perpendicular`] of `a`.
#[inline]
pub(crate) fn shortest_turn(a: DVec3, b: DVec3) -> Option<DQuat> {
    shortest_turn_or(a, b, || DQuat::from_vec4(perpendicular(a).extend(0.0)))
}

/// [`shortest_turn`] for loops in which each turn waits for the one before: a call for each joint makes CCD half as slow
/// again.
#[inline(always)]
pub(crate) fn shortest_turn_inline(a: DVec3, b: DVec3) -> Option<DQuat> {
    shortest_turn_or(a, b, || half_turn_across(a))
}

/// The shortest turn, where the directions are opposite that of `half_turn`.
#[inline(always)]
fn shortest_turn_or(a: DVec3, b: DVec3, half_turn: impl FnOnce() -> DQuat) -> Option<DQuat> {
    let size_sq = a.length_squared() * b.length_squared();
    // Not `<`: products that overflowed to NaN have no direction either.
    if !(size_sq > SHORTEST_SQ && size_sq < f64::INFINITY) {
        return None;
    }
    let size = size_sq.sqrt();
    // Half-angle form: the vector part sin(angle) and the scalar part 1 + cos(angle), of one length.
    let scalar = size + a.dot(b);
    if scalar <= OPPOSITE * size {
        return Some(half_turn());
    }
    let vector = a.cross(b);
    let norm = (vector.length_squared() + scalar * scalar).sqrt();
    Some(DQuat::from_vec4(vector.extend(scalar) * (1.0 / norm)))
}

/// Half a turn about [`perpendicular`] of `v`.
#[cold]
#[inline(never)]
fn half_turn_across(v: DVec3) -> DQuat {
    DQuat::from_vec4(perpendicular(v).extend(0.0))
}

/// Turns and rolls this near to half a turn (one plus the cosine), and vectors this near to the line (the sine), are left
/// to the careful way: in half-angle form so many digits are lost there.
pub(crate) const NEAR_NOTHING: f64 = 1e-3;

/// The shortest turn from the direction of `a` to that of `b`, and after it the roll about `b` that brings `up` as near
/// to the direction `wanted` as can be.
///
/// Both are kept in half-angle form, of no particular length, and brought to unit length once, together: three square
/// roots and one division. `None` where one of them is near half a turn or a vector lies near the line, where digits are
/// lost: then they are to be found one after the other.
#[inline]
pub(crate) fn shortest_turn_and_roll(
    a: DVec3,
    b: DVec3,
    up: DVec3,
    wanted: DVec3,
) -> Option<DQuat> {
    let line_sq = b.length_squared();
    let (dot, vector) = (a.dot(b), a.cross(b));
    let size = (a.length_squared() * line_sq).sqrt();
    let scalar = size + dot;
    // Half of what the turn, which is `2 size scalar` too long, makes of `up`.
    let turned = up * (scalar * dot) + vector * vector.dot(up) + vector.cross(up) * scalar;
    // Cosine and sine of the roll, of the parts across the line, times the same length.
    let cosine = line_sq * turned.dot(wanted) - turned.dot(b) * wanted.dot(b);
    let sine = b.dot(turned.cross(wanted));
    let radius_sq = cosine * cosine + line_sq * (sine * sine);
    let radius = radius_sq.sqrt();
    let roll = DQuat::from_vec4((b * sine).extend(radius + cosine));
    let both = roll * DQuat::from_vec4(vector.extend(scalar));
    let norm_sq = both.length_squared();
    let longest = line_sq * scalar * size;
    let longest_sq = longest * longest * (up.length_squared() * wanted.length_squared());
    let is_clear = scalar > NEAR_NOTHING * size
        && radius + cosine > NEAR_NOTHING * radius
        && radius_sq > NEAR_NOTHING * NEAR_NOTHING * longest_sq
        // Nothing came near the ends of the range on the way.
        && norm_sq > 1e-250
        && norm_sq < 1e250;
    is_clear.then(|| both * (1.0 / norm_sq.sqrt()))
}

/// A unit vector perpendicular to `v`: its cross product with the coordinate axis along which `v` is
/// smallest, the first of these if there are several.
pub(crate) fn perpendicular(v: DVec3) -> DVec3 {
    let size = v.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    axis.cross(v).normalize_or_zero()
}

/// The part `share` of the way from one turn to another.
pub(crate) fn shortened(from: DQuat, to: DQuat, share: f64) -> DQuat {
    if share >= 1.0 {
        to
    } else {
        slerp(from, to, share)
    }
}

/// Swivels each chain about the line from its first joint to its effector so that the joints that have
/// poles are on the side of their poles, as far as weights and limits allow.
pub(crate) fn swivel(linkage: &mut Linkage, problem: &IkProblem) {
    for pole in &problem.poles {
        for index in 0..linkage.effectors.len() {
            let path = linkage.path(index);
            let is_drawn = |&&k: &&u32| linkage.pivots[k as usize].joint == pole.joint;
            let Some(&drawn) = path.iter().find(is_drawn) else {
                continue;
            };
            let first = path[0] as usize;
            let base = linkage.positions[first];
            let line = linkage.effector_position(index) - base;
            let drawn = linkage.positions[drawn as usize] - base;
            let Some(angle_rad) = swivel_angle(line, drawn, pole.point_in_world - base) else {
                continue;
            };
            let give = linkage.pivots[first].give * pole.weight.clamp(0.0, 1.0);
            let turn = exp(line.normalize_or_zero() * (angle_rad * give)) * linkage.turns[first];
            linkage.set_turn(first, turn);
        }
    }
}

/// The angle about `line` from the half plane of `from` to that of `to`; `None` where one of them lies on
/// the line.
pub(crate) fn swivel_angle(line: DVec3, from: DVec3, to: DVec3) -> Option<f64> {
    let axis = line.try_normalize()?;
    let (from, to) = (
        from.reject_from_normalized(axis),
        to.reject_from_normalized(axis),
    );
    let size = from.length() * to.length();
    if size <= 1e-12 * line.length_squared() {
        return None;
    }
    let angle_rad = libm::atan2(from.cross(to).dot(axis), from.dot(to));
    (angle_rad.abs() <= PI).then_some(angle_rad)
}

impl Linkage {
    /// Turns pivot `k`'s outer link to `turn`, within its limits, and carries everything beyond it along.
    pub(crate) fn set_turn(&mut self, k: usize, turn: DQuat) {
        let turn = self.limited_turn(k, turn);
        let added = (turn * self.turns[k].conjugate()).normalize();
        self.turns[k] = turn;
        for next in k + 1..self.pivots.len() {
            if self.is_beyond(next, k) {
                self.turns[next] = added * self.turns[next];
            }
        }
        self.place();
    }

    /// Whether a pivot comes after another on a way from the base.
    fn is_beyond(&self, pivot: usize, other: usize) -> bool {
        let mut next = self.pivots[pivot].parent;
        while next != NONE {
            if next as usize == other {
                return true;
            }
            next = self.pivots[next as usize].parent;
        }
        false
    }

    /// Brings joints that start outside their limits within them.
    pub(crate) fn enforce_limits(&mut self) {
        for k in 0..self.pivots.len() {
            let pivot = &self.pivots[k];
            match pivot.limit {
                super::limit::JointLimit::Free | super::limit::JointLimit::Fixed => {}
                super::limit::JointLimit::Slide { distance, .. } => {
                    let start = pivot.slid_at_start;
                    self.slides[k] = distance.clamp(start) - start;
                    self.place();
                }
                _ => {
                    let now = self.turns[k];
                    if self.limited_turn(k, now) != now {
                        self.set_turn(k, now);
                    }
                }
            }
        }
    }

    /// Bends every joint a little, to get out of a pose in which no joint can do anything on its own.
    /// Whether anything moved.
    ///
    /// A hinge bends about its own axis, whichever way its range leaves open. Other joints bend across the line
    /// to their effector, in one of [`WAYS`]: a knee that bends one way only follows a hip that bends the
    /// other way, so there may be one that helps.
    pub(crate) fn nudge(&mut self, angle_rad: f64, way: usize) -> bool {
        let mut has_moved = false;
        for index in 0..self.effectors.len() {
            let Effector {
                path_start,
                path_end,
                ..
            } = self.effectors[index];
            for step in path_start..path_end {
                let k = self.paths[step] as usize;
                if !self.pivots[k].turns {
                    continue;
                }
                let axis_of = |k: usize| self.pivots[k].hinge_axis(self.inner_turn(k));
                let axes = if let Some(axis) = axis_of(k) {
                    [axis, -axis]
                } else {
                    let line = self.effector_position(index) - self.positions[k];
                    let across = perpendicular(line);
                    let mut beyond = self.paths[step..path_end].iter();
                    let axis = match way / 2 {
                        0 => across,
                        1 => beyond
                            .find_map(|&next| axis_of(next as usize))
                            .unwrap_or(across),
                        _ => across.cross(line).normalize_or_zero(),
                    };
                    let axis = if way.is_multiple_of(2) { axis } else { -axis };
                    [axis, across.cross(axis).normalize_or_zero()]
                };
                has_moved |= axes.iter().any(|&axis| {
                    let before = self.turns[k];
                    self.set_turn(k, exp(axis * angle_rad) * before);
                    self.turns[k].dot(before).abs() < 1.0 - 1e-9
                });
            }
        }
        has_moved
    }
}
