//! Whole poses put onto the active figure: held while they are looked at, then keyed or edited in.

use std::sync::Arc;

use posekit::pose::LocalPose;

use super::Session;

impl Session {
    /// Whether a pose can be put onto the active figure now.
    #[must_use]
    pub fn can_pose(&self) -> bool {
        self.can_edit() && self.mode().edits()
    }

    /// Shows the active figure in a pose that is in no clip yet.
    pub fn preview_pose(&mut self, pose: LocalPose) {
        let fits = |count: usize| count == pose.joint_count();
        if self
            .active_clip()
            .is_some_and(|clip| fits(clip.skeleton().joint_count()))
        {
            self.transport.pause();
            self.hold(Some(Arc::new(pose)));
        }
    }

    /// Returns the figure to the pose it had before it was shown in another.
    pub fn drop_preview(&mut self) {
        self.hold(None);
    }

    /// Puts a pose into the active clip at the time shown, as one step: in an authored clip as keys of
    /// what it changes, or as a pose to be keyed.
    pub fn apply_pose(&mut self, name: &str, pose: LocalPose) {
        let fits = |count: usize| count == pose.joint_count();
        let has_room = self
            .active_clip()
            .is_some_and(|clip| fits(clip.skeleton().joint_count()));
        if has_room && self.can_pose() {
            self.transport.pause();
            self.hold(None);
            self.put_pose(name, pose);
        }
    }
}
