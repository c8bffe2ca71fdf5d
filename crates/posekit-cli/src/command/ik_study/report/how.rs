//! How it was done: the problem, the solvers, what is measured.

use super::super::document::{Block, Document, Entry, Table};
use super::super::moving::FRAMES;
use super::{Numbers, counted};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.paragraph(
        "Forward kinematics follows the chain from joint to joint, $Qᵢ = Qᵢ₋₁ Rᵢ$ and $pᵢ = pᵢ₋₁ + Qᵢ₋₁ lᵢ$, with \
         rotations $R$ and bones $l$; it gives the end's place $f(θ)$. A solver looks for rotations with $f(θ) = x′$, \
         where $x′$ is the target, and leaves the error $e = x′ − f(θ)$. All work on the same chains in double \
         precision, without limits on joints, and from the same pose; the joint at which a chain starts keeps its \
         place.",
    );
    document.section("The solvers");
    let rows = study.methods.iter().map(|method| {
        let facts = method.facts();
        vec![
            Entry::new(format!("{}, {}", facts.name, facts.full_name)),
            Entry::new(facts.step),
            Entry::new(facts.source),
        ]
    });
    let rows = rows.collect();
    document.blocks.push(Block::Table(Table {
        caption:
            "The solvers, each as published and with its defaults. $J$ is the Jacobian $∂f/∂θ$."
                .to_owned(),
        columns: ["solver", "one iteration", "source"]
            .map(str::to_owned)
            .to_vec(),
        is_text: true,
        rows,
    }));
    document.section("What is measured");
    let counts: Vec<String> = study.counts.iter().map(u32::to_string).collect();
    document.blocks.push(Block::Terms(vec![
        (
            "residual".to_owned(),
            "$|e|$, the distance between the end and the target that is left, in the file's unit.".to_owned(),
        ),
        (
            "miss".to_owned(),
            "the residual less the distance by which the target is out of reach: what a better pose could have saved. \
             Within reach it is the residual."
                .to_owned(),
        ),
        (
            "reached".to_owned(),
            "the miss is within the tolerance of the chain, a thousandth of its reach unless it was given.".to_owned(),
        ),
        (
            "iterations".to_owned(),
            format!(
                "each solver was run anew with {} iterations; it stopped earlier only where it came to rest by itself.",
                super::listed(&counts)
            ),
        ),
        (
            "joint motion".to_owned(),
            "the angles by which all joints differ from the start pose, added up: how much the figure had to move.".to_owned(),
        ),
        (
            "time".to_owned(),
            "of one call of a solver, on one core, memory warm; medians over targets.".to_owned(),
        ),
        (
            "roughness".to_owned(),
            format!(
                "of the motion behind a target that moves in {FRAMES} frames: $√(Σ|ωₜ₊₁ − ωₜ|² / Σ|ωₜ|²)$ with the turns \
                 $ω$ of all joints from frame to frame. 0 is an even motion, 2 one that goes back and forth."
            ),
        ),
    ]));
    document.paragraph(format!(
        "Poses are shown after {} unless it says otherwise: the chain blue, where it was before grey, the target red, and \
         a red line where the end misses it. Quantiles are those of Hyndman and Fan's definition 7, NumPy's.",
        counted(study.shown_count() as usize, "iteration")
    ));
}
