//! What was asked: the figure, its chains, the targets. And how to ask it again.

use super::super::document::{
    Block, Document, Entry, PictureEntry, PictureTable, Shot, Table, code,
};
use super::super::targets::Kind;
use super::{Numbers, counted, length, scientific};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let start = match study.start_frame {
        None => {
            let root = study.chains[0].root_place;
            format!(
                "in its rest pose, the root at ({}, {}, {}),",
                root.x, root.y, root.z
            )
        }
        Some(frame) => format!("in frame {frame} of the motion"),
    };
    document.paragraph(format!(
        "Inverse kinematics asks which joint rotations bring the end of a chain of joints to a place. This study \
         compares {} on the figure of {}, which has {} and starts {start} in every run. It asks four things: how near \
         does each solver come after how many iterations; what does the place of the target change, and what the \
         choice of the chain; what does it cost, in time and in motion; and does the pose follow a target that moves \
         without a jump.",
        counted(study.methods.len(), "solver"),
        code(&study.input),
        counted(study.skeleton.joint_count(), "joint"),
    ));
    let shot = document.shot(Shot::Start(0));
    let chain = &study.chains[0];
    let grid = if study.grid > 0 {
        ", the smaller balls the targets of the grid"
    } else {
        ""
    };
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "Where it starts. The chain {} is blue; the red balls with names are the targets that were named{grid}.",
            code(&chain.name)
        ),
        columns: Vec::new(),
        rows: vec![(
            String::new(),
            vec![PictureEntry {
                shot,
                alt: format!("the figure with the chain {} and its targets", chain.name),
                lines: Vec::new(),
            }],
        )],
    }));
    document.section("The chains");
    let rows = study.chains.iter().map(|chain| {
        let name = |joint: &posekit::skeleton::JointId| code(study.skeleton.unique_name(*joint));
        let joints: Vec<String> = chain.turning.iter().map(name).collect();
        let way = if chain.climbs() {
            format!(
                "climbs to {} and goes down; the start stays, the root moves",
                name(&chain.chain.top())
            )
        } else {
            "goes down; the start stays".to_owned()
        };
        vec![
            Entry::new(code(&chain.name)),
            Entry::new(joints.join(", ")),
            Entry::new(way),
            Entry::new(length(chain.reach, chain.reach)),
            Entry::new(scientific(chain.tolerance)),
        ]
    });
    let rows = rows.collect();
    document.blocks.push(Block::Table(Table {
        caption: "The chains. The reach is the distance to which the end gets from the first joint that turns when \
                  all bones lie in line; lengths are in the file's unit."
            .to_owned(),
        columns: ["chain", "joints that turn", "way", "reach", "tolerance"].map(str::to_owned).to_vec(),
        is_text: true,
        rows,
    }));
    document.section("The targets");
    write_targets(document, numbers);
}

fn write_targets(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let count = |is_of: fn(Kind) -> bool| {
        study.targets[0]
            .iter()
            .filter(|target| is_of(target.kind))
            .count()
    };
    let mut points = Vec::new();
    for target in study.targets[0]
        .iter()
        .filter(|target| target.kind == Kind::Named)
    {
        let place = target.place;
        let away = study.chains[0].base().distance(place) / study.chains[0].reach;
        let out = if target.beyond > 0.0 {
            ", which is out of reach"
        } else {
            ""
        };
        points.push(format!(
            "**{}** at ({}, {}, {}): {:.1} % of the reach of {} away from its base{out}.",
            target.name,
            place.x,
            place.y,
            place.z,
            away * 100.0,
            code(&study.chains[0].name),
        ));
    }
    let grid = count(|kind| matches!(kind, Kind::Grid { .. }));
    if grid > 0 {
        let outside = study.targets[0]
            .iter()
            .filter(|target| matches!(target.kind, Kind::Grid { .. }) && target.beyond > 0.0)
            .count();
        points.push(format!(
            "**A grid** of {side} by {side} targets on an upright plane through the first named target, as wide and \
             high as 1.6 reaches of the first chain around its base; {outside} of them are out of its reach.",
            side = study.grid,
        ));
    }
    let reachable = count(|kind| kind == Kind::Reachable);
    if reachable > 0 {
        points.push(format!(
            "**{} at random within reach** of each chain: where its end was after every joint had been turned by 0° to \
             90° about an axis of any direction. So each of them can be reached (seed {}).",
            counted(reachable, "target"),
            study.seed,
        ));
    }
    let unreachable = count(|kind| kind == Kind::Unreachable);
    if unreachable > 0 {
        points.push(format!(
            "**{} at random out of reach** of each chain: in any direction, 1.05 to 1.5 reaches away from its base.",
            counted(unreachable, "target"),
        ));
    }
    document.blocks.push(Block::List(points));
}

pub(super) fn write_command(document: &mut Document, numbers: Numbers<'_>, command: &str) {
    document
        .paragraph("This command writes this report again, with the same numbers and pictures:");
    document.blocks.push(Block::Code(command.to_owned()));
    let times = if numbers.study.has_times {
        "Times, which differ from run to run, are in the tables of effort and in the CSV's last column only; with \
         `--no-times` they are left out and all files are the same to the byte."
    } else {
        "It was written with `--no-times`: all files are the same to the byte whenever it is run."
    };
    document.paragraph(format!(
        "Beside the report lie all runs as CSV, a line each; this text as Markdown; and the poses of the named targets \
         as a BVH file, whose frames the CSV's column `pose_frame` names. Forward kinematics of those poses gives the \
         residuals of the CSV: `posekit fk` and three lines of NumPy check this report. {times}"
    ));
}
