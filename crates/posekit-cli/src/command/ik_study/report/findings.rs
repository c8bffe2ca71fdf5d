//! What the numbers mean, said from the numbers.

use super::super::document::{Block, Document, code};
use super::super::targets::Target;
use super::summary::{agree, leaders, ranked};
use super::worst::worst;
use super::{
    Numbers, ROUNDING, counted, is_judged, judged_words, listed, percent, roughly, scientific,
};

/// The chapter, up to the ranking.
pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let mut points: Vec<String> = Vec::new();
    points.extend(iteration_sentence(numbers));
    points.extend((numbers.study.counts.len() > 1).then(|| loss_sentence(numbers)));
    points.extend(place_sentence(numbers));
    points.extend(out_of_reach_sentence(numbers));
    points.extend(chain_sentence(numbers));
    points.extend(two_bone_sentence(numbers));
    points.extend(worst_sentence(numbers));
    document.blocks.push(Block::List(points));
}

fn iteration_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let last = numbers.last();
    let mut gains = Vec::new();
    for method in 0..study.methods.len() {
        let before = numbers.median_miss((0, method, study.shown), is_judged)?;
        let after = numbers.median_miss((0, method, last), is_judged)?;
        let name = numbers.name(method);
        gains.push(if before < ROUNDING {
            format!("{name} has nothing left to gain")
        } else if after > 0.95 * before {
            format!("{name} stays at {}", roughly(after))
        } else {
            format!("{name} goes from {} to {}", roughly(before), roughly(after))
        });
    }
    (last != study.shown).then(|| {
        format!(
            "**More iterations.** From {} to {} iterations the median residual changes as follows: {}.",
            study.shown_count(),
            study.last_count(),
            gains.join("; ")
        )
    })
}

/// Targets that solvers reached and lost again.
fn loss_sentence(numbers: Numbers<'_>) -> String {
    let study = numbers.study;
    let all: usize = study.targets.iter().map(Vec::len).sum();
    let losing: Vec<String> = (0..study.methods.len())
        .map(|method| (method, super::iterations::losses(numbers, method)))
        .filter(|(_, losses)| losses.lost > 0)
        .map(|(method, losses)| format!("{} {}", numbers.name(method), losses.lost))
        .collect();
    let rising: Vec<String> = (0..study.methods.len())
        .filter(|&method| super::iterations::losses(numbers, method).rose > 0)
        .map(|method| numbers.name(method))
        .collect();
    let lost = if losing.is_empty() {
        format!(
            "No solver lost any of the {} targets of all chains again once it had come as near as the tolerance",
            crate::text::grouped(all)
        )
    } else {
        format!(
            "Of the {} targets of all chains, some were within the tolerance after fewer iterations and not after more: {}",
            crate::text::grouped(all),
            listed(&losing)
        )
    };
    let rose = match rising.len() {
        0 => "no solver's residual ever rose from one of the numbers of iterations to the next"
            .to_owned(),
        _ => format!(
            "the residual rose from one of the numbers of iterations to the next at some target with {}",
            listed(&rising)
        ),
    };
    format!("**Never worse?** {lost}; {rose}.")
}

fn place_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let chain = &study.chains[0];
    let ring = |low: f64, high: f64| {
        let base = chain.base();
        let reach = chain.reach;
        move |target: &Target| {
            let share = base.distance(target.place) / reach;
            !target.is_out_of_reach() && share > low && share <= high + 1e-9
        }
    };
    let mut each = Vec::new();
    for method in 0..study.methods.len() {
        let near = numbers.success((0, method, study.shown), ring(-1.0, 0.75))?;
        let far = numbers.success((0, method, study.shown), ring(0.9, 1.0))?;
        let name = numbers.name(method);
        each.push(format!("{name} {} and {}", percent(near), percent(far)));
    }
    Some(format!(
        "**Place.** A target that nearly stretches the chain is a different task from one well within reach. Reached in {}, first of the \
         targets nearer than 75 % of the reach, then of those beyond 90 %: {}.",
        counted(study.shown_count() as usize, "iteration"),
        each.join("; ")
    ))
}

