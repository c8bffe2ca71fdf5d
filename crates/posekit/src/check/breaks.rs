//! Breaks in the course of something that moves: jumps, and spikes that are taken back.
//!
//! A step (the distance from one frame to the next) is a break when it is large in itself, large
//! against the steps around it (their median and median absolute deviation, so that a second break
//! nearby does not hide the first) and large against the two steps beside it (fast but smooth
//! motion ramps up and down). A break that returns to the course within a few frames is a spike;
//! any other is a jump.

use super::statistics::{median, usual_limit};

/// How many steps on either side tell what is usual.
const NEIGHBOURS: usize = 8;

/// With fewer steps than this around it nothing is known about a step.
const NEIGHBOURS_MIN: usize = 4;

/// A spike has returned when it ends this share of its height from where it began, or closer,
/// besides the usual motion in between.
const RETURN_SHARE: f64 = 0.35;

/// What counts as a break.
#[derive(Clone, Copy, Debug)]
pub(super) struct BreakLimits {
    /// Steps up to this are never one; in the unit of the distances.
    pub smallest: f64,
    /// Steps up to this are no spikes either; those between this and `smallest` are spikes when they stand
    /// out by twice as much, because two breaks that cancel are stronger evidence than one.
    pub smallest_spike: f64,
    /// How many times the usual limit around it a step must be.
    pub factor: f64,
    /// How many times each of the two steps beside it a step must be.
    pub contrast: f64,
    /// How many frames a spike lasts at most.
    pub spike_frames_max: usize,
}

/// Whether a break was taken back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BreakKind {
    Spike,
    Jump,
}

/// A break in the course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Break {
    pub kind: BreakKind,
    /// The first frame off the course, or the first one of the new course.
    pub first: usize,
    /// The last frame off the course; `first` of a jump.
    pub last: usize,
    /// How far the frames are off the course, or how long the jump is.
    pub size: f64,
    /// The median of the steps around it.
    pub usual_step: f64,
}

/// Finds the breaks. `steps[i]` is the distance from frame `i` to the next; `distance` gives that
/// between any two frames. Cost: one comparison a step, more only for large ones.
pub(super) fn find_breaks(
    steps: &[f64],
    distance: impl Fn(usize, usize) -> f64,
    limits: &BreakLimits,
) -> Vec<Break> {
    let mut breaks = Vec::new();
    let mut step = 0;
    while step < steps.len() {
        if steps[step] > limits.smallest_spike {
            if let Some(found) = spike_at(steps, step, &distance, limits) {
                step = found.last + 1;
                breaks.push(found);
                continue;
            }
            if steps[step] > limits.smallest {
                breaks.extend(jump_at(steps, step, limits));
            }
        }
        step += 1;
    }
    breaks
}

fn spike_at(
    steps: &[f64],
    step: usize,
    distance: &impl Fn(usize, usize) -> f64,
    limits: &BreakLimits,
) -> Option<Break> {
    for frames in 1..=limits.spike_frames_max {
        let back = step + frames;
        if back >= steps.len() {
            return None;
        }
        if steps[back] <= limits.smallest_spike {
            continue;
        }
        let off_course = step + 1..=back;
        let size = off_course
            .clone()
            .map(|frame| distance(step, frame))
            .fold(f64::MAX, f64::min);
        let (usual, limit) = usual_around(steps, step, back)?;
        let gap = distance(step, back + 1);
        let drift = usual * (frames + 1) as f64;
        let returned = gap <= RETURN_SHARE * size + drift;
        let smaller_side = steps[step].min(steps[back]);
        let is_large = smaller_side > limits.smallest && size > limits.smallest;
        let judged = if is_large {
            smaller_side
        } else {
            0.5 * smaller_side
        };
        if returned
            && size > limits.smallest_spike
            && judged > limits.factor * limit
            && stands_out(steps, step, back, judged, limits)
        {
            return Some(Break {
                kind: BreakKind::Spike,
                first: step + 1,
                last: back,
                size: off_course
                    .map(|frame| distance(step, frame))
                    .fold(0.0, f64::max),
                usual_step: usual,
            });
        }
    }
    None
}

