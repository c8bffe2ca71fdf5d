//! How much of what is put into real clips is found, and how much is reported on clips into which
//! nothing was put: the table in `docs/check/README.md`.
//!
//! The table is made from the real files beside the project. Where they are, the guide must
//! hold it as it is printed here; where they are not, there is nothing to compare.

use std::collections::BTreeSet;
use std::path::Path;

use posekit_formats::bvh::{Bvh, CheckEntry};

use crate::bvh_real_files::files;
use crate::check_clip::{Clip, check, real_clips};
use crate::check_damage as damage;

/// A way to damage a clip; `None` where it cannot be done to that clip.
type Damage = fn(&Clip) -> Option<Bvh>;

/// What is done to a clip, by how much, to which clips, and the code that must be found.
struct Row {
    what: &'static str,
    code: &'static str,
    damage: Damage,
}

const fn row(what: &'static str, code: &'static str, damage: Damage) -> Row {
    Row { what, code, damage }
}

const ROWS: &[Row] = &[
    row(
        "a joint off by 30 degrees for 2 frames",
        "rotation-spike",
        |clip| Some(damage::rotation_spike(clip, 30.0, 2)),
    ),
    row("... by 45 degrees", "rotation-spike", |clip| {
        Some(damage::rotation_spike(clip, 45.0, 2))
    }),
    row("... by 85 degrees", "rotation-spike", |clip| {
        Some(damage::rotation_spike(clip, 85.0, 2))
    }),
    row(
        "a joint off by 45 degrees from a frame on",
        "rotation-jump",
        |clip| Some(damage::rotation_jump(clip, 45.0)),
    ),
    row("... by 80 degrees", "rotation-jump", |clip| {
        Some(damage::rotation_jump(clip, 80.0))
    }),
    row(
        "the figure elsewhere by 0.1 heights from a frame on",
        "teleport",
        |clip| Some(damage::teleport(clip, 0.1)),
    ),
    row("... by 0.2 heights", "teleport", |clip| {
        Some(damage::teleport(clip, 0.2))
    }),
    row("... by 0.5 heights", "teleport", |clip| {
        Some(damage::teleport(clip, 0.5))
    }),
    row(
        "the figure elsewhere by 0.1 heights for a frame",
        "position-spike",
        |clip| Some(damage::position_spike(clip, 0.1, 1)),
    ),
    row("... by 0.4 heights", "position-spike", |clip| {
        Some(damage::position_spike(clip, 0.4, 1))
    }),
    row("a frame repeated for 0.12 s", "frozen-frames", |clip| {
        Some(damage::freeze(clip, 0.12))
    }),
    row("... for 0.25 s", "frozen-frames", |clip| {
        Some(damage::freeze(clip, 0.25))
    }),
    row(
        "not a run, drifting at 0.1 heights a second",
        "foot-sliding",
        |clip| (!clip.is_run()).then(|| damage::drift(clip, 0, 0.1)),
    ),
    row("... at 0.2", "foot-sliding", |clip| {
        (!clip.is_run()).then(|| damage::drift(clip, 0, 0.2))
    }),
    row("... at 0.3", "foot-sliding", |clip| {
        (!clip.is_run()).then(|| damage::drift(clip, 0, 0.3))
    }),
    row("... at 0.4", "foot-sliding", |clip| {
        (!clip.is_run()).then(|| damage::drift(clip, 2, 0.4))
    }),
    row("... at 0.6", "foot-sliding", |clip| {
        (!clip.is_run()).then(|| damage::drift(clip, 2, 0.6))
    }),
    row(
        "a run, drifting at 0.1 heights a second",
        "foot-sliding",
        |clip| clip.is_run().then(|| damage::drift(clip, 0, 0.1)),
    ),
    row("... at 0.2", "foot-sliding", |clip| {
        clip.is_run().then(|| damage::drift(clip, 0, 0.2))
    }),
    row("... at 0.3", "foot-sliding", |clip| {
        clip.is_run().then(|| damage::drift(clip, 0, 0.3))
    }),
    row("... at 0.4", "foot-sliding", |clip| {
        clip.is_run().then(|| damage::drift(clip, 2, 0.4))
    }),
    row("... at 0.6", "foot-sliding", |clip| {
        clip.is_run().then(|| damage::drift(clip, 2, 0.6))
    }),
    row("a walk on the spot", "foot-sliding", |clip| {
        damage::on_the_spot(clip).filter(|_| clip.is_walk())
    }),
    row("a run on the spot", "foot-sliding", |clip| {
        damage::on_the_spot(clip).filter(|_| clip.is_run())
    }),
    row(
        "sinking by 0.04 heights for a second",
        "foot-below-floor",
        |clip| Some(damage::sink(clip, 0.04)),
    ),
    row("... by 0.08 heights", "foot-below-floor", |clip| {
        Some(damage::sink(clip, 0.08))
    }),
    row(
        "a bone longer by 3 per cent",
        "bone-length-changes",
        |clip| damage::stretch(clip, 1.03),
    ),
    row(
        "a walk, played 4 times too slow",
        "playback-speed-implausible",
        |clip| clip.is_walk().then(|| damage::played(clip, 0.25)),
    ),
    row(
        "... 2 times too slow",
        "playback-speed-implausible",
        |clip| clip.is_walk().then(|| damage::played(clip, 0.5)),
    ),
    row(
        "... 2 times too fast",
        "playback-speed-implausible",
        |clip| clip.is_walk().then(|| damage::played(clip, 2.0)),
    ),
    row(
        "... 4 times too fast",
        "playback-speed-implausible",
        |clip| clip.is_walk().then(|| damage::played(clip, 4.0)),
    ),
    row(
        "a run, played 2 times too slow",
        "playback-speed-implausible",
        |clip| clip.is_run().then(|| damage::played(clip, 0.5)),
    ),
    row(
        "... 2 times too fast",
        "playback-speed-implausible",
        |clip| clip.is_run().then(|| damage::played(clip, 2.0)),
    ),
];

