//! Which axes were taken as up in all files, where that is not plainly Y: floor and feet were looked for there.

use posekit::figure::{UpAxis, UpTaken};
use serde_json::{Map, Value, json};

use crate::failure::one_line;
use crate::text::{counted, grouped};

/// The axes of all files.
#[derive(Debug, Default)]
pub(super) struct Axes {
    kinds: Vec<Kind>,
}

/// Files of which the same was taken for the same reason.
#[derive(Debug)]
struct Kind {
    up: UpAxis,
    /// An axis that may be up as well, and was not taken.
    perhaps: Option<UpAxis>,
    is_said: bool,
    count: usize,
    first: String,
}

impl Axes {
    /// Counts one more file.
    pub(super) fn add(&mut self, name: &str, taken: UpTaken) {
        let guessed = taken.guess.map(|guess| guess.up);
        let perhaps = guessed.filter(|&up| up != taken.up);
        let same = |kind: &&mut Kind| {
            (kind.up, kind.perhaps, kind.is_said) == (taken.up, perhaps, taken.is_said)
        };
        match self.kinds.iter_mut().find(same) {
            Some(kind) => kind.count += 1,
            None => self.kinds.push(Kind {
                up: taken.up,
                perhaps,
                is_said: taken.is_said,
                count: 1,
                first: name.to_owned(),
            }),
        }
    }

    /// A line for each axis that is not plainly Y.
    pub(super) fn lines(&self) -> Vec<String> {
        let lines = self.kinds.iter().filter_map(|kind| {
            let doubt = match kind.perhaps {
                Some(perhaps) => format!(", where {perhaps} may be"),
                None if kind.up == UpAxis::Y => return None,
                None => String::new(),
            };
            let of = match kind.count {
                1 => kind.first.clone(),
                count => format!(
                    "{} ({} and {} more)",
                    counted(count, "file"),
                    kind.first,
                    grouped(count - 1)
                ),
            };
            let next = if kind.is_said {
                ", as --up says"
            } else {
                "; --up chooses another axis"
            };
            Some(one_line(&format!(
                "{} is taken as up in {of}{doubt}{next}",
                kind.up
            )))
        });
        lines.collect()
    }

    /// How many files there are for each axis.
    pub(super) fn json(&self) -> Value {
        let mut files = Map::new();
        for kind in &self.kinds {
            let of_axis = files.entry(kind.up.name()).or_insert(json!(0));
            *of_axis = json!(of_axis.as_u64().unwrap_or(0) + kind.count as u64);
        }
        Value::Object(files)
    }
}
