//! NumPy's `.npz`: a zip archive of `.npy` arrays, opened by `numpy.load` without pickle.
//!
//! Formats: "NEP 1: A Simple File Format for NumPy Arrays" (Kern, 2007), version 1.0 of `.npy`, and
//! `numpy.lib.format`'s documentation. Arrays are little-endian in C order. The bytes depend on the
//! arrays alone: the archive carries no time of its making.

use std::fmt::{self, Write as _};
use std::io::{self, Seek, SeekFrom, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::arrays::MotionArrays;

/// How many bytes are gathered before they go to the archive: they stay in the second cache.
const CHUNK_BYTES: usize = 1 << 16;

/// The array data starts at a multiple of this, as NEP 1 asks for.
const NPY_ALIGNMENT: usize = 64;

/// Beyond this an entry needs the archive's 64-bit fields; with some room for the `.npy` header.
const ZIP32_BYTES: u64 = u32::MAX as u64 - (1 << 16);

/// Whether the archive's entries are compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compression {
    /// As they are: the fastest to write and to load, as `numpy.savez` does.
    #[default]
    Stored,
    /// Deflated, as `numpy.savez_compressed` does: about three quarters of the size for joint positions.
    Deflated,
}

/// Writes a motion in world space as an `.npz` archive.
///
/// With F frames, J joints and P points it holds
///
/// | array | shape | type | |
/// | --- | --- | --- | --- |
/// | `positions` | (F, J, 3) | float32 | in world space, in the file's unit |
/// | `orientations` | (F, J, 4) | float32 | unit quaternions x, y, z, w |
/// | `joint_names` | (J,) | str | told apart where the file gives two joints the same name |
/// | `parents` | (J,) | int32 | -1 at a root |
/// | `frame_time` | () | float64 | seconds between two frames of the motion |
/// | `frames` | (F,) | int64 | the frames' numbers in the motion, from 0 |
/// | `points` | (F, P, 3) | float32 | only with attached points, as the next two |
/// | `point_joints` | (P,) | str | the joints that carry them |
/// | `point_offsets` | (P, 3) | float32 | where they are in their joints' spaces |
///
/// # Errors
/// When `out` cannot be written, or a number is not finite.
///
/// # Panics
/// If a joint or a frame is not one of the motion's.
pub fn write<W: Write + Seek>(
    arrays: &MotionArrays<'_>,
    out: W,
    compression: Compression,
) -> io::Result<W> {
    let (f, j, p) = (
        arrays.frames.len(),
        arrays.joints.len(),
        arrays.points.len(),
    );
    let motion = arrays.motion;
    let mut archive = NpzWriter::new(out, compression);
    archive.array("positions", &[f, j, 3], |values| {
        for &frame in arrays.frames {
            for &joint in arrays.joints {
                values.write(&arrays.position(frame, joint)?)?;
            }
        }
        Ok(())
    })?;
    archive.array("orientations", &[f, j, 4], |values| {
        for &frame in arrays.frames {
            for &joint in arrays.joints {
                values.write(&arrays.orientation(frame, joint)?)?;
            }
        }
        Ok(())
    })?;
    archive.strings("joint_names", &arrays.joint_names())?;
    let parents: Vec<i32> = arrays.parents().into_iter().map(parent_number).collect();
    archive.array("parents", &[j], |values| values.write(&parents))?;
    archive.array("frame_time", &[], |values| {
        values.write(&[motion.frame_time_secs()])
    })?;
    archive.array("frames", &[f], |values| {
        arrays
            .numbers()
            .iter()
            .try_for_each(|&number| values.write(&[frame_number(number)]))
    })?;
    if p > 0 {
        archive.array("points", &[f, p, 3], |values| {
            for &frame in arrays.frames {
                for point in arrays.points {
                    values.write(&arrays.point(frame, point)?)?;
                }
            }
            Ok(())
        })?;
        let skeleton = motion.skeleton();
        let carriers: Vec<&str> = arrays
            .points
            .iter()
            .map(|point| skeleton.unique_name(point.joint))
            .collect();
        archive.strings("point_joints", &carriers)?;
        archive.array("point_offsets", &[p, 3], |values| {
            arrays
                .points
                .iter()
                .try_for_each(|point| values.write(&point.point_in_joint.to_array()))
        })?;
    }
    archive.finish()
}