/// What a row came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Score {
    found: usize,
    damaged: usize,
    /// Clips of the row on which the code is reported although nothing was done to them.
    false_alarms: usize,
}

impl Score {
    fn add(&mut self, other: Self) {
        self.found += other.found;
        self.damaged += other.damaged;
        self.false_alarms += other.false_alarms;
    }

    fn recall(self) -> String {
        format!("{}/{}", self.found, self.damaged)
    }

    fn precision(self) -> String {
        let reported = self.found + self.false_alarms;
        if reported == 0 {
            return "-".to_owned();
        }
        format!("{:.2}", self.found as f64 / reported as f64)
    }
}

fn score(clip: &Clip, row: &Row) -> Score {
    let Some(damaged) = (row.damage)(clip) else {
        return Score::default();
    };
    let of_code = |entries: &[CheckEntry]| -> Vec<CheckEntry> {
        let same = entries.iter().filter(|entry| entry.code == row.code);
        same.cloned().collect()
    };
    let before = of_code(&clip.found);
    let is_new = |entry: &CheckEntry| !before.contains(entry);
    Score {
        found: usize::from(of_code(&check(&damaged)).iter().any(is_new)),
        damaged: 1,
        false_alarms: usize::from(!before.is_empty()),
    }
}

/// Half of the clips by the FNV-1a hash of their names, so that each row can be seen on two
/// sets of clips.
fn is_in_second_half(name: &str) -> bool {
    let file = Path::new(name).file_stem().unwrap().to_string_lossy();
    let hash = file.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    (hash >> 40) % 2 == 1
}

/// The scores of all rows on one clip, with the half that it is in.
fn scores_of(clips: &[Clip]) -> Vec<[Score; 2]> {
    let mut scores = vec![[Score::default(); 2]; ROWS.len()];
    for clip in clips {
        let half = usize::from(is_in_second_half(&clip.name));
        for (row, scores) in ROWS.iter().zip(&mut scores) {
            scores[half].add(score(clip, row));
        }
    }
    scores
}

/// The table of the guide.
fn table(clips: &[Clip]) -> (String, Vec<Score>) {
    let parts: Vec<Vec<[Score; 2]>> = std::thread::scope(|scope| {
        let workers: Vec<_> = clips
            .chunks(clips.len().div_ceil(4))
            .map(|part| scope.spawn(|| scores_of(part)))
            .collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap())
            .collect()
    });
    let mut text = String::from(
        "| damage | code | found, first half | found, second half | precision |\n\
         | --- | --- | --- | --- | --- |\n",
    );
    let mut totals = Vec::new();
    for (index, row) in ROWS.iter().enumerate() {
        let mut halves = [Score::default(); 2];
        for part in &parts {
            halves[0].add(part[index][0]);
            halves[1].add(part[index][1]);
        }
        let mut total = halves[0];
        total.add(halves[1]);
        text += &format!(
            "| {} | `{}` | {} | {} | {} |\n",
            row.what,
            row.code,
            halves[0].recall(),
            halves[1].recall(),
            total.precision()
        );
        totals.push(total);
    }
    (text, totals)
}

#[test]
fn the_guide_says_how_much_is_found() {
    if files().is_empty() {
        return;
    }
    let clips = real_clips();
    let names: BTreeSet<&str> = clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(names.len(), clips.len());
    let (table, totals) = table(&clips);
    for (row, total) in ROWS.iter().zip(&totals) {
        assert!(total.damaged > 0, "{}: no clip to try it on", row.what);
    }
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/check/README.md");
    let page = std::fs::read_to_string(page).unwrap().replace("\r\n", "\n");
    assert!(
        page.contains(&table),
        "docs/check/README.md needs this table:\n{table}"
    );
}
