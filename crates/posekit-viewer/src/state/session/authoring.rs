//! Authored clips in the session: their scenes, keys of poses, and the motion that follows from them.

use std::collections::BTreeMap;
use std::sync::Arc;

use posekit::keyframe::Interpolation;
use posekit::pose::LocalPose;
use posekit::skeleton::JointId;

use super::{ClipId, Session};
use crate::state::animate::edit::mode::{LOST_TURN, loses_turns};
use crate::state::animate::edit::pose::{changed_joints, keys_of_change, keys_of_pose};
use crate::state::animate::{Authored, edit::Edit};
use crate::state::clip::{Clip, Source};
use crate::state::ik::Goals;
use crate::state::mode::Mode;

/// How poses are keyed in the animation mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnimateSettings {
    /// Whether a changed pose becomes keys at once.
    pub auto_key: bool,
    /// Whether joints are brought to targets instead of turned.
    pub uses_ik: bool,
    /// How new keys go on.
    pub interpolation: Interpolation,
}

impl Default for AnimateSettings {
    fn default() -> Self {
        Self {
            auto_key: false,
            uses_ik: false,
            interpolation: Interpolation::Cubic,
        }
    }
}

/// Which joints get a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyWhat {
    /// Those that are selected, and those that were posed; all where there is none of either.
    Selected,
    /// All.
    Whole,
}

/// What turns the figure under the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handles {
    /// Nothing.
    None,
    /// Rings and arrows on joints.
    Joints,
    /// Targets, which limbs follow.
    Targets,
}

/// A pose that was made and is not keyed yet.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) pose: Arc<LocalPose>,
    time_secs: f64,
}

/// The part of a session that deals with authored clips.
#[derive(Debug, Default)]
pub(super) struct Authoring {
    open: BTreeMap<ClipId, Authored>,
    settings: AnimateSettings,
    pub(super) pending: Option<Pending>,
}

impl Session {
    /// The scene of the active clip, if it is an authored one.
    #[must_use]
    pub fn authored(&self) -> Option<&Authored> {
        self.authored_of(self.active?)
    }

    /// The scene of a clip, if it is an authored one.
    #[must_use]
    pub fn authored_of(&self, id: ClipId) -> Option<&Authored> {
        self.authoring.open.get(&id)
    }

    /// Works on the active clip's scene; its motion, and all that is shown of it, follow. `None` where
    /// the clip is not an authored one.
    pub fn author<T>(&mut self, work: impl FnOnce(&mut Authored) -> T) -> Option<T> {
        let id = self.active?;
        self.author_clip(id, work)
    }

    /// Works on a clip's scene, as [`author`](Self::author).
    pub fn author_clip<T>(
        &mut self,
        id: ClipId,
        work: impl FnOnce(&mut Authored) -> T,
    ) -> Option<T> {
        let now = self.transport.time_secs();
        let is_active = self.active == Some(id);
        let authored = self.authoring.open.get_mut(&id)?;
        if is_active {
            let start = authored.scene().range_secs[0];
            authored.set_now(start + now);
        }
        let (revision, start) = (authored.revision(), authored.scene().range_secs[0]);
        let done = work(authored);
        let moved_secs = start - authored.scene().range_secs[0];
        if authored.revision() != revision {
            self.rebake(id, moved_secs);
            if is_active {
                self.surround();
            }
        }
        Some(done)
    }

    /// Makes a clip an authored one, shown as its scene says. Its edits of single poses are dropped: they are
    /// in the scene by now, or were discarded by the caller.
    pub fn put_authored(&mut self, id: ClipId, authored: Authored) {
        let Some(index) = self.index_of(id) else {
            return;
        };
        self.forget_edits(id);
        if loses_turns(authored.scene()) {
            self.tell(LOST_TURN);
        }
        let path = authored.path().map(ToOwned::to_owned);
        let motion = Arc::new(authored.bake());
        let old = &self.clips[index].clip;
        let same_joints = old.skeleton().joint_count() == motion.skeleton().joint_count();
        let mut clip = Clip::clone(old);
        clip.source = Source::Scene(path);
        clip.set_motion(motion, |joint| authored.order_of(joint));
        self.authoring.open.insert(id, authored);
        self.clips[index].clip = Arc::new(clip);
        self.clips[index].scaled = None;
        self.remake_actor(index);
        if self.active == Some(id) {
            self.reload_time_line();
            if !same_joints {
                self.selection.clear();
            }
        }
        self.editing.changed.insert(id);
        self.set_stage();
    }

