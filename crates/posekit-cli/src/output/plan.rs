//! Which file each input's result is written to, settled before any work starts.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use super::guard::{Guard, Target};
use crate::failure::Failure;
use crate::inputs::{Input, Inputs, STDIN, Source};
use crate::scene_file;

/// Where one result goes.
#[derive(Clone, Debug)]
pub(crate) enum Destination {
    /// A file.
    File(Target),
    /// Standard output.
    Stdout,
}

/// Where every result goes, by the index of its input.
#[derive(Debug)]
pub(crate) struct Plan {
    destinations: Vec<Destination>,
}

impl Plan {
    /// Reads the user's output name for these inputs. `extension` is what files that we name
    /// ourselves end in.
    ///
    /// One input and a plain name: that file. A folder (one that exists, a name that ends in a
    /// slash, or any plain name when the inputs are a set): the inputs' sub-folders mirrored in it.
    /// A name with `{stem}`, `{dir}` or `{ext}` in it: that pattern, filled in for every input.
    ///
    /// No result may land on an input, and no two on the same file: `guard` sees to that.
    pub(crate) fn new(
        output: &OsStr,
        inputs: &Inputs,
        extension: &str,
        guard: &Guard,
    ) -> Result<Self, Failure> {
        if output.is_empty() {
            return Err(Failure::usage("the output name is empty"));
        }
        note_inputs(inputs, guard)?;
        if output == STDIN {
            return Self::to_stdout(inputs, guard);
        }
        let path = Path::new(output);
        let pattern = output.to_str().filter(|text| text.contains('{'));
        let files: Vec<PathBuf> = if let Some(pattern) = pattern {
            inputs
                .list
                .iter()
                .map(|i| fill(pattern, i, extension))
                .collect::<Result<_, _>>()?
        } else if is_folder_name(path, inputs)? {
            inputs
                .list
                .iter()
                .map(|input| Ok(path.join(inside(&input.relative)?.with_extension(extension))))
                .collect::<Result<_, Failure>>()?
        } else {
            inputs.list.iter().map(|_| path.to_owned()).collect()
        };
        refuse_collisions(&files, inputs)?;
        let targets = files.iter().zip(&inputs.list).map(|(file, input)| {
            let target = guard.target(file, &input.name())?;
            Ok(Destination::File(target))
        });
        Ok(Self {
            destinations: targets.collect::<Result<_, Failure>>()?,
        })
    }

    fn to_stdout(inputs: &Inputs, guard: &Guard) -> Result<Self, Failure> {
        if inputs.is_set {
            return Err(
                Failure::usage("several results cannot share standard output")
                    .try_next("give a folder with -o"),
            );
        }
        guard.refuse_stdout()?;
        Ok(Self {
            destinations: vec![Destination::Stdout; inputs.list.len()],
        })
    }

    /// Where the result of input number `index` goes.
    pub(crate) fn destination(&self, index: usize) -> &Destination {
        &self.destinations[index]
    }
}

/// Whether a plain output name stands for a folder.
fn is_folder_name(path: &Path, inputs: &Inputs) -> Result<bool, Failure> {
    let ends_in_slash = path.as_os_str().as_encoded_bytes().ends_with(b"/")
        || path
            .as_os_str()
            .to_str()
            .is_some_and(|text| text.ends_with(std::path::MAIN_SEPARATOR));
    if ends_in_slash || path.is_dir() {
        return Ok(true);
    }
    if !inputs.is_set {
        return Ok(false);
    }
    // `-o out.npz` for a hundred files is a slip, not a wish for a folder of that name.
    if path.is_file() || path.extension().is_some() {
        let name = path.display();
        return Err(Failure::usage(format!(
            "'{name}' is one file, but there may be many results"
        ))
        .try_next(format!(
            "name a folder, as '{}/'",
            path.with_extension("").display()
        )));
    }
    Ok(true)
}

/// A mirrored path stays inside the output folder.
fn inside(relative: &Path) -> Result<&Path, Failure> {
    if relative
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
    {
        return Ok(relative);
    }
    Err(Failure::usage(format!(
        "cannot mirror '{}' inside a folder",
        relative.display()
    ))
    .try_next("name the file or its folder explicitly"))
}

