//! The one door to what files hold. Everything that is read is made known to the command's guard, and read up to a
//! bound: a device has no end, and a file may be larger than the memory.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;

use crate::failure::Failure;
use crate::output::Guard;
use posekit_formats::memory::prefer_large_pages;

/// The most that is read of a file: an hour of a hundred joints at 120 frames a second, in text, is less than half
/// of it.
const MOST_OF_A_FILE: u64 = 4 << 30;
/// The most that is read of a pipe or a device, whose size nobody knows beforehand.
const MOST_OF_A_STREAM: u64 = 1 << 30;

/// The bytes of a file.
pub(crate) fn of_file(path: &Path, guard: &Guard) -> Result<Vec<u8>, Failure> {
    let cannot = |error: io::Error| Failure::cannot_read(path, &error);
    let file = File::open(path).map_err(cannot)?;
    let meta = file.metadata().map_err(cannot)?;
    let name = path.display().to_string();
    guard.reads_as(&name, path, &meta)?;
    read(&file, Some(&meta), path)
}

/// All of standard input.
pub(crate) fn of_stdin(guard: &Guard) -> Result<Vec<u8>, Failure> {
    let name = "standard input";
    let meta = stdin_meta();
    if let Some(meta) = &meta {
        guard.reads_as(name, Path::new("/dev/stdin"), meta)?;
    }
    read(io::stdin().lock(), meta.as_ref(), Path::new(name))
}

/// What standard input is, where the system says it.
#[cfg(unix)]
fn stdin_meta() -> Option<Metadata> {
    use std::os::fd::AsFd;
    let stdin = io::stdin().as_fd().try_clone_to_owned().ok()?;
    File::from(stdin).metadata().ok()
}

#[cfg(not(unix))]
fn stdin_meta() -> Option<Metadata> {
    None
}

fn read(from: impl Read, meta: Option<&Metadata>, path: &Path) -> Result<Vec<u8>, Failure> {
    let length = meta.filter(|meta| meta.is_file()).map(Metadata::len);
    let most = length.map_or(MOST_OF_A_STREAM, |_| MOST_OF_A_FILE);
    let bytes = match length.is_some_and(|length| length > most) {
        true => None,
        false => {
            read_up_to(from, length, most).map_err(|error| Failure::cannot_read(path, &error))?
        }
    };
    bytes.ok_or_else(|| {
        let (name, most) = (path.display(), most >> 30);
        match length {
            Some(_) => Failure::new(format!(
                "{name}: is larger than {most} GiB, the most that posekit reads from one file"
            ))
            .try_next("split it into parts"),
            None => Failure::new(format!(
                "{name}: no end after {most} GiB, the most that posekit reads from a pipe or a device"
            ))
            .try_next("save it as a file first"),
        }
    })
}

/// All that comes; `None` where that is more than `most`.
fn read_up_to(from: impl Read, length: Option<u64>, most: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    let expected = length.and_then(|length| usize::try_from(length).ok());
    bytes.try_reserve_exact(expected.unwrap_or(0))?;
    prefer_large_pages(&mut bytes);
    from.take(most + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_is_read_than_the_bound() {
        let five = || &b"12345"[..];
        assert_eq!(read_up_to(five(), Some(5), 5).unwrap().unwrap(), b"12345");
        assert_eq!(read_up_to(five(), None, 4).unwrap(), None);
        assert_eq!(read_up_to(io::repeat(0), None, 1 << 16).unwrap(), None);
    }
}
