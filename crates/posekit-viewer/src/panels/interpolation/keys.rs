//! The left side: a preset and what to look for in it, and the keys with their angles.

use egui::{Button, ComboBox, DragValue, RichText, ScrollArea, Sense, Slider, Ui, vec2};
use posekit::rotation::Axis;

use super::super::row;
use crate::icons::{Icon, sized_icon};
use crate::state::interpolation::case::{LabPreset, MOST_KEYS, ORDERS, WIDEST_DEG};
use crate::state::interpolation::{InterpolationLab, Span};
use crate::theme::{CURVES, GAP, Palette};

/// Width of a number at the right of its slider.
const NUMBER: f32 = 70.0;

/// Sliders go a turn to either side, numbers farther.
const SLIDER_DEG: f64 = 360.0;

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut InterpolationLab) {
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            row::heading(ui, "Show me", |_| {});
            presets(ui, lab);
            row::divider(ui);
            row::heading(ui, "Orientations", |ui| {
                order(ui, lab);
                let swap = Button::new(RichText::new("Swap").small());
                if ui
                    .add(swap)
                    .on_hover_text("Start and end change places")
                    .clicked()
                {
                    lab.begin_step();
                    lab.change(crate::state::interpolation::Case::swap);
                }
            });
            ui.spacing_mut().item_spacing = vec2(GAP, 3.0);
            let mut removed = None;
            for key in 0..lab.case().keys_deg().len() {
                show_key(ui, lab, key, &mut removed);
            }
            if let Some(key) = removed {
                lab.begin_step();
                lab.change(|case| case.remove_key(key));
            }
            ui.add_space(GAP);
            add_button(ui, lab);
        });
}

fn presets(ui: &mut Ui, lab: &mut InterpolationLab) {
    let now = lab.case().preset();
    let mut chosen = None;
    ComboBox::from_id_salt("preset")
        .selected_text(now.map_or("Your own", LabPreset::title))
        .width(ui.available_width())
        .height(360.0)
        .show_ui(ui, |ui| {
            for preset in LabPreset::all() {
                if ui
                    .selectable_label(now == Some(preset), preset.title())
                    .on_hover_text(preset.says())
                    .clicked()
                {
                    chosen = Some(preset);
                }
            }
        })
        .response
        .on_hover_text("Orientations that show something");
    if let Some(preset) = chosen {
        lab.take_preset(preset);
    }
    let says = lab.case().preset().map_or(
        "Set the angles, drag the rings of start and end, or choose a preset.",
        LabPreset::says,
    );
    let quiet = Palette::in_ui(ui).quiet;
    ui.label(RichText::new(says).small().color(quiet));
}

fn order(ui: &mut Ui, lab: &mut InterpolationLab) {
    let now = lab.case().order().to_string();
    let mut chosen = None;
    ComboBox::from_id_salt("order of angles")
        .selected_text(&now)
        .width(66.0)
        .height(340.0)
        .show_ui(ui, |ui| {
            for word in ORDERS {
                if ui.selectable_label(now == word, word).clicked() {
                    chosen = word.parse().ok();
                }
            }
        })
        .response
        .on_hover_text("The order of the Euler angles below; the orientations stay");
    if let Some(order) = chosen {
        lab.begin_step();
        lab.change(|case| case.set_order(order));
    }
}

/// A key: its name, and its three angles; the start and the end with sliders.
fn show_key(ui: &mut Ui, lab: &mut InterpolationLab, key: usize, removed: &mut Option<usize>) {
    let [start, end] = lab.ends();
    let is_end = key == start || key == end;
    let count = lab.case().keys_deg().len();
    let name = match key {
        _ if key == start => "Start".to_owned(),
        _ if key == end => "End".to_owned(),
        _ => format!("Key {}", key + 1),
    };
    ui.add_space(GAP);
    title(ui, lab, (key, count, &name), removed);
    if is_end {
        for axis in 0..3 {
            slider(ui, lab, (key, axis), &name);
        }
        return;
    }
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 2.0 * GAP) / 3.0;
        for axis in 0..3 {
            number(ui, lab, (key, axis), (&name, width));
        }
    });
}

fn title(
    ui: &mut Ui,
    lab: &mut InterpolationLab,
    (key, count, name): (usize, usize, &str),
    removed: &mut Option<usize>,
) {
    let palette = Palette::in_ui(ui);
    ui.horizontal(|ui| {
        let is_end = lab.ends().contains(&key);
        let text = match (is_end, count) {
            (true, 3..) => format!("{name}  \u{b7}  key {}", key + 1),
            _ => name.to_owned(),
        };
        let color = if is_end { palette.text } else { palette.quiet };
        let text = RichText::new(text).strong().color(color);
        if count > 2 {
            let says = "Look at the way from this key to the next";
            let button = Button::new(text).frame_when_inactive(false);
            if ui.add(button).on_hover_text(says).clicked() {
                lab.change(|case| case.set_gap(key));
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let says = format!("Take key {} away", key + 1);
                if sized_icon(ui, Icon::Close, &says, false, vec2(22.0, 20.0)).clicked() {
                    *removed = Some(key);
                }
            });
        } else {
            ui.label(text);
        }
    });
}