fn parent_number(parent: Option<usize>) -> i32 {
    parent.map_or(-1, |index| i32::try_from(index).unwrap_or(i32::MAX))
}

fn frame_number(frame: usize) -> i64 {
    i64::try_from(frame).unwrap_or(i64::MAX)
}

/// An archive that arrays are added to one after the other.
///
/// [`write()`] makes the archive of a motion; this is for arrays of one's own.
#[derive(Debug)]
pub struct NpzWriter<W: Write + Seek> {
    archive: ZipWriter<Sink<W>>,
    compression: CompressionMethod,
    bytes: Vec<u8>,
}

impl<W: Write + Seek> NpzWriter<W> {
    /// An archive without arrays. `out` is best buffered.
    pub fn new(out: W, compression: Compression) -> Self {
        let compression = match compression {
            Compression::Stored => CompressionMethod::Stored,
            Compression::Deflated => CompressionMethod::Deflated,
        };
        Self {
            archive: ZipWriter::new(Sink::new(out)),
            compression,
            bytes: Vec::new(),
        }
    }

    /// Adds an array of this shape in C order; an empty shape is a single number. `fill` writes its
    /// numbers, in as many steps as it likes.
    ///
    /// # Errors
    /// When the archive cannot be written.
    ///
    /// # Panics
    /// If `fill` writes more or fewer numbers than the shape has.
    pub fn array<T: Number>(
        &mut self,
        name: &str,
        shape: &[usize],
        fill: impl FnOnce(&mut ValueWriter<'_, T>) -> io::Result<()>,
    ) -> io::Result<()> {
        let count: usize = shape.iter().product();
        self.start(name, T::DESCRIPTION, shape, count * T::BYTES)?;
        let mut values = ValueWriter {
            out: &mut self.archive,
            bytes: &mut self.bytes,
            written: 0,
            number: std::marker::PhantomData,
        };
        fill(&mut values)?;
        values.flush()?;
        assert_eq!(
            values.written, count,
            "numbers for the shape of array `{name}`"
        );
        Ok(())
    }

    /// Adds a one-dimensional array of text.
    ///
    /// # Errors
    /// When the archive cannot be written.
    pub fn strings(&mut self, name: &str, texts: &[&str]) -> io::Result<()> {
        // NumPy has no text of length 0: `<U0` is read as "any length".
        let longest = texts
            .iter()
            .map(|text| text.chars().count())
            .max()
            .unwrap_or(0)
            .max(1);
        self.start(
            name,
            &format!("<U{longest}"),
            &[texts.len()],
            texts.len() * longest * 4,
        )?;
        let mut padded = Vec::with_capacity(longest * 4);
        for text in texts {
            padded.clear();
            padded.extend(
                text.chars()
                    .flat_map(|letter| u32::from(letter).to_le_bytes()),
            );
            padded.resize(longest * 4, 0);
            self.archive.write_all(&padded)?;
        }
        Ok(())
    }

    /// Writes the archive's directory and gives the output back.
    ///
    /// # Errors
    /// When the archive cannot be written.
    pub fn finish(self) -> io::Result<W> {
        Ok(self.archive.finish()?.out)
    }

    fn start(
        &mut self,
        name: &str,
        description: &str,
        shape: &[usize],
        data_bytes: usize,
    ) -> io::Result<()> {
        let options = SimpleFileOptions::DEFAULT
            .compression_method(self.compression)
            .large_file(data_bytes as u64 > ZIP32_BYTES);
        self.archive.start_file(format!("{name}.npy"), options)?;
        self.archive.write_all(&npy_header(description, shape))
    }
}

/// The output of an archive. Once it could not be written it only pretends to be: whoever gave up on the archive
/// knows why, and an archive that is dropped unfinished tries to finish and says on standard error that it cannot.
#[derive(Debug)]
struct Sink<W> {
    out: W,
    position: u64,
    /// The farthest position there was: where a broken output always is, since no entry of the archive that is
    /// finished then may end before it began.
    farthest: u64,
    is_broken: bool,
}

impl<W> Sink<W> {
    fn new(out: W) -> Self {
        Self {
            out,
            position: 0,
            farthest: 0,
            is_broken: false,
        }
    }

