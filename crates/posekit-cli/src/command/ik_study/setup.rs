//! From the options to what is studied: the figure, its chains, and the targets of each.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::sync::Arc;

use fastrand::Rng;
use glam::DVec3;
use posekit::motion::{FrameTime, Motion};
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton};
use posekit_render::stage::{Actor, SkeletonStyle};
use posekit_render::theme::CharacterColors;

use super::args::IkStudyArgs;
use super::experiment::Cell;
use super::linkage::StudiedChain;
use super::method::Method;
use super::targets::{self, Kind, Target};
use crate::args::Global;
use crate::failure::Failure;
use crate::inputs;
use crate::load;
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::select;

/// The example of the course for which this command was made: its chain and its target.
const COURSE_CHAIN: [&str; 2] = ["RootJoint", "lWrist_end"];
const COURSE_TARGET: DVec3 = DVec3::new(0.5, 0.75, 0.5);
/// Where that course's viewer has the root of its figure, which stands on the floor then.
const COURSE_ROOT: DVec3 = DVec3::new(0.0, 0.931_395, 0.0);

/// The iterations after which poses are shown and chains and places compared.
const USUAL_COUNT: u32 = 20;

/// More solver runs than this are a mistake in the options: hours.
const MOST_RUNS: u64 = 20_000_000;

/// What is studied.
#[derive(Debug)]
pub(super) struct Study {
    /// What the input is called.
    pub(super) input: String,
    /// The input as it was given on the command line.
    pub(super) file: OsString,
    /// What position channels do with OFFSETs.
    pub(super) positions: PositionsArgs,
    /// The figure.
    pub(super) skeleton: Arc<Skeleton>,
    /// The pose in which every solver starts.
    pub(super) start: LocalPose,
    /// The start pose as a motion of one frame, with a body.
    pub(super) actor: Actor,
    /// The frame that the start pose is of; the rest pose if none.
    pub(super) start_frame: Option<usize>,
    /// Where the root was put in the rest pose, if not where its OFFSET has it.
    pub(super) root_place: Option<DVec3>,
    /// The chains.
    pub(super) chains: Vec<StudiedChain>,
    /// The targets of each chain.
    pub(super) targets: Vec<Vec<Target>>,
    /// The solvers.
    pub(super) methods: Vec<Method>,
    /// The numbers of iterations, rising.
    pub(super) counts: Vec<u32>,
    /// Which of the counts poses are shown after.
    pub(super) shown: usize,
    /// The side of the grid.
    pub(super) grid: u32,
    /// The seed of random targets.
    pub(super) seed: u64,
    /// Whether times are reported.
    pub(super) has_times: bool,
}

impl Study {
    /// The count after which poses are shown.
    pub(super) fn shown_count(&self) -> u32 {
        self.counts[self.shown]
    }

    /// The largest number of iterations.
    pub(super) fn last_count(&self) -> u32 {
        self.counts[self.counts.len() - 1]
    }

    /// The target of a run.
    pub(super) fn target(&self, cell: Cell) -> &Target {
        &self.targets[cell.chain][cell.target]
    }
}

/// Poses as the frames of a motion. Joints that are not where they rest are translated, and roots, which a
/// chain that climbs carries along.
pub(super) fn motion_of(skeleton: &Arc<Skeleton>, poses: &[LocalPose]) -> Motion {
    let is_moved = |&joint: &JointId| {
        let rest = skeleton.rest_translation(joint);
        let stays = |pose: &LocalPose| pose.translations[joint.index()] == rest;
        skeleton.parent(joint).is_none() || !poses.iter().all(stays)
    };
    let moved: Vec<JointId> = skeleton.joints().filter(is_moved).collect();
    Motion::from_poses(Arc::clone(skeleton), FrameTime::of_fps(30), moved, poses)
}

/// Refuses two targets of one name: nobody could tell them apart in the report.
fn refuse_equal_names(args: &IkStudyArgs) -> Result<(), Failure> {
    let mut names = BTreeSet::new();
    for name in args
        .targets
        .iter()
        .filter_map(|target| target.name.as_ref())
    {
        if !names.insert(name) {
            return Err(Failure::usage(format!("two targets are called '{name}'")));
        }
    }
    Ok(())
}

