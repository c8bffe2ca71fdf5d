//! When each foot stands on the floor, and where the floor is.
//!
//! The floor is the height at which the lowest foot joint is most often: the middle of the narrowest
//! interval that holds [`FLOOR_SHARE`] of the frames, so that neither flights nor feet that sink
//! move it. A foot joint is low when it is near its own usual lowest height (an ankle never touches
//! the floor) and near the floor's; a foot is planted while one of its low joints moves slower than a
//! swinging foot does, with hysteresis. A figure that slides has no such foot: the figure stands on
//! something, so while every foot is fast, the slowest one that is low and hardly rises or sinks is
//! planted, however fast it is along the floor. A foot that swings low past one that stands is not.
//! How far a foot slides from one frame to the next is the way of the low joint that moves least: a
//! foot that rolls or pivots does not slide.

use glam::Vec3;

use super::statistics::{densest, median, most_frequent};
use super::{CheckConfig, Figure, whole_up};
use crate::motion::GlobalMotion;
use crate::skeleton::JointId;

/// The share of all frames in which a figure stands, at least. Runners stand in half of them.
const FLOOR_SHARE: f64 = 0.3;

/// A foot that is this much faster than twice its median speed on the floor is landing or leaving, in
/// heights per second; feet that stand still in good captures move with up to 0.1.
const LANDING_SPEED: f64 = 0.05;

/// No foot that carries a figure slides faster than this, in heights per second: that of a sprinter on
/// the spot. A figure that is elsewhere in the next frame is faster.
const CARRYING_SPEED_MAX: f64 = 4.0;

/// A fast foot carries the figure for at least so many steps.
const CARRYING_STEPS_MIN: usize = 3;

/// The share of the frames below a foot joint's usual lowest height: a foot stands for longer, and
/// sinks for less, than that.
const LOW_SHARE: f64 = 0.15;

/// A run of frames in which a foot is planted.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Which of [`Figure::feet`].
    pub foot: usize,
    /// The joint of the foot that it stands on: mostly the one that moves least.
    pub joint: JointId,
    /// The first frame.
    pub first: usize,
    /// The last frame.
    pub last: usize,
    /// How far it moves along the floor in between, in file units, without the steps at both ends in
    /// which it lands and leaves.
    pub slide: Vec3,
    /// How many steps `slide` is made of; at least one.
    pub slide_steps: usize,
}

/// Where the floor is and how the feet stand on it.
#[derive(Clone, Debug, PartialEq)]
pub struct FloorContacts {
    /// The height of the floor, in file units.
    pub floor: f64,
    /// The lowest joint of each foot in each frame, in file units: foot after foot.
    pub lowest: Vec<Vec<f64>>,
    /// All contacts, foot after foot, in order of time.
    pub contacts: Vec<Contact>,
}

/// Finds the floor and when the feet stand on it. `None` for a figure without feet or height, a
/// motion of less than two frames, or one without a frame time.
pub fn floor_contacts(
    global: &GlobalMotion,
    figure: &Figure,
    config: &CheckConfig,
) -> Option<FloorContacts> {
    let has_time = global.frame_time_secs() > 0.0 && global.frame_count() > 1;
    if figure.feet.is_empty() || figure.height <= 0.0 || !has_time {
        return None;
    }
    let tracks: Vec<FootTrack> = (0..figure.feet.len())
        .map(|foot| FootTrack::new(global, figure, foot))
        .collect();
    let lowest: Vec<Vec<f64>> = tracks.iter().map(FootTrack::lowest).collect();
    let mut lowest_of_all: Vec<f64> = (0..global.frame_count())
        .map(|frame| {
            lowest
                .iter()
                .map(|foot| foot[frame])
                .fold(f64::MAX, f64::min)
        })
        .collect();
    let floor = densest(&mut lowest_of_all, FLOOR_SHARE);
    let limits = Limits::new(global.frame_time_secs(), figure.height, config);
    let steps: Vec<Vec<FootStep>> = tracks
        .iter()
        .map(|track| track.steps(floor, &limits))
        .collect();
    let slowest: Vec<f64> = (0..global.frame_count() - 1)
        .map(|step| {
            let lengths = steps.iter().map(|foot| foot[step].length());
            lengths.fold(f64::MAX, f64::min)
        })
        .collect();
    let mut contacts = Vec::new();
    for (foot, steps) in steps.iter().enumerate() {
        contacts.extend(planted(foot, steps, &slowest, &limits));
    }
    Some(FloorContacts {
        floor,
        lowest,
        contacts,
    })
}

