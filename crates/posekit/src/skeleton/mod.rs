//! The skeleton: a hierarchy of joints and its rest pose.
//!
//! Joints stand in topological order, a parent before its children, and in the order of the file
//! they came from, so that one pass over the joints computes every global transform. A skeleton is
//! immutable once built; motions share it through an [`Arc`](std::sync::Arc).
//!
//! Space and units: rest transforms are in the parent joint's space, translations in the file's
//! length unit.

mod builder;
mod chain;
mod symmetry;

use glam::{Quat, Vec3};

pub use builder::{SkeletonBuilder, SkeletonError};
pub use chain::Chain;
use symmetry::KnownPairs;
pub use symmetry::{PairEvidence, SymmetricPair};

/// A joint of one skeleton: its index in topological order.
///
/// An id means nothing to another skeleton. Methods that take one panic when it is out of range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointId(u32);

impl JointId {
    /// The joint at a place in topological order.
    ///
    /// # Panics
    /// If the index does not fit in 32 bits; no skeleton has so many joints.
    pub fn new(index: usize) -> Self {
        Self(u32::try_from(index).expect("a joint index fits in 32 bits"))
    }

    /// The joint's place in topological order.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// A joint and its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The joint nearer to the root.
    pub parent: JointId,
    /// The joint that hangs from it.
    pub child: JointId,
}

/// Static data of an articulated figure: hierarchy, names and rest pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    names: Vec<String>,
    unique_names: Vec<String>,
    /// All joints, sorted by unique name.
    by_unique_name: Vec<JointId>,
    parents: Vec<Option<JointId>>,
    roots: Vec<JointId>,
    links_by_depth: Vec<Link>,
    child_starts: Vec<u32>,
    children: Vec<JointId>,
    rest_translations: Vec<Vec3>,
    rest_rotations: Vec<Quat>,
    end_sites: Vec<bool>,
    known_pairs: KnownPairs,
}

impl Skeleton {
    /// Number of joints, End Sites included.
    pub fn joint_count(&self) -> usize {
        self.parents.len()
    }

    /// All joints in topological order.
    pub fn joints(&self) -> impl DoubleEndedIterator<Item = JointId> + ExactSizeIterator + use<> {
        (0..self.joint_count()).map(JointId::new)
    }

    /// The joint's name as its file gave it; two joints may share one.
    pub fn name(&self, joint: JointId) -> &str {
        &self.names[joint.index()]
    }

    /// The joint's name, told apart from earlier joints of the same name by a suffix: the second
    /// `Spine` is `Spine.001`, the third `Spine.002`.
    pub fn unique_name(&self, joint: JointId) -> &str {
        &self.unique_names[joint.index()]
    }

    /// The joint of that unique name; the first joint of a shared name keeps it as it is.
    pub fn find(&self, unique_name: &str) -> Option<JointId> {
        let name = |joint: &JointId| self.unique_names[joint.index()].as_str();
        let place = self
            .by_unique_name
            .binary_search_by(|joint| name(joint).cmp(unique_name));
        place.ok().map(|place| self.by_unique_name[place])
    }

    /// The joint's parent, or `None` for a root.
    pub fn parent(&self, joint: JointId) -> Option<JointId> {
        self.parents[joint.index()]
    }

    /// The parents of all joints, in topological order.
    pub fn parents(&self) -> &[Option<JointId>] {
        &self.parents
    }

    /// All links level by level: those below the roots first, then those below their children,
    /// and so on. Work that goes down the tree runs faster in this order than in topological
    /// order, since a link seldom waits for the one just before it.
    pub fn links_by_depth(&self) -> &[Link] {
        &self.links_by_depth
    }

    /// The joint's children, in topological order.
    pub fn children(&self, joint: JointId) -> &[JointId] {
        let range = joint.index()..joint.index() + 2;
        let bounds = &self.child_starts[range];
        &self.children[bounds[0] as usize..bounds[1] as usize]
    }

    /// The joints without a parent, in topological order. There is at least one.
    pub fn roots(&self) -> impl Iterator<Item = JointId> + '_ {
        self.roots.iter().copied()
    }

    /// True for a joint that only marks where its parent's link ends, such as a BVH End Site.
    pub fn is_end_site(&self, joint: JointId) -> bool {
        self.end_sites[joint.index()]
    }

    /// The joint's translation in its parent's space at rest: the vector that a BVH calls OFFSET.
    pub fn rest_translation(&self, joint: JointId) -> Vec3 {
        self.rest_translations[joint.index()]
    }

    /// The rest translations of all joints, in topological order.
    pub fn rest_translations(&self) -> &[Vec3] {
        &self.rest_translations
    }

    /// The joint's rotation in its parent's space at rest; the identity for skeletons from BVH.
    pub fn rest_rotation(&self, joint: JointId) -> Quat {
        self.rest_rotations[joint.index()]
    }

    /// The rest rotations of all joints, in topological order.
    pub fn rest_rotations(&self) -> &[Quat] {
        &self.rest_rotations
    }

    /// Distance from the parent to the joint at rest; 0 for a root.
    pub fn bone_length(&self, joint: JointId) -> f32 {
        match self.parent(joint) {
            Some(_) => self.rest_translation(joint).length(),
            None => 0.0,
        }
    }

    /// The same skeleton in a world turned by `turn` about the origin: only the roots' rest transforms change.
    pub(crate) fn turned(&self, turn: Quat) -> Self {
        let mut turned = self.clone();
        // Left and right may be others where names do not say them.
        turned.known_pairs = KnownPairs::default();
        for root in self.roots() {
            turned.rest_translations[root.index()] = turn * self.rest_translation(root);
            turned.rest_rotations[root.index()] = turn * self.rest_rotation(root);
        }
        turned
    }

    /// The same skeleton with every length times `factor`.
    pub(crate) fn scaled(&self, factor: f32) -> Self {
        let mut scaled = self.clone();
        scaled.known_pairs = KnownPairs::default();
        for translation in &mut scaled.rest_translations {
            *translation *= factor;
        }
        scaled
    }

    /// The joint's ancestors, its parent first and a root last.
    pub fn ancestors(&self, joint: JointId) -> impl Iterator<Item = JointId> + '_ {
        std::iter::successors(self.parent(joint), |&ancestor| self.parent(ancestor))
    }

    /// Number of ancestors; 0 for a root.
    pub fn depth(&self, joint: JointId) -> usize {
        self.ancestors(joint).count()
    }

    /// The joint and all its descendants, in depth-first order, children in topological order.
    pub fn subtree(&self, joint: JointId) -> impl Iterator<Item = JointId> + '_ {
        let mut pending = vec![joint];
        std::iter::from_fn(move || {
            let next = pending.pop()?;
            pending.extend(self.children(next).iter().rev());
            Some(next)
        })
    }

    /// The path of joints from `start` to `end`, up to their common ancestor and down again.
    ///
    /// `None` when they hang from different roots.
    pub fn chain(&self, start: JointId, end: JointId) -> Option<Chain> {
        Chain::between(self, start, end)
    }

    /// How tall the figure is, in the file's unit: the length that tolerances and scales are
    /// stated in.
    ///
    /// It is the vertical extent of the rest pose, or, where the rest pose does not stand (its
    /// vertical extent is under half its largest one), that largest extent. 0 for a skeleton whose
    /// joints all coincide.
    pub fn height(&self) -> f32 {
        let rest = crate::pose::GlobalPose::rest(self);
        let (low, high) = rest.bounds();
        let extent = high - low;
        if extent.y >= 0.5 * extent.max_element() {
            extent.y
        } else {
            extent.max_element()
        }
    }
}
