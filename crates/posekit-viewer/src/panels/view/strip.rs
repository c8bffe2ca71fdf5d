//! What lies over the view while poses are edited: the gizmo's choices at the top, a hint at the bottom.

use egui::{Align, Layout, Rect, Ui, UiBuilder, pos2, vec2};

use super::super::{Asked, row, tip};
use super::Below;
use crate::command::Command;
use crate::gizmo::Tool;
use crate::state::mode::{Mode, Space, TURN_STEP_DEG, move_step};
use crate::state::session::{Handles, Session};
use crate::theme::Palette;

/// Shows both. Where the room below the tools begins.
pub(super) fn show(
    ui: &mut Ui,
    (rect, below): (Rect, Below),
    session: &mut Session,
    asked: &mut Asked,
) -> f32 {
    if !session.mode().edits() || session.active_clip().is_none() {
        return rect.top();
    }
    let room = Rect::from_min_max(rect.min + vec2(10.0, 10.0), rect.max - vec2(10.0, 10.0));
    if room.width() < 120.0 || room.height() < 80.0 {
        return rect.top();
    }
    let builder = UiBuilder::new()
        .max_rect(room)
        .layout(Layout::left_to_right(Align::Min));
    let above = ui.scope_builder(builder, |ui| tools(ui, session, asked));
    hint(ui, room, &text(session, below));
    above.inner.bottom()
}

/// Shows the tools. Where they are.
fn tools(ui: &mut Ui, session: &mut Session, asked: &mut Asked) -> Rect {
    let palette = Palette::in_ui(ui);
    let card = egui::Frame::NONE
        .fill(palette.raised.gamma_multiply(0.94))
        .stroke(egui::Stroke::new(1.0, palette.line))
        .corner_radius(9.0)
        .inner_margin(egui::Margin::same(3));
    let shown = card.show(ui, |ui| {
        type Context<'a> = (&'a mut Session, &'a mut Asked);
        let groups: [row::Group<Context<'_>>; 4] = [
            |ui, _, (session, asked)| {
                let (undo, redo) = session.step_names();
                row::undo_buttons(ui, (undo.into(), redo.into()), 26.0, asked);
            },
            |ui, room, (session, asked)| tool_choice(ui, room, session, asked),
            |ui, _, (session, _)| spaces(ui, session),
            |ui, _, (session, asked)| snap(ui, session, asked),
        ];
        row::lines(ui, &mut (session, asked), &groups);
    });
    shown.response.rect
}

/// Arrows or rings; on a target, arrows alone or both.
fn tool_choice(ui: &mut Ui, room: f32, session: &Session, asked: &mut Asked) {
    let tools = session.tools();
    let (chosen, options) = match session.handles() {
        Handles::Targets => {
            let chosen = match tools.ik_tool {
                Tool::Move => Tool::Move,
                Tool::Turn | Tool::MoveAndTurn => Tool::Turn,
            };
            let options = [
                (
                    Tool::Move,
                    "Place",
                    "Bring it to a place; G moves it with the pointer",
                ),
                (
                    Tool::Turn,
                    "Place and turn",
                    "Bring it to a place, turned in a certain way; R turns it with the pointer",
                ),
            ];
            (chosen, options)
        }
        Handles::None | Handles::Joints => {
            let options = [
                (
                    Tool::Move,
                    "Move",
                    "Arrows: move what the file lets move; G moves it with the pointer",
                ),
                (Tool::Turn, "Turn", "Rings: turn; R turns with the pointer"),
            ];
            (tools.tool, options)
        }
    };
    let options = options.map(|(tool, name, says)| {
        let command = Command::Tool(tool);
        (command, name, tip(says, command))
    });
    row::segments(ui, room, Command::Tool(chosen), &options, asked);
}

fn spaces(ui: &mut Ui, session: &mut Session) {
    let mut tools = session.tools();
    let chosen = tools.space_with(session.handles());
    egui::ComboBox::from_id_salt("space")
        .selected_text(chosen.name())
        .width(72.0)
        .show_ui(ui, |ui| {
            for space in Space::ALL {
                ui.selectable_value(chosen, space, space.name());
            }
        })
        .response
        .on_hover_text(tip("How the gizmo's axes lie", Command::NextSpace));
    session.set_tools(tools);
}

fn snap(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let step = move_step(session.stage().stature());
    let digits = usize::from(step < 1.0) + usize::from(step < 0.1) + usize::from(step < 0.01);
    let text = format!("{TURN_STEP_DEG}\u{b0}, {step:.digits$}");
    let says = tip("Go in steps; Ctrl does the other", Command::ToggleSnap);
    let button = egui::Button::selectable(session.tools().snaps, format!("Snap {text}"));
    if ui.add(button).on_hover_text(says).clicked() {
        asked.command(Command::ToggleSnap);
    }
}

/// What the pointer does, and why nothing can be done where that is so.
fn hint(ui: &Ui, room: Rect, text: &str) {
    let palette = Palette::in_ui(ui);
    if text.is_empty() {
        return;
    }
    let font = egui::TextStyle::Small.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(text.to_owned(), font, palette.quiet);
    let size = galley.size() + vec2(20.0, 8.0);
    if size.x > room.width() {
        return;
    }
    let at = pos2(room.center().x - size.x / 2.0, room.bottom() - size.y);
    let pill = Rect::from_min_size(at, size);
    let fill = palette.raised.gamma_multiply(0.9);
    ui.painter().rect_filled(pill, size.y / 2.0, fill);
    ui.painter()
        .galley(at + vec2(10.0, 4.0), galley, palette.quiet);
}

fn text(session: &Session, below: Below) -> String {
    if session.is_in_hand() {
        return "Click or Enter: keep  \u{b7}  X, Y, Z: one axis  \u{b7}  Ctrl: in steps  \u{b7}  Esc: give up"
            .to_owned();
    }
    if session.is_dragging() {
        return "Ctrl: in steps  \u{b7}  Esc: let go".to_owned();
    }
    let clip = session.active_clip();
    if clip.is_some_and(|clip| clip.frame_count() == 0) {
        return "This clip has no frames to edit".to_owned();
    }
    if session.mode() == Mode::Animate && session.authored().is_none() {
        return match below {
            Below::Mode => "Choose below how this clip is animated".to_owned(),
            Below::Side => "Close the side to choose how this clip is animated".to_owned(),
        };
    }
    if session.has_pending_pose() {
        return "I: key this pose  \u{b7}  Alt+R: give it up".to_owned();
    }
    if !session.can_edit() {
        return tip(
            "The rest pose is shown; the motion can be edited",
            Command::ToggleRest,
        );
    }
    if session.stepper().is_some() {
        return "PageDown: next update  \u{b7}  PageUp: back  \u{b7}  Esc: end".to_owned();
    }
    let is_fixed = session.selected().is_some() && session.gizmo().is_none();
    if is_fixed {
        return "The file gives this joint no channels to turn or move".to_owned();
    }
    let hint = match session.handles() {
        Handles::Targets => Mode::Ik.hint(),
        Handles::None | Handles::Joints => session.mode().hint(),
    };
    hint.to_owned()
}
