//! Euler angles: rotations as up to three turns about coordinate axes.
//!
//! An [`EulerOrder`] names the axes; the turns are *intrinsic* (each about the axes that the turns
//! before it have carried along) and multiply left to right with column vectors, so `ZXY` with the
//! angles `[z, x, y]` means `R = Rz(z) * Rx(x) * Ry(y)`. This is how motion files list rotation
//! channels. Read right to left, the same product is the extrinsic sequence about fixed axes.
//!
//! **Space and units.** The rotation maps child (body) coordinates to parent coordinates. Angles are
//! radians unless a name ends in `_deg`.
//!
//! **Method.** To a quaternion: the product of elementary quaternions. From a quaternion: the direct
//! formula of Bernardes and Viollet (2022, "Quaternion to Euler angles conversion: a direct, general
//! and computationally efficient method", `PLoS` ONE 17(11), doi:10.1371/journal.pone.0276302), with
//! the parametrisations of Shuster (1993, "A Survey of Attitude Representations", J. Astronautical
//! Sciences 41(4)). An order with fewer than three axes cannot make every rotation: there the angles
//! of the *nearest* rotation are found in closed form (for two axes it is the largest singular value
//! of a 2 by 2 matrix, which half angles give without iteration), and the angle that is left over is
//! reported.
//!
//! **Guarantees and degenerate inputs.**
//! - Every multiple of a unit quaternion is accepted, and `q` and `-q` give the same rotation. A zero
//!   quaternion gives zero angles; a non-finite one gives non-finite angles. Nothing panics.
//! - Angles of [`EulerOrder::from_quat`] lie in `[-pi, pi]`; the middle one of three in
//!   `[-pi/2, pi/2]` when the three axes differ (Tait-Bryan) and in `[0, pi]` when the first equals
//!   the last (proper Euler).
//! - *Gimbal lock*: at the ends of the middle angle's range only the sum or the difference of the
//!   other two is defined. Then the **last angle is set to zero** and
//!   [`EulerAngles::gimbal_lock`] is set; the rotation that is rebuilt is off by no more than
//!   `4e-12` rad. Short of the lock by `d` rad the first and last angles each carry an error of about
//!   `1e-16 / d` (`1e-7 / d` for a quaternion that was stored in `f32`), yet their errors cancel: the
//!   rebuilt rotation keeps full accuracy all the way.
//! - Neighbours that repeat (`XXY`) are one turn: the first of them gets the angle, the others zero.
//!
//! **Cost.** About one sine and cosine per axis one way, three `atan2` the other; no allocation.
//!
//! ```
//! use posekit::rotation::EulerOrder;
//!
//! let order: EulerOrder = "ZXY".parse()?;
//! let q = order.to_quat([0.3, -0.2, 1.1]);
//! let euler = order.from_quat(q);
//! assert!(!euler.gimbal_lock);
//! assert!((euler.angles_rad[2] - 1.1).abs() < 1e-12);
//! # Ok::<(), posekit::rotation::EulerOrderError>(())
//! ```

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt;
use core::str::FromStr;

use glam::DQuat;

use super::Axis;

/// Below this share of the quaternion's norm, a pair of components is noise and the half angle that
/// it would give is undefined. Rounding leaves about `1e-16` in such a pair, so the angle would still
/// be good to `1e-4` here; dropping it moves the rotation by at most four times this value.
const LOCK_SHARE: f64 = 1e-12;

/// A sequence of zero to three axes, the order in which elementary rotations are multiplied.
///
/// Every sequence is allowed: the twelve complete ones (six Tait-Bryan such as `ZXY`, six proper such
/// as `ZXZ`), incomplete ones of one or two axes, none at all, and ones with repeated neighbours.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EulerOrder {
    /// The axes; entries from `len` on are `X` so that derived equality is right.
    axes: [Axis; 3],
    len: u8,
}

/// Why a sequence is not an [`EulerOrder`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EulerOrderError {
    /// More than three axes: such a product can be composed but not extracted.
    #[error("expected at most 3 rotation axes, found {count}")]
    TooManyAxes {
        /// How many axes were given.
        count: usize,
    },
    /// A letter that names no axis.
    #[error("expected X, Y or Z as letter {} of a rotation order, found {letter:?}", index + 1)]
    UnknownAxis {
        /// The letter that was found.
        letter: char,
        /// Its index among the letters, from 0.
        index: usize,
    },
}

