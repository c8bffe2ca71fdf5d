//! Unsaved scenes are kept aside every few seconds, and offered again when the program ended without
//! saving them.
//!
//! Each run of the program has a folder entry of its own: a lock that it holds while it runs, and a file
//! for each scene. Where the lock can be taken by another run, the one that held it is gone, and what it
//! has left is offered. On a page the browser's local storage takes the folder's place, and its own locks, which it
//! lets go when a page is gone, that of the lock.

use std::collections::BTreeMap;

use posekit_formats::scene;

use crate::load::scene::{ReadScene, authored_of};
use crate::state::animate::Authored;
use crate::state::clip::{Clip, Source};
use crate::state::session::{ClipId, Session};

#[cfg(not(target_arch = "wasm32"))]
use folder::Shelf;
#[cfg(target_arch = "wasm32")]
use storage::Shelf;

/// How long after a change a scene is kept aside, and at most how often, seconds.
pub const EVERY_SECS: f64 = 3.0;

/// What the first line of a kept scene is.
const HEAD: &str = "# kept by posekit, since it was not saved";

/// A scene that was kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// What the clip was called.
    pub name: String,
    /// Where its own file is, if it had one.
    pub path: Option<std::path::PathBuf>,
    /// The scene's text; files are named by where they are.
    text: String,
    /// Under which key it lies.
    key: String,
    /// Where the page's server has files that it names.
    #[cfg(target_arch = "wasm32")]
    pub addresses: Vec<std::path::PathBuf>,
}

impl Kept {
    /// What a scene is kept as; `None` for one that could not be opened again.
    fn text_of(name: &str, authored: &Authored) -> Option<String> {
        let path = authored.path().and_then(|path| path.to_str());
        let bytes = scene::write(authored.scene()).ok()?;
        let text = String::from_utf8_lossy(&bytes);
        // Names of files may hold a line's end; there it would end the comment.
        let flat = |text: &str| text.replace(['\n', '\r'], " ");
        Some(format!(
            "{HEAD}\n# name: {}\n# path: {}\n{text}",
            flat(name),
            flat(path.unwrap_or_default())
        ))
    }

    fn read(key: String, kept: &str) -> Option<Self> {
        let mut lines = kept.splitn(4, '\n');
        let head = lines.next()?;
        let name = lines.next()?.strip_prefix("# name: ")?;
        let path = lines.next()?.strip_prefix("# path: ")?;
        let text = lines.next()?;
        (head == HEAD).then(|| Self {
            name: name.to_owned(),
            path: (!path.is_empty()).then(|| path.into()),
            text: text.to_owned(),
            key,
            #[cfg(target_arch = "wasm32")]
            addresses: Vec::new(),
        })
    }

    /// The files that it names.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn files(&self) -> Vec<String> {
        let read = scene::read(self.text.as_bytes());
        read.map_or_else(
            |_| Vec::new(),
            |scene| scene.files().into_iter().map(str::to_owned).collect(),
        )
    }

    /// It as the file that it was not saved as.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn parcel(&self) -> crate::work::files::Parcel {
        crate::work::files::Parcel {
            name: self.name.clone(),
            kind: "posekit scene",
            extension: "toml",
            bytes: self.text.as_bytes().into(),
        }
    }

    /// The clip and its keys, which are in no file yet.
    ///
    /// # Errors
    /// What is wrong, for people: a file that the scene names may be gone.
    pub fn open(
        &self,
        bytes_of: impl Fn(&str) -> Result<Vec<u8>, String>,
    ) -> Result<ReadScene, String> {
        let read = scene::read(self.text.as_bytes()).map_err(|error| error.in_file(&self.name))?;
        let (mut authored, report) = authored_of(&self.name, read, bytes_of)?;
        authored.set_path(self.path.clone());
        let mut clip = Clip::from_motion(self.name.as_str(), authored.bake());
        clip.source = Source::Scene(self.path.clone());
        clip.report = report;
        Ok((clip, authored))
    }
}

/// Keeps unsaved scenes.
#[derive(Debug)]
pub struct Autosave {
    shelf: Option<Shelf>,
    /// What is kept of each scene: its revision, and under which key.
    kept: BTreeMap<ClipId, (u64, String)>,
    /// Earliest time of the next look, by the window's clock.
    due_secs: f64,
}

impl Autosave {
    /// Keeps nothing: for tests, and where there is no place to keep things.
    #[must_use]
    pub fn none() -> Self {
        Self::on(None)
    }

    fn on(shelf: Option<Shelf>) -> Self {
        Self {
            shelf,
            kept: BTreeMap::new(),
            due_secs: 0.0,
        }
    }