fn out_of_reach_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let out = ranked(numbers, |method| {
        numbers
            .success((0, method, study.shown), Target::is_out_of_reach)
            .map(|share| -share)
    });
    let (&(_, best), &(_, least)) = (out.first()?, out.last()?);
    let after = counted(study.shown_count() as usize, "iteration");
    let rule = "Where the target is too far, the best that can be done is a chain stretched straight towards it";
    if least <= best {
        return Some(format!(
            "**Out of reach.** {rule}; every solver comes that near, within the tolerance, in {} of these cases in {after}. They are left out of every success rate.",
            percent(-best)
        ));
    }
    let leaders = leaders(numbers, &out);
    let last: Vec<String> = out
        .iter()
        .filter(|&&(_, share)| share >= least)
        .map(|&(method, _)| numbers.name(method))
        .collect();
    Some(format!(
        "**Out of reach.** {rule}. In {after} {} {} within the tolerance of that in {} of these cases, {} in {}. They are left out of every success rate.",
        listed(&leaders),
        agree(leaders.len(), "comes", "come"),
        percent(-best),
        listed(&last),
        percent(-least)
    ))
}

fn chain_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    if study.chains.len() < 2 {
        return None;
    }
    let is_judged = is_judged(study);
    let mut each = Vec::new();
    for (index, chain) in study.chains.iter().enumerate() {
        let shares: Vec<f64> = (0..study.methods.len())
            .filter_map(|method| numbers.success((index, method, study.shown), is_judged))
            .collect();
        if shares.is_empty() {
            return None;
        }
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        each.push((mean, chain, chain.turning.len()));
    }
    let best = each.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let least = each.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let after = counted(study.shown_count() as usize, "iteration");
    if best.0 - least.0 < 1e-9 {
        return Some(format!(
            "**Chain.** On average over the solvers, {} of each chain's own targets are reached in {after}, whichever the chain.",
            percent(best.0)
        ));
    }
    Some(format!(
        "**Chain.** On average over the solvers, {}, in which {}, is the easiest: {} of its own targets are reached in {after}. \
         {}, in which {}, is the hardest: {}. A longer chain has more ways to reach a place, and more joints to turn in every \
         iteration.",
        code(&best.1.name),
        turning(best.2),
        percent(best.0),
        code(&least.1.name),
        turning(least.2),
        percent(least.0)
    ))
}

fn turning(count: usize) -> String {
    format!(
        "{} {}",
        counted(count, "joint"),
        agree(count, "turns", "turn")
    )
}

/// What two bones can reach at all, which is not what the chain can.
fn two_bone_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_two_bone = |&method: &super::super::method::Method| method.is_two_bone();
    let method = study.methods.iter().position(is_two_bone)?;
    let chain = &study.chains[0];
    let is_judged = is_judged(study);
    let judged: Vec<&Target> = study.targets[0]
        .iter()
        .filter(|target| is_judged(target))
        .collect();
    if judged.is_empty() || chain.turning.len() < 2 {
        return None;
    }
    let possible = judged
        .iter()
        .filter(|target| chain.two_bones_reach(target.place))
        .count();
    let runs = numbers.over((0, method, study.shown), move |target| {
        is_judged(target) && chain.two_bones_reach(target.place)
    });
    let reached = runs.filter(|run| run.miss <= chain.tolerance).count();
    Some(format!(
        "**Two bones.** {} turns two joints and no more, so its success says how many targets lie within reach of these two: {} \
         of the {} of {}. Of them it reaches {}.",
        numbers.name(method),
        crate::text::grouped(possible),
        crate::text::grouped(judged.len()),
        code(&chain.name),
        if reached == possible {
            "all".to_owned()
        } else {
            crate::text::grouped(reached)
        },
    ))
}

fn worst_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let list = ranked(numbers, |method| {
        worst(numbers, method).map(|(_, share)| -share)
    });
    let &(method, share) = list.first()?;
    let (run, _) = worst(numbers, method)?;
    let chain = &study.chains[run.cell.chain];
    if run.miss <= chain.tolerance {
        return Some(format!(
            "**Worst case.** In {} every solver comes to each of the {} of all chains within the tolerance.",
            counted(study.last_count() as usize, "iteration"),
            judged_words(study)
        ));
    }
    Some(format!(
        "**Worst case.** After {}, the farthest that a solver stays from any of the {} is {} ({:.2} % of the reach of {}), with {}.",
        counted(study.last_count() as usize, "iteration"),
        judged_words(study),
        scientific(run.miss),
        -share * 100.0,
        code(&chain.name),
        numbers.name(method),
    ))
}
