//! Eight Euler rotations at a time: from angles in degrees to quaternions in SIMD lanes.
//!
//! The batch path from a motion's channel rows to local rotations. A lane is one frame; all lanes share
//! the joint, and so the axes.
//!
//! **Space and units.** Angles are degrees in `f64`, as a file gives them; quaternions map child to
//! parent coordinates, `f32`, and are equal to the scalar path's ([`compose_elementary`]) **up to
//! sign**: one more full turn of a channel changes a quaternion's sign and nothing else, so the
//! reduction drops whole turns of the angle, half turns of the half angle, and needs no quadrants.
//!
//! **Method.** The turn count `angle / 360` less its nearest integer is exact in `f64`, within half a
//! turn either way, and is rounded to `f32` once. On that range `sin(pi f)` and `cos(pi f)` are
//! polynomials of degree 9 and 10 in `f`, minimax fits (linear programming on a Chebyshev grid,
//! coefficients rounded to `f32` one by one and the rest refitted) whose own errors, `8e-9` and `1e-9`,
//! are a tenth of the rounding. Elementary quaternions have two components that are not zero, so three
//! of them are multiplied in 12 products instead of 32. One axis, two, three different ones and the proper
//! Euler orders (ZXZ) are each done in their own frame, as if they began with X and Y, and only the
//! components are renamed at the end; other sequences are multiplied axis after axis.
//!
//! **Guarantees and degenerate inputs.** Absolute error of sine and cosine at most `1.7e-7` for angles
//! up to a million turns (the `f64` angle's own resolution takes over beyond). A lane's result depends
//! on its own angles only. No fused multiply-add and no platform's trigonometry: the same bits
//! everywhere. Angles beyond `2^51` turns and non-finite ones give components that mean nothing, or
//! NaN; nothing panics.
//!
//! **Cost.** See `benches/rotation.rs`.
//!
//! [`compose_elementary`]: super::compose_elementary

use glam::Quat;

use super::Axis;
use crate::lanes::{self, Kernel, LANES, QuatLanes, QuatRegisters, Register};

/// `sin(pi f) = f * P(f^2)`, lowest power first.
const SIN_COEFFICIENTS: [f32; 5] = [
    3.141_592_5,
    -5.167_702,
    2.549_957_8,
    -0.597_625_4,
    0.076_433_81,
];

/// `cos(pi f) = P(f^2)`, lowest power first.
const COS_COEFFICIENTS: [f32; 6] = [
    1.0,
    -4.934_802,
    4.058_705_3,
    -1.335_161_6,
    0.234_683_77,
    -0.023_963_874,
];

/// The rotations of many frames of one joint, from rows of Euler angles in degrees: each row holds one
/// angle per axis, and `R = R_axes[0] * R_axes[1] * ...` as in [`EulerOrder`](super::EulerOrder), for any
/// number of axes.
///
/// The quaternions are unit to rounding (`1e-6`) and map child to parent coordinates. Their signs are
/// not those of [`compose_elementary`](super::compose_elementary): full turns are dropped from the
/// angles, so they may be opposite. Angles keep full accuracy up to a million turns. Non-finite angles
/// give NaN components.
///
/// # Panics
///
/// When `rows_deg` does not hold `axes.len()` angles for each of `rotations`.
pub fn quats_from_euler_rows_deg(axes: &[Axis], rows_deg: &[f64], rotations: &mut [Quat]) {
    let width = axes.len();
    assert_eq!(
        rows_deg.len(),
        width * rotations.len(),
        "expected {width} angles for each of {} rotations",
        rotations.len(),
    );
    if width == 0 {
        rotations.fill(Quat::IDENTITY);
        return;
    }
    lanes::run(EulerRows {
        axes,
        rows_deg,
        rotations,
    });
}

/// What [`quats_from_euler_rows_deg`] does, on registers of any width.
struct EulerRows<'a> {
    axes: &'a [Axis],
    rows_deg: &'a [f64],
    rotations: &'a mut [Quat],
}

impl Kernel for EulerRows<'_> {
    #[inline(always)]
    fn run<R: Register>(self) {
        let width = self.axes.len();
        let mut block = QuatLanes::IDENTITY;
        let mut row_blocks = self.rows_deg.chunks_exact(LANES * width);
        let mut quat_blocks = self.rotations.chunks_exact_mut(LANES);
        for (rows, quats) in (&mut row_blocks).zip(&mut quat_blocks) {
            set_quats_from_rows_deg::<R>(self.axes, rows, width, &mut block);
            write_lanes(&block, quats);
        }
        let (rows, quats) = (row_blocks.remainder(), quat_blocks.into_remainder());
        if !quats.is_empty() {
            let rows = repeat_last_row(rows, width);
            set_quats_from_rows_deg::<R>(self.axes, &rows, width, &mut block);
            write_lanes(&block, quats);
        }
    }
}

