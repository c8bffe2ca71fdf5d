//! The comparison on a real clip: every n-th frame is kept, each method fills in the others, and the truth
//! stands beside them.
//!
//! The work is done away from the window, a method at a time ([`FillJob`]): what is done is seen at once, and
//! what is not begun can be given up.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use posekit::inbetween::{FillError, FillMethod, FillPlan, Method, fill};
use posekit::motion::Motion;
use posekit::rotation::EulerOrder;
use posekit::skeleton::JointId;
use posekit_render::camera::{Camera, View};
use posekit_render::scene::Scene;
use posekit_render::stage::{Actor, Arrangement, SkeletonStyle, Stage, StageOptions};
use posekit_render::theme::Theme;

use super::colors::{TRUTH, figure_of, hex_of_fill};
use crate::state::camera::ViewCamera;
use crate::state::clip::{Clip, Source};
use crate::state::display::{Compare, Look};
use crate::state::session::ClipId;
use crate::state::transport::Transport;

/// How many frames there may be from one kept frame to the next.
pub const EVERY_RANGE: std::ops::RangeInclusive<usize> = 2..=120;

/// Every which frame is kept first.
const FIRST_EVERY: usize = 10;

/// All methods for whole figures, in the order in which they are listed.
#[must_use]
pub fn offered() -> Vec<FillMethod> {
    let mut all: Vec<FillMethod> = vec![FillMethod::OwnEuler];
    all.extend(Method::ALL.map(FillMethod::Same));
    all.sort_by_key(|method| match method {
        FillMethod::OwnEuler => 5,
        FillMethod::Same(Method::Slerp) => 0,
        FillMethod::Same(Method::Nlerp) => 1,
        FillMethod::Same(Method::Squad) => 2,
        FillMethod::Same(Method::RotationVector) => 3,
        FillMethod::Same(Method::Matrix) => 4,
        FillMethod::Same(Method::Euler(_)) => 6,
        FillMethod::Same(_) => 7,
    });
    all
}

/// The clip that is compared.
#[derive(Clone, Debug)]
struct Subject {
    id: ClipId,
    clip: Arc<Clip>,
    orders: Arc<[EulerOrder]>,
    truth: Actor,
}

/// A piece of work: one method on one clip.
#[derive(Clone, Debug)]
pub struct FillJob {
    generation: u64,
    motion: Arc<Motion>,
    orders: Arc<[EulerOrder]>,
    every: usize,
    method: FillMethod,
    style: SkeletonStyle,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct Filled {
    generation: u64,
    /// By which method.
    pub method: FillMethod,
    /// How far it is from the truth.
    pub error: FillError,
    actor: Actor,
}

impl FillJob {
    /// By which method.
    #[must_use]
    pub fn method(&self) -> FillMethod {
        self.method
    }

