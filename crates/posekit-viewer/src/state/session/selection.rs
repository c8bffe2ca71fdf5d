//! What is selected, and going from finding to finding.

use posekit::check::Finding;
use posekit::skeleton::JointId;

use super::Session;

impl Session {
    /// The selected joints of the active clip; the last one is what the inspector shows.
    #[must_use]
    pub fn selection(&self) -> &[JointId] {
        &self.selection
    }

    /// The joint selected last.
    #[must_use]
    pub fn selected(&self) -> Option<JointId> {
        self.selection.last().copied()
    }

    /// Selects one joint alone, or none.
    pub fn select(&mut self, joint: Option<JointId>) {
        self.forget_picked();
        self.selection.clear();
        self.selection.extend(joint);
        self.selection_changed();
    }

    /// Adds a joint to the selection, or takes it out.
    pub fn toggle_selected(&mut self, joint: JointId) {
        self.forget_picked();
        if let Some(index) = self
            .selection
            .iter()
            .position(|&selected| selected == joint)
        {
            self.selection.remove(index);
        } else {
            self.selection.push(joint);
        }
        self.selection_changed();
    }

    /// Selects the parent of the selected joint.
    pub fn select_parent(&mut self) {
        if let (Some(joint), Some(clip)) = (self.selected(), self.active_clip())
            && let Some(parent) = clip.skeleton().parent(joint)
        {
            self.select(Some(parent));
        }
    }

    /// Selects the first child of the selected joint, or the first root.
    pub fn select_child(&mut self) {
        let Some(clip) = self.active_clip() else {
            return;
        };
        let next = match self.selected() {
            Some(joint) => clip.skeleton().children(joint).first().copied(),
            None => clip.skeleton().roots().next(),
        };
        if next.is_some() {
            self.select(next);
        }
    }

    fn selection_changed(&mut self) {
        if self.display.trails {
            self.set_stage();
        }
    }

    /// Goes to the first frame of the finding after (`forward`) or before the frame shown.
    pub fn go_to_finding(&mut self, order: std::cmp::Ordering) {
        let Some(clip) = self.active_clip() else {
            return;
        };
        let here = self.transport.frame();
        let firsts = clip
            .findings
            .iter()
            .filter_map(|f| f.frames.map(|frames| frames.first));
        let beyond = firsts.filter(|frame| frame.cmp(&here) == order);
        let target = match order {
            std::cmp::Ordering::Less => beyond.max(),
            _ => beyond.min(),
        };
        if let Some(frame) = target {
            self.transport.pause();
            self.transport.go_to_frame(frame);
        }
    }

    /// Shows a finding: its first frame, and its joints selected.
    pub fn show_finding(&mut self, finding: &Finding) {
        if let Some(frames) = finding.frames {
            self.transport.pause();
            self.transport.go_to_frame(frames.first);
        }
        if !finding.joints.is_empty() {
            self.selection = finding.joints.iter().copied().take(8).collect();
            self.selection.reverse();
            self.selection_changed();
        }
    }
}
