//! Whether the bones of a figure lie inside the parts of its body.

use glam::{DVec3, Vec3};

use posekit::body::{Anatomy, Limb};
use posekit::motion::Motion;
use posekit::pose::GlobalPose;
use posekit::skeleton::JointId;
use posekit_render::character::{Proportions, body_mesh};
use posekit_render::mesh::Mesh;

/// Triangles of a mesh in a pose.
struct Surface {
    triangles: Vec<[DVec3; 3]>,
}

impl Surface {
    /// What a joint carries all of, or everything.
    fn of(mesh: &Mesh, pose: &GlobalPose, joints: Option<&[JointId]>) -> Self {
        let is_carried = |vertex: u32| {
            let joint = mesh.vertices[vertex as usize].joint as usize;
            joints.is_none_or(|joints| joints.iter().any(|j| j.index() == joint))
        };
        let corner = |vertex: u32| {
            let vertex = &mesh.vertices[vertex as usize];
            let joint = JointId::new(vertex.joint as usize);
            pose.transform_point(joint, vertex.position).as_dvec3()
        };
        let triangles = mesh.triangles.iter();
        let whole = triangles.filter(|triangle| triangle.iter().all(|&v| is_carried(v)));
        Self {
            triangles: whole.map(|triangle| triangle.map(corner)).collect(),
        }
    }

    /// Whether a closed surface is around a point: the solid angles of its triangles, over the sphere
    /// (Jacobson et al. 2013; the angle of a triangle by Van Oosterom and Strackee 1983), come to 1
    /// or more.
    fn contains(&self, point: Vec3) -> bool {
        let point = point.as_dvec3();
        let angle: f64 = self
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| corner - point);
                let (la, lb, lc) = (a.length(), b.length(), c.length());
                let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
                2.0 * libm::atan2(a.dot(b.cross(c)), below)
            })
            .sum();
        angle.abs() / (4.0 * std::f64::consts::PI) > 0.5
    }
}

/// Panics unless every bone of a figure lies inside its part in a frame.
fn assert_bones_are_inside(
    label: &str,
    motion: &Motion,
    mesh: &Mesh,
    anatomy: &Anatomy,
    frame: usize,
) {
    let pose = motion.pose(frame).to_global(motion.skeleton());
    let at = |joint: JointId| pose.positions[joint.index()];
    let whole = Surface::of(mesh, &pose, None);
    let inside = |surface: &Surface, from: Vec3, to: Vec3, shares: [f32; 3], what: &str| {
        for share in shares {
            assert!(
                surface.contains(from.lerp(to, share)),
                "{label}, frame {frame}: {what} at {share}"
            );
        }
    };
    let limb = |limb: &Limb, upper: &str, lower: &str, end: &str| {
        let side = limb.side;
        for (joint, next, what) in [
            (limb.upper, limb.middle, upper),
            (limb.middle, limb.lower, lower),
        ] {
            let part = Surface::of(mesh, &pose, Some(&[joint]));
            let what = format!("{side:?} {what}");
            inside(&part, at(joint), at(next), [0.1, 0.5, 0.9], &what);
        }
        if let Some(tip) = limb.tip {
            let part = Surface::of(mesh, &pose, Some(&[limb.lower, tip]));
            let what = format!("{side:?} {end}");
            inside(&part, at(limb.lower), at(tip), [0.15, 0.3, 0.5], &what);
        }
    };
    for leg in &anatomy.legs {
        limb(leg, "thigh", "shin", "foot");
    }
    for arm in anatomy.arms.iter().flatten() {
        limb(arm, "upper arm", "forearm", "hand");
    }
    let stations: Vec<JointId> = std::iter::once(anatomy.pelvis)
        .chain(anatomy.trunk.iter().copied())
        .chain([anatomy.head])
        .collect();
    for pair in stations.windows(2) {
        let what = format!("trunk above {}", motion.skeleton().unique_name(pair[0]));
        inside(&whole, at(pair[0]), at(pair[1]), [0.2, 0.5, 0.8], &what);
    }
}

/// Panics unless the figure gets a body, with every bone inside its part at the start, in the middle and at
/// the end of the motion.
pub(crate) fn assert_fits(label: &str, motion: &Motion) {
    let proportions = Proportions::of(motion);
    let anatomy = proportions
        .anatomy
        .as_ref()
        .unwrap_or_else(|why| panic!("{label}: {why}"));
    let mesh = body_mesh(motion.skeleton(), &proportions);
    for frame in [0, motion.frame_count() / 2, motion.frame_count() - 1] {
        assert_bones_are_inside(label, motion, &mesh, anatomy, frame);
    }
}
