//! Edits of a clip: one pose at a time, undone and redone without limit.
//!
//! An edit is in the clip as soon as it is made, in the motion and in the document, so that every panel
//! and every file that is saved shows it. What makes it one is its [`Draft`]: the pose at a frame before
//! and after, and how it reaches the frames around ([`Spread`]), which may still be changed. The draft
//! is kept for good when another frame is edited, and taken back by a reset.

mod history;
mod patch;
mod spread;

use std::sync::Arc;

use posekit::pose::LocalPose;
use posekit::skeleton::JointId;

pub use history::{Gesture, History};
pub use patch::{Freedom, Patch, Replaced, freedom, reachable};
pub use spread::{Blend, Reach, Spread};

use super::clip::Clip;
use super::ik::Goals;

/// A pose that is being edited.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// The frame.
    pub frame: usize,
    /// The pose that the frame had.
    pub before: Arc<LocalPose>,
    /// The pose that it has now.
    pub pose: Arc<LocalPose>,
    /// How it reaches the frames around.
    pub spread: Spread,
}

/// All that is undone and redone, beside what is in the clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EditState {
    /// The pose that is being edited.
    pub draft: Option<Draft>,
    /// What is asked of limbs.
    pub goals: Goals,
}

/// One step of the history.
#[derive(Clone, Debug)]
struct Step {
    /// The state on the other side of it.
    other: EditState,
    /// Whether it keeps the draft before it for good; then what that draft has replaced.
    keeps: Option<Option<Replaced>>,
}

/// The edits of one clip.
#[derive(Clone, Debug, Default)]
pub struct ClipEdits {
    state: EditState,
    /// What the draft has replaced in the clip.
    replaced: Option<Replaced>,
    history: History<Step>,
    /// How the next draft reaches the frames around.
    spread: Spread,
}

impl ClipEdits {
    /// No edits yet; the first reaches the frames around as `spread` says.
    #[must_use]
    pub fn with_spread(spread: Spread) -> Self {
        Self {
            spread,
            ..Self::default()
        }
    }

    /// The state.
    #[must_use]
    pub fn state(&self) -> &EditState {
        &self.state
    }

    /// The pose that is being edited.
    #[must_use]
    pub fn draft(&self) -> Option<&Draft> {
        self.state.draft.as_ref()
    }

