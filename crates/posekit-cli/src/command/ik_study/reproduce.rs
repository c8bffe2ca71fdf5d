//! The `posekit ik` command that does what a run of the study did, and prints its residual.

use posekit::skeleton::JointId;

use super::experiment::Cell;
use super::setup::Study;

/// The command of a run.
pub(super) fn command(study: &Study, cell: Cell) -> String {
    let target = study.target(cell).place;
    let count = study.counts[cell.count].to_string();
    let method = study.methods[cell.method];
    let mut words = figure_words(study);
    let chain = &study.chains[cell.chain];
    let name = |joint: JointId| study.skeleton.unique_name(joint).to_owned();
    words.extend(["--start".to_owned(), name(chain.chain.start())]);
    words.extend(["--end".to_owned(), name(chain.chain.end())]);
    words.push("--target".to_owned());
    words.push(format!("{},{},{}", target.x, target.y, target.z));
    // As in the study nothing but its own rest stops a solver early, and it rests within the study's tolerance.
    words.extend(["--tolerance", "0", "--rest-tolerance"].map(str::to_owned));
    words.push(chain.tolerance.to_string());
    words.extend(["--solver", method.option()].map(str::to_owned));
    if let (true, Some([upper, middle])) = (method.is_two_bone(), chain.two_bones()) {
        words.push("--two-bone-joints".to_owned());
        words.push(format!("{},{}", name(upper), name(middle)));
    }
    words.extend(["--iterations".to_owned(), count]);
    line(words)
}

/// `posekit ik FILE`, and the pose in which the study starts.
fn figure_words(study: &Study) -> Vec<String> {
    let file = study.file.to_string_lossy().into_owned();
    let mut words = vec!["posekit".to_owned(), "ik".to_owned(), file];
    match study.start_frame {
        Some(frame) => words.extend(["--frames".to_owned(), frame.to_string()]),
        None => words.push("--rest".to_owned()),
    }
    if let Some(place) = study.root_place {
        words.push("--root".to_owned());
        words.push(format!("{},{},{}", place.x, place.y, place.z));
    }
    words.extend(study.positions.words());
    words
}

/// Words as a shell takes them.
pub(super) fn line(words: impl IntoIterator<Item = String>) -> String {
    let words = words.into_iter().map(|word| {
        let is_plain = |c: char| c.is_alphanumeric() || "-_./:,=+\\".contains(c);
        if !word.is_empty() && word.chars().all(is_plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', "'\\''"))
        }
    });
    words.collect::<Vec<String>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_them() {
        let words = ["a.bvh", "-1,2e-3,0", "two words", "it's", ""].map(str::to_owned);
        assert_eq!(line(words), "a.bvh -1,2e-3,0 'two words' 'it'\\''s' ''");
    }
}