/// Reads the input and settles everything that is studied.
pub(super) fn study(args: &IkStudyArgs, global: &Global) -> Result<Study, Failure> {
    let inputs = inputs::expand(std::slice::from_ref(&args.file));
    if let Some((_, failure)) = inputs.failures.into_iter().next() {
        return Err(failure);
    }
    let [input] = inputs.list.as_slice() else {
        return Err(Failure::usage("a study is of one file"));
    };
    refuse_equal_names(args)?;
    Said::of(args.positions).refuse_scene(input)?;
    let motion = load::load(input, global)?
        .motion(args.positions.policies())
        .map_err(|failure| failure.in_file(&input.name()))?;
    let skeleton = Arc::clone(motion.skeleton());
    let root_place = root_place(args, &skeleton);
    let start = start_pose(args.frame, root_place, &motion)
        .map_err(|failure| failure.in_file(&input.name()))?;
    let chains =
        chains(args, &skeleton, &start).map_err(|failure| failure.in_file(&input.name()))?;
    let still = motion_of(&skeleton, std::slice::from_ref(&start));
    let actor = Actor::new(
        Arc::new(still),
        SkeletonStyle::Bones,
        CharacterColors::of(0),
    );
    let targets = targets(args, &chains, &skeleton, actor.facing_yaw_rad());
    let mut counts = args.iterations.clone();
    counts.sort_unstable();
    counts.dedup();
    let shown = counts.partition_point(|&count| count <= USUAL_COUNT).max(1) - 1;
    let methods: Vec<Method> = Method::ALL
        .into_iter()
        .filter(|method| args.methods.is_empty() || args.methods.contains(method))
        .collect();
    let runs = targets.iter().map(|list| list.len() as u64).sum::<u64>()
        * (methods.len() * counts.len()) as u64;
    if runs > MOST_RUNS {
        return Err(
            Failure::usage(format!("{runs} runs of solvers are too many"))
                .try_next("ask for fewer targets with --random"),
        );
    }
    Ok(Study {
        input: input.relative.display().to_string(),
        file: args.file.clone(),
        positions: args.positions,
        skeleton,
        start,
        actor,
        start_frame: args.frame,
        root_place: args.frame.is_none().then_some(root_place).flatten(),
        chains,
        targets,
        methods,
        counts,
        shown,
        grid: args.grid,
        seed: args.seed,
        has_times: !args.no_times,
    })
}

fn start_pose(
    frame: Option<usize>,
    root_place: Option<DVec3>,
    motion: &Motion,
) -> Result<LocalPose, Failure> {
    match frame {
        None => Ok(rest_pose(root_place, motion.skeleton())),
        Some(frame) if frame < motion.frame_count() => Ok(motion.pose(frame)),
        Some(frame) => Err(Failure::new(format!("frame {frame} is past the end"))
            .try_next(format!("the frames are 0..{}", motion.frame_count()))),
    }
}

/// The rest pose, with the first root where it was asked for.
fn rest_pose(root_place: Option<DVec3>, skeleton: &Skeleton) -> LocalPose {
    let mut pose = LocalPose::rest(skeleton);
    if let (Some(place), Some(root)) = (root_place, skeleton.roots().next()) {
        pose.translations[root.index()] = place.as_vec3();
    }
    pose
}

/// Where the first root stands in the rest pose, if not where its OFFSET has it.
fn root_place(args: &IkStudyArgs, skeleton: &Skeleton) -> Option<DVec3> {
    let given = args.root.map(|root| root.0);
    given.or(is_course(skeleton).then_some(COURSE_ROOT))
}

/// Whether the figure is the one of the course: it has its chain.
fn is_course(skeleton: &Skeleton) -> bool {
    COURSE_CHAIN
        .iter()
        .all(|name| skeleton.find(name).is_some())
}

