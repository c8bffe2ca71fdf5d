//! The session: the clips that are open, what is selected, what time it is, and the stage that
//! follows from it. It knows no widget and no window.

mod authoring;
mod editing;
mod hand;
mod limbs;
mod posing;
mod selection;
mod staging;
mod things;

use std::sync::Arc;

use glam::Vec3;
use posekit::check::Finding;
use posekit::pose::GlobalPose;
use posekit::skeleton::JointId;
use posekit_render::camera::{Camera, View};
use posekit_render::scene::Scene;
use posekit_render::stage::{Actor, Stage, StageOptions};

use crate::state::camera::ViewCamera;
use crate::state::clip::{Clip, Reading, index_to_f64, nearest_index};
use crate::state::display::{Display, Look, PoseShown};
use crate::state::transport::Transport;

use authoring::Authoring;
pub use authoring::{AnimateSettings, Handles, KeyWhat};
pub use editing::Changed;
use editing::Editing;
pub use hand::Act;
pub use limbs::Hold;
use limbs::Limbs;
use staging::actor_of;
use things::Things;
pub use things::{KeyState, NewThing};

/// A joint that is taken into the picture alone shows this much of the figure around it.
const JOINT_FRAME_STATURES: f32 = 0.25;

/// No time line is longer: a clip whose rate is wrong by far stands beside one that is right.
const MOST_FRAMES: usize = 10_000_000;

/// An open clip of a session: it stays the same however the list changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClipId(u64);

/// A clip in the session's list.
#[derive(Clone, Debug)]
pub struct OpenClip {
    /// Which one it is.
    pub id: ClipId,
    /// The clip.
    pub clip: Arc<Clip>,
    /// Whether its figure is on the stage.
    pub shown: bool,
    /// Its place in the order of character colours, which is its place on the stage. What is not shown
    /// keeps the one it had.
    pub color: usize,
    actor: Actor,
    /// The same figure in another clip's unit of length, and the factor.
    scaled: Option<(f32, Actor)>,
}

/// Everything about the program's state that is about motion.
#[derive(Debug)]
pub struct Session {
    clips: Vec<OpenClip>,
    active: Option<ClipId>,
    next_id: u64,
    selection: Vec<JointId>,
    /// What time it is.
    pub transport: Transport,
    /// The camera of the view.
    pub camera: ViewCamera,
    display: Display,
    look: Look,
    pose_shown: PoseShown,
    stage: Stage,
    stage_version: u64,
    aspect: f32,
    editing: Editing,
    limbs: Limbs,
    things: Things,
    authoring: Authoring,
    /// Messages for the user.
    told: Vec<String>,
}

impl Default for Session {
    fn default() -> Self {
        Self::new(Display::default(), Look::default())
    }
}

impl Session {
    /// An empty session.
    #[must_use]
    pub fn new(display: Display, look: Look) -> Self {
        let mut session = Self {
            clips: Vec::new(),
            active: None,
            next_id: 1,
            selection: Vec::new(),
            transport: Transport::default(),
            camera: ViewCamera::default(),
            display,
            look,
            pose_shown: PoseShown::Motion,
            stage: Stage::new(Vec::new(), StageOptions::default()),
            stage_version: 0,
            aspect: 16.0 / 9.0,
            editing: Editing::default(),
            limbs: Limbs::default(),
            things: Things::default(),
            authoring: Authoring::default(),
            told: Vec::new(),
        };
        session.set_stage();
        session
            .camera
            .look_from(View::ThreeQuarter, &session.stage, session.aspect);
        session
    }

    /// Leaves a message for the user.
    pub fn tell(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !self.told.contains(&text) {
            self.told.push(text);
        }
    }

