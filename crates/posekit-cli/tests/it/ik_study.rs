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
    assert!(
        html.contains("Jacobian transpose, conjugate directions"),
        "the method that runs"
    );
    let markdown = folder.read("out/s.md");
    assert!(markdown.starts_with("# Inverse kinematics") && markdown.contains("### Conclusion"));
    assert!(markdown.contains("### Ranking") && markdown.contains("not ranked"));
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
success, medians = table('Success by the number of iterations'), table('The median residual of the same runs')
for name, option in options.items():
    for column, count in enumerate(['1', '5', '20']):
        of = [r for r in sample if r['solver'] == option and r['iterations'] == count]
        residuals = np.array([float(r['residual']) for r in of])
        share = 100 * np.mean(residuals <= float(of[0]['tolerance']))
        assert abs(float(success[name][column].strip(' %>')) - share) < 0.1, (name, count)
        median = np.quantile(residuals, 0.5)
        written = medians[name][column]
        assert written == ('< 1e-12' if median < 1e-12 else re.sub(r'e-0*', 'e-', f'{median:.1e}')), (name, count, median, written)

# The ranking by its rule: places by success, time and motion; the sum decides.
judged = [r for r in rows if r['kind'] == 'random reachable' and r['iterations'] == '20']
target = lambda r: (r['chain'], r['target'])
arrived = {o: {target(r) for r in judged if r['solver'] == o and r['iterations_to_tolerance']} for o in options.values()}
total = len({target(r) for r in judged})
share = {o: len(arrived[o]) / total for o in arrived}
ranked = [o for o in share if share[o] >= 0.9 * max(share.values())]
common = set.intersection(*(arrived[o] for o in ranked))
def middle(o, column):
    return np.median([float(r[column]) for r in judged if r['solver'] == o and target(r) in common])
def places(values, is_tie):
    result, leader = {}, None
    for before, o in enumerate(sorted(values, key=values.get)):
        if leader is None or not is_tie(values[o], leader[1]): leader = (before + 1, values[o])
        result[o] = leader[0]
    return result
tenth = lambda value, best: value <= 1.1 * best
wanted = [
    places({o: 1 - share[o] for o in ranked}, lambda value, best: value <= best + 0.01 + 1e-12),
    places({o: middle(o, 'time_to_tolerance_us') for o in ranked}, tenth),
    places({o: middle(o, 'joint_motion_to_tolerance_deg') for o in ranked}, tenth),
]
ranking = table('The solvers ranked by the rule above')
sums = {}
for name, option in options.items():
    cells = ranking[name]
    assert abs(float(cells[0].strip(' %>')) - 100 * share[option]) < 0.1, (name, cells)
    if option not in ranked:
        assert cells[-1] == 'not ranked', (name, cells)
        continue
    own = [int(place) for place in cells[4].split('+')]
    # Times are written to a hundredth of a microsecond.
    assert [own[0], own[2]] == [wanted[0][option], wanted[2][option]], (name, cells, wanted)
    assert abs(own[1] - wanted[1][option]) <= 1, (name, cells, wanted)
    sums[name] = sum(own)
    assert int(cells[5]) == sums[name]
for name, own in sums.items():
    rank = 1 + sum(other < own for other in sums.values())
    tie = ' (tie)' if sum(other == own for other in sums.values()) > 1 else ''
    assert ranking[name][6] == f'{rank}{tie}', (name, ranking[name])
print('good')
"#;
    if let Some(out) = python(&folder, script) {
        assert_eq!(out, "good\n");
    }
}

/// The commands that a report prints, as words.
fn printed_commands(html: &str) -> Vec<Vec<String>> {
    let commands = html.split("<pre>").skip(1).filter_map(|rest| {
        let (command, _) = rest.split_once("</pre>")?;
        command.starts_with("posekit ik ").then(|| {
            let words = command.split(' ').skip(1);
            words
                .map(|word| word.trim_matches('\'').to_owned())
                .collect()
        })
    });
    commands.collect()
}

