//! How it was done: the problem, the solvers, what is measured.

use super::super::document::{Block, Document, Entry, Table};
use super::super::method::Method;
use super::super::moving::FRAMES;
use super::{Numbers, counted, listed};

pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    document.paragraph(
        "Forward kinematics follows the chain from joint to joint, $Qᵢ = Qᵢ₋₁ Rᵢ$ and $pᵢ = pᵢ₋₁ + Qᵢ₋₁ lᵢ$, with \
         rotations $R$ and bones $l$; it gives the end's place $f(θ)$. A solver looks for rotations with $f(θ) = x′$, \
         where $x′$ is the target, and leaves the error $e = x′ − f(θ)$. All solvers work on the same chains, without \
         limits on joints, and from the same pose. The joint at which a chain starts keeps its place.",
    );
    document.paragraph(
        "**Precision.** The start pose is in single precision (32-bit numbers), as posekit keeps all poses. From it each \
         solver computes in double precision (64-bit), and residuals and joint motion are taken from its result before that is \
         rounded: they are in double precision, where rounding leaves about $10⁻¹⁵$ of the figure's size. The poses in the \
         pictures and in the BVH file are that result rounded to single precision, which moves the end by about $10⁻⁷$ of the \
         figure's size. A pose that follows a moving target is rounded in the same way from each frame to the next.",
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
    document.paragraph(
        "Every solver that iterates gives the best pose of its iterations, so that more of them never leave more. A chain that \
         rests farther from its target than the tolerance, such as a straight arm in line with it, is bent a little and goes on \
         from there; one that rests within the tolerance stays as it is.",
    );
    document.blocks.push(Block::Table(Table {
        caption: format!(
            "The solvers as they run here, with their defaults.{}",
            jacobian_words(&study.methods)
        ),
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
            "$|e|$, the distance that is left between the end and the target, in the file's unit.".to_owned(),
        ),
        (
            "miss".to_owned(),
            "the residual less the distance by which the target is out of reach: what a better pose could still gain. \
             Within reach it is the residual."
                .to_owned(),
        ),
        (
            "reached".to_owned(),
            "the target is within reach, and the residual within the tolerance of the chain: a thousandth of its reach, \
             unless the command says otherwise. Of a target out of reach the report says whether the miss is within the \
             tolerance."
                .to_owned(),
        ),
        (
            "iterations".to_owned(),
            format!(
                "each solver ran anew from the start pose with {} iterations, and stopped earlier only where it came to rest by \
                 itself. For the table of effort and the ranking it ran once more and stopped within the tolerance.",
                super::listed(&counts)
            ),
        ),
        (
            "joint motion".to_owned(),
            "the angles by which the joints differ from the start pose, added up: how much the figure had to move.".to_owned(),
        ),
        (
            "time".to_owned(),
            "of one call of a solver, on one core, with its memory warm; medians over targets.".to_owned(),
        ),
        (
            "roughness".to_owned(),
            format!(
                "of the motion behind a target that moves for {FRAMES} frames: $√(Σ|ωₜ₊₁ − ωₜ|² / Σ|ωₜ|²)$ with the turns \
                 $ω$ of all joints from frame to frame. 0 is an even motion, 2 one that goes back and forth."
            ),
        ),
    ]));
    document.paragraph(format!(
        "Pictures show the pose after {} unless they say otherwise: the chain in blue, its start in grey, the target in red, and a \
         red line where the end misses it. Quantiles are those of Hyndman and Fan's definition 7, as in NumPy.",
        counted(study.shown_count() as usize, "iteration")
    ));
}

/// What the Jacobian is and how far joints turn in an iteration, for those of the solvers that have one.
fn jacobian_words(methods: &[Method]) -> String {
    let clamped = methods
        .iter()
        .filter(|method| matches!(method, Method::Transpose | Method::Dls | Method::Sdls))
        .map(|method| method.name().to_owned());
    let clamped = listed(&clamped.collect::<Vec<_>>());
    let mut most = Vec::new();
    if !clamped.is_empty() {
        most.push(format!("45° with {clamped}"));
    }
    if methods.contains(&Method::Lm) {
        most.push("57° (one radian) with LM".to_owned());
    }
    match most.is_empty() {
        true => String::new(),
        false => format!(
            " $J$ is the Jacobian $∂f/∂θ$. In one iteration no joint turns by more than {}.",
            most.join(", and by more than ")
        ),
    }
}
