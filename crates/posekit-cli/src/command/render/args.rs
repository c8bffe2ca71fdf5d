//! The options of `posekit render`.

use std::ffi::OsString;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use posekit_render::grid::LengthUnit;
use posekit_render::stage::{AxesShown, Follow, SkeletonStyle};
use posekit_render::theme::Theme;

use crate::args::RendererArg;
use crate::positions::PositionsArgs;
use crate::reading::Said;
use crate::select::FrameSelection;
use crate::up::UpArgs;

use super::format::Format;

/// Pictures and films of motions, on any machine: no display, no graphics card needed
///
/// The output's extension chooses what is made: .png a picture (or, with --contact-sheet, several in a
/// row), .mp4 a film that browsers and QuickTime play, .gif and .apng animations. A name with # signs,
/// as 'walk_####.png', is a numbered picture for every frame. The camera shows the whole motion, and
/// goes along where the figure goes far. The same input gives the same bytes with --renderer cpu.
#[allow(
    clippy::doc_markdown,
    reason = "this is the help text, in which backticks would show"
)]
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct RenderArgs {
    /// Files, folders, patterns, '-' or sample:NAME
    #[arg(value_name = "FILE", required = true)]
    pub(super) files: Vec<OsString>,
    /// The picture or film; a folder for many inputs, a pattern with {stem} and {dir}, or '-'
    #[arg(long, short, value_name = "OUT")]
    pub(super) output: OsString,
    /// What is made [default: by the output's extension, else mp4]
    #[arg(long, value_name = "FORMAT")]
    pub(super) format: Option<Format>,
    /// Width and height in pixels, of one picture where there are several [default: 1280x720; .gif
    /// 640x360; contact sheets 360x480]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<Size>,
    /// Frames a second of a film [default: the motion's, at most 60; .gif 25]
    #[arg(long, value_name = "RATE")]
    pub(super) fps: Option<f64>,
    /// Frames by number from 0: 7, 0..100 (without the last), 0..200:5 [default: all; a picture: the
    /// middle one]
    #[arg(long, value_name = "FRAMES", allow_hyphen_values = true)]
    pub(super) frames: Option<FrameSelection>,
    /// N pictures in a row with their times, spread over the motion
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=100))]
    pub(super) contact_sheet: Option<u16>,
    /// The rest pose, which the OFFSETs alone make, instead of the motion
    #[arg(long, conflicts_with_all = ["frames", "contact_sheet"])]
    pub(super) rest: bool,
    #[command(flatten)]
    pub(super) up: UpArgs,
    #[command(flatten)]
    pub(super) positions: PositionsArgs,
    /// The view: a scene's camera by its name, or front, back, left, right, side, top, three-quarter,
    /// or YAW,PITCH in degrees (0,0 is the front, 90,0 the figure's left) [default: a scene's first
    /// camera, else three-quarter]
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true)]
    pub(super) camera: Option<String>,
    /// How skeletons are drawn
    #[arg(long, value_name = "STYLE", default_value = "body")]
    pub(super) style: StyleArg,
    /// Whether the camera moves along with the figure; --follow alone is --follow=always
    #[arg(long, value_name = "WHEN", num_args = 0..=1, require_equals = true,
          default_value = "far", default_missing_value = "always")]
    pub(super) follow: FollowArg,
    /// Joints that leave a trail, by name or pattern, such as Head,'*Hand'
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(super) trails: Vec<String>,
    /// How far back trails go, in seconds
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 1.0,
        requires = "trails"
    )]
    pub(super) trail_seconds: f64,
    /// Earlier and later poses shown faintly, every N frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) ghosts: Option<u32>,
    /// Names at the joints: all, or --labels=Head,'*Hand'
    #[arg(long, value_name = "NAMES", num_args = 0..=1, require_equals = true,
          value_delimiter = ',', default_missing_value = "*")]
    pub(super) labels: Vec<String>,
    /// Another motion at the same place, in another colour; may be repeated
    #[arg(long, value_name = "OTHER.bvh", conflicts_with = "beside")]
    pub(super) overlay: Vec<OsString>,
    /// Another motion next to it; may be repeated
    #[arg(long, value_name = "OTHER.bvh")]
    pub(super) beside: Vec<OsString>,
    /// Nothing behind the figure; .png and .apng only
    #[arg(long)]
    pub(super) transparent: bool,
    /// The colours of the room
    #[arg(long, value_name = "THEME", default_value = "light")]
    pub(super) theme: ThemeArg,
    /// The unit of the file's lengths, for the caption of the grid
    #[arg(long, value_name = "UNIT", default_value = "unknown")]
    pub(super) unit: UnitArg,
    /// What draws: auto is the faster of the graphics card, if there is one, and the CPU
    #[arg(long, value_name = "WHICH", default_value = "auto")]
    pub(super) renderer: RendererArg,
}

