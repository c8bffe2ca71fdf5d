//! The right side: the methods with their colours, which of them are shown, and their numbers.

use egui::{
    Align2, Button, Color32, FontId, Rect, RichText, ScrollArea, Sense, Stroke, Ui, pos2, vec2,
};
use posekit::inbetween::Method;

use super::super::row;
use super::color;
use crate::state::interpolation::colors::hex_of;
use crate::state::interpolation::{InterpolationLab, Kind, Span, Way};
use crate::state::readout::fixed;
use crate::theme::{GAP, Palette};

/// Height of a row.
const ROW: f32 = 25.0;

/// The columns of numbers: heading, and what it is.
const COLUMNS: [(&str, &str); 4] = [
    ("strays", "How far it is from slerp at most, in degrees"),
    (
        "slowest",
        "How fast it turns at least, in degrees for a way from key to key",
    ),
    (
        "fastest",
        "How fast it turns at most, in degrees for a way from key to key",
    ),
    (
        "det",
        "The least determinant of what it makes: 1 for a rotation",
    ),
];

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut InterpolationLab) {
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            row::heading(ui, "Methods", |ui| all_or_none(ui, lab));
            let columns = columns(ui);
            headings(ui, &columns);
            ui.spacing_mut().item_spacing.y = 0.0;
            for kind in Kind::all() {
                kind_row(ui, lab, kind, &columns);
            }
            ui.add_space(2.0 * GAP);
            ui.spacing_mut().item_spacing.y = GAP;
            notes(ui, lab);
        });
}

fn all_or_none(ui: &mut Ui, lab: &mut InterpolationLab) {
    for (name, says, choose) in [
        (
            "None",
            "Show slerp alone",
            (|kind| kind == Kind::Between(Method::Slerp)) as fn(Kind) -> bool,
        ),
        ("All", "Show every method", |_| true),
    ] {
        let button = Button::new(RichText::new(name).small());
        if ui.add(button).on_hover_text(says).clicked() {
            for kind in Kind::all() {
                lab.set_shown(kind, choose(kind));
            }
        }
        ui.add_space(GAP);
    }
}

/// Where the numbers end, from the left.
fn columns(ui: &Ui) -> [f32; 4] {
    let width = ui.available_width() - 6.0;
    let step = ((width - 96.0) / 4.0).clamp(38.0, 70.0);
    [3.0, 2.0, 1.0, 0.0].map(|from_right| width - step * from_right)
}

fn headings(ui: &mut Ui, columns: &[f32; 4]) {
    let palette = Palette::in_ui(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 18.0), Sense::hover());
    for ((name, says), end) in COLUMNS.into_iter().zip(columns) {
        let place = pos2(rect.left() + end, rect.center().y);
        let written = ui.painter().text(
            place,
            Align2::RIGHT_CENTER,
            name,
            FontId::proportional(11.0),
            palette.quiet,
        );
        let id = ui.scope_id().with(name);
        ui.interact(written.expand(3.0), id, Sense::hover())
            .on_hover_text(says);
    }
}

fn kind_row(ui: &mut Ui, lab: &mut InterpolationLab, kind: Kind, columns: &[f32; 4]) {
    let is_shown = lab.is_shown(kind);
    let palette = Palette::in_ui(ui);
    let word = kind.name(lab.case().order());
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_shown, word.clone())
    });
    if response.hovered() {
        ui.painter().rect_filled(rect, 5.0, palette.hover);
    }
    swatch(ui, rect, color(hex_of(kind)), is_shown);
    let text = if is_shown {
        palette.text
    } else {
        palette.quiet
    };
    let name = Rect::from_min_max(
        rect.min + vec2(24.0, 0.0),
        pos2(rect.left() + columns[0] - 30.0, rect.bottom()),
    );
    row::text_in(ui, name, RichText::new(&word), text);
    if let Some(way) = lab.way(kind) {
        for (number, end) in numbers(way).into_iter().zip(columns) {
            let color = match number.stands_out {
                true => palette.warning,
                false => text,
            };
            ui.painter().text(
                pos2(rect.left() + end, rect.center().y),
                Align2::RIGHT_CENTER,
                number.text,
                FontId::proportional(12.0),
                color,
            );
        }
    }
    if response.on_hover_text(says_of(kind)).clicked() {
        lab.set_shown(kind, !is_shown);
    }
}

