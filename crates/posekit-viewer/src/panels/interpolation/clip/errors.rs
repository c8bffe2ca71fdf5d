//! The right side: how far each method is from the truth, and joint by joint as a map of heat.

use egui::{Align2, Color32, FontId, Rect, RichText, ScrollArea, Sense, Ui, pos2, vec2};
use posekit::inbetween::JointError;

use super::super::super::row;
use super::super::color;
use crate::state::interpolation::clip::Filled;
use crate::state::interpolation::colors::hex_of_fill;
use crate::state::interpolation::{ClipLab, InterpolationLab};
use crate::state::readout::fixed;
use crate::theme::{GAP, Palette};

/// Height of a row of methods, and of joints.
const ROW: f32 = 25.0;
const JOINT_ROW: f32 = 19.0;

/// Widths of the joints' names in the map, and of its cells at most.
const JOINT_NAME: f32 = 104.0;
const CELL: f32 = 46.0;

/// The columns of numbers: heading, and what it is.
const COLUMNS: [(&str, &str); 4] = [
    (
        "mean \u{b0}",
        "The mean angle between local rotations over the frames that were filled in, in degrees",
    ),
    ("most \u{b0}", "The largest one, in degrees"),
    (
        "mean %",
        "The mean distance between global positions, in parts of the skeleton's height",
    ),
    (
        "most %",
        "The largest one, in parts of the skeleton's height",
    ),
];

/// Shows it.
pub(in super::super) fn show(ui: &mut Ui, lab: &mut InterpolationLab) {
    let lab = &mut lab.clip;
    row::heading(ui, "Errors", |_| {});
    if lab.results().is_empty() {
        let text = match (lab.clip(), lab.progress()) {
            (None, _) => "Open a clip to compare methods on it.",
            (_, Some(_)) => "The frames are being filled in.",
            _ => "Tick methods at the left.",
        };
        row::empty_note(ui, text);
        return;
    }
    let mut go = None;
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            table(ui, lab, &mut go);
            row::divider(ui);
            heat(ui, lab, &mut go);
        });
    if let Some((frame, joint)) = go {
        lab.go_to(frame, Some(joint));
    }
}

type Go = Option<(usize, posekit::skeleton::JointId)>;

fn table(ui: &mut Ui, lab: &ClipLab, go: &mut Go) {
    let palette = Palette::in_ui(ui);
    let width = ui.available_width();
    let step = ((width - 92.0) / 4.0).clamp(38.0, 70.0);
    let ends = [3.0, 2.0, 1.0, 0.0].map(|from_right| width - step * from_right);
    let (rect, _) = ui.allocate_exact_size(vec2(width, 18.0), Sense::hover());
    for ((name, says), end) in COLUMNS.into_iter().zip(ends) {
        let place = pos2(rect.left() + end, rect.center().y);
        let font = FontId::proportional(11.0);
        let written = ui
            .painter()
            .text(place, Align2::RIGHT_CENTER, name, font, palette.quiet);
        ui.interact(
            written.expand(3.0),
            ui.scope_id().with(name),
            Sense::hover(),
        )
        .on_hover_text(says);
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    for filled in lab.results() {
        let (rect, response) = ui.allocate_exact_size(vec2(width, ROW), Sense::click());
        let word = filled.method.to_string();
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, true, format!("worst of {word}"))
        });
        if response.hovered() {
            ui.painter().rect_filled(rect, 5.0, palette.hover);
        }
        let ink = if lab.is_stale(filled) {
            palette.quiet
        } else {
            palette.text
        };
        let dot = pos2(rect.left() + 8.0, rect.center().y);
        ui.painter()
            .circle_filled(dot, 5.0, color(hex_of_fill(filled.method)));
        let name = Rect::from_min_max(
            rect.min + vec2(18.0, 0.0),
            pos2(rect.left() + ends[0] - 34.0, rect.bottom()),
        );
        row::text_in(ui, name, RichText::new(&word), ink);
        for (text, end) in numbers(lab, filled).into_iter().zip(ends) {
            let place = pos2(rect.left() + end, rect.center().y);
            let font = FontId::proportional(12.0);
            ui.painter()
                .text(place, Align2::RIGHT_CENTER, text, font, ink);
        }
        let worst = filled.error.worst().copied();
        let response = response.on_hover_text(worst.map_or_else(String::new, |worst| {
            format!("Go to the worst: {}", told(lab, &word, &worst))
        }));
        if let (true, Some(worst)) = (response.clicked(), worst) {
            *go = Some((worst.worst_frame, worst.joint));
        }
    }
}

fn numbers(lab: &ClipLab, filled: &Filled) -> [String; 4] {
    let error = &filled.error;
    let percent = |distance: f64| fixed(100.0 * distance / lab.height(), 2);
    [
        fixed(error.mean_deg, 3),
        fixed(error.max_deg, 2),
        percent(error.mean_distance),
        percent(error.max_distance),
    ]
}

fn told(lab: &ClipLab, word: &str, error: &JointError) -> String {
    let name = lab
        .clip()
        .map_or("", |clip| clip.skeleton().unique_name(error.joint));
    format!(
        "{word}, {name}: {}\u{b0} at frame {}, mean {}\u{b0}",
        fixed(error.max_deg, 2),
        error.worst_frame,
        fixed(error.mean_deg, 3)
    )
}

