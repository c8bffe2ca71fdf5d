//! What a command reads is not overwritten by what it writes, and no two results go to one place.
//!
//! A [`Guard`] knows every file that the command reads: all reading goes through it. What is written goes to a
//! [`Target`], which only the guard gives out. Files are told apart by what they are (on Unix device and inode),
//! not by how they are spelled: other ways to a folder, links and, where the system has them, hard links and names
//! in another case lead to the same file. A file that does not exist yet is known by its folder and its name.
//!
//! Devices and pipes are nobody's data and go free.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::failure::Failure;

/// More links than this, one leading to the next, are a circle; Linux gives up at the same number.
const MOST_LINKS: usize = 40;

/// The files of one command. Clones are of the same one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Guard(Arc<Mutex<Ledger>>);

/// What is read and written, each by the name that the user or a file gave it.
#[derive(Debug, Default)]
struct Ledger {
    /// What was read or will be.
    read: BTreeMap<FileId, String>,
    /// What will be written: what it is, and its name.
    claimed: BTreeMap<Place, (String, PathBuf)>,
    /// What has been written.
    written: BTreeMap<FileId, PathBuf>,
}

/// A place that may be written.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    /// As the user named it.
    path: PathBuf,
    /// Where it lies, links followed.
    real: PathBuf,
    guard: Guard,
}

impl Guard {
    /// Notes that a file is read.
    ///
    /// Fails where the command has promised its place to a result.
    pub(crate) fn reads(&self, path: &Path) -> Result<(), Failure> {
        // A file that is not there fails when it is read, with the system's own reason.
        match fs::metadata(path) {
            Ok(meta) => self.reads_as(&path.display().to_string(), path, &meta),
            Err(_) => Ok(()),
        }
    }

    /// Notes that an open file is read, standard input perhaps: `name` is what messages call it, and `path` where
    /// it lies.
    pub(crate) fn reads_as(&self, name: &str, path: &Path, meta: &Metadata) -> Result<(), Failure> {
        let Some(id) = FileId::of(path, meta) else {
            return Ok(());
        };
        let mut ledger = self.lock();
        let claim = ledger.claimed.get(&Place::File(id.clone()));
        let taken = claim.map(|(_, path)| path).or(ledger.written.get(&id));
        if let Some(path) = taken {
            return Err(overwritten(path, name));
        }
        ledger.read.entry(id).or_insert_with(|| name.to_owned());
        Ok(())
    }

    /// The place of a result. `of` says what is written there.
    ///
    /// Fails where something lies there that the command reads or that is write-protected, and where another result
    /// goes.
    pub(crate) fn target(&self, path: &Path, of: &str) -> Result<Target, Failure> {
        let target = self.unclaimed(path)?;
        let Some(place) = Place::of(&target.real) else {
            return Ok(target);
        };
        let mut ledger = self.lock();
        if let Some((other, at)) = ledger.claimed.get(&place) {
            let (at, path) = (at.display(), path.display());
            let place = match at.to_string() == path.to_string() {
                true => path.to_string(),
                false => format!("{path}, which is the same file as {at}"),
            };
            let what = format!("{other} and {of} would both be written to {place}");
            return Err(Failure::usage(what).try_next("give each its own name"));
        }
        let claim = (of.to_owned(), path.to_owned());
        ledger.claimed.insert(place, claim);
        drop(ledger);
        Ok(target)
    }

    /// As [`target`](Self::target), without keeping the place for itself: of results whose names, counted through,
    /// cannot be the same.
    fn unclaimed(&self, path: &Path) -> Result<Target, Failure> {
        let target = Target {
            path: path.to_owned(),
            real: real_place(path),
            guard: self.clone(),
        };
        target.refuse_known()?;
        refuse_protected(&target)?;
        Ok(target)
    }

