//! Memory that solvers use again from one problem to the next.

use super::ccd;
use super::fabrik;
use super::least_squares;
use super::linkage::Linkage;
use super::trace::MovedJoint;

/// Memory of the solvers: solving again with the same workspace allocates nothing but the report.
///
/// It holds nothing that a result depends on: any workspace serves any skeleton and any problem.
#[derive(Clone, Debug, Default)]
pub struct IkWorkspace {
    pub(super) linkage: Linkage,
    pub(super) ccd: ccd::Scratch,
    pub(super) fabrik: fabrik::Scratch,
    pub(super) least_squares: least_squares::Memory,
    pub(super) moved: Vec<MovedJoint>,
}

impl IkWorkspace {
    /// A workspace that has not been used yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The local transforms, in double precision, of all joints that the last problem was free to move:
    /// what was written to the pose, before it was rounded to single precision. From the base on; a
    /// root that was carried along comes last. Empty if the last problem was invalid.
    pub fn moved(&self) -> &[MovedJoint] {
        &self.moved
    }
}
