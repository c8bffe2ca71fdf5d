//! `posekit ik-study`: its files, checked from outside.

use crate::harness::{Folder, real_data};
use crate::numpy::python;

/// Few targets and counts: what is checked does not depend on how many there are.
const SMALL: [&str; 10] = [
    "--random",
    "12",
    "--unreachable",
    "4",
    "--grid",
    "2",
    "--iterations",
    "1,5,20",
    "--seed",
    "7",
];

fn study(folder: &Folder, args: &[&str]) {
    let all: Vec<&str> = ["ik-study"]
        .iter()
        .chain(args)
        .chain(&SMALL)
        .copied()
        .collect();
    folder.succeed(&all);
}

#[test]
fn a_study_is_one_report_and_three_files_beside_it() {
    let folder = Folder::with_arm();
    study(
        &folder,
        &["sample:walk", "-o", "out/s.html", "--no-times", "--quiet"],
    );
    assert_eq!(
        folder.names(),
        [
            "arm.bvh",
            "out/s.bvh",
            "out/s.csv",
            "out/s.html",
            "out/s.md"
        ]
    );
    let html = folder.read("out/s.html");
    for name in [
        "CCD",
        "FABRIK",
        "Transpose",
        "DLS",
        "SDLS",
        "LM",
        "Two-bone",
    ] {
        assert!(html.contains(&format!("<th>{name}</th>")), "{name}");
    }
    assert!(
        !html.contains("<script") && !html.contains("src=\"http") && !html.contains("href=\"http")
    );
    assert!(
        html.contains("--no-times") && html.contains("--seed 7"),
        "the command that was typed"
    );
    let markdown = folder.read("out/s.md");
    assert!(markdown.starts_with("# Inverse kinematics") && markdown.contains("### Conclusion"));
}

#[test]
fn without_times_the_files_are_the_same_on_any_number_of_cores() {
    let (one, other) = (Folder::with_arm(), Folder::with_arm());
    let read = |folder: &Folder, jobs: &str| {
        folder.succeed(&[
            "ik-study",
            "arm.bvh",
            "-o",
            "s.html",
            "--no-times",
            "--quiet",
            "--random",
            "9",
            "--grid",
            "2",
            "--chain",
            "base:elbow_end",
            "-j",
            jobs,
        ]);
        ["s.html", "s.csv", "s.md", "s.bvh"]
            .map(|name| folder.read(name).replace(&format!("-j {jobs}"), ""))
    };
    assert_eq!(read(&one, "1"), read(&other, "3"));
}

