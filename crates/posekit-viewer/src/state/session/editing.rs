//! Editing the active clip: modes, what the gizmo holds, undo and redo.
//!
//! While a handle is dragged the figure is held in a pose that is in no clip yet ([`Session::live_pose`]);
//! letting go puts it into the clip as one step, Esc lets it fall back.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use egui::Pos2;
use glam::{Quat, Vec3};
use posekit::pose::{GlobalPose, LocalPose};
use posekit::skeleton::JointId;

use super::hand::Hand;
use super::{ClipId, Handles, Session};
use crate::gizmo::{Drag, Gizmo, Handle, Placement, Snap, Tool, Viewport};
use crate::state::animate::Authored;
use crate::state::clip::{Clip, nearest_index, rest_motion};
use crate::state::display::PoseShown;
use crate::state::edit::{ClipEdits, Spread, freedom, reachable};
use crate::state::ik::Goals;
use crate::state::mode::{Mode, Space, TURN_STEP_DEG, ToolSettings, move_step};

/// A clip with at least this many frames and no keys counts as a recording.
const CAPTURED_FRAMES: usize = 60;

/// Over how long, on both sides, an edit of a recording fades until something else is chosen.
const CAPTURED_FALLOFF_SECS: f64 = 0.3;

/// And over no more frames than these.
const LONGEST_FALLOFF: usize = 240;

/// What undo or redo has changed, as shown to the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Changed {
    /// The step's name.
    pub name: String,
}

/// The part of a session that deals with editing.
#[derive(Debug, Default)]
pub(super) struct Editing {
    mode: Mode,
    tools: ToolSettings,
    edits: BTreeMap<ClipId, ClipEdits>,
    held: Option<Held>,
    /// What follows the pointer without a button.
    pub(super) hand: Hand,
    /// The pose that the figure is held in while a handle is dragged.
    pub(super) live: Option<Arc<LocalPose>>,
    /// Clips whose motion has changed since that was asked for.
    pub(super) changed: BTreeSet<ClipId>,
}

/// A handle that is held with the pointer.
#[derive(Clone, Debug)]
struct Held {
    drag: Drag,
    joint: JointId,
    /// The pose when it was taken.
    pose: Arc<LocalPose>,
}

/// The name of the undo step for a turned joint.
fn step_name(verb: &str, clip: &Clip, joint: JointId) -> String {
    format!("{verb} {}", clip.skeleton().unique_name(joint))
}

