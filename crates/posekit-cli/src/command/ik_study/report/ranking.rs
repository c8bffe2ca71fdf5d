//! Which solver is the one to take: by success, time, joint motion and smoothness together. The rule stands in
//! the report, and ties are ties.

use super::super::document::{Block, Document, Entry, Mark, Table};
use super::super::experiment::Arrival;
use super::super::statistics::median;
use super::{Numbers, counted, degrees, is_judged, judged_words, listed, micros, percent};

/// Ranked are solvers that reach at least this share of the targets that the best one reaches.
const CANDIDATE_SHARE: f64 = 0.9;

/// Shares of success that differ by no more than this are a tie.
const SUCCESS_MARGIN: f64 = 0.01;

/// Times, angles and roughnesses that differ by no more than this share of the smaller one are a tie.
const MARGIN: f64 = 0.1;

/// A solver that falls behind a target on the circle by more than so many tolerances does not follow it, and is
/// last in smoothness.
const BEHIND: f64 = 10.0;

/// What a solver is ranked by.
#[derive(Clone, Copy, Debug)]
enum Measure {
    Success,
    Time,
    Motion,
    Smoothness,
}

/// A solver with what was measured.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    /// Index of the solver.
    pub(super) method: usize,
    /// The share of targets that it came to, over all chains.
    pub(super) success: f64,
    /// The median time to a target, in seconds; over the targets that all ranked solvers reach, as the next.
    secs: Option<f64>,
    motion_rad: Option<f64>,
    /// The mean over both moving targets; none if it did not follow.
    roughness: Option<f64>,
    /// Its place by each measure: 1 for the best.
    places: Vec<usize>,
    /// Its place by the sum of its places; none if it is not ranked.
    pub(super) rank: Option<usize>,
}

impl Standing {
    fn sum(&self) -> usize {
        self.places.iter().sum()
    }
}

/// All solvers: the ranked ones from the first on, then the others by success.
pub(super) fn standings(numbers: Numbers<'_>) -> Vec<Standing> {
    let study = numbers.study;
    let mut all: Vec<Standing> = (0..study.methods.len())
        .filter_map(|method| {
            Some(Standing {
                method,
                success: success(numbers, method)?,
                secs: None,
                motion_rad: None,
                roughness: roughness(numbers, method),
                places: Vec::new(),
                rank: None,
            })
        })
        .collect();
    let best = all
        .iter()
        .map(|standing| standing.success)
        .fold(0.0, f64::max);
    let is_candidate =
        |standing: &Standing| best > 0.0 && standing.success >= CANDIDATE_SHARE * best;
    let (mut ranked, mut others): (Vec<_>, Vec<_>) = all.drain(..).partition(is_candidate);
    let methods: Vec<usize> = ranked.iter().map(|standing| standing.method).collect();
    for standing in &mut ranked {
        let arrivals = || common_arrivals(numbers, &methods, standing.method);
        standing.secs = median(arrivals().map(|arrival| arrival.secs)).filter(|_| study.has_times);
        standing.motion_rad = median(arrivals().map(|arrival| arrival.motion_rad));
    }
    for measure in measures(numbers) {
        let values: Vec<f64> = ranked
            .iter()
            .map(|standing| measure.value(standing).unwrap_or(f64::INFINITY))
            .collect();
        let places = places(&values, measure);
        for (standing, place) in ranked.iter_mut().zip(places) {
            standing.places.push(place);
        }
    }
    ranked.sort_by_key(Standing::sum);
    let sums: Vec<usize> = ranked.iter().map(Standing::sum).collect();
    for standing in &mut ranked {
        let before = sums.iter().filter(|&&sum| sum < standing.sum()).count();
        standing.rank = Some(before + 1);
    }
    others.sort_by(|a, b| b.success.total_cmp(&a.success));
    ranked.into_iter().chain(others).collect()
}

fn measures(numbers: Numbers<'_>) -> Vec<Measure> {
    let mut measures = vec![Measure::Success, Measure::Motion, Measure::Smoothness];
    if numbers.study.has_times {
        measures.insert(1, Measure::Time);
    }
    measures
}

impl Measure {
    /// What is small for a good solver.
    fn value(self, standing: &Standing) -> Option<f64> {
        match self {
            Self::Success => Some(1.0 - standing.success),
            Self::Time => standing.secs,
            Self::Motion => standing.motion_rad,
            Self::Smoothness => standing.roughness,
        }
    }

    /// Whether a value shares the place of the best one at that place.
    fn is_tie(self, value: f64, best: f64) -> bool {
        match self {
            // The last bit of a share does not part what is one target apart.
            Self::Success => value <= best + SUCCESS_MARGIN + 1e-12,
            _ => value <= best * (1.0 + MARGIN),
        }
    }
}

