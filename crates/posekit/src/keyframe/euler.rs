//! Euler curves: a rotation as three angles, each a curve of its own.
//!
//! **Space and units.** Degrees, since whole turns and the numbers that people type are exact in them; the
//! angles of a key stand in the order's sequence (see [`EulerOrder`]), and may be of any size: 720 is two
//! turns.
//!
//! **Method.** Every angle is interpolated as a number is ([`Track`]): straight lines, Hermite and Bezier
//! curves with tangents and handles of its own, Catmull and Rom's cubic for `Squad`. The orientation at a time
//! is made of the three angles there, multiplied in the order. This is what Blender's XYZ Euler and the other
//! rotation modes of its kind do, and Maya's independent Euler curves.
//!
//! **Guarantees.** A turn goes as far and as often as its angles say. Beyond the keys, a cycle with offset adds
//! the angles from the first to the last key, so that a spin goes on. Near gimbal lock two of the angles turn
//! about one axis; the curves stay what they are.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::extrapolation::Extrapolation;
use super::track::Track;
use crate::rotation::EulerOrder;

/// Why an order has no Euler curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EulerTrackError {
    /// Some rotations have no angles in it.
    #[error("Euler curves need an order of three axes, no two neighbours alike, not {order}")]
    Incomplete {
        /// The order.
        order: EulerOrder,
    },
}

/// A rotation as three curves of angles, in an order of axes.
///
/// ```
/// use glam::{DQuat, DVec3};
/// use posekit::keyframe::{EulerTrack, Extrapolation, Interpolation, Keyframe, Track};
/// use posekit::rotation::{EulerOrder, angle_between};
///
/// let keys = [(0.0, 0.0), (4.0, 360.0)].map(|(time, turn)| {
///     Keyframe::new(time, DVec3::new(0.0, 0.0, turn), Interpolation::Linear)
/// });
/// let spin = EulerTrack::new(EulerOrder::XYZ, Track::new(keys.to_vec(), Extrapolation::Hold)?)?;
/// let quarter = DQuat::from_rotation_z(90_f64.to_radians());
/// assert!(angle_between(spin.sample(1.0), quarter) < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EulerTrack {
    order: EulerOrder,
    angles_deg: Track<DVec3>,
}

impl EulerTrack {
    /// Euler curves of an order: the angles of each key in its sequence, in degrees.
    ///
    /// # Errors
    /// [`EulerTrackError`] when the order cannot make every rotation.
    pub fn new(order: EulerOrder, angles_deg: Track<DVec3>) -> Result<Self, EulerTrackError> {
        if !order.is_complete() {
            return Err(EulerTrackError::Incomplete { order });
        }
        Ok(Self { order, angles_deg })
    }

    /// The order of the axes: one of twelve.
    pub fn order(&self) -> EulerOrder {
        self.order
    }

    /// The angles in degrees, in the order's sequence.
    pub fn angles_deg(&self) -> &Track<DVec3> {
        &self.angles_deg
    }

    /// The same order with other curves.
    #[must_use]
    pub fn with_angles_deg(&self, angles_deg: Track<DVec3>) -> Self {
        Self {
            order: self.order,
            angles_deg,
        }
    }

    /// The rotation at a time in seconds, a unit quaternion. Its sign follows the angles: it does not jump
    /// where they do not.
    pub fn sample(&self, time_secs: f64) -> DQuat {
        quat_of_deg(self.order, self.angles_deg.sample(time_secs))
    }

    /// The angles, in degrees, of a rotation at a time: of all that make it those nearest to the curves there.
    pub fn angles_near_deg(&self, rotation: DQuat, time_secs: f64) -> DVec3 {
        angles_near_deg(self.order, rotation, self.angles_deg.sample(time_secs))
    }
}

/// The rotation of angles in degrees.
pub(super) fn quat_of_deg(order: EulerOrder, angles_deg: DVec3) -> DQuat {
    order.to_quat(angles_deg.to_array().map(f64::to_radians))
}

/// The angles of a rotation in degrees that are nearest to others.
pub(super) fn angles_near_deg(order: EulerOrder, rotation: DQuat, near_deg: DVec3) -> DVec3 {
    let near = near_deg.to_array().map(f64::to_radians);
    let angles = order.from_quat_near(rotation, near).angles_rad;
    DVec3::from_array(angles.map(f64::to_degrees))
}

/// How a rotation is keyed. Tracks are shared: a copy costs a pointer.
#[derive(Clone, Debug, PartialEq)]
pub enum RotationTrack {
    /// Quaternions: the short way from key to key, no whole turns, no gimbal lock.
    Quaternion(Arc<Track<DQuat>>),
    /// Euler curves: three angles that turn as far as they say.
    Euler(Arc<EulerTrack>),
}

/// Does the same with the track of either mode.
macro_rules! of_either {
    ($value:expr, $track:ident => $does:expr) => {
        match $value {
            Self::Quaternion($track) => $does,
            Self::Euler(euler) => {
                let $track = euler.angles_deg();
                $does
            }
        }
    };
}

impl RotationTrack {
    /// The rotation at a time in seconds, a unit quaternion.
    pub fn sample(&self, time_secs: f64) -> DQuat {
        match self {
            Self::Quaternion(track) => track.sample(time_secs),
            Self::Euler(track) => track.sample(time_secs),
        }
    }

    /// The times of the keys in seconds, in rising order.
    pub fn times_secs(&self) -> &[f64] {
        of_either!(self, track => track.times_secs())
    }

    /// How many keys there are: at least one.
    pub fn key_count(&self) -> usize {
        self.times_secs().len()
    }

    /// The times of the first and the last key, in seconds.
    pub fn range_secs(&self) -> [f64; 2] {
        of_either!(self, track => [track.start_secs(), track.end_secs()])
    }

    /// How it goes on before its first and after its last key.
    pub fn beyond(&self) -> [Extrapolation; 2] {
        of_either!(self, track => [track.before(), track.after()])
    }

    /// The order of its angles, of Euler curves.
    pub fn order(&self) -> Option<EulerOrder> {
        self.as_euler().map(|track| track.order())
    }

    /// The track of quaternions, if it is one.
    pub fn as_quaternion(&self) -> Option<&Arc<Track<DQuat>>> {
        match self {
            Self::Quaternion(track) => Some(track),
            Self::Euler(_) => None,
        }
    }

    /// The Euler curves, if it is those.
    pub fn as_euler(&self) -> Option<&Arc<EulerTrack>> {
        match self {
            Self::Euler(track) => Some(track),
            Self::Quaternion(_) => None,
        }
    }
}

impl From<Track<DQuat>> for RotationTrack {
    fn from(track: Track<DQuat>) -> Self {
        Self::Quaternion(Arc::new(track))
    }
}

impl From<Arc<Track<DQuat>>> for RotationTrack {
    fn from(track: Arc<Track<DQuat>>) -> Self {
        Self::Quaternion(track)
    }
}

impl From<EulerTrack> for RotationTrack {
    fn from(track: EulerTrack) -> Self {
        Self::Euler(Arc::new(track))
    }
}

impl From<Arc<EulerTrack>> for RotationTrack {
    fn from(track: Arc<EulerTrack>) -> Self {
        Self::Euler(track)
    }
}
