//! The option `--positions`, of all commands that read motion from BVH.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use posekit::motion::{PositionPolicies, PositionPolicy};

/// What position channels do with the OFFSET of their joint.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct PositionsArgs {
    /// What position channels do with OFFSETs: replace, add or ignore; for roots and other joints separately:
    /// root=add,others=ignore. 'ignore' alone leaves roots replaced [default: replace]
    #[arg(long, value_name = "HOW")]
    positions: Option<Positions>,
    /// The same for roots alone; an older name
    #[arg(long, value_name = "HOW", hide = true, conflicts_with = "positions")]
    root_offset: Option<RootOffset>,
}

impl PositionsArgs {
    /// The same for the library.
    pub(crate) fn policies(self) -> PositionPolicies {
        match (self.positions, self.root_offset) {
            (Some(Positions(policies)), _) => policies,
            (None, Some(RootOffset::Add)) => PositionPolicies {
                root: PositionPolicy::Add,
                ..PositionPolicies::default()
            },
            (None, _) => PositionPolicies::default(),
        }
    }

    /// The option as it would be written; nothing where it says what holds anyway.
    pub(crate) fn words(self) -> Vec<String> {
        let PositionPolicies { root, others } = self.policies();
        if self.policies() == PositionPolicies::default() {
            return Vec::new();
        }
        let how = format!("root={},others={}", name(root), name(others));
        vec!["--positions".to_owned(), how]
    }

    /// Whether the user said anything.
    pub(crate) fn is_given(self) -> bool {
        self.positions.is_some() || self.root_offset.is_some()
    }
}

/// The old spelling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum RootOffset {
    /// Added
    Add,
    /// Replaced
    Replace,
}

/// A word for all joints, or one for roots and one for the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Positions(PositionPolicies);

impl FromStr for Positions {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if !text.contains('=') {
            let policy = policy(text)?;
            let mut policies = PositionPolicies::from(policy);
            // A root's channels carry the figure: who has no use for those of its bones wants it to move all
            // the same.
            if policy == PositionPolicy::Ignore {
                policies.root = PositionPolicy::Replace;
            }
            return Ok(Self(policies));
        }
        let mut policies = PositionPolicies::default();
        for part in text.split(',') {
            match part.split_once('=') {
                Some(("root", how)) => policies.root = policy(how)?,
                Some(("others", how)) => policies.others = policy(how)?,
                _ => return Err("write it as root=add,others=ignore".to_owned()),
            }
        }
        Ok(Self(policies))
    }
}

fn name(policy: PositionPolicy) -> &'static str {
    match policy {
        PositionPolicy::Replace => "replace",
        PositionPolicy::Add => "add",
        PositionPolicy::Ignore => "ignore",
    }
}

fn policy(text: &str) -> Result<PositionPolicy, String> {
    match text {
        "replace" => Ok(PositionPolicy::Replace),
        "add" => Ok(PositionPolicy::Add),
        "ignore" => Ok(PositionPolicy::Ignore),
        _ => Err(
            "expected replace, add or ignore, or both, such as root=add,others=ignore".to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use PositionPolicy::{Add, Ignore, Replace};

    #[test]
    fn a_word_is_for_all_joints_and_two_are_for_roots_and_others() {
        for (text, root, others) in [
            ("replace", Replace, Replace),
            ("add", Add, Add),
            ("ignore", Replace, Ignore),
            ("root=add", Add, Replace),
            ("others=ignore", Replace, Ignore),
            ("others=add,root=ignore", Ignore, Add),
        ] {
            let policies = PositionPolicies { root, others };
            assert_eq!(text.parse(), Ok(Positions(policies)), "{text}");
        }
        for text in [
            "",
            "sum",
            "root=",
            "root=sum",
            "feet=add",
            "root=add,ignore",
            "=add",
        ] {
            assert!(text.parse::<Positions>().is_err(), "{text}");
        }
    }
}