/// The place of each value: 1 for the least and for all that tie with it, and so on.
fn places(values: &[f64], measure: Measure) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut places = vec![0; values.len()];
    let mut leader: Option<(usize, f64)> = None;
    for (before, &index) in order.iter().enumerate() {
        let value = values[index];
        let place = match leader {
            Some((place, best)) if measure.is_tie(value, best) => place,
            _ => {
                leader = Some((before + 1, value));
                before + 1
            }
        };
        places[index] = place;
    }
    places
}

/// The share of the targets of all chains that a solver came to.
fn success(numbers: Numbers<'_>, method: usize) -> Option<f64> {
    super::share(judged(numbers).map(|(chain, target)| {
        let arrival = numbers.results.arrival(chain, target, method);
        arrival.iterations.is_some()
    }))
}

/// The targets by which solvers are judged, of all chains.
fn judged(numbers: Numbers<'_>) -> impl Iterator<Item = (usize, usize)> {
    let is_judged = is_judged(numbers.study);
    let lists = numbers.study.targets.iter().enumerate();
    lists.flat_map(move |(chain, list)| {
        let targets = list
            .iter()
            .enumerate()
            .filter(move |(_, target)| is_judged(target));
        targets.map(move |(target, _)| (chain, target))
    })
}

/// `300 random targets within reach`.
fn counted_judged(numbers: Numbers<'_>) -> String {
    let count = crate::text::grouped(judged(numbers).count());
    format!("{count} {}", judged_words(numbers.study))
}

/// How a solver came to those targets that all of some solvers came to.
fn common_arrivals<'a>(
    numbers: Numbers<'a>,
    methods: &'a [usize],
    method: usize,
) -> impl Iterator<Item = &'a Arrival> {
    let results = numbers.results;
    let is_common = move |&(chain, target): &(usize, usize)| {
        let arrives = |&method: &usize| results.arrival(chain, target, method).iterations.is_some();
        methods.iter().all(arrives)
    };
    judged(numbers)
        .filter(is_common)
        .map(move |(chain, target)| results.arrival(chain, target, method))
}

/// The mean roughness of a solver on both paths, if it stayed with the target on the circle.
fn roughness(numbers: Numbers<'_>, method: usize) -> Option<f64> {
    let own = || numbers.following.iter().filter(|one| one.method == method);
    let follows = own().all(|one| !one.is_within_reach() || numbers.keeps_up(one, BEHIND));
    let count = own().count();
    let sum: f64 = own().map(|one| one.roughness).sum();
    (follows && count > 0).then(|| sum / count as f64)
}

/// The rule, the table, and what follows from it.
pub(super) fn write(document: &mut Document, numbers: Numbers<'_>) {
    let study = numbers.study;
    let standings = standings(numbers);
    document.section("Ranking");
    if standings.is_empty() {
        document.paragraph("No target within reach was tried, so the solvers are not ranked.");
        return;
    }
    if standings.len() == 1 {
        document.paragraph("Only one solver ran, so there is nothing to rank.");
        return;
    }
    let last = study.last_count();
    let (time, what) = if study.has_times {
        ("the median **time** until then, ", "In the last three")
    } else {
        ("", "In the last two")
    };
    document.paragraph(format!(
        "No single number makes a solver the best, so the ranking follows a rule. It counts the {} of all chains. Each of {} gives \
         every solver a place: **success**, the share of the targets that it reaches within the tolerance in {last} iterations or \
         fewer; {time}the median **joint motion** until then; and **smoothness**, the mean roughness behind the two moving \
         targets. Success is a tie up to a difference of one percentage point. {what} a difference of up to 10 % is a tie, and \
         the medians are taken over the targets that all ranked solvers reach. The sum of the places makes the rank, the \
         smallest first; equal sums are a tie. A solver that reaches fewer than 90 % as many targets as the best one is not \
         ranked, because not arriving is quick and smooth.",
        counted_judged(numbers),
        counted(measures(numbers).len(), "measure"),
    ));
    if study.has_times {
        document.paragraph(
            "Times differ from run to run, so two solvers of much the same speed may change places when the study is \
             run again.",
        );
    } else {
        document
            .paragraph("Times were left out of this study (`--no-times`), and so of its ranking.");
    }
    document
        .blocks
        .push(Block::Table(table(numbers, &standings)));
    document.section("Conclusion");
    document.paragraph(conclusion(numbers, &standings));
}

