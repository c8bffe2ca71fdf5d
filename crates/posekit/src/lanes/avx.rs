//! Eight lanes in one register, where the processor has AVX.
#![allow(
    unsafe_code,
    reason = "vector instructions that need AVX; the tests in motion::same_bits prove that they \
              give the portable path's bits"
)]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use super::register::{Kernel, ROUNDING_MAGIC, Register, TURNS_PER_DEGREE};
use super::{LANES, Lanes};

/// Eight lanes.
///
/// SAFETY, of everything below: values of this type, and calls of its functions, exist only in a
/// kernel that [`run`] started, which is after AVX was found; the type is private to this module.
#[derive(Clone, Copy)]
struct Avx(__m256);

/// Whether the processor has AVX and the operating system keeps its registers.
pub(super) fn is_detected() -> bool {
    is_x86_feature_detected!("avx")
}

/// Runs a kernel on AVX registers.
///
/// # Panics
/// If there is no AVX.
pub(super) fn run(kernel: impl Kernel) {
    assert!(is_detected(), "AVX was found before it is used");
    // SAFETY: AVX was found.
    unsafe { run_with_avx(kernel) }
}

/// The kernel and all that it inlines are compiled for AVX here.
#[target_feature(enable = "avx")]
fn run_with_avx(kernel: impl Kernel) {
    kernel.run::<Avx>();
}

impl Add for Avx {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // SAFETY: as the type says.
        Self(unsafe { _mm256_add_ps(self.0, other.0) })
    }
}

impl Sub for Avx {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        // SAFETY: as the type says.
        Self(unsafe { _mm256_sub_ps(self.0, other.0) })
    }
}

impl Mul for Avx {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // SAFETY: as the type says.
        Self(unsafe { _mm256_mul_ps(self.0, other.0) })
    }
}

impl Register for Avx {
    const COUNT: usize = 8;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        // SAFETY: as the type says.
        Self(unsafe { _mm256_set1_ps(value) })
    }

    #[inline(always)]
    fn load(lanes: &Lanes, _part: usize) -> Self {
        // SAFETY: as the type says; `Lanes` is eight `f32`, aligned to 32 bytes.
        Self(unsafe { _mm256_load_ps(lanes.0.as_ptr()) })
    }

    #[inline(always)]
    fn store(self, lanes: &mut Lanes, _part: usize) {
        // SAFETY: as the type says; `Lanes` is eight `f32`, aligned to 32 bytes.
        unsafe { _mm256_store_ps(lanes.0.as_mut_ptr(), self.0) }
    }

    #[inline(always)]
    fn sums<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        _part: usize,
        base: f64,
    ) -> Self {
        let [a, b, c, d, e, f, g, h] = rows;
        let low = four(a[column], b[column], c[column], d[column]);
        let high = four(e[column], f[column], g[column], h[column]);
        // SAFETY: as the type says.
        unsafe {
            let base = _mm256_set1_pd(base);
            rounded(_mm256_add_pd(base, low), _mm256_add_pd(base, high))
        }
    }

    #[inline(always)]
    fn turn_fractions<const N: usize>(
        rows: &[&[f64; N]; LANES],
        column: usize,
        _part: usize,
    ) -> Self {
        let [a, b, c, d, e, f, g, h] = rows;
        let low = four(a[column], b[column], c[column], d[column]);
        let high = four(e[column], f[column], g[column], h[column]);
        rounded(four_turn_fractions(low), four_turn_fractions(high))
    }
}

#[inline(always)]
fn four(a: f64, b: f64, c: f64, d: f64) -> __m256d {
    // SAFETY: called with AVX only, as `Avx` says.
    unsafe { _mm256_setr_pd(a, b, c, d) }
}

/// The operations of the portable `turn_fraction`, in their order.
#[inline(always)]
fn four_turn_fractions(angles_deg: __m256d) -> __m256d {
    // SAFETY: called with AVX only, as `Avx` says.
    unsafe {
        let magic = _mm256_set1_pd(ROUNDING_MAGIC);
        let turns = _mm256_mul_pd(angles_deg, _mm256_set1_pd(TURNS_PER_DEGREE));
        let whole = _mm256_sub_pd(_mm256_add_pd(turns, magic), magic);
        _mm256_sub_pd(turns, whole)
    }
}

#[inline(always)]
fn rounded(low: __m256d, high: __m256d) -> Avx {
    // SAFETY: called with AVX only, as `Avx` says.
    Avx(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low)) })
}
