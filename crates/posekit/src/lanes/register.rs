//! The arithmetic of the batch paths, written once for every width of register.
//!
//! A [`Kernel`] is a batch job that does not know the width; [`run`] gives it the widest [`Register`]
//! that the processor has: AVX's eight lanes where they are found at run time, otherwise four, which
//! every target has (SSE2, NEON, WebAssembly's SIMD, or plain code). Widths differ in speed only:
//! every operation rounds once, in the order written here, so all give the same bits.
//!
//! Whatever a kernel does with registers must be `#[inline(always)]`, down to loops and not closures:
//! a call in between would be compiled without AVX and pass registers through memory.

use std::ops::{Add, Mul, Sub};

use glam::{Quat, Vec3};
use wide::f32x4;

use super::{LANES, Lanes, QuatLanes, Vec3Lanes};

/// Several lanes in one register.
pub(crate) trait Register:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// How many lanes one register holds; a divisor of [`LANES`].
    const COUNT: usize;

    /// How many registers hold all lanes.
    const PARTS: usize = LANES / Self::COUNT;

    /// The same value in every lane.
    fn splat(value: f32) -> Self;

    /// The lanes of one part.
    fn load(lanes: &Lanes, part: usize) -> Self;

    /// Writes the lanes of one part.
    fn store(self, lanes: &mut Lanes, part: usize);

    /// One column of eight rows, added to `base` in `f64` and rounded.
    fn sums<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        part: usize,
        base: f64,
    ) -> Self;

    /// One column of eight rows, angles in degrees, as turns less the nearest whole number of turns:
    /// [`turn_fraction`] of each.
    fn turn_fractions<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        part: usize,
    ) -> Self;
}

/// A batch job over registers of any width.
pub(crate) trait Kernel {
    /// Does the job; `#[inline(always)]`, as everything in it that touches registers.
    fn run<R: Register>(self);
}

/// Runs a kernel on the widest registers there are.
pub(crate) fn run(kernel: impl Kernel) {
    #[cfg(target_arch = "x86_64")]
    if super::avx::is_detected() {
        super::avx::run(kernel);
        return;
    }
    kernel.run::<f32x4>();
}

/// Runs a kernel on the registers that every target has.
#[cfg(test)]
pub(crate) fn run_portable(kernel: impl Kernel) {
    kernel.run::<f32x4>();
}

/// Three registers: vectors.
#[derive(Clone, Copy)]
pub(crate) struct Vec3Registers<R> {
    pub(crate) x: R,
    pub(crate) y: R,
    pub(crate) z: R,
}

impl<R: Register> Vec3Registers<R> {
    #[inline(always)]
    pub(crate) fn splat(v: Vec3) -> Self {
        Self {
            x: R::splat(v.x),
            y: R::splat(v.y),
            z: R::splat(v.z),
        }
    }

    #[inline(always)]
    pub(crate) fn load(lanes: &Vec3Lanes, part: usize) -> Self {
        Self {
            x: R::load(&lanes.x, part),
            y: R::load(&lanes.y, part),
            z: R::load(&lanes.z, part),
        }
    }

    #[inline(always)]
    pub(crate) fn store(self, lanes: &mut Vec3Lanes, part: usize) {
        self.x.store(&mut lanes.x, part);
        self.y.store(&mut lanes.y, part);
        self.z.store(&mut lanes.z, part);
    }

    #[inline(always)]
    pub(crate) fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

/// Four registers: quaternions.
#[derive(Clone, Copy)]
pub(crate) struct QuatRegisters<R> {
    pub(crate) x: R,
    pub(crate) y: R,
    pub(crate) z: R,
    pub(crate) w: R,
}

impl<R: Register> QuatRegisters<R> {
    #[inline(always)]
    pub(crate) fn splat(q: Quat) -> Self {
        Self {
            x: R::splat(q.x),
            y: R::splat(q.y),
            z: R::splat(q.z),
            w: R::splat(q.w),
        }
    }

