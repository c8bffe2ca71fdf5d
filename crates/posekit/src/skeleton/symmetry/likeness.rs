//! Branches that are copies of each other, and branches that lie near a place.
//!
//! Hostile or merely wide hierarchies have a hundred thousand branches at one joint. Comparing every two
//! of them is out of the question; comparing one of each kind with those near its image is not.

use std::collections::{BTreeMap, HashMap};

use glam::Vec3;

use crate::pose::GlobalPose;
use crate::skeleton::{JointId, Skeleton};

/// For each joint a number that is the same for joints below which hangs the same: offsets, rotations and
/// hierarchy, bit by bit. Sisters of one likeness lie in the same places.
pub(super) fn likenesses(skeleton: &Skeleton) -> Vec<u32> {
    type Own = ([u32; 7], bool);
    let mut known: HashMap<(Own, Vec<u32>), u32> = HashMap::new();
    let mut of_joint = vec![0_u32; skeleton.joint_count()];
    for joint in skeleton.joints().rev() {
        let children = skeleton.children(joint).iter();
        let below: Vec<u32> = children.map(|child| of_joint[child.index()]).collect();
        let [x, y, z] = skeleton.rest_translation(joint).to_array();
        let [i, j, k, w] = skeleton.rest_rotation(joint).to_array();
        let own = (
            [x, y, z, i, j, k, w].map(f32::to_bits),
            skeleton.is_end_site(joint),
        );
        let next = u32::try_from(known.len()).unwrap_or(u32::MAX);
        of_joint[joint.index()] = *known.entry((own, below)).or_insert(next);
    }
    of_joint
}

/// What two joints must share to be images of each other whatever their places: the number of joints
/// below them, of children, and whether they are End Sites.
pub(super) type Shape = (usize, usize, bool);

type Cell = (Shape, [i64; 3]);

/// Some sisters, found by place: each kind of likeness once, with its members in order.
pub(super) struct Sisters<'a> {
    rest: &'a GlobalPose,
    cell_size: f32,
    /// The members of a likeness that are still there, the last one at the end.
    members: BTreeMap<u32, Vec<JointId>>,
    /// In each cell the likenesses that are there, by the member that comes next.
    cells: BTreeMap<Cell, BTreeMap<JointId, u32>>,
    takes_last: bool,
}

/// Cells are a little larger than what is looked for, so that rounding does not hide anything next door.
const CELL_SLACK: f32 = 1.25;

impl<'a> Sisters<'a> {
    /// Sisters that are taken from the last one on, or from the first one on.
    pub(super) fn new(
        sisters: &[JointId],
        likenesses: &[u32],
        shape: impl Fn(JointId) -> Shape,
        rest: &'a GlobalPose,
        reach: f32,
        takes_last: bool,
    ) -> Self {
        let mut members: BTreeMap<u32, Vec<JointId>> = BTreeMap::new();
        let mut add = |&joint: &JointId| {
            members
                .entry(likenesses[joint.index()])
                .or_default()
                .push(joint);
        };
        if takes_last {
            sisters.iter().for_each(&mut add);
        } else {
            sisters.iter().rev().for_each(&mut add);
        }
        let mut found = Self {
            rest,
            cell_size: reach * CELL_SLACK,
            members: BTreeMap::new(),
            cells: BTreeMap::new(),
            takes_last,
        };
        for (likeness, members) in members {
            let next = members[members.len() - 1];
            let cell = (shape(next), found.cell(rest.positions[next.index()]));
            found.cells.entry(cell).or_default().insert(next, likeness);
            found.members.insert(likeness, members);
        }
        found
    }

    /// Takes the next member of a likeness out.
    pub(super) fn take(&mut self, likeness: u32, shape: Shape) -> Option<JointId> {
        let members = self.members.get_mut(&likeness)?;
        let taken = members.pop()?;
        let next = members.last().copied();
        let cell = (shape, self.cell(self.rest.positions[taken.index()]));
        if let Some(there) = self.cells.get_mut(&cell) {
            there.remove(&taken);
            if let Some(next) = next {
                there.insert(next, likeness);
            }
        }
        Some(taken)
    }

    /// The next member of every likeness of a shape that may lie within reach of a place, in the order in
    /// which they are taken.
    pub(super) fn near(&self, shape: Shape, place: Vec3) -> impl Iterator<Item = (JointId, u32)> {
        let [x, y, z] = self.cell(place);
        let mut around = Vec::with_capacity(27);
        for dx in -1..=1 {
            for dy in -1..=1 {
                for dz in -1..=1 {
                    around.extend(self.cells.get(&(shape, [x + dx, y + dy, z + dz])));
                }
            }
        }
        let takes_last = self.takes_last;
        let mut around: Vec<_> = around
            .into_iter()
            .map(|there| there.iter().map(|(&joint, &likeness)| (joint, likeness)))
            .map(|there| {
                let there: Box<dyn Iterator<Item = (JointId, u32)> + '_> = if takes_last {
                    Box::new(there.rev())
                } else {
                    Box::new(there)
                };
                there.peekable()
            })
            .collect();
        std::iter::from_fn(move || {
            let heads = around
                .iter_mut()
                .enumerate()
                .filter_map(|(at, there)| Some((there.peek()?.0, at)));
            let (_, at) = if takes_last { heads.max() } else { heads.min() }?;
            around[at].next()
        })
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "the cast saturates, and places beyond a cell's number share the last one"
    )]
    fn cell(&self, place: Vec3) -> [i64; 3] {
        // Not to the end of the range: neighbours have numbers too.
        const FARTHEST: f32 = 1e15;
        let cell = |value: f32| (value / self.cell_size).floor().clamp(-FARTHEST, FARTHEST) as i64;
        place.to_array().map(cell)
    }
}
