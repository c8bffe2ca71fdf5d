//! Targets on the command line: every `--end` starts one, and what follows is about it.

use clap::error::ErrorKind;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches, value_parser};
use glam::DVec3;
use posekit::skeleton::{JointId, Skeleton};

use super::figure::Figure;
use super::numbers::{Orientation, Vector};
use super::place::{Place, PlaceArg};
use crate::args::Global;
use crate::failure::Failure;
use crate::select;

/// All targets, in the order they were given.
#[derive(Clone, Debug, Default)]
pub(super) struct Goals {
    list: Vec<GoalArg>,
}

/// One target as it was given.
#[derive(Clone, Debug)]
struct GoalArg {
    end: String,
    start: Option<String>,
    place: Option<PlaceArg>,
    orientation: Option<Orientation>,
    point: Option<DVec3>,
    weight: f64,
}

/// A target on the figure.
#[derive(Debug)]
pub(super) struct Goal {
    /// The effector.
    pub(super) end: JointId,
    /// Where its chain starts; the figure's root unless it was said.
    pub(super) start: Option<JointId>,
    /// Where it should be.
    pub(super) place: Place,
    /// How it should be turned.
    pub(super) orientation: Option<Orientation>,
    /// The point of it that should be there, in its own space.
    pub(super) point: DVec3,
    /// How much it counts.
    pub(super) weight: f64,
}

/// The options that are about one target, with what they are called in the help.
const OPTIONS: [(&str, &str, &str); 8] = [
    (
        "start",
        "JOINT",
        "Where its chain starts, and stays in place [default: the root]",
    ),
    ("target", "X,Y,Z", "Where it should be, in the world"),
    (
        "offset",
        "X,Y,Z",
        "Where it should be, from where it was in each frame",
    ),
    (
        "path",
        "FILE.csv",
        "Where it should be frame by frame: lines x,y,z, or frame,x,y,z with the way between",
    ),
    (
        "follow",
        "FILE:JOINT",
        "Where it should be: at a joint of another motion (:JOINT of this one) at the same time",
    ),
    (
        "orient",
        "HOW",
        "How it should be turned: hold, follow, degrees as 0,90,0 or ZXY:10,20,30, or x,y,z,w",
    ),
    (
        "point",
        "X,Y,Z",
        "The point on it that should be there, in its own space [default: the joint]",
    ),
    (
        "weight",
        "W",
        "How much it counts beside the other targets [default: 1]",
    ),
];

/// The heading of these options in the help.
const HEADING: &str = "Targets (may be repeated from --end on)";

impl Args for Goals {
    fn augment_args(command: Command) -> Command {
        let end = Arg::new("end")
            .long("end")
            .value_name("JOINT")
            .help("A joint that should reach something; starts a new target")
            .required(true)
            .action(ArgAction::Append)
            .help_heading(HEADING);
        OPTIONS
            .iter()
            .fold(command.arg(end), |command, &(name, value, help)| {
                let argument = Arg::new(name)
                    .long(name)
                    .value_name(value)
                    .help(help)
                    .action(ArgAction::Append)
                    .allow_hyphen_values(true)
                    .help_heading(HEADING);
                command.arg(match name {
                    "target" | "offset" | "point" => argument.value_parser(value_parser!(Vector)),
                    "orient" => argument.value_parser(value_parser!(Orientation)),
                    "weight" => argument.value_parser(value_parser!(f64)),
                    _ => argument,
                })
            })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Goals {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let ends = with_places::<String>(matches, "end");
        let owner = |place: usize| {
            // An option before the first --end is about that one: --start A --end B reads well, too.
            let before = ends.iter().filter(|(end, _)| *end < place).count();
            before.max(1) - 1
        };
        let mut list: Vec<GoalArg> = ends
            .iter()
            .map(|(_, end)| GoalArg {
                end: end.clone(),
                start: None,
                place: None,
                orientation: None,
                point: None,
                weight: 1.0,
            })
            .collect();
        if list.is_empty() {
            return Ok(Self::default());
        }
        for (place, start) in with_places::<String>(matches, "start") {
            set(&mut list[owner(place)].start, start, "--start")?;
        }
        for (place, point) in with_places::<Vector>(matches, "point") {
            set(&mut list[owner(place)].point, point.0, "--point")?;
        }
        for (place, orientation) in with_places::<Orientation>(matches, "orient") {
            set(&mut list[owner(place)].orientation, orientation, "--orient")?;
        }
        for (place, weight) in with_places::<f64>(matches, "weight") {
            if !(weight > 0.0 && weight.is_finite()) {
                return Err(wrong("a weight must be greater than zero"));
            }
            list[owner(place)].weight = weight;
        }
        let mut places = Vec::new();
        for (place, at) in with_places::<Vector>(matches, "target") {
            places.push((place, PlaceArg::World(at.0)));
        }
        for (place, by) in with_places::<Vector>(matches, "offset") {
            places.push((place, PlaceArg::Offset(by.0)));
        }
        for (place, path) in with_places::<String>(matches, "path") {
            places.push((place, PlaceArg::Path(path.into())));
        }
        for (place, followed) in with_places::<String>(matches, "follow") {
            places.push((
                place,
                PlaceArg::follow(&followed).map_err(|text| wrong(&text))?,
            ));
        }
        for (place, given) in places {
            let option = "--target, --offset, --path or --follow";
            set(&mut list[owner(place)].place, given, option)?;
        }
        Ok(Self { list })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The values of an option with their places on the command line.
fn with_places<T: Clone + Send + Sync + 'static>(
    matches: &ArgMatches,
    name: &str,
) -> Vec<(usize, T)> {
    let places = matches.indices_of(name).into_iter().flatten();
    let values = matches.get_many::<T>(name).into_iter().flatten();
    places.zip(values.cloned()).collect()
}

fn set<T>(slot: &mut Option<T>, value: T, option: &str) -> Result<(), clap::Error> {
    if slot.replace(value).is_some() {
        return Err(wrong(&format!(
            "a target takes one {option}; each --end starts a new target"
        )));
    }
    Ok(())
}

fn wrong(text: &str) -> clap::Error {
    clap::Error::raw(ErrorKind::ValueValidation, format!("{text}\n"))
}

impl Goals {
    /// Finds the joints and reads the files that the targets name.
    pub(super) fn attach(&self, figure: &Figure, global: &Global) -> Result<Vec<Goal>, Failure> {
        let goals = self.list.iter().map(|goal| {
            let skeleton = &figure.skeleton;
            let end = find(skeleton, &goal.end)?;
            let start = goal.start.as_ref().map(|name| find(skeleton, name));
            let is_followed = matches!(goal.place, Some(PlaceArg::Follow { .. }));
            if goal.orientation == Some(Orientation::Follow) && !is_followed {
                return Err(Failure::usage("--orient follow needs a --follow"));
            }
            Ok(Goal {
                end,
                start: start.transpose()?,
                place: Place::new(goal.place.as_ref(), figure, global)?,
                orientation: goal.orientation,
                point: goal.point.unwrap_or(DVec3::ZERO),
                weight: goal.weight,
            })
        });
        goals.collect()
    }
}

/// The one joint of that name.
pub(super) fn find(skeleton: &Skeleton, name: &str) -> Result<JointId, Failure> {
    if let Some(joint) = skeleton.find(name) {
        return Ok(joint);
    }
    let found = select::joints(skeleton, &[name.to_owned()])?;
    match found.as_slice() {
        [joint] => Ok(*joint),
        _ => Err(Failure::usage(format!(
            "'{name}' matches {} joints",
            found.len()
        ))),
    }
}
