//! Other programs, by the name that `--for` takes.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use posekit_formats::bvh::elsewhere::Program;

/// A program that reads BVH files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ProgramArg(pub(crate) Program);

impl ValueEnum for ProgramArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [ProgramArg; Program::ALL.len()] = {
            let mut all = [ProgramArg(Program::Three); Program::ALL.len()];
            let mut index = 0;
            while index < all.len() {
                all[index] = ProgramArg(Program::ALL[index]);
                index += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = format!("{} {}", self.0.title(), self.0.version());
        Some(PossibleValue::new(self.0.name()).help(help))
    }
}
