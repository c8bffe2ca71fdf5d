//! The bar at the top: what is open, how it is drawn, what can be taken away.

use egui::containers::menu::MenuButton;
use egui::{Align, Button, Layout, RichText, Ui};
use posekit_render::camera::View;

use super::sides::Sides;
use super::{Asked, row, stay_open, tip};
use crate::command::{Command, is_mac, shortcut_of};
use crate::icons::{Icon, icon_button, toggle_icon};
use crate::state::display::{
    Compare, Display, FollowMode, Look, PoseShown, Style, TRAIL_SECS_RANGE,
};
use crate::state::mode::Mode;
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// The bar has the program's name in it where at least this much is left.
const NAME_ROOM: f32 = 1000.0;

/// All modes stand beside each other where at least this much is left.
const MODES_ROOM: f32 = 860.0;

/// The menus stand beside each other where at least this much is left.
const MENUS_ROOM: f32 = 560.0;

/// Shows the bar.
pub fn show(ui: &mut Ui, session: &mut Session, sides: Sides, asked: &mut Asked) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let room = ui.available_width();
        let left = tip("Clips and joints", Command::ToggleLeft);
        if toggle_icon(ui, Icon::SideLeft, &left, sides.left).clicked() {
            asked.command(Command::ToggleLeft);
        }
        if room >= NAME_ROOM {
            ui.add_space(GAP);
            ui.label(RichText::new("posekit").strong().size(15.0));
            ui.add_space(2.0 * GAP);
        }
        if room >= MENUS_ROOM {
            menus(ui, session, asked);
        } else {
            // On a phone one menu holds them all.
            let button = Button::new("Menu").frame_when_inactive(false);
            stay_open(MenuButton::from_button(button)).ui(ui, |ui| {
                ui.set_width(180.0);
                menus(ui, session, asked);
            });
        }
        if room >= MODES_ROOM {
            ui.add_space(3.0 * GAP);
            modes(ui, session, asked);
        } else {
            mode_choice(ui, session, asked);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            right_buttons(ui, session, sides, asked);
        });
    });
}

fn menus(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    file_menu(ui, session, asked);
    view_menu(ui, session, asked);
    if !session.mode().is_lab() {
        style_choice(ui, session);
        figure_menu(ui, session, asked);
        rest_button(ui, session, asked);
    }
}

/// What the window is for: one of several, beside each other.
fn modes(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let options = Mode::ALL.map(|mode| {
        let command = Command::Mode(mode);
        (command, mode.name(), tip(mode.says(), command))
    });
    row::segments(
        ui,
        f32::INFINITY,
        Command::Mode(session.mode()),
        &options,
        asked,
    );
}

/// The same as a menu, where there is less room.
fn mode_choice(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let name = session.mode().name();
    let button = Button::new(RichText::new(name).color(Palette::in_ui(ui).accent));
    let (response, _) = MenuButton::from_button(button).ui(ui, |ui| {
        ui.set_width(200.0);
        for mode in Mode::ALL {
            let chosen = session.mode() == mode;
            let keys = shortcut_of(Command::Mode(mode), is_mac()).unwrap_or_default();
            let quiet = Palette::in_ui(ui).quiet;
            let button = Button::selectable(chosen, mode.name())
                .shortcut_text(RichText::new(keys).small().color(quiet));
            if ui.add(button).on_hover_text(mode.says()).clicked() {
                asked.command(Command::Mode(mode));
                ui.close();
            }
        }
    });
    response.on_hover_text("What the window is for");
}

fn right_buttons(ui: &mut Ui, session: &Session, sides: Sides, asked: &mut Asked) {
    let right = tip("Inspector", Command::ToggleRight);
    if toggle_icon(ui, Icon::SideRight, &right, sides.right).clicked() {
        asked.command(Command::ToggleRight);
    }
    if icon_button(ui, Icon::Help, &tip("All keys", Command::ToggleHelp)).clicked() {
        asked.command(Command::ToggleHelp);
    }
    let (icon, says) = match session.look() {
        Look::Light => (Icon::Moon, "Dark"),
        Look::Dark => (Icon::Sun, "Light"),
    };
    if icon_button(ui, icon, &tip(says, Command::ToggleLook)).clicked() {
        asked.command(Command::ToggleLook);
    }
}

