//! What is wrong with a picture of the window: texts on each other, under something or cut; controls that are cut,
//! lie on each other or cannot be reached; messages over controls.

use std::collections::BTreeSet;

use egui::{LayerId, Order, Rect, Role, Vec2};

use super::seen::{Layer, Line, Painted, Seen, Widget};

/// Edges of letters are soft: so much of a cut or an overlap is not seen, points.
const SLACK: f32 = 1.0;

/// What is in the view at a place of the world, and goes wherever that goes.
pub(super) struct Loose<'a> {
    /// Names that are written there.
    pub(super) names: &'a BTreeSet<String>,
}

/// All that is wrong.
pub(super) fn of(seen: &Seen, widgets: &[Widget], loose: &Loose<'_>) -> Vec<String> {
    let mut faults = Vec::new();
    let window = seen.window.unwrap_or(Rect::EVERYTHING);
    let bars: Vec<Bar> = widgets.iter().filter_map(Bar::of).collect();
    for layer in &seen.layers {
        texts(layer, loose, &mut faults);
        let lines = layer.painted.iter().filter_map(|painted| match painted {
            Painted::Line(line) if !loose.names.contains(&line.text) => Some(line),
            _ => None,
        });
        for line in lines {
            cut_line(line, window, &bars, widgets, &mut faults);
        }
    }
    for widget in widgets.iter().filter(|widget| is_control(widget.role)) {
        cut_widget(widget, window, &bars, &mut faults);
    }
    over_each_other(widgets, &mut faults);
    messages(seen, widgets, &mut faults);
    faults
}

/// What is used: it is pressed, typed into, or read.
fn is_control(role: Role) -> bool {
    matches!(
        role,
        Role::Button
            | Role::CheckBox
            | Role::RadioButton
            | Role::TextInput
            | Role::MultilineTextInput
            | Role::SpinButton
            | Role::Slider
            | Role::ComboBox
            | Role::Link
            | Role::Label
            | Role::ProgressIndicator
    )
}

/// A bar that is shown where there is more than is seen: what is cut at its ends comes into view with it.
struct Bar {
    layer: LayerId,
    rect: Rect,
    goes_down: bool,
}

impl Bar {
    fn of(widget: &Widget) -> Option<Self> {
        let rect = widget.spot.rect;
        (widget.role == Role::ScrollBar).then_some(Self {
            layer: widget.spot.layer,
            rect,
            goes_down: rect.height() > rect.width(),
        })
    }

