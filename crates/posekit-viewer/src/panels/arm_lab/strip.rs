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

/// Shows it. Where the room below it begins.
pub(super) fn show(ui: &mut Ui, rect: Rect, lab: &mut ArmLab, asked: &mut Asked) -> f32 {
    let room = rect.shrink(10.0);
    if room.width() < 120.0 || room.height() < 80.0 {
        return rect.top();
    }
    let builder = UiBuilder::new()
        .max_rect(room)
        .layout(Layout::left_to_right(Align::Min));
    let above = ui.scope_builder(builder, |ui| tools(ui, lab, asked));
    let mut bottom = above.inner.bottom();
    let Some(bench) = lab.bench() else {
        return bottom;
    };
    let below = room.with_min_y(bottom + 2.0 * GAP);
    if let Some(card) = warning(ui, below, bench) {
        bottom = card.bottom();
    }
    if bench.is_dragging() {
        pill(ui, room, "Ctrl: in steps  \u{b7}  Esc: let go");
    }
    bottom
}

/// Shows the tools. Where they are.
fn tools(ui: &mut Ui, lab: &mut ArmLab, asked: &mut Asked) -> Rect {
    let palette = Palette::in_ui(ui);
    let card = Frame::NONE
        .fill(palette.raised.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(9.0)
        .inner_margin(Margin::same(3));
    let shown = card.show(ui, |ui| {
        type Context<'a> = (&'a mut ArmLab, &'a mut Asked);
        let groups: [row::Group<Context<'_>>; 5] = [
            |ui, _, (lab, asked)| {
                let (undo, redo) = lab.bench().map_or((false, false), Bench::can_undo_redo);
                row::undo_buttons(ui, (undo.into(), redo.into()), 26.0, asked);
            },
            |ui, room, (lab, _)| tool_choice(ui, room, lab),
            |ui, room, (lab, _)| space_choice(ui, room, lab),
            |ui, _, (lab, asked)| snap(ui, lab, asked),
            |ui, _, (lab, _)| shown_choice(ui, lab),
        ];
        row::lines(ui, &mut (lab, asked), &groups);
    });
    shown.response.rect
}

fn tool_choice(ui: &mut Ui, room: f32, lab: &mut ArmLab) {
    let Some(now) = lab.bench().map(Bench::tool) else {
        return;
    };
    let options = [
        ("Place", "The tip is brought to a place, turned any way"),
        (
            "Place and turn",
            "The tip is brought to a place, turned in a certain way",
        ),
    ];
    let turns = now.turns();
    match row::one_of(ui, "tool", room, Some(usize::from(turns)), &options) {
        Some(0) if turns => lab.work(|bench| bench.set_tool(Tool::Move)),
        Some(1) if !turns => lab.work(|bench| bench.set_tool(Tool::MoveAndTurn)),
        _ => None,
    };
}

fn space_choice(ui: &mut Ui, room: f32, lab: &mut ArmLab) {
    let Some(now) = lab.bench().map(Bench::space) else {
        return;
    };
    let spaces = [Space::World, Space::Local];
    let options = [
        ("World", "The gizmo's axes are the world's"),
        ("Tip", "The gizmo's axes are the tip's"),
    ];
    let now = spaces.iter().position(|space| *space == now);
    if let Some(index) = row::one_of(ui, "space", room, now, &options) {
        lab.work(|bench| bench.set_space(spaces[index]));
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

/// Says that the arm is at a singularity or near one, and what is lost. Where it says so.
fn warning(ui: &Ui, room: Rect, bench: &Bench) -> Option<Rect> {
    let mobility = bench.mobility();
    let palette = Palette::in_ui(ui);
    let (word, color) = match mobility.singularity {
        Singularity::Far => return None,
        Singularity::Near => ("Near a singularity: hard", palette.warning),
        Singularity::At => ("Singular: it cannot", palette.error),
    };
    let verb = match (mobility.singularity, mobility.hardest) {
        (_, None) => return None,
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
    Some(card)
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