fn menu(ui: &mut Ui, text: &str, contents: impl FnOnce(&mut Ui)) {
    stay_open(MenuButton::from_button(
        Button::new(text).frame_when_inactive(false),
    ))
    .ui(ui, |ui| {
        ui.set_width(244.0);
        contents(ui);
    });
}

/// A line of a menu with its key.
fn item(ui: &mut Ui, says: &str, command: Command, asked: &mut Asked) {
    let keys = shortcut_of(command, is_mac()).unwrap_or_default();
    let quiet = Palette::in_ui(ui).quiet;
    let keys = RichText::new(keys).small().color(quiet);
    if ui
        .add(
            Button::new(says)
                .frame_when_inactive(false)
                .shortcut_text(keys),
        )
        .clicked()
    {
        asked.command(command);
        ui.close();
    }
}

fn file_menu(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    menu(ui, "File", |ui| {
        item(ui, "Open files\u{2026}", Command::Open, asked);
        if cfg!(not(target_arch = "wasm32")) {
            item(ui, "Open a folder\u{2026}", Command::OpenFolder, asked);
        }
        ui.separator();
        if session.authored().is_some() && !session.mode().is_lab() {
            item(ui, "Save the scene", Command::SaveScene, asked);
            item(ui, "Save the scene as\u{2026}", Command::SaveSceneAs, asked);
        }
        item(
            ui,
            "Save the range as BVH\u{2026}",
            Command::SaveRange,
            asked,
        );
        item(ui, "Export a video\u{2026}", Command::ExportVideo, asked);
        ui.separator();
        item(ui, "Copy the picture", Command::CopyPicture, asked);
        item(ui, "Save the picture\u{2026}", Command::SavePicture, asked);
        ui.separator();
        item(ui, "Messages\u{2026}", Command::ShowMessages, asked);
        #[cfg(not(target_arch = "wasm32"))]
        dialog_choice(ui, asked);
    });
}

/// Whether files are asked for by the system, or by the window's own chooser.
#[cfg(not(target_arch = "wasm32"))]
fn dialog_choice(ui: &mut Ui, asked: &mut Asked) {
    let mut in_window = asked.asks_in_window;
    let says = "Ask for files by posekit's own chooser instead of the system's dialogs";
    let check = ui.checkbox(&mut in_window, "Choose files in this window");
    if check.on_hover_text(says).changed() {
        asked.requests.push(super::Request::AskInWindow(in_window));
    }
}

fn view_menu(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    menu(ui, "Camera", |ui| {
        for (says, view) in [
            ("Three-quarter", View::ThreeQuarter),
            ("Front", View::Front),
            ("Back", View::Back),
            ("Right side", View::Right),
            ("Left side", View::Left),
            ("Top", View::Top),
        ] {
            item(ui, says, Command::Look(view), asked);
        }
        ui.separator();
        item(ui, "Frame everything", Command::FrameAll, asked);
        item(
            ui,
            "Frame the selected joint",
            Command::FrameSelected,
            asked,
        );
        let parallel = session.camera.is_orthographic();
        let says = if session.mode().is_lab() {
            "Perspective or parallel rays"
        } else if parallel {
            "Perspective"
        } else {
            "Parallel rays"
        };
        item(ui, says, Command::ToggleProjection, asked);
        if session.mode().is_lab() {
            return;
        }
        ui.separator();
        let mut display = session.display().clone();
        choice(
            ui,
            "Follow the figure",
            &mut display.follow,
            &[
                (FollowMode::Auto, "When it goes far"),
                (FollowMode::On, "Always"),
                (FollowMode::Off, "Never"),
            ],
        );
        choice(
            ui,
            "Several figures",
            &mut display.compare,
            &[
                (Compare::SideBySide, "Side by side"),
                (Compare::Overlaid, "Overlaid"),
            ],
        );
        session.set_display(display);
    });
}

