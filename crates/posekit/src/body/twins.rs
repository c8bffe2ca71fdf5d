//! Branches that are as long as each other, bone by bone: limbs without names, in any pose.

use crate::skeleton::JointId;

use super::limb::STOPS_MAX;
use super::tree::Tree;

/// How far the bones of two sides differ in length, as a share of the longer one (CMU subjects' legs:
/// 4 per cent, their arms 5).
const BONE_TOLERANCE: f32 = 0.1;

/// ... and by how much of the branch they may differ besides, for short ones.
const BRANCH_TOLERANCE: f32 = 0.01;

/// The pairs of branches of the same joint that are at least `least` long and not `taken`.
pub(super) fn twins(tree: &Tree<'_>, taken: &[bool], least: f32) -> Vec<[JointId; 2]> {
    let mut found = Vec::new();
    let length = |joint: JointId| tree.reach[joint.index()] + tree.length(joint);
    for hub in tree.skeleton.joints() {
        let mut branches: Vec<JointId> = tree
            .skeleton
            .children(hub)
            .iter()
            .copied()
            .filter(|&child| !taken[child.index()] && length(child) >= least && least > 0.0)
            .collect();
        branches.sort_by(|&a, &b| length(a).total_cmp(&length(b)).then(a.cmp(&b)));
        let mut at = 0;
        while at + 1 < branches.len() {
            let (a, b) = (branches[at], branches[at + 1]);
            if are_alike(tree, a, b) {
                found.push([a.min(b), a.max(b)]);
                at += 1;
            }
            at += 1;
        }
    }
    found
}

fn are_alike(tree: &Tree<'_>, a: JointId, b: JointId) -> bool {
    let bones = |top: JointId| -> Vec<f32> {
        let path = tree.main_path(top).take(STOPS_MAX);
        path.map(|joint| tree.length(joint)).collect()
    };
    let (a, b) = (bones(a), bones(b));
    let free = BRANCH_TOLERANCE * a.iter().sum::<f32>();
    a.len() == b.len()
        && a.iter()
            .zip(&b)
            .all(|(a, b)| (a - b).abs() <= BONE_TOLERANCE * a.max(*b) + free)
}
