//! Drawing what was asked for and writing it where it should go.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

#[cfg(feature = "h264")]
use posekit_render::output::write_mp4;
use posekit_render::output::{
    ContactSheet, Film, FilmError, render_contact_sheet, write_apng, write_gif, write_png,
};
use posekit_render::render::Renderer;

use crate::console;
use crate::failure::Failure;
use crate::output::{Destination, Target, write_whole};
use crate::progress::Progress;
use crate::text::{counted, duration, trimmed};

use super::format::{NUMBER_SIGN, Product};
use super::shot::Shot;

/// One shot, what becomes of it and where that goes.
#[derive(Debug)]
pub(super) struct Work<'a> {
    /// What is drawn.
    pub(super) shot: &'a Shot,
    /// What becomes of it.
    pub(super) format: Product,
    /// Where it goes.
    pub(super) destination: &'a Destination,
    /// Whether a bar is shown while it is drawn.
    pub(super) show_progress: bool,
}

/// Draws and writes; gives what to tell the user, nothing for standard output.
pub(super) fn write(work: &Work<'_>, renderer: &mut Renderer) -> Result<String, Failure> {
    let frames = work.shot.times_secs.len();
    let progress = Progress::frames(frames, !work.show_progress);
    match work.destination {
        Destination::File(target) if work.format == Product::Numbered => {
            write_numbered(work.shot, target, renderer, &progress)?;
        }
        Destination::File(target) => {
            let mut refused = None;
            let written = write_whole(target, |file| {
                encode(work, renderer, file, &progress).map_err(|error| split(error, &mut refused))
            });
            said(written, refused, &target.display().to_string())?;
        }
        Destination::Stdout => {
            let mut refused = None;
            let mut bytes = Vec::new();
            let drawn = encode(work, renderer, &mut bytes, &progress)
                .map_err(|error| split(error, &mut refused));
            said(drawn.map_err(Failure::from), refused, "standard output")?;
            let mut out = console::binary_stdout();
            out.write_all(&bytes)?;
            out.flush()?;
            return Ok(String::new());
        }
    }
    Ok(announcement(work))
}

/// What the renderer or encoder refused is kept; what the file system did goes on.
fn split(error: FilmError, refused: &mut Option<String>) -> io::Error {
    match error {
        FilmError::Output(error) => error,
        other => {
            *refused = Some(other.to_string());
            io::Error::other("not drawn")
        }
    }
}

fn said(written: Result<(), Failure>, refused: Option<String>, name: &str) -> Result<(), Failure> {
    match refused {
        Some(text) => Err(Failure::new(text).in_file(name)),
        None => written,
    }
}

fn encode(
    work: &Work<'_>,
    renderer: &mut Renderer,
    output: impl Write,
    progress: &Progress,
) -> Result<(), FilmError> {
    let shot = work.shot;
    let scene_at = |time_secs: f64| shot.scene(time_secs);
    let film = || Film {
        width: shot.size.width,
        height: shot.size.height,
        frames_per_sec: shot.frames_per_sec,
        times_secs: shot.times_secs.clone(),
    };
    let mut one_more = |_done: usize| {
        progress.advance("");
        ControlFlow::Continue(())
    };
    match work.format {
        Product::Picture | Product::Numbered => {
            let scene = shot.scene(shot.times_secs.first().copied().unwrap_or(0.0));
            let image = renderer.render(&scene, shot.size.width, shot.size.height)?;
            Ok(write_png(&image, output)?)
        }
        Product::ContactSheet { .. } => {
            let sheet = ContactSheet {
                cell_width: shot.size.width,
                cell_height: shot.size.height,
                times_secs: shot.times_secs.clone(),
            };
            let theme = &shot.options().theme;
            let image = render_contact_sheet(&sheet, &scene_at, theme, renderer)?;
            Ok(write_png(&image, output)?)
        }
        #[cfg(feature = "h264")]
        Product::Mp4 => write_mp4(&film(), &scene_at, renderer, output, &mut one_more),
        #[cfg(not(feature = "h264"))]
        Product::Mp4 => Err(FilmError::Encoder("built without H.264".to_owned())),
        Product::Gif => write_gif(&film(), &scene_at, renderer, output, &mut one_more),
        Product::Apng => write_apng(&film(), &scene_at, renderer, output, &mut one_more),
    }
}

/// A file for each moment, each whole.
fn write_numbered(
    shot: &Shot,
    pattern: &Target,
    renderer: &mut Renderer,
    progress: &Progress,
) -> Result<(), Failure> {
    for (number, &time_secs) in shot.times_secs.iter().enumerate() {
        let path = numbered(pattern.path(), number);
        let target = pattern.one_of(&path)?;
        let image = renderer
            .render(&shot.scene(time_secs), shot.size.width, shot.size.height)
            .map_err(|error| {
                Failure::new(error.to_string()).in_file(&path.display().to_string())
            })?;
        write_whole(&target, |file| write_png(&image, file))?;
        progress.advance("");
    }
    Ok(())
}

/// The name with its last run of `#` replaced by the number, with zeros in front.
fn numbered(pattern: &Path, number: usize) -> PathBuf {
    let name = pattern.to_string_lossy();
    let Some(end) = name.rfind(NUMBER_SIGN) else {
        return pattern.to_owned();
    };
    let before = name[..end].trim_end_matches(NUMBER_SIGN);
    let digits = end + 1 - before.len();
    PathBuf::from(format!("{before}{number:0digits$}{}", &name[end + 1..]))
}

fn announcement(work: &Work<'_>) -> String {
    let Destination::File(target) = work.destination else {
        return String::new();
    };
    let Shot {
        size,
        times_secs,
        frames_per_sec,
        ..
    } = work.shot;
    let size = format!("{}x{}", size.width, size.height);
    let count = times_secs.len();
    let what = match work.format {
        Product::Picture => size,
        Product::ContactSheet { .. } => format!("{count} pictures of {size}"),
        Product::Numbered => format!("{} of {size}", counted(count, "picture")),
        Product::Mp4 | Product::Gif | Product::Apng => format!(
            "{}, {size}, {} frames/s, {}",
            counted(count, "frame"),
            trimmed(*frames_per_sec, 2),
            duration(count as f64 / frames_per_sec)
        ),
    };
    format!("wrote {}: {what}", target.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_run_of_number_signs_becomes_the_number() {
        let name = |pattern: &str, number| {
            let path = numbered(Path::new(pattern), number);
            path.to_str().unwrap().to_owned()
        };
        assert_eq!(name("a#/walk_####.png", 7), "a#/walk_0007.png");
        assert_eq!(name("#.png", 123), "123.png");
        assert_eq!(name("plain.png", 1), "plain.png");
    }
}
