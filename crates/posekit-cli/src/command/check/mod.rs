//! `posekit check`: what is suspicious in a file.

use std::ffi::OsString;
use std::io::Write;

use clap::{Args, ValueEnum};
use posekit::check::{CheckConfig, FindingCode, Severity};
use posekit::figure::{UpAxis, UpTaken};
use posekit_formats::bvh::{self, CheckAs, CheckEntry};
use posekit_formats::report::{Import, Location, WarningCode};
use posekit_formats::urdf;
use serde_json::{Value, json};

use crate::args::Global;
use crate::batch::{self, Done, Outcome};
use crate::console::{self, Reader};
use crate::failure::Failure;
use crate::inputs::{self, Input};
use crate::load::{self, Subject};
use crate::positions::PositionsArgs;
use crate::program::ProgramArg;
use crate::reading::{Said, is_scene};
use crate::similar;
use crate::text::counted;
use crate::up::{self, UpArgs};

mod axes;
mod elsewhere;
mod order;
mod report;
mod summary;

use self::report::Counts;
use self::summary::Total;

/// What is suspicious in a file: what its reader noticed, Euler flips, spikes, freezes, sliding feet
///
/// Of a robot (URDF) it is what the reader noticed, and whether all that moves has a mass. Every finding has a code, and every code has a page in docs/check. The exit code is 1 when
/// something is an error, or has a code that --deny names. Euler flips are information, since the rotations are right: --warn euler-flip
/// makes them warnings. Floor and feet are looked for along the axis on which the rest pose stands, if that is clear,
/// or else along Y. Frames count from 0.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE", required = true)]
    files: Vec<OsString>,
    /// Treat findings with this code as errors; may be repeated
    #[arg(long, value_name = "CODE", value_parser = known_code)]
    deny: Vec<String>,
    /// Treat findings with this code as warnings; may be repeated
    #[arg(long, value_name = "CODE", value_parser = known_code)]
    warn: Vec<String>,
    /// Show only findings that are at least this serious [default: info; of several files, for people, warning]
    #[arg(long, value_name = "SEVERITY")]
    min: Option<Minimum>,
    #[command(flatten)]
    up: UpArgs,
    #[command(flatten)]
    positions: PositionsArgs,
    /// Say whether these programs read the file as posekit does, and what convert --for would change; may be
    /// repeated
    #[arg(
        long = "for",
        value_name = "PROGRAM",
        value_delimiter = ',',
        conflicts_with_all = ["deny", "warn", "min", "summary", "up", "positions", "root_offset"]
    )]
    programs: Vec<ProgramArg>,
    /// Only the table that ends the output: a line for each code, the worst first
    #[arg(long)]
    summary: bool,
    /// One JSON object per file, each on its own line; with --summary one for all
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit check walk.bvh
  posekit check takes/ --min warning
  posekit check takes/ --summary
  posekit check takes/ --deny euler-flip --deny teleport
  posekit check zup.bvh --up z
  posekit check walk.bvh --for blender,three
  posekit check --json takes/ | jq -r '.findings[] | .code' | sort | uniq -c";

/// How serious a finding must be to be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Minimum {
    /// Everything
    Info,
    /// What a viewer sees or a program trips over
    Warning,
    /// What cannot be used
    Error,
}

impl Minimum {
    fn severity(self) -> Severity {
        match self {
            Self::Info => Severity::Info,
            Self::Warning => Severity::Warning,
            Self::Error => Severity::Error,
        }
    }
}

/// A code that findings or the reader's warnings have.
fn known_code(code: &str) -> Result<String, String> {
    let findings = FindingCode::ALL.iter().map(|known| known.code());
    let warnings = WarningCode::ALL.iter().map(|known| known.code());
    let mut known = findings.chain(warnings);
    if known.clone().any(|known| known == code) {
        return Ok(code.to_owned());
    }
    Err(match similar::nearest(code, &mut known) {
        Some(meant) => format!("no finding has this code; did you mean '{meant}'"),
        None => "no finding has this code; docs/check/README.md lists them".to_owned(),
    })
}

/// What came out for one file.
struct Checked {
    entries: Vec<CheckEntry>,
    /// The axis along which floor and feet were looked for; none for a robot.
    up: Option<UpTaken>,
    /// Whether `posekit fix` repairs something of what is shown.
    is_fixable: bool,
}