    /// Passes a result on, and remembers that it was a failure.
    fn checked<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        // An interrupted call is made again.
        let is_failure = |error: &io::Error| error.kind() != io::ErrorKind::Interrupted;
        self.is_broken |= result.as_ref().is_err_and(is_failure);
        result
    }

    fn go_to(&mut self, position: u64) {
        self.position = position;
        self.farthest = self.farthest.max(position);
    }
}

impl<W: Write> Write for Sink<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.is_broken {
            return Ok(bytes.len());
        }
        let written = self.out.write(bytes);
        let written = self.checked(written)?;
        self.go_to(self.position + written as u64);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.is_broken {
            return Ok(());
        }
        let flushed = self.out.flush();
        self.checked(flushed)
    }
}

impl<W: Seek> Seek for Sink<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if self.is_broken {
            return Ok(self.farthest);
        }
        let sought = self.out.seek(to);
        let position = self.checked(sought)?;
        self.go_to(position);
        Ok(position)
    }
}

/// The header of a `.npy` file, version 1.0: magic, version, length, and a Python literal padded
/// with blanks to the alignment.
fn npy_header(description: &str, shape: &[usize]) -> Vec<u8> {
    const MAGIC_AND_VERSION: &[u8] = b"\x93NUMPY\x01\x00";
    let mut shape_text = String::new();
    for length in shape {
        // Writing to a string does not fail.
        let _ = write!(shape_text, "{length}, ");
    }
    let literal =
        format!("{{'descr': '{description}', 'fortran_order': False, 'shape': ({shape_text}), }}");
    // Two bytes of length before the literal, a newline after it.
    let unpadded = MAGIC_AND_VERSION.len() + 2 + literal.len() + 1;
    let padding = unpadded.next_multiple_of(NPY_ALIGNMENT) - unpadded;
    let length = u16::try_from(literal.len() + padding + 1).unwrap_or(u16::MAX);
    let mut header = MAGIC_AND_VERSION.to_vec();
    header.extend(length.to_le_bytes());
    header.extend(literal.as_bytes());
    header.resize(header.len() + padding, b' ');
    header.push(b'\n');
    header
}

/// A number type that `.npy` files hold.
pub trait Number: Copy + sealed::Sealed {
    /// NumPy's name of the type.
    const DESCRIPTION: &'static str;
    /// Its size.
    const BYTES: usize;
    /// Appends the numbers as bytes.
    fn extend_bytes(values: &[Self], bytes: &mut Vec<u8>);
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! number {
    ($($type:ident $description:literal),+) => {$(
        impl sealed::Sealed for $type {}
        impl Number for $type {
            const DESCRIPTION: &'static str = $description;
            const BYTES: usize = size_of::<$type>();
            #[inline]
            fn extend_bytes(values: &[Self], bytes: &mut Vec<u8>) {
                for value in values {
                    bytes.extend_from_slice(&value.to_le_bytes());
                }
            }
        }
    )+};
}
number!(f32 "<f4", f64 "<f8", i32 "<i4", i64 "<i8");

/// Takes the numbers of one array.
pub struct ValueWriter<'a, T> {
    out: &'a mut dyn Write,
    bytes: &'a mut Vec<u8>,
    written: usize,
    number: std::marker::PhantomData<T>,
}

impl<T: Number> ValueWriter<'_, T> {
    /// Writes the next numbers.
    ///
    /// # Errors
    /// When the archive cannot be written.
    #[inline]
    pub fn write(&mut self, values: &[T]) -> io::Result<()> {
        T::extend_bytes(values, self.bytes);
        self.written += values.len();
        if self.bytes.len() >= CHUNK_BYTES {
            self.flush()
        } else {
            Ok(())
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.write_all(self.bytes)?;
        self.bytes.clear();
        Ok(())
    }
}