/// Eight rows from fewer, but at least one: every lane must hold something, and the frames that are
/// not there hold what the last one does.
pub(crate) fn repeat_last_row(rows: &[f64], width: usize) -> Vec<f64> {
    let last = &rows[rows.len() - width..];
    let mut padded = rows.to_vec();
    while padded.len() < LANES * width {
        padded.extend_from_slice(last);
    }
    padded
}

/// Lane by lane, as many as there are quaternions.
#[inline(always)]
fn write_lanes(lanes: &QuatLanes, quats: &mut [Quat]) {
    for (lane, quat) in quats.iter_mut().enumerate() {
        *quat = lanes.lane(lane);
    }
}

/// The product of the elementary rotations about `axes`, left to right, in eight lanes, up to sign.
///
/// The frames lie `stride` values apart in `rows`: the joint's first rotation channel at the start, the
/// others right after it, degrees. Any number of axes is allowed, repeated ones too; none gives the
/// identity.
///
/// # Panics
///
/// When `rows` is shorter than seven strides and the channels of one row.
#[inline(always)]
pub(crate) fn set_quats_from_rows_deg<R: Register>(
    axes: &[Axis],
    rows: &[f64],
    stride: usize,
    quats: &mut QuatLanes,
) {
    match *axes {
        [axis] => one_axis::<R>(axis, &row_starts(rows, stride), quats),
        [first, second] if first != second => {
            two_axes::<R>(Frame::new(first, second), &row_starts(rows, stride), quats);
        }
        [first, second, third] if first != second && second != third => {
            let frame = Frame::new(first, second);
            if third == first {
                proper_euler::<R>(frame, &row_starts(rows, stride), quats);
            } else {
                tait_bryan::<R>(frame, &row_starts(rows, stride), quats);
            }
        }
        _ => any_sequence::<R>(axes, rows, stride, quats),
    }
}

/// Where the joint's channels begin in each of eight rows.
#[inline(always)]
pub(crate) fn row_starts<const N: usize>(rows: &[f64], stride: usize) -> [&[f64; N]; LANES] {
    let mut starts = [&[0.0; N]; LANES];
    for (lane, start) in starts.iter_mut().enumerate() {
        *start = rows[lane * stride..]
            .first_chunk()
            .expect("a row holds the joint's channels");
    }
    starts
}

/// The axes of a sequence, as if it began with X and Y.
#[derive(Clone, Copy)]
struct Frame {
    first: Axis,
    second: Axis,
    third: Axis,
    /// Whether the third axis is the cross product of the first two and not its opposite, against
    /// which turns and components change sign.
    is_right_handed: bool,
}

impl Frame {
    #[inline(always)]
    fn new(first: Axis, second: Axis) -> Self {
        let third = Axis::ALL[3 - first.index() - second.index()];
        Self {
            first,
            second,
            third,
            is_right_handed: (first.index() + 1) % 3 == second.index(),
        }
    }
}

/// `Rx(a)`, renamed.
#[inline(always)]
fn one_axis<R: Register>(axis: Axis, rows: &[&[f64; 1]; LANES], quats: &mut QuatLanes) {
    *quats = QuatLanes::IDENTITY;
    for part in 0..R::PARTS {
        let (sin, cos) = half_angle_sin_cos(R::turn_fractions(rows, 0, part));
        sin.store(quats.component_mut(axis), part);
        cos.store(&mut quats.w, part);
    }
}

/// `Rx(a) * Ry(b)`, renamed.
#[inline(always)]
fn two_axes<R: Register>(frame: Frame, rows: &[&[f64; 2]; LANES], quats: &mut QuatLanes) {
    for part in 0..R::PARTS {
        let (sin_a, cos_a) = half_angle_sin_cos(R::turn_fractions(rows, 0, part));
        let (sin_b, cos_b) = half_angle_sin_cos(R::turn_fractions(rows, 1, part));
        let on_third = sin_a * sin_b;
        let components = QuatRegisters {
            x: sin_a * cos_b,
            y: cos_a * sin_b,
            z: if frame.is_right_handed {
                on_third
            } else {
                R::splat(0.0) - on_third
            },
            w: cos_a * cos_b,
        };
        store_renamed(components, frame, quats, part);
    }
}