fn jump_at(steps: &[f64], step: usize, limits: &BreakLimits) -> Option<Break> {
    let (usual, limit) = usual_around(steps, step, step)?;
    let is_jump =
        steps[step] > limits.factor * limit && stands_out(steps, step, step, steps[step], limits);
    is_jump.then_some(Break {
        kind: BreakKind::Jump,
        first: step + 1,
        last: step + 1,
        size: steps[step],
        usual_step: usual,
    })
}

/// Whether the steps just before `first` and just after `last` are small against `size`.
fn stands_out(steps: &[f64], first: usize, last: usize, size: f64, limits: &BreakLimits) -> bool {
    let before = first.checked_sub(1).map_or(0.0, |step| steps[step]);
    let after = steps.get(last + 1).copied().unwrap_or(0.0);
    size > limits.contrast * before.max(after)
}

/// The median of the steps around those from `first` to `last`, and where usual steps end.
fn usual_around(steps: &[f64], first: usize, last: usize) -> Option<(f64, f64)> {
    let before = &steps[first.saturating_sub(NEIGHBOURS)..first];
    let after_start = (last + 1).min(steps.len());
    let after = &steps[after_start..(after_start + NEIGHBOURS).min(steps.len())];
    let mut around: Vec<f64> = before.iter().chain(after).copied().collect();
    if around.len() < NEIGHBOURS_MIN {
        return None;
    }
    Some((median(&mut around), usual_limit(&mut around)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: BreakLimits = BreakLimits {
        smallest: 0.5,
        smallest_spike: 0.5,
        factor: 4.0,
        contrast: 3.0,
        spike_frames_max: 3,
    };

    fn breaks_of(course: &[f64]) -> Vec<(BreakKind, usize, usize)> {
        let steps: Vec<f64> = course
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).abs())
            .collect();
        let found = find_breaks(&steps, |a, b| (course[a] - course[b]).abs(), &LIMITS);
        found.iter().map(|b| (b.kind, b.first, b.last)).collect()
    }

    fn slope(frames: usize) -> Vec<f64> {
        (0..frames).map(|frame| 0.1 * frame as f64).collect()
    }

    #[test]
    fn a_steady_course_has_none() {
        assert_eq!(breaks_of(&slope(40)), []);
    }

    #[test]
    fn spikes_of_one_to_three_frames_return() {
        for width in 1..=3 {
            let mut course = slope(40);
            for value in &mut course[20..20 + width] {
                *value += 5.0;
            }
            assert_eq!(breaks_of(&course), [(BreakKind::Spike, 20, 19 + width)]);
        }
    }

    #[test]
    fn a_small_spike_must_stand_out_by_twice_as_much() {
        let limits = BreakLimits {
            smallest: 8.0,
            smallest_spike: 0.5,
            ..LIMITS
        };
        for (size, is_found) in [(0.8, false), (1.5, true)] {
            let mut course = slope(40);
            course[20] += size;
            let steps: Vec<f64> = course
                .windows(2)
                .map(|pair| (pair[1] - pair[0]).abs())
                .collect();
            let found = find_breaks(&steps, |a, b| (course[a] - course[b]).abs(), &limits);
            assert_eq!(found.len(), usize::from(is_found), "{size}: {found:?}");
        }
    }

    #[test]
    fn a_longer_detour_is_two_jumps() {
        let mut course = slope(40);
        for value in &mut course[15..25] {
            *value += 5.0;
        }
        assert_eq!(
            breaks_of(&course),
            [(BreakKind::Jump, 15, 15), (BreakKind::Jump, 25, 25)]
        );
    }

    #[test]
    fn a_fast_but_smooth_swing_is_none() {
        let swing: Vec<f64> = (0..60)
            .map(|frame| 10.0 / (1.0 + libm::exp(-(f64::from(frame) - 30.0) / 2.0)))
            .collect();
        assert_eq!(breaks_of(&swing), []);
    }

    #[test]
    fn short_courses_are_left_alone() {
        assert_eq!(breaks_of(&[0.0, 9.0, 0.0]), []);
        assert_eq!(breaks_of(&[]), []);
    }
}