/// Fills in `{stem}` (the input's name without extension), `{dir}` (its sub-folder) and `{ext}`.
fn fill(pattern: &str, input: &Input, extension: &str) -> Result<PathBuf, Failure> {
    let relative = inside(&input.relative)?;
    let stem = relative.file_stem().unwrap_or_default().to_string_lossy();
    let dir = relative.parent().unwrap_or(Path::new("")).to_string_lossy();
    let mut filled = String::with_capacity(pattern.len() + stem.len());
    let mut rest = pattern;
    while let Some(open) = rest.find('{') {
        filled.push_str(&rest[..open]);
        let Some(length) = rest[open..].find('}') else {
            return Err(unknown_placeholder(&rest[open..]));
        };
        match &rest[open..=open + length] {
            "{stem}" => filled.push_str(&stem),
            "{dir}" if dir.is_empty() => filled.push('.'),
            "{dir}" => filled.push_str(&dir),
            "{ext}" => filled.push_str(extension),
            other => return Err(unknown_placeholder(other)),
        }
        rest = &rest[open + length + 1..];
    }
    filled.push_str(rest);
    // A `{dir}` of nothing leaves a `.` behind, which components drop.
    Ok(Path::new(&filled).components().collect())
}

fn unknown_placeholder(text: &str) -> Failure {
    Failure::usage(format!("'{text}' in the output name is not known"))
        .try_next("there are {stem}, {dir} and {ext}")
}

/// What is read is known before anything is written: of several inputs the first result is there before the last
/// input is read.
fn note_inputs(inputs: &Inputs, guard: &Guard) -> Result<(), Failure> {
    for input in &inputs.list {
        if let Source::File(path) = &input.source {
            guard.reads(path)?;
            if inputs.list.len() > 1 && scene_file::is_scene(path) {
                scene_file::note_files(path, guard)?;
            }
        }
    }
    Ok(())
}

fn refuse_collisions(files: &[PathBuf], inputs: &Inputs) -> Result<(), Failure> {
    let mut first_at: BTreeMap<&Path, usize> = BTreeMap::new();
    for (index, file) in files.iter().enumerate() {
        if let Some(first) = first_at.insert(file, index) {
            let (a, b) = (inputs.list[first].name(), inputs.list[index].name());
            let file = file.display();
            return Err(
                Failure::usage(format!("{a} and {b} would both be written to {file}"))
                    .try_next("name their common folder as the input, or use {dir} in -o"),
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::expand;
    use std::ffi::OsString;
    use std::fs;

    fn tree() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for path in ["in/a.bvh", "in/sub/a.bvh"] {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        folder
    }

    fn planned(output: &str, names: &[&str]) -> Result<Vec<String>, String> {
        let tree = tree();
        let names: Vec<OsString> = names.iter().map(|n| tree.path().join(n).into()).collect();
        let inputs = expand(&names);
        let plan = Plan::new(
            tree.path().join(output).as_os_str(),
            &inputs,
            "npz",
            &Guard::default(),
        );
        let plan = plan.map_err(|failure| failure.to_string())?;
        let root = tree.path().to_owned();
        Ok((0..inputs.list.len())
            .map(|index| match plan.destination(index) {
                Destination::File(target) => target
                    .path()
                    .strip_prefix(&root)
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .replace('\\', "/"),
                Destination::Stdout => "-".to_owned(),
            })
            .collect())
    }

    #[test]
    fn one_file_goes_to_the_name_given_or_into_the_folder_given() {
        assert_eq!(planned("x.npz", &["in/a.bvh"]).unwrap(), ["x.npz"]);
        assert_eq!(planned("x/", &["in/a.bvh"]).unwrap(), ["x/a.npz"]);
        assert_eq!(planned("in", &["in/a.bvh"]).unwrap(), ["in/a.npz"]);
    }

    #[test]
    fn a_set_goes_to_a_folder_with_its_sub_folders() {
        assert_eq!(
            planned("out", &["in"]).unwrap(),
            ["out/a.npz", "out/sub/a.npz"]
        );
        let error = planned("out.npz", &["in"]).unwrap_err();
        assert!(error.contains("is one file"), "{error}");
    }

    #[test]
    fn a_pattern_is_filled_in() {
        let names = planned("o/{dir}/{stem}_fk.{ext}", &["in"]).unwrap();
        assert_eq!(names, ["o/a_fk.npz", "o/sub/a_fk.npz"]);
        assert!(
            planned("o/{name}.npz", &["in"])
                .unwrap_err()
                .contains("{stem}, {dir} and {ext}")
        );
        assert!(planned("o/{stem", &["in"]).is_err());
    }

    #[test]
    fn two_results_on_one_file_and_a_result_on_an_input_are_refused() {
        let error = planned("out", &["in/a.bvh", "in/sub/a.bvh"]).unwrap_err();
        assert!(error.contains("would both be written"), "{error}");
        let error = planned("in/a.bvh", &["in/a.bvh"]).unwrap_err();
        assert!(error.contains("would be overwritten"), "{error}");
        let error = planned("in/sub/../a.bvh", &["in/a.bvh"]).unwrap_err();
        assert!(error.contains("would be overwritten"), "{error}");
    }
}