    /// Renames a clip, as when it gets a file of its own.
    pub fn rename(&mut self, id: ClipId, name: String, source: Source) {
        if let Some(index) = self.index_of(id) {
            let clip = Arc::make_mut(&mut self.clips[index].clip);
            clip.name = name;
            clip.source = source;
        }
    }

    pub(super) fn forget_authored(&mut self, id: ClipId) {
        self.authoring.open.remove(&id);
        if self.active == Some(id) {
            self.authoring.pending = None;
            self.forget_things();
        }
    }

    /// The clip's motion anew, after its scene has changed.
    fn rebake(&mut self, id: ClipId, moved_secs: f64) {
        let (Some(authored), Some(index)) = (self.authoring.open.get(&id), self.index_of(id))
        else {
            return;
        };
        let motion = Arc::new(authored.bake());
        let before = &self.clips[index].clip.motion;
        let same_time = before.frame_count() == motion.frame_count()
            && (before.frame_time_secs() - motion.frame_time_secs()).abs() < f64::EPSILON;
        Arc::make_mut(&mut self.clips[index].clip)
            .set_motion(Arc::clone(&motion), |joint| authored.order_of(joint));
        self.clips[index].scaled = None;
        self.clips[index].actor = self.clips[index].actor.with_motion(Arc::clone(&motion));
        self.editing.changed.insert(id);
        if self.active == Some(id) {
            self.authoring.pending = None;
            self.editing.live = None;
        }
        if same_time {
            let actor = self.shown().position(|open| open.id == id);
            if let Some(actor) = actor {
                self.stage
                    .edit_actor(actor, |actor| *actor = actor.with_motion(motion));
                self.stage_version += 1;
            }
            return;
        }
        if self.active == Some(id) {
            let time = self.transport.time_secs() + moved_secs;
            self.reload_time_line();
            self.transport.set_time_secs(time);
        }
        self.set_stage();
    }

    /// How poses are keyed.
    #[must_use]
    pub fn animate(&self) -> AnimateSettings {
        self.authoring.settings
    }

    /// Changes how poses are keyed.
    pub fn set_animate(&mut self, settings: AnimateSettings) {
        if settings.uses_ik != self.authoring.settings.uses_ik {
            self.stop_editing();
        }
        self.authoring.settings = settings;
    }

    /// What turns the figure under the pointer.
    #[must_use]
    pub fn handles(&self) -> Handles {
        match self.mode() {
            Mode::View | Mode::Lab | Mode::Interpolation => Handles::None,
            Mode::Animate if self.authored().is_none() => Handles::None,
            Mode::Animate if self.authoring.settings.uses_ik => Handles::Targets,
            Mode::Pose | Mode::Animate => Handles::Joints,
            Mode::Ik => Handles::Targets,
        }
    }

    /// The time shown, in seconds of the active clip's scene.
    #[must_use]
    pub fn scene_secs(&self) -> f64 {
        let start = self
            .authored()
            .map_or(0.0, |authored| authored.scene().range_secs[0]);
        start + self.transport.time_secs()
    }

    /// Shows a time of the active clip's scene, as far as it is in its range.
    pub fn go_to_scene_secs(&mut self, time_secs: f64) {
        let start = self
            .authored()
            .map_or(0.0, |authored| authored.scene().range_secs[0]);
        self.transport.pause();
        self.transport.set_time_secs(time_secs - start);
    }

    /// Whether a pose was made that is not keyed, or something around was set so.
    #[must_use]
    pub fn has_pending_pose(&self) -> bool {
        self.authoring.pending.is_some() || self.has_pending_values()
    }

    /// The pose that was made and is not keyed, while its time is shown.
    pub(super) fn pending_pose(&self) -> Option<&Arc<LocalPose>> {
        self.authoring.pending.as_ref().map(|pending| &pending.pose)
    }

