//! `posekit render`: pictures and films of motions.

mod args;
mod camera;
mod format;
mod shot;
mod write;

use std::sync::{Mutex, PoisonError};

use posekit_render::render::{Renderer, RendererChoice};

use crate::args::{Global, RendererArg};
use crate::batch::{self, Done};
use crate::console;
use crate::failure::Failure;
use crate::inputs;
use crate::jobs;
use crate::output::Plan;
use crate::text::counted;
pub(crate) use args::RenderArgs;
use write::Work;

/// Runs the command.
pub(crate) fn run(args: &RenderArgs, global: &Global) -> Result<(), Failure> {
    let format = format::of(args)?;
    let inputs = inputs::expand(&args.files);
    let plan = Plan::new(&args.output, &inputs, format.extension(), &global.guard)?;
    let companions = shot::companions(args, global)?;
    let renderer = Mutex::new(renderer(args.renderer, global)?);
    let is_set = inputs.is_set;
    let mut written_count = 0;
    // A film is drawn on all cores by itself: the files are taken one after the other.
    let one_by_one = Global {
        jobs: Some(std::num::NonZeroUsize::MIN),
        ..global.clone()
    };
    let result = batch::run(
        inputs,
        &one_by_one,
        |index, input| {
            let shot = shot::prepare(args, format, &companions, input, global)?;
            let mut renderer = renderer.lock().unwrap_or_else(PoisonError::into_inner);
            let work = Work {
                shot: &shot,
                format,
                destination: plan.destination(index),
                show_progress: !is_set && !global.quiet,
            };
            let announcement = write::write(&work, &mut renderer)
                .map_err(|failure| name_picture(failure, &input.name()))?;
            Ok(Done {
                value: announcement,
                warnings: shot.warnings,
                notes: shot.notes,
            })
        },
        |_, announcement: String| {
            written_count += 1;
            if !is_set && !global.quiet && !announcement.is_empty() {
                console::note(&announcement);
            }
            Ok(())
        },
    );
    if written_count > 0 && !global.quiet {
        if is_set {
            let files = counted(written_count, "file");
            console::note(&format!("wrote {files} to {}", args.output.display()));
        }
        let renderer = renderer.lock().unwrap_or_else(PoisonError::into_inner);
        console::note(renderer.note());
    }
    result
}

/// What cannot be drawn is said of the input; what cannot be written names the output already.
fn name_picture(failure: Failure, input: &str) -> Failure {
    match failure {
        Failure::Usage(_) => failure.in_file(input),
        Failure::CouldNot(_) | Failure::ClosedPipe => failure,
    }
}

/// The back end that was asked for, on as many threads as `--jobs` says.
fn renderer(choice: RendererArg, global: &Global) -> Result<Renderer, Failure> {
    let threads = global.jobs.unwrap_or_else(jobs::default_workers);
    match choice.into() {
        RendererChoice::Cpu => Ok(Renderer::cpu(threads)),
        choice => Renderer::new(choice),
    }
    .map_err(|error| {
        Failure::new(error.to_string()).try_next("--renderer cpu draws on any machine")
    })
}
