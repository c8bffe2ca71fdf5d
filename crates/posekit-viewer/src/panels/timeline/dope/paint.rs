//! How the dope sheet looks.

use std::collections::BTreeSet;

use egui::{Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};
use posekit::keyframe::Interpolation;

use super::super::axis::Axis;
use super::rows::{Kind, Mark, Row};
use crate::state::animate::KeyId;
use crate::theme::Palette;

/// Height of a row.
pub(super) const ROW_HEIGHT: f32 = 20.0;

/// Half the width of a mark.
pub(super) const MARK: f32 = 5.0;

/// A row's ground.
pub(super) fn ground(
    painter: &Painter,
    rect: Rect,
    row: &Row,
    is_selected: bool,
    palette: &Palette,
) {
    let fill = match row.kind {
        _ if is_selected => palette.accent_soft.gamma_multiply(0.6),
        Kind::Summary => palette.raised,
        Kind::Owner(_) => Color32::TRANSPARENT,
        Kind::Lane(_) => palette.sunken.gamma_multiply(0.45),
    };
    painter.rect_filled(rect, 0.0, fill);
    painter.hline(
        rect.x_range(),
        rect.bottom(),
        Stroke::new(1.0, palette.line.gamma_multiply(0.5)),
    );
}

/// A row's name, with the triangle that opens it.
pub(super) fn name(painter: &Painter, rect: Rect, row: &Row, is_selected: bool, palette: &Palette) {
    let left = rect.left() + 6.0 + 12.0 * index_to_f32(row.depth);
    if let Some(is_open) = row.open {
        triangle(painter, pos2(left, rect.center().y), is_open, palette.quiet);
    }
    let color = match row.kind {
        _ if is_selected => palette.accent,
        Kind::Lane(_) => palette.quiet,
        _ => palette.text,
    };
    let size = if row.kind == Kind::Summary {
        12.5
    } else {
        12.0
    };
    let room = rect.right() - left - 14.0;
    let mut job = egui::text::LayoutJob::simple_singleline(
        row.name.clone(),
        FontId::proportional(size),
        color,
    );
    job.wrap = egui::text::TextWrapping::truncate_at_width(room.max(10.0));
    let galley = painter.layout_job(job);
    let at = pos2(left + 12.0, rect.center().y - galley.size().y / 2.0);
    painter.galley(at, galley, color);
}

fn triangle(painter: &Painter, at: Pos2, is_open: bool, color: Color32) {
    let corners = if is_open {
        [vec2(-4.0, -2.0), vec2(4.0, -2.0), vec2(0.0, 3.5)]
    } else {
        [vec2(-2.0, -4.0), vec2(3.5, 0.0), vec2(-2.0, 4.0)]
    };
    let corners = corners.map(|corner| at + corner).to_vec();
    painter.add(Shape::convex_polygon(corners, color, Stroke::NONE));
}

/// The marks of a row that are in view.
pub(super) fn marks(
    painter: &Painter,
    axis: &Axis,
    (y, row): (f32, &Row),
    (selection, hovered): (&BTreeSet<KeyId>, Option<usize>),
    palette: &Palette,
) {
    let [start, end] = [axis.rect.left() - MARK, axis.rect.right() + MARK].map(|x| axis.secs_at(x));
    let first = row.marks.partition_point(|mark| mark.secs < start);
    for (index, mark) in row.marks.iter().enumerate().skip(first) {
        if mark.secs > end {
            break;
        }
        let at = pos2(axis.x(mark.secs), y);
        let state = state_of(mark, selection);
        draw(painter, at, mark, (state, hovered == Some(index)), palette);
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Selected {
    No,
    Partly,
    Yes,
}

fn state_of(mark: &Mark, selection: &BTreeSet<KeyId>) -> Selected {
    let count = mark
        .keys
        .iter()
        .filter(|key| selection.contains(key))
        .count();
    match count {
        0 => Selected::No,
        count if count == mark.keys.len() => Selected::Yes,
        _ => Selected::Partly,
    }
}

/// A mark: its shape says how its keys go on, its fill whether they are selected.
fn draw(
    painter: &Painter,
    at: Pos2,
    mark: &Mark,
    (state, is_hovered): (Selected, bool),
    palette: &Palette,
) {
    let fill = match state {
        Selected::Yes => palette.warning,
        Selected::Partly => palette.warning.gamma_multiply(0.45),
        Selected::No => palette.raised,
    };
    let edge = if is_hovered {
        palette.accent
    } else {
        palette.text.gamma_multiply(0.75)
    };
    let stroke = Stroke::new(if is_hovered { 2.0 } else { 1.2 }, edge);
    let r = MARK;
    match mark.interpolation {
        Some(Interpolation::Step) => {
            let square = Rect::from_center_size(at, vec2(1.6 * r, 1.6 * r));
            painter.rect(
                square,
                CornerRadius::ZERO,
                fill,
                stroke,
                egui::StrokeKind::Middle,
            );
        }
        Some(Interpolation::Squad) => {
            painter.circle(at, 0.9 * r, fill, stroke);
        }
        Some(Interpolation::Linear) => {
            // Sharp where the curve has a corner: a triangle to the next key.
            let corners = [vec2(-0.8 * r, -r), vec2(1.1 * r, 0.0), vec2(-0.8 * r, r)];
            painter.add(Shape::convex_polygon(
                corners.map(|corner| at + corner).to_vec(),
                fill,
                stroke,
            ));
        }
        _ => {
            let corners = [vec2(0.0, -r), vec2(r, 0.0), vec2(0.0, r), vec2(-r, 0.0)];
            painter.add(Shape::convex_polygon(
                corners.map(|corner| at + corner).to_vec(),
                fill,
                stroke,
            ));
        }
    }
}

/// The box that selects.
pub(super) fn selecting_box(painter: &Painter, rect: Rect, palette: &Palette) {
    painter.rect(
        rect,
        2.0,
        palette.accent_soft.gamma_multiply(0.35),
        Stroke::new(1.0, palette.accent),
        egui::StrokeKind::Inside,
    );
}

/// The grips at both ends of what is selected, which scale it.
pub(super) fn grips(painter: &Painter, places: [Pos2; 2], palette: &Palette) {
    for (place, side) in places.into_iter().zip([-1.0, 1.0]) {
        let bar = Rect::from_center_size(place + vec2(side * 9.0, 0.0), vec2(3.0, 14.0));
        painter.rect_filled(bar, 1.5, palette.warning);
    }
}

/// A line at the bottom that says what follows the pointer.
pub(super) fn hint(painter: &Painter, rect: Rect, text: &str, palette: &Palette) {
    let font = FontId::proportional(11.5);
    let galley = painter.layout_no_wrap(text.to_owned(), font, palette.text);
    let card = Align2::CENTER_BOTTOM.anchor_size(
        rect.center_bottom() - vec2(0.0, 5.0),
        galley.size() + vec2(18.0, 6.0),
    );
    painter.rect_filled(card, card.height() / 2.0, palette.raised);
    painter.galley(card.min + vec2(9.0, 3.0), galley, palette.text);
}

#[allow(
    clippy::cast_precision_loss,
    reason = "rows and depths are small numbers"
)]
pub(super) fn index_to_f32(index: usize) -> f32 {
    index as f32
}
