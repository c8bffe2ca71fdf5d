//! Arrays into files.

use std::ffi::OsStr;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use posekit_formats::arrays::MotionArrays;
use posekit_formats::npz::Compression;
use posekit_formats::{csv, json, npz};

use crate::console;
use crate::failure::Failure;
use crate::inputs::STDIN;
use crate::output::{Destination, write_whole};
use crate::text::counted;

/// A format of arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// NumPy's archive of arrays
    Npz,
    /// One row a frame
    Csv,
    /// Nested lists
    Json,
}

/// A format and how its files are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArrayFormat {
    format: Format,
    compression: Compression,
}

impl ArrayFormat {
    /// What its files end in.
    pub(super) fn extension(self) -> &'static str {
        match self.format {
            Format::Npz => "npz",
            Format::Csv => "csv",
            Format::Json => "json",
        }
    }
}

/// The format that the user chose, or that the output's extension says.
pub(super) fn format(
    output: &OsStr,
    chosen: Option<Format>,
    compress: bool,
) -> Result<ArrayFormat, Failure> {
    let format = match chosen {
        Some(format) => format,
        None => by_name(output)?,
    };
    if compress && format != Format::Npz {
        return Err(Failure::usage("only .npz can be compressed"));
    }
    if output == STDIN && format == Format::Npz && console::stdout_is_terminal() {
        return Err(
            Failure::usage("an .npz cannot be shown as text on a terminal")
                .try_next("name a file with -o, or add --format csv"),
        );
    }
    let compression = if compress {
        Compression::Deflated
    } else {
        Compression::Stored
    };
    Ok(ArrayFormat {
        format,
        compression,
    })
}

fn by_name(output: &OsStr) -> Result<Format, Failure> {
    const KNOWN: &str = "name it .npz, .csv or .json, or give --format";
    if output == STDIN {
        return Err(
            Failure::usage("standard output has no extension to tell the format from")
                .try_next("give --format csv, json or npz"),
        );
    }
    let path = Path::new(output);
    // A folder such as `arrays.v2/` has no extension that means something.
    let is_folder = path.is_dir() || output.as_encoded_bytes().ends_with(b"/");
    let Some(extension) = path.extension().filter(|_| !is_folder) else {
        return Ok(Format::Npz);
    };
    match extension.to_string_lossy().to_lowercase().as_str() {
        "npz" | "{ext}" => Ok(Format::Npz),
        "csv" => Ok(Format::Csv),
        "json" => Ok(Format::Json),
        other => Err(Failure::usage(format!("no format writes .{other} files")).try_next(KNOWN)),
    }
}

/// What was written where.
#[derive(Debug)]
pub(super) struct Written {
    path: Option<PathBuf>,
    frame_count: usize,
    joint_count: usize,
}

impl Written {
    /// Tells the user.
    pub(super) fn announce(&self) {
        if let Some(path) = &self.path {
            let (frames, joints) = (
                counted(self.frame_count, "frame"),
                counted(self.joint_count, "joint"),
            );
            console::note(&format!("wrote {}: {frames} of {joints}", path.display()));
        }
    }
}

/// Writes arrays where they should go.
pub(super) fn write(
    arrays: &MotionArrays<'_>,
    format: ArrayFormat,
    destination: &Destination,
) -> Result<Written, Failure> {
    let path = match destination {
        Destination::File(target) => {
            write_whole(target, |file| match format.format {
                Format::Npz => npz::write(arrays, file, format.compression).map(drop),
                Format::Csv => csv::write(arrays, file),
                Format::Json => json::write(arrays, file),
            })?;
            Some(target.path().to_owned())
        }
        Destination::Stdout => {
            write_stdout(arrays, format)?;
            None
        }
    };
    Ok(Written {
        path,
        frame_count: arrays.frames.len(),
        joint_count: arrays.joints.len(),
    })
}

fn write_stdout(arrays: &MotionArrays<'_>, format: ArrayFormat) -> io::Result<()> {
    let mut out = console::binary_stdout();
    match format.format {
        Format::Npz => {
            // An archive is sought in while it is written, which a pipe cannot do.
            let archive = npz::write(arrays, Cursor::new(Vec::new()), format.compression)?;
            out.write_all(archive.get_ref())?;
        }
        Format::Csv => csv::write(arrays, &mut out)?,
        Format::Json => json::write(arrays, &mut out)?,
    }
    out.flush()
}