/// The angles of a rotation in some [`EulerOrder`], and how faithful they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerAngles {
    /// One angle per axis of the order, in radians; entries beyond the order's axes are zero.
    pub angles_rad: [f64; 3],
    /// Whether only the sum or difference of two of the angles was defined, so that the split between
    /// them is a convention (see the module's documentation).
    pub gimbal_lock: bool,
    /// The angle in `[0, pi]` between the rotation that was asked for and the one that these angles
    /// make: zero for an order of three axes, the unreachable rest for an incomplete order.
    pub residual_rad: f64,
}

impl EulerOrder {
    /// No axis: the identity.
    pub const NONE: Self = Self {
        axes: [Axis::X; 3],
        len: 0,
    };
    /// `Rx * Ry * Rz`.
    pub const XYZ: Self = Self::of_three(Axis::X, Axis::Y, Axis::Z);
    /// `Rx * Rz * Ry`.
    pub const XZY: Self = Self::of_three(Axis::X, Axis::Z, Axis::Y);
    /// `Ry * Rx * Rz`.
    pub const YXZ: Self = Self::of_three(Axis::Y, Axis::X, Axis::Z);
    /// `Ry * Rz * Rx`.
    pub const YZX: Self = Self::of_three(Axis::Y, Axis::Z, Axis::X);
    /// `Rz * Rx * Ry`, the order most motion files use.
    pub const ZXY: Self = Self::of_three(Axis::Z, Axis::X, Axis::Y);
    /// `Rz * Ry * Rx`.
    pub const ZYX: Self = Self::of_three(Axis::Z, Axis::Y, Axis::X);

    const fn of_three(first: Axis, second: Axis, third: Axis) -> Self {
        Self {
            axes: [first, second, third],
            len: 3,
        }
    }

    /// The order with these axes.
    ///
    /// # Errors
    ///
    /// [`EulerOrderError::TooManyAxes`] for more than three axes.
    pub fn new(axes: &[Axis]) -> Result<Self, EulerOrderError> {
        let mut order = Self::NONE;
        for &axis in axes {
            if order.len == 3 {
                return Err(EulerOrderError::TooManyAxes { count: axes.len() });
            }
            order.axes[usize::from(order.len)] = axis;
            order.len += 1;
        }
        Ok(order)
    }

    /// The axes, in the order of multiplication.
    pub fn axes(&self) -> &[Axis] {
        &self.axes[..usize::from(self.len)]
    }

    /// Whether these axes can make every rotation: three of them, no neighbours equal.
    pub fn is_complete(&self) -> bool {
        self.turns().len == 3
    }

    /// The rotation with these angles (radians, one per axis; further entries are ignored).
    pub fn to_quat(self, angles_rad: [f64; 3]) -> DQuat {
        compose_elementary(self.axes().iter().copied().zip(angles_rad))
    }

    /// The angles of `rotation` in this order, or of the nearest rotation that the order can make.
    pub fn from_quat(self, rotation: DQuat) -> EulerAngles {
        let turns = self.turns();
        let solution = turns.solve(rotation);
        turns.spread(&solution)
    }

    /// The angles of `rotation` that lie closest to `previous_rad`: of the two solutions that a
    /// complete order has, and all their shifts by full turns, the one with the least sum of squared
    /// differences. In gimbal lock the split between the first and last angle is chosen freely to
    /// the same end. Angles are not confined to one turn.
    ///
    /// Going through a motion frame by frame with the result of the frame before gives curves without
    /// flips wherever the rotation itself moves smoothly.
    pub fn from_quat_near(self, rotation: DQuat, previous_rad: [f64; 3]) -> EulerAngles {
        let turns = self.turns();
        let solution = turns.solve(rotation);
        let mut euler = turns.spread(&solution);
        if let Some(slope) = solution.lock {
            let (first, last) = (turns.slots[0], turns.slots[turns.len - 1]);
            turns.split_lock_near(&mut euler.angles_rad, slope, [first, last], previous_rad);
        }
        euler.angles_rad = self.closest_equivalent_rad(euler.angles_rad, previous_rad);
        euler
    }

