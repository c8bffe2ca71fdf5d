//! Setting the stage: from what is open and how it is shown to actors in their places.

use std::sync::Arc;

use posekit::body::NoAnatomy;
use posekit::keyframe::edit::SAME_TIME_SECS;
use posekit::skeleton::JointId;
use posekit_render::stage::{
    Actor, Arrangement, AxesShown, GhostSide, Ghosts, KeyGhost, Labels, Stage, StageOptions,
    Trails, scale_beside,
};
use posekit_render::theme::{CharacterColors, Theme};

use super::{OpenClip, Session};
use crate::state::animate::Owner;
use crate::state::camera::ViewCamera;
use crate::state::clip::{Clip, rest_motion};
use crate::state::display::{Display, Look, PoseShown};
use crate::state::mode::Mode;
use crate::state::things::surroundings;

/// How many ghosts there are before and after the figure.
const GHOSTS_EACH_SIDE: usize = 3;

impl Session {
    pub(super) fn set_stage(&mut self) {
        if self.time_line().0 != self.transport.frame_count() {
            self.reload_time_line();
        }
        let time = self.transport.time_secs();
        self.set_colors();
        self.set_scales();
        let actors: Vec<Actor> = self.shown().map(|open| open.on_stage().clone()).collect();
        self.stage = Stage::new(actors, self.stage_options());
        if self.pose_shown == PoseShown::Rest {
            self.stage = self.stage_at_rest(time);
        }
        self.surround();
    }

    /// The stage with every figure at rest, where it stands in its motion at a time.
    fn stage_at_rest(&self, time_secs: f64) -> Stage {
        let placed = self.shown().zip(self.stage.places());
        let at_rest = placed.map(|(open, &place)| {
            let motion = rest_motion(open.on_stage().motion(), time_secs, place);
            let colors = CharacterColors::of(open.color);
            Actor::new(Arc::new(motion), self.display.style.to_render(), colors)
        });
        let options = StageOptions {
            arrangement: Arrangement::AsRecorded,
            ..self.stage_options()
        };
        Stage::new(at_rest.collect(), options)
    }

    /// The figures on the stage take the colours in the order in which they stand there, as those of
    /// `posekit render` do: one that is alone has the first.
    fn set_colors(&mut self) {
        let shown = self.clips.iter_mut().filter(|open| open.shown);
        for (color, open) in shown.enumerate() {
            if open.color != color {
                open.color = color;
                let colors = CharacterColors::of(color);
                open.actor.set_colors(colors);
                if let Some((_, actor)) = &mut open.scaled {
                    actor.set_colors(colors);
                }
            }
        }
    }

    /// The stage of the active clip's scene as a file of it is drawn: the figure alone, its body fitted to
    /// the motion as it is now, in the style and the theme of the view, nothing held or marked.
    #[must_use]
    pub fn shot_stage(&self) -> Stage {
        let open = self.clips.iter().find(|open| Some(open.id) == self.active);
        let actor = open.map(|open| actor_of(&open.clip, &self.display, 0));
        let of_view = self.stage_options();
        let options = StageOptions {
            style: of_view.style,
            theme: of_view.theme,
            ..StageOptions::default()
        };
        let mut stage = Stage::new(actor.into_iter().collect(), options);
        if let Some(authored) = self.authored() {
            stage.set_surroundings(surroundings(authored.scene()));
        }
        stage
    }

    /// The stage as it is seen, for a film of it: bodies are fitted to the motions as they are now, and
    /// nothing is held in a pose or a place that is not in the motion. Figures told in other units stand beside
    /// the first, as in pictures of `posekit render`.
    #[must_use]
    pub fn film_stage(&self) -> Stage {
        let mut stage = match self.pose_shown {
            PoseShown::Rest => self.stage.clone(),
            PoseShown::Motion => {
                let style = self.display.style.to_render();
                let actors = self.shown().map(|open| {
                    let motion = Arc::clone(open.actor.motion());
                    Actor::new(motion, style, CharacterColors::of(open.color))
                });
                let mut actors: Vec<Actor> = actors.collect();
                let kept = self.kept_in_films();
                if let Some(stature) = actors.get(kept).map(Actor::stature) {
                    let beside = |actor: Actor| actor.beside(stature).0;
                    actors = actors.into_iter().map(beside).collect();
                }
                Stage::new(actors, self.stage_options())
            }
        };
        let of_scene = self.authored().map(|it| surroundings(it.scene()));
        stage.set_surroundings(of_scene.unwrap_or_default());
        stage
    }