/// Runs each of the commands and compares what it leaves with the CSV. Gives how many there were.
fn commands_leave_what_the_csv_says(folder: &Folder) -> usize {
    let csv = folder.read("s.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|head| *head == name).unwrap();
    let [chain, solver, iterations, residual] =
        ["chain", "solver", "iterations", "residual"].map(column);
    let place = ["x", "y", "z"].map(column);
    let commands = printed_commands(&folder.read("s.html"));
    for command in &commands {
        let after = |option: &str| {
            let at = command.iter().position(|word| word == option);
            command[at.unwrap_or_else(|| panic!("{option}: {command:?}")) + 1].as_str()
        };
        let own_chain = format!("{} → {}", after("--start"), after("--end"));
        let own_place: Vec<&str> = after("--target").split(',').collect();
        let row = rows.iter().find(|row| {
            row[chain] == own_chain
                && row[solver] == after("--solver")
                && row[iterations] == after("--iterations")
                && place.map(|axis| row[axis]) == own_place[..]
        });
        let row = row.unwrap_or_else(|| panic!("not in the CSV: {command:?}"));
        let words: Vec<&str> = command.iter().map(String::as_str).collect();
        let summary = folder.succeed(&[&words[..], &["--json", "--quiet"]].concat());
        let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
        let left = summary["worst"]["distance"].as_f64().unwrap();
        let wanted: f64 = row[residual].parse().unwrap();
        // The same computation, but for the last digit of where the root stands.
        assert!(
            (left - wanted).abs() <= 1e-9 * (1.0 + wanted),
            "{command:?} leaves {left:e}, not {wanted:e}"
        );
    }
    commands.len()
}

#[test]
fn the_commands_in_the_report_leave_what_it_says() {
    let folder = Folder::with_arm();
    let output = ["-o", "s.html", "--no-times", "--quiet"];
    study(
        &folder,
        &[
            &["sample:walk", "--target", "a=0.3,1.2,0.4"][..],
            &["--target", "-0.2,0.6,0.3"],
            &output,
        ]
        .concat(),
    );
    // Seven solvers at the first target, one at the second and at both with two more chains, and seven worst cases.
    assert_eq!(commands_leave_what_the_csv_says(&folder), 7 + 1 + 2 * 2 + 7);
    let few = ["--random", "3", "--grid", "0", "--iterations", "1,9"];
    let run = |args: &[&str]| {
        folder.succeed(&[&["ik-study"], args, &output, &few].concat());
        assert_eq!(commands_leave_what_the_csv_says(&folder), 14);
    };
    let arm = ["arm.bvh", "--chain", "base:elbow_end"];
    run(&[&arm[..], &["--frame", "2"]].concat());
    run(&[&arm[..], &["--root=-1,2.5,3", "--root-offset", "add"]].concat());
    let climbing = ["--chain", "LeftToes_end:RightHand"];
    run(&[&["sample:walk", "--frame", "40"][..], &climbing].concat());
}

#[test]
fn targets_out_of_reach_are_said_so_and_count_in_no_success() {
    let folder = Folder::with_arm();
    let args = ["sample:walk", "-o", "s.html", "--no-times", "--quiet"];
    let chain = ["--chain", "LeftUpperArm:LeftHand"];
    let targets = ["--target", "far=9,1,1", "--target", "near=0.4,1.2,0.2"];
    study(&folder, &[&args[..], &chain, &targets].concat());
    let text = folder.read("s.md");
    assert!(text.contains("**Target** `far`. With") && text.contains(": out of reach, so no pose"));
    assert!(text.contains("**Target** `near`. With"), "{text}");
    assert!(text.contains("**out of reach** of `LeftUpperArm → LeftHand` (by 8."));
    let csv = folder.read("s.csv");
    let mut nearest = 0;
    // Names of the grid have commas in them.
    for line in csv.lines().skip(1).filter(|line| !line.contains('"')) {
        let cells: Vec<&str> = line.split(',').collect();
        let (beyond, reached, near) = (cells[7], cells[13], cells[14]);
        assert!(beyond == "0" || reached == "0", "{line}");
        assert!(beyond == "0" || cells[16].is_empty(), "{line}");
        nearest += usize::from(beyond != "0" && near == "1");
    }
    assert!(nearest > 0, "some chains are stretched out");
}

/// Plain CCD in NumPy (`tools/ik_reference.py`, which shares nothing with the solver but the definition) has the
/// same residuals, and from them the report's figures on CCD follow. Reads `course/motion_walking.bvh`.
#[test]
fn the_figures_on_ccd_are_those_of_plain_numpy() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    let file = data.join("course/motion_walking.bvh");
    let file = file.to_str().unwrap();
    let args = ["ik-study", file, "-o", "s.html", "--quiet", "--no-times"];
    let what = [
        "--solver",
        "ccd",
        "--random",
        "20",
        "--unreachable",
        "3",
        "--grid",
        "2",
    ];
    let counts = ["--iterations", "1,2,5,10,16,18,20,25,30,50,100"];
    let shelf = ["--target", "shelf=0.4,1.5,0.3", "--target", "0.5,0.75,0.5"];
    folder.succeed(&[&args[..], &what, &counts, &shelf].concat());
    let tools = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tools");
    let script = format!(
        "import sys\nsys.path.insert(0, {:?})\nfile = {file:?}\n{CCD_BY_NUMPY}",
        tools.to_str().unwrap()
    );
    if let Some(out) = python(&folder, &script) {
        assert_eq!(out, "good\n");
    }
}