fn letter(lab: &InterpolationLab, axis: usize) -> (char, egui::Color32) {
    let axis = lab
        .case()
        .order()
        .axes()
        .get(axis)
        .copied()
        .unwrap_or(Axis::X);
    let color = match axis {
        Axis::X => CURVES[0],
        Axis::Y => CURVES[1],
        Axis::Z => CURVES[2],
    };
    (axis.letter(), color)
}

/// An angle with its slider.
fn slider(ui: &mut Ui, lab: &mut InterpolationLab, (key, axis): (usize, usize), name: &str) {
    let before = lab.case().keys_deg()[key][axis];
    let mut shown = before;
    let (letter, color) = letter(lab, axis);
    let label = format!("{name} {letter} {}", axis + 1);
    let mut touched = Touched::default();
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(14.0, 22.0), Sense::hover());
        row::text_in(ui, rect, RichText::new(letter.to_string()).strong(), color);
        ui.spacing_mut().slider_width = (ui.available_width() - NUMBER - GAP).max(30.0);
        let slider = Slider::new(&mut shown, -SLIDER_DEG..=SLIDER_DEG)
            .clamping(egui::SliderClamping::Never)
            .show_value(false)
            .smart_aim(false)
            .trailing_fill(false);
        let response = ui.add(slider);
        response.widget_info(|| egui::WidgetInfo::slider(true, shown, label.clone()));
        touched.note(&response);
        let response = field(ui, &mut shown, NUMBER, &label);
        touched.note(&response);
    });
    apply(lab, (key, axis), (before, shown), touched);
}

/// An angle alone.
fn number(
    ui: &mut Ui,
    lab: &mut InterpolationLab,
    (key, axis): (usize, usize),
    (name, width): (&str, f32),
) {
    let before = lab.case().keys_deg()[key][axis];
    let mut shown = before;
    let (letter, _) = letter(lab, axis);
    let label = format!("{name} {letter} {}", axis + 1);
    let mut touched = Touched::default();
    let response = field(ui, &mut shown, width, &label).on_hover_text(letter.to_string());
    touched.note(&response);
    apply(lab, (key, axis), (before, shown), touched);
}

fn field(ui: &mut Ui, shown: &mut f64, width: f32, label: &str) -> egui::Response {
    let number = DragValue::new(shown)
        .speed(0.5)
        .range(-WIDEST_DEG..=WIDEST_DEG)
        .max_decimals(2)
        .suffix("\u{b0}");
    let response = ui.add_sized(vec2(width, 20.0), number);
    let value = *shown;
    response.widget_info(|| egui::WidgetInfo {
        label: Some(label.to_owned()),
        ..egui::WidgetInfo::drag_value(true, value)
    });
    response
}

/// What the pointer does with a slider or a number.
#[derive(Clone, Copy, Debug, Default)]
struct Touched {
    has_started: bool,
    is_dragged: bool,
}

impl Touched {
    fn note(&mut self, response: &egui::Response) {
        self.has_started |= response.drag_started();
        self.is_dragged |= response.dragged();
    }
}

fn apply(
    lab: &mut InterpolationLab,
    (key, axis): (usize, usize),
    (before, shown): (f64, f64),
    touched: Touched,
) {
    // What was not touched stays as it is, to the last bit.
    let is_changed = (shown - before).abs() > 1e-9;
    if touched.has_started || (is_changed && !touched.is_dragged) {
        lab.begin_step();
    }
    if is_changed {
        // A slider is not finer than this.
        let angle = (shown * 100.0).round() / 100.0;
        lab.change(|case| case.set_angle(key, axis, angle));
    }
}

fn add_button(ui: &mut Ui, lab: &mut InterpolationLab) {
    let is_full = lab.case().keys_deg().len() >= MOST_KEYS;
    let says =
        "Another key after the end. All methods go from key to key; squad looks at the keys around";
    let button = Button::new("Add a key");
    if ui
        .add_enabled(!is_full, button)
        .on_hover_text(says)
        .clicked()
    {
        lab.begin_step();
        lab.change(crate::state::interpolation::Case::add_key);
        lab.set_span(Span::AllKeys);
    }
}
