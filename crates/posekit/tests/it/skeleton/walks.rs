//! Ancestors, subtrees, levels and chains.

use std::collections::HashSet;

use posekit::skeleton::{JointId, Skeleton};
use proptest::prelude::*;

use crate::figures::{any_skeleton, hand_drawn};

fn id(index: usize) -> JointId {
    JointId::new(index)
}

fn indices<'a>(joints: impl IntoIterator<Item = &'a JointId>) -> Vec<usize> {
    joints.into_iter().map(|joint| joint.index()).collect()
}

#[test]
fn ancestors_go_up_to_the_root() {
    let skeleton = hand_drawn();
    let ancestors: Vec<JointId> = skeleton.ancestors(id(3)).collect();
    assert_eq!(indices(&ancestors), [2, 1, 0]);
    assert_eq!(skeleton.ancestors(id(8)).count(), 0);
    assert_eq!(
        [0, 1, 3, 5, 8, 9].map(|joint| skeleton.depth(id(joint))),
        [0, 1, 3, 2, 0, 1]
    );
}

#[test]
fn a_subtree_goes_depth_first() {
    let skeleton = hand_drawn();
    let of = |joint| indices(&skeleton.subtree(id(joint)).collect::<Vec<_>>());
    assert_eq!(of(0), [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(of(4), [4, 5]);
    assert_eq!(of(9), [9]);
}

#[test]
fn a_chain_goes_from_one_limb_to_another() {
    let skeleton = hand_drawn();
    let chain = skeleton.chain(id(5), id(3)).unwrap();
    assert_eq!(indices(chain.joints()), [5, 4, 0, 1, 2, 3]);
    assert_eq!(
        (chain.start(), chain.top(), chain.end()),
        (id(5), id(0), id(3))
    );
    assert_eq!(indices(chain.climbing()), [5, 4, 0]);
    assert_eq!(indices(chain.descending()), [0, 1, 2, 3]);
    let length = chain.rest_length(&skeleton);
    assert!(
        (length - (0.9 + 0.1 + 0.3 + 0.4 + 0.2)).abs() < 1e-6,
        "{length}"
    );
}

#[test]
fn a_chain_within_a_limb_goes_one_way() {
    let skeleton = hand_drawn();
    let down = skeleton.chain(id(1), id(3)).unwrap();
    assert_eq!(indices(down.joints()), [1, 2, 3]);
    assert_eq!(
        (indices(down.climbing()), indices(down.descending())),
        (vec![1], vec![1, 2, 3])
    );
    let up = skeleton.chain(id(3), id(1)).unwrap();
    assert_eq!(indices(up.joints()), [3, 2, 1]);
    assert_eq!(
        (indices(up.climbing()), indices(up.descending())),
        (vec![3, 2, 1], vec![1])
    );
    assert_eq!(up.rest_length(&skeleton), down.rest_length(&skeleton));
}

#[test]
fn a_chain_may_be_one_joint_alone() {
    let skeleton = hand_drawn();
    let chain = skeleton.chain(id(6), id(6)).unwrap();
    assert_eq!(indices(chain.joints()), [6]);
    assert_eq!(chain.top(), id(6));
    assert_eq!(chain.rest_length(&skeleton), 0.0);
}

#[test]
fn no_chain_joins_two_roots() {
    let skeleton = hand_drawn();
    assert_eq!(skeleton.chain(id(0), id(8)), None);
    assert_eq!(skeleton.chain(id(9), id(3)), None);
}

/// Whether two joints are parent and child, whichever way.
fn adjacent(skeleton: &Skeleton, a: JointId, b: JointId) -> bool {
    skeleton.parent(a) == Some(b) || skeleton.parent(b) == Some(a)
}

fn root_of(skeleton: &Skeleton, joint: JointId) -> JointId {
    skeleton.ancestors(joint).last().unwrap_or(joint)
}

proptest! {
    #[test]
    fn every_chain_is_the_one_path(skeleton in any_skeleton(), a: usize, b: usize) {
        let joint_count = skeleton.joint_count();
        let (a, b) = (id(a % joint_count), id(b % joint_count));
        let chain = skeleton.chain(a, b);
        prop_assert_eq!(chain.is_some(), root_of(&skeleton, a) == root_of(&skeleton, b));
        if let Some(chain) = chain {
            let joints = chain.joints();
            prop_assert_eq!((joints[0], joints[joints.len() - 1]), (a, b));
            prop_assert!(joints.windows(2).all(|pair| adjacent(&skeleton, pair[0], pair[1])));
            // A path in a tree that visits nothing twice is the only one.
            let distinct: HashSet<_> = joints.iter().collect();
            prop_assert_eq!(distinct.len(), joints.len());
            let shallowest = joints.iter().copied().min_by_key(|&joint| skeleton.depth(joint));
            prop_assert_eq!(shallowest, Some(chain.top()));
            let mut there_and_back = skeleton.chain(b, a).unwrap().joints().to_vec();
            there_and_back.reverse();
            prop_assert_eq!(there_and_back, joints);
        }
    }

    #[test]
    fn walks_agree_with_the_parents(skeleton in any_skeleton()) {
        let mut from_roots: Vec<JointId> = Vec::new();
        for root in skeleton.roots() {
            prop_assert_eq!(skeleton.parent(root), None);
            from_roots.extend(skeleton.subtree(root));
        }
        from_roots.sort_unstable();
        prop_assert_eq!(from_roots, skeleton.joints().collect::<Vec<_>>());
        for joint in skeleton.joints() {
            for &child in skeleton.children(joint) {
                prop_assert_eq!(skeleton.parent(child), Some(joint));
            }
            let below = skeleton.subtree(joint).filter(|&other| other != joint);
            for other in below {
                prop_assert!(skeleton.ancestors(other).any(|ancestor| ancestor == joint));
            }
        }
    }

    #[test]
    fn links_go_level_by_level(skeleton in any_skeleton()) {
        let links = skeleton.links_by_depth();
        let depths: Vec<usize> = links.iter().map(|link| skeleton.depth(link.child)).collect();
        prop_assert!(depths.is_sorted());
        prop_assert!(links.iter().all(|link| skeleton.parent(link.child) == Some(link.parent)));
        let mut children: Vec<JointId> = links.iter().map(|link| link.child).collect();
        children.sort_unstable();
        let expected = skeleton.joints().filter(|&joint| skeleton.parent(joint).is_some());
        prop_assert_eq!(children, expected.collect::<Vec<_>>());
    }
}

#[test]
fn a_tower_of_a_hundred_thousand_joints_is_walked_without_recursion() {
    let mut builder = posekit::skeleton::SkeletonBuilder::new();
    let mut last = builder.joint("0", None, glam::Vec3::ZERO);
    for index in 1..100_000 {
        last = builder.joint(index.to_string(), Some(last), glam::Vec3::Y * 1e-3);
    }
    let skeleton = builder.build().unwrap();
    assert_eq!(skeleton.depth(last), 99_999);
    assert_eq!(skeleton.subtree(id(0)).count(), 100_000);
    let chain = skeleton.chain(last, id(0)).unwrap();
    assert_eq!((chain.joints().len(), chain.top()), (100_000, id(0)));
}