impl Session {
    /// The mode of the window.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.editing.mode
    }

    /// Changes the mode. Poses are edited with the playback stopped, and in the motion, not at rest.
    pub fn set_mode(&mut self, mode: Mode) {
        self.stop_editing();
        self.editing.mode = mode;
        if mode.is_lab() {
            self.transport.pause();
        }
        if mode.edits() {
            self.transport.pause();
            if self.pose_shown == PoseShown::Rest {
                self.set_pose_shown(PoseShown::Motion);
            }
        }
    }

    /// How the gizmo is set.
    #[must_use]
    pub fn tools(&self) -> ToolSettings {
        self.editing.tools
    }

    /// Sets the gizmo.
    pub fn set_tools(&mut self, tools: ToolSettings) {
        self.editing.tools = tools;
    }

    /// The edits of the active clip, once there are any.
    #[must_use]
    pub fn edits(&self) -> Option<&ClipEdits> {
        self.editing.edits.get(&self.active?)
    }

    /// Whether a clip differs from what was opened.
    #[must_use]
    pub fn is_edited(&self, id: ClipId) -> bool {
        if let Some(authored) = self.authored_of(id) {
            return authored.is_dirty();
        }
        let edits = self.editing.edits.get(&id);
        edits.is_some_and(ClipEdits::has_changed_motion)
    }

    /// Whether the active clip is a recording: many frames, none of them a key.
    #[must_use]
    pub fn is_captured(&self) -> bool {
        let frames = self.active_clip().map_or(0, |clip| clip.frame_count());
        self.authored().is_none() && frames >= CAPTURED_FRAMES
    }

    /// How the edit, or the next one, reaches the frames around it.
    #[must_use]
    pub fn spread(&self) -> Spread {
        let edits = self.edits().map(ClipEdits::spread);
        edits.unwrap_or_else(|| self.first_spread())
    }

    /// How edits reach the frames around until something else is chosen: in a recording they fade, since a
    /// frame that is changed alone jumps.
    fn first_spread(&self) -> Spread {
        let Some(clip) = self.active_clip().filter(|_| self.is_captured()) else {
            return Spread::default();
        };
        let frames = CAPTURED_FALLOFF_SECS / clip.motion.frame_time_secs();
        Spread {
            falloff_frames: nearest_index(frames, LONGEST_FALLOFF).max(2),
            ..Spread::default()
        }
    }

    /// The clips whose motion has changed since this was asked last.
    pub fn take_changed(&mut self) -> Vec<ClipId> {
        std::mem::take(&mut self.editing.changed)
            .into_iter()
            .collect()
    }

    /// Whether the active clip can be edited at the frame shown.
    #[must_use]
    pub fn can_edit(&self) -> bool {
        let frames = self.active_clip().map_or(0, |clip| clip.frame_count());
        let is_open = self.mode() != Mode::Animate || self.authored().is_some();
        frames > 0 && is_open && self.pose_shown == PoseShown::Motion
    }

    /// The local pose of the active clip as it is shown: held by a handle, or the motion's.
    #[must_use]
    pub fn shown_local_pose(&self) -> Option<LocalPose> {
        let clip = self.active_clip()?;
        Some(match self.editing.live.as_ref().or(self.pending_pose()) {
            Some(held) => LocalPose::clone(held),
            None => clip.local_pose(self.transport.time_secs()),
        })
    }

    /// The rest pose of the active clip, where its figure stands, while that is shown.
    #[must_use]
    pub fn rest_pose_shown(&self) -> Option<LocalPose> {
        let clip = self.active_clip()?;
        let time = self.transport.time_secs();
        (self.pose_shown == PoseShown::Rest)
            .then(|| rest_motion(&clip.motion, time, Vec3::ZERO).pose(0))
    }

    /// The pose that the figure is held in while a handle is dragged.
    #[must_use]
    pub fn live_pose(&self) -> Option<&LocalPose> {
        self.editing.live.as_deref()
    }

    /// The transform from the motion's space to where the active figure stands.
    #[must_use]
    pub fn active_place(&self) -> Vec3 {
        let index = self.active_actor();
        let place = index.and_then(|index| self.stage.places().get(index));
        place.copied().unwrap_or_default()
    }

    /// Which of the stage's actors is the active clip's.
    pub(super) fn active_actor(&self) -> Option<usize> {
        self.shown().position(|open| Some(open.id) == self.active)
    }

    /// Holds the active figure in a pose, or lets it go back to its motion.
    pub(super) fn hold(&mut self, pose: Option<Arc<LocalPose>>) {
        let Some(clip) = self.active_clip().map(Arc::clone) else {
            return;
        };
        let shown = pose.as_ref().or(self.pending_pose());
        let global = shown.map(|pose| Arc::new(pose.to_global(clip.skeleton())));
        self.editing.live = pose;
        if let Some(index) = self.active_actor() {
            self.stage.edit_actor(index, |actor| actor.hold(global));
            self.stage_version += 1;
        }
    }

    /// Changes the active clip, then shows it.
    pub(super) fn edit_clip<T>(
        &mut self,
        edit: impl FnOnce(&mut ClipEdits, &mut Clip) -> T,
    ) -> Option<T> {
        let id = self.active?;
        let index = self.index_of(id)?;
        let spread = self.first_spread();
        let edits = self.editing.edits.entry(id);
        let edits = edits.or_insert_with(|| ClipEdits::with_spread(spread));
        let motion_before = Arc::clone(&self.clips[index].clip.motion);
        let done = edit(edits, Arc::make_mut(&mut self.clips[index].clip));
        let open = &mut self.clips[index];
        if !Arc::ptr_eq(&motion_before, &open.clip.motion) {
            open.actor = open.actor.with_motion(Arc::clone(&open.clip.motion));
            self.editing.changed.insert(id);
        }
        self.editing.live = None;
        if let Some(actor) = self.active_actor() {
            let motion = Arc::clone(&self.clips[index].clip.motion);
            self.stage
                .edit_actor(actor, |actor| *actor = actor.with_motion(motion));
            self.stage_version += 1;
        }
        Some(done)
    }

    /// Puts a pose into the active clip at the frame shown, as one step.
    pub(super) fn put_pose(&mut self, name: &str, pose: LocalPose) {
        if self.authored().is_some() {
            self.put_authored_pose(name, pose, None);
            return;
        }
        let frame = self.clip_frame();
        self.edit_clip(|edits, clip| {
            let goals = edits.state().goals.clone();
            edits.set_pose(clip, name, frame, pose, goals);
        });
    }

    /// As [`put_pose`](Self::put_pose), and changes target and pins in the same step.
    pub(super) fn put_pose_and_goals(&mut self, name: &str, pose: LocalPose, goals: Goals) {
        if self.authored().is_some() {
            self.put_authored_pose(name, pose, Some(goals));
            return;
        }
        let frame = goals.target.map(|target| target.frame);
        let frame = frame.unwrap_or_else(|| self.clip_frame());
        self.edit_clip(|edits, clip| edits.set_pose(clip, name, frame, pose, goals));
    }

    /// Changes target and pins, as one step.
    pub(super) fn put_goals(&mut self, name: &str, goals: Goals) {
        if self.authored().is_some() {
            self.author(|authored| authored.set_goals(name, goals));
        } else {
            self.edit_clip(|edits, clip| edits.set_goals(clip, name, goals));
        }
    }

    /// The names of what would be undone and redone in the active clip.
    #[must_use]
    pub fn step_names(&self) -> (Option<String>, Option<String>) {
        let (undo, redo) = match (self.authored(), self.edits()) {
            (Some(authored), _) => (authored.undo_name(), authored.redo_name()),
            (None, Some(edits)) => (edits.undo_name(), edits.redo_name()),
            (None, None) => (None, None),
        };
        (undo.map(str::to_owned), redo.map(str::to_owned))
    }

    /// Undoes the last step of the active clip.
    pub fn undo(&mut self) -> Option<Changed> {
        self.stop_editing();
        if self.authored().is_some() {
            self.drop_pending();
            let name = self.author(Authored::undo)??;
            return Some(Changed { name });
        }
        let (name, frame) = self.edit_clip(|edits, clip| edits.undo(clip))??;
        self.go_to_edited(frame);
        Some(Changed { name })
    }

    /// Redoes the step that was undone last.
    pub fn redo(&mut self) -> Option<Changed> {
        self.stop_editing();
        if self.authored().is_some() {
            self.drop_pending();
            let name = self.author(Authored::redo)??;
            return Some(Changed { name });
        }
        let (name, frame) = self.edit_clip(|edits, clip| edits.redo(clip))??;
        self.go_to_edited(frame);
        Some(Changed { name })
    }

    /// Shows what was changed.
    fn go_to_edited(&mut self, frame: Option<usize>) {
        if let Some(frame) = frame
            && frame != self.clip_frame()
        {
            self.transport.pause();
            self.transport.go_to_frame(frame);
        }
    }

    /// Keeps the draft for good.
    pub fn keep_draft(&mut self) {
        if self.authored().is_some() {
            return;
        }
        self.edit_clip(ClipEdits::keep);
    }

    /// Takes the draft back.
    pub fn reset_draft(&mut self) {
        self.stop_editing();
        if self.drop_pending() || self.authored().is_some() {
            return;
        }
        self.edit_clip(ClipEdits::reset);
    }

    /// Changes how the draft reaches the frames around. All that happens in one `gesture` of the
    /// caller's is one step.
    pub fn set_spread(&mut self, spread: Spread, gesture: crate::state::edit::Gesture) {
        self.edit_clip(|edits, clip| edits.set_spread(clip, spread, gesture));
    }

    /// A new gesture on the active clip's edits.
    pub fn new_gesture(&mut self) -> Option<crate::state::edit::Gesture> {
        let id = self.active?;
        let spread = self.first_spread();
        let edits = self.editing.edits.entry(id);
        let edits = edits.or_insert_with(|| ClipEdits::with_spread(spread));
        Some(edits.gesture())
    }

    pub(super) fn forget_edits(&mut self, id: ClipId) {
        self.forget_ranges(id);
        self.editing.edits.remove(&id);
        if self.active == Some(id) {
            self.stop_editing();
        }
    }

    /// The steps that the gizmo goes in.
    #[must_use]
    pub fn snap(&self) -> Snap {
        Snap {
            length: move_step(self.stage.stature()),
            angle_rad: TURN_STEP_DEG.to_radians(),
        }
    }

    /// The gizmo of what is selected, as it stands now.
    #[must_use]
    pub fn gizmo(&self) -> Option<Gizmo> {
        if let Some(held) = &self.editing.held {
            let placement = held.drag.placement();
            return Some(Gizmo {
                position: placement.position,
                ..*held.drag.gizmo()
            });
        }
        if let Some(drag) = self.thing_drag() {
            return Some(Gizmo {
                position: drag.placement().position,
                ..*drag.gizmo()
            });
        }
        if self.picked().is_some() {
            return self.thing_gizmo();
        }
        match self.handles() {
            Handles::None => None,
            Handles::Joints => self.joint_gizmo(),
            Handles::Targets => self.target_gizmo(),
        }
    }

    /// The joint that the gizmo turns, if its channels let it.
    fn joint_gizmo(&self) -> Option<Gizmo> {
        let joint = self.selected().filter(|_| self.can_edit())?;
        let clip = self.active_clip()?;
        if joint.index() >= clip.document.joints.len() {
            return None;
        }
        let freedom = freedom(&clip.document, joint);
        let tool = match (freedom.turns.is_some(), freedom.moves) {
            (false, false) => return None,
            (true, false) => Tool::Turn,
            (false, true) => Tool::Move,
            (true, true) => self.editing.tools.tool,
        };
        let global = self.shown_global_pose()?;
        Some(Gizmo {
            position: global.positions[joint.index()] + self.active_place(),
            axes: self.axes_of(joint, &global),
            tool,
        })
    }

    /// The gizmo's axes at a joint.
    pub(super) fn axes_of(&self, joint: JointId, global: &GlobalPose) -> Quat {
        let of = |joint: JointId| global.orientations[joint.index()];
        let parent = self
            .active_clip()
            .and_then(|clip| clip.skeleton().parent(joint));
        match *self.tools().space_with(self.handles()) {
            Space::Local => of(joint),
            Space::Parent => parent.map_or(Quat::IDENTITY, of),
            Space::World => Quat::IDENTITY,
        }
    }

    /// Whether a handle is held.
    #[must_use]
    pub fn is_dragging(&self) -> bool {
        self.editing.held.is_some() || self.thing_drag().is_some()
    }

    /// The drag of the handle that is held.
    #[must_use]
    pub fn drag(&self) -> Option<&Drag> {
        let joint = self.editing.held.as_ref().map(|held| &held.drag);
        joint.or(self.thing_drag())
    }

    /// Grabs a handle of the gizmo. Returns false if there is nothing to grab.
    pub fn grab(&mut self, handle: Handle, pointer: Pos2, viewport: &Viewport) -> bool {
        self.stop_editing();
        self.transport.pause();
        if let Some(taken) = self.grab_thing(handle, pointer, viewport) {
            return taken;
        }
        let (Some(gizmo), Some(joint)) = (self.gizmo(), self.selected()) else {
            return false;
        };
        let (Some(pose), Some(global)) = (self.shown_local_pose(), self.shown_global_pose()) else {
            return false;
        };
        let orientation = match self.target() {
            Some(target) => target.orientation,
            None => global.orientations[joint.index()],
        };
        let start = Placement {
            position: gizmo.position,
            orientation,
        };
        let Some(drag) = Drag::begin(gizmo, handle, start, pointer, viewport) else {
            return false;
        };
        let pose = Arc::new(pose);
        self.editing.held = Some(Held { drag, joint, pose });
        true
    }

    /// Follows the pointer with the handle that is held.
    pub fn drag_to(&mut self, pointer: Pos2, viewport: &Viewport, snap: Option<Snap>) {
        if self.drag_thing(pointer, viewport, snap) {
            return;
        }
        let Some(mut held) = self.editing.held.take() else {
            return;
        };
        let before = held.drag.placement();
        let placement = held.drag.update(pointer, viewport, snap);
        if placement != before {
            let pose = if self.handles() == Handles::Targets {
                let from = self.editing.live.clone();
                self.follow(&from.unwrap_or_else(|| Arc::clone(&held.pose)), placement)
            } else {
                self.pose_with_joint_at(&held, placement)
            };
            self.hold(pose.map(Arc::new));
        }
        self.editing.held = Some(held);
    }

    /// The pose in which the joint that is held stands and is turned as it was dragged.
    fn pose_with_joint_at(&self, held: &Held, placement: Placement) -> Option<LocalPose> {
        let clip = self.active_clip()?;
        let skeleton = clip.skeleton();
        let joint = held.joint;
        let global = held.pose.to_global(skeleton);
        let mut pose = LocalPose::clone(&held.pose);
        let parent = skeleton.parent(joint);
        let freedom = freedom(&clip.document, joint);
        if held.drag.handle().turns() {
            let order = freedom.turns?;
            let parent = parent.map_or(Quat::IDENTITY, |p| global.orientations[p.index()]);
            let rotation = (parent.inverse() * placement.orientation).normalize();
            pose.rotations[joint.index()] = reachable(order, rotation);
        } else {
            let position = placement.position - self.active_place();
            let local = match parent {
                Some(parent) => global.inverse_transform_point(parent, position),
                None => position,
            };
            pose.translations[joint.index()] = local;
        }
        Some(pose)
    }

    /// Releases the handle: its change becomes one undo step.
    pub fn drop_handle(&mut self) {
        self.empty_hand();
        if self.drop_thing() {
            return;
        }
        let Some(held) = self.editing.held.take() else {
            return;
        };
        if self.limbs.dragged.is_some() {
            let pose = self.editing.live.take();
            self.put_target(pose.map(|pose| LocalPose::clone(&pose)));
            return;
        }
        let (Some(live), Some(clip)) = (self.editing.live.clone(), self.active_clip()) else {
            return;
        };
        if *live == *held.pose {
            self.hold(None);
            return;
        }
        let verb = if held.drag.handle().turns() {
            "Turn"
        } else {
            "Move"
        };
        let name = step_name(verb, clip, held.joint);
        self.put_pose(&name, LocalPose::clone(&live));
    }

    /// Releases the handle and takes its change back. Returns whether one was held.
    pub fn cancel_drag(&mut self) -> bool {
        self.empty_hand();
        if self.cancel_thing() {
            return true;
        }
        let was_held = self.editing.held.take().is_some();
        self.limbs.dragged = None;
        if was_held || self.editing.live.is_some() {
            self.hold(None);
        }
        was_held
    }

    /// Cancels a drag or a run of steps, because something else is happening.
    pub(super) fn stop_editing(&mut self) {
        self.stop_stepping();
        self.cancel_drag();
    }
}
