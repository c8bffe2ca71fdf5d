//! What is in a robot's file.

use posekit::mechanism::{Freedom, Mechanism, ValueRange};
use posekit::skeleton::JointId;
use posekit_formats::report::Import;
use posekit_formats::urdf::{UpAxis, Urdf, UrdfJointKind, UrdfShape};
use serde_json::{Value, json};

use super::json::notice_object;
use super::readable::{line, notice_text};
use super::tree::Branches;
use crate::console::{DIM, HEADING, styled};
use crate::failure::one_line;
use crate::text::{counted, fixed, trimmed, width};

/// Names of links beyond this many are counted.
const LINKS_NAMED: usize = 6;

/// Everything about a robot, as lines with a label each.
pub(super) fn block(name: &str, import: &Import<Urdf>, with_tree: bool) -> String {
    let urdf = &import.document;
    let robot = urdf.to_robot(UpAxis::Z).ok();
    let mut text = format!("{}\n", styled(HEADING, &one_line(name)));
    line(&mut text, "robot", &one_line(&urdf.name));
    let links = counted(urdf.links.len(), "link");
    let root = one_line(&urdf.links[urdf.root].name);
    line(
        &mut text,
        "links",
        &format!("{links}, root {root}, {}", tips(urdf)),
    );
    line(&mut text, "joints", &joints(urdf));
    line(&mut text, "shapes", &shapes(urdf));
    match &robot {
        None => line(&mut text, "values", "none: numbers beyond single precision"),
        Some(robot) => {
            let count = counted(robot.value_count(), "degree");
            line(&mut text, "values", &format!("{count} of freedom"));
            let ranges = robot.value_ranges();
            for joint in robot.moving_joints() {
                let first = ranges[robot.values_of_joint(joint).start];
                line(&mut text, "", &range(robot, joint, first));
            }
        }
    }
    for (index, notice) in import.report.warnings.iter().enumerate() {
        let label = if index == 0 { "noticed" } else { "" };
        line(&mut text, label, &notice_text(notice));
    }
    if let (true, Some(robot)) = (with_tree, &robot) {
        text.push('\n');
        text.push_str(&tree(urdf, robot));
    }
    text
}

/// One JSON object on one line.
pub(super) fn object(name: &str, import: &Import<Urdf>, _with_tree: bool) -> String {
    let urdf = &import.document;
    let joints: Vec<Value> = urdf
        .joints
        .iter()
        .map(|joint| {
            json!({
                "name": joint.name,
                "type": joint.kind.name(),
                "parent": urdf.links[joint.parent].name,
                "child": urdf.links[joint.child].name,
                "xyz": joint.origin.xyz,
                "rpy": joint.origin.rpy,
                "axis": joint.axis,
                "limit": joint.limit.map(|limit| json!({
                    "lower": limit.lower,
                    "upper": limit.upper,
                    "effort": limit.effort,
                    "velocity": limit.velocity,
                })),
                "mimic": joint.mimic.map(|mimic| json!({
                    "joint": urdf.joints[mimic.joint].name,
                    "multiplier": mimic.multiplier,
                    "offset": mimic.offset,
                })),
            })
        })
        .collect();
    let links: Vec<Value> = urdf
        .links
        .iter()
        .map(|link| json!({"name": link.name, "visuals": link.visuals.len()}))
        .collect();
    let object = json!({
        "file": name,
        "robot": urdf.name,
        "root": urdf.links[urdf.root].name,
        "link_count": urdf.links.len(),
        "joint_count": urdf.joints.len(),
        "value_count": urdf.to_robot(UpAxis::Z).ok().map(|robot| robot.value_count()),
        "links": links,
        "joints": joints,
        "notices": import.report.warnings.iter().map(notice_object).collect::<Vec<_>>(),
    });
    format!("{object}\n")
}

