//! `posekit view`: the window.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::Args;
use posekit_formats::urdf;
use posekit_viewer::load::Input as Opened;
use posekit_viewer::state::clip::ReadingSaid;
use posekit_viewer::{ViewerOptions, run_native};

use crate::args::{Global, RendererArg};
use crate::bytes;
use crate::failure::Failure;
use crate::inputs::{self, Source};
use crate::output::Guard;
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::up::UpArgs;

/// Open a window and see the character move
///
/// Opens files and folders, several at once side by side or overlaid; more can be dropped on the window. With
/// no file, a walking figure that posekit makes itself is shown. A URDF file is opened in the arm lab, and so
/// are sample:planar2, sample:arm6 and sample:arm7. All keys are listed at '?'.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ViewArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE")]
    files: Vec<OsString>,
    #[command(flatten)]
    up: UpArgs,
    #[command(flatten)]
    positions: PositionsArgs,
    /// What draws: auto is the graphics card, if there is one, and else the CPU
    #[arg(long, value_name = "WHICH", default_value = "auto")]
    renderer: RendererArg,
}

impl ViewArgs {
    /// Whether a graphics driver may be asked to draw: wgpu shows the window whatever draws the figures.
    #[allow(clippy::unused_self, reason = "as for the other commands")]
    pub(crate) fn may_use_graphics(&self) -> bool {
        true
    }
}

const EXAMPLES: &str = "\
Examples:
  posekit view                          a figure walks
  posekit view walk.bvh
  posekit view takes/                   a folder: its clips are listed on the left
  posekit view before.bvh after.bvh     two, to compare
  posekit view shot.posekit.toml        a scene, to go on animating
  posekit view arm.urdf                 a robot, in the arm lab
  posekit view sample:arm6              a six-axis arm

Without a display: posekit render walk.bvh -o walk.mp4, or posekit serve takes/";

/// Runs the command: returns when the window is closed.
pub(crate) fn run(args: &ViewArgs, global: &Global) -> Result<(), Failure> {
    if !has_display() {
        return Err(no_window("there is no display to open a window on"));
    }
    let said = Said::of(args.positions).and_up(args.up.said());
    let mut options = options(&args.files, said, &global.guard)?;
    options.renderer = args.renderer.into();
    options.reading = ReadingSaid {
        positions: args.positions.is_given().then(|| args.positions.policies()),
        up: args.up.said(),
    };
    run_native(options).map_err(|error| no_window(&error.to_string()))
}

fn no_window(why: &str) -> Failure {
    Failure::new(why).try_next(
        "'posekit render FILE -o clip.mp4' makes a film, 'posekit serve FOLDER' shows it in a browser",
    )
}

/// Whether a window could be opened. Elsewhere than on Unix with X11 or Wayland there is a display
/// whenever somebody is logged in; the window itself finds out.
pub(crate) fn has_display() -> bool {
    if !cfg!(all(unix, not(target_vendor = "apple"))) {
        return true;
    }
    ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"]
        .into_iter()
        .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}

/// A robot of our own by its name on the command line, `sample:arm6` or `sample:arm6.urdf`.
fn sample_robot(name: &OsStr) -> Option<Opened> {
    let name = name.to_str()?.strip_prefix(inputs::SAMPLE_PREFIX)?;
    let name = name.strip_suffix(".urdf").unwrap_or(name);
    let text = urdf::sample::by_name(name)?;
    Some(Opened::Bytes {
        name: format!("{name}.urdf"),
        bytes: text.as_bytes().into(),
    })
}

fn options(names: &[OsString], said: Said, guard: &Guard) -> Result<ViewerOptions, Failure> {
    let mut options = ViewerOptions::default();
    for name in names {
        // A folder is opened as one: the window lists what is in it.
        let path = Path::new(name);
        if path.is_dir() {
            options.paths.push(path.to_owned());
            continue;
        }
        if let Some(robot) = sample_robot(name) {
            said.refuse_robot(&name.to_string_lossy())?;
            options.inputs.push(robot);
            continue;
        }
        let found = inputs::expand(std::slice::from_ref(name));
        if let Some((_, failure)) = found.failures.into_iter().next() {
            return Err(failure);
        }
        for input in found.list {
            let name = input.name();
            said.refuse_scene(&input)?;
            match input.source {
                Source::File(path) => {
                    if path
                        .extension()
                        .is_some_and(|it| it.eq_ignore_ascii_case("urdf"))
                    {
                        said.refuse_robot(&name)?;
                    }
                    // Whoever typed a wrong name is told where they typed it.
                    std::fs::File::open(&path)
                        .map_err(|error| Failure::cannot_read(&path, &error))?;
                    options.paths.push(path);
                }
                Source::Stdin => {
                    let bytes = bytes::of_stdin(guard)?.into();
                    options.inputs.push(Opened::Bytes { name, bytes });
                }
                Source::Sample(sample) => {
                    let name = sample.name().to_owned();
                    options.inputs.push(Opened::Sample(name));
                }
            }
        }
    }
    Ok(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_of_our_own_have_names() {
        for name in [
            "sample:arm6",
            "sample:arm6.urdf",
            "sample:planar2",
            "sample:arm7",
        ] {
            let options =
                options(&[OsString::from(name)], Said::default(), &Guard::default()).unwrap();
            let [Opened::Bytes { name, bytes }] = options.inputs.as_slice() else {
                panic!("one robot");
            };
            assert!(name.ends_with(".urdf") && bytes.starts_with(b"<?xml"));
        }
        let arm5 = [OsString::from("sample:arm5")];
        assert!(options(&arm5, Said::default(), &Guard::default()).is_err());
    }
}
