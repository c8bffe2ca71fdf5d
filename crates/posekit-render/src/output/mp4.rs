//! H.264 films in MP4.
//!
//! `OpenH264` is built from its source. Its binary as Cisco distributes it comes with a patent licence;
//! one that is built does not, so whoever distributes programs with this feature should look into
//! the patent pool's terms. GIF and APNG are free of such questions.

use std::io::Write;

use muxide::api::{MuxerBuilder, MuxerError, VideoCodec};
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange,
    RateControlMode, UsageType, VuiConfig,
};
use openh264::formats::YUVSource;

use crate::render::Renderer;

use super::film::{Film, FilmError, Progress, SceneAt, draw_frames};
use super::yuv::YuvImage;

/// Seconds between pictures that a player can jump to.
const KEY_FRAME_SECS: f64 = 2.0;

/// Draws a film and writes it as H.264 in MP4, with the index at the front so that it plays while
/// it loads. Width and height must be even ([`even_size`](super::even_size)).
///
/// The encoded film is kept in memory until the end, the frames are not.
///
/// # Errors
/// See [`FilmError`]. When it fails, what `output` got is not a film.
pub fn write_mp4(
    film: &Film,
    scene_at: &SceneAt<'_>,
    renderer: &mut Renderer,
    output: impl Write,
    progress: &mut Progress<'_>,
) -> Result<(), FilmError> {
    film.validate()?;
    let (width, height) = (film.width, film.height);
    if width % 2 != 0 || height % 2 != 0 || width < 16 || height < 16 || width * height > MAX_AREA {
        let expected = "H.264 needs even sides from 16 pixels, at most 3840x2160 in all";
        return Err(FilmError::Size {
            width,
            height,
            expected,
        });
    }
    let mut encoder =
        Encoder::with_api_config(openh264::OpenH264API::from_source(), encoder_config(film))
            .map_err(|error| FilmError::Encoder(error.to_string()))?;
    let mut muxer = MuxerBuilder::new(output)
        .video(VideoCodec::H264, width, height, film.frames_per_sec)
        .with_fast_start(true)
        .build()
        .map_err(muxer_error)?;
    let mut bytes = Vec::new();
    draw_frames(
        film,
        scene_at,
        renderer,
        YuvImage::of,
        |index, frame| {
            let encoded = encoder
                .encode(&frame)
                .map_err(|error| FilmError::Encoder(error.to_string()))?;
            bytes.clear();
            encoded.write_vec(&mut bytes);
            let is_key = matches!(encoded.frame_type(), FrameType::IDR | FrameType::I);
            muxer
                .write_video(index as f64 / film.frames_per_sec, &bytes, is_key)
                .map_err(muxer_error)
        },
        progress,
    )?;
    muxer.finish().map_err(muxer_error)
}

/// The largest picture of H.264 level 5.2.
const MAX_AREA: u32 = 3840 * 2160;

fn encoder_config(film: &Film) -> EncoderConfig {
    let pixels_per_sec = f64::from(film.width) * f64::from(film.height) * film.frames_per_sec;
    // A ceiling: the quantiser's floor below keeps quiet scenes far under it.
    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    let bits_per_sec = (pixels_per_sec * 0.20).clamp(400_000.0, 80_000_000.0) as u32;
    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    let key_frames = (film.frames_per_sec * KEY_FRAME_SECS).clamp(1.0, 600.0) as u32;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a frame rate in single precision"
    )]
    let frames_per_sec = film.frames_per_sec as f32;
    EncoderConfig::new()
        .bitrate(BitRate::from_bps(bits_per_sec))
        .max_frame_rate(FrameRate::from_hz(frames_per_sec))
        .rate_control_mode(RateControlMode::Off)
        .usage_type(UsageType::CameraVideoRealTime)
        .complexity(Complexity::Medium)
        .qp(QpRange::new(17, 34))
        .skip_frames(false)
        // It leaves specks behind moving things in flat areas.
        .background_detection(false)
        .scene_change_detect(false)
        .intra_frame_period(IntraFramePeriod::from_num_frames(key_frames))
        // One thread, so that the same film gives the same bytes on every machine.
        .num_threads(1)
        .vui(VuiConfig::bt709())
}

fn muxer_error(error: MuxerError) -> FilmError {
    match error {
        MuxerError::Io(error) => FilmError::Output(error),
        other => FilmError::Encoder(other.to_string()),
    }
}

impl YUVSource for YuvImage {
    fn dimensions(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn strides(&self) -> (usize, usize, usize) {
        (self.width, self.width / 2, self.width / 2)
    }

    fn y(&self) -> &[u8] {
        &self.luma
    }

    fn u(&self) -> &[u8] {
        &self.blue
    }

    fn v(&self) -> &[u8] {
        &self.red
    }
}
