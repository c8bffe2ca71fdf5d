//! `posekit check`: what is suspicious in a file.

use std::ffi::OsString;
use std::io::Write;

use clap::{Args, ValueEnum};
use posekit::check::{CheckConfig, FindingCode, Severity};
use posekit_formats::bvh::{self, CheckEntry};
use posekit_formats::report::WarningCode;
use serde_json::{Value, json};

use crate::args::Global;
use crate::batch::{self, Done};
use crate::console;
use crate::failure::Failure;
use crate::inputs;
use crate::load::{self, Subject};
use crate::root_offset::RootOffset;
use crate::text::counted;

mod report;

use self::report::{Counts, Total};

/// What is suspicious in a file: what its reader noticed, Euler flips, spikes, freezes, sliding feet
///
/// Of a robot (URDF) it is what the reader noticed. Every finding has a code, and every code has a page in docs/check. The exit code is 1 when
/// something is an error, or has a code that --deny names. Frames count from 0.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CheckArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE", required = true)]
    files: Vec<OsString>,
    /// Take findings of this code as errors; may be repeated
    #[arg(long, value_name = "CODE", value_parser = known_code)]
    deny: Vec<String>,
    /// Show only findings that are at least this serious
    #[arg(long, value_name = "SEVERITY", default_value = "info")]
    min: Minimum,
    /// Whether a root's position channels replace its OFFSET or are added to it
    #[arg(long, value_name = "HOW", default_value = "replace")]
    root_offset: RootOffset,
    /// One JSON object a file, each on a line of its own
    #[arg(long)]
    json: bool,
}

const EXAMPLES: &str = "\
Examples:
  posekit check walk.bvh
  posekit check takes/ --min warning
  posekit check takes/ --deny euler-flip --deny teleport
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
    if findings.chain(warnings).any(|known| known == code) {
        Ok(code.to_owned())
    } else {
        Err("no finding has this code; docs/check/README.md lists them".to_owned())
    }
}

/// What came out for one file.
struct Outcome {
    text: String,
    counts: Counts,
    is_denied: bool,
    is_fixable: bool,
}

/// Runs the command.
pub(crate) fn run(args: &CheckArgs, global: &Global) -> Result<(), Failure> {
    let mut out = console::stdout();
    let mut denied = Vec::new();
    let mut total = Total::default();
    let checked = batch::run(
        inputs::expand(&args.files),
        global,
        |_, input| {
            let name = input.name();
            let import = match load::load_subject(input, global)? {
                Subject::Clip(import) => import,
                Subject::Robot(import) => {
                    let entries = bvh::reader_entries(&import.report);
                    let mut outcome = outcome(args, &name, &entries);
                    // `posekit fix` mends motion files.
                    outcome.is_fixable = false;
                    return Ok(Done {
                        value: outcome,
                        warnings: Vec::new(),
                    });
                }
            };
            let policy = args.root_offset.policy();
            let config = CheckConfig::default();
            let entries = bvh::check(&import.document, &import.report, policy, &config)
                .map_err(|error| Failure::new(error.to_string()).in_file(&name))?;
            Ok(Done {
                value: outcome(args, &name, &entries),
                warnings: Vec::new(),
            })
        },
        |input, outcome: Outcome| {
            if outcome.is_denied {
                denied.push(input.name());
            }
            total.add(&outcome, input.name());
            Ok(out.write_all(outcome.text.as_bytes())?)
        },
    );
    if !args.json && !global.quiet {
        out.write_all(total.text().as_bytes())?;
    }
    out.flush()?;
    checked?;
    match denied.as_slice() {
        [] => Ok(()),
        [name] => Err(Failure::new(format!(
            "{name}: not accepted, for the findings above"
        ))),
        names => Err(Failure::new(format!(
            "{} are not accepted, for the findings above: {}",
            counted(names.len(), "file"),
            names.join(", ")
        ))),
    }
}

fn outcome(args: &CheckArgs, name: &str, entries: &[CheckEntry]) -> Outcome {
    let is_denied = |entry: &CheckEntry| {
        entry.severity == Severity::Error || args.deny.iter().any(|code| code == entry.code)
    };
    let shown: Vec<&CheckEntry> = entries
        .iter()
        .filter(|entry| entry.severity >= args.min.severity() || is_denied(entry))
        .collect();
    let text = if args.json {
        json_line(name, &shown)
    } else {
        report::readable(name, &shown, entries.len() - shown.len())
    };
    Outcome {
        text,
        counts: Counts::of(entries),
        is_denied: entries.iter().any(is_denied),
        is_fixable: entries.iter().any(report::is_fixable),
    }
}

fn json_line(name: &str, entries: &[&CheckEntry]) -> String {
    let findings: Vec<Value> = entries
        .iter()
        .map(|entry| {
            json!({
                "code": entry.code,
                "severity": entry.severity.name(),
                "joints": entry.joints,
                "frames": entry.frames.map(|frames| json!({
                    "first": frames.first,
                    "last": frames.last,
                })),
                "line": entry.location.map(|location| location.line),
                "column": entry.location.map(|location| location.column),
                "value": entry.value,
                "unit": entry.unit.name(),
                "share_of_height": entry.share_of_height,
                "message": entry.message,
                "page": format!("docs/check/{}.md", entry.code),
            })
        })
        .collect();
    format!("{}\n", json!({ "file": name, "findings": findings }))
}
