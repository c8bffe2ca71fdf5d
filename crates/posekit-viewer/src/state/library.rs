//! The library: the clips of a folder that are not open, and the filter over everything listed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A file of the folder.
#[derive(Clone, Debug)]
pub struct Entry<T> {
    /// The file.
    pub path: PathBuf,
    /// Its name, without the folder.
    pub name: String,
    /// The folder that it is in, as seen from the folder that is listed; empty for that one itself.
    pub group: String,
    /// Where its name goes another way than others of the folder, in bytes.
    pub branches: Vec<usize>,
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
    /// Its files, those of one folder in it beside each other.
    pub entries: Vec<Entry<T>>,
    /// What is in the folder and not among them, for people.
    pub shortage: Option<String>,
    /// The folders in it whose files are not shown.
    closed: BTreeSet<String>,
    /// What was typed to filter by.
    pub filter: String,
}

impl<T> Default for Library<T> {
    fn default() -> Self {
        Self {
            folder: None,
            entries: Vec::new(),
            shortage: None,
            closed: BTreeSet::new(),
            filter: String::new(),
        }
    }
}

impl<T> Library<T> {
    /// Lists another folder's files.
    pub fn list(&mut self, folder: PathBuf, paths: Vec<PathBuf>) {
        let named = |path: PathBuf| {
            let below = path.strip_prefix(&folder).unwrap_or(&path);
            let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
            let name = parts.join("/");
            (path, name)
        };
        let mut files: Vec<(PathBuf, String)> = paths.into_iter().map(named).collect();
        // The files of the folder itself before those of folders in it.
        files.sort_by(|a, b| parts_of(&a.1).cmp(&parts_of(&b.1)));
        self.list_named(folder, files);
    }

    /// Lists files, in this order, under names that they were given; in those, folders may stand before `/`.
    pub fn list_named(&mut self, folder: PathBuf, files: Vec<(PathBuf, String)>) {
        let entry = |(path, whole): (PathBuf, String)| {
            let (group, name) = parts_of(&whole);
            Entry {
                path,
                name: name.to_owned(),
                group: group.to_owned(),
                branches: Vec::new(),
                state: EntryState::Unknown,
            }
        };
        self.entries = files.into_iter().map(entry).collect();
        let names: Vec<&str> = self.entries.iter().map(|it| it.name.as_str()).collect();
        let branches = super::names::branches(&names);
        for (entry, branches) in self.entries.iter_mut().zip(branches) {
            entry.branches = branches;
        }
        self.shortage = None;
        self.closed.clear();
        self.folder = Some(folder);
    }

    /// The files that pass the filter and a test, in their order: first those that lie in no further folder, then
    /// folder by folder.
    pub fn groups(&self, is_listed: impl Fn(&Entry<T>) -> bool) -> Vec<(&str, Vec<&Entry<T>>)> {
        let mut groups: Vec<(&str, Vec<&Entry<T>>)> = vec![("", Vec::new())];
        let mut place_of = BTreeMap::from([("", 0)]);
        for entry in self.entries.iter().filter(|entry| is_listed(entry)) {
            let whole = format!("{}/{}", entry.group, entry.name);
            if !self.passes(&whole) {
                continue;
            }
            let place = *place_of.entry(&entry.group).or_insert_with(|| {
                groups.push((&entry.group, Vec::new()));
                groups.len() - 1
            });
            groups[place].1.push(entry);
        }
        if groups[0].1.is_empty() {
            groups.remove(0);
        }
        groups
    }

    /// Whether the files of a folder in it are shown. While a filter is typed all are that pass it.
    #[must_use]
    pub fn is_open(&self, group: &str) -> bool {
        !self.filter.trim().is_empty() || !self.closed.contains(group)
    }

    /// Shows the files of a folder in it, or no longer.
    pub fn toggle(&mut self, group: &str) {
        if !self.closed.remove(group) {
            self.closed.insert(group.to_owned());
        }
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

/// The folder and the name in a path whose parts are parted by `/`.
fn parts_of(whole: &str) -> (&str, &str) {
    whole.rsplit_once('/').unwrap_or(("", whole))
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
    fn files_of_one_folder_stand_together_and_can_be_closed() {
        let mut library = Library::<u8>::default();
        let paths = [
            "c/z.bvh",
            "c/b/a.bvh",
            "c/a/y.bvh",
            "c/a/x.bvh",
            "c/a.b/q.bvh",
        ];
        library.list("c".into(), paths.map(PathBuf::from).to_vec());
        let groups = |library: &Library<u8>| -> Vec<(String, Vec<String>)> {
            let groups = library.groups(|_| true).into_iter();
            let names = |entries: Vec<&Entry<u8>>| entries.iter().map(|e| e.name.clone()).collect();
            groups
                .map(|(group, entries)| (group.to_owned(), names(entries)))
                .collect()
        };
        let group = |name: &str, files: &[&str]| {
            (
                name.to_owned(),
                files
                    .iter()
                    .map(|file| (*file).to_owned())
                    .collect::<Vec<_>>(),
            )
        };
        let all = [
            group("", &["z.bvh"]),
            group("a", &["x.bvh", "y.bvh"]),
            group("a.b", &["q.bvh"]),
            group("b", &["a.bvh"]),
        ];
        assert_eq!(groups(&library), all);
        library.toggle("a");
        assert!(!library.is_open("a") && library.is_open("b"));
        library.filter = "a/".to_owned();
        assert!(library.is_open("a"), "what a filter finds is shown");
        assert_eq!(groups(&library), [all[1].clone()]);
        library.filter.clear();
        library.toggle("a");
        assert!(library.is_open("a"));
        // A server's names say folders, too, and come in any order.
        let files = ["d/e.bvh", "f.bvh", "d/g.bvh"];
        let files = files.map(|name| (PathBuf::from(format!("clips/{name}")), name.to_owned()));
        library.list_named("server".into(), files.to_vec());
        let all = [group("", &["f.bvh"]), group("d", &["e.bvh", "g.bvh"])];
        assert_eq!(groups(&library), all);
        library.filter = "d/".to_owned();
        assert_eq!(groups(&library), all[1..]);
    }

    #[test]
    fn only_motion_files_are_listed() {
        assert!(is_motion_file(Path::new("a/B.BVH")));
        assert!(is_motion_file(Path::new("a/b.posekit.toml")));
        assert!(!is_motion_file(Path::new("a/bvh")) && !is_motion_file(Path::new("a/c.obj")));
        assert!(motion_files(Path::new("no/such/folder")).is_err());
    }
}