    /// A pose was made in an authored clip: it becomes keys on what it has changed, or is held until
    /// it is keyed.
    pub(super) fn put_authored_pose(&mut self, name: &str, pose: LocalPose, goals: Option<Goals>) {
        let settings = self.authoring.settings;
        if !settings.auto_key {
            let time_secs = self.transport.time_secs();
            self.authoring.pending = Some(Pending {
                pose: Arc::new(pose),
                time_secs,
            });
            self.hold(None);
            if let Some(goals) = goals {
                self.author(|authored| authored.choose_goals(goals));
            }
            return;
        }
        let time_secs = self.key_time();
        let before = self.unposed();
        self.author(|authored| {
            let before = before.unwrap_or_else(|| authored.pose_at(time_secs));
            let poses = (&before, &pose);
            let edit = keys_of_change(authored, poses, time_secs, settings.interpolation);
            if let Some(Edit { changes, selection }) = edit {
                authored.set_tracks(name, None, changes, selection);
            }
            if let Some(goals) = goals {
                authored.choose_goals(goals);
            }
        });
        // Where nothing changed there was no new bake either.
        self.hold(None);
    }

    /// The pose at the time shown, as the motion has it.
    fn unposed(&self) -> Option<LocalPose> {
        let clip = self.active_clip()?;
        Some(clip.local_pose(self.transport.time_secs()))
    }

    /// Where a key is set now, in seconds of the scene.
    pub(super) fn key_time(&self) -> f64 {
        let now = self.scene_secs();
        self.authored()
            .map_or(now, |authored| authored.snapped(now))
    }

    /// Sets keys of the pose that is shown, at the time shown, or of the camera, light or prop that is
    /// picked. How many joints or properties got one.
    pub fn insert_keys(&mut self, what: KeyWhat) -> usize {
        if self.authored().is_none() {
            return 0;
        }
        self.transport.pause();
        if what == KeyWhat::Selected
            && let Some(count) = self.key_picked()
        {
            return count;
        }
        let (Some(pose), Some(before)) = (self.shown_local_pose(), self.unposed()) else {
            return 0;
        };
        let Some(authored) = self.authored() else {
            return 0;
        };
        let all = || authored.skeleton().joints().collect::<Vec<JointId>>();
        let mut joints = match what {
            KeyWhat::Whole => all(),
            KeyWhat::Selected => {
                let mut joints = self.selection.clone();
                joints.extend(changed_joints(authored, &before, &pose));
                joints
            }
        };
        if joints.is_empty() {
            joints = all();
        }
        joints.sort_unstable();
        joints.dedup();
        let name = match joints.as_slice() {
            [joint] => format!("Key {}", authored.skeleton().unique_name(*joint)),
            joints => format!("Key {} joints", joints.len()),
        };
        let time_secs = self.key_time();
        let interpolation = self.authoring.settings.interpolation;
        self.author(|authored| {
            let edit = keys_of_pose(authored, &joints, &pose, time_secs, interpolation);
            if let Some(Edit { changes, selection }) = edit {
                authored.set_tracks(&name, None, changes, selection);
            }
        });
        // It is keyed: what was asked of limbs stays asked.
        self.authoring.pending = None;
        self.hold(None);
        joints.len()
    }

    /// Gives a pose up that is not keyed. True when there was one.
    pub fn drop_pending(&mut self) -> bool {
        let was_set = self.drop_pending_values();
        let was_pending = self.authoring.pending.take().is_some();
        if was_pending {
            // Nor is a limb still asked to be where it was in it.
            let mut goals = self.goals();
            if goals.target.take().is_some() {
                self.author(|authored| authored.choose_goals(goals));
            }
            self.hold(None);
        }
        was_pending || was_set
    }

    /// A pose that is not keyed is gone when another time is shown.
    pub(super) fn follow_time(&mut self) {
        self.follow_time_of_values();
        let now = self.transport.time_secs();
        let is_old = |pending: &Pending| (pending.time_secs - now).abs() > 1e-9;
        if self.authoring.pending.as_ref().is_some_and(is_old) {
            self.drop_pending();
        }
    }
}
