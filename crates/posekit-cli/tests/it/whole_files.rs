//! An old file stays whole until the new one is.

use crate::harness::{ARM, Folder};

#[test]
fn a_result_replaces_an_old_file_and_leaves_nothing_beside_it() {
    let folder = Folder::with_arm();
    folder.write("out.csv", "old");
    folder.fail(1, &["fk", "missing.bvh", "-o", "out.csv"]);
    assert_eq!(folder.read("out.csv"), "old");
    folder.succeed(&["fk", "arm.bvh", "-o", "out.csv"]);
    assert!(folder.read("out.csv").starts_with("frame,time"));
    assert_eq!(folder.names(), ["arm.bvh", "out.csv"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_the_old_file_and_no_other() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::with_arm();
    folder.write("out.bvh", "old");
    let mut command = folder.command();
    // Long enough that a tenth of a second cannot write it.
    command.args(["convert", "sample:walk", "out.bvh", "--fps", "40000"]);
    let mut child = command
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let deadline = Instant::now() + Duration::from_secs(120);
    while !folder
        .names()
        .iter()
        .any(|name| name.starts_with(".posekit-"))
    {
        assert!(Instant::now() < deadline, "no temporary file appeared");
        assert!(
            child.try_wait().unwrap().is_none(),
            "done before the interrupt"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.names(), ["arm.bvh", "out.bvh"]);
    assert_eq!(folder.read("out.bvh"), "old");
    assert_eq!(folder.read("arm.bvh"), ARM);
}