    /// The messages since the last call.
    pub fn take_told(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    /// Adds a clip and makes it the active one, alone on the stage, playing.
    pub fn open(&mut self, clip: Clip) -> ClipId {
        let id = self.insert(clip);
        self.activate(id);
        self.transport.play();
        id
    }

    /// Adds a clip next to those on the stage. The first one is opened.
    pub fn open_beside(&mut self, clip: Clip) -> ClipId {
        if self.active.is_none() {
            return self.open(clip);
        }
        let id = self.insert(clip);
        self.set_shown(id, true);
        id
    }

    fn insert(&mut self, clip: Clip) -> ClipId {
        let id = ClipId(self.next_id);
        self.next_id += 1;
        let color = 0;
        let clip = Arc::new(clip);
        let actor = actor_of(&clip, &self.display, color);
        self.clips.push(OpenClip {
            id,
            clip,
            shown: false,
            color,
            actor,
            scaled: None,
        });
        id
    }

    /// Moves a clip in the list, and on the stage, to before another.
    pub fn move_before(&mut self, id: ClipId, other: ClipId) {
        let (Some(from), Some(_)) = (self.index_of(id), self.index_of(other)) else {
            return;
        };
        let open = self.clips.remove(from);
        let to = self.index_of(other).unwrap_or(self.clips.len());
        self.clips.insert(to, open);
        self.set_stage();
    }

    /// Puts a newer version of a clip in its place; time, selection and camera stay.
    pub fn replace(&mut self, id: ClipId, clip: Clip) {
        let Some(index) = self.index_of(id) else {
            return;
        };
        let clip = Arc::new(clip);
        self.forget_edits(id);
        self.forget_authored(id);
        let same_joints =
            clip.skeleton().joint_count() == self.clips[index].clip.skeleton().joint_count();
        self.clips[index].actor = actor_of(&clip, &self.display, self.clips[index].color);
        self.clips[index].scaled = None;
        self.clips[index].clip = Arc::clone(&clip);
        if self.active == Some(id) {
            self.reload_time_line();
            if !same_joints {
                self.selection.clear();
            }
        }
        self.set_stage();
    }

    /// Reads a clip's numbers in another way. An edited clip, whose history is of the numbers as they are read,
    /// stays as it is, and so does an authored one.
    pub fn set_reading(&mut self, id: ClipId, reading: Reading) {
        let Some(index) = self.index_of(id) else {
            return;
        };
        let old = &self.clips[index].clip;
        if old.reading == reading || self.is_edited(id) || self.authored_of(id).is_some() {
            return;
        }
        let Ok(clip) = old.read_as(reading) else {
            return;
        };
        self.replace(id, clip);
        self.editing.changed.insert(id);
    }

    /// An open clip.
    #[must_use]
    pub fn clip(&self, id: ClipId) -> Option<&Arc<Clip>> {
        Some(&self.clips[self.index_of(id)?].clip)
    }

    /// Hands in what the checks found in a clip.
    pub fn set_findings(&mut self, id: ClipId, findings: Vec<Finding>) {
        if let Some(index) = self.index_of(id) {
            Arc::make_mut(&mut self.clips[index].clip).findings = findings;
        }
    }

    /// Closes a clip. The one before it becomes active if it was.
    pub fn close(&mut self, id: ClipId) {
        let Some(index) = self.index_of(id) else {
            return;
        };
        self.clips.remove(index);
        self.forget_edits(id);
        self.forget_authored(id);
        if self.active == Some(id) {
            self.active = None;
            match self.clips.get(index.saturating_sub(1)).map(|open| open.id) {
                Some(next) => self.activate(next),
                None => {
                    self.selection.clear();
                    self.transport.load(0, 0.0);
                    self.set_stage();
                }
            }
        } else {
            self.set_stage();
        }
    }

    /// Makes a clip the active one, alone on the stage.
    pub fn activate(&mut self, id: ClipId) {
        if self.index_of(id).is_none() {
            return;
        }
        for open in &mut self.clips {
            open.shown = open.id == id;
        }
        self.make_active(id);
        self.set_stage();
        self.reframe();
    }

    /// Makes a clip that is on the stage the active one, and leaves the others on it.
    pub fn activate_among(&mut self, id: ClipId) {
        if self.clips.iter().any(|open| open.id == id && open.shown) {
            self.make_active(id);
        }
    }

    fn make_active(&mut self, id: ClipId) {
        if self.active == Some(id) {
            return;
        }
        self.stop_editing();
        let before = self.active_clip().map(|clip| Arc::clone(clip.skeleton()));
        self.active = Some(id);
        let Some(clip) = self.active_clip() else {
            return;
        };
        // The same joints stay selected in a clip of the same skeleton.
        let same = before.is_some_and(|before| before.parents() == clip.skeleton().parents());
        if !same {
            self.selection.clear();
        }
        self.forget_things();
        let was_playing = self.transport.is_playing();
        let (frame_count, frame_time) = self.time_line();
        self.transport.load(frame_count, frame_time);
        if was_playing {
            self.transport.play();
        }
    }

    /// How many frames there are, and the seconds of one: those of the active clip, and as many more as it
    /// takes for the longest clip on the stage to come to its end.
    fn time_line(&self) -> (usize, f64) {
        let Some(active) = self.active_clip() else {
            return (0, 0.0);
        };
        let frame_secs = active.motion.frame_time_secs();
        let own = active.frame_count();
        if own == 0 || frame_secs <= 0.0 {
            return (own, frame_secs);
        }
        let durations = self.shown().map(|open| open.clip.motion.duration_secs());
        let longest = durations.fold(0.0, f64::max);
        // Rates that are rounded in their files do not make a frame of their own.
        let frames = (longest / frame_secs - 0.01).ceil().max(0.0);
        let last = nearest_index(frames, MOST_FRAMES).max(own - 1);
        (last + 1, frame_secs)
    }

    /// The time line follows a change of the clips on the stage; time and range stay where they can.
    fn reload_time_line(&mut self) {
        let (frame_count, frame_secs) = self.time_line();
        self.transport.reload(frame_count, frame_secs);
    }

    /// The frame of the active clip that is shown: its last, where others go on.
    #[must_use]
    pub fn clip_frame(&self) -> usize {
        let frames = self.active_clip().map_or(0, |clip| clip.frame_count());
        self.transport.frame().min(frames.saturating_sub(1))
    }

    /// Puts a clip on the stage beside the active one, or takes it off. The active one stays.
    pub fn set_shown(&mut self, id: ClipId, shown: bool) {
        if self.active == Some(id) {
            return;
        }
        if let Some(index) = self.index_of(id)
            && self.clips[index].shown != shown
        {
            self.clips[index].shown = shown;
            self.set_stage();
            self.reframe();
        }
    }

    /// All open clips, in the order of opening.
    #[must_use]
    pub fn clips(&self) -> &[OpenClip] {
        &self.clips
    }

    /// The clips on the stage, in the order of its actors.
    pub fn shown(&self) -> impl Iterator<Item = &OpenClip> {
        self.clips.iter().filter(|open| open.shown)
    }

    /// Which clip is active.
    #[must_use]
    pub fn active_id(&self) -> Option<ClipId> {
        self.active
    }

    /// The clip that the transport, the inspector and the curves are about.
    #[must_use]
    pub fn active_clip(&self) -> Option<&Arc<Clip>> {
        let id = self.active?;
        self.clips
            .iter()
            .find(|open| open.id == id)
            .map(|open| &open.clip)
    }

    fn index_of(&self, id: ClipId) -> Option<usize> {
        self.clips.iter().position(|open| open.id == id)
    }

    /// What is shown, and how.
    #[must_use]
    pub fn display(&self) -> &Display {
        &self.display
    }

    /// Changes what is shown.
    pub fn set_display(&mut self, display: Display) {
        if self.display == display {
            return;
        }
        let restyled = self.display.style != display.style;
        let rearranged = self.display.compare != display.compare;
        let before = self.stage.followed(self.transport.time_secs());
        self.display = display;
        if restyled {
            for open in &mut self.clips {
                open.actor = actor_of(&open.clip, &self.display, open.color);
                open.scaled = None;
            }
        }
        self.set_stage();
        let after = self.stage.followed(self.transport.time_secs());
        if rearranged {
            self.reframe();
        } else {
            self.camera.rebase(before, after);
        }
    }

    /// Light or dark.
    #[must_use]
    pub fn look(&self) -> Look {
        self.look
    }

    /// Makes it light or dark.
    pub fn set_look(&mut self, look: Look) {
        self.look = look;
        self.set_stage();
    }

    /// Which pose is shown.
    #[must_use]
    pub fn pose_shown(&self) -> PoseShown {
        self.pose_shown
    }

    /// Shows the motion or the rest pose.
    pub fn set_pose_shown(&mut self, pose_shown: PoseShown) {
        let before = self.stage.followed(self.stage_time_secs());
        self.pose_shown = pose_shown;
        self.set_stage();
        let after = self.stage.followed(self.stage_time_secs());
        self.camera.rebase(before, after);
    }

    /// Sets the aspect ratio of the view, width over height. A camera that was framed for another shape
    /// is framed again.
    pub fn set_aspect(&mut self, aspect: f32) {
        let valid = aspect.is_finite() && aspect > 0.0;
        if valid && (aspect - self.aspect).abs() > 1e-3 {
            self.aspect = aspect;
            if self.camera.is_framed() {
                self.reframe();
            }
        }
    }

    /// Takes everything into the picture, seen from where the camera looks now.
    pub fn reframe(&mut self) {
        self.camera.frame_all(&self.stage, self.aspect);
    }

    /// Looks from a named side.
    pub fn look_from(&mut self, view: View) {
        self.camera.look_from(view, &self.stage, self.aspect);
    }

    /// Takes the selected joint, or the camera, light or prop that is picked, into the picture; everything
    /// when there is neither.
    pub fn frame_selected(&mut self) {
        let time = self.stage_time_secs();
        let point = match (self.picked_place(), self.selected()) {
            (Some(place), _) => Some(place),
            (None, Some(joint)) => self.joint_position(joint),
            (None, None) => {
                self.reframe();
                return;
            }
        };
        if let Some(point) = point {
            let radius = JOINT_FRAME_STATURES * self.stage.stature();
            self.camera.frame_point(point, radius, &self.stage, time);
        }
    }

    /// Where a joint of the active clip stands on the stage now.
    #[must_use]
    pub fn joint_position(&self, joint: JointId) -> Option<Vec3> {
        let (_, pose) = self
            .poses_on_stage()
            .into_iter()
            .find(|(id, _)| Some(*id) == self.active)?;
        pose.positions.get(joint.index()).copied()
    }

    /// The poses of all actors as they stand on the stage now.
    #[must_use]
    pub fn poses_on_stage(&self) -> Vec<(ClipId, GlobalPose)> {
        let time = self.stage_time_secs();
        let actors = self.stage.actors().iter().zip(self.stage.places());
        let placed = self.shown().zip(actors).map(|(open, (actor, &place))| {
            let mut pose = actor.shown_pose(time);
            for position in &mut pose.positions {
                *position += place;
            }
            (open.id, pose)
        });
        placed.collect()
    }

    /// The stage.
    #[must_use]
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// A number that changes whenever the stage does.
    #[must_use]
    pub fn stage_version(&self) -> u64 {
        self.stage_version
    }

    /// The time that the stage is shown at.
    #[must_use]
    pub fn stage_time_secs(&self) -> f64 {
        match self.pose_shown {
            PoseShown::Motion => self.transport.time_secs(),
            PoseShown::Rest => 0.0,
        }
    }

    /// The camera now.
    #[must_use]
    pub fn view_camera(&self) -> Camera {
        self.framed_camera().unwrap_or_else(|| {
            self.camera
                .orbit(&self.stage, self.stage_time_secs())
                .camera()
        })
    }

    /// The scene now.
    #[must_use]
    pub fn scene(&self) -> Scene {
        self.stage
            .scene_from(self.stage_time_secs(), self.view_camera())
    }

    /// The scene now as a picture of it shows it: by the camera that is looked through, if there is one,
    /// without the margin around its frame.
    #[must_use]
    pub fn picture(&self) -> Scene {
        let camera = self.scene_camera().unwrap_or_else(|| self.view_camera());
        self.stage.scene_from(self.stage_time_secs(), camera)
    }

    /// The time of a frame of the active clip.
    #[must_use]
    pub fn secs_of_frame(&self, frame: usize) -> f64 {
        self.active_clip().map_or(0.0, |clip| {
            index_to_f64(frame) * clip.motion.frame_time_secs()
        })
    }
}