    /// Which of the figures on the stage keeps its unit of length in films: the one that stands among the things
    /// of its scene, or else the first, as in pictures of the command.
    fn kept_in_films(&self) -> usize {
        let of_scene = self.active_actor().filter(|_| self.authored().is_some());
        of_scene.unwrap_or(0)
    }

    /// The camera of the view, for the film's stage: what is seen keeps the unit of the active clip, and the film
    /// may have another.
    #[must_use]
    pub fn film_camera(&self, stage: &Stage) -> ViewCamera {
        let mut camera = self.camera.clone();
        let statures = |stage: &Stage| -> Vec<f32> {
            let actors = stage.actors().iter();
            actors.map(Actor::stature).collect()
        };
        let (seen, filmed) = (statures(&self.stage), statures(stage));
        if seen == filmed {
            return camera;
        }
        if camera.is_framed() {
            camera.frame_again(stage, self.aspect);
            return camera;
        }
        let kept = self.kept_in_films();
        let sizes = seen.get(kept).zip(filmed.get(kept));
        if let Some(factor) = sizes.and_then(|(seen, filmed)| scale_beside(*seen, *filmed)) {
            camera.scale(factor);
        }
        camera
    }

    /// Figures that are told in another unit of length than the active one are made as tall as it
    /// is, or one would be a giant to the other. The active one is what is worked on, in its own unit.
    fn set_scales(&mut self) {
        let active = self.clips.iter().find(|open| Some(open.id) == self.active);
        let Some(stature) = active.map(|open| open.actor.stature()) else {
            return;
        };
        for open in self.clips.iter_mut().filter(|open| open.shown) {
            let Some(factor) = scale_beside(open.actor.stature(), stature) else {
                open.scaled = None;
                continue;
            };
            if open
                .scaled
                .as_ref()
                .is_none_or(|(before, _)| *before != factor)
            {
                let (actor, factor) = open.actor.clone().beside(stature);
                open.scaled = factor.map(|factor| (factor, actor));
            }
        }
    }

    fn stage_options(&self) -> StageOptions {
        let display = &self.display;
        StageOptions {
            style: display.style.to_render(),
            axes: if display.axes {
                AxesShown::Joints
            } else {
                AxesShown::None
            },
            theme: match self.look {
                Look::Light => Theme::light(),
                Look::Dark => Theme::dark(),
            },
            follow: display.follow.to_render(),
            arrangement: match self.shown().count() {
                // A figure alone stands where its file says: coordinates are those of the grid.
                0 | 1 => Arrangement::AsRecorded,
                _ => display.compare.to_render(),
            },
            trails: display.trails.then(|| Trails {
                joints: self.trailed_joints(),
                seconds: display.trail_secs,
            }),
            ghosts: (display.ghosts && !self.has_key_ghosts()).then_some(Ghosts {
                every_frames: display.ghost_every_frames.max(1),
                before: GHOSTS_EACH_SIDE,
                after: GHOSTS_EACH_SIDE,
            }),
            labels: if display.labels {
                Labels::All
            } else {
                Labels::None
            },
            ..StageOptions::default()
        }
    }

    /// Whether ghosts stand at the keys around the time shown.
    fn has_key_ghosts(&self) -> bool {
        let display = &self.display;
        display.ghosts
            && display.ghosts_at_keys
            && self.mode() == Mode::Animate
            && self.authored().is_some()
    }