fn chains(
    args: &IkStudyArgs,
    skeleton: &Skeleton,
    start: &LocalPose,
) -> Result<Vec<StudiedChain>, Failure> {
    if args
        .tolerance
        .is_some_and(|tolerance| !(tolerance > 0.0 && tolerance.is_finite()))
    {
        return Err(Failure::usage(
            "--tolerance must be a length greater than zero",
        ));
    }
    let is_default = args.chains.is_empty();
    let ends: Vec<[JointId; 2]> = if is_default {
        default_chains(skeleton)
    } else {
        let given = args.chains.iter().map(|text| ends(skeleton, text));
        given.collect::<Result<_, _>>()?
    };
    let mut chains = Vec::new();
    for [from, to] in ends {
        let name = |joint| skeleton.unique_name(joint);
        let chain = skeleton.chain(from, to).ok_or_else(|| {
            Failure::usage(format!(
                "no way leads from '{}' to '{}'",
                name(from),
                name(to)
            ))
        })?;
        match StudiedChain::new(skeleton, start, chain, args.tolerance) {
            Some(chain) => chains.push(chain),
            None if is_default => {}
            None => {
                let (from, to) = (name(from), name(to));
                return Err(Failure::usage(format!(
                    "no joint turns between '{from}' and '{to}'"
                )));
            }
        }
    }
    if chains.is_empty() {
        return Err(
            Failure::new("no chain of its joints can bend").try_next("give one with --chain")
        );
    }
    Ok(chains)
}

/// `START:END`; joints' names may have colons in them.
fn ends(skeleton: &Skeleton, text: &str) -> Result<[JointId; 2], Failure> {
    let splits = text
        .match_indices(':')
        .map(|(at, _)| (&text[..at], &text[at + 1..]));
    let known = splits
        .filter_map(|(from, to)| Some([skeleton.find(from)?, skeleton.find(to)?]))
        .next();
    if let Some(ends) = known {
        return Ok(ends);
    }
    let Some((from, to)) = text.split_once(':') else {
        return Err(Failure::usage(format!(
            "'{text}' is not a chain; write START:END"
        )));
    };
    Ok([one_joint(skeleton, from)?, one_joint(skeleton, to)?])
}

fn one_joint(skeleton: &Skeleton, name: &str) -> Result<JointId, Failure> {
    let found = select::joints(skeleton, &[name.to_owned()])?;
    match found.as_slice() {
        [joint] => Ok(*joint),
        _ => Err(Failure::usage(format!(
            "'{name}' matches {} joints",
            found.len()
        ))),
    }
}

/// From the root to a hand, from the limb's own first joint to it, and from the farthest end of another limb
/// up and down to it.
fn default_chains(skeleton: &Skeleton) -> Vec<[JointId; 2]> {
    let Some(end) = hand(skeleton) else {
        return Vec::new();
    };
    let mut up: Vec<JointId> = skeleton.ancestors(end).collect();
    let Some(root) = up.pop() else {
        return Vec::new();
    };
    let mut chains = vec![[root, end]];
    // Two bones before the last joint: a shoulder.
    let bends: Vec<JointId> = up
        .iter()
        .copied()
        .filter(|&joint| skeleton.bone_length(joint) > 0.0)
        .collect();
    if let Some(&limb) = bends.get(2) {
        chains.push([limb, end]);
    }
    // A foot: the lowest end of the figure at rest, on the same side as far as that decides.
    let rest = posekit::pose::GlobalPose::rest(skeleton);
    let at = |joint: JointId| rest.positions[joint.index()];
    let lowest = skeleton
        .joints()
        .filter(|&joint| skeleton.children(joint).is_empty() && joint != end)
        .min_by(|&a, &b| {
            let key = |joint: JointId| at(joint).y + 0.01 * at(joint).distance(at(end));
            key(a).total_cmp(&key(b))
        });
    if let Some(foot) = lowest.filter(|&foot| at(foot).y < at(root).y) {
        chains.push([foot, end]);
    }
    chains
}