    /// Whether standard output is a file that is read.
    pub(crate) fn refuse_stdout(&self) -> Result<(), Failure> {
        let Some(id) = stdout_meta().and_then(|meta| FileId::of(Path::new("/dev/stdout"), &meta))
        else {
            return Ok(());
        };
        match self.lock().read.get(&id) {
            Some(read) => Err(overwritten(Path::new("standard output"), read)),
            None => Ok(()),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Ledger> {
        // Nothing that could panic is done with the lock held.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Target {
    /// The name that the user gave it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The same for messages.
    pub(crate) fn display(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// One of several files that stand for this one, as numbered pictures do.
    pub(crate) fn one_of(&self, path: &Path) -> Result<Self, Failure> {
        self.guard.unclaimed(path)
    }

    /// Where it lies, links followed.
    pub(super) fn real(&self) -> &Path {
        &self.real
    }

    /// Fails where what lies in its place now is read by the command, or is another result of it: two names may
    /// turn out to be one when the first is written, as where a file system does not tell `A` from `a`.
    pub(super) fn refuse_known(&self) -> Result<(), Failure> {
        let Some(id) = FileId::at(&self.real) else {
            return Ok(());
        };
        let ledger = self.guard.lock();
        if let Some(read) = ledger.read.get(&id) {
            return Err(overwritten(&self.path, read));
        }
        match ledger.written.get(&id) {
            Some(other) if *other != self.path => {
                let (other, this) = (other.display(), self.path.display());
                let what = format!("{this} is the same file as {other}, which was just written");
                Err(Failure::usage(what).try_next("give each result its own name"))
            }
            _ => Ok(()),
        }
    }

    /// Notes that it is written.
    pub(super) fn is_written(&self) {
        if let Some(id) = FileId::at(&self.real) {
            self.guard.lock().written.insert(id, self.path.clone());
        }
    }
}

fn overwritten(output: &Path, read: &str) -> Failure {
    let output = output.display().to_string();
    let what = match output == read {
        true => format!("{output} is an input and would be overwritten"),
        false => {
            format!("{output} is the same file as {read}, an input, which would be overwritten")
        }
    };
    Failure::usage(what).try_next("choose another output")
}

/// A file that its owner has protected is not replaced, though its folder would allow that.
fn refuse_protected(target: &Target) -> Result<(), Failure> {
    let is_protected = fs::metadata(&target.real).is_ok_and(|meta| {
        let denied = || {
            let opened = File::options().write(true).open(&target.real);
            opened.is_err_and(|error| {
                use io::ErrorKind::{PermissionDenied, ReadOnlyFilesystem};
                matches!(error.kind(), PermissionDenied | ReadOnlyFilesystem)
            })
        };
        meta.is_file() && (meta.permissions().readonly() || denied())
    });
    if !is_protected {
        return Ok(());
    }
    let name = target.path.display();
    Err(Failure::new(format!("{name}: is write-protected"))
        .try_next("choose another output, or allow writing to it"))
}

/// Where a file is or will be, links followed, also those that lead to nothing yet.
fn real_place(path: &Path) -> PathBuf {
    if let Ok(real) = fs::canonicalize(path) {
        return real;
    }
    let mut links = 0;
    // What is left to go, the next step last.
    let mut steps: Vec<PathBuf> = steps_of(path);
    let mut real = PathBuf::new();
    if !path.is_absolute() {
        real = fs::canonicalize(".").unwrap_or_default();
    }
    while let Some(step) = steps.pop() {
        match step.components().next() {
            Some(Component::ParentDir) => {
                // Of what does not exist, too: the folder would be made, and is as good as there.
                real.pop();
            }
            Some(Component::Normal(_)) => {
                let next = real.join(&step);
                match fs::read_link(&next) {
                    Ok(leads_to) if links < MOST_LINKS => {
                        links += 1;
                        if leads_to.is_absolute() {
                            real = PathBuf::new();
                        }
                        steps.append(&mut steps_of(&leads_to));
                    }
                    _ => real = next,
                }
            }
            Some(Component::CurDir) | None => {}
            Some(Component::Prefix(_) | Component::RootDir) => real.push(&step),
        }
    }
    real
}

/// The components of a path, the last first.
fn steps_of(path: &Path) -> Vec<PathBuf> {
    let steps = path.components().rev();
    steps.map(|step| PathBuf::from(step.as_os_str())).collect()
}

/// Where something is written.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// In place of a file.
    File(FileId),
    /// Below a folder that exists.
    New {
        /// The folder.
        folder: FileId,
        /// What is new below it.
        below: PathBuf,
    },
}

impl Place {
    /// Of a path without links; `None` for what is no file.
    fn of(real: &Path) -> Option<Self> {
        if let Ok(meta) = fs::metadata(real) {
            return FileId::of(real, &meta).map(Self::File);
        }
        let (folder, meta) = real
            .ancestors()
            .skip(1)
            .find_map(|folder| Some((folder, fs::metadata(folder).ok()?)))?;
        Some(Self::New {
            folder: FileId::of_any(folder, &meta),
            below: real.strip_prefix(folder).unwrap_or(real).to_owned(),
        })
    }
}

/// What makes a file the same as another, whatever its names.
#[cfg(unix)]
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct FileId {
    device: u64,
    inode: u64,
}

/// What makes a file the same as another: the name that the system itself has for it. Hard links have several.
#[cfg(not(unix))]
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct FileId(PathBuf);

impl FileId {
    /// Of a file, and of nothing else.
    fn of(path: &Path, meta: &Metadata) -> Option<Self> {
        meta.is_file().then(|| Self::of_any(path, meta))
    }

    /// Of what lies there now.
    fn at(path: &Path) -> Option<Self> {
        Self::of(path, &fs::metadata(path).ok()?)
    }

    #[cfg(unix)]
    fn of_any(_: &Path, meta: &Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self {
            device: meta.dev(),
            inode: meta.ino(),
        }
    }

    #[cfg(not(unix))]
    fn of_any(path: &Path, _: &Metadata) -> Self {
        Self(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()))
    }
}

#[cfg(unix)]
fn stdout_meta() -> Option<Metadata> {
    use std::os::fd::AsFd;
    let stdout = io::stdout().as_fd().try_clone_to_owned().ok()?;
    File::from(stdout).metadata().ok()
}

/// Where the system does not say what a standard stream is, it is taken for a pipe.
#[cfg(not(unix))]
fn stdout_meta() -> Option<Metadata> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(folder.path().join("in.bvh"), "motion").unwrap();
        folder
    }

