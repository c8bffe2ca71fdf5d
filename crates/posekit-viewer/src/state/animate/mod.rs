//! Authored clips: a scene with its keys, edited without limit, of which the clip's motion is the bake.
//!
//! An [`Authored`] holds the scene, which keys are selected, and the history. Everything that changes it
//! is one step of the history; all that happens in one [`Gesture`] is one step together. The editing
//! functions ([`edit`]) make new tracks of old ones and hand them to [`Authored::set_tracks`].
//!
//! **Space and units.** Times are seconds of the scene. The clip's frame 0 is at the start of the
//! scene's range.
//!
//! **Paths.** While a scene is open it names files by where they are on this machine; in its own file
//! they are relative to its folder ([`place`]).

pub mod channel;
pub mod edit;
pub mod graph;
mod lane;
pub mod place;
pub mod pose_library;
mod start;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use posekit::keyframe::Animation;
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::rotation::EulerOrder;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::scene::{FileMotion, JointValues, MotionFileError, Scene, Shot, ShotError};

pub use lane::{KeyId, Lane, LaneTrack, LaneValue, Owner, TrackValue};
pub use start::{Start, start};

use super::edit::{Gesture, History};
use super::ik::Goals;
use lane::{PropertyRef, put_track};

/// What files play, by the names that the scene has for them.
pub type Files = BTreeMap<String, FileMotion>;

/// All that is undone and redone.
#[derive(Clone, Debug)]
struct State {
    scene: Scene,
    selection: BTreeSet<KeyId>,
    goals: Goals,
    /// A number of its own for every state that there was.
    revision: u64,
}

/// An authored clip's scene.
#[derive(Clone, Debug)]
pub struct Authored {
    state: State,
    history: History<State>,
    files: Files,
    /// The order of angles that joints have in the skeleton's own file, by their unique names.
    orders: BTreeMap<String, EulerOrder>,
    shot: Shot,
    now_secs: f64,
    next_revision: u64,
    /// The revision that is in the file; `None` while there is none in any.
    saved: Option<u64>,
    path: Option<PathBuf>,
}

impl Authored {
    /// A scene that is in no file yet.
    ///
    /// # Errors
    /// If the scene does not fit its skeleton, or names a file that is not among `files`.
    pub fn new(scene: Scene, files: Files) -> Result<Self, ShotError<MotionFileError>> {
        let shot = shot_of(&scene, &files)?;
        Ok(Self {
            now_secs: scene.range_secs[0],
            state: State {
                scene,
                selection: BTreeSet::new(),
                goals: Goals::default(),
                revision: 0,
            },
            history: History::default(),
            files,
            orders: BTreeMap::new(),
            shot,
            next_revision: 1,
            saved: None,
            path: None,
        })
    }

    /// The same, as it is in a file: `path` where that can be written again.
    #[must_use]
    pub fn in_file(mut self, path: Option<PathBuf>) -> Self {
        self.set_saved(path);
        self
    }

    /// The same, with the order of angles that joints have in the skeleton's own file, by unique names.
    #[must_use]
    pub fn with_orders(mut self, orders: BTreeMap<String, EulerOrder>) -> Self {
        self.orders = orders;
        self
    }

    /// The order in which a joint's angles are told: that of its track, else that of the skeleton's file, else
    /// `ZXY`.
    #[must_use]
    pub fn order_of(&self, joint: JointId) -> EulerOrder {
        if joint.index() >= self.skeleton().joint_count() {
            return EulerOrder::ZXY;
        }
        let name = self.skeleton().unique_name(joint);
        let tracks = self.scene().tracks.iter();
        let keyed = tracks
            .filter(|track| track.joint == name)
            .find_map(|track| match &track.values {
                JointValues::Rotation { euler, .. } => euler.as_ref().map(|euler| euler.order),
                JointValues::EulerRotation(track) => Some(track.order()),
                JointValues::Translation(_) => None,
            });
        let in_file = self.orders.get(name).copied();
        keyed.or(in_file).unwrap_or(EulerOrder::ZXY)
    }

