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
    let mut left = points[last].distance(target);
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
    let mut iterations = 0;
    while iterations < max_iterations {
        iterations += 1;
        points[last] = target;
        for i in (0..last).rev() {
            points[i] = points[i + 1] + at_length(points[i] - points[i + 1], lengths[i]);
        }
        points[0] = base;
        for i in 0..last {
            points[i + 1] = points[i] + at_length(points[i + 1] - points[i], lengths[i]);
        }
        let now = points[last].distance(target);
        if now <= tolerance || now >= left {
            return (now, iterations);
        }
        left = now;
    }
    (left, iterations)
}

/// The vector brought to a length; one without a direction points along Y, so that bones keep their
/// lengths whatever comes.
#[inline(always)]
pub(super) fn at_length(vector: DVec3, length: f64) -> DVec3 {
    let size_sq = vector.length_squared();
    if size_sq > 1e-200 {
        vector * (length / size_sq.sqrt())
    } else {
        DVec3::Y * length
    }
}