    /// Does it: up to seconds for a clip of many minutes. `None` where nothing can be kept.
    #[must_use]
    pub fn run(&self) -> Option<Filled> {
        let plan = FillPlan::every(self.every, self.motion.frame_count()).ok()?;
        let filled = fill(&self.motion, &plan, |joint| {
            self.method.of(joint, &self.orders)
        });
        let error = FillError::between(&self.motion, &filled, &plan.filled());
        let colors = figure_of(hex_of_fill(self.method));
        Some(Filled {
            generation: self.generation,
            method: self.method,
            error,
            actor: Actor::new(Arc::new(filled), self.style, colors),
        })
    }
}

/// The comparison.
#[derive(Debug)]
pub struct ClipLab {
    subject: Option<Subject>,
    every: usize,
    chosen: BTreeSet<FillMethod>,
    seen: BTreeSet<FillMethod>,
    sees_truth: bool,
    results: BTreeMap<FillMethod, Filled>,
    running: Option<FillMethod>,
    given_up: bool,
    generation: u64,
    arrangement: Compare,
    stage: Stage,
    version: u64,
    aspect: f32,
    marked: Option<JointId>,
    style: SkeletonStyle,
    look: Look,
    /// The clip's clock here.
    pub transport: Transport,
    /// Where the figures are looked at from.
    pub camera: ViewCamera,
}

impl Default for ClipLab {
    fn default() -> Self {
        Self {
            subject: None,
            every: FIRST_EVERY,
            chosen: FillMethod::USUAL.into_iter().collect(),
            seen: [FillMethod::Same(Method::Slerp), FillMethod::OwnEuler].into(),
            sees_truth: true,
            results: BTreeMap::new(),
            running: None,
            given_up: false,
            generation: 0,
            arrangement: Compare::SideBySide,
            stage: Stage::new(Vec::new(), StageOptions::default()),
            version: 0,
            aspect: 1.5,
            marked: None,
            style: SkeletonStyle::Bones,
            look: Look::default(),
            transport: Transport::default(),
            camera: ViewCamera::default(),
        }
    }
}

impl ClipLab {
    /// Compares this clip from now on, if it is another one or has changed. `None` compares nothing.
    pub fn follow(&mut self, active: Option<(ClipId, &Arc<Clip>)>) {
        let is_same = match (&self.subject, active) {
            (Some(subject), Some((id, clip))) => {
                subject.id == id && Arc::ptr_eq(&subject.clip.motion, &clip.motion)
            }
            (None, None) => true,
            _ => false,
        };
        if is_same {
            return;
        }
        self.subject = active.map(|(id, clip)| Subject {
            id,
            clip: Arc::clone(clip),
            orders: clip.document.rotation_orders().into(),
            truth: Actor::new(Arc::clone(&clip.motion), self.style, figure_of(TRUTH)),
        });
        self.results.clear();
        self.marked = None;
        match &self.subject {
            Some(subject) => {
                let motion = &subject.clip.motion;
                self.transport
                    .load(motion.frame_count(), motion.frame_time_secs());
            }
            None => self.transport.load(0, 0.0),
        }
        self.start_anew();
        self.set_stage();
        self.reframe();
    }

    fn start_anew(&mut self) {
        self.generation += 1;
        self.given_up = false;
    }

    /// The clip that is compared.
    #[must_use]
    pub fn clip(&self) -> Option<&Arc<Clip>> {
        self.subject.as_ref().map(|subject| &subject.clip)
    }

    /// Every which frame is kept.
    #[must_use]
    pub fn every(&self) -> usize {
        self.every
    }

    /// Chooses every which frame is kept. What was worked out stays until there is better.
    pub fn set_every(&mut self, every: usize) {
        let every = every.clamp(*EVERY_RANGE.start(), *EVERY_RANGE.end());
        if self.every != every {
            self.every = every;
            self.start_anew();
        }
    }

    /// What is kept and filled in; `None` without frames.
    #[must_use]
    pub fn plan(&self) -> Option<FillPlan> {
        let frames = self.clip()?.frame_count();
        FillPlan::every(self.every, frames).ok()
    }

    /// Whether a method is compared.
    #[must_use]
    pub fn is_chosen(&self, method: FillMethod) -> bool {
        self.chosen.contains(&method)
    }

    /// Compares a method, or no longer.
    pub fn set_chosen(&mut self, method: FillMethod, is_chosen: bool) {
        if is_chosen {
            self.given_up = false;
            self.chosen.insert(method);
        } else {
            self.chosen.remove(&method);
            self.results.remove(&method);
            self.set_seen(method, false);
        }
    }

    /// Whether a method's figure is shown.
    #[must_use]
    pub fn is_seen(&self, method: FillMethod) -> bool {
        self.seen.contains(&method)
    }

    /// Shows a method's figure, or no longer.
    pub fn set_seen(&mut self, method: FillMethod, is_seen: bool) {
        let has_changed = match is_seen {
            true => self.seen.insert(method),
            false => self.seen.remove(&method),
        };
        if has_changed {
            self.set_stage();
        }
    }

    /// Whether the truth is shown.
    #[must_use]
    pub fn sees_truth(&self) -> bool {
        self.sees_truth
    }

    /// Shows the truth, or no longer.
    pub fn set_sees_truth(&mut self, sees_truth: bool) {
        if self.sees_truth != sees_truth {
            self.sees_truth = sees_truth;
            self.set_stage();
        }
    }

