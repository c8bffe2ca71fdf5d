//! What the joints must make of the links: one tree, and no joint that follows itself.

use super::joint::warn_of_mimic;
use crate::report::{ReadError, ReadErrorKind, Reporter, quote};
use crate::urdf::{UrdfJoint, UrdfLink};

/// Where links and joints begin in the file.
pub(super) struct Places {
    pub(super) links: Vec<usize>,
    pub(super) joints: Vec<usize>,
}

/// The index of the root link of the tree that the joints make.
pub(super) fn root(
    links: &[UrdfLink],
    joints: &[UrdfJoint],
    places: &Places,
    reporter: &mut Reporter<'_>,
) -> Result<usize, ReadError> {
    let carriers = carriers(links, joints, places, reporter)?;
    let mut roots = (0..links.len()).filter(|&link| carriers[link].is_none());
    let root = roots.next();
    if let (Some(first), Some(second)) = (root, roots.next()) {
        let expected = "one root link, which no joint carries";
        let found = format!(
            "{} beside {}",
            named(&links[second].name),
            named(&links[first].name)
        );
        return Err(reporter.error(
            ReadErrorKind::NotATree,
            places.links[second],
            expected,
            found,
        ));
    }
    if let Some(joint) = joint_in_cycle(&carriers, joints) {
        let name = named(&joints[joint].name);
        let found = format!("joint {name}, which carries the link that it is mounted on");
        return Err(reporter.error(
            ReadErrorKind::NotATree,
            places.joints[joint],
            "joints that make a tree",
            found,
        ));
    }
    root.ok_or_else(|| reporter.unexpected(0, "an element `<link>`", "a robot without links"))
}

/// The joint that carries each link.
fn carriers(
    links: &[UrdfLink],
    joints: &[UrdfJoint],
    places: &Places,
    reporter: &mut Reporter<'_>,
) -> Result<Vec<Option<usize>>, ReadError> {
    let mut carriers: Vec<Option<usize>> = vec![None; links.len()];
    for (index, joint) in joints.iter().enumerate() {
        if let Some(other) = carriers[joint.child].replace(index) {
            let expected = format!(
                "one joint to carry link {}",
                named(&links[joint.child].name)
            );
            let found = format!(
                "{} beside {}",
                named(&joint.name),
                named(&joints[other].name)
            );
            let at = places.joints[index];
            return Err(reporter.error(ReadErrorKind::NotATree, at, expected, found));
        }
    }
    Ok(carriers)
}

/// The first joint in the file's order that stands in a cycle, if there is one.
fn joint_in_cycle(carriers: &[Option<usize>], joints: &[UrdfJoint]) -> Option<usize> {
    let up: Vec<Option<usize>> = carriers
        .iter()
        .map(|carrier| carrier.map(|joint| joints[joint].parent))
        .collect();
    let in_cycle = in_cycles(&up);
    joints.iter().position(|joint| in_cycle[joint.child])
}

/// Lets joints that follow themselves, directly or through others, keep values of their own.
pub(super) fn free_circling_mimics(
    joints: &mut [UrdfJoint],
    places: &Places,
    reporter: &mut Reporter<'_>,
) {
    let followed: Vec<Option<usize>> = joints
        .iter()
        .map(|joint| joint.mimic.map(|mimic| mimic.joint))
        .collect();
    let circling = in_cycles(&followed).into_iter().zip(joints);
    for ((is_circling, joint), &at) in circling.zip(&places.joints) {
        if is_circling {
            joint.mimic = None;
            warn_of_mimic(
                &joint.name,
                at,
                "itself, directly or through others",
                reporter,
            );
        }
    }
}

/// Which of the things that each point to one other at most stand in a cycle. Linear in their number.
fn in_cycles(next: &[Option<usize>]) -> Vec<bool> {
    /// The walk that first came past a thing, counted from 1; 0 for none.
    const UNSEEN: usize = 0;
    let mut seen_in = vec![UNSEEN; next.len()];
    let mut in_cycle = vec![false; next.len()];
    for start in 0..next.len() {
        let walk = start + 1;
        let mut at = Some(start);
        while let Some(thing) = at {
            if seen_in[thing] == walk {
                let mut around = thing;
                while !in_cycle[around] {
                    in_cycle[around] = true;
                    around = next[around].unwrap_or(around);
                }
                break;
            }
            if seen_in[thing] != UNSEEN {
                break;
            }
            seen_in[thing] = walk;
            at = next[thing];
        }
    }
    in_cycle
}

fn named(name: &str) -> String {
    quote(name.as_bytes())
}
