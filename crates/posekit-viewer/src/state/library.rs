//! The library: the clips of a folder that are not open, and the filter over everything listed.

use std::path::{Path, PathBuf};

/// A file of the folder.
#[derive(Clone, Debug)]
pub struct Entry<T> {
    /// The file.
    pub path: PathBuf,
    /// Its name, without the folder.
    pub name: String,
    /// What is known of it.
    pub state: EntryState<T>,
}

/// What is known of a file of the folder.
#[derive(Clone, Debug)]
pub enum EntryState<T> {
    /// It was not looked at yet.
    Unknown,
    /// It can be opened.
    Ready(T),
    /// It cannot, or not just for a look, and why.
    Refused(String),
}

/// The clips of a folder. `T` is what is shown of a clip.
#[derive(Clone, Debug)]
pub struct Library<T> {
    /// The folder.
    pub folder: Option<PathBuf>,
    /// Its files, by name.
    pub entries: Vec<Entry<T>>,
    /// What is in the folder and not among them, for people.
    pub shortage: Option<String>,
    /// What was typed to filter by.
    pub filter: String,
}

impl<T> Default for Library<T> {
    fn default() -> Self {
        Self {
            folder: None,
            entries: Vec::new(),
            shortage: None,
            filter: String::new(),
        }
    }
}

impl<T> Library<T> {
    /// Lists another folder's files.
    pub fn list(&mut self, folder: PathBuf, mut paths: Vec<PathBuf>) {
        paths.sort();
        let named = |path: PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            (path.clone(), name.into_owned())
        };
        self.list_named(folder, paths.into_iter().map(named).collect());
    }

    /// Lists files, in this order, under names that they were given.
    pub fn list_named(&mut self, folder: PathBuf, files: Vec<(PathBuf, String)>) {
        let entry = |(path, name)| Entry {
            path,
            name,
            state: EntryState::Unknown,
        };
        self.entries = files.into_iter().map(entry).collect();
        self.shortage = None;
        self.folder = Some(folder);
    }

    /// Lists no folder.
    pub fn clear(&mut self) {
        self.entries.clear();
        self.shortage = None;
        self.folder = None;
    }

    /// Hands in what became known of a file.
    pub fn set_state(&mut self, path: &Path, state: EntryState<T>) {
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.path == path) {
            entry.state = state;
        }
    }

    /// How many files were not looked at yet.
    #[must_use]
    pub fn unknown_count(&self) -> usize {
        let unknown = |entry: &&Entry<T>| matches!(entry.state, EntryState::Unknown);
        self.entries.iter().filter(unknown).count()
    }

    /// Whether a name passes the filter.
    #[must_use]
    pub fn passes(&self, name: &str) -> bool {
        matches(&self.filter, name)
    }
}

/// Whether every word of a filter is somewhere in a name, in any case and order.
#[must_use]
pub fn matches(filter: &str, name: &str) -> bool {
    let name = name.to_lowercase();
    filter
        .to_lowercase()
        .split_whitespace()
        .all(|word| name.contains(word))
}

/// The motion files of a folder, and of the folders in it to a small depth; links to folders are
/// not followed, so there is no going round in circles.
///
/// # Errors
/// If the folder itself cannot be read.
#[cfg(not(target_arch = "wasm32"))]
pub fn motion_files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    /// Deep enough for a data set's folders, and not for a whole disk.
    const DEPTH: usize = 4;
    /// More than anybody scrolls through.
    const MOST: usize = 20_000;
    let mut files = Vec::new();
    let mut pending = vec![(folder.to_owned(), 0)];
    let mut is_first = true;
    while let Some((folder, depth)) = pending.pop() {
        let listing = match std::fs::read_dir(&folder) {
            Err(error) if is_first => return Err(error),
            Err(_unreadable) => continue,
            Ok(listing) => listing,
        };
        is_first = false;
        for item in listing.flatten() {
            let Ok(kind) = item.file_type() else { continue };
            let path = item.path();
            if kind.is_dir() && depth < DEPTH {
                pending.push((path, depth + 1));
            } else if !kind.is_dir() && is_motion_file(&path) && files.len() < MOST {
                files.push(path);
            }
        }
    }
    Ok(files)
}

/// Whether a file's name says that it holds motion.
#[must_use]
pub fn is_motion_file(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let is_bvh = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("bvh"));
    is_bvh || posekit_formats::scene::is_scene_name(&name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_must_be_there_in_any_order_and_case() {
        assert!(matches("", "walk.bvh"));
        assert!(matches(
            "  LEFT walk ",
            "dataset-1_walk-left_normal_001.bvh"
        ));
        assert!(!matches("walk right", "dataset-1_walk-left_normal_001.bvh"));
    }

    #[test]
    fn files_are_listed_by_name_and_filled_in() {
        let mut library = Library::<u8>::default();
        library.list(
            "clips".into(),
            vec!["clips/b.bvh".into(), "clips/a.bvh".into()],
        );
        assert_eq!(library.entries[0].name, "a.bvh");
        library.set_state(Path::new("clips/b.bvh"), EntryState::Ready(7));
        library.set_state(Path::new("clips/elsewhere.bvh"), EntryState::Ready(9));
        assert_eq!(library.unknown_count(), 1);
    }

    #[test]
    fn only_motion_files_are_listed() {
        assert!(is_motion_file(Path::new("a/B.BVH")));
        assert!(is_motion_file(Path::new("a/b.posekit.toml")));
        assert!(!is_motion_file(Path::new("a/bvh")) && !is_motion_file(Path::new("a/c.obj")));
        assert!(motion_files(Path::new("no/such/folder")).is_err());
    }
}