    #[inline(always)]
    pub(crate) fn load(lanes: &QuatLanes, part: usize) -> Self {
        Self {
            x: R::load(&lanes.x, part),
            y: R::load(&lanes.y, part),
            z: R::load(&lanes.z, part),
            w: R::load(&lanes.w, part),
        }
    }

    #[inline(always)]
    pub(crate) fn store(self, lanes: &mut QuatLanes, part: usize) {
        self.x.store(&mut lanes.x, part);
        self.y.store(&mut lanes.y, part);
        self.z.store(&mut lanes.z, part);
        self.w.store(&mut lanes.w, part);
    }

    /// The quaternion product: `other` applied first, then `self`. Summed in the order that
    /// forward kinematics of one pose uses too, so that both give the same bits.
    #[inline(always)]
    pub(crate) fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self {
            x: a.w * b.x + (a.x * b.w + a.y * b.z) - a.z * b.y,
            y: a.w * b.y + (a.y * b.w + a.z * b.x) - a.x * b.z,
            z: a.w * b.z + (a.z * b.w + a.x * b.y) - a.y * b.x,
            w: a.w * b.w - (a.x * b.x + a.y * b.y) - a.z * b.z,
        }
    }

    /// Rotates a vector: `v + 2 w (u x v) + 2 u x (u x v)` with `u` the vector part.
    #[inline(always)]
    pub(crate) fn rotate(self, v: Vec3Registers<R>) -> Vec3Registers<R> {
        let Self { x, y, z, w } = self;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let tx = y2 * v.z - z2 * v.y;
        let ty = z2 * v.x - x2 * v.z;
        let tz = x2 * v.y - y2 * v.x;
        Vec3Registers {
            x: v.x + w * tx + (y * tz - z * ty),
            y: v.y + w * ty + (z * tx - x * tz),
            z: v.z + w * tz + (x * ty - y * tx),
        }
    }
}

/// `1.5 * 2^52`: adding and subtracting it rounds a small `f64` to the nearest integer, ties to even.
pub(super) const ROUNDING_MAGIC: f64 = 6_755_399_441_055_744.0;

/// Turns in a degree.
pub(super) const TURNS_PER_DEGREE: f64 = 1.0 / 360.0;

/// The angle in turns, less the nearest whole number of turns.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the value is within half a turn; f32 is wanted"
)]
fn turn_fraction(angle_deg: f64) -> f32 {
    let turns = angle_deg * TURNS_PER_DEGREE;
    (turns - ((turns + ROUNDING_MAGIC) - ROUNDING_MAGIC)) as f32
}

/// The portable width. Two of them do eight lanes, one after the other, so that what a joint needs
/// stays in the sixteen registers of SSE2.
impl Register for f32x4 {
    const COUNT: usize = 4;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self::splat(value)
    }

    #[inline(always)]
    fn load(lanes: &Lanes, part: usize) -> Self {
        Self::new(lanes.0.as_chunks::<4>().0[part])
    }

    #[inline(always)]
    fn store(self, lanes: &mut Lanes, part: usize) {
        lanes.0.as_chunks_mut::<4>().0[part] = self.to_array();
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "poses are f32")]
    fn sums<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        part: usize,
        base: f64,
    ) -> Self {
        let [a, b, c, d] = rows.as_chunks::<4>().0[part];
        Self::new([
            (base + a[column]) as f32,
            (base + b[column]) as f32,
            (base + c[column]) as f32,
            (base + d[column]) as f32,
        ])
    }

    #[inline(always)]
    fn turn_fractions<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        part: usize,
    ) -> Self {
        let [a, b, c, d] = rows.as_chunks::<4>().0[part];
        Self::new([
            turn_fraction(a[column]),
            turn_fraction(b[column]),
            turn_fraction(c[column]),
            turn_fraction(d[column]),
        ])
    }
}
