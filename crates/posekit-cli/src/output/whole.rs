//! Files that are either the old one or the new one, never a part of either.
//!
//! A file is written under a temporary name in its own folder and renamed into place when it is
//! complete. A failure removes the temporary file; so does an interrupt (^C, a termination signal, a
//! closed terminal), which [`remove_unfinished_on_interrupt`] arranges.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::Builder;

use super::guard::Target;
use crate::failure::Failure;

/// Large enough that the cost of a system call does not show.
const BUFFER_BYTES: usize = 1 << 18;

/// What a shell reports for a program that ^C ended: 128 and the number of the signal.
const EXIT_INTERRUPTED: i32 = 130;

/// The exit code of an interrupted process.
static EXIT_ON_INTERRUPT: AtomicI32 = AtomicI32::new(EXIT_INTERRUPTED);

/// The temporary files that exist now. Creating, renaming and removing one happens with this lock
/// held, so that an interrupt sees every file or none.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on an interrupt removes the files that are half written before it ends the process.
pub(crate) fn remove_unfinished_on_interrupt() {
    let handler = || {
        // Held until the process is gone: no new temporary file can appear after the sweep.
        let files = unfinished();
        for path in files.iter() {
            let _ = fs::remove_file(path);
        }
        std::process::exit(EXIT_ON_INTERRUPT.load(Ordering::SeqCst));
    };
    // Where no handler can be set, the default one ends the process and leaves old files whole all
    // the same; only a temporary file may stay behind.
    let _ = ctrlc::set_handler(handler);
}

/// From here on an interrupt is the ordinary end of the process, as of a server's.
pub(crate) fn interrupt_is_no_failure() {
    EXIT_ON_INTERRUPT.store(0, Ordering::SeqCst);
}

/// A file that can be written and sought, as archive formats need.
pub(crate) type WholeFile = BufWriter<File>;

/// Writes `target` by `write`, so that it appears complete or not at all; makes its folder if need be.
///
/// A symbolic link is followed and stays a link. A device or a pipe is written directly.
pub(crate) fn write_whole(
    target: &Target,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> Result<(), Failure> {
    let cannot = |error: io::Error| Failure::cannot_write(target.path(), &error);
    let real = target.real();
    match fs::metadata(real) {
        Ok(meta) if meta.is_dir() => {
            return Err(cannot(io::Error::from(io::ErrorKind::IsADirectory)));
        }
        Ok(meta) if !meta.is_file() => return write_through(real, write).map_err(cannot),
        _ => {}
    }
    let unfinished_file = write_beside(real, write).map_err(cannot)?;
    target.refuse_known()?;
    unfinished_file.rename_to(real).map_err(cannot)?;
    target.is_written();
    Ok(())
}

/// Writes what is no file: a device or a pipe.
fn write_through(
    path: &Path,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> io::Result<()> {
    let file = File::options().write(true).open(path)?;
    let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, file);
    write(&mut buffered)?;
    buffered.flush()
}

/// Writes a temporary file in the folder of `real`.
fn write_beside(
    real: &Path,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> io::Result<Unfinished> {
    let folder = match real.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder)?;
    let unfinished_file = create_beside(folder, real)?;
    let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, unfinished_file.file.try_clone()?);
    write(&mut buffered)?;
    buffered.flush()?;
    Ok(unfinished_file)
}

/// A temporary file that is removed unless it is renamed into place.
struct Unfinished {
    file: File,
    path: PathBuf,
}

fn create_beside(folder: &Path, target: &Path) -> io::Result<Unfinished> {
    let mut builder = Builder::new();
    builder.prefix(".posekit-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any other new file (the process's mask applies), not private as temporary files are.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut files = unfinished();
    let (file, path) = builder
        .tempfile_in(folder)?
        .keep()
        .map_err(|kept| kept.error)?;
    files.insert(path.clone());
    drop(files);
    let unfinished_file = Unfinished { file, path };
    if let Ok(old) = fs::metadata(target) {
        // A file that is replaced keeps its permissions; where they cannot be set, the new file
        // has the usual ones.
        let _ = unfinished_file.file.set_permissions(old.permissions());
    }
    Ok(unfinished_file)
}

impl Unfinished {
    fn rename_to(self, target: &Path) -> io::Result<()> {
        let mut files = unfinished();
        fs::rename(&self.path, target)?;
        files.remove(&self.path);
        drop(files);
        Ok(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut files = unfinished();
        if files.remove(&self.path) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::guard::Guard;
    use super::*;

    /// The place of a result of a command of its own.
    fn target(path: &Path) -> Target {
        Guard::default().target(path, "the result").unwrap()
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let result = write_whole(&target(&path), |file| {
            file.write_all(&[b'x'; 1 << 20])?;
            Err(io::Error::other("broke"))
        });
        assert!(result.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_new_file_replaces_the_old_one_and_makes_its_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/a.txt");
        for text in ["one", "two"] {
            write_whole(&target(&path), |file| file.write_all(text.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names(path.parent().unwrap()), ["a.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let real = folder.path().join("real.txt");
        let link = folder.path().join("link.txt");
        fs::write(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_whole(&target(&link), |file| file.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(
            fs::metadata(&real).unwrap().permissions().mode() & 0o777,
            0o640
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_what_is_not_there_yet_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link.txt");
        std::os::unix::fs::symlink("later/real.txt", &link).unwrap();
        write_whole(&target(&link), |file| file.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let real = folder.path().join("later/real.txt");
        assert_eq!(fs::read_to_string(real).unwrap(), "new");
    }

    #[test]
    fn a_name_that_turns_out_to_be_another_ones_is_refused_when_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["A.txt", "a.txt"].map(|name| folder.path().join(name));
        let guard = Guard::default();
        let [one, two] = [&first, &second].map(|path| guard.target(path, "a result").unwrap());
        write_whole(&one, |file| file.write_all(b"one")).unwrap();
        // As on a file system that does not tell them apart.
        if !second.exists() {
            fs::hard_link(&first, &second).unwrap();
        }
        let error = write_whole(&two, |file| file.write_all(b"two")).unwrap_err();
        assert!(error.to_string().contains("A.txt"), "{error}");
        assert_eq!(fs::read_to_string(&first).unwrap(), "one");
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_and_not_replaced() {
        write_whole(&target(Path::new("/dev/null")), |file| {
            file.write_all(b"gone")
        })
        .unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