/// The ways of one foot's joints: joint after joint, all frames of each.
struct FootTrack {
    joints: Vec<(JointId, Vec<Vec3>)>,
}

impl FootTrack {
    fn new(global: &GlobalMotion, figure: &Figure, foot: usize) -> Self {
        let way = |&joint| {
            let frames = 0..global.frame_count();
            let places = frames.map(|frame| global.position(frame, joint));
            (joint, places.collect())
        };
        Self {
            joints: figure.feet[foot].joints.iter().map(way).collect(),
        }
    }

    /// The height of the lowest joint in each frame.
    fn lowest(&self) -> Vec<f64> {
        let mut lowest = vec![f64::MAX; self.joints[0].1.len()];
        for (_, way) in &self.joints {
            for (lowest, position) in lowest.iter_mut().zip(way) {
                *lowest = lowest.min(f64::from(position.y));
            }
        }
        lowest
    }

    /// How the foot moves in each step from one frame to the next.
    fn steps(&self, floor: f64, limits: &Limits) -> Vec<FootStep> {
        let mut steps = vec![FootStep::default(); self.joints[0].1.len().saturating_sub(1)];
        for (joint, way) in &self.joints {
            let low_below = usual_lowest(way, floor) + limits.low;
            let is_low = |position: Vec3| f64::from(position.y) <= low_below;
            for (step, pair) in steps.iter_mut().zip(way.windows(2)) {
                if !(is_low(pair[0]) && is_low(pair[1])) {
                    continue;
                }
                let moved = pair[1] - pair[0];
                let along = moved * Vec3::new(1.0, 0.0, 1.0);
                if step
                    .least
                    .is_none_or(|(_, least)| along.length() < least.length())
                {
                    step.least = Some((*joint, along));
                }
                let length = f64::from(along.length());
                if f64::from(moved.y).abs() <= limits.rise {
                    step.level = step.level.min(length);
                }
            }
        }
        steps
    }
}

/// A foot's step from one frame to the next.
#[derive(Clone, Debug)]
struct FootStep {
    /// The low joint that moves least, and its way along the floor; `None` where no joint is low
    /// before and after it.
    least: Option<(JointId, Vec3)>,
    /// How far the low joint moves along the floor that moves least among those that hardly rise
    /// or sink; `f64::MAX` where there is none.
    level: f64,
}

impl Default for FootStep {
    fn default() -> Self {
        Self {
            least: None,
            level: f64::MAX,
        }
    }
}

impl FootStep {
    fn length(&self) -> f64 {
        self.least
            .map_or(f64::MAX, |(_, way)| f64::from(way.length()))
    }
}

/// The thresholds in file units and frames.
struct Limits {
    low: f64,
    rise: f64,
    enter: f64,
    leave: f64,
    landing: f64,
    carrying: f64,
    shortest: usize,
}

impl Limits {
    fn new(frame_time_secs: f64, height: f64, config: &CheckConfig) -> Self {
        let per_step = height * frame_time_secs;
        Self {
            low: config.contact_height_heights * height,
            rise: config.contact_vertical_speed * per_step,
            enter: config.contact_enter_speed * per_step,
            leave: config.contact_leave_speed * per_step,
            landing: LANDING_SPEED * per_step,
            carrying: CARRYING_SPEED_MAX * per_step,
            shortest: whole_up(config.contact_secs_min / frame_time_secs).max(2),
        }
    }
}

/// The height that a foot joint has when it stands: low, but not below the floor.
fn usual_lowest(way: &[Vec3], floor: f64) -> f64 {
    let mut heights: Vec<f64> = way.iter().map(|position| f64::from(position.y)).collect();
    let place = super::whole(LOW_SHARE * heights.len() as f64).min(heights.len() - 1);
    let low = *heights.select_nth_unstable_by(place, f64::total_cmp).1;
    low.max(floor)
}

