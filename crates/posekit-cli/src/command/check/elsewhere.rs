//! `posekit check --for PROGRAM`: whether a program reads a file as posekit does, and what convert would change.

use std::io::Write;

use posekit_formats::bvh::elsewhere::{self, Effect, Program, Remark};
use posekit_formats::bvh::{self, Bvh};
use serde_json::{Value, json};

use crate::args::Global;
use crate::batch::{self, Done, Outcome};
use crate::console::{self, DIM, HEADING, Reader, styled};
use crate::failure::{Failure, one_line};
use crate::inputs::{self, Input};
use crate::load;
use crate::text::counted;

use super::CheckArgs;

/// How many joints a line names.
const JOINTS_NAMED: usize = 4;

/// How a program reads a file.
struct Reading {
    program: Program,
    remarks: Vec<Remark>,
    /// What `posekit convert --for` would change, or why it cannot help.
    remedy: Result<Vec<String>, String>,
    /// The names of all joints.
    joints: Vec<String>,
}

/// Runs the command with `--for`.
pub(super) fn run(args: &CheckArgs, global: &Global) -> Result<(), Failure> {
    let mut out = console::stdout_for(Reader::of_json(args.json));
    let mut wrong: Vec<String> = Vec::new();
    batch::run_telling(
        inputs::expand(&args.files),
        global,
        |_, input| {
            Ok(Done {
                value: readings(args, input, global)?,
                warnings: Vec::new(),
                notes: Vec::new(),
            })
        },
        |outcome| {
            let (input, readings) = match outcome {
                Outcome::Done(input, readings) => (input, readings),
                Outcome::Failed { name, failure } if args.json => {
                    return Ok(out.write_all(failure.json_line(name).as_bytes())?);
                }
                Outcome::Failed { .. } => return Ok(()),
            };
            let name = input.name();
            wrong.extend(
                readings
                    .iter()
                    .filter(|reading| reading.is_wrong())
                    .map(|reading| format!("{name} in {}", reading.program.title())),
            );
            let text = if args.json {
                let readings: Vec<Value> = readings.iter().map(Reading::json).collect();
                format!("{}\n", json!({ "file": name, "readings": readings }))
            } else {
                readings.iter().map(|reading| reading.text(&name)).collect()
            };
            Ok(out.write_all(text.as_bytes())?)
        },
    )
    .and_then(|()| Ok(out.flush()?))?;
    match wrong.as_slice() {
        [] => Ok(()),
        [one] => Err(Failure::new(format!(
            "{one}: not read correctly, see above"
        ))),
        many => Err(Failure::new(format!(
            "{} are not correct, see above",
            counted(many.len(), "reading")
        ))),
    }
}

fn readings(args: &CheckArgs, input: &Input, global: &Global) -> Result<Vec<Reading>, Failure> {
    let (mut import, mut bytes) = load::load_import(input, global)?;
    if bytes.is_empty() {
        // A clip of our own and a scene have no text: what convert would write is judged.
        bytes = bvh::write(&import.document);
        import = bvh::read(&bytes).map_err(|error| Failure::new(error.to_string()))?;
    }
    let reading = |program: Program| Reading {
        program,
        remarks: elsewhere::judge(program, &bytes, &import),
        remedy: remedy(&import.document, program),
        joints: import
            .document
            .joints
            .iter()
            .map(|joint| joint.name().into_owned())
            .collect(),
    };
    Ok(args.programs.iter().map(|arg| reading(arg.0)).collect())
}

fn remedy(bvh: &Bvh, program: Program) -> Result<Vec<String>, String> {
    elsewhere::adapt(&mut bvh.clone(), program).map_err(|obstacle| obstacle.to_string())
}

impl Reading {
    /// The worst that happens.
    fn effect(&self) -> Option<Effect> {
        self.remarks.iter().map(|remark| remark.rule.effect).max()
    }

    fn effect_name(&self) -> &'static str {
        self.effect().map_or("right", Effect::name)
    }

    fn is_wrong(&self) -> bool {
        self.effect() >= Some(Effect::Misread)
    }

    fn text(&self, name: &str) -> String {
        let program = format!("{} {}", self.program.title(), self.program.version());
        let verdict = match self.effect() {
            None => "reads it correctly",
            Some(Effect::Renamed) => "reads it correctly, under other names",
            Some(Effect::Unsure) => "may read it correctly",
            Some(Effect::Misread) => "reads it wrongly",
            Some(Effect::Refused) => "refuses it",
        };
        let heading = styled(HEADING, &one_line(&format!("{name}: {program}")));
        let mut text = format!("{heading} {verdict}\n");
        for remark in &self.remarks {
            let joints = one_line(&self.joints_named(&remark.joints));
            text += &format!(
                "  {:<7}  {}: {}{joints}\n",
                remark.rule.effect.name(),
                remark.rule.peculiarity.title(),
                remark.rule.what
            );
        }
        if !self.remarks.is_empty() {
            text += &format!("  {}\n", styled(DIM, &one_line(&self.advice())));
        }
        text
    }

    /// ` (Hips, Spine and 3 more)`.
    fn joints_named(&self, joints: &[usize]) -> String {
        let names: Vec<&str> = joints
            .iter()
            .take(JOINTS_NAMED)
            .map(|&joint| self.joints[joint].as_str())
            .collect();
        match joints.len() - names.len() {
            _ if names.is_empty() => String::new(),
            0 => format!(" ({})", names.join(", ")),
            more => format!(" ({} and {more} more)", names.join(", ")),
        }
    }

    fn advice(&self) -> String {
        let option = format!("posekit convert --for {}", self.program.name());
        match &self.remedy {
            Ok(changes) if changes.is_empty() => {
                format!("{option} rewrites it, which is enough")
            }
            Ok(changes) => format!("{option} {}", changes.join("; ")),
            Err(obstacle) => format!("{option} cannot help: {obstacle}"),
        }
    }

    fn json(&self) -> Value {
        let remarks: Vec<Value> = self
            .remarks
            .iter()
            .map(|remark| {
                let joints: Vec<&str> = remark
                    .joints
                    .iter()
                    .map(|&joint| self.joints[joint].as_str())
                    .collect();
                json!({
                    "peculiarity": remark.rule.peculiarity.title(),
                    "effect": remark.rule.effect.name(),
                    "what": remark.rule.what,
                    "joints": joints,
                })
            })
            .collect();
        json!({
            "program": self.program.name(),
            "version": self.program.version(),
            "effect": self.effect_name(),
            "remarks": remarks,
            "convert": self.remedy.as_ref().ok(),
            "obstacle": self.remedy.as_ref().err(),
        })
    }
}
