//! The list of all keys, and of what the mouse does; it is searched by key and by words.

use egui::{Key, Modifiers, RichText, Ui, vec2};

use super::{Asked, row};
use crate::command::{Command, Group, Line, found, lines};
use crate::state::library::matches;
use crate::theme::{GAP, Palette};

/// What the mouse does, and fingers on a screen.
const MOUSE: [(&str, &str); 16] = [
    ("Drag", "Turn"),
    ("Right drag, shift drag", "Move"),
    ("Wheel, pinch", "Zoom"),
    ("Two fingers", "Move and zoom"),
    ("Click a bone", "Select its joint"),
    ("Shift click", "Select several"),
    ("Double click", "Frame it"),
    ("Shift click a clip", "Compare it"),
    ("Drop a file", "Open it"),
    ("Ctrl while dragging", "In steps, or freely"),
    ("Drag a robot's tip", "Its joints follow"),
    ("Drag on the time line", "Go to that time"),
    ("Drag the ends of its bar", "The range"),
    ("Wheel on the timeline", "Zoom in time; with Shift move"),
    ("Drag in the timeline", "Select keys in a box"),
    ("Drag a panel's edge", "Make it wider, or higher"),
];

/// Width of a column of the list.
const COLUMN: f32 = 276.0;

/// Width of the keys in it.
const KEYS: f32 = 118.0;

/// Shows the list in a window of its own. False when it was closed; what a line asks for that was clicked is
/// asked for.
pub fn show(ctx: &egui::Context, search: &mut String, asked: &mut Asked) -> bool {
    let mut open = true;
    let mut clicked = None;
    let screen = ctx.content_rect();
    let margin = if screen.width() < 600.0 { 12 } else { 24 };
    let modal = egui::Modal::new(egui::Id::unique("help"));
    let frame = super::modal_frame(ctx).inner_margin(egui::Margin::same(margin));
    let modal = modal.frame(frame).show(ctx, |ui| {
        let around = 2.0 * f32::from(margin) + 24.0;
        let room = screen.size() - vec2(around, around);
        let columns = columns_in(room.x);
        let count = f32::from(columns);
        ui.set_width(
            room.x
                .min(count * COLUMN + (count - 1.0) * 6.0 * GAP + 12.0),
        );
        ui.horizontal(|ui| {
            ui.heading("Keys and mouse");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if crate::icons::icon_button(ui, crate::icons::Icon::Close, "Close  (Esc)")
                    .clicked()
                {
                    open = false;
                }
            });
        });
        ui.add_space(GAP);
        let field = super::library::search(ui, search, "Search: a key, as Ctrl+S, or words");
        // It is typed into at once; on a screen that is touched that would call the keyboard over the list.
        let nobody_has_keys = ui.memory(|memory| memory.focused().is_none());
        if nobody_has_keys && !ui.input(|i| i.has_touch_screen()) {
            field.request_focus();
        }
        ui.add_space(2.0 * GAP);
        let height = (room.y - 84.0).max(80.0);
        let area = egui::ScrollArea::vertical()
            .auto_shrink([false, true])
            .max_height(height)
            .min_scrolled_height(height);
        area.show(ui, |ui| list(ui, columns, search, &mut clicked));
    });
    let closed_by_key = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::F1));
    if let Some(command) = clicked {
        // The list is closed by that, also where the command is to open it.
        if command != Command::ToggleHelp {
            asked.command(command);
        }
        return false;
    }
    open && !closed_by_key && !modal.should_close()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a number of columns, one to four"
)]
fn columns_in(width: f32) -> u8 {
    (width / (COLUMN + 6.0 * GAP)).floor().clamp(1.0, 4.0) as u8
}

/// A heading and its lines.
struct Block {
    title: &'static str,
    lines: Vec<(String, &'static str, Option<Command>)>,
}

fn blocks(search: &str) -> Vec<Block> {
    let all = lines();
    let found: Vec<Line> = if search.trim().is_empty() {
        all
    } else {
        found(&all, search)
    };
    let of = |group: Group| {
        let lines = found.iter().filter(move |line| line.group == group);
        Block {
            title: group.title(),
            lines: lines
                .map(|line| (line.keys.join(", "), line.says, line.command))
                .collect(),
        }
    };
    let mut blocks: Vec<Block> = Group::ALL.into_iter().map(of).collect();
    let is_found = |(what, does): &&(&str, &str)| matches(search, &format!("mouse {what} {does}"));
    let mouse = MOUSE.iter().filter(is_found);
    blocks.push(Block {
        title: "Mouse and fingers",
        lines: mouse
            .map(|(what, does)| ((*what).to_owned(), *does, None))
            .collect(),
    });
    blocks.retain(|block| !block.lines.is_empty());
    blocks
}

fn list(ui: &mut Ui, columns: u8, search: &str, clicked: &mut Option<Command>) {
    let blocks = blocks(search);
    if blocks.is_empty() {
        row::empty_note(ui, "No key and nothing that keys do is called that.");
        return;
    }
    // Columns of about the same length, in the order of the list.
    let length = |block: &Block| block.lines.len() + 2;
    let whole: usize = blocks.iter().map(length).sum();
    let most = whole.div_ceil(usize::from(columns));
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0 * GAP;
        let mut rest = blocks.as_slice();
        for column in 1..=columns {
            let mut used = 0;
            let mut count = 0;
            for block in rest {
                // The last column takes what is left.
                if column < columns && count > 0 && used + length(block) / 2 > most {
                    break;
                }
                used += length(block);
                count += 1;
            }
            let (here, others) = rest.split_at(count);
            rest = others;
            ui.vertical(|ui| {
                ui.set_width(ui.available_width().min(COLUMN));
                for block in here {
                    show_block(ui, block, clicked);
                }
            });
        }
    });
}

fn show_block(ui: &mut Ui, block: &Block, clicked: &mut Option<Command>) {
    let palette = Palette::in_ui(ui);
    let title = RichText::new(block.title).small().strong();
    ui.label(title.color(palette.quiet));
    for (keys, says, command) in &block.lines {
        let below = ui.painter().add(egui::Shape::Noop);
        let line = ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0 * GAP;
            ui.set_min_height(ui.spacing().interact_size.y - 6.0);
            let text = RichText::new(keys).color(palette.accent);
            let layout = egui::Layout::top_down(egui::Align::Min);
            ui.allocate_ui_with_layout(vec2(KEYS, 18.0), layout, |ui| {
                ui.set_width(KEYS);
                ui.add(egui::Label::new(text).wrap());
            });
            ui.add(egui::Label::new(*says).wrap());
        });
        let Some(command) = *command else { continue };
        let rect = line.response.rect;
        let id = ui.scope_id().with((keys, says));
        let response = ui.interact(rect, id, egui::Sense::click());
        let name = format!("{says}  ({keys})");
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        if response.hovered() || response.has_focus() {
            let fill = egui::Shape::rect_filled(rect.expand(2.0), 4.0, palette.hover);
            ui.painter().set(below, fill);
        }
        if response.on_hover_text("Click: do it").clicked() {
            *clicked = Some(command);
        }
    }
    ui.add_space(3.0 * GAP);
}