    /// What was worked out, in the order in which methods are listed. Numbers of another spacing of kept
    /// frames are told apart by [`is_stale`](Self::is_stale).
    #[must_use]
    pub fn results(&self) -> Vec<&Filled> {
        let all = offered().into_iter();
        all.filter_map(|method| self.results.get(&method)).collect()
    }

    /// Whether a result is of a choice that has changed since.
    #[must_use]
    pub fn is_stale(&self, filled: &Filled) -> bool {
        filled.generation != self.generation
    }

    /// The next piece of work, if nothing is being done.
    pub fn next_job(&mut self) -> Option<FillJob> {
        if self.running.is_some() || self.given_up {
            return None;
        }
        let subject = self.subject.as_ref()?;
        if subject.clip.frame_count() == 0 {
            return None;
        }
        let is_missing = |method: &FillMethod| {
            let result = self.results.get(method);
            self.chosen.contains(method) && result.is_none_or(|filled| self.is_stale(filled))
        };
        let method = offered().into_iter().find(is_missing)?;
        self.running = Some(method);
        Some(FillJob {
            generation: self.generation,
            motion: Arc::clone(&subject.clip.motion),
            orders: Arc::clone(&subject.orders),
            every: self.every,
            method,
            style: self.style,
        })
    }

    /// Takes in what was worked out; what nobody waits for any more is dropped.
    pub fn take(&mut self, filled: Option<Filled>) {
        self.running = None;
        let Some(filled) = filled else {
            // Nothing can be done about this clip.
            self.given_up = true;
            return;
        };
        if filled.generation == self.generation && self.chosen.contains(&filled.method) {
            let is_seen = self.seen.contains(&filled.method);
            self.results.insert(filled.method, filled);
            if is_seen {
                self.set_stage();
            }
        }
    }

    /// How much of the work is done, 0 to 1; `None` when nothing is left to do.
    #[must_use]
    pub fn progress(&self) -> Option<f32> {
        if self.given_up || self.subject.is_none() {
            return None;
        }
        let is_done = |method: &&FillMethod| {
            let result = self.results.get(method);
            result.is_some_and(|filled| !self.is_stale(filled))
        };
        let done = self.chosen.iter().filter(is_done).count();
        let total = self.chosen.len();
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let share = done as f32 / total.max(1) as f32;
        (done < total && self.clip().is_some_and(|clip| clip.frame_count() > 0)).then_some(share)
    }

    /// Gives up what is not done yet.
    pub fn cancel(&mut self) {
        self.generation += 1;
        for filled in self.results.values_mut() {
            if filled.generation + 1 == self.generation {
                filled.generation = self.generation;
            }
        }
        self.given_up = true;
    }

    /// Whether the work was given up before it was done.
    #[must_use]
    pub fn is_given_up(&self) -> bool {
        self.given_up
    }

    /// Does the work after all that was given up.
    pub fn resume(&mut self) {
        self.given_up = false;
    }

    /// Where the figures stand.
    #[must_use]
    pub fn arrangement(&self) -> Compare {
        self.arrangement
    }

    /// Chooses where the figures stand.
    pub fn set_arrangement(&mut self, arrangement: Compare) {
        if self.arrangement != arrangement {
            self.arrangement = arrangement;
            self.set_stage();
            self.reframe();
        }
    }

    /// Light or dark.
    pub fn set_look(&mut self, look: Look) {
        if self.look != look {
            self.look = look;
            self.set_stage();
        }
    }

    /// Goes to a frame, with a joint marked.
    pub fn go_to(&mut self, frame: usize, joint: Option<JointId>) {
        self.transport.pause();
        self.transport.go_to_frame(frame);
        self.marked = joint;
        self.version += 1;
    }

    /// The joint that is marked.
    #[must_use]
    pub fn marked(&self) -> Option<JointId> {
        self.marked
    }

