//! The main results, a sentence each, made from the numbers.

use super::super::document::code;
use super::super::experiment::Cell;
use super::super::moving::Path;
use super::super::statistics::median;
use super::super::targets::{Kind, Target};
use super::moving::JUMP_RAD;
use super::ranking::{standings, winners};
use super::{
    Numbers, ROUNDING, counted, degrees, is_judged, judged_words, listed, micros, percent,
    scientific,
};

/// Of a circle that is followed: nobody is called the smoothest who falls behind by more tolerances.
const BEHIND: f64 = 10.0;

pub(super) fn write(numbers: Numbers<'_>) -> Vec<String> {
    let study = numbers.study;
    let named = study.targets[0].iter().enumerate();
    let named = named.filter(|(_, target)| target.kind == Kind::Named);
    let mut sentences: Vec<String> = named
        .map(|(index, target)| target_sentence(numbers, index, target))
        .collect();
    sentences.extend(success_sentence(numbers));
    sentences.extend(patience_sentence(numbers));
    sentences.extend(motion_sentence(numbers));
    sentences.extend(time_sentence(numbers));
    sentences.extend(moving_sentence(numbers));
    sentences.extend(ranking_sentence(numbers));
    sentences
}

/// Solvers with what they are ranked by, the least first; ties in the report's order.
pub(super) fn ranked(
    numbers: Numbers<'_>,
    key: impl Fn(usize) -> Option<f64>,
) -> Vec<(usize, f64)> {
    let methods = 0..numbers.study.methods.len();
    let mut list: Vec<(usize, f64)> = methods
        .filter_map(|method| Some((method, key(method)?)))
        .collect();
    list.sort_by(|a, b| a.1.total_cmp(&b.1));
    list
}

/// All that share the first place.
pub(super) fn leaders(numbers: Numbers<'_>, ranked: &[(usize, f64)]) -> Vec<String> {
    let best = ranked.first().map_or(0.0, |first| first.1);
    let first = ranked.iter().take_while(|(_, key)| *key <= best);
    first.map(|&(method, _)| numbers.name(method)).collect()
}

/// `reaches` for one, `reach` for several.
pub(super) fn agree(count: usize, one: &'static str, several: &'static str) -> &'static str {
    if count == 1 { one } else { several }
}

/// What the usual number of iterations leaves at a named target.
fn target_sentence(numbers: Numbers<'_>, index: usize, target: &Target) -> String {
    let study = numbers.study;
    let chain = &study.chains[0];
    let run = |method| {
        numbers.results.run(Cell {
            chain: 0,
            target: index,
            method,
            count: study.shown,
        })
    };
    let place = target.place;
    let title = format!(
        "{} With {} to ({}, {}, {})",
        title(target),
        code(&chain.name),
        place.x,
        place.y,
        place.z
    );
    let after = counted(study.shown_count() as usize, "iteration");
    if target.is_out_of_reach() {
        let methods = 0..study.methods.len();
        let (near, far): (Vec<usize>, Vec<usize>) =
            methods.partition(|&method| run(method).miss <= chain.tolerance);
        let names = |list: &[usize]| {
            let names: Vec<String> = list.iter().map(|&method| numbers.name(method)).collect();
            listed(&names)
        };
        let near = match near.len() {
            0 => "No solver comes within the tolerance of that".to_owned(),
            count => format!(
                "{} {} within the tolerance of that",
                names(&near),
                agree(count, "comes", "come")
            ),
        };
        let far = match far.len() {
            0 => String::new(),
            count => format!("; {} {} not", names(&far), agree(count, "does", "do")),
        };
        return format!(
            "{title}: out of reach, so no pose leaves less than {}. {near} in {after}{far}.",
            scientific(target.beyond)
        );
    }
    let list = ranked(numbers, |method| Some(run(method).residual));
    let (exact, others): (Vec<_>, Vec<_>) =
        list.into_iter().partition(|&(_, left)| left < ROUNDING);
    let mut each: Vec<String> = others
        .iter()
        .map(|&(method, left)| format!("{} {}", numbers.name(method), scientific(left)))
        .collect();
    if !exact.is_empty() {
        let names: Vec<String> = exact
            .iter()
            .map(|&(method, _)| numbers.name(method))
            .collect();
        each.insert(0, format!("{} nothing but rounding", listed(&names)));
    }
    format!("{title}, {after} leave: {}.", each.join("; "))
}

/// What a named target is called at the head of a sentence.
fn title(target: &Target) -> String {
    if target.name == "target" {
        "**The target.**".to_owned()
    } else {
        format!("**Target** {}.", code(&target.name))
    }
}

fn success_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let (is_judged, count) = (is_judged(study), study.shown);
    let list = ranked(numbers, |method| {
        let share = numbers.success((0, method, count), is_judged);
        share.map(|share| -share)
    });
    let (&(_, best), &(_, least)) = (list.first()?, list.last()?);
    let sample = study.targets[0]
        .iter()
        .filter(|target| is_judged(target))
        .count();
    let judged = judged_words(study);
    let sample = match sample {
        1 => format!("Of one {}", judged.replace("targets", "target")),
        _ => format!("Of {} {judged}", crate::text::grouped(sample)),
    };
    let sample = format!("{sample} of {}", code(&study.chains[0].name));
    let after = counted(study.shown_count() as usize, "iteration");
    if least <= best {
        return Some(format!(
            "**Success.** {sample}, {} {} in {after}.",
            match list.as_slice() {
                [(only, _)] => format!("{} reaches", numbers.name(*only)),
                _ => "every solver reaches".to_owned(),
            },
            percent(-best)
        ));
    }
    let leaders = leaders(numbers, &list);
    let last: Vec<String> = list
        .iter()
        .filter(|&&(_, share)| share >= least)
        .map(|&(method, _)| numbers.name(method))
        .collect();
    Some(format!(
        "**Success.** {sample}, {} {} the most in {after}, {}; {} {} the fewest, {}.",
        listed(&leaders),
        agree(leaders.len(), "reaches", "reach"),
        percent(-best),
        listed(&last),
        agree(last.len(), "reaches", "reach"),
        percent(-least)
    ))
}

