//! What the user named, as a list of things to read.
//!
//! A name may be a file (whatever its extension), a folder (every motion file in it and below, in
//! order of name), a pattern with `*`, `?`, `[...]` or `**`, `-` for standard input, or
//! `sample:walk` and its like, clips that the program makes itself.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Component, Path, PathBuf};

use walkdir::WalkDir;

use crate::failure::Failure;
use crate::sample::Sample;
use crate::similar;

/// Standard input's name on the command line.
pub(crate) const STDIN: &str = "-";
/// What a clip of our own starts with on the command line.
pub(crate) const SAMPLE_PREFIX: &str = "sample:";

/// One thing to read.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// Where its bytes come from.
    pub(crate) source: Source,
    /// Its path below the folder or pattern that named it: where a mirrored output goes.
    pub(crate) relative: PathBuf,
}

/// Where an input comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// A file.
    File(PathBuf),
    /// Standard input, to its end.
    Stdin,
    /// A clip that the program makes itself.
    Sample(Sample),
}

/// Everything the user named.
#[derive(Debug, Default)]
pub(crate) struct Inputs {
    /// What there is to read, in the order it was named; a folder's files by name.
    pub(crate) list: Vec<Input>,
    /// What was named and is not there: the name, and why not.
    pub(crate) failures: Vec<(String, Failure)>,
    /// Whether the user named a set (several names, a folder or a pattern), even a set of one:
    /// then results go to a folder and not to one file.
    pub(crate) is_set: bool,
}

impl Input {
    /// What messages call this input.
    pub(crate) fn name(&self) -> String {
        match &self.source {
            Source::File(path) => path.display().to_string(),
            Source::Stdin => "standard input".to_owned(),
            Source::Sample(sample) => format!("{SAMPLE_PREFIX}{}", sample.name()),
        }
    }

    fn file(path: PathBuf, relative: PathBuf) -> Self {
        Self {
            source: Source::File(path),
            relative,
        }
    }

    /// A clip that the program makes itself.
    pub(crate) fn sample(sample: Sample) -> Self {
        let relative = PathBuf::from(format!("{}.bvh", sample.name()));
        Self {
            source: Source::Sample(sample),
            relative,
        }
    }
}

/// Finds what `names` stand for. A name that stands for nothing is a failure in the list: the rest
/// is still worked on.
pub(crate) fn expand(names: &[OsString]) -> Inputs {
    let mut inputs = Inputs {
        is_set: names.len() > 1,
        ..Inputs::default()
    };
    for name in names {
        if name == STDIN {
            let relative = PathBuf::from("stdin.bvh");
            inputs.list.push(Input {
                source: Source::Stdin,
                relative,
            });
            continue;
        }
        let text = name.to_str();
        if let Some(sample) = text.and_then(|text| text.strip_prefix(SAMPLE_PREFIX)) {
            match Sample::named(sample) {
                Some(sample) => inputs.list.push(Input::sample(sample)),
                None => {
                    let name = format!("{SAMPLE_PREFIX}{sample}");
                    inputs.failures.push((name, unknown_sample(sample)));
                }
            }
            continue;
        }
        let path = Path::new(name);
        if path.is_dir() {
            inputs.is_set = true;
            add_folder(path, &mut inputs);
        } else if let Some(pattern) = text.filter(|text| !path.exists() && is_pattern(text)) {
            inputs.is_set = true;
            add_pattern(pattern, &mut inputs);
        } else {
            // A missing file fails when it is read, with the system's own reason.
            let relative = path
                .file_name()
                .map_or_else(|| path.to_owned(), PathBuf::from);
            inputs.list.push(Input::file(path.to_owned(), relative));
        }
    }
    drop_repeats(&mut inputs.list);
    inputs
}

fn unknown_sample(name: &str) -> Failure {
    if posekit_formats::urdf::sample::by_name(name).is_some() {
        let why =
            format!("{SAMPLE_PREFIX}{name} is a robot, which posekit view alone takes by its name");
        let next = format!("posekit sample {name} -o {name}.urdf makes a file of it");
        return Failure::usage(why).try_next(next);
    }
    let known: Vec<_> = Sample::ALL.iter().map(|sample| sample.name()).collect();
    let failure = Failure::usage(format!("there is no sample '{name}'"));
    match similar::nearest(name, known.iter().copied()) {
        Some(meant) => failure.try_next(format!("did you mean {SAMPLE_PREFIX}{meant}")),
        None => failure.try_next(format!("the samples are {}", known.join(", "))),
    }
}

/// The same file named twice (`walk.bvh .`) is worked on once.
fn drop_repeats(list: &mut Vec<Input>) {
    let mut seen = std::collections::HashSet::new();
    list.retain(|input| match &input.source {
        Source::File(path) => seen.insert(without_dots(path)),
        Source::Stdin | Source::Sample(_) => seen.insert(PathBuf::from(input.name())),
    });
}

/// `./a.bvh` and `a.bvh` are the same name.
fn without_dots(path: &Path) -> PathBuf {
    path.components()
        .filter(|component| *component != Component::CurDir)
        .collect()
}

fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?', '['])
}

/// Whether a file found in a folder is one to read; a file named outright is read whatever it is
/// called.
fn is_motion_file(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("bvh"))
}