impl<T: Number> fmt::Debug for ValueWriter<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut writer = f.debug_struct("ValueWriter");
        writer
            .field("number", &T::DESCRIPTION)
            .field("written", &self.written)
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Read};

    fn archive(compression: Compression) -> Vec<u8> {
        let mut npz = NpzWriter::new(Cursor::new(Vec::new()), compression);
        npz.array("a", &[2, 3], |values| {
            values.write(&[1.0f32, 2.0])?;
            values.write(&[3.0, 4.0, 5.0, -0.5])
        })
        .unwrap();
        npz.strings("names", &["Hüfte", ""]).unwrap();
        npz.array("t", &[], |values| values.write(&[0.25f64]))
            .unwrap();
        npz.finish().unwrap().into_inner()
    }

    #[test]
    fn a_header_is_aligned_and_says_type_and_shape() {
        for (shape, text) in [(&[][..], "()"), (&[7], "(7, )"), (&[2, 3], "(2, 3, )")] {
            let header = npy_header("<f4", shape);
            assert_eq!(header.len() % NPY_ALIGNMENT, 0);
            assert_eq!(usize::from(header[8]), header.len() - 10);
            assert_eq!(header.last(), Some(&b'\n'));
            let literal = String::from_utf8_lossy(&header[10..]);
            let wanted = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {text}, }}");
            assert!(literal.starts_with(&wanted), "{literal}");
        }
    }

    #[test]
    fn entries_hold_the_numbers_in_order() {
        for compression in [Compression::Stored, Compression::Deflated] {
            let bytes = archive(compression);
            let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
            let mut entry = Vec::new();
            zip.by_name("a.npy")
                .unwrap()
                .read_to_end(&mut entry)
                .unwrap();
            let numbers: Vec<f32> = entry[NPY_ALIGNMENT * 2..]
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
                .collect();
            assert_eq!(numbers, [1.0, 2.0, 3.0, 4.0, 5.0, -0.5]);
            let mut names = Vec::new();
            zip.by_name("names.npy")
                .unwrap()
                .read_to_end(&mut names)
                .unwrap();
            assert!(names.windows(5).any(|w| w == b"'<U5'"));
            let text: String = names[NPY_ALIGNMENT * 2..]
                .chunks_exact(4)
                .filter_map(|b| char::from_u32(u32::from_le_bytes(b.try_into().unwrap())))
                .collect();
            assert_eq!(text, "Hüfte\0\0\0\0\0");
        }
    }

    #[test]
    fn the_same_arrays_give_the_same_bytes() {
        assert_eq!(archive(Compression::Stored), archive(Compression::Stored));
        // No time of making: the date fields of the first local header are those of 1980-01-01.
        assert_eq!(archive(Compression::Stored)[10..14], [0, 0, 0x21, 0]);
    }

    /// Takes so many bytes and no more, as a disk does.
    struct Disk {
        free: usize,
        position: u64,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.free == 0 {
                return Err(io::ErrorKind::StorageFull.into());
            }
            let written = bytes.len().min(self.free);
            self.free -= written;
            self.position += written as u64;
            Ok(written)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Disk {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            match to {
                SeekFrom::Start(position) => self.position = position,
                SeekFrom::Current(by) | SeekFrom::End(by) => {
                    self.position = self.position.saturating_add_signed(by);
                }
            }
            Ok(self.position)
        }
    }

    #[test]
    fn a_full_disk_is_an_error_and_stays_one_wherever_the_archive_is_cut() {
        for compression in [Compression::Stored, Compression::Deflated] {
            let whole = archive(compression).len();
            for free in (0..whole).step_by(7) {
                let disk = Disk { free, position: 0 };
                let mut npz = NpzWriter::new(disk, compression);
                let numbers = vec![1.0f32; 6];
                let result = npz
                    .array("a", &[6], |values| values.write(&numbers))
                    .and_then(|()| npz.strings("names", &["Hüfte", ""]))
                    .and_then(|()| npz.array("t", &[], |values| values.write(&[0.25f64])))
                    .and_then(|()| npz.finish().map(drop));
                let error = result.expect_err("the disk is smaller than the archive");
                assert_eq!(
                    error.kind(),
                    io::ErrorKind::StorageFull,
                    "{free} bytes free"
                );
            }
        }
    }

    #[test]
    #[should_panic(expected = "numbers for the shape")]
    fn too_few_numbers_are_a_mistake_of_the_caller() {
        let mut npz = NpzWriter::new(Cursor::new(Vec::new()), Compression::Stored);
        let _ = npz.array("a", &[3], |values| values.write(&[1.0f32]));
    }
}