    fn set_stage(&mut self) {
        let truth = self.subject.iter().filter(|_| self.sees_truth);
        let mut actors: Vec<Actor> = truth.map(|subject| subject.truth.clone()).collect();
        for method in offered() {
            if let Some(filled) = self
                .results
                .get(&method)
                .filter(|_| self.seen.contains(&method))
            {
                actors.push(filled.actor.clone());
            }
        }
        let arrangement = match actors.len() {
            0 | 1 => Arrangement::AsRecorded,
            _ => self.arrangement.to_render(),
        };
        let count = self.stage.actors().len();
        let options = StageOptions {
            style: self.style,
            theme: match self.look {
                Look::Light => Theme::light(),
                Look::Dark => Theme::dark(),
            },
            arrangement,
            ..StageOptions::default()
        };
        let has_other_count = count != actors.len();
        self.stage = Stage::new(actors, options);
        self.version += 1;
        if has_other_count && self.camera.is_framed() {
            self.reframe();
        }
    }

    /// The figures on their stage.
    #[must_use]
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The methods of the figures on the stage, in their order; the truth is none.
    #[must_use]
    pub fn on_stage(&self) -> Vec<Option<FillMethod>> {
        let truth = self
            .subject
            .iter()
            .filter(|_| self.sees_truth)
            .map(|_| None);
        let is_there =
            |method: &FillMethod| self.seen.contains(method) && self.results.contains_key(method);
        truth
            .chain(offered().into_iter().filter(is_there).map(Some))
            .collect()
    }

    /// A number that changes whenever what is on the stage does.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Tells the shape of the view, width over height.
    pub fn set_aspect(&mut self, aspect: f32) {
        let valid = aspect.is_finite() && aspect > 0.0;
        if valid && (aspect - self.aspect).abs() > 1e-3 {
            self.aspect = aspect;
            if self.camera.is_framed() {
                self.reframe();
            }
        }
    }

    /// Takes all figures into the picture, from where the camera looks now.
    pub fn reframe(&mut self) {
        self.camera.frame_all(&self.stage, self.aspect);
    }

    /// Looks from a named side.
    pub fn look_from(&mut self, view: View) {
        self.camera.look_from(view, &self.stage, self.aspect);
    }

    /// The camera now.
    #[must_use]
    pub fn view_camera(&self) -> Camera {
        let time = self.transport.time_secs();
        self.camera.orbit(&self.stage, time).camera()
    }

    /// The scene now.
    #[must_use]
    pub fn scene(&self) -> Scene {
        self.stage
            .scene_from(self.transport.time_secs(), self.view_camera())
    }

    /// The height that distances are told in parts of.
    #[must_use]
    pub fn height(&self) -> f64 {
        let height = self
            .clip()
            .map_or(0.0, |clip| f64::from(clip.skeleton().height()));
        if height > 0.0 { height } else { 1.0 }
    }

    /// The command that shows the same; `None` for a motion that no file holds.
    #[must_use]
    pub fn command(&self) -> Option<String> {
        let clip = self.clip()?;
        let name = match &clip.source {
            Source::File(path) => quoted(&path.display().to_string()),
            Source::Bytes => quoted(&clip.name),
            Source::Sample(name) => format!("sample:{name}"),
            Source::Scene(Some(path)) => quoted(&path.display().to_string()),
            Source::Scene(None) | Source::Made => return None,
        };
        let listed = offered()
            .into_iter()
            .filter(|method| self.chosen.contains(method));
        let words: Vec<String> = listed.map(|method| method.to_string()).collect();
        let mut line = format!("posekit inbetween {name} --keep {}", self.every);
        if !words.is_empty() {
            line.push_str(&format!(" --method {}", words.join(",")));
        }
        Some(line)
    }
}

/// A name as a shell takes it.
fn quoted(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    if !name.is_empty() && name.chars().all(is_plain) {
        name.to_owned()
    } else {
        format!("'{}'", name.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_is_listed_once() {
        let mut all = offered();
        assert_eq!(all.len(), Method::ALL.len() + 1);
        all.sort();
        all.dedup();
        assert_eq!(all.len(), Method::ALL.len() + 1);
        for usual in FillMethod::USUAL {
            assert!(all.contains(&usual));
        }
    }

    #[test]
    fn names_are_quoted_for_a_shell() {
        assert_eq!(quoted("a/b-1.bvh"), "a/b-1.bvh");
        assert_eq!(quoted("my walk.bvh"), "'my walk.bvh'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
