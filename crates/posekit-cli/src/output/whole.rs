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

/// Writes `path` by `write`, so that it appears complete or not at all; makes its folder if need be.
///
/// A symbolic link is followed and stays a link. A device or a pipe is written directly.
pub(crate) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> Result<(), Failure> {
    write_whole_io(path, write).map_err(|error| Failure::cannot_write(path, &error))
}

fn write_whole_io(
    path: &Path,
    write: impl FnOnce(&mut WholeFile) -> io::Result<()>,
) -> io::Result<()> {
    // The file behind a link, when there is one already.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&target) {
        Ok(meta) if meta.is_dir() => {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a folder"));
        }
        Ok(meta) if !meta.is_file() => {
            let file = File::options().write(true).open(&target)?;
            let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, file);
            write(&mut buffered)?;
            return buffered.flush();
        }
        _ => {}
    }
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(folder)?;
    let unfinished_file = create_beside(folder, &target)?;
    let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, unfinished_file.file.try_clone()?);
    write(&mut buffered)?;
    buffered.flush()?;
    drop(buffered);
    unfinished_file.rename_to(&target)
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
    use super::*;

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
        let result = write_whole(&path, |file| {
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
            write_whole(&path, |file| file.write_all(text.as_bytes())).unwrap();
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
        write_whole(&link, |file| file.write_all(b"new")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(
            fs::metadata(&real).unwrap().permissions().mode() & 0o777,
            0o640
        );
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_and_not_replaced() {
        write_whole(Path::new("/dev/null"), |file| file.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