/// The contacts of a foot whose steps are known, and how far the slowest of all feet moves in each.
fn planted(foot: usize, steps: &[FootStep], slowest: &[f64], limits: &Limits) -> Vec<Contact> {
    let carries = carrying(steps, slowest, limits);
    let mut contacts = Vec::new();
    let mut step = 0;
    while step < steps.len() {
        let first = step;
        let mut sure_steps = 0;
        while step < steps.len() && (steps[step].length() <= limits.leave || carries[step]) {
            sure_steps += usize::from(steps[step].length() <= limits.enter || carries[step]);
            step += 1;
        }
        if sure_steps >= 1 && step - first >= limits.shortest {
            let least = steps[first..step].iter().filter_map(|step| step.least);
            let (joints, ways): (Vec<JointId>, Vec<Vec3>) = least.unzip();
            let standing = standing_part(&ways, limits.landing);
            let joint = most_frequent(joints.into_iter());
            contacts.extend(joint.map(|joint| Contact {
                foot,
                joint,
                first,
                last: step,
                slide: standing.iter().copied().sum(),
                slide_steps: standing.len(),
            }));
        }
        step = step.max(first + 1);
    }
    contacts
}

/// The steps in which a foot carries the figure although it is fast. The figure stands on something:
/// while no foot is slow, the slowest one does. A step or two are a figure that jumps elsewhere.
fn carrying(steps: &[FootStep], slowest: &[f64], limits: &Limits) -> Vec<bool> {
    let mut carries: Vec<bool> = steps
        .iter()
        .zip(slowest)
        .map(|(step, &slowest)| {
            slowest > limits.enter && step.level <= slowest.min(limits.carrying)
        })
        .collect();
    for run in carries.chunk_by_mut(|a, b| a == b) {
        if run.len() < CARRYING_STEPS_MIN {
            run.fill(false);
        }
    }
    carries
}

/// A contact's steps without those at both ends in which the foot still lands or already leaves: the
/// ones that exceed twice the median of the contact by more than `landing`.
fn standing_part(ways: &[Vec3], landing: f64) -> &[Vec3] {
    let lengths: Vec<f64> = ways.iter().map(|way| f64::from(way.length())).collect();
    let limit = 2.0 * median(&mut lengths.clone()) + landing;
    let stands = |length: &f64| *length <= limit;
    let first = lengths.iter().position(stands).unwrap_or(0);
    let last = lengths.iter().rposition(stands).unwrap_or(0);
    &ways[first..=last]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At 30 frames a second, a figure 1 unit tall.
    fn limits() -> Limits {
        Limits::new(1.0 / 30.0, 1.0, &CheckConfig::default())
    }

    /// A low foot that moves steadily along X, in heights a second.
    fn steady(speed: f32, step_count: usize) -> Vec<FootStep> {
        let way = speed / 30.0 * Vec3::X;
        let step = FootStep {
            least: Some((JointId::new(3), way)),
            level: f64::from(way.length()),
        };
        vec![step; step_count]
    }

    #[test]
    fn the_slowest_foot_carries_a_figure_that_slides() {
        for speed in [0.3, 0.6, 2.0] {
            let steps = steady(speed, 6);
            let slowest: Vec<f64> = steps.iter().map(FootStep::length).collect();
            let contacts = planted(0, &steps, &slowest, &limits());
            assert_eq!(contacts.len(), 1, "{speed}");
            assert_eq!((contacts[0].first, contacts[0].last), (0, 6));
            assert!((contacts[0].slide.x - speed / 5.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_foot_that_swings_low_past_one_that_stands_is_not_planted() {
        assert_eq!(planted(0, &steady(1.5, 6), &[0.0; 6], &limits()), []);
    }

    #[test]
    fn a_figure_that_jumps_elsewhere_is_not_carried() {
        for (speed, step_count) in [(1.5, 2), (12.0, 6)] {
            let steps = steady(speed, step_count);
            let slowest: Vec<f64> = steps.iter().map(FootStep::length).collect();
            assert_eq!(planted(0, &steps, &slowest, &limits()), []);
        }
    }
}