/// `Rx(a) * Ry(b) * Rz(c)`, renamed. The signs are spelled out: negating would cost operations of
/// its own.
#[inline(always)]
fn tait_bryan<R: Register>(frame: Frame, rows: &[&[f64; 3]; LANES], quats: &mut QuatLanes) {
    for part in 0..R::PARTS {
        let (sin_a, cos_a) = half_angle_sin_cos(R::turn_fractions(rows, 0, part));
        let (sin_b, cos_b) = half_angle_sin_cos(R::turn_fractions(rows, 1, part));
        let (x, y) = (sin_a * cos_b, cos_a * sin_b);
        let (z, w) = (sin_a * sin_b, cos_a * cos_b);
        let (sin_c, cos_c) = half_angle_sin_cos(R::turn_fractions(rows, 2, part));
        let components = if frame.is_right_handed {
            QuatRegisters {
                x: x * cos_c + y * sin_c,
                y: y * cos_c - x * sin_c,
                z: w * sin_c + z * cos_c,
                w: w * cos_c - z * sin_c,
            }
        } else {
            QuatRegisters {
                x: x * cos_c - y * sin_c,
                y: y * cos_c + x * sin_c,
                z: w * sin_c - z * cos_c,
                w: w * cos_c + z * sin_c,
            }
        };
        store_renamed(components, frame, quats, part);
    }
}

/// `Rx(a) * Ry(b) * Rx(c)`, renamed: turns by `a + c` and `a - c` about X, weighted by the cosine and
/// the sine of `b`.
#[inline(always)]
fn proper_euler<R: Register>(frame: Frame, rows: &[&[f64; 3]; LANES], quats: &mut QuatLanes) {
    for part in 0..R::PARTS {
        let (sin_a, cos_a) = half_angle_sin_cos(R::turn_fractions(rows, 0, part));
        let (sin_c, cos_c) = half_angle_sin_cos(R::turn_fractions(rows, 2, part));
        let (sin_cos, cos_sin) = (sin_a * cos_c, cos_a * sin_c);
        let (cos_cos, sin_sin) = (cos_a * cos_c, sin_a * sin_c);
        let (sin_b, cos_b) = half_angle_sin_cos(R::turn_fractions(rows, 1, part));
        let components = QuatRegisters {
            x: (sin_cos + cos_sin) * cos_b,
            y: (cos_cos + sin_sin) * sin_b,
            z: if frame.is_right_handed {
                (sin_cos - cos_sin) * sin_b
            } else {
                (cos_sin - sin_cos) * sin_b
            },
            w: (cos_cos - sin_sin) * cos_b,
        };
        store_renamed(components, frame, quats, part);
    }
}

#[inline(always)]
fn store_renamed<R: Register>(
    components: QuatRegisters<R>,
    frame: Frame,
    quats: &mut QuatLanes,
    part: usize,
) {
    components.x.store(quats.component_mut(frame.first), part);
    components.y.store(quats.component_mut(frame.second), part);
    components.z.store(quats.component_mut(frame.third), part);
    components.w.store(&mut quats.w, part);
}

/// Any axes, one after the other.
#[inline(always)]
fn any_sequence<R: Register>(axes: &[Axis], rows: &[f64], stride: usize, quats: &mut QuatLanes) {
    for part in 0..R::PARTS {
        let mut product = QuatRegisters::<R>::splat(Quat::IDENTITY);
        for (channel, &axis) in axes.iter().enumerate() {
            let rows: [&[f64; 1]; LANES] = row_starts(&rows[channel..], stride);
            let (sin, cos) = half_angle_sin_cos(R::turn_fractions(&rows, 0, part));
            product = turned_about(product, axis, sin, cos);
        }
        product.store(quats, part);
    }
}

/// The product of a quaternion and the elementary one about `axis`.
#[inline(always)]
fn turned_about<R: Register>(q: QuatRegisters<R>, axis: Axis, s: R, c: R) -> QuatRegisters<R> {
    let QuatRegisters { x, y, z, w } = q;
    let (x, y, z, w) = match axis {
        Axis::X => (x * c + w * s, y * c + z * s, z * c - y * s, w * c - x * s),
        Axis::Y => (x * c - z * s, y * c + w * s, z * c + x * s, w * c - y * s),
        Axis::Z => (x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s),
    };
    QuatRegisters { x, y, z, w }
}

/// Sine and cosine of *half* of each angle, given in turns less whole turns; both with the same sign
/// changed when the angle was an odd number of turns away from the range of half a turn either way.
#[inline(always)]
fn half_angle_sin_cos<R: Register>(turn_fraction: R) -> (R, R) {
    let u = turn_fraction * turn_fraction;
    (
        turn_fraction * polynomial(u, &SIN_COEFFICIENTS),
        polynomial(u, &COS_COEFFICIENTS),
    )
}

/// Horner's rule, lowest power first. A plain loop: `array::map` is not always inlined, and a call here
/// spills every register.
#[inline(always)]
fn polynomial<R: Register, const N: usize>(u: R, coefficients: &[f32; N]) -> R {
    let mut sum = R::splat(coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * u + R::splat(coefficient);
    }
    sum
}
