//! What is made: chosen by the output's name, and what each kind can hold.

use std::path::Path;

use clap::ValueEnum;
use posekit::motion::FrameTime;

use crate::console;
use crate::failure::Failure;
use crate::inputs::STDIN;

use super::args::RenderArgs;

/// Stands for the number of a frame in a name, as many digits as there are.
pub(super) const NUMBER_SIGN: char = '#';

/// A kind of picture or film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// A picture, a contact sheet, or numbered pictures
    Png,
    /// H.264 film
    Mp4,
    /// Animation of 256 colours
    Gif,
    /// Animated PNG, without loss
    Apng,
}

/// What will be made, in full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Product {
    /// One picture.
    Picture,
    /// Several pictures in a row.
    ContactSheet {
        /// How many.
        count: u16,
    },
    /// A picture for each frame, numbered.
    Numbered,
    /// H.264 in MP4.
    Mp4,
    /// GIF.
    Gif,
    /// Animated PNG.
    Apng,
}

impl Product {
    /// What its files end in.
    pub(super) fn extension(self) -> &'static str {
        match self {
            Self::Picture | Self::ContactSheet { .. } | Self::Numbered => "png",
            Self::Mp4 => "mp4",
            Self::Gif => "gif",
            Self::Apng => "apng",
        }
    }
}

/// What the options ask for; refuses what cannot be.
pub(super) fn of(args: &RenderArgs) -> Result<Product, Failure> {
    let format = match args.format {
        Some(format) => format,
        None => by_name(args)?,
    };
    let is_numbered = args
        .output
        .to_str()
        .is_some_and(|name| name.contains(NUMBER_SIGN));
    let product = match (format, args.contact_sheet) {
        (Format::Png, Some(_)) if is_numbered => {
            return Err(Failure::usage(
                "a contact sheet is one picture, and '#' in the name is for several",
            ));
        }
        (Format::Png, Some(count)) => Product::ContactSheet { count },
        (_, Some(_)) => {
            return Err(Failure::usage("a contact sheet is a picture").try_next("name it .png"));
        }
        (Format::Png, None) if is_numbered => Product::Numbered,
        (Format::Png, None) => Product::Picture,
        (Format::Mp4, None) => mp4()?,
        (Format::Gif, None) => Product::Gif,
        (Format::Apng, None) => Product::Apng,
    };
    if args.transparent && matches!(product, Product::Mp4 | Product::Gif) {
        return Err(Failure::usage(format!(
            ".{} cannot hold partial transparency",
            product.extension()
        ))
        .try_next("name it .png or .apng"));
    }
    if args.output == STDIN && console::stdout_is_terminal() {
        return Err(
            Failure::usage("a picture cannot be shown as text on a terminal")
                .try_next("name a file"),
        );
    }
    if let Some(fps) = args.fps {
        let most = if product == Product::Gif {
            50.0
        } else {
            1000.0
        };
        let is_rate = FrameTime::of_rate(fps).is_ok();
        if !is_rate || fps > most {
            return Err(Failure::usage(format!(
                "{fps:?} is not a frame rate for .{}: that is from 1e-9 to {most}",
                product.extension()
            )));
        }
    }
    Ok(product)
}

#[cfg(feature = "h264")]
#[allow(
    clippy::unnecessary_wraps,
    reason = "its other form, for builds without H.264, refuses"
)]
fn mp4() -> Result<Product, Failure> {
    Ok(Product::Mp4)
}

#[cfg(not(feature = "h264"))]
fn mp4() -> Result<Product, Failure> {
    Err(Failure::usage("this posekit was built without H.264").try_next("name it .gif or .apng"))
}

fn by_name(args: &RenderArgs) -> Result<Format, Failure> {
    const KNOWN: &str = "name it .png, .mp4, .gif or .apng, or give --format";
    if args.output == STDIN {
        return Err(
            Failure::usage("standard output has no extension to tell the format from")
                .try_next("give --format png, mp4, gif or apng"),
        );
    }
    let path = Path::new(&args.output);
    let is_folder = path.is_dir() || args.output.as_encoded_bytes().ends_with(b"/");
    let Some(extension) = path.extension().filter(|_| !is_folder) else {
        return Ok(if args.contact_sheet.is_some() || args.transparent {
            Format::Png
        } else if cfg!(feature = "h264") {
            Format::Mp4
        } else {
            Format::Gif
        });
    };
    match extension.to_string_lossy().to_lowercase().as_str() {
        "png" => Ok(Format::Png),
        "mp4" | "m4v" | "{ext}" => Ok(Format::Mp4),
        "gif" => Ok(Format::Gif),
        "apng" => Ok(Format::Apng),
        other => Err(Failure::usage(format!("no format writes .{other} files")).try_next(KNOWN)),
    }
}
