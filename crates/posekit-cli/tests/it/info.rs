use crate::harness::{ARM, Folder};

#[test]
fn it_says_what_is_in_the_file() {
    let text = Folder::with_arm().succeed(&["info", "arm.bvh"]);
    for wanted in [
        "3 with 1 end site, 3 levels, root base",
        "3 at 2 fps, 1 s long",
        "position XYZ, rotation ZXY: 1 joint (base)",
        "rotation ZXY: 1 joint (elbow)",
        "no pairs",
        "note, line",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
}

#[test]
fn the_tree_is_drawn() {
    let text = Folder::with_arm().succeed(&["info", "--tree", "arm.bvh"]);
    let tree: Vec<&str> = text.lines().rev().take(3).collect();
    assert!(tree[2].starts_with("base "), "{text}");
    assert!(tree[1].starts_with("└─ elbow "), "{text}");
    assert!(tree[0].starts_with("   └─ (end) "), "{text}");
}

#[test]
fn json_is_an_object_a_line() {
    let folder = Folder::with_arm();
    folder.write("again.bvh", ARM);
    let text = folder.succeed(&["info", "--json", "arm.bvh", "again.bvh"]);
    let objects: Vec<serde_json::Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(objects.len(), 2);
    assert_eq!(objects[0]["file"], "arm.bvh");
    assert_eq!(objects[1]["frame_count"], 3);
    assert_eq!(objects[1]["fps"], 2.0);
    assert_eq!(objects[1]["joints"][1]["channels"][0], "Zrotation");
    assert_eq!(objects[1]["notices"][0]["code"], "nonzero-root-offset");
}

#[test]
fn our_own_person_is_a_person() {
    let text = Folder::with_arm().succeed(&["info", "--json", "sample:walk"]);
    let facts: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(facts["unit"], "metres");
    assert_eq!(facts["up"], "y");
    assert_eq!(facts["rest_pose"], "T-pose, +Y up, facing +Z");
    assert!(facts["pairs"].as_array().unwrap().len() >= 8);
}
