//! Curves: a channel or a derived quantity of the selected joints over time.

use posekit::motion::Channel;
use posekit::skeleton::JointId;

use super::clip::{Clip, index_to_f64};
use super::readout::{speed, turn_speed};

/// A curve has at most this many points; of more frames the lowest and the highest in each stretch
/// are kept, so that no spike is lost.
const MOST_POINTS: usize = 4000;

/// What is plotted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The rotation channels as the file has them, degrees.
    #[default]
    Rotation,
    /// The position channels as the file has them.
    Translation,
    /// The position in the world.
    Position,
    /// The height over the floor.
    Height,
    /// The speed in the world.
    Speed,
    /// How fast it turns.
    TurnSpeed,
}

impl Quantity {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 6] = [
        Self::Rotation,
        Self::Translation,
        Self::Position,
        Self::Height,
        Self::Speed,
        Self::TurnSpeed,
    ];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rotation => "Rotation channels",
            Self::Translation => "Position channels",
            Self::Position => "World position",
            Self::Height => "Height over the floor",
            Self::Speed => "Speed",
            Self::TurnSpeed => "Turning speed",
        }
    }

    /// The unit shown.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Rotation => "\u{b0}",
            Self::Translation | Self::Position | Self::Height => "",
            Self::Speed => "/s",
            Self::TurnSpeed => "\u{b0}/s",
        }
    }
}

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The joint and what is plotted of it.
    pub name: String,
    /// Which colour: 0, 1, 2 for X, Y, Z where it is one of them.
    pub color: usize,
    /// Seconds and values.
    pub points: Vec<[f64; 2]>,
}

/// The curves of a quantity of joints.
#[must_use]
pub fn curves(clip: &Clip, joints: &[JointId], quantity: Quantity, floor: f32) -> Vec<Curve> {
    let joint_count = clip.skeleton().joint_count();
    let joints = joints.iter().filter(|joint| joint.index() < joint_count);
    let mut curves: Vec<Curve> = joints
        .flat_map(|&joint| curves_of(clip, joint, quantity, floor))
        .collect();
    if matches!(
        quantity,
        Quantity::Height | Quantity::Speed | Quantity::TurnSpeed
    ) {
        // One curve a joint: each its own colour.
        for (index, curve) in curves.iter_mut().enumerate() {
            curve.color = index + 2;
        }
    }
    curves
}

fn curves_of(clip: &Clip, joint: JointId, quantity: Quantity, floor: f32) -> Vec<Curve> {
    let name = clip.skeleton().unique_name(joint);
    let frame_secs = |frame: usize| index_to_f64(frame) * clip.motion.frame_time_secs();
    let sampled = |label: &str, color: usize, value: &dyn Fn(usize) -> f64| Curve {
        name: format!("{name} {label}").trim_end().to_owned(),
        color,
        points: thin((0..clip.frame_count()).map(|frame| [frame_secs(frame), value(frame)])),
    };
    match quantity {
        Quantity::Rotation | Quantity::Translation => {
            channel_curves(clip, joint, quantity, &sampled)
        }
        Quantity::Position => ["X", "Y", "Z"]
            .iter()
            .enumerate()
            .map(|(axis, label)| {
                sampled(label, axis, &|frame| {
                    clip.global.position(frame, joint)[axis].into()
                })
            })
            .collect(),
        Quantity::Height => vec![sampled("", 0, &|frame| {
            f64::from(clip.global.position(frame, joint).y - floor)
        })],
        Quantity::Speed => vec![sampled("", 0, &|frame| {
            speed(clip, joint, frame_secs(frame)).unwrap_or(0.0)
        })],
        Quantity::TurnSpeed => vec![sampled("", 0, &|frame| {
            turn_speed(clip, joint, frame_secs(frame)).unwrap_or(0.0)
        })],
    }
}

/// Makes a curve of a name, a colour index and a value for every frame.
type Sampled<'a> = dyn Fn(&str, usize, &dyn Fn(usize) -> f64) -> Curve + 'a;

fn channel_curves(
    clip: &Clip,
    joint: JointId,
    quantity: Quantity,
    sampled: &Sampled<'_>,
) -> Vec<Curve> {
    let document = &clip.document;
    let columns = document.joint_columns(joint.index());
    let channels = document.joints[joint.index()].channels.iter().zip(columns);
    channels
        .filter(|(channel, _)| {
            matches!(channel, Channel::Rotation(_)) == (quantity == Quantity::Rotation)
        })
        .map(|(channel, column)| {
            let (Channel::Rotation(axis) | Channel::Position(axis)) = channel;
            sampled(channel.name(), *axis as usize, &|frame| {
                document.row(frame)[column]
            })
        })
        .collect()
}

/// At most about [`MOST_POINTS`] of the points, the extremes among them.
fn thin(points: impl ExactSizeIterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    if points.len() <= MOST_POINTS {
        return points.collect();
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 2);
    let all: Vec<[f64; 2]> = points.collect();
    let mut kept = Vec::with_capacity(MOST_POINTS);
    for points in all.chunks(stretch) {
        let by_value = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        if let (Some(low), Some(high)) = (
            points.iter().min_by(by_value),
            points.iter().max_by(by_value),
        ) {
            let (first, second) = if low[0] <= high[0] {
                (low, high)
            } else {
                (high, low)
            };
            kept.push(*first);
            kept.push(*second);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_spikes() {
        let points = (0..100_000).map(|i| [f64::from(i), if i == 77_777 { 9.0 } else { 0.0 }]);
        let thinned = thin(points);
        assert!(thinned.len() <= MOST_POINTS);
        assert!(thinned.contains(&[77_777.0, 9.0]));
        assert!(thinned.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}