fn add_folder(folder: &Path, inputs: &mut Inputs) {
    let before = (inputs.list.len(), inputs.failures.len());
    for entry in WalkDir::new(folder).follow_links(true).sort_by_file_name() {
        match entry {
            Ok(entry) if entry.file_type().is_file() && is_motion_file(entry.path()) => {
                let relative = entry.path().strip_prefix(folder).unwrap_or(entry.path());
                inputs
                    .list
                    .push(Input::file(entry.path().to_owned(), relative.to_owned()));
            }
            Ok(_) => {}
            Err(error) => {
                // A link that leads nowhere is only a problem if it claims to be a motion file.
                let path = error.path().unwrap_or(folder).to_owned();
                let dangling = fs::symlink_metadata(&path).is_ok_and(|meta| meta.is_symlink());
                if !dangling || is_motion_file(&path) {
                    let error = std::io::Error::from(error);
                    let failure = Failure::cannot_read(&path, &error);
                    inputs.failures.push((path.display().to_string(), failure));
                }
            }
        }
    }
    if (inputs.list.len(), inputs.failures.len()) == before {
        let name = folder.display().to_string();
        let failure = Failure::new(format!("{name}: no .bvh file in this folder or below it"));
        inputs.failures.push((name, failure));
    }
}

fn add_pattern(pattern: &str, inputs: &mut Inputs) {
    let matches = match glob::glob(pattern) {
        Ok(matches) => matches,
        Err(error) => {
            let failure = Failure::usage(format!("bad pattern '{pattern}': {}", error.msg));
            inputs.failures.push((pattern.to_owned(), failure));
            return;
        }
    };
    let root = literal_folder(pattern);
    let before = (inputs.list.len(), inputs.failures.len());
    for path in matches {
        match path {
            Ok(path) if path.is_dir() => add_folder_below(&path, &root, inputs),
            Ok(path) => {
                let relative = path.strip_prefix(&root).unwrap_or(&path).to_owned();
                inputs.list.push(Input::file(path, relative));
            }
            Err(error) => {
                let failure = Failure::cannot_read(error.path(), error.error());
                let name = error.path().display().to_string();
                inputs.failures.push((name, failure));
            }
        }
    }
    if (inputs.list.len(), inputs.failures.len()) == before {
        let failure = Failure::new(format!("no file matches '{pattern}'"));
        inputs.failures.push((pattern.to_owned(), failure));
    }
}

/// A folder that a pattern matched: its files, mirrored below the pattern's own folder.
fn add_folder_below(folder: &Path, root: &Path, inputs: &mut Inputs) {
    let start = inputs.list.len();
    add_folder(folder, inputs);
    let below = folder.strip_prefix(root).unwrap_or(folder);
    for input in &mut inputs.list[start..] {
        input.relative = below.join(&input.relative);
    }
}

/// The part of a pattern before its first component with a wildcard.
fn literal_folder(pattern: &str) -> PathBuf {
    let is_plain = |component: &OsStr| component.to_str().is_some_and(|text| !is_pattern(text));
    Path::new(pattern)
        .components()
        .take_while(|part| is_plain(part.as_os_str()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for path in ["b.bvh", "a.BVH", "notes.txt", "sub/c.bvh", "sub/deep/d.bvh"] {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    fn relatives(inputs: &Inputs) -> Vec<String> {
        inputs
            .list
            .iter()
            .map(|i| i.relative.to_str().unwrap().replace('\\', "/"))
            .collect()
    }

    #[test]
    fn a_folder_gives_its_motion_files_in_order_and_keeps_their_sub_folders() {
        let tree = tree();
        let inputs = expand(&[tree.path().into()]);
        assert!(inputs.is_set && inputs.failures.is_empty());
        assert_eq!(
            relatives(&inputs),
            ["a.BVH", "b.bvh", "sub/c.bvh", "sub/deep/d.bvh"]
        );
    }

    #[test]
    fn a_pattern_mirrors_below_its_own_folder() {
        let tree = tree();
        let inputs = expand(&[tree.path().join("**/*.bvh").into()]);
        assert_eq!(relatives(&inputs), ["b.bvh", "sub/c.bvh", "sub/deep/d.bvh"]);
        let inputs = expand(&[tree.path().join("s*").into()]);
        assert_eq!(relatives(&inputs), ["sub/c.bvh", "sub/deep/d.bvh"]);
    }

    #[test]
    fn one_file_is_not_a_set_and_a_repeated_one_is_read_once() {
        let tree = tree();
        let one = tree.path().join("b.bvh");
        assert!(!expand(&[one.clone().into()]).is_set);
        let inputs = expand(&[one.clone().into(), tree.path().join("./b.bvh").into()]);
        assert_eq!(inputs.list.len(), 1);
        assert!(inputs.is_set);
    }

    #[test]
    fn what_is_not_there_is_a_failure_beside_what_is() {
        let tree = tree();
        let names = [
            tree.path().join("*.xyz").into(),
            tree.path().into(),
            "sample:fly".into(),
        ];
        let inputs = expand(&names);
        assert_eq!((inputs.list.len(), inputs.failures.len()), (4, 2));
        assert!(
            inputs.failures[0]
                .1
                .to_string()
                .starts_with("no file matches")
        );
        assert!(
            inputs.failures[1]
                .1
                .to_string()
                .contains("walk, run, wave, arm")
        );
    }
}
