//! The left side: which robot, and where each of its joints stands.

use egui::{Button, ComboBox, DragValue, RichText, ScrollArea, Sense, Slider, Ui, vec2};
use posekit::mechanism::ValueRange;

use super::super::{Asked, row, tip};
use super::LabPanel;
use crate::command::Command;
use crate::icons::{Icon, icon_button};
use crate::state::arm::bench::AT_END;
use crate::state::arm::robot::ValueKind;
use crate::state::arm::{ArmLab, Bench};
use crate::state::readout::fixed;
use crate::theme::{GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut ArmLab, panel: &mut LabPanel, asked: &mut Asked) {
    ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            row::heading(ui, "Robot", |ui| {
                if icon_button(ui, Icon::Folder, &tip("Open a URDF file", Command::Open)).clicked()
                {
                    asked.command(Command::Open);
                }
            });
            choose(ui, lab);
            row::divider(ui);
            row::heading(ui, "Joints", |ui| buttons(ui, lab));
            panel.pointed = None;
            ui.spacing_mut().item_spacing = vec2(GAP, 2.0);
            let count = lab.bench().map_or(0, |bench| bench.values().len());
            if count == 0 {
                row::empty_note(ui, "Nothing about this robot moves.");
            }
            for index in 0..count {
                value(ui, lab, panel, index);
                ui.add_space(GAP);
            }
            if let Some(bench) = lab.bench() {
                followers(ui, bench);
            }
        });
}

/// Which robot is on the bench.
fn choose(ui: &mut Ui, lab: &mut ArmLab) {
    let Some(bench) = lab.bench() else { return };
    let name = bench.robot().name.clone();
    let quiet = Palette::in_ui(ui).quiet;
    let summary = summary(bench);
    let mut sample = None;
    let mut opened = None;
    ComboBox::from_id_salt("robot")
        .selected_text(title(&name))
        .width(ui.available_width())
        .show_ui(ui, |ui| {
            for (known, what) in ArmLab::samples() {
                if ui
                    .selectable_label(known == name, format!("{}  \u{2013}  {what}", title(known)))
                    .clicked()
                {
                    sample = Some(known);
                }
            }
            for robot in lab.opened() {
                if ui
                    .selectable_label(robot.name == name, &robot.name)
                    .clicked()
                {
                    opened = Some(robot.name.clone());
                }
            }
        })
        .response
        .on_hover_text("Which robot is on the bench");
    ui.label(RichText::new(summary).small().color(quiet));
    if let Some(known) = sample {
        lab.open_sample(known);
    }
    if let Some(known) = opened {
        lab.open_again(&known);
    }
}

/// A sample's name for people.
fn title(name: &str) -> &str {
    match name {
        "planar2" => "Two-link arm",
        "arm6" => "Six-axis arm",
        "arm7" => "Seven-axis arm",
        name => name,
    }
}

fn summary(bench: &Bench) -> String {
    let values = match bench.values().len() {
        1 => "1 degree of freedom".to_owned(),
        count => format!("{count} degrees of freedom"),
    };
    format!("{values}, reaches {} m", fixed(bench.robot().reach, 2))
}

fn buttons(ui: &mut Ui, lab: &mut ArmLab) {
    type Act = fn(&mut Bench);
    let acts: [(&str, &str, Act); 3] = [
        ("Random", "Random places in the ranges", Bench::randomize),
        (
            "Zero",
            "All values to zero, as far as their ranges let them",
            Bench::go_to_zero,
        ),
        ("Start", "As it stood first", Bench::go_home),
    ];
    ui.spacing_mut().item_spacing.x = GAP;
    for (name, says, act) in acts {
        if ui
            .add(Button::new(RichText::new(name).small()))
            .on_hover_text(says)
            .clicked()
        {
            lab.work(act);
        }
    }
}