/// What the most iterations that were tried leave undone.
fn patience_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let last = numbers.last();
    if last == study.shown {
        return None;
    }
    let (mut missing, mut complete) = (Vec::new(), Vec::new());
    for method in 0..study.methods.len() {
        let success = numbers.success((0, method, last), is_judged)?;
        let name = numbers.name(method);
        if success < 1.0 {
            missing.push(format!("{name} misses {}", percent(1.0 - success)));
        } else {
            complete.push(name);
        }
    }
    let after = counted(study.last_count() as usize, "iteration");
    let good = match complete.len() {
        0 => format!("In {after} no solver reaches all of them"),
        count => format!(
            "In {after} {} {} all of them",
            listed(&complete),
            agree(count, "reaches", "reach")
        ),
    };
    let bad = match missing.len() {
        0 => String::new(),
        _ => format!("; {}", listed(&missing)),
    };
    Some(format!("**More iterations.** {good}{bad}."))
}

fn motion_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    let is_judged = is_judged(study);
    let success = |method| numbers.success((0, method, study.shown), is_judged);
    // A solver that does not get there has little motion for nothing.
    let list = ranked(numbers, |method| {
        success(method).filter(|&share| share >= 0.5)?;
        let runs = numbers.over((0, method, study.shown), is_judged);
        median(runs.map(|run| run.motion_rad))
    });
    let (&(_, least), &(last, most)) = (list.first()?, list.last()?);
    if least >= most {
        return None;
    }
    // Those that the printed digits do not tell apart are named together.
    let least_names: Vec<String> = list
        .iter()
        .filter(|(_, turned)| degrees(*turned) == degrees(least))
        .map(|&(method, _)| numbers.name(method))
        .collect();
    Some(format!(
        "**Joint motion.** Of the solvers that reach at least half of these targets, {} {} the joints least, by {} together \
         in the median, and {} most, by {}.",
        listed(&least_names),
        agree(least_names.len(), "turns", "turn"),
        degrees(least),
        numbers.name(last),
        degrees(most)
    ))
}

fn time_sentence(numbers: Numbers<'_>) -> Option<String> {
    let study = numbers.study;
    if !study.has_times {
        return None;
    }
    let list = ranked(numbers, |method| {
        super::effort::time_to_arrive(numbers, method)
    });
    let (&(first, least), &(last, most)) = (list.first()?, list.last()?);
    if first == last {
        return Some(format!(
            "**Time.** {} reaches a target in {} (median, on the machine that wrote this).",
            numbers.name(first),
            micros(least)
        ));
    }
    Some(format!(
        "**Time.** Of the solvers that reach at least half of these targets, {} takes the least time, {} in the median, and {} \
         the most, {} (on the machine that wrote this).",
        numbers.name(first),
        micros(least),
        numbers.name(last),
        micros(most)
    ))
}

fn moving_sentence(numbers: Numbers<'_>) -> Option<String> {
    let circle = |method| {
        let mut found = numbers.following.iter();
        found.find(|followed| followed.method == method && followed.path == Path::Circle)
    };
    // To three digits, as it is printed: less is not seen.
    let list = ranked(numbers, |method| {
        let followed = circle(method)?;
        numbers
            .keeps_up(followed, BEHIND)
            .then(|| (followed.roughness * 1e3).round() / 1e3)
    });
    let jumping: Vec<String> = numbers
        .following
        .iter()
        .filter(|followed| followed.largest_step_rad() > JUMP_RAD)
        .map(|followed| {
            let name = numbers.name(followed.method);
            let step = degrees(followed.largest_step_rad());
            format!("{name} ({}, {step})", followed.path.name())
        })
        .collect();
    let jumps = if jumping.is_empty() {
        format!(
            "no joint jumps by more than {} in a frame",
            degrees(JUMP_RAD)
        )
    } else {
        format!(
            "a joint jumps by more than {} in a frame with {}",
            degrees(JUMP_RAD),
            listed(&jumping)
        )
    };
    let leaders = leaders(numbers, &list);
    let smooth = match list.first() {
        Some(&(only, roughness)) if numbers.study.methods.len() == 1 => format!(
            "{} follows a circle with a roughness of {roughness:.3}",
            numbers.name(only)
        ),
        Some(&(_, roughness)) => format!(
            "{} {} a circle most smoothly (roughness {roughness:.3})",
            listed(&leaders),
            agree(leaders.len(), "follows", "follow")
        ),
        None => "No solver keeps up with a target on a circle".to_owned(),
    };
    (!numbers.following.is_empty()).then(|| format!("**Moving targets.** {smooth}; {jumps}."))
}

fn ranking_sentence(numbers: Numbers<'_>) -> Option<String> {
    let standings = standings(numbers);
    let winners: Vec<String> = winners(&standings)
        .into_iter()
        .map(|method| numbers.name(method))
        .collect();
    if winners.is_empty() || standings.len() < 2 {
        return None;
    }
    let verb = match winners.len() {
        1 => "ranks first",
        _ => "share the first rank",
    };
    let time = if numbers.study.has_times {
        "time, "
    } else {
        ""
    };
    Some(format!(
        "**All in all,** {} {verb} by success, {time}joint motion and smoothness together; chapter 4 has the rule.",
        listed(&winners)
    ))
}
