//! From an input to the document in it.

use std::ops::ControlFlow;
use std::thread;

use posekit::motion::{Motion, PositionPolicies};
use posekit_formats::bvh::{self, Bvh, Gap, PIECE_BYTES, Piece, ReadOptions};
use posekit_formats::report::{Import, ImportReport, ReadError, ReadErrorKind, Severity, Warning};
use posekit_formats::urdf::{self, Urdf};

use crate::args::Global;
use crate::bytes;
use crate::failure::{Failure, one_line};
use crate::inputs::{Input, Source};
use crate::jobs;
use crate::kind;
use crate::scene_file::{self, Asked, Part};

/// A document and what its reader had to say.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// The file's content.
    pub(crate) bvh: Bvh,
    /// What the reader repaired or found unusual.
    pub(crate) notices: Vec<Warning>,
}

impl Loaded {
    /// The motion that the document's channels make.
    pub(crate) fn motion(&self, policies: PositionPolicies) -> Result<Motion, Failure> {
        self.bvh.to_motion(policies).map_err(|error| {
            Failure::new(error.to_string())
                .try_next("posekit check says where in the file these values are")
        })
    }

    /// What position channels turn out to mean where they are not positions, as a warning that names the option.
    pub(crate) fn relative_positions(
        &self,
        input: &Input,
        motion: &Motion,
        policies: PositionPolicies,
    ) -> Option<String> {
        let found = self.bvh.relative_positions(motion, policies)?;
        let text = format!("{}: {}", input.name(), found.advice());
        Some(one_line(&text))
    }

    /// What the reader had to repair, as `file:line:column: message`.
    pub(crate) fn repairs(&self, input: &Input) -> Vec<String> {
        repair_lines(&input.name(), &self.notices)
    }
}

/// What is wrong with a file of this name, a line each.
pub(crate) fn repair_lines(name: &str, notices: &[Warning]) -> Vec<String> {
    let repairs = notices.iter().filter(|notice| is_repair(notice));
    repairs.map(|notice| notice_line(name, notice)).collect()
}

/// Whether a notice says that the file was wrong, and not merely unusual.
pub(crate) fn is_repair(notice: &Warning) -> bool {
    notice.code.severity() == Severity::Warning
}

/// Reads an input. With `--strict` a file that needed repair is a failure.
pub(crate) fn load(input: &Input, global: &Global) -> Result<Loaded, Failure> {
    let (import, _) = load_import(input, global)?;
    Ok(Loaded {
        bvh: import.document,
        notices: import.report.warnings,
    })
}

/// As [`load`], of a scene only the frames that are asked for: a few lines of text can stand for millions.
pub(crate) fn load_part(
    input: &Input,
    asked: Asked<'_>,
    global: &Global,
) -> Result<(Loaded, Option<Part>), Failure> {
    let Source::File(path) = &input.source else {
        return Ok((load(input, global)?, None));
    };
    if !scene_file::is_scene(path) {
        return Ok((load(input, global)?, None));
    }
    let (import, part) = scene_file::part(path, asked, &global.guard)?;
    refuse_repairs(&input.name(), &import.report, global)?;
    let loaded = Loaded {
        bvh: import.document,
        notices: import.report.warnings,
    };
    Ok((loaded, Some(part)))
}

/// A file of motion, or of a robot.
#[derive(Debug)]
pub(crate) enum Subject {
    /// A BVH file.
    Clip(Import<Bvh>),
    /// A URDF file.
    Robot(Import<Urdf>),
}

/// Reads an input that may be a robot: bytes that begin as XML does are URDF. With `--strict` a file that
/// needed repair is a failure.
pub(crate) fn load_subject(input: &Input, global: &Global) -> Result<Subject, Failure> {
    Ok(load_subject_by(input, global, parse_whole)?.0)
}

/// As [`load_subject`], with values in the rows that are not numbers: their places beside a clip.
pub(crate) fn load_subject_with_gaps(
    input: &Input,
    global: &Global,
) -> Result<(Subject, Vec<Gap>), Failure> {
    load_subject_by(input, global, parse_with_gaps)
}

fn load_subject_by(
    input: &Input,
    global: &Global,
    parse: impl Fn(&str, &[u8]) -> Result<(Import<Bvh>, Vec<Gap>), Failure>,
) -> Result<(Subject, Vec<Gap>), Failure> {
    let name = input.name();
    let Some(bytes) = input_bytes(input, global)? else {
        return Ok((Subject::Clip(load_import(input, global)?.0), Vec::new()));
    };
    if !looks_like_xml(&bytes) {
        let (import, gaps) = parse(&name, &bytes)?;
        refuse_repairs(&name, &import.report, global)?;
        return Ok((Subject::Clip(import), gaps));
    }
    let import =
        urdf::read(&bytes).map_err(|error| Failure::new(read_error_line(&name, &error)))?;
    refuse_repairs(&name, &import.report, global)?;
    Ok((Subject::Robot(import), Vec::new()))
}

fn looks_like_xml(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.trim_ascii_start().starts_with(b"<")
}

/// With `--strict`, fails where a file needed repair.
pub(crate) fn refuse_repairs(
    name: &str,
    report: &ImportReport,
    global: &Global,
) -> Result<(), Failure> {
    match report.first_repair().filter(|_| global.strict) {
        None => Ok(()),
        Some(repair) => {
            let failure = Failure::new(notice_line(name, repair));
            Err(failure.try_next("it can be read without --strict"))
        }
    }
}