/// A square in a colour, filled when on.
pub(super) fn swatch(ui: &Ui, row: Rect, color: Color32, is_on: bool) {
    let place = pos2(row.left() + 11.0, row.center().y);
    let square = Rect::from_center_size(place, vec2(12.0, 12.0));
    if is_on {
        ui.painter().rect_filled(square, 3.0, color);
    } else {
        let edge = Stroke::new(1.6, color.gamma_multiply(0.7));
        ui.painter()
            .rect_stroke(square, 3.0, edge, egui::StrokeKind::Inside);
    }
}

struct Number {
    text: String,
    stands_out: bool,
}

fn numbers(way: &Way) -> [Number; 4] {
    let plain = |text: String| Number {
        text,
        stands_out: false,
    };
    let speed = |deg: f64| match deg {
        ..1e3 => fixed(deg, 1),
        ..1e4 => fixed(deg, 0),
        _ => format!("{}k", fixed(deg / 1e3, 0)),
    };
    [
        plain(match way.kind {
            Kind::Between(Method::Slerp) => "\u{2013}".to_owned(),
            _ => fixed(way.most_deviation_deg, 2),
        }),
        plain(speed(way.least_speed_deg)),
        plain(speed(way.most_speed_deg)),
        Number {
            text: fixed(way.least_determinant, 3),
            stands_out: way.least_determinant < 0.999,
        },
    ]
}

/// What it does, in a sentence.
fn says_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Between(method) => says(method),
        Kind::Curves => {
            "Straight curves of the angles at the left, in their order, as in a graph editor: whole turns count"
        }
    }
}

/// What a method does, in a sentence.
pub(super) const fn says(method: Method) -> &'static str {
    match method {
        Method::Slerp => "R1 exp(t log(R1^T R2)): the shortest way at an even pace",
        Method::RawSlerp => {
            "Slerp that does not look at the quaternions' signs: it may go the long way round"
        }
        Method::Nlerp => {
            "The chord between the quaternions, normalised: slerp's way at an uneven pace"
        }
        Method::RawLerp => {
            "The chord between the quaternions as it is: it scales. Speed and straying are those of its rotation"
        }
        Method::Matrix => {
            "The nine elements: no rotation in between. Speed and straying are those of the nearest rotation"
        }
        Method::RotationVector => "The three components of the rotation vector",
        Method::Euler(_) => "Three angles, each by itself",
        Method::Squad => {
            "A curve through the keys around as well; between two keys alone it is slerp"
        }
        _ => "",
    }
}

fn notes(ui: &mut Ui, lab: &InterpolationLab) {
    let Palette { quiet, warning, .. } = Palette::in_ui(ui);
    for lost in lab.lost_turns() {
        ui.label(RichText::new(lost.text()).small().color(warning));
    }
    let lerp = "matrix and lerp make no rotations in between: how far they stray and how fast they turn \
                is told of the nearest rotation.";
    ui.label(RichText::new(lerp).small().color(quiet));
    let span = match lab.span() {
        Span::Pair => "Numbers over 100 steps from start to end, those of posekit slerp.",
        Span::AllKeys => "Numbers over all keys, 40 steps from each to the next.",
    };
    ui.label(RichText::new(span).small().color(quiet));
    ui.add_space(GAP);
    ui.horizontal_wrapped(|ui| {
        if ui
            .button("Copy command")
            .on_hover_text(lab.command())
            .clicked()
        {
            ui.copy_text(lab.command());
        }
        let says =
            "Every step of the shown methods from start to end, as posekit slerp --csv prints it";
        if ui.button("Copy numbers").on_hover_text(says).clicked() {
            ui.copy_text(lab.numbers());
        }
    });
}
