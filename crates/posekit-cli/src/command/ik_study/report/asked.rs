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
                "in its rest pose, with the root at ({}, {}, {}),",
                root.x, root.y, root.z
            )
        }
        Some(frame) => format!("in frame {frame} of the motion"),
    };
    document.paragraph(format!(
        "Inverse kinematics asks which joint rotations bring the end of a chain of joints to a given place. This study \
         compares {} on the figure of {}, which has {} and starts {start} in every run. It asks four questions. How near \
         does each solver come, and after how many iterations? What do the place of the target and the choice of the chain \
         change? What does it cost, in time and in motion? And does the pose follow a moving target without jumping?",
        counted(study.methods.len(), "solver"),
        code(&study.input),
        counted(study.skeleton.joint_count(), "joint"),
    ));
    let shot = document.shot(Shot::Start(0));
    let chain = &study.chains[0];
    let grid = if study.grid > 0 {
        ", the smaller balls are the targets of the grid"
    } else {
        ""
    };
    document.blocks.push(Block::Pictures(PictureTable {
        caption: format!(
            "The start. The chain {} is blue; the red balls with names are the named targets{grid}.",
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
                "up to {}, then down; the start stays in place and the root moves",
                name(&chain.chain.top())
            )
        } else {
            "down; the start stays in place".to_owned()
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
        caption: "The chains. The reach is how far the end gets from the first joint that turns when all bones lie in \
                  line. Lengths are in the file's unit."
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
    let named = study.targets[0].iter().enumerate();
    for (index, target) in named.filter(|(_, target)| target.kind == Kind::Named) {
        let place = target.place;
        let away = study.chains[0].base().distance(place) / study.chains[0].reach;
        points.push(format!(
            "{} at ({}, {}, {}), named: {:.1} % of the reach of {} away from its base{}.",
            code(&target.name),
            place.x,
            place.y,
            place.z,
            away * 100.0,
            code(&study.chains[0].name),
            out_of_reach_words(numbers, index),
        ));
    }
    let grid = count(|kind| matches!(kind, Kind::Grid { .. }));
    if grid > 0 {
        let outside = study.targets[0]
            .iter()
            .filter(|target| matches!(target.kind, Kind::Grid { .. }) && target.is_out_of_reach())
            .count();
        points.push(format!(
            "**A grid** of {side} by {side} targets on an upright plane through the first named target, centred on the base of the \
             first chain and 1.6 of its reaches wide and high. {} of them {} out of its reach.",
            if outside == 0 { "None".to_owned() } else { crate::text::grouped(outside) },
            super::summary::agree(outside, "is", "are"),
            side = study.grid,
        ));
    }
    let reachable = count(|kind| kind == Kind::Reachable);
    if reachable > 0 {
        points.push(format!(
            "**{} at random within reach** of each chain: where its end is when every joint turns by 0° to 90° about an axis in \
             any direction. So each of them can be reached (seed {}).",
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
    document.paragraph(
        "Targets out of reach are left out of every success rate: for them the report says separately how near the solvers come to the nearest place that there is.",
    );
}

/// For which chains a target is out of reach, and by how much.
fn out_of_reach_words(numbers: Numbers<'_>, target: usize) -> String {
    let study = numbers.study;
    let lists = study.chains.iter().zip(&study.targets);
    let out = lists.filter(|(_, list)| list[target].is_out_of_reach());
    let out = out.map(|(chain, list)| {
        let beyond = length(list[target].beyond, chain.reach);
        format!("{} (by {beyond})", code(&chain.name))
    });
    let out: Vec<String> = out.collect();
    if out.is_empty() {
        String::new()
    } else {
        format!("; **out of reach** of {}", super::listed(&out))
    }
}
