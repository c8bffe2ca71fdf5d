//! The keys of the graph editor, while the pointer is over it: Blender's where it has one.

use egui::{Event, InputState, Key, Ui};

use super::GraphPanel;
use super::menus::{Menu, MenuKind};
use super::plane::Plane;
use super::pointer::{Lock, Pointing};
use crate::panels::timeline::axis::TimeAxis;
use crate::state::session::Session;

/// What a key asks of the graph editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphKey {
    /// The selected keys go along with the pointer.
    Move,
    /// The selected keys are scaled with the pointer.
    Scale,
    /// The selected keys are taken away.
    Delete,
    /// How the selected keys go on is chosen.
    Interpolation,
    /// The tangents of the selected keys are chosen.
    Tangents,
    /// Everything into view.
    ViewAll,
    /// What is selected into view.
    ViewSelected,
    /// Everything is selected.
    SelectAll,
    /// Nothing is selected.
    SelectNone,
    /// What is held keeps its values, and is moved in time alone.
    LockTime,
    /// What is held keeps its times.
    LockValue,
    /// What is held stays where it is now.
    Confirm,
    /// What is held goes back to where it was.
    Cancel,
}

impl GraphKey {
    /// The key that was pressed, while something is held and while nothing is.
    fn of(key: Key, modifiers: egui::Modifiers, is_held: bool) -> Option<Self> {
        if is_held {
            return Some(match key {
                Key::X => Self::LockTime,
                Key::Y => Self::LockValue,
                Key::Enter => Self::Confirm,
                Key::Escape => Self::Cancel,
                _ => return None,
            });
        }
        let alt = modifiers.alt && !modifiers.command;
        if modifiers.command || modifiers.shift {
            return None;
        }
        Some(match key {
            Key::A if alt => Self::SelectNone,
            _ if alt => return None,
            Key::G => Self::Move,
            Key::S => Self::Scale,
            Key::X | Key::Delete => Self::Delete,
            Key::T => Self::Interpolation,
            Key::V => Self::Tangents,
            Key::Home => Self::ViewAll,
            Key::Period => Self::ViewSelected,
            Key::A => Self::SelectAll,
            _ => return None,
        })
    }
}

impl GraphPanel {
    /// Takes the keys that are meant for the graph editor: those pressed while the pointer is over it or
    /// while something is held. True when no other keys count at the moment.
    pub fn take_keys(&mut self, input: &mut InputState) -> bool {
        let is_held = self.pointing.as_ref().is_some_and(Pointing::holds);
        if !is_held && !self.has_pointer {
            return false;
        }
        let has_selection = !self.graph.selected().is_empty();
        input.events.retain(|event| {
            let Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } = event
            else {
                return true;
            };
            let mut asked = GraphKey::of(*key, *modifiers, is_held);
            if !is_held && *key == Key::Escape && has_selection {
                asked = Some(GraphKey::SelectNone);
            }
            self.pressed.extend(asked);
            asked.is_none()
        });
        is_held
    }
}

/// Does what a key asks.
pub(super) fn run(
    ui: &Ui,
    key: GraphKey,
    session: &mut Session,
    panel: &mut GraphPanel,
    axis: &mut TimeAxis,
    plane: &Plane,
) {
    let pointer = ui.input(|i| i.pointer.latest_pos());
    let width = plane.rect.width();
    match key {
        GraphKey::Move => {
            if let Some(pointer) = pointer
                && panel.graph.take_dots(session)
            {
                panel.pointing = Some(Pointing::modal(&panel.graph, plane, pointer));
            }
        }
        GraphKey::Scale => {
            if let Some(pointer) = pointer
                && panel.graph.take_to_scale(session)
            {
                panel.pointing = Some(Pointing::modal(&panel.graph, plane, pointer));
            }
        }
        GraphKey::Delete => panel.graph.delete(session),
        GraphKey::Interpolation => panel.menu = Menu::at(MenuKind::Interpolation, pointer),
        GraphKey::Tangents => panel.menu = Menu::at(MenuKind::Tangents, pointer),
        GraphKey::ViewAll => panel.view_all(axis, width),
        GraphKey::ViewSelected => panel.view_selected(axis, width),
        GraphKey::SelectAll => {
            let dots = panel.graph.dots().collect();
            panel.graph.select(session, dots);
        }
        GraphKey::SelectNone => panel.graph.select(session, Default::default()),
        GraphKey::LockTime => panel.lock(Lock::Time),
        GraphKey::LockValue => panel.lock(Lock::Value),
        GraphKey::Confirm => panel.drop_held(),
        GraphKey::Cancel => panel.give_up(session),
    }
}