/// Joint by joint: the warmer, the farther in the mean; a click goes to the joint's worst frame.
fn heat(ui: &mut Ui, lab: &ClipLab, go: &mut Go) {
    let palette = Palette::in_ui(ui);
    ui.label(RichText::new("Joint by joint").strong().size(12.5));
    let results = lab.results();
    let most = results
        .iter()
        .flat_map(|filled| filled.error.joints.iter())
        .map(|joint| joint.mean_deg)
        .fold(0.0, f64::max);
    let says = format!(
        "Mean angle, from 0 to {}\u{b0}; the number is the largest. A click goes to the worst frame.",
        fixed(most, 2)
    );
    ui.label(RichText::new(says).small().color(palette.quiet));
    ui.add_space(GAP);
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let count = results.len().max(1) as f32;
    let cell = ((ui.available_width() - JOINT_NAME - 6.0) / count).clamp(12.0, CELL);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 12.0), Sense::hover());
    let mut left = rect.left() + JOINT_NAME;
    for filled in &results {
        let dot = pos2(left + 0.5 * cell, rect.center().y);
        ui.painter()
            .circle_filled(dot, 4.0, color(hex_of_fill(filled.method)));
        left += cell;
    }
    let joints = results
        .first()
        .map_or(0, |filled| filled.error.joints.len());
    ui.spacing_mut().item_spacing.y = 0.0;
    for index in 0..joints {
        let place = Rect::from_min_size(
            ui.next_widget_position(),
            vec2(ui.available_width(), JOINT_ROW),
        );
        // Rows that are scrolled away are not worth their text.
        if ui.is_rect_visible(place) {
            joint_row(ui, lab, (&results, index), (cell, most), go);
        } else {
            ui.allocate_exact_size(place.size(), Sense::hover());
        }
    }
}

fn joint_row(
    ui: &mut Ui,
    lab: &ClipLab,
    (results, index): (&[&Filled], usize),
    (cell, most): (f32, f64),
    go: &mut Go,
) {
    let palette = Palette::in_ui(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), JOINT_ROW), Sense::hover());
    let Some(joint) = results
        .first()
        .map(|filled| filled.error.joints[index].joint)
    else {
        return;
    };
    let name = lab
        .clip()
        .map_or("", |clip| clip.skeleton().unique_name(joint));
    let place = Rect::from_min_size(rect.min, vec2(JOINT_NAME - 4.0, JOINT_ROW));
    let is_marked = lab.marked() == Some(joint);
    let ink = if is_marked {
        palette.accent
    } else {
        palette.text
    };
    row::text_in(ui, place, RichText::new(name).size(11.5), ink);
    for (column, filled) in results.iter().enumerate() {
        let Some(error) = filled.error.joints.get(index) else {
            continue;
        };
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let corner = rect.min + vec2(JOINT_NAME + cell * column as f32, 0.0);
        let place = Rect::from_min_size(corner, vec2(cell, JOINT_ROW)).shrink(0.5);
        let share = if most > 0.0 {
            error.mean_deg / most
        } else {
            0.0
        };
        let fill = warmth(share, &palette);
        ui.painter().rect_filled(place, 2.0, fill);
        if cell >= 26.0 {
            let font = FontId::proportional(10.0);
            let ink = ink_on(fill);
            let text = fixed(error.max_deg, 1);
            ui.painter()
                .text(place.center(), Align2::CENTER_CENTER, text, font, ink);
        }
        let word = filled.method.to_string();
        let response = ui.interact(place, ui.scope_id().with((index, column)), Sense::click());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, true, format!("{name}, {word}"))
        });
        if response.hovered() {
            let edge = egui::Stroke::new(1.5, palette.accent);
            ui.painter()
                .rect_stroke(place, 2.0, edge, egui::StrokeKind::Inside);
        }
        if response.on_hover_text(told(lab, &word, error)).clicked() {
            *go = Some((error.worst_frame, error.joint));
        }
    }
}

/// From the ground's colour over yellow to red.
#[allow(
    clippy::cast_possible_truncation,
    reason = "a share of 0 to 1, for a colour"
)]
fn warmth(share: f64, palette: &Palette) -> Color32 {
    // The root makes small differences visible.
    let share = share.clamp(0.0, 1.0).sqrt() as f32;
    let warm = Color32::from_rgb(0xF2, 0xC1, 0x4E);
    let hot = Color32::from_rgb(0xC8, 0x32, 0x2B);
    if share < 0.5 {
        palette.sunken.lerp_to_gamma(warm, 2.0 * share)
    } else {
        warm.lerp_to_gamma(hot, 2.0 * share - 1.0)
    }
}

/// Black or white, whichever is read on a colour.
fn ink_on(fill: Color32) -> Color32 {
    let bright =
        0.3 * f32::from(fill.r()) + 0.59 * f32::from(fill.g()) + 0.11 * f32::from(fill.b());
    if bright > 130.0 {
        Color32::from_gray(25)
    } else {
        Color32::from_gray(240)
    }
}