    /// Keeps scenes in a folder, which is made where there is none.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn in_folder(folder: &std::path::Path) -> Self {
        Self::on(Shelf::new(folder))
    }

    /// Keeps scenes in the browser's local storage.
    #[cfg(target_arch = "wasm32")]
    #[must_use]
    pub fn in_storage() -> Self {
        Self::on(Shelf::new())
    }

    /// What runs of the program have left that are gone.
    #[must_use]
    pub fn left(&self) -> Vec<Kept> {
        let left = self.shelf.as_ref().map_or_else(Vec::new, Shelf::left);
        left.into_iter()
            .filter_map(|(key, text)| Kept::read(key, &text))
            .collect()
    }

    /// What was left is open again as a clip: from now on it is kept as that.
    pub fn adopt(&mut self, kept: &Kept, session: &Session, id: ClipId) {
        if let Some(authored) = session.authored_of(id) {
            self.keep(id, &kept.name, authored);
            self.discard(kept);
        }
    }

    /// Forgets what was left: it is not wanted.
    pub fn discard(&self, kept: &Kept) {
        if let Some(shelf) = &self.shelf {
            shelf.remove(&kept.key);
        }
    }

    /// Keeps what has changed, at most every few seconds. How long until it should look again, if there
    /// is something to keep.
    pub fn tick(&mut self, session: &Session, now_secs: f64) -> Option<f64> {
        let is_kept = |kept: &BTreeMap<ClipId, (u64, String)>, id, authored: &Authored| {
            kept.get(&id).map(|(revision, _)| *revision) == Some(authored.revision())
        };
        let scenes: Vec<(ClipId, &str, &Authored)> = session
            .clips()
            .iter()
            .filter_map(|open| {
                let authored = session.authored_of(open.id)?;
                Some((open.id, open.clip.name.as_str(), authored))
            })
            .collect();
        // What was saved, or closed, is not to be offered again.
        let dirty = |id: &ClipId| scenes.iter().any(|(open, _, a)| open == id && a.is_dirty());
        let over: Vec<ClipId> = self.kept.keys().copied().filter(|id| !dirty(id)).collect();
        for id in over {
            if let (Some((_, key)), Some(shelf)) = (self.kept.remove(&id), &self.shelf) {
                shelf.remove(&key);
            }
        }
        let waiting = scenes
            .iter()
            .any(|(id, _, authored)| authored.is_dirty() && !is_kept(&self.kept, *id, authored));
        if !waiting || self.shelf.is_none() {
            self.due_secs = now_secs + EVERY_SECS;
            return None;
        }
        if now_secs < self.due_secs {
            return Some(self.due_secs - now_secs);
        }
        for (id, name, authored) in scenes {
            if authored.is_dirty() && !is_kept(&self.kept, id, authored) {
                self.keep(id, name, authored);
            }
        }
        self.due_secs = now_secs + EVERY_SECS;
        None
    }

    /// Keeps a scene now. Where it cannot be written nothing is lost but the safety.
    fn keep(&mut self, id: ClipId, name: &str, authored: &Authored) {
        let Some(shelf) = &self.shelf else {
            return;
        };
        let key = match self.kept.get(&id) {
            Some((_, key)) => key.clone(),
            None => shelf.new_key(),
        };
        // It counts as kept where it cannot be: a full disk is not tried at every picture.
        if let Some(text) = Kept::text_of(name, authored) {
            shelf.write(&key, &text);
        }
        self.kept.insert(id, (authored.revision(), key));
    }
}