    /// The scene. Files are named by where they are on this machine.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.state.scene
    }

    /// The skeleton that moves.
    #[must_use]
    pub fn skeleton(&self) -> &Arc<Skeleton> {
        self.shot.skeleton()
    }

    /// The keyed joints.
    #[must_use]
    pub fn animation(&self) -> &Animation {
        self.shot.animation()
    }

    /// The motion of the scene's range at its own rate.
    #[must_use]
    pub fn bake(&self) -> Motion {
        self.shot.bake(None)
    }

    /// The pose at a time of the scene: layers, under the keyed joints.
    #[must_use]
    pub fn pose_at(&self, time_secs: f64) -> LocalPose {
        let mut pose = LocalPose::rest(self.skeleton());
        self.shot.sample_into(time_secs, &mut pose);
        pose
    }

    /// Everything that has keys, and every property of cameras, lights and props, keyed or not: joints
    /// in the skeleton's order.
    #[must_use]
    pub fn lanes(&self) -> Vec<Lane> {
        let joints = self.skeleton().joints().map(Owner::Joint);
        let keyed = joints
            .flat_map(Owner::lanes)
            .filter(|lane| self.track(*lane).is_some());
        let around = self.owners_around().into_iter().flat_map(Owner::lanes);
        keyed.chain(around).collect()
    }

    /// The cameras, lights and props.
    #[must_use]
    pub fn owners_around(&self) -> Vec<Owner> {
        let scene = self.scene();
        let cameras = (0..scene.cameras.len()).map(Owner::Camera);
        let lights = (0..scene.lights.len()).map(Owner::Light);
        let props = (0..scene.props.len()).map(Owner::Prop);
        cameras.chain(lights).chain(props).collect()
    }

    /// A lane's track, if it is keyed.
    #[must_use]
    pub fn track(&self, lane: Lane) -> Option<LaneTrack<'_>> {
        let animation = self.animation();
        let exists = |joint: JointId| joint.index() < animation.skeleton().joint_count();
        match lane {
            Lane::Rotation(joint) if exists(joint) => {
                animation.rotation(joint).map(LaneTrack::from)
            }
            Lane::Translation(joint) if exists(joint) => {
                let track = animation.translation(joint)?;
                Some(LaneTrack::Vector(track.as_ref()))
            }
            _ => PropertyRef::of(self.scene(), lane)?.track(),
        }
    }

    /// What a lane is at a time of the scene, keyed or not; `None` where the scene has no such thing.
    #[must_use]
    pub fn value_at(&self, lane: Lane, time_secs: f64) -> Option<LaneValue> {
        let exists = |joint: JointId| joint.index() < self.skeleton().joint_count();
        match lane {
            Lane::Rotation(joint) | Lane::Translation(joint) if !exists(joint) => None,
            Lane::Rotation(joint) => Some(LaneValue::Orientation(
                match self.animation().rotation(joint) {
                    Some(track) => track.sample(time_secs),
                    None => self.pose_at(time_secs).rotations[joint.index()].as_dquat(),
                },
            )),
            Lane::Translation(joint) => Some(LaneValue::Vector(
                match self.animation().translation(joint) {
                    Some(track) => track.sample(time_secs),
                    None => self.pose_at(time_secs).translations[joint.index()].as_dvec3(),
                },
            )),
            _ => Some(PropertyRef::of(self.scene(), lane)?.at(time_secs)),
        }
    }

    /// The time of a key, seconds of the scene.
    #[must_use]
    pub fn time_of(&self, key: KeyId) -> Option<f64> {
        let track = self.track(key.lane)?;
        track.times_secs().get(key.index).copied()
    }

    /// How many keys there are.
    #[must_use]
    pub fn key_count(&self) -> usize {
        let lanes = self.lanes();
        let tracks = lanes.iter().filter_map(|lane| self.track(*lane));
        tracks.map(|track| track.key_count()).sum()
    }

    /// The selected keys.
    #[must_use]
    pub fn selection(&self) -> &BTreeSet<KeyId> {
        &self.state.selection
    }

    /// Selects keys. It is no step of the history; those that do not exist are left out.
    pub fn select(&mut self, mut keys: BTreeSet<KeyId>) {
        keys.retain(|key| self.time_of(*key).is_some());
        self.state.selection = keys;
    }

    /// What is asked of limbs.
    #[must_use]
    pub fn goals(&self) -> &Goals {
        &self.state.goals
    }

    /// Asks something new of limbs.
    pub fn set_goals(&mut self, name: &str, goals: Goals) {
        if goals != self.state.goals {
            let next = State {
                goals,
                ..self.state.clone()
            };
            self.step(name, None, next);
        }
    }

    /// Asks something new of limbs as part of the step that was made last.
    pub fn choose_goals(&mut self, goals: Goals) {
        self.state.goals = goals;
    }

    /// The time shown, in seconds of the scene.
    #[must_use]
    pub fn now_secs(&self) -> f64 {
        self.now_secs
    }

    /// Tells what time is shown.
    pub fn set_now(&mut self, time_secs: f64) {
        self.now_secs = time_secs;
    }

    /// The time between two frames.
    #[must_use]
    pub fn frame_secs(&self) -> f64 {
        FrameTime::of_rate(self.scene().frames_per_sec)
            .unwrap_or(FrameTime::of_fps(30))
            .secs()
    }

    /// The frame's time that is nearest to a time. Frames are counted from the start of the range.
    #[must_use]
    pub fn snapped(&self, time_secs: f64) -> f64 {
        let start = self.scene().range_secs[0];
        let frames = ((time_secs - start) / self.frame_secs()).round();
        start + frames * self.frame_secs()
    }

    /// A new gesture: what is edited within it becomes one step.
    pub fn gesture(&mut self) -> Gesture {
        self.history.gesture()
    }

    /// The one write of keys: gives lanes new tracks, and selects keys of what is then there. `None`
    /// for a property that is no longer keyed: it keeps the value that it has now; a joint goes back
    /// to what motions, or the rest pose, say of it. All that is set in one `gesture` is one step.
    ///
    /// Lanes that the scene does not have, and tracks of another kind than the lane's, are left out.
    pub fn set_tracks(
        &mut self,
        name: &str,
        gesture: Option<Gesture>,
        changes: Vec<(Lane, Option<TrackValue>)>,
        selection: BTreeSet<KeyId>,
    ) {
        let now_secs = self.now_secs;
        let skeleton = Arc::clone(self.skeleton());
        // Tracks by themselves do not fail to fit: lanes are those of the skeleton.
        let fits = self.edit_scene(name, gesture, |scene| {
            for (lane, track) in changes {
                put_track(scene, &skeleton, lane, track, now_secs);
            }
        });
        if fits.is_ok() {
            self.select(selection);
        }
    }

    /// Changes the scene in another way: its range, its cameras, what stands around. Keys stay
    /// selected as far as they exist afterwards.
    ///
    /// # Errors
    /// If the scene would no longer fit its skeleton, or names a file that was not added
    /// ([`add_file`](Self::add_file)); then nothing has changed.
    pub fn edit_scene(
        &mut self,
        name: &str,
        gesture: Option<Gesture>,
        change: impl FnOnce(&mut Scene),
    ) -> Result<(), ShotError<MotionFileError>> {
        let mut next = self.state.clone();
        change(&mut next.scene);
        if next.scene == self.state.scene {
            return Ok(());
        }
        let shot = shot_of(&next.scene, &self.files)?;
        self.step(name, gesture, next);
        self.shot = shot;
        self.select(self.state.selection.clone());
        Ok(())
    }

    /// Adds the motion of a file, so that the scene may name it.
    pub fn add_file(&mut self, name: String, motion: FileMotion) {
        self.files.insert(name, motion);
    }

    fn step(&mut self, name: &str, gesture: Option<Gesture>, mut next: State) {
        next.revision = self.next_revision;
        self.next_revision += 1;
        let before = std::mem::replace(&mut self.state, next);
        match gesture {
            Some(gesture) => drop(self.history.record_in(gesture, name, || before)),
            None => self.history.record(name, before),
        }
    }

    /// Undoes the last step: its name.
    pub fn undo(&mut self) -> Option<String> {
        self.travel(|history, state| {
            let name = history.undo(|step| std::mem::swap(step, state));
            name.map(str::to_owned)
        })
    }

    /// Does the last step again that was undone: its name.
    pub fn redo(&mut self) -> Option<String> {
        self.travel(|history, state| {
            let name = history.redo(|step| std::mem::swap(step, state));
            name.map(str::to_owned)
        })
    }

    /// Gives a gesture up: everything is as it was before. True when it had changed something.
    pub fn give_up(&mut self, gesture: Gesture) -> bool {
        self.travel(|history, state| history.give_up(gesture, |step| std::mem::swap(step, state)))
    }

    fn travel<T>(&mut self, go: impl FnOnce(&mut History<State>, &mut State) -> T) -> T {
        let before = self.state.revision;
        let gone = go(&mut self.history, &mut self.state);
        if self.state.revision != before
            && let Ok(shot) = shot_of(&self.state.scene, &self.files)
        {
            // A state that was there once fits: no file is ever taken away.
            self.shot = shot;
        }
        gone
    }

    /// The name of what would be undone.
    #[must_use]
    pub fn undo_name(&self) -> Option<&str> {
        self.history.undo_name()
    }

    /// The name of what would be redone.
    #[must_use]
    pub fn redo_name(&self) -> Option<&str> {
        self.history.redo_name()
    }

    /// How many steps can be undone.
    #[must_use]
    pub fn undo_count(&self) -> usize {
        self.history.len()
    }

    /// A number that is another one whenever the scene, what is asked of limbs, or the selection that a
    /// step has made, is.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.state.revision
    }

    /// Whether there is something that is in no file.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.saved != Some(self.state.revision)
    }

    /// Where its file is, if it has one that can be written again.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Tells that the scene as it is now is in a file.
    pub fn set_saved(&mut self, path: Option<PathBuf>) {
        self.saved = Some(self.state.revision);
        self.path = path;
    }

    /// Tells where its file would be, though what is there is older.
    pub fn set_path(&mut self, path: Option<PathBuf>) {
        self.path = path;
    }
}

fn shot_of(scene: &Scene, files: &Files) -> Result<Shot, ShotError<MotionFileError>> {
    Shot::new(scene, |name| {
        let motion = files.get(name).cloned();
        motion.ok_or_else(|| MotionFileError("it was not read".to_owned()))
    })
}