/// The end that is most likely meant to reach for things: the course's, a left hand's, or else the one whose
/// chain from the root is longest.
fn hand(skeleton: &Skeleton) -> Option<JointId> {
    if let Some(end) = skeleton.find(COURSE_CHAIN[1]) {
        return Some(end);
    }
    let is_left_hand = |joint: &JointId| {
        let name = skeleton.name(*joint).to_lowercase();
        let is_left = name.contains("left") || name.starts_with('l') || name.ends_with("_l");
        is_left && (name.contains("hand") || name.contains("wrist")) && skeleton.depth(*joint) > 1
    };
    if let Some(end) = skeleton.joints().find(is_left_hand) {
        return Some(end);
    }
    let length = |joint: JointId| -> f32 {
        let above = skeleton
            .ancestors(joint)
            .map(|above| skeleton.bone_length(above));
        skeleton.bone_length(joint) + above.sum::<f32>()
    };
    let ends = skeleton
        .joints()
        .filter(|&joint| skeleton.children(joint).is_empty());
    ends.max_by(|&a, &b| length(a).total_cmp(&length(b)).then(b.cmp(&a)))
}

fn targets(
    args: &IkStudyArgs,
    chains: &[StudiedChain],
    skeleton: &Skeleton,
    facing_yaw_rad: f32,
) -> Vec<Vec<Target>> {
    let main = &chains[0];
    let (sin, cos) = libm::sincos(f64::from(facing_yaw_rad));
    let (across, ahead) = (DVec3::new(cos, 0.0, -sin), DVec3::new(sin, 0.0, cos));
    let named = named(args, main, skeleton, across, ahead);
    let depth = (named[0].1 - main.base()).dot(ahead);
    let middle = main.base() + ahead * depth;
    let grid = targets::grid(args.grid, middle, across, 0.8 * main.reach);
    let own = |(index, chain): (usize, &StudiedChain)| {
        // Every chain has numbers of its own, whatever the others are.
        let mut random = Rng::with_seed(args.seed.wrapping_add((index as u64) << 32));
        let mut list: Vec<Target> = named
            .iter()
            .map(|(name, place)| Target::new(chain, Kind::Named, name.clone(), *place))
            .collect();
        for &(kind, place) in &grid {
            let name = match kind {
                Kind::Grid { row, column } => format!("grid {},{}", row + 1, column + 1),
                _ => String::new(),
            };
            list.push(Target::new(chain, kind, name, place));
        }
        list.extend(targets::reachable(chain, args.random, &mut random));
        list.extend(targets::unreachable(chain, args.unreachable, &mut random));
        list
    };
    chains.iter().enumerate().map(own).collect()
}

/// The targets that were given; else the course's on its figure; else one in front of the figure, at four
/// fifths of its reach.
fn named(
    args: &IkStudyArgs,
    main: &StudiedChain,
    skeleton: &Skeleton,
    across: DVec3,
    ahead: DVec3,
) -> Vec<(String, DVec3)> {
    let given = args.targets.iter().enumerate().map(|(index, target)| {
        let name = target.name.clone();
        (
            name.unwrap_or_else(|| format!("target {}", index + 1)),
            target.place,
        )
    });
    let given: Vec<_> = given.collect();
    if !given.is_empty() {
        return given;
    }
    let place = if is_course(skeleton) {
        COURSE_TARGET
    } else {
        let direction = (across * 0.4 + DVec3::Y * 0.45 + ahead * 0.8).normalize();
        let place = main.base() + direction * (0.8 * main.reach);
        spoken(place, main.reach)
    };
    vec![("target".to_owned(), place)]
}

/// A place rounded to two digits of a reach, in numbers as short as they are said: 0.3, not 0.30000000000000004.
fn spoken(place: DVec3, reach: f64) -> DVec3 {
    let power = libm::floor(libm::log10(reach)) - 1.0;
    // A power of ten below one is not exact, and what it divides into is.
    let scale = libm::pow(10.0, power.abs());
    if power < 0.0 {
        (place * scale).round() / scale
    } else {
        (place / scale).round() * scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_of_ours_is_short_to_say() {
        let place = DVec3::new(0.312, -0.489, 0.7101);
        assert_eq!(spoken(place, 1.07), DVec3::new(0.3, -0.5, 0.7));
        assert_eq!(spoken(place, 0.97), DVec3::new(0.31, -0.49, 0.71));
        assert_eq!(
            spoken(place * 1e3, 1070.0),
            DVec3::new(300.0, -500.0, 700.0)
        );
    }
}
