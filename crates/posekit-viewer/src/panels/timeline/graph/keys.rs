//! What is asked of the graph editor by keys and menus.

use egui::{Event, InputState, Key, Ui};

use super::GraphPanel;
use super::menus::{Menu, MenuKind};
use super::plane::Plane;
use super::pointer::{Lock, Pointing};
use crate::command::KeysCommand;
use crate::panels::timeline::axis::TimeView;
use crate::state::session::Session;

/// What a key does to what is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeldKey {
    Lock(Lock),
    Confirm,
    Cancel,
}

impl GraphPanel {
    /// Asks for something, which is done when the graph is shown next. False for what is not the
    /// graph's to do.
    pub fn run(&mut self, command: KeysCommand) -> bool {
        let is_own = matches!(
            command,
            KeysCommand::Move
                | KeysCommand::Scale
                | KeysCommand::SelectAll
                | KeysCommand::SelectNone
                | KeysCommand::Delete
                | KeysCommand::Interpolation
                | KeysCommand::Tangents
                | KeysCommand::ViewAll
                | KeysCommand::ViewSelected
        );
        if is_own {
            self.asked.push(command);
        }
        is_own
    }

    /// Whether something follows the pointer, so that Esc and clicks are about that.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.pointing.is_some_and(|pointing| pointing.holds())
    }

    /// Takes the keys that are about what is held: X and Y for the axis that it moves along, Enter, Esc.
    pub fn take_held_keys(&mut self, input: &mut InputState) {
        input.events.retain(|event| {
            let Event::Key {
                key, pressed: true, ..
            } = event
            else {
                return true;
            };
            let asked = match key {
                Key::X => HeldKey::Lock(Lock::Time),
                Key::Y => HeldKey::Lock(Lock::Value),
                Key::Enter => HeldKey::Confirm,
                Key::Escape => HeldKey::Cancel,
                _ => return true,
            };
            self.held_keys.push(asked);
            false
        });
    }

    /// Does what keys have asked of what is held.
    pub(super) fn run_held_keys(&mut self, session: &mut Session) {
        for key in std::mem::take(&mut self.held_keys) {
            match key {
                HeldKey::Lock(lock) => self.lock(lock),
                HeldKey::Confirm => self.drop_held(),
                HeldKey::Cancel => self.give_up(session),
            }
        }
    }
}

/// Does what a command asks.
pub(super) fn run(
    ui: &Ui,
    command: KeysCommand,
    session: &mut Session,
    panel: &mut GraphPanel,
    time: &mut TimeView,
    plane: &Plane,
) {
    let pointer = ui.input(|i| i.pointer.latest_pos());
    let from = pointer.unwrap_or(plane.rect.center());
    match command {
        KeysCommand::Move => {
            if panel.graph.take_dots(session) {
                panel.pointing = Some(Pointing::modal(&panel.graph, plane, from));
            }
        }
        KeysCommand::Scale => {
            if panel.graph.take_to_scale(session) {
                panel.pointing = Some(Pointing::modal(&panel.graph, plane, from));
            }
        }
        KeysCommand::Delete => panel.graph.delete(session),
        KeysCommand::Interpolation => panel.menu = Some(Menu::at(MenuKind::Interpolation, from)),
        KeysCommand::Tangents => panel.menu = Some(Menu::at(MenuKind::Tangents, from)),
        KeysCommand::ViewAll => panel.view_all(time, &plane.axis),
        KeysCommand::ViewSelected => panel.view_selected(time, &plane.axis),
        KeysCommand::SelectAll => {
            let dots = panel.graph.dots().collect();
            panel.graph.select(session, dots);
        }
        KeysCommand::SelectNone => panel.graph.select(session, Default::default()),
        _ => {}
    }
}