/// The bytes of an input; `None` for a scene, whose text names other files, and for a clip of our own.
fn input_bytes(input: &Input, global: &Global) -> Result<Option<Vec<u8>>, Failure> {
    match &input.source {
        Source::File(path) if scene_file::is_scene(path) => Ok(None),
        Source::File(path) => bytes::of_file(path, &global.guard).map(Some),
        Source::Stdin => bytes::of_stdin(&global.guard).map(Some),
        Source::Sample(_) => Ok(None),
    }
}

/// As [`load`], with the reader's whole report and the bytes that were read. A clip of our own has neither; a scene, which
/// has no bytes here, has what the readers of the files that it names noticed.
pub(crate) fn load_import(
    input: &Input,
    global: &Global,
) -> Result<(Import<Bvh>, Vec<u8>), Failure> {
    let read = load_import_by(input, global, parse_whole)?;
    Ok((read.import, read.bytes))
}

/// As [`load_import`], with values in the rows that are not numbers, and where they are.
pub(crate) fn load_import_with_gaps(
    input: &Input,
    global: &Global,
) -> Result<ImportWithGaps, Failure> {
    load_import_by(input, global, parse_with_gaps)
}

/// A reader's result, the bytes that were read, and the values in them that are not numbers.
#[derive(Debug)]
pub(crate) struct ImportWithGaps {
    /// The document, which holds 0 for each gap, and the report.
    pub(crate) import: Import<Bvh>,
    /// The bytes.
    pub(crate) bytes: Vec<u8>,
    /// The values that are not numbers.
    pub(crate) gaps: Vec<Gap>,
}

fn load_import_by(
    input: &Input,
    global: &Global,
    parse: impl Fn(&str, &[u8]) -> Result<(Import<Bvh>, Vec<Gap>), Failure>,
) -> Result<ImportWithGaps, Failure> {
    let name = input.name();
    let without_notices = |document| {
        let report = ImportReport::default();
        Ok(ImportWithGaps {
            import: Import { document, report },
            bytes: Vec::new(),
            gaps: Vec::new(),
        })
    };
    let bytes = match &input.source {
        Source::File(path) if scene_file::is_scene(path) => {
            let import = scene_file::document(path, &global.guard)?;
            refuse_repairs(&name, &import.report, global)?;
            return Ok(ImportWithGaps {
                import,
                bytes: Vec::new(),
                gaps: Vec::new(),
            });
        }
        Source::File(path) => bytes::of_file(path, &global.guard)?,
        Source::Stdin => bytes::of_stdin(&global.guard)?,
        Source::Sample(sample) => return without_notices(sample.document()?),
    };
    let (import, gaps) = parse(&name, &bytes)?;
    refuse_repairs(&name, &import.report, global)?;
    Ok(ImportWithGaps {
        import,
        bytes,
        gaps,
    })
}

/// Below this a file is read before other threads would have begun.
const LARGE_BYTES: usize = 8 << 20;

/// Reads BVH, a large file on all cores that this file has to itself.
fn read_bvh(bytes: &[u8]) -> Result<Import<Bvh>, ReadError> {
    let hands = jobs::hands().get();
    if bytes.len() < LARGE_BYTES || hands == 1 {
        return bvh::read(bytes);
    }
    let go_on = |_| ControlFlow::Continue(());
    let options = ReadOptions::default();
    bvh::read_in_pieces(bytes, options, PIECE_BYTES, go_on, |pieces| {
        let share = pieces.len().div_ceil(hands).max(1);
        thread::scope(|threads| {
            for part in pieces.chunks_mut(share) {
                let work = move || part.iter_mut().for_each(Piece::work);
                // Where no thread can be had, the pieces are read after the others.
                drop(thread::Builder::new().spawn_scoped(threads, work));
            }
        });
    })
}

/// Reads a file whose values are numbers, all of them.
fn parse_whole(name: &str, bytes: &[u8]) -> Result<(Import<Bvh>, Vec<Gap>), Failure> {
    read_bvh(bytes)
        .map(|import| (import, Vec::new()))
        .map_err(|error| refused(name, bytes, &error))
}

/// The failure of a file that cannot be read; where only numbers are missing, what can be done.
pub(crate) fn refused(name: &str, bytes: &[u8], error: &ReadError) -> Failure {
    if let Some(failure) = kind::not_a_motion(name, bytes) {
        return failure;
    }
    let failure = Failure::new(read_error_line(name, error));
    let has_gaps = error.kind == ReadErrorKind::NotFinite && bvh::read_with_gaps(bytes).is_ok();
    if has_gaps {
        failure
            .try_next("posekit check lists all such values, posekit fix --bridge-gaps fills them")
    } else {
        failure
    }
}

fn parse_with_gaps(name: &str, bytes: &[u8]) -> Result<(Import<Bvh>, Vec<Gap>), Failure> {
    bvh::read_with_gaps(bytes).map_err(|error| {
        kind::not_a_motion(name, bytes)
            .unwrap_or_else(|| Failure::new(read_error_line(name, &error)))
    })
}

/// `file:line:column: expected this, found that`, which editors and terminals make a link of.
fn read_error_line(name: &str, error: &ReadError) -> String {
    let ReadError {
        place,
        expected,
        found,
        ..
    } = error;
    let place = place.after_name();
    format!("{name}{place}expected {expected}, found {found}")
}

fn notice_line(name: &str, notice: &Warning) -> String {
    let Warning {
        code,
        file,
        place,
        message,
        count,
    } = notice;
    let more = if *count > 1 {
        format!(" (and {} more)", count - 1)
    } else {
        String::new()
    };
    let file = file
        .as_ref()
        .map_or(String::new(), |file| format!(": {file}"));
    let place = place.after_name();
    one_line(&format!("{name}{file}{place}{message} [{code}]{more}"))
}