const CCD_BY_NUMPY: &str = r#"
import csv, re
import numpy as np
from ik_reference import ccd, path_between, read_hierarchy

rows = list(csv.DictReader(open('s.csv', encoding='utf-8')))
counts = sorted({int(r['iterations']) for r in rows})
names, parents, offsets = read_hierarchy(file)
# Poses are in single precision, and that is where a solver starts.
single = lambda v: np.asarray(v, dtype=np.float32).astype(float)
places = []
for parent, offset in zip(parents, offsets):
    places.append(single([0, 0.931395, 0]) if parent < 0 else places[parent] + single(offset))

residuals, tolerances = {}, {}
for r in rows:
    key = r['chain'], r['target']
    if key in residuals: continue
    start, end = (names.index(name) for name in r['chain'].split(' → '))
    climbing, descending = path_between(parents, start, end)
    chain = climbing + descending
    # A root and an End Site are held at the start; the link at the top of a chain that climbs is rigid.
    held = parents[start] < 0 or names[start].endswith('_end')
    rigid = {len(chain) - 1} | ({0} if held else set()) | ({len(climbing) - 1} if len(climbing) > 1 else set())
    pivots = [index for index in range(len(chain)) if index not in rigid]
    target = np.array([float(r[axis]) for axis in 'xyz'])
    residuals[key] = ccd(np.array([places[joint] for joint in chain]), pivots, target, counts[-1], False)
    tolerances[key] = float(r['tolerance'])

for r in rows:
    key, count = (r['chain'], r['target']), int(r['iterations'])
    plain, ours = residuals[key][count - 1], float(r['residual'])
    assert abs(plain - ours) < 1e-9 + 1e-5 * plain, (key, count, plain, ours)
    needed = next((i + 1 for i, left in enumerate(residuals[key]) if left <= tolerances[key]), None)
    if float(r['beyond_reach']) == 0:
        assert r['iterations_to_tolerance'] == ('' if needed is None else str(needed)), (key, needed)

# From NumPy's residuals: what the report says in words and tables.
text = open('s.md', encoding='utf-8').read()
main = rows[0]['chain']
def row(caption, first):
    after = text[text.index(caption):]
    lines = [l for l in after.split('\n\n')[1].splitlines() if l.startswith('|')]
    cells = [[c.strip(' *') for c in l.split('|')[1:-1]] for l in lines]
    return next(c for c in cells if c[0] == str(first))[1:]
sample = [key for key in residuals if key[0] == main and key[1].startswith('reachable')]
assert len(sample) == 20
write = lambda value, digits: '< 1e-12' if value < 1e-12 else re.sub(r'e-0*', 'e-', f'{value:.{digits}e}')
for count in counts:
    left = np.array([residuals[key][count - 1] for key in sample])
    share = 100 * np.mean(left <= tolerances[sample[0]])
    written = row('Success by the number of iterations', count)[0]
    assert abs(float(written.strip(' %>')) - share) < 0.1, (count, share, written)
    assert row('The median residual of the same runs', count)[0] == write(np.median(left), 1), count
shelf, course = residuals[main, 'shelf'], residuals[main, 'target 2']
for count in counts:
    written = row('Residual of `RootJoint → lWrist_end` at the target `shelf`', count)[0]
    # As it is printed, but where rounding has a part in it.
    assert written == write(shelf[count - 1], 3) or float(written.strip('< ')) < 1e-9 > shelf[count - 1], (count, written)
assert f'20 iterations leave: CCD {write(course[19], 3)}.' in text and write(course[19], 3) == '2.786e-2'
needed = next(i + 1 for i, left in enumerate(course) if left <= tolerances[main, 'target 2'])
assert f'CCD after {needed}' in text[text.index('at the target `target 2`'):]

# More iterations never make CCD worse, in NumPy as in the report.
assert all(b <= a + 1e-12 for left in residuals.values() for a, b in zip(left, left[1:]))
assert row('Do more iterations ever make it worse?', 'CCD') == ['0', '0', '–']
assert "no solver's residual ever rose" in text
print('good')
"#;

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
