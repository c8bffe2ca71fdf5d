//! What the numbers mean, said from the numbers.

use super::super::document::{Block, Document, code};
use super::super::experiment::Cell;
use super::super::moving::Path;
use super::super::statistics::median;
use super::super::targets::Kind;
use super::moving::JUMP_RAD;
use super::worst::worst;
use super::{
    Numbers, counted, degrees, is_judged, judged_words, listed, micros, percent, scientific,
};

/// The main results, a sentence each.
pub(super) fn summary(numbers: Numbers<'_>) -> Vec<String> {
    let study = numbers.study;
    let mut sentences = vec![named_sentence(numbers)];
    sentences.extend(success_sentence(numbers, study.shown));
    sentences.extend(failure_sentence(numbers));
    sentences.extend(motion_sentence(numbers));
    sentences.extend(time_sentence(numbers));
    sentences.extend(moving_sentence(numbers));
    sentences
}

/// The chapter.
pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let mut points: Vec<String> = Vec::new();
    points.extend(iteration_sentence(numbers));
    points.extend(place_sentence(numbers));
    points.extend(chain_sentence(numbers));
    points.extend(worst_sentence(numbers));
    document.blocks.push(Block::List(points));
    document.section("Conclusion");
    document.paragraph(conclusion(numbers));
}

fn name(numbers: Numbers<'_>, method: usize) -> &'static str {
    numbers.study.methods[method].name()
}

/// Solvers with what they are ranked by, the best first; ties in the report's order.
fn ranked(numbers: Numbers<'_>, key: impl Fn(usize) -> Option<f64>) -> Vec<(usize, f64)> {
    let methods = 0..numbers.study.methods.len();
    let mut list: Vec<(usize, f64)> = methods
        .filter_map(|method| Some((method, key(method)?)))
        .collect();
    list.sort_by(|a, b| a.1.total_cmp(&b.1));
    list
}

/// All that share the first place.
fn leaders(numbers: Numbers<'_>, ranked: &[(usize, f64)]) -> Vec<String> {
    let best = ranked.first().map_or(0.0, |first| first.1);
    let first = ranked.iter().take_while(|(_, key)| *key <= best);
    first
        .map(|&(method, _)| name(numbers, method).to_owned())
        .collect()
}

fn named_sentence(numbers: Numbers<'_>) -> String {
    let study = numbers.study;
    let residual = |method| {
        let cell = Cell {
            chain: 0,
            target: 0,
            method,
            count: study.shown,
        };
        numbers.results.run(cell).residual
    };
    let list = ranked(numbers, |method| Some(residual(method)));
    let each: Vec<String> = list
        .iter()
        .map(|&(method, residual)| format!("{} {}", name(numbers, method), scientific(residual)))
        .collect();
    let place = study.targets[0][0].place;
    format!(
        "**One target.** With {} at ({}, {}, {}), {} leave: {}.",
        code(&study.chains[0].name),
        place.x,
        place.y,
        place.z,
        counted(study.shown_count() as usize, "iteration"),
        listed(&each)
    )
}

fn success_sentence(numbers: Numbers<'_>, count: usize) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let list = ranked(numbers, |method| {
        numbers
            .success((0, method, count), is_judged)
            .map(|share| -share)
    });
    let (&(_, best), &(last, least)) = (list.first()?, list.last()?);
    let leaders = leaders(numbers, &list);
    let verb = if leaders.len() == 1 {
        "reaches"
    } else {
        "reach"
    };
    let rest = if least > best {
        format!(
            "; {} reaches the fewest, {}",
            name(numbers, last),
            percent(-least)
        )
    } else {
        String::new()
    };
    Some(format!(
        "**Success.** Of the {}, {} {verb} the most after {}: {}{rest}.",
        judged_words(study),
        listed(&leaders),
        counted(study.counts[count] as usize, "iteration"),
        percent(-best),
    ))
}

fn failure_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let last = numbers.last();
    let mut failing = Vec::new();
    let mut complete = Vec::new();
    for method in 0..study.methods.len() {
        let success = numbers.success((0, method, last), is_judged)?;
        if success < 1.0 {
            failing.push(format!(
                "{} {}",
                name(numbers, method),
                percent(1.0 - success)
            ));
        } else {
            complete.push(name(numbers, method).to_owned());
        }
    }
    let after = counted(study.counts[last] as usize, "iteration");
    let good = match complete.len() {
        0 => format!("no solver reaches them all after {after}"),
        1 => format!("{} reaches them all after {after}", complete[0]),
        _ => format!("{} reach them all after {after}", listed(&complete)),
    };
    let bad = if failing.is_empty() {
        String::new()
    } else {
        format!("; still missed are: {}", listed(&failing))
    };
    Some(format!("**Patience.** Of the same targets {good}{bad}."))
}

