//! One way between two orientations.

use glam::{DMat3, DQuat, DVec3};

use super::method::Method;
use crate::keyframe::{Extrapolation, Interpolation, Keyframe, Track};
use crate::rotation::{EulerOrder, exp, log, matrix_from_quat, nlerp, quat_from_matrix, slerp};

/// Two orientations to get from and to, and the keys around them, which squad looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// Where it starts.
    pub start: DQuat,
    /// Where it ends.
    pub end: DQuat,
    /// The key before the start, as far before it as the end is after it.
    pub before: Option<DQuat>,
    /// The key after the end, as far after it.
    pub after: Option<DQuat>,
}

impl Ends {
    /// Two orientations and nothing around them.
    pub fn new(start: DQuat, end: DQuat) -> Self {
        Self {
            start,
            end,
            before: None,
            after: None,
        }
    }
}

/// What a method makes in between: a matrix, which is a rotation for the methods that deserve it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// It maps body coordinates to the parent's.
    pub matrix: DMat3,
}

impl Blend {
    /// 1 for a rotation; the factor by which volumes change.
    pub fn determinant(&self) -> f64 {
        self.matrix.determinant()
    }

    /// How far the axes are from right angles to each other: the largest of the three differences, in
    /// degrees. NaN where an axis has no length.
    pub fn shear_deg(&self) -> f64 {
        let [x, y, z] = [self.matrix.x_axis, self.matrix.y_axis, self.matrix.z_axis];
        let off = |a: DVec3, b: DVec3| {
            let lengths = a.length() * b.length();
            libm::asin((a.dot(b) / lengths).clamp(-1.0, 1.0))
                .abs()
                .to_degrees()
        };
        [off(x, y), off(y, z), off(z, x)]
            .into_iter()
            .fold(0.0, |most: f64, angle| {
                if angle.is_nan() || most.is_nan() {
                    f64::NAN
                } else {
                    most.max(angle)
                }
            })
    }

    /// The rotation nearest to it; `None` where there is none, which half turns of a matrix can make.
    pub fn rotation(&self) -> Option<DQuat> {
        quat_from_matrix(&self.matrix).ok()
    }
}

/// A method made ready for two orientations.
#[derive(Clone, Debug)]
pub struct Between(Prepared);

#[derive(Clone, Debug)]
enum Prepared {
    Slerp([DQuat; 2]),
    /// The start, and the rotation vector of the way in its own space, up to a whole turn long.
    RawSlerp(DQuat, DVec3),
    Nlerp([DQuat; 2]),
    RawLerp([DQuat; 2]),
    Matrix([DMat3; 2]),
    RotationVector([DVec3; 2]),
    Euler(EulerOrder, [DVec3; 2]),
    Squad(Option<Track<DQuat>>, [DQuat; 2]),
}

impl Between {
    /// Prepares a method for two unit quaternions.
    pub fn new(method: Method, ends: &Ends) -> Self {
        let pair = [ends.start, ends.end];
        Self(match method {
            Method::Slerp => Prepared::Slerp(pair),
            Method::RawSlerp => {
                Prepared::RawSlerp(ends.start, way_as_given(ends.start.conjugate() * ends.end))
            }
            Method::Nlerp => Prepared::Nlerp(pair),
            Method::RawLerp => {
                let end = if ends.start.dot(ends.end) < 0.0 {
                    -ends.end
                } else {
                    ends.end
                };
                Prepared::RawLerp([ends.start, end])
            }
            Method::Matrix => Prepared::Matrix(pair.map(matrix_from_quat)),
            Method::RotationVector => {
                let start = log(ends.start);
                Prepared::RotationVector([start, nearest_vector(log(ends.end), start)])
            }
            Method::Euler(order) => {
                let start = order.from_quat(ends.start).angles_rad;
                let end = order.from_quat_near(ends.end, start).angles_rad;
                Prepared::Euler(order, [start, end].map(DVec3::from_array))
            }
            Method::Squad => Prepared::Squad(squad_track(ends), pair),
        })
    }

    /// As [`new`](Self::new) for Euler angles that are known already: an end's angles may have been
    /// chosen near those of the key before it. Radians.
    pub fn euler(order: EulerOrder, start_rad: [f64; 3], end_rad: [f64; 3]) -> Self {
        Self(Prepared::Euler(
            order,
            [start_rad, end_rad].map(DVec3::from_array),
        ))
    }

    /// What lies at a share of the way: 0 is the start, 1 the end.
    pub fn at(&self, t: f64) -> Blend {
        let matrix = match &self.0 {
            Prepared::RawLerp([start, end]) => {
                let chord = *start * (1.0 - t) + *end * t;
                // A quaternion of another length turns v to q v q*, and scales it by its square.
                let square = chord.length_squared();
                if square > 0.0 {
                    matrix_from_quat(chord) * square
                } else {
                    DMat3::ZERO
                }
            }
            Prepared::Matrix([start, end]) => *start * (1.0 - t) + *end * t,
            _ => matrix_from_quat(self.rotation_at(t)),
        };
        Blend { matrix }
    }

    /// The rotation at a share of the way; for the methods that make none, the nearest one, and where
    /// there is none, that of the nearer end.
    pub fn rotation_at(&self, t: f64) -> DQuat {
        match &self.0 {
            Prepared::Slerp([start, end]) => slerp(*start, *end, t),
            Prepared::RawSlerp(start, way) => *start * exp(*way * t),
            Prepared::Nlerp([start, end]) | Prepared::RawLerp([start, end]) => {
                nlerp(*start, *end, t)
            }
            Prepared::Matrix([start, end]) => {
                let nearer = if t < 0.5 { start } else { end };
                let nearest = quat_from_matrix(&(*start * (1.0 - t) + *end * t));
                nearest
                    .or_else(|_| quat_from_matrix(nearer))
                    .unwrap_or_default()
            }
            Prepared::RotationVector([start, end]) => exp(start.lerp(*end, t)),
            Prepared::Euler(order, [start, end]) => order.to_quat(start.lerp(*end, t).to_array()),
            Prepared::Squad(Some(track), _) => track.sample(t),
            Prepared::Squad(None, [start, end]) => slerp(*start, *end, t),
        }
    }
}

/// The rotation vector of a quaternion whose sign counts: longer than half a turn where its scalar part
/// is negative. A whole turn has no axis; X is as good as any.
fn way_as_given(relative: DQuat) -> DVec3 {
    let vector = relative.xyz();
    let angle = 2.0 * libm::atan2(vector.length(), relative.w);
    vector.try_normalize().unwrap_or(DVec3::X) * angle
}

/// A track of the ends at 0 and 1 and the keys around them at -1 and 2.
fn squad_track(ends: &Ends) -> Option<Track<DQuat>> {
    let times = [-1.0, 0.0, 1.0, 2.0];
    let values = [ends.before, Some(ends.start), Some(ends.end), ends.after];
    let keys = times
        .into_iter()
        .zip(values)
        .filter_map(|(time, value)| Some(Keyframe::new(time, value?, Interpolation::Squad)));
    Track::new(keys.collect(), Extrapolation::Hold).ok()
}

/// Of the vectors of one rotation (whole turns more or less about its axis), the one nearest to another
/// vector.
fn nearest_vector(vector: DVec3, other: DVec3) -> DVec3 {
    let Some(axis) = vector.try_normalize() else {
        return vector;
    };
    let turns = ((other.dot(axis) - vector.length()) / std::f64::consts::TAU).round();
    vector + axis * (turns * std::f64::consts::TAU)
}