/// The links that carry no other.
fn tips(urdf: &Urdf) -> String {
    let mut carries = vec![false; urdf.links.len()];
    for joint in &urdf.joints {
        carries[joint.parent] = true;
    }
    let tips: Vec<String> = (0..urdf.links.len())
        .filter(|&link| !carries[link])
        .take(LINKS_NAMED + 1)
        .map(|link| one_line(&urdf.links[link].name))
        .collect();
    let more = if tips.len() > LINKS_NAMED {
        ", ..."
    } else {
        ""
    };
    let named = &tips[..tips.len().min(LINKS_NAMED)];
    let noun = if tips.len() == 1 { "tip" } else { "tips" };
    format!("{noun} {}{more}", named.join(", "))
}

fn joints(urdf: &Urdf) -> String {
    let count = |kind| {
        urdf.joints
            .iter()
            .filter(|joint| joint.kind == kind)
            .count()
    };
    let kinds = UrdfJointKind::ALL.map(|kind| (count(kind), kind.name()));
    let mut parts: Vec<String> = kinds
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    let followers = urdf
        .joints
        .iter()
        .filter(|joint| joint.mimic.is_some())
        .count();
    if followers > 0 {
        parts.push(format!("{followers} of them mimic others"));
    }
    if parts.is_empty() {
        return "none".to_owned();
    }
    format!("{}: {}", urdf.joints.len(), parts.join(", "))
}

fn shapes(urdf: &Urdf) -> String {
    let (mut simple, mut meshes) = (0, 0);
    for visual in urdf.links.iter().flat_map(|link| &link.visuals) {
        match visual.shape {
            UrdfShape::Mesh { .. } => meshes += 1,
            UrdfShape::Box { .. } | UrdfShape::Cylinder { .. } | UrdfShape::Sphere { .. } => {
                simple += 1;
            }
        }
    }
    match (simple, meshes) {
        (0, 0) => "none".to_owned(),
        (simple, 0) => counted(simple, "simple shape"),
        (0, _) => format!("{meshes} in mesh files"),
        _ => format!(
            "{}, {meshes} in mesh files",
            counted(simple, "simple shape")
        ),
    }
}

/// A joint's name and the range of its first value.
fn range(robot: &Mechanism, joint: JointId, range: ValueRange) -> String {
    let name = one_line(robot.skeleton().name(joint));
    let values = robot.values_of_joint(joint);
    let detail = match robot.joint(joint).freedom {
        Freedom::Hinge { .. } if range == ValueRange::FREE => "turns without end".to_owned(),
        Freedom::Hinge { .. } => {
            let [lower, upper] = [range.lower, range.upper].map(|end| trimmed(end.to_degrees(), 1));
            format!("{lower} to {upper} degrees")
        }
        Freedom::Slide { .. } if range == ValueRange::FREE => "slides without end".to_owned(),
        Freedom::Slide { .. } => {
            let [lower, upper] = [range.lower, range.upper].map(|end| trimmed(end, 4));
            format!("slides {lower} to {upper} m")
        }
        _ => counted(values.len(), "value"),
    };
    format!("{name}  {detail}")
}

/// A line for every link: its place in the tree, the joint that carries it, and that joint's origin.
fn tree(urdf: &Urdf, robot: &Mechanism) -> String {
    let links = urdf.links_from_root();
    let order = urdf.joints_from_root();
    let skeleton = robot.skeleton();
    let branches = Branches::new(skeleton);
    let rows: Vec<(String, String, String)> = skeleton
        .roots()
        .flat_map(|root| skeleton.subtree(root))
        .map(|id| {
            let label = one_line(&urdf.links[links[id.index()]].name);
            let detail = id.index().checked_sub(1).map_or(String::new(), |carrier| {
                let joint = &urdf.joints[order[carrier]];
                let xyz = joint.origin.xyz.map(|number| fixed(number, 3));
                let kind = joint.kind.name();
                format!("{}  {kind} {}", xyz.join(" "), one_line(&joint.name))
            });
            (branches.to(id), label, detail)
        })
        .collect();
    let size = |row: &(String, String, String)| width(&row.0) + width(&row.1);
    let widest = rows.iter().map(size).max().unwrap_or(0);
    let mut text = String::new();
    for row in &rows {
        text.push_str(&styled(DIM, &row.0));
        text.push_str(&row.1);
        text.push_str(&" ".repeat(widest - size(row) + 2));
        text.push_str(&styled(DIM, &row.2));
        text.push('\n');
    }
    text + &branches.remark()
}
