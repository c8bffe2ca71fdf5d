//! `posekit fk` against an independent computation, at every joint of every frame.
//!
//! The reference is `tools/fk_reference.py`: a parser of its own, rotations by SciPy, double
//! precision. It bounds positions to 1e-5 of the skeleton's height and orientations to 1e-5 rad.
//! Without a `python3` that has NumPy and SciPy these tests say so and pass; CI installs both. The
//! real files are in `shared/data` beside the workspace; without them that test says so and passes.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::harness::{REAL_FILES, real_data};

const WORKSPACE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// What the real files do not have: a root OFFSET beside position channels, and two of those only;
/// several roots; one, two, none, four rotation channels; position channels between them; angles
/// of many turns; a joint of six channels deep in the tree.
const UNUSUAL: &str = "HIERARCHY
ROOT Base
{
  OFFSET 3 -2 1.5
  CHANNELS 5 Yrotation Xposition Zrotation Zposition Xrotation
  JOINT Bend
  {
    OFFSET 0 4 0
    CHANNELS 1 Zrotation
    JOINT Slide
    {
      OFFSET 0 2 1
      CHANNELS 6 Xrotation Yrotation Zrotation Zposition Xposition Yposition
      JOINT Fixed
      {
        OFFSET 0.5 1 0
        CHANNELS 0
        End Site
        {
          OFFSET 0 0 2
        }
      }
    }
    JOINT Twist
    {
      OFFSET -1 1 0
      CHANNELS 2 Yrotation Xrotation
      JOINT Bend
      {
        OFFSET 0 1 0
        CHANNELS 4 Zrotation Xrotation Zrotation Yrotation
        End Site
        {
          OFFSET 0 0.25 0
        }
      }
    }
  }
}
ROOT Other
{
  OFFSET 10 0 0
  CHANNELS 3 Zrotation Yrotation Zrotation
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
Frames: 3
Frame Time: 0.04
10 1 20 2 30  40  50 60 70 3 4 5  80 90  100 110 120 130  140 150 160
0 0 0 0 0  0  0 0 0 0 0 0  0 0  0 0 0 0  0 0 0
-725 -7.5 181 6.25 -359.5  3600.5  -90 90 -90 0.1 0.2 0.3  1e-3 -1e3  45 -45 45 -45  180 -180 12
";

#[test]
fn every_real_file_agrees_at_every_joint_of_every_frame() {
    let Some(data) = real_data() else { return };
    let files: Vec<PathBuf> = REAL_FILES.lines().map(|name| data.join(name)).collect();
    for root_offset in ["replace", "add"] {
        agrees(&files, root_offset);
    }
}

#[test]
fn unusual_channels_agree_with_both_policies() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("unusual.bvh");
    std::fs::write(&file, UNUSUAL).unwrap();
    for root_offset in ["replace", "add"] {
        agrees(std::slice::from_ref(&file), root_offset);
    }
}

#[test]
fn the_clips_of_our_own_agree() {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = ["walk", "run", "wave", "arm"]
        .map(|name| {
            let file = folder.path().join(format!("{name}.bvh"));
            posekit(&["sample", name, "-o"].map(OsStr::new), &[file.as_os_str()]);
            file
        })
        .into();
    agrees(&files, "replace");
}

/// The test of the test: a wrong policy and a shifted joint must be found.
#[test]
fn the_reference_finds_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("unusual.bvh");
    let moved = folder.path().join("moved.bvh");
    std::fs::write(&file, UNUSUAL).unwrap();
    std::fs::write(
        &moved,
        UNUSUAL.replace("OFFSET 0 0 2\n", "OFFSET 0 0 2.0002\n"),
    )
    .unwrap();
    let arrays = fk(std::slice::from_ref(&file), "add", folder.path());
    let elsewhere = tempfile::tempdir().unwrap();
    let of_moved = fk(std::slice::from_ref(&moved), "add", elsewhere.path());
    let compare = |file: &Path, npz: &Path, root_offset: &str| {
        let (file, npz) = (file.as_os_str(), npz.as_os_str());
        reference(&[
            OsStr::new("--root-offset"),
            OsStr::new(root_offset),
            file,
            npz,
        ])
    };
    let Some((right, said)) = compare(&file, &arrays[0], "add") else {
        return;
    };
    assert!(right, "{said}");
    let (wrong_policy, said) = compare(&file, &arrays[0], "replace").unwrap();
    assert!(!wrong_policy, "{said}");
    let (wrong_offset, said) = compare(&file, &of_moved[0], "add").unwrap();
    assert!(!wrong_offset, "{said}");
}

/// Runs `posekit fk` on the files, holds its arrays against the reference and prints what that
/// says last: how far off the worst joint is.
fn agrees(files: &[PathBuf], root_offset: &str) {
    let folder = tempfile::tempdir().unwrap();
    let arrays = fk(files, root_offset, folder.path());
    let pairs = files
        .iter()
        .zip(&arrays)
        .flat_map(|(file, npz)| [file.as_os_str(), npz.as_os_str()]);
    let mut args = vec![OsStr::new("--root-offset"), OsStr::new(root_offset)];
    args.extend(pairs);
    if let Some((within_tolerance, said)) = reference(&args) {
        println!("{}", said.lines().last().unwrap_or_default());
        assert!(within_tolerance, "{said}");
    }
}

/// The arrays that `posekit fk` makes of each file, in the order of the files.
fn fk(files: &[PathBuf], root_offset: &str, folder: &Path) -> Vec<PathBuf> {
    let out = |index: usize| folder.join(format!("{root_offset}-{index}.npz"));
    for (index, file) in files.iter().enumerate() {
        let out = out(index);
        posekit(
            &["fk", "--root-offset", root_offset, "-o"].map(OsStr::new),
            &[out.as_os_str(), file.as_os_str()],
        );
    }
    (0..files.len()).map(out).collect()
}

fn posekit(args: &[&OsStr], more: &[&OsStr]) {
    let output = Command::new(env!("CARGO_BIN_EXE_posekit"))
        .args(args)
        .args(more)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?} {more:?}: {said}");
}

/// Whether the reference finds all within its tolerances and what it prints, or `None`, said on
/// stderr, where it cannot run.
fn reference(args: &[&OsStr]) -> Option<(bool, String)> {
    let python = |args: &[&OsStr]| Command::new("python3").args(args).output();
    let can_import = python(&["-c", "import numpy, scipy"].map(OsStr::new));
    if !can_import.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: there is no python3 with NumPy and SciPy");
        return None;
    }
    let script = Path::new(WORKSPACE).join("tools/fk_reference.py");
    let command = [script.as_os_str(), OsStr::new("compare")];
    let output = python(&[&command, args].concat()).unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(
        !said.contains("Traceback") || said.contains("AssertionError"),
        "the reference itself failed: {said}"
    );
    Some((output.status.success(), said.into_owned()))
}
