//! Where the sides of the window stand: beside the view; one at a time where there is no room for two; under
//! the view in a window as upright as a phone.

use egui::{Panel, Ui, Vec2};

use crate::state::settings::WindowLayout;

/// Under this width there is room for one side.
const NARROW: f32 = 900.0;

/// Under this width, in a window higher than wide, a side beside the view would leave nothing of it.
const UPRIGHT: f32 = 600.0;

/// As much of the window's width a side takes at most, and of its height.
const MOST: f32 = 0.6;

/// What room a window has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Room {
    /// Both sides stand beside the view.
    #[default]
    Wide,
    /// One side stands beside the view.
    Narrow,
    /// One side stands under the view.
    Upright,
}

impl Room {
    /// That of a window of this size.
    #[must_use]
    pub fn of(size: Vec2) -> Self {
        if size.x < UPRIGHT && size.y > size.x {
            Self::Upright
        } else if size.x < NARROW {
            Self::Narrow
        } else {
            Self::Wide
        }
    }
}

/// A side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Clips and joints; what is set.
    Left,
    /// Numbers.
    Right,
}

/// Which sides are shown, and where there is room for them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sides {
    /// The left one.
    pub left: bool,
    /// The right one.
    pub right: bool,
    /// The room.
    pub room: Room,
}

impl Sides {
    /// Those that a window of this size shows.
    #[must_use]
    pub fn of(layout: WindowLayout, size: Vec2) -> Self {
        let room = Room::of(size);
        Self {
            left: layout.left,
            right: layout.right && (room == Room::Wide || !layout.left),
            room,
        }
    }

    /// Whether a side is shown under the view, where the tables are otherwise.
    #[must_use]
    pub fn is_under_view(self) -> bool {
        self.room == Room::Upright && (self.left || self.right)
    }

    /// Opens a side, or closes it; where there is room for one the other goes.
    pub fn toggle(self, side: Side, layout: &mut WindowLayout) {
        let opens = match side {
            Side::Left => !self.left,
            Side::Right => !self.right,
        };
        if self.room != Room::Wide {
            (layout.left, layout.right) = (false, false);
        }
        match side {
            Side::Left => layout.left = opens,
            Side::Right => layout.right = opens,
        }
    }

    /// The panel of a side, `least` wide, and `first` at first.
    pub fn panel(self, side: Side, id: &'static str, (least, first): (f32, f32), ui: &Ui) -> Panel {
        let room = ui.available_size();
        let panel = match (self.room, side) {
            (Room::Upright, _) => {
                let least = 180.0_f32.min(MOST * room.y);
                return Panel::bottom(egui::Id::unique((id, "under the view")))
                    .resizable(true)
                    .default_size(0.5 * room.y)
                    .size_range(least..=(0.75 * room.y).max(least));
            }
            (_, Side::Left) => Panel::left(id),
            (_, Side::Right) => Panel::right(id),
        };
        panel
            .resizable(true)
            .default_size(first)
            .size_range(least..=(MOST * room.x).max(least))
    }
}

/// Shows what is in a side in the room that the side has. What is wider than that is cut off at the edge: a
/// panel grows to what is in it, and would take more of the window with every picture.
pub fn within(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let room = ui.available_rect_before_wrap();
    let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(room));
    contents(&mut inner);
    ui.advance_cursor_after_rect(room);
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::vec2;

    #[test]
    fn a_button_of_a_side_always_does_something() {
        for size in [vec2(1280.0, 800.0), vec2(800.0, 600.0), vec2(390.0, 844.0)] {
            for (left, right) in [(false, false), (false, true), (true, false), (true, true)] {
                for side in [Side::Left, Side::Right] {
                    let mut layout = WindowLayout {
                        left,
                        right,
                        ..WindowLayout::default()
                    };
                    let before = Sides::of(layout, size);
                    before.toggle(side, &mut layout);
                    let after = Sides::of(layout, size);
                    let shown = |sides: Sides| match side {
                        Side::Left => sides.left,
                        Side::Right => sides.right,
                    };
                    assert_ne!(
                        shown(before),
                        shown(after),
                        "{size} {left} {right} {side:?}"
                    );
                    after.toggle(side, &mut layout);
                    assert_eq!(shown(Sides::of(layout, size)), shown(before));
                }
            }
        }
    }

    #[test]
    fn a_window_as_wide_as_high_is_not_upright() {
        assert_eq!(Room::of(vec2(390.0, 844.0)), Room::Upright);
        assert_eq!(Room::of(vec2(480.0, 400.0)), Room::Narrow);
        assert_eq!(Room::of(vec2(960.0, 540.0)), Room::Wide);
    }
}
