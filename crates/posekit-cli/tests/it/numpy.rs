//! The archives as NumPy opens them.

use std::process::Command;

use crate::harness::Folder;

pub(crate) fn python(folder: &Folder, script: &str) -> Option<String> {
    let has_numpy = Command::new("python3")
        .args(["-c", "import numpy"])
        .output();
    if !has_numpy.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: no python3 with NumPy");
        return None;
    }
    let mut python = Command::new("python3");
    let output = python
        .args(["-c", script])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn numpy_opens_an_archive_without_pickle() {
    let folder = Folder::with_arm();
    folder.succeed(&["fk", "arm.bvh", "-o", "a.npz", "--point", "elbow,0,0.5,0"]);
    folder.succeed(&[
        "fk",
        "arm.bvh",
        "-o",
        "b.npz",
        "--point",
        "elbow,0,0.5,0",
        "--compress",
    ]);
    let script = "
import numpy as np
a, b = (np.load(n, allow_pickle=False) for n in ('a.npz', 'b.npz'))
for k in a.files: assert (a[k] == b[k]).all(), k
for k in ('positions', 'orientations', 'points'): assert a[k].dtype == np.float32, k
assert a['positions'].shape == (3, 3, 3) and a['orientations'].shape == (3, 3, 4)
assert a['joint_names'].tolist() == ['base', 'elbow', 'elbow_end']
assert a['parents'].tolist() == [-1, 0, 1] and a['parents'].dtype.kind == 'i'
assert a['frame_time'].shape == () and a['frame_time'] == 0.5
assert a['frames'].tolist() == [0, 1, 2]
np.testing.assert_allclose(a['positions'][2, 2], [8.125, 21, 30], atol=1e-5)
np.testing.assert_allclose(a['orientations'][1, 1], [0, 0, .5**.5, .5**.5], atol=1e-6)
np.testing.assert_allclose(a['points'][1, 0], [7.5, 20, 30], atol=1e-5)
assert a['point_joints'].tolist() == ['elbow'] and a['point_offsets'].tolist() == [[0, .5, 0]]
print('good')
";
    if let Some(out) = python(&folder, script) {
        assert_eq!(out, "good\n");
    }
}