fn motion_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let success = |method| numbers.success((0, method, study.shown), is_judged);
    // A solver that does not get there has little motion for nothing.
    let list = ranked(numbers, |method| {
        success(method).filter(|&share| share >= 0.5)?;
        median(
            numbers
                .over((0, method, study.shown), is_judged)
                .map(|run| run.motion_rad),
        )
    });
    let (&(first, least), &(last, most)) = (list.first()?, list.last()?);
    if first == last {
        return None;
    }
    Some(format!(
        "**Motion.** Of the solvers that reach at least half of the targets, {} turns the joints least, {} in the median, and \
         {} most, {}.",
        name(numbers, first),
        degrees(least),
        name(numbers, last),
        degrees(most)
    ))
}

fn time_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    if !study.has_times {
        return None;
    }
    let is_judged = is_judged(study);
    let list = ranked(numbers, |method| {
        median(
            numbers
                .over((0, method, study.shown), is_judged)
                .map(|run| run.secs),
        )
    });
    let (&(first, least), &(last, most)) = (list.first()?, list.last()?);
    Some(format!(
        "**Time.** {} take {} with {} and {} with {} (medians, on the machine that wrote this).",
        counted(study.shown_count() as usize, "iteration"),
        micros(least),
        name(numbers, first),
        micros(most),
        name(numbers, last)
    ))
}

fn moving_sentence(numbers: Numbers<'_>) -> Option<String> {
    let circle = |method| {
        let mut found = numbers.following.iter();
        found.find(|followed| followed.method == method && followed.path == Path::Circle)
    };
    let tolerance = numbers.study.chains[0].tolerance;
    let list = ranked(numbers, |method| {
        let followed = circle(method)?;
        let largest = followed.misses.iter().copied().fold(0.0, f64::max);
        (largest <= 10.0 * tolerance).then_some(followed.roughness)
    });
    let jumps = numbers
        .following
        .iter()
        .filter(|followed| followed.largest_step_rad() > JUMP_RAD)
        .count();
    let jumps = match jumps {
        0 => "no solver jumped".to_owned(),
        1 => "one run of a solver jumped".to_owned(),
        count => format!("{} of solvers jumped", counted(count, "run")),
    };
    let &(first, roughness) = list.first()?;
    Some(format!(
        "**Moving targets.** {} follows a circle most evenly of those that stay at the target (roughness {roughness:.3}); on both \
         paths {jumps}.",
        name(numbers, first)
    ))
}

fn iteration_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let last = numbers.last();
    let mut gains = Vec::new();
    for method in 0..study.methods.len() {
        let before = numbers.median_miss((0, method, study.shown), is_judged)?;
        let after = numbers.median_miss((0, method, last), is_judged)?;
        let name = name(numbers, method);
        gains.push(if before <= 1e-7 * study.chains[0].reach {
            format!("{name} is done by then")
        } else if after > 0.95 * before {
            format!("{name} gains nothing more ({})", scientific(after))
        } else {
            format!(
                "{name} goes from {} to {}",
                scientific(before),
                scientific(after)
            )
        });
    }
    (last != study.shown).then(|| {
        format!(
            "**More iterations.** From {} to {} the median residual changes so: {}.",
            study.shown_count(),
            study.counts[last],
            gains.join("; ")
        )
    })
}