    /// The triple nearest to `previous_rad` (least sum of squared differences) among all triples that
    /// make the same rotation as `angles_rad`: full turns on each angle and, for a complete order, the
    /// mirror solution that turns the outer axes by half a turn. Radians.
    pub fn closest_equivalent_rad(self, angles_rad: [f64; 3], previous_rad: [f64; 3]) -> [f64; 3] {
        self.closest_equivalent(angles_rad, previous_rad, PI)
    }

    /// As [`closest_equivalent_rad`](Self::closest_equivalent_rad), in degrees, so that values of a
    /// file are only ever moved by whole multiples of 180 and angles that need no move keep every
    /// digit.
    pub fn closest_equivalent_deg(self, angles_deg: [f64; 3], previous_deg: [f64; 3]) -> [f64; 3] {
        self.closest_equivalent(angles_deg, previous_deg, 180.0)
    }

    fn closest_equivalent(self, angles: [f64; 3], previous: [f64; 3], half_turn: f64) -> [f64; 3] {
        let direct = self.shifted_near(angles, previous, half_turn);
        let turns = self.turns();
        if turns.len != 3 {
            return direct;
        }
        let middle = if turns.is_proper() {
            -angles[1]
        } else {
            half_turn - angles[1]
        };
        let mirrored = [angles[0] + half_turn, middle, angles[2] + half_turn];
        let mirrored = self.shifted_near(mirrored, previous, half_turn);
        let distance = |candidate: &[f64; 3]| -> f64 {
            candidate
                .iter()
                .zip(previous)
                .map(|(a, b)| (a - b) * (a - b))
                .sum()
        };
        if distance(&mirrored) < distance(&direct) {
            mirrored
        } else {
            direct
        }
    }

    /// Each angle moved by full turns to the one nearest to `previous`; unused entries are kept.
    fn shifted_near(self, mut angles: [f64; 3], previous: [f64; 3], half_turn: f64) -> [f64; 3] {
        let full_turn = 2.0 * half_turn;
        for i in 0..self.axes().len() {
            let turn_count = ((previous[i] - angles[i]) / full_turn).round();
            // A jump from NaN or infinity has no nearest angle: such an entry stays as it is.
            if turn_count != 0.0 && turn_count.is_finite() {
                angles[i] += turn_count * full_turn;
            }
        }
        angles
    }

    /// The order with repeated neighbours merged.
    fn turns(self) -> Turns {
        let mut turns = Turns {
            axes: [Axis::X; 3],
            slots: [0; 3],
            len: 0,
        };
        for (slot, &axis) in self.axes().iter().enumerate() {
            if turns.len > 0 && turns.axes[turns.len - 1] == axis {
                continue;
            }
            turns.axes[turns.len] = axis;
            turns.slots[turns.len] = slot;
            turns.len += 1;
        }
        turns
    }
}

/// The product of elementary rotations, left to right: `(Z, a), (X, b)` gives `Rz(a) * Rx(b)`.
///
/// Takes any number of rotations, for files that list more channels than an [`EulerOrder`] holds.
/// Angles are radians; none at all is the identity.
pub fn compose_elementary(rotations: impl IntoIterator<Item = (Axis, f64)>) -> DQuat {
    rotations
        .into_iter()
        .fold(DQuat::IDENTITY, |product, (axis, angle_rad)| {
            let (s, c) = libm::sincos(0.5 * angle_rad);
            let DQuat { x, y, z, w } = product;
            match axis {
                Axis::X => {
                    DQuat::from_xyzw(x * c + w * s, y * c + z * s, z * c - y * s, w * c - x * s)
                }
                Axis::Y => {
                    DQuat::from_xyzw(x * c - z * s, y * c + w * s, z * c + x * s, w * c - y * s)
                }
                Axis::Z => {
                    DQuat::from_xyzw(x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s)
                }
            }
        })
}

