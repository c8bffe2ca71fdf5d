//! Targets that move.

use super::super::chart::{Axis, Chart, Panel, Series, draw};
use super::super::document::{Block, Document, Entry, Mark, Table, code};
use super::super::moving::{FRAMES, Following, Path};
use super::super::statistics::median;
use super::{Numbers, counted, degrees, mark_best, scientific};

/// A joint that turns farther than this from one frame to the next has jumped.
pub(super) const JUMP_RAD: f64 = core::f64::consts::FRAC_PI_4;

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let chain = &study.chains[0];
    document.section("Targets that move");
    document.paragraph(format!(
        "The end of {} follows a target for {FRAMES} frames; each frame is solved with {} from the pose of the frame before. \
         One target goes round a circle, 75 % of the reach away and with a radius of 15 % of the reach. The other goes from \
         60 % of the reach straight out to 115 %, where no pose can follow, and back. A small step of the target should \
         be a small step of every joint.",
        code(&chain.name),
        counted(study.shown_count() as usize, "iteration")
    ));
    for path in Path::ALL {
        write_table(document, numbers, path);
    }
    draw_steps(document, numbers);
    let jumps = numbers
        .following
        .iter()
        .filter(|followed| followed.largest_step_rad() > JUMP_RAD);
    let jumps = jumps.map(|followed| {
        let name = study.methods[followed.method].name();
        let step = degrees(followed.largest_step_rad());
        format!("{name} ({}, {step})", followed.path.name())
    });
    let jumps: Vec<String> = jumps.collect();
    document.paragraph(if jumps.is_empty() {
        format!(
            "No joint turned by more than {} from one frame to the next: no solver jumped.",
            degrees(JUMP_RAD)
        )
    } else {
        format!(
            "A joint turned by more than {} from one frame to the next, which looks like a jump, with {}.",
            degrees(JUMP_RAD),
            super::listed(&jumps)
        )
    });
}

fn of_path(numbers: Numbers<'_>, path: Path) -> impl Iterator<Item = &Following> {
    numbers
        .following
        .iter()
        .filter(move |followed| followed.path == path)
}

fn write_table(document: &mut Document, numbers: Numbers<'_>, path: Path) {
    let study = numbers.study;
    let mut rows = Vec::new();
    let mut keys: Vec<[f64; 5]> = Vec::new();
    for followed in of_path(numbers, path) {
        let middle = median(followed.misses.iter().copied()).unwrap_or(0.0);
        let largest = followed.misses.iter().copied().fold(0.0, f64::max);
        let step = followed.largest_step_rad();
        let mut row = vec![
            Entry::new(study.methods[followed.method].name()),
            Entry::new(scientific(middle)),
            Entry::new(scientific(largest)),
            Entry::new(degrees(followed.motion_rad)),
            Entry::new(degrees(step)),
            Entry::new(format!("{:.3}", followed.roughness)),
        ];
        if step > JUMP_RAD {
            row[4].mark = Mark::Bad;
        }
        rows.push(row);
        keys.push([
            middle,
            largest,
            followed.motion_rad,
            step,
            followed.roughness,
        ]);
    }
    // The median and the largest miss say how near; a solver that hardly moves is smooth for nothing, so motion,
    // step and roughness are not ranked.
    for column in [0, 1] {
        let values: Vec<_> = keys.iter().map(|keys| Some(keys[column])).collect();
        mark_best(&mut rows, column + 1, &values, true);
    }
    let columns = [
        "solver",
        "median miss",
        "largest miss",
        "joint motion",
        "largest step",
        "roughness",
    ];
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "The target that goes {}: how much farther from it the end was than it has to be, how much all joints turned on the \
             whole way, the most that one joint turned from one frame to the next, and the roughness.",
            match path {
                Path::Circle => "round a circle",
                Path::OutAndBack => "out of reach and back",
            }
        ),
        columns: columns.map(str::to_owned).to_vec(),
        is_text: false,
        rows,
    }));
}

fn draw_steps(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let mut panels = Vec::new();
    let mut values = Vec::new();
    for (method, solver) in study.methods.iter().enumerate() {
        let mut series = Vec::new();
        for path in Path::ALL {
            let followed = of_path(numbers, path).find(|followed| followed.method == method);
            let steps = followed.map_or(&[][..], |followed| followed.steps_rad.as_slice());
            let points = steps.iter().enumerate().map(|(frame, step)| {
                let degrees = step.to_degrees().max(1e-3);
                [(frame + 1) as f64, degrees]
            });
            let points: Vec<[f64; 2]> = points.collect();
            values.extend(points.iter().map(|point| point[1]));
            series.push(Series {
                style: solver.index(),
                is_dashed: path == Path::OutAndBack,
                points,
                ..Series::default()
            });
        }
        panels.push(Panel {
            title: solver.name().to_owned(),
            series,
        });
    }
    let svg = draw(&Chart {
        alt: "the largest turn of a joint from frame to frame, a panel for each solver".to_owned(),
        x: Axis::even(
            "frame",
            [0.0, f64::from(FRAMES)],
            &[
                (0.0, "0"),
                (30.0, "30"),
                (60.0, "60"),
                (90.0, "90"),
                (120.0, "120"),
            ],
        ),
        y: Axis::powers_of_ten(
            "largest turn of a joint since the frame before, degrees",
            values,
            1e-3,
        ),
        columns: panels.len().min(4),
        panels,
        bound: None,
    });
    document.blocks.push(Block::Drawing {
        svg,
        caption: "The most that one joint turns from frame to frame: the full line round the circle, the dashed line out of reach \
                  and back (out of reach in the middle third). A flat line is a smooth motion, a peak is a jerk."
            .to_owned(),
    });
}