/// One value: its name and number, its slider, and the ends of its range.
fn value(ui: &mut Ui, lab: &mut ArmLab, panel: &mut LabPanel, index: usize) {
    let Some(bench) = lab.bench() else { return };
    let robot = bench.robot();
    let kind = robot.values[index].clone();
    let symbol = format!("t{}", index + 1);
    let joint = robot.joint_name(kind.joint).to_owned();
    let name = match kind.part {
        "" => joint,
        part => format!("{joint} {part}"),
    };
    let before = bench.values()[index];
    let scale = if kind.is_angle {
        1f64.to_degrees()
    } else {
        1.0
    };
    let mut shown = before * scale;
    let ends = (kind.offered.lower * scale)..=(kind.offered.upper * scale);
    let palette = Palette::in_ui(ui);
    let mut has_started = false;
    let mut is_dragged = false;
    let top = ui.cursor().top();
    ui.horizontal(|ui| {
        let number_width = 76.0;
        let room = vec2(ui.available_width() - number_width - GAP, 20.0);
        let (rect, _) = ui.allocate_exact_size(room, Sense::hover());
        let letter = egui::Rect::from_min_size(rect.min, vec2(22.0, rect.height()));
        row::text_in(ui, letter, RichText::new(&symbol).strong(), palette.accent);
        let rest = egui::Rect::from_min_max(rect.min + vec2(24.0, 0.0), rect.max);
        // A planar arm's joints are often called as the formula calls them.
        if name != symbol {
            row::text_in(ui, rest, RichText::new(&name), palette.text);
        }
        let number = DragValue::new(&mut shown)
            .speed(if kind.is_angle { 0.5 } else { 0.002 })
            .range(ends.clone())
            .fixed_decimals(if kind.is_angle { 1 } else { 3 })
            .suffix(if kind.is_angle { "\u{b0}" } else { " m" });
        let response = ui.add_sized(vec2(number_width, 20.0), number);
        has_started |= response.drag_started();
        is_dragged |= response.dragged();
    });
    ui.spacing_mut().slider_width = ui.available_width();
    let slider = Slider::new(&mut shown, ends)
        .show_value(false)
        .smart_aim(false);
    let response = ui.add(slider);
    response.widget_info(|| egui::WidgetInfo::slider(true, shown, symbol.clone()));
    has_started |= response.drag_started();
    is_dragged |= response.dragged();
    range_ends(ui, &kind, before);
    let area = egui::Rect::from_min_max(
        egui::pos2(ui.min_rect().left(), top),
        egui::pos2(ui.max_rect().right(), ui.cursor().top()),
    );
    if ui.rect_contains_pointer(area) {
        panel.pointed = Some(kind.joint);
    }
    let wanted = shown / scale;
    // What was not touched stays as it is, to the last bit.
    let is_changed = (wanted - before).abs() > 1e-12;
    if has_started || (is_changed && !is_dragged) {
        lab.work(Bench::begin_step);
    }
    if is_changed {
        lab.work(|bench| bench.set_value(index, wanted));
    }
}

/// The ends of a range under its slider; the one that a value is at stands out.
fn range_ends(ui: &mut Ui, kind: &ValueKind, value: f64) {
    let palette = Palette::in_ui(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 13.0), Sense::hover());
    let text = |end: f64| match (end.is_finite(), kind.is_angle) {
        (false, _) => "no limit".to_owned(),
        (true, true) => format!("{}\u{b0}", fixed(end.to_degrees(), 0)),
        (true, false) => format!("{} m", fixed(end, 2)),
    };
    let ValueRange { lower, upper } = kind.range;
    let sides = [
        (lower, egui::Align2::LEFT_CENTER, rect.left_center()),
        (upper, egui::Align2::RIGHT_CENTER, rect.right_center()),
    ];
    for (end, align, place) in sides {
        let is_at = (value - end).abs() <= AT_END;
        let (text, color) = if is_at {
            (format!("{}  limit", text(end)), palette.warning)
        } else {
            (text(end), palette.quiet)
        };
        let font = egui::FontId::proportional(10.5);
        ui.painter().text(place, align, text, font, color);
    }
}

/// Joints that follow others have no slider; where they are is told.
fn followers(ui: &mut Ui, bench: &Bench) {
    let robot = bench.robot();
    let mechanism = &robot.mechanism;
    let quiet = Palette::in_ui(ui).quiet;
    for joint in mechanism.skeleton().joints() {
        let Some(follow) = mechanism.joint(joint).follows else {
            continue;
        };
        let Some(value) = robot.value_of(joint, bench.values()) else {
            continue;
        };
        let is_angle = matches!(
            mechanism.joint(joint).freedom,
            posekit::mechanism::Freedom::Hinge { .. }
        );
        let number = if is_angle {
            format!("{}\u{b0}", fixed(value.to_degrees(), 1))
        } else {
            format!("{} m", fixed(value, 3))
        };
        let text = format!(
            "{} follows {}: {number}",
            robot.joint_name(joint),
            robot.joint_name(follow.joint)
        );
        ui.label(RichText::new(text).small().color(quiet));
    }
}
