//! A body for what is no humanoid: animals, machines, chains, anything.
//!
//! Rounded links, thicker the more hangs on them, as a tree's branches; a trunk where limbs hang on
//! both ends of a spine; dark balls at joints that turn freely, drums and collars at joints that turn
//! about one axis, a foot plate under a machine that stands.

use glam::Vec3;

use posekit::skeleton::{JointId, Skeleton};

use crate::mesh::{MaterialId, Mesh, Shape};

use super::body::side_material;
use super::fitter::{Fitter, SEGMENTS};
use super::proportions::Proportions;

/// Half thickness of the thinnest and, added to it, of the thickest link, in sizes.
const THIN: f32 = 0.012;
const THICK: f32 = 0.032;
/// Machines are stouter than bones.
const MACHINE: f32 = 1.25;
/// Half thickness of a trunk, in sizes.
const TRUNK: f32 = 0.062;
/// A branch with more than this share of the whole length is a limb, which makes its start a hub.
const LIMB: f32 = 0.1;
/// Cosine from which an axis runs along its link.
const ALONG: f32 = 0.85;

/// Builds the links of a skeleton.
pub(super) fn links(skeleton: &Skeleton, proportions: &Proportions) -> Mesh {
    let mut fitter = Fitter::new(&proportions.reference);
    let plan = Plan::new(skeleton, proportions);
    for joint in skeleton.joints() {
        for &child in skeleton.children(joint) {
            add_link(&mut fitter, &plan, joint, child);
        }
        add_joint(&mut fitter, &plan, joint);
    }
    if plan.total <= 0.0 {
        // All joints in one place: something must be seen.
        for root in skeleton.roots() {
            fitter.ball(root, 0.05 * plan.size, MaterialId::Accent);
        }
    }
    fitter.finish()
}

struct Plan<'a> {
    skeleton: &'a Skeleton,
    proportions: &'a Proportions,
    size: f32,
    /// Length of all that hangs on each joint.
    carried: Vec<f32>,
    total: f32,
    /// Whether the link from a joint's parent to it belongs to the trunk.
    trunk: Vec<bool>,
    /// Whether it is no bone but a point of reference that the hub is moved by.
    handle: Vec<bool>,
    /// Axes, not balls, and one chain: a robot arm.
    is_machine: bool,
}

impl<'a> Plan<'a> {
    fn new(skeleton: &'a Skeleton, proportions: &'a Proportions) -> Self {
        let mut carried = vec![0.0f32; skeleton.joint_count()];
        let position = |joint: JointId| proportions.reference.positions[joint.index()];
        for joint in skeleton.joints().rev() {
            let parent = skeleton.parent(joint);
            if let Some(parent) = parent.filter(|_| !proportions.loose[joint.index()]) {
                let length = position(parent).distance(position(joint));
                carried[parent.index()] += carried[joint.index()] + length;
            }
        }
        let total = carried.iter().copied().fold(0.0, f32::max);
        let is_chain = skeleton.joints().all(|j| skeleton.children(j).len() <= 1);
        let has_hinge = proportions.hinges.iter().any(Option::is_some);
        let mut plan = Self {
            skeleton,
            proportions,
            size: proportions.stature,
            carried,
            total,
            trunk: Vec::new(),
            handle: Vec::new(),
            is_machine: is_chain && has_hinge,
        };
        plan.find_trunk();
        plan
    }

    fn at(&self, joint: JointId) -> Vec3 {
        self.proportions.reference.positions[joint.index()]
    }

    fn length(&self, joint: JointId, child: JointId) -> f32 {
        self.at(joint).distance(self.at(child))
    }

    /// Finds the hubs, which three limbs or more hang on, and the links between them.
    fn find_trunk(&mut self) {
        let joints = || self.skeleton.joints();
        let is_limb = |joint: JointId, child: JointId| {
            let length = self.carried[child.index()] + self.length(joint, child);
            !self.proportions.loose[child.index()] && length > LIMB * self.total
        };
        let hubs: Vec<bool> = joints()
            .map(|j| {
                let children = self.skeleton.children(j).iter();
                children.filter(|&&child| is_limb(j, child)).count() >= 3
            })
            .collect();
        let mut hub_below = hubs.clone();
        for joint in joints().rev() {
            if let Some(parent) = self.skeleton.parent(joint) {
                hub_below[parent.index()] |= hub_below[joint.index()];
            }
        }
        let hub_above = |joint: JointId| self.skeleton.ancestors(joint).any(|a| hubs[a.index()]);
        self.trunk = joints()
            .map(|j| hub_below[j.index()] && hub_above(j))
            .collect();
        // A lone root over a hub is a point of reference, mostly on the floor, and no bone.
        self.handle = joints()
            .map(|j| {
                let parent = self.skeleton.parent(j);
                let is_lone = |p: &JointId| {
                    self.skeleton.parent(*p).is_none() && self.skeleton.children(*p).len() == 1
                };
                hubs[j.index()] && parent.as_ref().is_some_and(is_lone)
            })
            .collect();
    }

    fn in_trunk(&self, joint: JointId) -> bool {
        let children = self.skeleton.children(joint);
        self.trunk[joint.index()] || children.iter().any(|c| self.trunk[c.index()])
    }

    /// Whether a joint lies inside the trunk's surface.
    fn is_buried(&self, joint: JointId) -> bool {
        let near = |p: JointId| self.in_trunk(p) && self.length(p, joint) < 1.2 * TRUNK * self.size;
        self.in_trunk(joint) || self.skeleton.parent(joint).is_some_and(near)
    }

