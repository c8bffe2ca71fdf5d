//! Robots: our own as files, and what `info` and `check` say of them.

use crate::harness::Folder;

#[test]
fn samples_are_written_and_said() {
    let folder = Folder::with_arm();
    folder.succeed(&["sample", "arm6.urdf", "-o", "arm6.urdf"]);
    folder.succeed(&["sample", "arm7", "-o", "robots/"]);
    assert!(folder.exists("robots/arm7.urdf"));
    let text = folder.succeed(&["info", "--tree", "arm6.urdf"]);
    for wanted in [
        "robot       arm6",
        "8 links, root base, tip tool",
        "7: 6 revolute, 1 fixed",
        "6 degrees of freedom",
        "waist  -160 to 160 degrees",
        "└─ trunk",
        "revolute waist",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    let json = folder.succeed(&["info", "--json", "robots/arm7.urdf"]);
    let object: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(object["value_count"], 7);
    assert_eq!(object["joints"][0]["type"], "revolute");
    let text = folder.succeed(&["check", "arm6.urdf"]);
    assert!(text.contains("nothing suspicious"), "{text}");
    let text = folder.succeed(&["sample", "planar2", "-o", "-"]);
    assert!(text.starts_with("<?xml"));
}

#[test]
fn what_is_wrong_has_a_place() {
    let folder = Folder::with_arm();
    let joint = "<joint name='j' type='revolute'><parent link='a'/><child link='b'/></joint>";
    let robot = format!("<robot name='r'>\n<link name='a'/><link name='b'/>\n{joint}</robot>");
    folder.write("loose.urdf", &robot);
    let text = folder.succeed(&["check", "loose.urdf"]);
    assert!(text.contains("missing-joint-limit"), "{text}");
    assert!(!text.contains("posekit fix"), "{text}");
    folder.fail(1, &["check", "loose.urdf", "--deny", "missing-joint-limit"]);
    folder.fail(1, &["info", "loose.urdf", "--strict"]);
    folder.write(
        "cycle.urdf",
        robot.replace("<parent link='a'/>", "<parent link='b'/>"),
    );
    let error = folder.fail(1, &["info", "cycle.urdf"]);
    assert!(
        error.contains("cycle.urdf:3:1: expected joints that make a tree"),
        "{error}"
    );
}
