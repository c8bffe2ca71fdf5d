//! What is in a folder, as the file chooser lists it.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use posekit_formats::system::in_words;

/// More than anybody scrolls through; a folder of more is searched by its names' beginnings.
pub(super) const MOST: usize = 20_000;

/// A file or a folder in a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Item {
    /// Folders come first.
    pub is_file: bool,
    /// Its name in small letters: the order of the list.
    folded: String,
    /// Its name as it is shown.
    pub name: String,
    /// Where it is. A name that is not Unicode is whole only here.
    pub path: PathBuf,
    /// Where its name goes another way than others of the folder, in bytes.
    pub branches: Vec<usize>,
}

impl Item {
    /// Whether its name starts with a text, in any case of letters.
    #[must_use]
    pub fn starts_with(&self, folded: &str) -> bool {
        self.folded.starts_with(folded)
    }

    /// Whether a text is somewhere in its name, in any case of letters.
    #[must_use]
    pub fn contains(&self, folded: &str) -> bool {
        self.folded.contains(folded)
    }

    /// Whether its name ends in one of these, after a dot.
    #[must_use]
    pub fn ends_in(&self, endings: &[&str]) -> bool {
        endings
            .iter()
            .any(|ending| has_ending(&self.folded, ending))
    }

    /// Whether it is one that systems hide.
    #[must_use]
    pub fn is_hidden(&self) -> bool {
        self.name.starts_with('.')
    }
}

/// Whether a name ends in a dot and an ending, in any case of letters.
pub(super) fn has_ending(name: &str, ending: &str) -> bool {
    let name = name.to_lowercase();
    let stem = name.strip_suffix(&ending.to_lowercase());
    stem.is_some_and(|stem| stem.len() > 1 && stem.ends_with('.'))
}

/// What is in a folder: folders first, each by name.
///
/// # Errors
/// Why it cannot be listed, for people.
pub(super) fn list(folder: &Path) -> Result<Vec<Item>, String> {
    let listing = std::fs::read_dir(folder).map_err(|error| told(folder, &error))?;
    let items = listing.flatten().take(MOST).map(|item| {
        let path = item.path();
        // What a link leads to counts, and a link that leads nowhere is a file that cannot be opened.
        let is_folder = match item.file_type() {
            Ok(kind) if kind.is_symlink() => path.is_dir(),
            Ok(kind) => kind.is_dir(),
            Err(_unknown) => path.is_dir(),
        };
        let name = item.file_name().to_string_lossy().into_owned();
        Item {
            is_file: !is_folder,
            folded: name.to_lowercase(),
            name,
            path,
            branches: Vec::new(),
        }
    });
    let mut items: Vec<Item> = items.collect();
    items.sort();
    let names: Vec<&str> = items.iter().map(|item| item.name.as_str()).collect();
    let branches = crate::state::names::branches(&names);
    for (item, branches) in items.iter_mut().zip(branches) {
        item.branches = branches;
    }
    Ok(items)
}

/// Whether a file can be put into a folder: by putting one there, and taking it away again.
///
/// # Errors
/// Why not, for people.
pub(super) fn check_writable(folder: &Path) -> Result<(), String> {
    let probe = folder.join(format!(".posekit.{}.probe", std::process::id()));
    match std::fs::OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&probe)
    {
        Ok(_empty) => {
            // What cannot be removed again was written all the same.
            drop(std::fs::remove_file(&probe));
            Ok(())
        }
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(()),
        Err(error) => Err(format!(
            "{} cannot be written to: {}",
            folder.display(),
            why(&error)
        )),
    }
}

/// Whether a file is there that its owner, or the system, protects from being written to.
#[must_use]
pub fn is_write_protected(path: &Path) -> bool {
    let denied = || {
        let opened = std::fs::File::options().write(true).open(path);
        opened.is_err_and(|error| {
            let kind = error.kind();
            matches!(
                kind,
                ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem
            )
        })
    };
    std::fs::metadata(path)
        .is_ok_and(|meta| meta.is_file() && (meta.permissions().readonly() || denied()))
}

/// What went wrong with a folder, for people.
fn told(folder: &Path, error: &std::io::Error) -> String {
    let folder = folder.display();
    match error.kind() {
        ErrorKind::NotFound => format!("There is no folder {folder}"),
        ErrorKind::NotADirectory => format!("{folder} is not a folder"),
        _ => format!("{folder} cannot be listed: {}", why(error)),
    }
}

fn why(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::PermissionDenied => "you do not have permission".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "its file system is read-only".to_owned(),
        ErrorKind::NotFound => "it does not exist, or takes no new files".to_owned(),
        _ => in_words(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_told_in_any_case_and_need_a_name_before_them() {
        assert!(has_ending("Walk.BVH", "bvh"));
        assert!(has_ending("a.posekit.toml", "posekit.toml"));
        assert!(!has_ending(".bvh", "bvh") && !has_ending("bvh", "bvh"));
        assert!(!has_ending("a.xbvh", "bvh"));
    }

    #[test]
    fn what_is_wrong_with_a_folder_is_said() {
        let denied = std::io::Error::from(ErrorKind::PermissionDenied);
        let text = told(Path::new("/a b"), &denied);
        assert_eq!(text, "/a b cannot be listed: you do not have permission");
        let missing = list(Path::new("/no such folder")).expect_err("it is not there");
        assert_eq!(missing, "There is no folder /no such folder");
        let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        assert!(check_writable(&here).is_err());
    }
}