    /// Ghosts at the keys around the time shown follow it, the keys, and what is selected.
    pub(super) fn follow_key_ghosts(&mut self) {
        let is_keyed = self.has_key_ghosts();
        let has_others = self.stage.options().ghosts.is_some();
        if self.display.ghosts && is_keyed == has_others {
            self.set_stage();
        }
        let wanted = if is_keyed {
            self.key_ghosts()
        } else {
            Vec::new()
        };
        let Some(index) = self.active_actor() else {
            return;
        };
        let now = self.stage.actors().get(index).map(Actor::key_ghosts);
        if now != Some(&wanted[..]) {
            self.stage
                .edit_actor(index, |actor| actor.set_key_ghosts(wanted));
            self.stage_version += 1;
        }
    }

    /// The neighbouring keys of the selected joints, or where those have none of all.
    fn key_ghosts(&self) -> Vec<KeyGhost> {
        let Some(authored) = self.authored() else {
            return Vec::new();
        };
        let times_of = |joints: &[JointId]| {
            let lanes = joints.iter().copied().map(Owner::Joint);
            let tracks = lanes
                .flat_map(Owner::lanes)
                .filter_map(|lane| authored.track(lane));
            let times = tracks.flat_map(|track| track.times_secs().to_vec());
            times.collect::<Vec<f64>>()
        };
        let mut times = times_of(&self.selection);
        if times.is_empty() {
            times = times_of(&authored.skeleton().joints().collect::<Vec<_>>());
        }
        times.sort_by(f64::total_cmp);
        times.dedup_by(|a, b| (*a - *b).abs() <= SAME_TIME_SECS);
        let [start, end] = authored.scene().range_secs;
        times.retain(|time| *time >= start - SAME_TIME_SECS && *time <= end + SAME_TIME_SECS);
        let now = self.scene_secs();
        let count = self.display.ghost_keys.max(1);
        let ghost = |side: GhostSide| {
            move |(rank, time): (usize, &f64)| KeyGhost {
                time_secs: time - start,
                side,
                distance: rank as f32 / count as f32,
            }
        };
        let before = times
            .iter()
            .rev()
            .filter(|time| **time < now - SAME_TIME_SECS);
        let after = times.iter().filter(|time| **time > now + SAME_TIME_SECS);
        let before = before.take(count).enumerate().map(ghost(GhostSide::Before));
        let after = after.take(count).enumerate().map(ghost(GhostSide::After));
        before.chain(after).collect()
    }

    /// The selected joints, or the ends of the limbs.
    fn trailed_joints(&self) -> Vec<JointId> {
        if !self.selection.is_empty() {
            return self.selection.clone();
        }
        self.active_clip().map_or_else(Vec::new, |clip| {
            let skeleton = clip.skeleton();
            let is_last = |joint: &JointId| {
                let children = skeleton.children(*joint);
                !skeleton.is_end_site(*joint)
                    && children.iter().all(|&child| skeleton.is_end_site(child))
            };
            skeleton.joints().filter(is_last).take(8).collect()
        })
    }
}

impl Session {
    /// The figure of a clip anew, as of a motion of other joints.
    pub(super) fn remake_actor(&mut self, index: usize) {
        let open = &mut self.clips[index];
        open.actor = actor_of(&open.clip, &self.display, open.color);
    }
}

impl OpenClip {
    /// The figure as it stands among the others.
    pub(super) fn on_stage(&self) -> &Actor {
        self.scaled.as_ref().map_or(&self.actor, |(_, actor)| actor)
    }

    /// By how much the figure was made larger to stand beside the active one; 1 for as it is.
    #[must_use]
    pub fn scale(&self) -> f32 {
        self.scaled.as_ref().map_or(1.0, |(factor, _)| *factor)
    }

    /// Why the figure is drawn as bones although bodies are shown.
    #[must_use]
    pub fn doubt(&self) -> Option<NoAnatomy> {
        self.actor.doubt()
    }
}

pub(super) fn actor_of(clip: &Clip, display: &Display, color: usize) -> Actor {
    let colors = CharacterColors::of(color);
    Actor::new(Arc::clone(&clip.motion), display.style.to_render(), colors)
}
