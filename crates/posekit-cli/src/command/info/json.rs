//! The facts, for programs.

use posekit::body::{Certainty, Limb};
use posekit_formats::report::{Severity, Warning};
use serde_json::{Value, json};

use super::facts::Facts;
use super::readable;
use crate::load::Loaded;
use crate::up;

/// One JSON object on one line.
pub(super) fn object(name: &str, facts: &Facts, loaded: &Loaded) -> String {
    let skeleton = &facts.skeleton;
    let joints: Vec<Value> = skeleton
        .joints()
        .map(|joint| {
            let bvh_joint = &loaded.bvh.joints[joint.index()];
            let channels: Vec<&str> = bvh_joint.channels.iter().map(|c| c.name()).collect();
            json!({
                "name": skeleton.unique_name(joint),
                "parent": skeleton.parent(joint).map(|parent| parent.index()),
                "offset": bvh_joint.offset,
                "channels": channels,
                "end_site": bvh_joint.is_end_site,
            })
        })
        .collect();
    let notices: Vec<Value> = loaded.notices.iter().map(notice_object).collect();
    let pairs: Vec<Value> = facts
        .pairs
        .iter()
        .map(|(left, right)| json!({"left": left, "right": right}))
        .collect();
    let object = json!({
        "file": name,
        "joint_count": facts.joint_count,
        "end_site_count": facts.end_site_count,
        "has_motion": facts.has_motion,
        "frame_count": facts.frame_count,
        "frame_time": facts.frame_time_secs,
        "fps": facts.fps(),
        "duration": facts.duration_secs(),
        "channel_count": facts.channel_count,
        "positions": facts.relative_positions.as_ref().map(|relative| json!({
            "what": relative.what,
            "option": relative.option,
        })),
        "height_at_rest": facts.rest_height,
        "height_in_motion": facts.motion_height,
        "unit": facts.unit.map(|unit| unit.name()),
        "metres_per_unit": facts.unit.map(|unit| unit.metres()),
        "up": facts.up.map(|guess| guess.up.name()),
        "up_sureness": facts.up.map(up::sureness),
        "rest_pose": readable::rest_pose(&facts.rest_pose),
        "landmarks": landmarks(facts),
        "pairs": pairs,
        "joints": joints,
        "notices": notices,
    });
    format!("{object}\n")
}

/// The joints of trunk and limbs by index, and how sure that is; of what is no person's only why.
fn landmarks(facts: &Facts) -> Value {
    let anatomy = match &facts.anatomy {
        Ok(anatomy) => anatomy,
        Err(why) => return json!({"certainty": "none", "reason": why.to_string()}),
    };
    let limb = |limb: &Limb, names: [&str; 3]| {
        let joints = [limb.upper, limb.middle, limb.lower];
        let entries = names.into_iter().zip(joints);
        let entries = entries.map(|(name, joint)| (name.to_owned(), json!(joint.index())));
        Value::Object(entries.collect())
    };
    let leg = |side: usize| limb(&anatomy.legs[side], ["hip", "knee", "ankle"]);
    let arm = |side: usize| {
        let arms = anatomy.arms.as_ref();
        arms.map(|arms| limb(&arms[side], ["shoulder", "elbow", "wrist"]))
    };
    json!({
        "certainty": match anatomy.certainty {
            Certainty::Sure => "sure",
            Certainty::Likely => "likely",
        },
        "pelvis": anatomy.pelvis.index(),
        "chest": anatomy.chest().index(),
        "neck": anatomy.neck().index(),
        "head": anatomy.head.index(),
        "left_leg": leg(0),
        "right_leg": leg(1),
        "left_arm": arm(0),
        "right_arm": arm(1),
    })
}

/// What the reader noticed.
pub(super) fn notice_object(notice: &Warning) -> Value {
    json!({
        "code": notice.code.code(),
        "severity": match notice.code.severity() {
            Severity::Note => "note",
            Severity::Warning => "warning",
        },
        "file": notice.file,
        "line": notice.place.location().map(|location| location.line),
        "column": notice.place.location().map(|location| location.column),
        "place": notice.place.to_string(),
        "message": notice.message,
        "count": notice.count,
    })
}