/// A heading and one of several.
fn choice<T: PartialEq + Copy>(ui: &mut Ui, says: &str, value: &mut T, options: &[(T, &str)]) {
    let quiet = Palette::in_ui(ui).quiet;
    ui.label(RichText::new(says).small().color(quiet));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for &(option, name) in options {
            ui.selectable_value(value, option, name);
        }
    });
}

fn style_choice(ui: &mut Ui, session: &mut Session) {
    let mut display = session.display().clone();
    let shown = format!("Style: {}", display.style.name());
    let button = Button::new(shown).frame_when_inactive(false);
    let (response, _) = stay_open(MenuButton::from_button(button)).ui(ui, |ui| {
        ui.set_width(140.0);
        for style in Style::ALL {
            if ui
                .selectable_label(display.style == style, style.name())
                .clicked()
            {
                display.style = style;
                ui.close();
            }
        }
    });
    response.on_hover_text(tip("How the figure is drawn", Command::NextStyle));
    session.set_display(display);
}

fn figure_menu(ui: &mut Ui, session: &mut Session, asked: &mut Asked) {
    let mut display = session.display().clone();
    menu(ui, "Show", |ui| {
        check(
            ui,
            &mut display.labels,
            "Names of joints",
            Command::ToggleLabels,
        );
        check(ui, &mut display.axes, "Axes of joints", Command::ToggleAxes);
        ui.separator();
        trails_and_ghosts(ui, &mut display, session.mode());
        ui.separator();
        item(ui, "Rest pose", Command::ToggleRest, asked);
    });
    session.set_display(display);
}

fn trails_and_ghosts(ui: &mut Ui, display: &mut Display, mode: Mode) {
    check(
        ui,
        &mut display.trails,
        "Motion trails",
        Command::ToggleTrails,
    );
    ui.add_enabled_ui(display.trails, |ui| {
        let slider = egui::Slider::new(&mut display.trail_secs, TRAIL_SECS_RANGE);
        ui.add(slider.suffix(" s").fixed_decimals(1).text("length"))
            .on_hover_text("The paths of the selected joints, or of hands, feet and head");
    });
    check(ui, &mut display.ghosts, "Ghosts", Command::ToggleGhosts);
    ui.add_enabled_ui(display.ghosts, |ui| {
        if mode == Mode::Animate {
            ui.checkbox(&mut display.ghosts_at_keys, "At keys")
                .on_hover_text("Poses of the keys before and after, green and purple: of the selected joints, or of all");
            if display.ghosts_at_keys {
                ui.add(egui::Slider::new(&mut display.ghost_keys, 1..=8).text("keys each way"));
                return;
            }
        }
        let slider = egui::Slider::new(&mut display.ghost_every_frames, 1..=120);
        ui.add(slider.logarithmic(true).text("frames apart"))
            .on_hover_text("Earlier and later poses, shown faintly");
    });
}

fn check(ui: &mut Ui, value: &mut bool, says: &str, command: Command) {
    let keys = shortcut_of(command, is_mac()).unwrap_or_default();
    ui.horizontal(|ui| {
        ui.checkbox(value, says);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(keys).small().color(Palette::in_ui(ui).quiet));
        });
    });
}

/// Says that the rest pose is shown, which otherwise looks like a clip that does not move.
fn rest_button(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    if session.pose_shown() == PoseShown::Rest {
        let text = RichText::new("Rest pose").color(Palette::in_ui(ui).accent);
        if ui
            .add(Button::new(text))
            .on_hover_text(tip("Back to the motion", Command::ToggleRest))
            .clicked()
        {
            asked.command(Command::ToggleRest);
        }
    }
}
