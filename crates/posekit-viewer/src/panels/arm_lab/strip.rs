//! What lies over the lab's view: what the gizmo asks for, what is shown, and a warning.

use egui::containers::menu::MenuButton;
use egui::{
    Align, Button, Frame, Layout, Margin, Rect, RichText, Stroke, Ui, UiBuilder, pos2, vec2,
};

use super::super::{Asked, row, stay_open, tip};
use crate::command::Command;
use crate::gizmo::Tool;
use crate::icons::{self, Icon};
use crate::state::arm::ArmLab;
use crate::state::arm::bench::Bench;
use crate::state::arm::mobility::{Hardest, Singularity};
use crate::state::mode::{Space, TURN_STEP_DEG};
use crate::theme::{GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, rect: Rect, lab: &mut ArmLab, asked: &mut Asked) {
    let room = rect.shrink(10.0);
    if room.width() < 160.0 || room.height() < 80.0 {
        return;
    }
    let builder = UiBuilder::new()
        .max_rect(room)
        .layout(Layout::left_to_right(Align::Min));
    let above = ui.scope_builder(builder, |ui| tools(ui, room.width(), lab, asked));
    let Some(bench) = lab.bench() else { return };
    let below = room.with_min_y(above.inner.bottom() + 2.0 * GAP);
    warning(ui, below, bench);
    if bench.is_dragging() {
        pill(ui, room, "Ctrl: in steps  \u{b7}  Esc: let go");
    }
}

/// Where less is left the tools are in two lines.
const TOOLS_ROOM: f32 = 520.0;