/// An order without repeated neighbours, and where each of its turns sits in the original.
struct Turns {
    axes: [Axis; 3],
    slots: [usize; 3],
    len: usize,
}

/// Angles of the merged turns.
struct Solution {
    angles_rad: [f64; 3],
    /// In gimbal lock, the `slope` for which moving the last turn by `d` and the first by `slope * d`
    /// leaves the rotation as it is.
    lock: Option<f64>,
    residual_rad: f64,
}

impl Turns {
    fn is_proper(&self) -> bool {
        self.len == 3 && self.axes[0] == self.axes[2]
    }

    fn solve(&self, rotation: DQuat) -> Solution {
        let components = rotation.to_array();
        let at = |axis: Axis| components[axis.index()];
        let w = rotation.w;
        match self.len {
            0 => {
                let residual_rad = 2.0 * libm::atan2(rotation.xyz().length(), w.abs());
                Solution {
                    angles_rad: [0.0; 3],
                    lock: None,
                    residual_rad,
                }
            }
            1 => solve_one(rotation, at(self.axes[0])),
            2 => {
                let (third, parity) = third_axis(self.axes[0], self.axes[1]);
                solve_two(w, at(self.axes[0]), at(self.axes[1]), parity * at(third))
            }
            _ => {
                let (third, parity) = third_axis(self.axes[0], self.axes[1]);
                let (first, middle) = (at(self.axes[0]), at(self.axes[1]));
                let cross = parity * at(third);
                if self.is_proper() {
                    solve_proper(w, first, middle, cross)
                } else {
                    solve_tait_bryan(w, first, middle, cross, parity)
                }
            }
        }
    }

    fn spread(&self, solution: &Solution) -> EulerAngles {
        let mut angles_rad = [0.0; 3];
        for turn in 0..self.len {
            angles_rad[self.slots[turn]] = solution.angles_rad[turn];
        }
        EulerAngles {
            angles_rad,
            gimbal_lock: solution.lock.is_some(),
            residual_rad: solution.residual_rad,
        }
    }

    /// Moves along the free line of a gimbal lock to the point nearest to `previous`: what is fixed is
    /// `first - slope * last`, up to full turns, and the needed change is shared by both evenly.
    fn split_lock_near(
        &self,
        angles: &mut [f64; 3],
        slope: f64,
        [first, last]: [usize; 2],
        previous: [f64; 3],
    ) {
        let fixed = angles[first] - slope * angles[last];
        let change = wrap_angle(fixed - (previous[first] - slope * previous[last]));
        angles[first] = previous[first] + 0.5 * change;
        angles[last] = previous[last] - slope * 0.5 * change;
    }
}

/// The axis that is neither `first` nor `second`, and 1 if it points along `first x second`, else -1.
/// The two must differ.
fn third_axis(first: Axis, second: Axis) -> (Axis, f64) {
    let third = Axis::ALL[3 - first.index() - second.index()];
    let is_even = (first.index() + 1) % 3 == second.index();
    (third, if is_even { 1.0 } else { -1.0 })
}

/// The nearest turn about one axis is the twist about it; `along` is the component on the axis.
fn solve_one(rotation: DQuat, along: f64) -> Solution {
    let reachable = libm::hypot(rotation.w, along);
    let norm = rotation.length();
    let off_axis_sq = rotation.xyz().length_squared() - along * along;
    let residual_rad = 2.0 * libm::atan2(off_axis_sq.max(0.0).sqrt(), reachable);
    let angle = if reachable > LOCK_SHARE * norm {
        wrap_angle(2.0 * libm::atan2(along, rotation.w))
    } else {
        0.0
    };
    Solution {
        angles_rad: [angle, 0.0, 0.0],
        lock: None,
        residual_rad,
    }
}