    fn refusal(result: Result<impl Sized, Failure>) -> String {
        result.err().map_or_else(String::new, |it| it.to_string())
    }

    #[test]
    fn a_file_that_is_read_is_refused_under_all_its_names_and_in_either_order() {
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        let mut names = vec!["in.bvh", "./in.bvh", "sub/../in.bvh", "nosuch/../in.bvh"];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("in.bvh", at("link.bvh")).unwrap();
            std::os::unix::fs::symlink("../in.bvh", at("sub/link.bvh")).unwrap();
            std::os::unix::fs::symlink("sub", at("subs")).unwrap();
            fs::hard_link(at("in.bvh"), at("hard.bvh")).unwrap();
            names.extend([
                "link.bvh",
                "sub/link.bvh",
                "subs/link.bvh",
                "subs/../in.bvh",
                "hard.bvh",
                "no/such/../../subs/../in.bvh",
            ]);
        }
        for name in names {
            let guard = Guard::default();
            guard.reads(&at("in.bvh")).unwrap();
            let error = refusal(guard.target(&at(name), "the result"));
            assert!(
                error.contains("in.bvh") && error.contains("overwritten"),
                "{name}: {error}"
            );
            let guard = Guard::default();
            guard.target(&at(name), "the result").unwrap();
            let error = refusal(guard.reads(&at("in.bvh")));
            assert!(
                error.contains("in.bvh") && error.contains("overwritten"),
                "{name}: {error}"
            );
        }
        let guard = Guard::default();
        guard.reads(&at("in.bvh")).unwrap();
        for name in ["out.bvh", "sub/in.bvh", "nosuch/in.bvh"] {
            assert_eq!(refusal(guard.target(&at(name), "the result")), "", "{name}");
        }
    }

    #[test]
    fn two_results_in_one_place_are_refused_whether_or_not_there_is_a_file() {
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old.csv"), "").unwrap();
        let mut pairs = vec![
            ("new.csv", "sub/../new.csv"),
            ("deep/new.csv", "deep/er/../new.csv"),
            ("old.csv", "nosuch/../old.csv"),
        ];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("sub/later.csv", at("dangling.csv")).unwrap();
            std::os::unix::fs::symlink("old.csv", at("link.csv")).unwrap();
            pairs.extend([("sub/later.csv", "dangling.csv"), ("link.csv", "old.csv")]);
        }
        for (first, second) in pairs {
            let guard = Guard::default();
            guard.target(&at(first), "the motion").unwrap();
            let error = refusal(guard.target(&at(second), "the trace"));
            assert!(
                error.contains("the motion and the trace"),
                "{first} {second}: {error}"
            );
        }
    }

    #[test]
    fn a_protected_file_is_refused_and_stays() {
        let folder = folder();
        let path = folder.path().join("in.bvh");
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = refusal(Guard::default().target(&path, "the result"));
        assert!(error.contains("write-protected"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn devices_go_free_and_circles_of_links_end() {
        let guard = Guard::default();
        let null = Path::new("/dev/null");
        guard.reads(null).unwrap();
        guard.target(null, "the motion").unwrap();
        guard.target(null, "the trace").unwrap();
        let folder = folder();
        let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink(&b, &a).unwrap();
        std::os::unix::fs::symlink(&a, &b).unwrap();
        assert!(real_place(&a).starts_with(folder.path().canonicalize().unwrap()));
    }
}