#[test]
fn numpy_rebuilds_the_numbers() {
    let folder = Folder::with_arm();
    study(
        &folder,
        &[
            "sample:walk",
            "-o",
            "s.html",
            "--quiet",
            "--target",
            "a=0.3,1.2,0.4",
            "--target",
            "0.2,0.6,0.3",
        ],
    );
    folder.succeed(&["fk", "s.bvh", "-o", "p.npz", "--quiet"]);
    let script = r#"
import csv, itertools, re
import xml.etree.ElementTree as tree
import numpy as np

# Well-formed; every picture is a PNG inside of the file.
root = tree.parse('s.html').getroot()
images = [node.get('src') for node in root.iter() if node.tag.endswith('}img')]
assert images and all(image.startswith('data:image/png;base64,iVBOR') for image in images)
assert len([node for node in root.iter() if node.tag.endswith('}polyline')]) > 20

rows = list(csv.DictReader(open('s.csv', encoding='utf-8')))
key = lambda row, *names: tuple(row[name] for name in names)

# All combinations, each once.
cells = [key(r, 'chain', 'target', 'solver', 'iterations') for r in rows]
assert len(set(cells)) == len(cells)
chains = {c[0] for c in cells}
solvers, counts = {c[2] for c in cells}, {c[3] for c in cells}
assert len(chains) == 3 and len(solvers) == 7 and counts == {'1', '5', '20'}
for chain in chains:
    targets = {c[1] for c in cells if c[0] == chain}
    assert len(targets) == 2 + 4 + 12 + 4, targets
    for rest in itertools.product(targets, solvers, counts):
        assert (chain, *rest) in set(cells)

# Residuals by the forward kinematics of the poses that were written.
p = np.load('p.npz')
names = p['joint_names'].tolist()
posed = [r for r in rows if r['pose_frame']]
assert len(posed) == len(p['positions']) == 2 * 3 * 7 * 3
for r in posed:
    end = p['positions'][int(r['pose_frame']), names.index(r['chain'].split(' → ')[1])]
    target = np.array([float(r[axis]) for axis in 'xyz'])
    assert abs(np.linalg.norm(end - target) - float(r['residual'])) < 2e-5, r
    start = r['chain'].split(' → ')[0]
    first = next(int(o['pose_frame']) for o in posed if o['chain'] == r['chain'])
    still = p['positions'][first, names.index(start)]
    assert np.abs(p['positions'][int(r['pose_frame']), names.index(start)] - still).max() < 2e-5, r

# Targets that are called reachable can be reached, and the best solver stretches out to the others.
for r in rows:
    beyond = float(r['beyond_reach'])
    if r['kind'] == 'random reachable': assert beyond < 1e-9, r
    if r['kind'] == 'random unreachable': assert beyond > 0.04 * float(r['reach']), r
    assert float(r['residual']) > beyond - 1e-6, r  # single precision at the start

# The table of success and the table of medians, from the CSV.
text = open('s.md', encoding='utf-8').read()
main = rows[0]['chain']
def table(caption):
    after = text[text.index(caption):]
    lines = [l for l in after.split('\n\n')[1].splitlines() if l.startswith('|')]
    return {l.split('|')[1].strip(): [c.strip(' *') for c in l.split('|')[2:-1]] for l in lines[2:]}
sample = [r for r in rows if r['chain'] == main and r['kind'] == 'random reachable']
options = dict(zip(['CCD', 'FABRIK', 'Transpose', 'DLS', 'SDLS', 'LM', 'Two-bone'],
                   ['ccd', 'fabrik', 'transpose', 'dls', 'sdls', 'lm', 'two-bone']))
success, medians = table('Success: the share'), table('The median residual of the same runs')
for name, option in options.items():
    for column, count in enumerate(['1', '5', '20']):
        of = [r for r in sample if r['solver'] == option and r['iterations'] == count]
        residuals = np.array([float(r['residual']) for r in of])
        share = 100 * np.mean(residuals <= float(of[0]['tolerance']))
        assert abs(float(success[name][column].strip(' %>')) - share) < 0.1, (name, count)
        median = np.quantile(residuals, 0.5)
        written = medians[name][column]
        assert written == ('< 1e-12' if median < 1e-12 else re.sub(r'e-0*', 'e-', f'{median:.1e}')), (name, count, median, written)
print('good')
"#;
    if let Some(out) = python(&folder, script) {
        assert_eq!(out, "good\n");
    }
}

#[test]
fn the_course_example_leaves_what_it_must() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    let file = data.join("course/motion_walking.bvh");
    study(
        &folder,
        &[
            file.to_str().unwrap(),
            "-o",
            "s.html",
            "--quiet",
            "--solver",
            "ccd,lm",
        ],
    );
    // three.js and a loop in NumPy (tools/ik_reference.py) agree on it.
    assert!(folder.read("s.html").contains("2.786e-2"));
    let csv = folder.read("s.csv");
    let ccd = csv
        .lines()
        .find(|line| {
            line.contains("RootJoint → lWrist_end,target,named") && line.contains(",ccd,20,")
        })
        .unwrap();
    let residual: f64 = ccd.split(',').nth(12).unwrap().parse().unwrap();
    assert!((residual - 2.786e-2).abs() < 5e-6, "{ccd}");
}

#[test]
fn what_cannot_be_studied_says_why() {
    let folder = Folder::with_arm();
    let says = |code: i32, args: &[&str], text: &str| {
        let all: Vec<&str> = ["ik-study"].iter().chain(args).copied().collect();
        let error = folder.fail(code, &all);
        assert!(error.contains(text), "{args:?}: {error}");
    };
    says(2, &["arm.bvh", "--chain", "base"], "START:END");
    says(
        1,
        &["arm.bvh", "--chain", "base:tail"],
        "no joint is called",
    );
    says(2, &["arm.bvh", "--chain", "base:base"], "no joint turns");
    says(2, &["arm.bvh", "--target", "1,2"], "three numbers");
    says(2, &["arm.bvh", "--iterations", "0"], "iterations");
    says(2, &["arm.bvh", "--tolerance", "-1"], "tolerance");
    says(1, &["arm.bvh", "--frame", "3"], "past the end");
    says(2, &["arm.bvh", "-o", "arm.html"], "overwritten");
    says(2, &["arm.bvh", "-o", "report.pdf"], ".html");
    assert_eq!(folder.names(), ["arm.bvh"]);
}