impl Drop for Autosave {
    /// Whoever leaves without saving was asked. A program that falls over leaves what it has kept.
    fn drop(&mut self) {
        #[cfg(not(target_arch = "wasm32"))]
        if std::thread::panicking() {
            return;
        }
        if let Some(shelf) = &self.shelf {
            for (_, key) in self.kept.values() {
                shelf.remove(key);
            }
            shelf.leave();
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod folder {
    use std::cell::Cell;
    use std::fs::{self, File};
    use std::io::Write as _;
    use std::path::{Path, PathBuf};
    use std::time::{SystemTime, UNIX_EPOCH};

    use crate::work::files::write_beside;

    const LOCK: &str = "lock";
    const KEPT: &str = "posekit.toml";

    /// The folder of what is kept, seen by one run of the program.
    #[derive(Debug)]
    pub(super) struct Shelf {
        folder: PathBuf,
        /// What files of this run start with.
        run: String,
        /// Held as long as this run lasts.
        _lock: File,
        count: Cell<u32>,
    }

    impl Shelf {
        pub(super) fn new(folder: &Path) -> Option<Self> {
            fs::create_dir_all(folder).ok()?;
            let now = SystemTime::now().duration_since(UNIX_EPOCH);
            let nanos = now.map_or(0, |since| since.as_nanos());
            let run = format!("{}-{nanos}", std::process::id());
            let lock = File::create(folder.join(format!("{run}.{LOCK}"))).ok()?;
            lock.try_lock().ok()?;
            Some(Self {
                folder: folder.to_owned(),
                run,
                _lock: lock,
                count: Cell::new(0),
            })
        }

        pub(super) fn new_key(&self) -> String {
            let count = self.count.get() + 1;
            self.count.set(count);
            format!("{}_{count}.{KEPT}", self.run)
        }

        pub(super) fn write(&self, key: &str, text: &str) {
            let path = self.folder.join(key);
            let written: std::io::Result<()> =
                write_beside(&path, |file| file.write_all(text.as_bytes()));
            drop(written);
        }

        pub(super) fn remove(&self, key: &str) {
            drop(fs::remove_file(self.folder.join(key)));
            // The lock of a run that is gone goes with the last of what it has left.
            if let Some(run) = run_of(key).filter(|run| *run != self.run)
                && !self.files().iter().any(|file| run_of(file) == Some(run))
            {
                drop(fs::remove_file(self.folder.join(format!("{run}.{LOCK}"))));
            }
        }

        /// This run is over, and has left nothing.
        pub(super) fn leave(&self) {
            drop(fs::remove_file(
                self.folder.join(format!("{}.{LOCK}", self.run)),
            ));
        }

        /// What lies there of runs that are gone: keys and texts, oldest first.
        pub(super) fn left(&self) -> Vec<(String, String)> {
            let mut files = self.files();
            files.sort();
            let gone = files
                .into_iter()
                .filter(|key| run_of(key).is_some_and(|run| run != self.run && self.is_gone(run)));
            let read = |key: String| {
                let text = fs::read_to_string(self.folder.join(&key)).ok()?;
                Some((key, text))
            };
            gone.filter_map(read).collect()
        }

        /// Whether nobody holds a run's lock.
        fn is_gone(&self, run: &str) -> bool {
            let path = self.folder.join(format!("{run}.{LOCK}"));
            match File::open(path) {
                Ok(lock) => lock.try_lock().is_ok(),
                Err(_no_lock) => true,
            }
        }

        fn files(&self) -> Vec<String> {
            let listing = fs::read_dir(&self.folder).into_iter().flatten().flatten();
            let names = listing.filter_map(|item| item.file_name().into_string().ok());
            names
                .filter(|name| name.ends_with(&format!(".{KEPT}")))
                .collect()
        }
    }

    fn run_of(key: &str) -> Option<&str> {
        key.split_once('_').map(|(run, _)| run)
    }
}

#[cfg(target_arch = "wasm32")]
mod storage {
    use std::cell::Cell;

    use web_sys::Storage;

    use crate::web::Runs;

    /// What keys start with.
    const PREFIX: &str = "posekit kept ";

    /// The browser's local storage, seen by one page. What lies there of others was left by them, unless they are
    /// still there in another tab.
    #[derive(Debug)]
    pub(super) struct Shelf {
        storage: Storage,
        /// What keys of this page start with, without the prefix.
        run: String,
        /// The same of pages in other tabs.
        others: Vec<String>,
        count: Cell<u32>,
    }

    impl Shelf {
        pub(super) fn new() -> Option<Self> {
            let storage = web_sys::window()?.local_storage().ok()??;
            let Runs { own, others } = crate::web::runs();
            Some(Self {
                storage,
                run: own,
                others,
                count: Cell::new(0),
            })
        }

        pub(super) fn new_key(&self) -> String {
            let count = self.count.get() + 1;
            self.count.set(count);
            format!("{PREFIX}{}_{count}", self.run)
        }

        pub(super) fn write(&self, key: &str, text: &str) {
            // Where the storage is full or refused there is no safety, and nothing else is lost.
            drop(self.storage.set_item(key, text));
        }

        pub(super) fn remove(&self, key: &str) {
            drop(self.storage.remove_item(key));
        }

        pub(super) fn leave(&self) {}

        pub(super) fn left(&self) -> Vec<(String, String)> {
            let count = self.storage.length().unwrap_or(0);
            let keys = (0..count).filter_map(|index| self.storage.key(index).ok().flatten());
            let is_of = |key: &str, run: &str| {
                let rest = key.strip_prefix(run);
                rest.is_some_and(|rest| rest.starts_with('_'))
            };
            let is_left = |key: &String| {
                let key = key.strip_prefix(PREFIX);
                key.is_some_and(|key| {
                    !is_of(key, &self.run) && !self.others.iter().any(|run| is_of(key, run))
                })
            };
            let theirs = keys.filter(is_left);
            let read = |key: String| {
                let text = self.storage.get_item(&key).ok().flatten()?;
                Some((key, text))
            };
            theirs.filter_map(read).collect()
        }
    }
}
