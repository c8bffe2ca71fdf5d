//! The map from the tip to the world, factor by factor: a card each, the running product below, and the whole
//! map beside them.

use egui::{
    Align2, Color32, FontId, Frame, Margin, RichText, ScrollArea, Sense, Stroke, Ui, pos2, vec2,
};
use glam::DMat4;

use super::super::row;
use crate::state::arm::ArmLab;
use crate::state::arm::factors::{Detail, Factor, factors};
use crate::state::readout::fixed;
use crate::theme::{CURVES, GAP, Palette};

/// Width of a column of numbers and height of a row, points.
const COLUMN: f32 = 45.0;
const ROW: f32 = 14.0;

/// Space at the sides of a card's contents.
const MARGIN: i8 = 8;

/// Width of a card's contents.
const WIDTH: f32 = 4.0 * COLUMN + 14.0;

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &ArmLab, detail: Detail) {
    let Some(bench) = lab.bench() else { return };
    let list = factors(bench.robot(), bench.values(), bench.tip(), detail);
    let pinned = WIDTH + 2.0 * f32::from(MARGIN) + 3.0 * GAP;
    // Where less than two of them fit, the whole map comes after its factors.
    let is_pinned = ui.available_width() >= 2.0 * pinned;
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0 * GAP;
        let room = if is_pinned {
            ui.available_width() - pinned
        } else {
            ui.available_width()
        };
        ScrollArea::both()
            .id_salt("factors")
            .max_width(room)
            .auto_shrink([false, false])
            .show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    ui.spacing_mut().item_spacing.x = 2.0 * GAP;
                    for (index, factor) in list.iter().enumerate() {
                        let name = bench.robot().joint_name(factor.joint);
                        let before = index.checked_sub(1).map(|before| &list[before]);
                        ui.push_id(index, |ui| card(ui, factor, before, name));
                    }
                    if let Some(last) = list.last().filter(|_| !is_pinned) {
                        whole(ui, last);
                    }
                });
            });
        if let Some(last) = list.last().filter(|_| is_pinned) {
            whole(ui, last);
        }
    });
}

fn frame(ui: &mut Ui, edge: Color32, contents: impl FnOnce(&mut Ui)) {
    let frame = Frame::NONE
        .fill(Palette::in_ui(ui).raised)
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(7.0)
        .inner_margin(Margin::symmetric(MARGIN, 5));
    frame.show(ui, |ui| {
        ui.vertical(|ui| {
            ui.set_width(WIDTH);
            ui.spacing_mut().item_spacing.y = 2.0;
            contents(ui);
        });
    });
}

/// The whole map, which stays while the factors are scrolled.
fn whole(ui: &mut Ui, last: &Factor) {
    let palette = Palette::in_ui(ui);
    frame(ui, palette.accent, |ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, 17.0), Sense::hover());
        let text = RichText::new("T").strong();
        row::text_in(ui, rect, text, palette.accent);
        let rest = egui::Rect::from_min_max(rect.min + vec2(16.0, 0.0), rect.max);
        row::text_in(
            ui,
            rest,
            RichText::new("the tip in the world"),
            palette.text,
        );
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, 15.0), Sense::hover());
        let product = format!("= {}", product_name(last, Some(last)));
        let product = RichText::new(product).monospace().size(10.5);
        row::text_in(ui, rect, product, palette.quiet);
        matrix(ui, &last.product, palette.accent);
    });
}

fn card(ui: &mut Ui, factor: &Factor, before: Option<&Factor>, name: &str) {
    let palette = Palette::in_ui(ui);
    frame(ui, palette.line, |ui| {
        head(ui, factor, name);
        matrix(ui, &factor.matrix, palette.text);
        ui.add_space(2.0);
        let product = product_name(factor, before);
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, 15.0), Sense::hover());
        row::text_in(
            ui,
            rect,
            RichText::new(product).small().strong(),
            palette.quiet,
        );
        matrix(ui, &factor.product, palette.quiet);
    });
}

fn head(ui: &mut Ui, factor: &Factor, name: &str) {
    let palette = Palette::in_ui(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, 17.0), Sense::hover());
    let split = rect.left() + 8.0 * factor.symbol.len() as f32 + 8.0;
    let symbol = egui::Rect::from_min_max(rect.min, pos2(split, rect.bottom()));
    row::text_in(
        ui,
        symbol,
        RichText::new(&factor.symbol).strong(),
        palette.accent,
    );
    let rest = egui::Rect::from_min_max(pos2(split, rect.top()), rect.max);
    row::text_in(ui, rest, RichText::new(name), palette.text);
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, 15.0), Sense::hover());
    let formula = RichText::new(&factor.formula).monospace().size(10.5);
    row::text_in(ui, rect, formula, palette.quiet);
    response.on_hover_text(&factor.formula);
}

/// What the running product is a product of.
fn product_name(factor: &Factor, before: Option<&Factor>) -> String {
    match (factor.symbol.as_str(), before) {
        (_, None) | ("B", _) => "B".to_owned(),
        ("A1", Some(_)) => "B A1".to_owned(),
        ("A2", Some(_)) => "B A1 A2".to_owned(),
        (symbol, Some(_)) => format!("B A1 .. {symbol}"),
    }
}

/// Four by four numbers between brackets: the columns of the rotation have the colours of their axes.
fn matrix(ui: &mut Ui, matrix: &DMat4, color: Color32) {
    let palette = Palette::in_ui(ui);
    let size = vec2(WIDTH, 4.0 * ROW + 4.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let painter = ui.painter();
    let pen = Stroke::new(1.2, palette.quiet);
    for (x, inward) in [(rect.left() + 1.0, 4.0), (rect.right() - 1.0, -4.0)] {
        painter.line(
            vec![
                pos2(x + inward, rect.top()),
                pos2(x, rect.top()),
                pos2(x, rect.bottom()),
                pos2(x + inward, rect.bottom()),
            ],
            pen,
        );
    }
    let font = FontId::monospace(10.5);
    let mut lines = Vec::new();
    for row in 0..4 {
        let mut line = String::new();
        for column in 0..4 {
            let value = matrix.col(column)[row];
            let text = number(value, row);
            // The axes of the turn have colours of their own; the place has none.
            let tint = match CURVES.get(column).filter(|_| column < 3) {
                _ if row == 3 => palette.quiet.gamma_multiply(0.7),
                Some(axis) => color.lerp_to_gamma(*axis, 0.45),
                None => color,
            };
            let place = pos2(
                rect.left() + 6.0 + COLUMN * (column as f32 + 1.0),
                rect.top() + 2.0 + ROW * (row as f32 + 0.5),
            );
            line.push_str(&format!("{text:>9}"));
            painter.text(place, Align2::RIGHT_CENTER, text, font.clone(), tint);
        }
        lines.push(line);
    }
    let all = lines.join("\n");
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, all.clone()));
}

/// The last row is whole.
fn number(value: f64, row: usize) -> String {
    fixed(value, if row == 3 { 0 } else { 3 })
}