fn place_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let chain = &study.chains[0];
    let ring = |low: f64, high: f64| {
        let base = chain.base();
        let reach = chain.reach;
        move |target: &super::Target| {
            let share = base.distance(target.place) / reach;
            target.beyond == 0.0 && share > low && share <= high
        }
    };
    let mut harder = Vec::new();
    for method in 0..study.methods.len() {
        let near = numbers.success((0, method, study.shown), ring(0.0, 0.75))?;
        let far = numbers.success((0, method, study.shown), ring(0.9, 1.0))?;
        harder.push(format!(
            "{} {} and {}",
            name(numbers, method),
            percent(near),
            percent(far)
        ));
    }
    let out = ranked(numbers, |method| {
        let is_out = |target: &super::Target| target.kind == Kind::Unreachable;
        numbers
            .success((0, method, study.shown), is_out)
            .map(|share| -share)
    });
    let out = match (out.first(), out.last()) {
        (Some(&(_, best)), Some(&(last, least))) if least > best => format!(
            " Out of reach the best is a chain stretched straight: {} in {} of cases, {} in {}.",
            listed(&leaders(numbers, &out)),
            percent(-best),
            name(numbers, last),
            percent(-least)
        ),
        (Some(&(_, best)), Some(_)) => {
            format!(
                " Out of reach all solvers stretch the chain in {} of cases.",
                percent(-best)
            )
        }
        _ => String::new(),
    };
    Some(format!(
        "**Place.** Targets that nearly stretch the chain are another matter than those at ease. Reached within 75 % of reach and \
         beyond 90 %: {}.{out}",
        listed(&harder)
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
        let mean = shares.iter().sum::<f64>() / shares.len().max(1) as f64;
        each.push((mean, chain, chain.turning.len()));
    }
    let best = each.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let least = each.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(
        "**Chain.** In the mean of all solvers {}, with {} that turn, is the easiest: {} of its own targets are reached; {}, with {}, is \
         the hardest: {}. A chain with more joints has more ways to a place, and more to carry in an iteration.",
        code(&best.1.name),
        counted(best.2, "joint"),
        percent(best.0),
        code(&least.1.name),
        counted(least.2, "joint"),
        percent(least.0)
    ))
}

fn worst_sentence(numbers: Numbers<'_>) -> Option<String> {
    let list = ranked(numbers, |method| {
        worst(numbers, method).map(|(_, share)| -share)
    });
    let &(method, share) = list.first()?;
    let (run, _) = worst(numbers, method)?;
    let study = numbers.study;
    Some(format!(
        "**Worst.** The largest miss of all on {}, with as many iterations as were tried, is {}'s: {:.2} % of the reach of {}.",
        judged_words(study),
        name(numbers, method),
        -share * 100.0,
        code(&study.chains[run.cell.chain].name)
    ))
}

fn conclusion(numbers: Numbers<'_>) -> String {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let last = numbers.last();
    // Over all chains: how many are reached in the end, then how near after the usual count.
    let total = |method: usize, count: usize| {
        let shares = (0..study.chains.len())
            .filter_map(|chain| numbers.success((chain, method, count), is_judged));
        let shares: Vec<f64> = shares.collect();
        (!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64)
    };
    let by_success = ranked(numbers, |method| {
        Some(-total(method, study.shown)? - 1e-3 * total(method, last)?)
    });
    let Some(&(best, _)) = by_success.first() else {
        return "No target within reach was tried at random, and so nothing is concluded."
            .to_owned();
    };
    let success = total(best, study.shown).unwrap_or(0.0);
    let mut text = format!(
        "Over all chains and {}, {} is the solver to take for one end and one target: {} are reached within {}",
        judged_words(study),
        study.methods[best].facts().full_name,
        percent(success),
        counted(study.shown_count() as usize, "iteration")
    );
    if last != study.shown {
        let later = total(best, last).unwrap_or(0.0);
        text.push_str(&format!(
            ", {} within {}",
            percent(later),
            study.counts[last]
        ));
    }
    text.push('.');
    if let Some(&(second, _)) = by_success.get(1) {
        text.push_str(&format!(
            " {} follows with {}.",
            name(numbers, second),
            percent(total(second, study.shown).unwrap_or(0.0))
        ));
    }
    let few: Vec<String> = by_success
        .iter()
        .filter(|&&(method, _)| total(method, last).is_some_and(|share| share < 0.5))
        .map(|&(method, _)| name(numbers, method).to_owned())
        .collect();
    if !few.is_empty() {
        let verb = if few.len() == 1 { "is" } else { "are" };
        text.push_str(&format!(
            " {} {verb} not enough for these chains: fewer than half of the targets are reached even within {}.",
            listed(&few),
            counted(study.counts[last] as usize, "iteration")
        ));
    }
    text.push_str(
        " These figures hold for this figure without limits on its joints, from this pose; with limits or \
         several targets the order may change, and from another pose too, which `--frame` measures.",
    );
    text
}