/// Two turns `Ra(2A) Rb(2B)`. The cosine of half the angle to the rotation is
/// `((w + c) cos(A-B) + (a - b) sin(A-B) + (w - c) cos(A+B) + (a + b) sin(A+B)) / 2`, where `a`, `b`
/// and `c` are the quaternion's components on the first axis, the second and their cross product:
/// sum and difference are free of each other, so each takes its own best value.
fn solve_two(w: f64, a: f64, b: f64, c: f64) -> Solution {
    let difference_weight = libm::hypot(w + c, a - b);
    let sum_weight = libm::hypot(w - c, a + b);
    let mut difference = libm::atan2(a - b, w + c);
    let mut sum = libm::atan2(a + b, w - c);
    let floor = LOCK_SHARE * (difference_weight + sum_weight);
    let lock = if difference_weight <= floor {
        difference = sum;
        Some(-1.0)
    } else if sum_weight <= floor {
        sum = difference;
        Some(1.0)
    } else {
        None
    };
    // The squares of both singular values add up to the quaternion's squared norm, so the smaller
    // one is the sine of half the residual when the larger is its cosine.
    let residual_rad = 2.0
        * libm::atan2(
            (difference_weight - sum_weight).abs(),
            difference_weight + sum_weight,
        );
    let angles_rad = [
        wrap_angle(sum + difference),
        wrap_angle(sum - difference),
        0.0,
    ];
    Solution {
        angles_rad,
        lock,
        residual_rad,
    }
}

/// Three turns `Ra(alpha) Rb(beta) Ra(gamma)`, first and last about the same axis: the quaternion is
/// `w = cos(beta/2) cos(sum)`, `a = cos(beta/2) sin(sum)`, `b = sin(beta/2) cos(difference)`,
/// `c = sin(beta/2) sin(difference)` with half sum and half difference of `alpha` and `gamma`.
fn solve_proper(w: f64, a: f64, b: f64, c: f64) -> Solution {
    let cos_half = libm::hypot(w, a);
    let sin_half = libm::hypot(b, c);
    let middle = 2.0 * libm::atan2(sin_half, cos_half);
    let mut sum = libm::atan2(a, w);
    let mut difference = libm::atan2(c, b);
    let floor = LOCK_SHARE * libm::hypot(cos_half, sin_half);
    let lock = if sin_half <= floor {
        difference = sum;
        Some(-1.0)
    } else if cos_half <= floor {
        sum = difference;
        Some(1.0)
    } else {
        None
    };
    let angles_rad = [
        wrap_angle(sum + difference),
        middle,
        wrap_angle(sum - difference),
    ];
    Solution {
        angles_rad,
        lock,
        residual_rad: 0.0,
    }
}

/// Three turns about three axes. A quarter turn about the middle axis carries the last axis onto the
/// first (reversed when the order is even), so `R * Rb(pi/2)` is a proper sequence with the middle
/// angle a quarter turn larger and the last one's sign changed by the parity.
fn solve_tait_bryan(w: f64, a: f64, b: f64, c: f64, parity: f64) -> Solution {
    let mut solution = solve_proper(w - b, a - c, b + w, c + a);
    solution.angles_rad[1] -= FRAC_PI_2;
    solution.angles_rad[2] *= -parity;
    solution.lock = solution.lock.map(|slope| -parity * slope);
    solution
}

/// The same angle within `[-pi, pi]`.
fn wrap_angle(angle_rad: f64) -> f64 {
    if angle_rad.abs() <= PI {
        return angle_rad;
    }
    angle_rad - 2.0 * PI * (angle_rad / (2.0 * PI)).round()
}

impl fmt::Display for EulerOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.axes()
            .iter()
            .try_for_each(|axis| write!(f, "{}", axis.letter()))
    }
}

impl fmt::Debug for EulerOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "EulerOrder({self})")
    }
}

impl FromStr for EulerOrder {
    type Err = EulerOrderError;

    /// Reads letters such as `ZXY` or `zx`; the empty text is the empty order.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let count = text.chars().count();
        let mut order = Self::NONE;
        for (index, letter) in text.chars().enumerate() {
            let axis = match letter.to_ascii_uppercase() {
                'X' => Axis::X,
                'Y' => Axis::Y,
                'Z' => Axis::Z,
                _ => return Err(EulerOrderError::UnknownAxis { letter, index }),
            };
            if order.len == 3 {
                return Err(EulerOrderError::TooManyAxes { count });
            }
            order.axes[index] = axis;
            order.len += 1;
        }
        Ok(order)
    }
}
