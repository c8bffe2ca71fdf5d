//! What is asked of the graph editor by keys and menus.

use egui::{Event, InputState, Key, Ui};

use super::GraphPanel;
use super::plane::Plane;
use super::pointer::{Lock, Pointing};
use crate::command::KeysCommand;
use crate::panels::timeline::axis::TimeView;
use crate::state::session::Session;

impl GraphPanel {
    /// Asks for something, which is done when the graph is shown next. False for what is not the
    /// graph's to do.
    pub fn run(&mut self, command: KeysCommand) -> bool {
        let is_own = matches!(
            command,
            KeysCommand::Move
                | KeysCommand::Scale
                | KeysCommand::SelectAll
                | KeysCommand::ViewAll
                | KeysCommand::ViewSelected
        );
        // A box is drawn here by dragging, and copies are made in the dope sheet.
        let is_nothing = matches!(command, KeysCommand::BoxSelect | KeysCommand::Duplicate);
        if is_own {
            self.asked.push(command);
        }
        is_own || is_nothing
    }

    /// Whether something follows the pointer, so that Esc and clicks are about that.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.pointing.is_some_and(|pointing| pointing.holds())
    }

    /// Takes the keys that say along which axis dots are moved: X for time, Y for values.
    pub fn take_lock_keys(&mut self, input: &mut InputState) {
        input.events.retain(|event| {
            let Event::Key {
                key, pressed: true, ..
            } = event
            else {
                return true;
            };
            let lock = match key {
                Key::X => Lock::Time,
                Key::Y => Lock::Value,
                _ => return true,
            };
            if let Some(pointing) = &mut self.pointing {
                pointing.toggle(lock);
            }
            false
        });
    }

    /// Lets what follows the pointer be where it is.
    pub fn confirm(&mut self) {
        self.drop_held();
    }

    /// Gives up what follows the pointer: everything is as it was.
    pub fn cancel(&mut self, session: &mut Session) {
        self.graph.give_up(session);
        self.pointing = None;
        self.menu = None;
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
    let held = match command {
        KeysCommand::Move => panel.graph.take_dots(session),
        KeysCommand::Scale => panel.graph.take_to_scale(session),
        KeysCommand::ViewAll => {
            panel.view_all(time, &plane.axis, session.scene_secs());
            false
        }
        KeysCommand::ViewSelected => {
            panel.view_selected(time, &plane.axis, session.scene_secs());
            false
        }
        KeysCommand::SelectAll => {
            let dots = panel.graph.dots().collect();
            panel.graph.select(session, dots);
            false
        }
        _ => false,
    };
    if held {
        panel.pointing = Some(Pointing::modal(&panel.graph, plane, from));
    }
}
