//! The hierarchy, drawn.

use posekit::skeleton::{JointId, Skeleton};

use super::facts::has_own_end_name;
use crate::console::{DIM, styled};
use crate::failure::one_line;
use crate::load::Loaded;
use crate::text::{decimals_for, fixed, width};

/// A line for every joint: its place in the tree, its name, its channels and its OFFSET.
///
/// Nothing recurses: a rope may have a thousand joints one below the other.
pub(super) fn draw(skeleton: &Skeleton, loaded: &Loaded) -> String {
    let branches = Branches::new(skeleton);
    let rows: Vec<(String, String, JointId)> = skeleton
        .roots()
        .flat_map(|root| skeleton.subtree(root))
        .map(|joint| {
            let own_name = has_own_end_name(&loaded.bvh.joints[joint.index()]);
            let label = match skeleton.is_end_site(joint) && !own_name {
                true => "(end)".to_owned(),
                false => label(skeleton, joint),
            };
            (branches.to(joint), label, joint)
        })
        .collect();
    let widest = rows
        .iter()
        .map(|(lines, label, _)| width(lines) + width(label))
        .max();
    let decimals = decimals_for(f64::from(skeleton.height()));
    let mut text = String::new();
    for (lines, label, joint) in &rows {
        let gap = widest.unwrap_or(0) - width(lines) - width(label) + 2;
        let offset = skeleton.rest_translation(*joint).to_array();
        let offset: Vec<String> = offset
            .iter()
            .map(|value| format!("{:>8}", fixed(f64::from(*value), decimals)))
            .collect();
        let channels = super::readable::channel_text(&loaded.bvh.joints[joint.index()].channels);
        let detail = format!("{}  {channels}", offset.join(" "));
        text.push_str(&styled(DIM, lines));
        text.push_str(label);
        text.push_str(&" ".repeat(gap));
        text.push_str(&styled(DIM, detail.trim_end()));
        text.push('\n');
    }
    text + &branches.remark()
}

fn label(skeleton: &Skeleton, joint: JointId) -> String {
    let name = one_line(skeleton.unique_name(joint));
    if skeleton.is_end_site(joint) {
        format!("{name} (end)")
    } else {
        name
    }
}

/// The levels of a hierarchy that are drawn. Deeper ones are told by their number: the lines that lead to the last of
/// twenty thousand joints in a chain would take a gigabyte.
const MOST_LEVELS: usize = 64;

/// What stands before the joints of a hierarchy.
pub(super) struct Branches<'a> {
    skeleton: &'a Skeleton,
    /// How many ancestors each joint has.
    levels: Vec<usize>,
}

impl<'a> Branches<'a> {
    pub(super) fn new(skeleton: &'a Skeleton) -> Self {
        let mut levels: Vec<usize> = Vec::with_capacity(skeleton.joint_count());
        for parent in skeleton.parents() {
            levels.push(parent.map_or(0, |parent| levels[parent.index()] + 1));
        }
        Self { skeleton, levels }
    }

    /// The lines that lead to a joint: a branch of its own, and a bar for every ancestor that has later siblings.
    pub(super) fn to(&self, joint: JointId) -> String {
        let level = self.levels[joint.index()];
        if level > MOST_LEVELS {
            return format!("{}… level {level} ", "   ".repeat(MOST_LEVELS));
        }
        let mut parts = Vec::new();
        let mut below = joint;
        for ancestor in self.skeleton.ancestors(joint) {
            let is_last = self.skeleton.children(ancestor).last() == Some(&below);
            parts.push(match (below == joint, is_last) {
                (true, true) => "└─ ",
                (true, false) => "├─ ",
                (false, true) => "   ",
                (false, false) => "│  ",
            });
            below = ancestor;
        }
        parts.into_iter().rev().collect()
    }

    /// What is to be said below the tree, if anything.
    pub(super) fn remark(&self) -> String {
        let deepest = self.levels.iter().max().copied().unwrap_or(0);
        if deepest <= MOST_LEVELS {
            return String::new();
        }
        let text = format!(
            "levels go down to {deepest}; those below {MOST_LEVELS} are not indented further"
        );
        format!("{}\n", styled(DIM, &text))
    }
}