fn table(numbers: Numbers<'_>, standings: &[Standing]) -> Table {
    let study = numbers.study;
    let measures = measures(numbers);
    let mut columns = vec!["solver".to_owned()];
    columns.extend(measures.iter().map(|measure| {
        let name = match measure {
            Measure::Success => "success",
            Measure::Time => "time",
            Measure::Motion => "joint motion",
            Measure::Smoothness => "roughness",
        };
        name.to_owned()
    }));
    columns.extend(["places", "sum", "rank"].map(str::to_owned));
    let rows = standings.iter().map(|standing| {
        let dash = || "–".to_owned();
        let mut row = vec![Entry::new(study.methods[standing.method].name())];
        for (index, measure) in measures.iter().enumerate() {
            let text = match measure {
                Measure::Success => percent(standing.success),
                Measure::Time => standing.secs.map_or_else(dash, micros),
                Measure::Motion => standing.motion_rad.map_or_else(dash, degrees),
                Measure::Smoothness => standing
                    .roughness
                    .map_or_else(dash, |value| format!("{value:.3}")),
            };
            let is_first = standing.places.get(index) == Some(&1);
            row.push(Entry {
                text,
                mark: if is_first { Mark::Best } else { Mark::None },
            });
        }
        if let Some(rank) = standing.rank {
            let places: Vec<String> = standing.places.iter().map(usize::to_string).collect();
            let is_tie = standings
                .iter()
                .filter(|other| other.rank == Some(rank))
                .count()
                > 1;
            let tie = if is_tie { " (tie)" } else { "" };
            row.push(Entry::new(places.join(" + ")));
            row.push(Entry::new(standing.sum().to_string()));
            row.push(Entry {
                text: format!("{rank}{tie}"),
                mark: if rank == 1 { Mark::Best } else { Mark::None },
            });
        } else {
            row.extend([dash(), dash(), "not ranked".to_owned()].map(Entry::new));
        }
        row
    });
    Table {
        caption: "The solvers ranked by the rule above. Bold: first place by that measure, ties included.".to_owned(),
        columns,
        is_text: false,
        rows: rows.collect(),
    }
}

/// The solvers that share the first rank.
pub(super) fn winners(standings: &[Standing]) -> Vec<usize> {
    let first = standings.iter().filter(|standing| standing.rank == Some(1));
    first.map(|standing| standing.method).collect()
}

fn conclusion(numbers: Numbers<'_>, standings: &[Standing]) -> String {
    let study = numbers.study;
    let name = |method: usize| study.methods[method].name().to_owned();
    let names = |methods: &[usize]| {
        methods
            .iter()
            .map(|&method| name(method))
            .collect::<Vec<_>>()
    };
    let winners = winners(standings);
    let judged = judged_words(study);
    let last = study.last_count();
    let mut text = match winners.as_slice() {
        [] => format!(
            "No solver reached any of the {judged} in {last} iterations, so none is recommended."
        ),
        [one] => format!(
            "For one end and one target, take {} ({}): it ranks first by success, {}joint motion and smoothness together, and reaches {} of the {judged} in {last} iterations or fewer.",
            name(*one),
            study.methods[*one].facts().full_name,
            if study.has_times { "time, " } else { "" },
            percent(standings[0].success),
        ),
        several => format!(
            "For one end and one target, {} share the first rank: by success, {}joint motion and smoothness together this study \
             does not tell them apart.",
            listed(&names(several)),
            if study.has_times { "time, " } else { "" },
        ),
    };
    let next: Vec<usize> = {
        let rank = standings
            .iter()
            .filter_map(|standing| standing.rank)
            .find(|&rank| rank > 1);
        let at = standings
            .iter()
            .filter(|standing| rank.is_some() && standing.rank == rank);
        at.map(|standing| standing.method).collect()
    };
    if !next.is_empty() {
        let verb = if next.len() == 1 {
            "follows"
        } else {
            "share the next rank"
        };
        text.push_str(&format!(" {} {verb}.", listed(&names(&next))));
    }
    let unranked: Vec<String> = standings
        .iter()
        .filter(|standing| standing.rank.is_none())
        .map(|standing| format!("{} ({})", name(standing.method), percent(standing.success)))
        .collect();
    if !unranked.is_empty() && !winners.is_empty() {
        let they = if unranked.len() == 1 {
            "it reaches"
        } else {
            "they reach"
        };
        text.push_str(&format!(
            " Not ranked, because {they} too few of the targets in {last} iterations: {}.",
            listed(&unranked)
        ));
    }
    text.push_str(
        " This holds for this figure, without limits on its joints and from this start pose. With limits, with several \
         targets, or from another pose (`--frame`) the order may be different.",
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_within_the_margin_share_a_place() {
        // By hand: 10 leads and 11 is within a tenth of it; 11.5 is not, and leads its own place, which is the
        // third; infinite values are last together.
        let values = [11.5, 10.0, f64::INFINITY, 11.0, f64::INFINITY];
        assert_eq!(places(&values, Measure::Time), [3, 1, 4, 1, 4]);
        // A percentage point is a tie, and more is not.
        let missed = [0.0, 0.01, 0.02, 0.021];
        assert_eq!(places(&missed, Measure::Success), [1, 1, 3, 3]);
        assert_eq!(places(&[], Measure::Motion), Vec::<usize>::new());
    }
}