/// Shows the tools. Where they are.
fn tools(ui: &mut Ui, width: f32, lab: &mut ArmLab, asked: &mut Asked) -> Rect {
    let palette = Palette::in_ui(ui);
    let card = Frame::NONE
        .fill(palette.raised.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(9.0)
        .inner_margin(Margin::same(3));
    let shown = card.show(ui, |ui| {
        let first = |ui: &mut Ui, (lab, asked): &mut (&mut ArmLab, &mut Asked)| {
            let (undo, redo) = lab.bench().map_or((false, false), Bench::can_undo_redo);
            row::undo_buttons(ui, (undo.into(), redo.into()), 26.0, asked);
            tool_choice(ui, lab);
        };
        let second = |ui: &mut Ui, (lab, asked): &mut (&mut ArmLab, &mut Asked)| {
            space_choice(ui, lab);
            snap(ui, lab, asked);
            shown_choice(ui, lab);
        };
        row::rows(ui, width >= TOOLS_ROOM, &mut (lab, asked), [first, second]);
    });
    shown.response.rect
}

fn tool_choice(ui: &mut Ui, lab: &mut ArmLab) {
    let Some(now) = lab.bench().map(Bench::tool) else {
        return;
    };
    let mut chosen = None;
    row::well(ui, |ui| {
        for (tool, name, says) in [
            (
                Tool::Move,
                "Place",
                "The tip is brought to a place, turned any way",
            ),
            (
                Tool::MoveAndTurn,
                "Place and turn",
                "The tip is brought to a place, turned in a certain way",
            ),
        ] {
            let is_now = now.turns() == tool.turns();
            if row::segment(ui, name, is_now).on_hover_text(says).clicked() && !is_now {
                chosen = Some(tool);
            }
        }
    });
    if let Some(tool) = chosen {
        lab.work(|bench| bench.set_tool(tool));
    }
}

fn space_choice(ui: &mut Ui, lab: &mut ArmLab) {
    let Some(now) = lab.bench().map(Bench::space) else {
        return;
    };
    let mut chosen = None;
    row::well(ui, |ui| {
        for (space, name, says) in [
            (Space::World, "World", "The gizmo's axes are the world's"),
            (Space::Local, "Tip", "The gizmo's axes are the tip's"),
        ] {
            if row::segment(ui, name, now == space)
                .on_hover_text(says)
                .clicked()
            {
                chosen = Some(space);
            }
        }
    });
    if let Some(space) = chosen {
        lab.work(|bench| bench.set_space(space));
    }
}

fn snap(ui: &mut Ui, lab: &ArmLab, asked: &mut Asked) {
    let Some(step) = lab.bench().map(|bench| bench.snap().length) else {
        return;
    };
    let says = format!("Go in steps of {TURN_STEP_DEG}\u{b0} and {step} m; Ctrl does the other");
    let button = Button::selectable(lab.snaps(), "Snap");
    let says = tip(&says, Command::ToggleSnap);
    if ui.add(button).on_hover_text(says).clicked() {
        asked.command(Command::ToggleSnap);
    }
}

fn shown_choice(ui: &mut Ui, lab: &mut ArmLab) {
    let mut shown = lab.shown();
    let is_planar = lab.bench().is_some_and(|bench| bench.planar().is_some());
    let button = Button::new("Show").frame_when_inactive(false);
    stay_open(MenuButton::from_button(button)).ui(ui, |ui| {
        ui.set_width(210.0);
        ui.checkbox(&mut shown.frames, "Frames of the joints");
        ui.checkbox(&mut shown.names, "Names of the joints");
        ui.checkbox(&mut shown.ellipsoid, "Velocity ellipsoid")
            .on_hover_text(
                "Where the tip would be after a fifth of a second, the joints going at unit speed all together",
            );
        if is_planar {
            ui.separator();
            ui.checkbox(&mut shown.reach, "What it can reach");
            ui.checkbox(&mut shown.other_elbow, "The other elbow");
        }
    });
    lab.set_shown(shown);
}

/// Says that the arm is at a singularity or near one, and what is lost.
fn warning(ui: &Ui, room: Rect, bench: &Bench) {
    let mobility = bench.mobility();
    let palette = Palette::in_ui(ui);
    let (word, color) = match mobility.singularity {
        Singularity::Far => return,
        Singularity::Near => ("Near a singularity: hard", palette.warning),
        Singularity::At => ("Singular: it cannot", palette.error),
    };
    let verb = match (mobility.singularity, mobility.hardest) {
        (_, None) => return,
        (Singularity::At, Some(Hardest::Move(_))) => "move along the red line",
        (Singularity::At, Some(Hardest::Turn(_))) => "turn about the red line",
        (_, Some(Hardest::Move(_))) => "to move along the line",
        (_, Some(Hardest::Turn(_))) => "to turn about the line",
    };
    let text = format!("{word} {verb}");
    let font = egui::FontId::proportional(13.5);
    let width = (room.width() - 42.0).max(40.0);
    let galley = ui.painter().layout(text.clone(), font, color, width);
    let size = galley.size() + vec2(42.0, 12.0);
    // Under the tools, in the middle.
    let at = pos2(room.center().x - size.x / 2.0, room.top());
    let card = Rect::from_min_size(at, size);
    ui.painter().rect(
        card,
        size.y.min(28.0) / 2.0,
        palette.raised.gamma_multiply(0.95),
        Stroke::new(1.2, color),
        egui::StrokeKind::Inside,
    );
    let icon = Rect::from_center_size(pos2(card.left() + 19.0, card.center().y), vec2(15.0, 15.0));
    icons::draw(ui.painter(), Icon::Warning, icon, color);
    ui.painter().galley(at + vec2(32.0, 6.0), galley, color);
    let id = ui.scope_id().with("singularity");
    let response = ui.interact(card, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text.clone()));
}

fn pill(ui: &Ui, room: Rect, text: &str) {
    let palette = Palette::in_ui(ui);
    let font = egui::TextStyle::Small.resolve(ui.style());
    let text = RichText::new(text).text().to_owned();
    let galley = ui.painter().layout_no_wrap(text, font, palette.quiet);
    let size = galley.size() + vec2(20.0, 8.0);
    let at = pos2(room.center().x - size.x / 2.0, room.bottom() - size.y);
    let fill = palette.raised.gamma_multiply(0.9);
    ui.painter()
        .rect_filled(Rect::from_min_size(at, size), size.y / 2.0, fill);
    ui.painter()
        .galley(at + vec2(10.0, 4.0), galley, palette.quiet);
}
