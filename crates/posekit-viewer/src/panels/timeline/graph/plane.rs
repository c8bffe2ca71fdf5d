//! Where times and values are on the screen.

use egui::{Pos2, Rect, pos2};

use crate::panels::timeline::axis::Axis;
use crate::state::clip::{index_to_f64, nearest_index};

/// Share of the height that is left free above and below what is taken into view.
const MARGIN: f64 = 0.12;

/// Points from one labelled value to the next, at least.
const LABEL_ROOM: f64 = 26.0;

/// What is drawn farther outside than this is drawn at this distance: far out numbers on a screen lose
/// their meaning.
const FAR_OUTSIDE: f32 = 4000.0;

/// Which values are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueView {
    /// At half the height.
    pub(super) middle: f64,
    /// From the bottom to the top.
    pub(super) span: f64,
}

impl ValueView {
    /// All of a range, with some room.
    pub(super) fn of([low, high]: [f64; 2]) -> Self {
        let span = (high - low).max(least_span(low, high)) / (1.0 - 2.0 * MARGIN);
        Self {
            middle: (low + high) * 0.5,
            span,
        }
    }

    /// Zooms so that `value` stays where it is.
    pub(super) fn zoom(&mut self, value: f64, factor: f64) {
        let span = (self.span * factor).clamp(1e-6, 1e9);
        self.middle = value + (self.middle - value) * (span / self.span);
        self.span = span;
    }
}

/// A curve that does not move is shown with some room around it, in keeping with its size.
fn least_span(low: f64, high: f64) -> f64 {
    (low.abs().max(high.abs()) * 0.1).max(0.01)
}

/// The plot's rectangle and what it shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) rect: Rect,
    pub(super) axis: Axis,
    pub(super) values: ValueView,
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "places on a screen, cut off far outside of it"
)]
fn cut(place: f64, near: f32, far: f32) -> f32 {
    (place as f32).clamp(near - FAR_OUTSIDE, far + FAR_OUTSIDE)
}

impl Plane {
    /// A time's place from left to right.
    pub(super) fn x(&self, secs: f64) -> f32 {
        cut(
            self.axis.x(secs).into(),
            self.rect.left(),
            self.rect.right(),
        )
    }

    /// A value's place from top to bottom.
    pub(super) fn y(&self, value: f64) -> f32 {
        let y =
            f64::from(self.rect.center().y) - (value - self.values.middle) / self.value_per_point();
        cut(y, self.rect.top(), self.rect.bottom())
    }

    pub(super) fn pos(&self, [secs, value]: [f64; 2]) -> Pos2 {
        pos2(self.x(secs), self.y(value))
    }

    pub(super) fn secs(&self, x: f32) -> f64 {
        self.axis.secs_at(x)
    }

    pub(super) fn value(&self, y: f32) -> f64 {
        self.values.middle - f64::from(y - self.rect.center().y) * self.value_per_point()
    }

    pub(super) fn value_per_point(&self) -> f64 {
        self.values.span / f64::from(self.rect.height().max(1.0))
    }

    /// The values to be labelled.
    pub(super) fn value_ticks(&self) -> Vec<f64> {
        let step = round_step(LABEL_ROOM * self.value_per_point());
        let [low, high] = [self.rect.bottom(), self.rect.top()].map(|y| self.value(y));
        let first = (low / step).ceil();
        let count = nearest_index(((high / step).floor() - first).max(0.0), 500);
        (0..=count)
            .map(|index| (first + index_to_f64(index)) * step)
            .filter(|value| *value <= high)
            .collect()
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not under `wanted`.
pub(super) fn round_step(wanted: f64) -> f64 {
    if !(wanted.is_finite() && wanted > 0.0) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(wanted)));
    let factor = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|factor| factor * power >= wanted * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// A number as short as it can be said at this fineness.
pub(super) fn number_text(value: f64, step: f64) -> String {
    let places = nearest_index((-libm::log10(step)).ceil().max(0.0), 6);
    let text = format!("{value:.places$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_owned(),
        _ => text.replace('-', "\u{2212}"),
    }
}

#[cfg(test)]
mod tests {
    use egui::vec2;
    use posekit_formats::scene::{Scene, SkeletonSource};

    use super::*;
    use crate::panels::timeline::axis::TimeView;
    use crate::state::animate::Authored;

    fn plane(values: ValueView) -> Plane {
        let scene = Scene::new(SkeletonSource::File("sample:walk".to_owned()));
        let motion = posekit::sample::by_name("walk").expect("a sample");
        let files = [("sample:walk".to_owned(), std::sync::Arc::new(motion).into())].into();
        let authored = Authored::new(scene, files).expect("it fits");
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(500.0, 200.0));
        Plane {
            rect,
            axis: TimeView::default().axis(rect, &authored),
            values,
        }
    }

    #[test]
    fn places_and_numbers_agree() {
        let plane = plane(ValueView::of([-30.0, 60.0]));
        for secs in [0.0, 0.3, 1.0] {
            assert!((plane.secs(plane.x(secs)) - secs).abs() < 1e-5);
        }
        for value in [-30.0, 0.0, 12.5, 60.0] {
            assert!((plane.value(plane.y(value)) - value).abs() < 1e-4);
        }
        assert!(plane.y(60.0) < plane.y(-30.0), "up is more");
        let inside = plane.rect.shrink(10.0).y_range();
        assert!(inside.contains(plane.y(60.0)) && inside.contains(plane.y(-30.0)));
    }

    #[test]
    fn zooming_keeps_the_value_under_the_pointer() {
        let mut values = ValueView::of([0.0, 10.0]);
        let before = plane(values);
        let y = before.y(3.0);
        values.zoom(3.0, 0.5);
        assert!((plane(values).y(3.0) - y).abs() < 1e-3);
    }

    #[test]
    fn labels_are_round_and_not_crowded() {
        for (range, first) in [
            ([0.0, 1.0], 0.2),
            ([-180.0, 180.0], 100.0),
            ([5.0, 5.0], 0.1),
        ] {
            let plane = plane(ValueView::of(range));
            let ticks = plane.value_ticks();
            assert!(ticks.len() >= 2, "{range:?}");
            let step = ticks[1] - ticks[0];
            assert!((step - first).abs() < 1e-9, "{range:?}: {step}");
            assert!(f64::from(plane.y(ticks[0]) - plane.y(ticks[1])) >= LABEL_ROOM - 1e-3);
        }
    }

    #[test]
    fn numbers_are_said_at_the_fineness_of_their_step() {
        assert_eq!(number_text(0.30000000000000004, 0.1), "0.3");
        assert_eq!(number_text(-0.0, 0.1), "0.0");
        assert_eq!(number_text(-20.0, 20.0), "\u{2212}20");
        assert_eq!(number_text(1200.0, 200.0), "1200");
    }
}