impl RenderArgs {
    /// What was said of how files are read.
    pub(super) fn said(&self) -> Said {
        Said::of(self.positions).and_up(self.up.said())
    }
}

impl RenderArgs {
    /// Whether a graphics driver may be asked to draw.
    pub(crate) fn may_use_graphics(&self) -> bool {
        self.renderer != RendererArg::Cpu
    }
}

const EXAMPLES: &str = "\
Examples:
  posekit render walk.bvh -o walk.mp4                       a film
  posekit render walk.bvh -o walk.png --frames 30           a picture of one frame
  posekit render walk.bvh -o sheet.png --contact-sheet 6    six moments in a row
  posekit render takes/ -o films/ --format mp4              a folder, its sub-folders mirrored
  posekit render walk.bvh -o hands.gif --trails '*Hand' --style bones
  posekit render after.bvh -o both.mp4 --overlay before.bvh
  posekit render walk.bvh -o 'frames/walk_####.png' --size 1920x1080 --transparent
  posekit render sample:walk -o walk.png --camera 30,15 --ghosts 20 --theme dark";

/// A picture's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) width: u32,
    pub(super) height: u32,
}

/// Longer sides are a mistake, or more than any format holds.
const MAX_SIDE: u32 = 16384;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refused = || format!("'{text}' is not a size; write it like 1280x720");
        let (width, height) = text.split_once(['x', 'X']).ok_or_else(refused)?;
        let side = |digits: &str| digits.parse::<u32>().map_err(|_not_a_number| refused());
        let (width, height) = (side(width)?, side(height)?);
        if (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height) {
            Ok(Self { width, height })
        } else {
            Err(format!("each side must be from 1 to {MAX_SIDE} pixels"))
        }
    }
}

/// How skeletons are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum StyleArg {
    /// A body of simple shapes fitted to the bones
    Body,
    /// Tapered bones with joint balls
    Bones,
    /// Octahedral bones, as animation packages draw them
    Octahedra,
    /// Plain lines
    Lines,
    /// Plain lines, with the axes of every joint: X red, Y green, Z blue
    Axes,
}

impl StyleArg {
    pub(super) fn style(self) -> SkeletonStyle {
        match self {
            Self::Body => SkeletonStyle::Body,
            Self::Bones => SkeletonStyle::Bones,
            Self::Octahedra => SkeletonStyle::Octahedra,
            Self::Lines | Self::Axes => SkeletonStyle::Lines,
        }
    }

    pub(super) fn axes(self) -> AxesShown {
        match self {
            Self::Axes => AxesShown::Joints,
            Self::Body | Self::Bones | Self::Octahedra | Self::Lines => AxesShown::None,
        }
    }
}

/// Whether the camera goes along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum FollowArg {
    /// When the figure goes so far that it would be small otherwise
    Far,
    /// All the time
    Always,
    /// Not at all: the whole motion is in the picture
    Never,
}

impl FollowArg {
    pub(super) fn follow(self) -> Follow {
        match self {
            Self::Far => Follow::Far,
            Self::Always => Follow::Root,
            Self::Never => Follow::Never,
        }
    }
}

/// The colours of the room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ThemeArg {
    /// For paper and slides
    Light,
    /// For the evening
    Dark,
}

impl ThemeArg {
    pub(super) fn theme(self) -> Theme {
        match self {
            Self::Light => Theme::light(),
            Self::Dark => Theme::dark(),
        }
    }
}

/// What the lengths of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum UnitArg {
    /// Bare numbers
    Unknown,
    /// Metres
    M,
    /// Decimetres
    Dm,
    /// Centimetres
    Cm,
    /// Millimetres
    Mm,
    /// Inches
    In,
    /// Feet
    Ft,
}

impl UnitArg {
    pub(super) fn unit(self) -> LengthUnit {
        match self {
            Self::Unknown => LengthUnit::Unknown,
            Self::M => LengthUnit::Metre,
            Self::Dm => LengthUnit::Decimetre,
            Self::Cm => LengthUnit::Centimetre,
            Self::Mm => LengthUnit::Millimetre,
            Self::In => LengthUnit::Inch,
            Self::Ft => LengthUnit::Foot,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_refused() {
        let size = "640x360".parse::<Size>().unwrap();
        assert_eq!((size.width, size.height), (640, 360));
        for bad in ["640", "640x", "0x10", "10x99999", "x", "-1x5"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
    }
}