/// Runs the command.
pub(crate) fn run(args: &CheckArgs, global: &Global) -> Result<(), Failure> {
    if !args.programs.is_empty() {
        return elsewhere::run(args, global);
    }
    let mut out = console::stdout_for(Reader::of_json(args.json));
    let mut denied = Vec::new();
    let mut total = Total::default();
    let inputs = inputs::expand(&args.files);
    // Of many files people want to see those that something is wrong with.
    let is_terse = inputs.is_set && args.min.is_none() && !args.json;
    let default = if is_terse {
        Minimum::Warning
    } else {
        Minimum::Info
    };
    let min = args.min.unwrap_or(default);
    let result = batch::run_telling(
        inputs,
        global,
        |_, input| {
            let checked = check(args, min.severity(), input, global)?;
            Ok(Done {
                value: checked,
                warnings: Vec::new(),
                notes: Vec::new(),
            })
        },
        |outcome| {
            let (input, checked) = match outcome {
                Outcome::Done(input, checked) => (input, checked),
                Outcome::Failed { name, failure } => {
                    total.add_failed();
                    if args.json && !args.summary {
                        out.write_all(failure.json_line(name).as_bytes())?;
                    }
                    return Ok(());
                }
            };
            let name = input.name();
            if checked.has(Severity::Error) {
                denied.push(name.clone());
            }
            let is_listed = !is_terse || checked.has(min.severity());
            if is_listed && !args.summary {
                out.write_all(file_text(args, min, &name, &checked).as_bytes())?;
            }
            total.add(&name, checked);
            Ok(())
        },
    );
    if args.summary && args.json {
        writeln!(out, "{}", total.json())?;
    } else if args.summary {
        total.write_summary(&mut out)?;
    } else if !args.json && !global.quiet {
        total.write(&mut out)?;
    }
    out.flush()?;
    result?;
    match denied.as_slice() {
        [] => Ok(()),
        [name] => Err(Failure::new(format!(
            "{name}: not accepted because of the findings above"
        ))),
        names => Err(Failure::new(format!(
            "{} are not accepted because of the findings above: {}",
            counted(names.len(), "file"),
            names.join(", ")
        ))),
    }
}

fn check(
    args: &CheckArgs,
    least: Severity,
    input: &Input,
    global: &Global,
) -> Result<Checked, Failure> {
    let name = input.name();
    let said = Said::of(args.positions).and_up(args.up.said());
    said.refuse_scene(input)?;
    let (subject, gaps) = load::load_subject_with_gaps(input, global)?;
    // `posekit fix` mends motion files.
    let is_motion = matches!(subject, Subject::Clip(_));
    let mut up = None;
    let mut entries = match subject {
        Subject::Robot(import) => {
            said.refuse_robot(&name)?;
            urdf::check(&import.document, &import.report)
        }
        Subject::Clip(import) => {
            let how = CheckAs {
                positions: args.positions.policies(),
                up: match is_scene(input) {
                    true => Some(UpAxis::Y),
                    false => args.up.said(),
                },
            };
            let config = CheckConfig::default();
            let Import { document, report } = &import;
            let checked = bvh::check_with_gaps(document, &gaps, report, how, &config)
                .map_err(|error| Failure::new(error.to_string()).in_file(&name))?;
            up = Some(checked.up);
            checked.entries
        }
    };
    for entry in &mut entries {
        if args.deny.iter().any(|code| code == entry.code) {
            entry.severity = Severity::Error;
        } else if args.warn.iter().any(|code| code == entry.code) {
            entry.severity = entry.severity.max(Severity::Warning);
        }
    }
    Ok(Checked {
        is_fixable: is_motion
            && entries
                .iter()
                .any(|entry| entry.severity >= least && report::is_fixable(entry)),
        entries,
        up,
    })
}

impl Checked {
    /// Whether something is at least this serious.
    fn has(&self, severity: Severity) -> bool {
        self.entries.iter().any(|entry| entry.severity >= severity)
    }
}

fn file_text(args: &CheckArgs, min: Minimum, name: &str, checked: &Checked) -> String {
    let shown: Vec<&CheckEntry> = checked
        .entries
        .iter()
        .filter(|entry| entry.severity >= min.severity())
        .collect();
    if args.json {
        json_line(name, &shown, checked.up)
    } else {
        let up = checked.up.and_then(up::remark);
        report::readable(name, &shown, Counts::of(&checked.entries), up)
    }
}

fn location(entry: &CheckEntry) -> Option<Location> {
    entry.place.as_ref()?.location()
}

fn json_line(name: &str, entries: &[&CheckEntry], up: Option<UpTaken>) -> String {
    let findings: Vec<Value> = entries.iter().map(|entry| finding_object(entry)).collect();
    let object = json!({
        "file": name,
        "up": up.map(|taken| taken.up.name()),
        "up_sureness": up.map(up::taken_sureness),
        "findings": findings,
    });
    format!("{object}\n")
}

fn finding_object(entry: &CheckEntry) -> Value {
    json!({
        "code": entry.code,
        "severity": entry.severity.name(),
        "joints": entry.joints,
        "frames": entry.frames.map(|frames| json!({
            "first": frames.first,
            "last": frames.last,
        })),
        "file": entry.file,
        "line": location(entry).map(|location| location.line),
        "column": location(entry).map(|location| location.column),
        "place": entry.place.as_ref().map(ToString::to_string),
        "value": entry.value,
        "unit": entry.unit.name(),
        "share_of_height": entry.share_of_height,
        "message": entry.message,
        "page": format!("docs/check/{}.md", entry.code),
    })
}
