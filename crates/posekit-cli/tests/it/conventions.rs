//! Figures laid out as many programs do, written as BVH: what the command finds in the files.

use posekit_formats::bvh::{self, Bvh};

use crate::harness::Folder;

#[path = "../../../posekit/tests/it/body/conventions/mod.rs"]
#[allow(dead_code, reason = "the library's tests ask it for more")]
mod figures;

#[test]
fn landmarks_are_found_in_files_of_every_convention() {
    let folder = Folder::with_arm();
    let conventions = figures::all_conventions();
    let names: Vec<String> = conventions
        .iter()
        .map(|convention| format!("{}.bvh", convention.label))
        .collect();
    for (convention, name) in conventions.iter().zip(&names) {
        let document = Bvh::from_motion(&convention.motion(), "ZXY".parse().unwrap());
        folder.write(name, bvh::write(&document));
    }
    let args: Vec<&str> = ["info", "--json"]
        .into_iter()
        .chain(names.iter().map(String::as_str))
        .collect();
    let text = folder.succeed(&args);
    assert_eq!(text.lines().count(), conventions.len());
    for (convention, line) in conventions.iter().zip(text.lines()) {
        let facts: serde_json::Value = serde_json::from_str(line).unwrap();
        let landmarks = &facts["landmarks"];
        let name = |index: &serde_json::Value| {
            let index = usize::try_from(index.as_u64().unwrap()).unwrap();
            facts["joints"][index]["name"].as_str().unwrap().to_owned()
        };
        let found: Vec<String> = [
            ("left_leg", ["hip", "knee", "ankle"]),
            ("left_arm", ["shoulder", "elbow", "wrist"]),
            ("right_leg", ["hip", "knee", "ankle"]),
            ("right_arm", ["shoulder", "elbow", "wrist"]),
        ]
        .into_iter()
        .flat_map(|(limb, joints)| joints.map(|joint| name(&landmarks[limb][joint])))
        .collect();
        let expected = [0, 1].map(|side| convention.landmarks(side)).concat();
        assert_eq!(found, expected, "{}", convention.label);
        let [pelvis, chest, head] = convention.trunk();
        assert_eq!(name(&landmarks["pelvis"]), pelvis, "{}", convention.label);
        assert_eq!(name(&landmarks["chest"]), chest, "{}", convention.label);
        assert_eq!(name(&landmarks["head"]), head, "{}", convention.label);
    }
}