    /// How the draft, or the next one, reaches the frames around.
    #[must_use]
    pub fn spread(&self) -> Spread {
        self.draft().map_or(self.spread, |draft| draft.spread)
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

    /// Whether the clip's motion differs from what was opened: pins and targets alone do not count.
    #[must_use]
    pub fn has_changed_motion(&self) -> bool {
        let is_kept = |step: &Step| matches!(&step.keeps, Some(Some(_)));
        self.replaced.is_some() || self.history.steps().any(is_kept)
    }

    /// A new gesture: what is edited within it becomes one step.
    pub fn gesture(&mut self) -> Gesture {
        self.history.gesture()
    }

    /// Gives a frame a new pose and asks something new of limbs, in one step.
    ///
    /// # Panics
    /// If the frame is not one of the clip's, or the pose not one of its skeleton.
    pub fn set_pose(
        &mut self,
        clip: &mut Clip,
        name: &str,
        frame: usize,
        pose: LocalPose,
        goals: Goals,
    ) {
        let mut next = EditState {
            draft: self.state.draft.clone(),
            goals,
        };
        let pose = Arc::new(pose);
        let is_same_frame = self.draft().is_some_and(|draft| draft.frame == frame);
        match &mut next.draft {
            Some(draft) if is_same_frame => draft.pose = pose,
            draft => {
                let before = Arc::new(clip.motion.pose(frame));
                *draft = Some(Draft {
                    frame,
                    before,
                    pose,
                    spread: self.spread,
                });
            }
        }
        let keeps = self.draft().is_some() && !is_same_frame;
        self.step(clip, name, next, keeps);
    }

    /// Asks something new of limbs; the pose stays.
    pub fn set_goals(&mut self, clip: &mut Clip, name: &str, goals: Goals) {
        if goals != self.state.goals {
            let next = EditState {
                goals,
                ..self.state.clone()
            };
            self.step(clip, name, next, false);
        }
    }

    /// Asks something new of limbs without a step of its own: what is merely chosen.
    pub fn choose_goals(&mut self, goals: Goals) {
        self.state.goals = goals;
    }

    /// Changes how the draft reaches the frames around, and every draft that comes.
    pub fn set_spread(&mut self, clip: &mut Clip, spread: Spread, gesture: Gesture) {
        self.spread = spread;
        let Some(draft) = self.draft().filter(|draft| draft.spread != spread) else {
            return;
        };
        let next = EditState {
            draft: Some(Draft {
                spread,
                ..draft.clone()
            }),
            goals: self.state.goals.clone(),
        };
        let before = self.state.clone();
        self.history
            .record_in(gesture, "Change the fall-off", || Step {
                other: before,
                keeps: None,
            });
        self.take_back(clip);
        self.state = next;
        self.put_in(clip);
    }

    /// Keeps the draft for good: what comes next is another.
    pub fn keep(&mut self, clip: &mut Clip) {
        if let Some(draft) = self.draft() {
            let name = format!("Keep the pose of frame {}", draft.frame);
            let next = EditState {
                draft: None,
                goals: self.state.goals.clone(),
            };
            self.step(clip, &name, next, true);
        }
    }

    /// Takes the draft back: the frames have the poses that they had.
    pub fn reset(&mut self, clip: &mut Clip) {
        if self.draft().is_some() {
            let next = EditState {
                draft: None,
                goals: Goals {
                    target: None,
                    ..self.state.goals.clone()
                },
            };
            self.step(clip, "Reset the pose", next, false);
        }
    }

    fn step(&mut self, clip: &mut Clip, name: &str, next: EditState, keeps: bool) {
        let keeps = if keeps {
            Some(self.replaced.take())
        } else {
            self.take_back(clip);
            None
        };
        let other = std::mem::replace(&mut self.state, next);
        self.put_in(clip);
        self.history.record(name, Step { other, keeps });
    }

    /// Undoes the last step. Its name, and the frame at which something changed.
    pub fn undo(&mut self, clip: &mut Clip) -> Option<(String, Option<usize>)> {
        let mut history = std::mem::take(&mut self.history);
        let frame_after = self.draft().map(|draft| draft.frame);
        let name = history.undo(|step| {
            self.take_back(clip);
            std::mem::swap(&mut self.state, &mut step.other);
            match &mut step.keeps {
                // It is in the clip still: from now on it is the draft again.
                Some(kept) => self.replaced = kept.take(),
                None => self.put_in(clip),
            }
        });
        let name = name.map(str::to_owned);
        self.history = history;
        let frame = frame_after.or(self.draft().map(|draft| draft.frame));
        name.map(|name| (name, frame))
    }

    /// Does the last step again that was undone. Its name, and the frame at which something changed.
    pub fn redo(&mut self, clip: &mut Clip) -> Option<(String, Option<usize>)> {
        let mut history = std::mem::take(&mut self.history);
        let frame_before = self.draft().map(|draft| draft.frame);
        let name = history.redo(|step| {
            match &mut step.keeps {
                Some(kept) => *kept = self.replaced.take(),
                None => self.take_back(clip),
            }
            std::mem::swap(&mut self.state, &mut step.other);
            self.put_in(clip);
        });
        let name = name.map(str::to_owned);
        self.history = history;
        let frame = self.draft().map(|draft| draft.frame).or(frame_before);
        name.map(|name| (name, frame))
    }

    /// Takes the draft's values out of the clip.
    fn take_back(&mut self, clip: &mut Clip) {
        if let Some(replaced) = self.replaced.take() {
            replaced.restore(clip);
        }
    }

    /// Puts the draft's values into the clip.
    fn put_in(&mut self, clip: &mut Clip) {
        self.replaced = self.state.draft.as_ref().and_then(|draft| {
            let poses = (&*draft.before, &*draft.pose);
            let patch = Patch::of_edit(&clip.motion, draft.frame, poses, draft.spread)?;
            Some(patch.write(clip))
        });
    }

    /// The joints that the draft has changed.
    #[must_use]
    pub fn changed_joints(&self) -> Vec<JointId> {
        self.draft().map_or_else(Vec::new, |draft| {
            let joints = (0..draft.pose.joint_count()).filter(|&j| {
                draft.before.rotations[j] != draft.pose.rotations[j]
                    || draft.before.translations[j] != draft.pose.translations[j]
            });
            joints.map(JointId::new).collect()
        })
    }
}
