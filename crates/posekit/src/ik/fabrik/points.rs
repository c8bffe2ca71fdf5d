//! FABRIK on bare points: a chain of positions, no rotations.

use glam::DVec3;

/// Moves a chain of points so that its last one comes to the target; its first keeps its place, and so
/// does every distance between neighbours. How far the last point is from the target, and how many
/// iterations were made.
///
/// A target out of reach stretches the chain straight towards it, at once. Neighbours at one place stay
/// together. Iterations end with the last point within `tolerance`, or when they no longer bring it nearer.
/// Any length unit; nothing is allocated, `lengths` is filled.
///
/// # Panics
/// If `lengths` has not one entry less than there are points; there is at least one point.
pub fn fabrik_points(
    points: &mut [DVec3],
    lengths: &mut [f64],
    target: DVec3,
    tolerance: f64,
    max_iterations: u32,
) -> (f64, u32) {
    assert_eq!(
        points.len(),
        lengths.len() + 1,
        "a length between two points"
    );
    let mut reach = 0.0;
    for (length, pair) in lengths.iter_mut().zip(points.windows(2)) {
        *length = pair[0].distance(pair[1]);
        reach += *length;
    }
    let last = points.len() - 1;
    let base = points[0];
    let to_target = target - base;
    let left = points[last].distance(target);
    if left <= tolerance || !to_target.is_finite() {
        return (left, 0);
    }
    if to_target.length_squared() >= reach * reach {
        let direction = to_target.normalize_or_zero();
        for i in 0..last {
            points[i + 1] = points[i] + direction * lengths[i];
        }
        return (points[last].distance(target), 1);
    }
    let Some((_, moving)) = points.split_first_mut() else {
        return (left, 0);
    };
    // Distances are compared by their squares: their roots would only wait for each other.
    let near_sq = if tolerance >= 0.0 {
        tolerance * tolerance
    } else {
        -1.0
    };
    let mut left_sq = left * left;
    let mut iterations = 0;
    while iterations < max_iterations {
        iterations += 1;
        // Inwards. The last step would move the base, which keeps its place.
        if let Some((end, inner)) = moving.split_last_mut() {
            *end = target;
            lay_along(
                target,
                inner.iter_mut().zip(lengths[1..].iter().copied()).rev(),
            );
        }
        let at = lay_along(base, moving.iter_mut().zip(lengths.iter().copied()));
        let now_sq = at.distance_squared(target);
        let is_done = now_sq <= near_sq || now_sq >= left_sq;
        left_sq = now_sq;
        if is_done {
            break;
        }
    }
    (left_sq.sqrt(), iterations)
}

/// Lays points one after the other at their lengths from the one before, each on the line to where it was; the last of
/// them. Each point waits for the one before it, so that what counts is how long a step keeps the next one waiting: the
/// square of the next distance follows from the step's ratio by the law of cosines, before the point is there.
#[inline(always)]
fn lay_along<'a>(start: DVec3, mut steps: impl Iterator<Item = (&'a mut DVec3, f64)>) -> DVec3 {
    /// Below this share of the longer side the law of cosines leaves too few digits.
    const CLEAR: f64 = 1e-3;
    let mut at = start;
    let Some((mut point, mut length)) = steps.next() else {
        return at;
    };
    let mut way = *point - at;
    let mut size_sq = way.length_squared();
    for (next, next_length) in steps {
        let past = *next - at;
        let (past_sq, along) = (past.length_squared(), past.dot(way));
        if size_sq > NO_DIRECTION_SQ {
            let ratio = (length / size_sq) * size_sq.sqrt();
            at += way * ratio;
            way = *next - at;
            size_sq = (past_sq + length * length) - (2.0 * along) * ratio;
            if size_sq <= CLEAR * past_sq {
                size_sq = measured(way);
            }
        } else {
            at += at_length(way, length);
            way = *next - at;
            size_sq = measured(way);
        }
        *point = at;
        (point, length) = (next, next_length);
    }
    at += at_length(way, length);
    *point = at;
    at
}

/// The square of a length, where it must be waited for: a branch that is seldom taken, and not a choice of two values
/// that are both computed.
#[cold]
#[inline(never)]
fn measured(way: DVec3) -> f64 {
    way.length_squared()
}

/// Vectors whose squares are below this have no direction.
const NO_DIRECTION_SQ: f64 = 1e-200;

/// The vector brought to a length; one without a direction points along Y, so that bones keep their
/// lengths whatever comes.
#[inline(always)]
pub(super) fn at_length(vector: DVec3, length: f64) -> DVec3 {
    let size_sq = vector.length_squared();
    if size_sq > NO_DIRECTION_SQ {
        // The root and the quotient do not wait for each other, as those of `length / size` would.
        vector * ((length / size_sq) * size_sq.sqrt())
    } else {
        DVec3::Y * length
    }
}
