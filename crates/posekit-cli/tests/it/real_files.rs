//! Files that other people made.

use crate::harness::{Folder, real_data};

#[test]
fn every_real_file_is_described_posed_and_converted() {
    let Some(data) = real_data() else { return };
    let data = data.to_str().unwrap();
    let folder = Folder::with_arm();
    let files = folder.succeed(&["info", "--json", data]).lines().count();
    assert!(files >= 49, "{files}");
    folder.succeed(&["fk", data, "-o", "arrays", "--frames", "0..20", "--quiet"]);
    folder.succeed(&["convert", data, "again", "--quiet"]);
    let names = folder.names();
    let with = |ending: &str| names.iter().filter(|name| name.ends_with(ending)).count();
    assert_eq!((with(".npz"), with(".bvh")), (files, files + 1));
}

#[test]
fn conversions_leave_the_joints_of_a_real_file_where_they_were() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    for name in [
        "bandai/dataset-1_kick_normal_001.bvh",
        "course/motion_walking.bvh",
    ] {
        let original = data.join(name);
        let original = original.to_str().unwrap();
        let csv = |file: &str| -> Vec<f64> {
            let text = folder.succeed(&["fk", file, "-o", "-", "--format", "csv"]);
            let rows = text.lines().skip(1);
            // Positions alone: an orientation and its opposite are the same.
            let cells = rows.flat_map(|row| row.split(',').skip(2).enumerate());
            cells
                .filter(|(at, _)| at % 7 < 3)
                .map(|(_, cell)| cell.parse().unwrap())
                .collect()
        };
        let before = csv(original);
        let largest = before
            .iter()
            .fold(0.0f64, |most, value| most.max(value.abs()));
        for change in [["--order", "XYZ"], ["--channels", "3"], ["--channels", "6"]] {
            folder.succeed(&[
                "convert",
                original,
                "changed.bvh",
                change[0],
                change[1],
                "--quiet",
            ]);
            let after = csv("changed.bvh");
            assert_eq!(before.len(), after.len());
            let gap = before
                .iter()
                .zip(&after)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(
                gap < 1e-5 * largest,
                "{name} {change:?}: {gap} of {largest}"
            );
        }
    }
}
