//! How other programs read a BVH file: which of its peculiarities they refuse or take for something else, and what
//! has to change for them.
//!
//! [`judge`] tells what one program makes of a file, [`adapt`] changes a document so that the program reads the
//! motion that posekit reads, [`RULES`] is all that both know, and the table of the guide
//! (`docs/conventions-elsewhere.md`) is made from it. Each rule was tried with the program, at the version that
//! [`Program::version`] names, on files that have one peculiarity each (`tools/bvh_elsewhere.py`): a newer version
//! may do better.
//!
//! "Right" is what posekit reads by default, where position channels replace the OFFSET.
//!
//! ```
//! use posekit_formats::bvh::{self, elsewhere::{Effect, Program, adapt, judge}};
//!
//! let text = b"HIERARCHY\nROOT mixamorig:Hips\n{\nOFFSET 0 1 0\nCHANNELS 1 Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n\
//!     MOTION\nFrames: 1\nFrame Time: 0.04\n10\n";
//! let mut import = bvh::read(text)?;
//! let remarks = judge(Program::Three, text, &import);
//! assert_eq!(remarks[0].rule.effect, Effect::Misread);
//!
//! adapt(&mut import.document, Program::Three)?;
//! assert_eq!(import.document.joints[0].name(), "mixamorigHips");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adapt;
mod names;
mod peculiarity;
mod program;
mod rules;
#[cfg(test)]
mod tests;
mod text;

pub use adapt::{Obstacle, adapt};
pub use peculiarity::Peculiarity;
pub use program::Program;
pub use rules::{Effect, RULES, Rule};

use super::Bvh;
use crate::report::Import;

/// What a program makes of one peculiarity of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// What it does.
    pub rule: &'static Rule,
    /// The joints that it is about, by their index; empty when it is about the whole file.
    pub joints: Vec<usize>,
}

/// What `program` does not read as posekit does, the worst first; empty when it reads the file right.
///
/// `bytes` is the file that `import` was read from.
#[must_use]
pub fn judge(program: Program, bytes: &[u8], import: &Import<Bvh>) -> Vec<Remark> {
    let mut remarks = Vec::new();
    for found in peculiarity::find(bytes, import) {
        let applies =
            |rule: &&Rule| rule.program == program && rule.peculiarity == found.peculiarity;
        remarks.extend(RULES.iter().find(applies).map(|rule| Remark {
            rule,
            joints: found.joints,
        }));
    }
    remarks.sort_by_key(|remark| core::cmp::Reverse(remark.rule.effect));
    remarks
}