    /// Whether anything hangs on a joint: one that ends a limb needs no ball.
    fn carries(&self, joint: JointId) -> bool {
        let children = self.skeleton.children(joint).iter();
        children.copied().any(|child| self.is_drawn(joint, child))
    }

    /// Half the thickness at a joint, were its links long enough.
    fn thickness(&self, joint: JointId) -> f32 {
        let share = self.carried[joint.index()] / self.total.max(1e-6);
        let machine = if self.is_machine { MACHINE } else { 1.0 };
        self.size * (THIN + THICK * share.sqrt()) * machine
    }

    fn is_drawn(&self, joint: JointId, child: JointId) -> bool {
        !self.proportions.loose[child.index()]
            && !self.handle[child.index()]
            && self.length(joint, child) >= 1e-3 * self.size
    }

    /// Radii of a link at its start and its end.
    fn radii(&self, joint: JointId, child: JointId) -> (f32, f32) {
        if self.trunk[child.index()] {
            let radius = TRUNK * self.size;
            return (radius, radius * 0.94);
        }
        let limit = self.length(joint, child) * if self.is_machine { 0.32 } else { 0.25 };
        let start = if self.stands_fixed(joint) {
            self.thickness(joint)
        } else {
            self.thickness(joint).min(limit)
        };
        (start, self.thickness(child).min(start))
    }

    /// Radius of the thickest link that meets a joint.
    fn widest(&self, joint: JointId) -> f32 {
        let below = self.skeleton.children(joint).iter();
        let below = below
            .filter(|&&child| self.is_drawn(joint, child))
            .map(|&child| self.radii(joint, child).0);
        let above = self.skeleton.parent(joint);
        let above = above
            .filter(|&parent| self.is_drawn(parent, joint))
            .map(|parent| self.radii(parent, joint).1);
        below.chain(above).fold(0.0, f32::max)
    }

    /// A machine's base, which is screwed to the floor.
    fn stands_fixed(&self, joint: JointId) -> bool {
        let floor = self.proportions.reference.bounds().0.y;
        self.is_machine
            && self.skeleton.parent(joint).is_none()
            && self.proportions.hinges[joint.index()].is_none()
            && self.at(joint).y - floor < 1e-3 * self.size
    }

    /// The axis of a joint in the world of the reference pose, and whether it runs along the link
    /// that follows.
    fn axis(&self, joint: JointId) -> Option<(Vec3, bool)> {
        let axis = self.proportions.hinges[joint.index()]?;
        let axis = self.proportions.reference.orientations[joint.index()] * axis;
        let next = self.skeleton.children(joint).first()?;
        let link = (self.at(*next) - self.at(joint)).try_normalize()?;
        Some((axis, axis.dot(link).abs() > ALONG))
    }
}

fn add_link(fitter: &mut Fitter<'_>, plan: &Plan<'_>, joint: JointId, child: JointId) {
    if !plan.is_drawn(joint, child) {
        return;
    }
    let (from, to) = (plan.at(joint), plan.at(child));
    let (start, end) = plan.radii(joint, child);
    let is_tool = plan.is_machine && plan.skeleton.is_end_site(child);
    let shape: &[f32] = if is_tool {
        &[0.9, 0.9, 0.5, 0.42, 0.34, 0.26]
    } else {
        &[0.9, 1.0, 0.97, 0.93, 0.88]
    };
    let last = (shape.len() - 1) as f32;
    let radius = |(i, part): (usize, &f32)| (start + (end - start) * i as f32 / last) * part;
    let radii: Vec<f32> = if is_tool {
        shape.iter().map(|part| start * part).collect()
    } else {
        shape.iter().enumerate().map(radius).collect()
    };
    let foot = if plan.stands_fixed(joint) {
        // The rounded end stays over the floor.
        (to - from).normalize_or_zero() * (start * 0.9)
    } else {
        Vec3::ZERO
    };
    let material = side_material(plan.skeleton, child);
    fitter.turned(joint, (from + foot, to), &radii, material);
}

fn add_joint(fitter: &mut Fitter<'_>, plan: &Plan<'_>, joint: JointId) {
    let widest = plan.widest(joint);
    if widest <= 0.0 || !plan.carries(joint) || plan.is_buried(joint) {
        return;
    }
    let (at, dark) = (plan.at(joint), MaterialId::Accent);
    let mut drum = |axis: Vec3, half_length: f32, radius: f32, material: MaterialId| {
        let reach = axis * (half_length * widest);
        let shape = Shape::drum(
            at - reach,
            at + reach,
            radius * widest,
            0.12 * widest,
            SEGMENTS + 6,
        );
        fitter.add(joint, shape, material);
    };
    match plan.axis(joint) {
        _ if plan.stands_fixed(joint) => {
            let (up, radius) = (Vec3::Y * (0.3 * widest), 1.75 * widest);
            let plate = Shape::drum(at, at + up, radius, 0.1 * widest, SEGMENTS + 12);
            fitter.add(joint, plate, dark);
            fitter.contact(joint, at + up * 0.5, 0.15 * widest);
            return;
        }
        Some((axis, true)) => drum(axis, 0.36, 1.14, dark),
        Some((axis, false)) => {
            drum(axis, 1.2, 1.16, dark);
            drum(axis, 1.32, 0.72, MaterialId::Base);
        }
        None => fitter.ball(joint, widest * 1.1, dark),
    }
    fitter.contact(joint, at, widest * 1.1);
}