    /// Whether what is cut at a height, or at a distance from the left, is reached with this bar: what is seen
    /// ends where the bar ends, and is large enough for all of it.
    fn reaches(&self, what: Rect, seen: Rect, (side, edge): (Side, f32)) -> bool {
        let (ends, size, along) = match self.goes_down {
            true => (self.rect.y_range(), what.height(), side.is_vertical()),
            false => (self.rect.x_range(), what.width(), !side.is_vertical()),
        };
        let is_beside = match self.goes_down {
            // Where it lies far out to both sides what is seen of it is where it would be.
            true => what.left().min(seen.right()) < self.rect.right(),
            false => what.top().min(seen.bottom()) < self.rect.bottom(),
        };
        let end = match side {
            Side::Top | Side::Left => ends.min,
            Side::Bottom | Side::Right => ends.max,
        };
        along && is_beside && (end - edge).abs() <= 2.5 && ends.span() + SLACK >= size.min(60.0)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Top,
    Right,
    Bottom,
}

impl Side {
    fn is_vertical(self) -> bool {
        matches!(self, Self::Top | Self::Bottom)
    }
}

/// The sides at which something goes beyond what is seen, and where that ends.
fn cuts(what: Rect, seen: Rect) -> Vec<(Side, f32)> {
    let sides = [
        (Side::Left, seen.left() - what.left(), seen.left()),
        (Side::Top, seen.top() - what.top(), seen.top()),
        (Side::Right, what.right() - seen.right(), seen.right()),
        (Side::Bottom, what.bottom() - seen.bottom(), seen.bottom()),
    ];
    let cut = sides.into_iter().filter(|(_, beyond, _)| *beyond > SLACK);
    cut.map(|(side, _, edge)| (side, edge)).collect()
}

fn cut_line(line: &Line, window: Rect, bars: &[Bar], widgets: &[Widget], faults: &mut Vec<String>) {
    let clip = line.clip.intersect(window);
    // What is not seen at all is no text that is cut; a widget that has it is looked at as a widget.
    if !line.ink.intersects(clip) {
        return;
    }
    // A field shows as much of its text as it has room for, around the cursor.
    let is_in_field = widgets.iter().any(|widget| {
        matches!(widget.role, Role::TextInput | Role::MultilineTextInput)
            && widget.spot.rect.expand(1.0).contains_rect(line.clip)
    });
    if is_in_field {
        return;
    }
    for (side, edge) in cuts(line.ink, clip) {
        if !bars
            .iter()
            .any(|bar| bar.reaches(line.ink, clip, (side, edge)))
        {
            faults.push(format!(
                "the text '{}' at {} is cut at its {side:?} by {clip}",
                line.text, line.ink
            ));
        }
    }
    let letters = line
        .text
        .trim_end_matches('\u{2026}')
        .trim()
        .chars()
        .count();
    if line.is_elided && line.text.ends_with('\u{2026}') && letters < 2 {
        faults.push(format!(
            "of a text at {} only '{}' is left",
            line.ink, line.text
        ));
    }
}

fn cut_widget(widget: &Widget, window: Rect, bars: &[Bar], faults: &mut Vec<String>) {
    let spot = widget.spot;
    if !spot.rect.is_positive() {
        return;
    }
    let seen = spot.seen.intersect(window);
    for (side, edge) in cuts(spot.rect, seen) {
        let here = bars.iter().filter(|bar| bar.layer == spot.layer);
        let mut here = here.filter(|bar| bar.reaches(spot.rect, seen, (side, edge)));
        if here.next().is_none() {
            faults.push(format!(
                "{:?} '{}' at {} is cut at its {side:?}: {seen} is seen",
                widget.role, widget.name, spot.rect
            ));
        }
    }
    let is_pressed = !matches!(widget.role, Role::Label | Role::ProgressIndicator);
    // The dope sheet gives its rows only as much as is seen of them, at the end of what is scrolled.
    let is_at_end = bars
        .iter()
        .any(|bar| bar.goes_down && (bar.rect.bottom() - spot.rect.bottom()).abs() <= 2.5);
    if is_pressed && !is_at_end && spot.rect.size().min_elem() < 8.0 {
        faults.push(format!(
            "{:?} '{}' at {} is too small to be used",
            widget.role, widget.name, spot.rect
        ));
    }
}

/// What two rectangles share, without the soft edges of letters.
fn shared(a: Rect, b: Rect) -> Option<Rect> {
    let both = a.intersect(b).shrink2(Vec2::new(0.5, SLACK));
    both.is_positive().then_some(both)
}

/// Texts of one layer on each other, and under a ground that was painted later.
fn texts(layer: &Layer, loose: &Loose<'_>, faults: &mut Vec<String>) {
    // What has come so far, and how many grounds lie between.
    let mut lines: Vec<(&Line, usize)> = Vec::new();
    let mut grounds: Vec<Rect> = Vec::new();
    for painted in &layer.painted {
        match painted {
            Painted::Ground(rect) => {
                for (line, _) in &lines {
                    // Names in the view go under what lies over the view.
                    if shared(line.visible(), *rect).is_some() && !loose.names.contains(&line.text)
                    {
                        faults.push(format!(
                            "the text '{}' at {} lies under something at {rect}",
                            line.text, line.ink
                        ));
                    }
                }
                grounds.push(*rect);
            }
            Painted::Line(line) => {
                if !line.visible().is_positive() {
                    continue;
                }
                for (other, since) in &lines {
                    let Some(both) = shared(line.visible(), other.visible()) else {
                        continue;
                    };
                    let is_loose =
                        loose.names.contains(&line.text) && loose.names.contains(&other.text);
                    let hides = |ground: &Rect| ground.expand(1.0).contains_rect(both);
                    if !is_loose && !grounds[*since..].iter().any(hides) {
                        faults.push(format!(
                            "the text '{}' at {} lies on '{}' at {}",
                            line.text, line.ink, other.text, other.ink
                        ));
                    }
                }
                lines.push((line, grounds.len()));
            }
        }
    }
}

/// Controls of one layer that lie on each other, neither in the other.
fn over_each_other(widgets: &[Widget], faults: &mut Vec<String>) {
    let controls: Vec<&Widget> = widgets
        .iter()
        .filter(|widget| is_control(widget.role) && widget.role != Role::Label)
        .collect();
    for (index, a) in controls.iter().enumerate() {
        for b in &controls[index + 1..] {
            if a.spot.layer != b.spot.layer {
                continue;
            }
            let (here, there) = (a.spot.seen, b.spot.seen);
            let both = here.intersect(there);
            let is_in =
                here.expand(SLACK).contains_rect(there) || there.expand(SLACK).contains_rect(here);
            if both.width() > 1.5 && both.height() > 1.5 && !is_in {
                faults.push(format!(
                    "{:?} '{}' at {here} and {:?} '{}' at {there} lie on each other",
                    a.role, a.name, b.role, b.name
                ));
            }
        }
    }
}

/// Messages over controls.
fn messages(seen: &Seen, widgets: &[Widget], faults: &mut Vec<String>) {
    let is_message =
        |layer: LayerId| layer == LayerId::new(Order::Middle, egui::Id::unique("notices"));
    let cards = seen.layers.iter().filter(|layer| is_message(layer.id));
    let cards: Vec<Rect> = cards
        .flat_map(|layer| &layer.painted)
        .filter_map(|painted| match painted {
            Painted::Ground(rect) => Some(*rect),
            Painted::Line(_) => None,
        })
        .collect();
    for widget in widgets.iter().filter(|widget| is_control(widget.role)) {
        let spot = widget.spot;
        if spot.layer.order != Order::Background {
            continue;
        }
        if cards.iter().any(|card| shared(*card, spot.seen).is_some()) {
            faults.push(format!(
                "a message lies over {:?} '{}' at {}",
                widget.role, widget.name, spot.rect
            ));
        }
    }
}
