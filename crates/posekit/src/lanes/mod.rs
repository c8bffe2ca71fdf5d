//! Eight frames side by side: the vectors and quaternions of the batch paths, as they lie in memory.
//!
//! Lane `i` of everything belongs to frame `8 * block + i`, so that one instruction does the same
//! joint of many frames. The arithmetic is in [`register`], written once for every width of
//! register. Nothing here fuses a multiplication with an addition: the same bits come out whatever
//! the processor has.

#[cfg(target_arch = "x86_64")]
mod avx;
mod register;

use glam::{Quat, Vec3};

use crate::rotation::Axis;

#[cfg(test)]
pub(crate) use register::run_portable;
pub(crate) use register::{Kernel, QuatRegisters, Register, Vec3Registers, run};

/// Frames in one block.
pub(crate) const LANES: usize = 8;

/// One number of eight frames, aligned so that the widest register loads it at once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Lanes(pub(crate) [f32; LANES]);

impl Lanes {
    pub(crate) const ZERO: Self = Self::splat(0.0);

    pub(crate) const fn splat(value: f32) -> Self {
        Self([value; LANES])
    }
}

/// Eight vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct Vec3Lanes {
    pub(crate) x: Lanes,
    pub(crate) y: Lanes,
    pub(crate) z: Lanes,
}

impl Vec3Lanes {
    pub(crate) const ZERO: Self = Self {
        x: Lanes::ZERO,
        y: Lanes::ZERO,
        z: Lanes::ZERO,
    };

    pub(crate) fn splat(v: Vec3) -> Self {
        Self {
            x: Lanes::splat(v.x),
            y: Lanes::splat(v.y),
            z: Lanes::splat(v.z),
        }
    }

    #[inline]
    pub(crate) fn lane(&self, lane: usize) -> Vec3 {
        Vec3::new(self.x.0[lane], self.y.0[lane], self.z.0[lane])
    }

    pub(crate) fn set_lane(&mut self, lane: usize, v: Vec3) {
        self.x.0[lane] = v.x;
        self.y.0[lane] = v.y;
        self.z.0[lane] = v.z;
    }

    #[inline(always)]
    pub(crate) fn coordinate_mut(&mut self, axis: Axis) -> &mut Lanes {
        match axis {
            Axis::X => &mut self.x,
            Axis::Y => &mut self.y,
            Axis::Z => &mut self.z,
        }
    }
}

/// Eight quaternions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct QuatLanes {
    pub(crate) x: Lanes,
    pub(crate) y: Lanes,
    pub(crate) z: Lanes,
    pub(crate) w: Lanes,
}

impl QuatLanes {
    pub(crate) const IDENTITY: Self = Self {
        x: Lanes::ZERO,
        y: Lanes::ZERO,
        z: Lanes::ZERO,
        w: Lanes::splat(1.0),
    };

    pub(crate) fn splat(q: Quat) -> Self {
        Self {
            x: Lanes::splat(q.x),
            y: Lanes::splat(q.y),
            z: Lanes::splat(q.z),
            w: Lanes::splat(q.w),
        }
    }

    #[inline]
    pub(crate) fn lane(&self, lane: usize) -> Quat {
        Quat::from_xyzw(
            self.x.0[lane],
            self.y.0[lane],
            self.z.0[lane],
            self.w.0[lane],
        )
    }

    pub(crate) fn set_lane(&mut self, lane: usize, q: Quat) {
        self.x.0[lane] = q.x;
        self.y.0[lane] = q.y;
        self.z.0[lane] = q.z;
        self.w.0[lane] = q.w;
    }

    /// The component along an axis; `w` is the one along none.
    #[inline(always)]
    pub(crate) fn component_mut(&mut self, axis: Axis) -> &mut Lanes {
        match axis {
            Axis::X => &mut self.x,
            Axis::Y => &mut self.y,
            Axis::Z => &mut self.z,
        }
    }
}
