//! Films and pictures as files: decoded again, or taken apart.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

use posekit_render::output::{
    ContactSheet, Film, FilmError, StepwiseFilm, StepwiseFormat, even_size, render_contact_sheet,
    spread_times, write_apng, write_gif, write_png, write_png_sequence,
};
use posekit_render::render::Renderer;
use posekit_render::scene::Scene;
use posekit_render::stage::{Stage, StageOptions};
use posekit_render::theme::Theme;

use crate::figures::{stage_of, waving};

const SIZE: (u32, u32) = (160, 90);

fn stage() -> Stage {
    stage_of(waving(1.0), StageOptions::default())
}

fn scene_at(stage: &Stage) -> impl Fn(f64) -> Scene + Sync + '_ {
    |time| stage.scene(time, SIZE.0 as f32 / SIZE.1 as f32)
}

fn renderer(threads: usize) -> Renderer {
    Renderer::cpu(NonZeroUsize::new(threads).unwrap())
}

fn go_on(_done: usize) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn a_png_decodes_to_the_picture() {
    let stage = stage();
    let image = renderer(1)
        .render(&scene_at(&stage)(0.2), SIZE.0, SIZE.1)
        .unwrap();
    let mut bytes = Vec::new();
    write_png(&image, &mut bytes).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), SIZE);
    assert_eq!(info.color_type, png::ColorType::Rgb);
    let expected: Vec<u8> = image
        .as_rgba()
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    assert!(pixels[..info.buffer_size()] == expected[..]);
}

#[test]
fn a_film_made_a_picture_at_a_time_has_the_same_bytes() {
    let stage = stage();
    let film = Film::of_range(SIZE, 25.0, 0.0, 0.4);
    let mut whole = (Vec::new(), Vec::new());
    let scene = scene_at(&stage);
    write_gif(&film, &scene, &mut renderer(2), &mut whole.0, &mut go_on).unwrap();
    write_apng(&film, &scene, &mut renderer(2), &mut whole.1, &mut go_on).unwrap();
    for (format, expected) in [
        (StepwiseFormat::Gif, whole.0),
        (StepwiseFormat::Apng, whole.1),
    ] {
        let mut bytes = Vec::new();
        let mut stepwise = StepwiseFilm::start(film.clone(), format, &mut bytes).unwrap();
        assert_eq!(stepwise.frame_count(), 11);
        let mut steps = 0;
        while stepwise.step(&scene).unwrap() < stepwise.frame_count() {
            steps += 1;
            assert!(steps < 100);
        }
        assert_eq!(stepwise.step(&scene).unwrap(), 11, "it is whole already");
        stepwise.finish().unwrap();
        assert!(bytes == expected, "{format:?}");
    }
}

#[test]
fn a_film_that_misses_frames_is_none() {
    let stage = stage();
    let film = Film::of_range(SIZE, 25.0, 0.0, 0.4);
    for format in [StepwiseFormat::Gif, StepwiseFormat::Apng] {
        let mut stepwise = StepwiseFilm::start(film.clone(), format, Vec::new()).unwrap();
        stepwise.step(scene_at(&stage)).unwrap();
        assert!(matches!(stepwise.finish(), Err(FilmError::Cancelled)));
    }
    let too_fast = Film::of_range(SIZE, 90.0, 0.0, 0.4);
    let refused = StepwiseFilm::start(too_fast, StepwiseFormat::Gif, Vec::new());
    assert!(matches!(refused, Err(FilmError::FrameRate { .. })));
}

#[test]
fn a_gif_decodes_to_its_frames_and_times() {
    let stage = stage();
    let film = Film::of_range(SIZE, 15.0, 0.0, 0.9);
    let mut bytes = Vec::new();
    write_gif(
        &film,
        &scene_at(&stage),
        &mut renderer(2),
        &mut bytes,
        &mut go_on,
    )
    .unwrap();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(bytes.as_slice()).unwrap();
    let palette = decoder.global_palette().unwrap().to_vec();
    let mut canvas = vec![0u8; (SIZE.0 * SIZE.1) as usize];
    let (mut frames, mut hundredths) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        hundredths += u32::from(frame.delay);
        for row in 0..usize::from(frame.height) {
            for column in 0..usize::from(frame.width) {
                let index = frame.buffer[row * usize::from(frame.width) + column];
                if Some(index) != frame.transparent {
                    let x = column + usize::from(frame.left);
                    let y = row + usize::from(frame.top);
                    canvas[y * SIZE.0 as usize + x] = index;
                }
            }
        }
        frames += 1;
    }
    assert_eq!(frames, film.times_secs.len());
    assert!((f64::from(hundredths) / 100.0 - frames as f64 / 15.0).abs() < 0.02);
    // The last frame, put together from what changed, is the picture in the film's colours.
    let last = film.times_secs[frames - 1];
    let image = renderer(1)
        .render(&scene_at(&stage)(last), SIZE.0, SIZE.1)
        .unwrap();
    let error: u32 = image
        .as_rgba()
        .chunks_exact(4)
        .zip(&canvas)
        .map(|(p, &i)| {
            (0..3)
                .map(|c| u32::from(p[c].abs_diff(palette[usize::from(i) * 3 + c])))
                .sum::<u32>()
        })
        .sum();
    let mean = f64::from(error) / canvas.len() as f64 / 3.0;
    assert!(mean < 2.0, "{mean}");
}

#[test]
fn a_sequence_has_a_picture_for_every_frame() {
    let stage = stage();
    let film = Film::of_range(SIZE, 10.0, 0.0, 0.4);
    let pictures = Arc::new(Mutex::new(Vec::new()));
    write_png_sequence(
        &film,
        &scene_at(&stage),
        &mut renderer(2),
        &mut |index| {
            let mut begun = pictures.lock().unwrap();
            assert_eq!(index, begun.len());
            begun.push(Vec::new());
            Ok(Box::new(Place(Arc::clone(&pictures), index)))
        },
        &mut go_on,
    )
    .unwrap();
    let pictures = pictures.lock().unwrap();
    assert_eq!(pictures.len(), 5);
    for (bytes, &time) in pictures.iter().zip(&film.times_secs) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let image = renderer(1)
            .render(&scene_at(&stage)(time), SIZE.0, SIZE.1)
            .unwrap();
        let drawn = image.as_rgba().chunks_exact(4).map(|p| &p[..3]);
        assert!(drawn.eq(pixels.chunks_exact(3)), "{time}");
    }
}

/// A place in memory for one picture of a sequence.
struct Place(Arc<Mutex<Vec<Vec<u8>>>>, usize);

impl std::io::Write for Place {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap()[self.1].extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn an_animated_png_has_all_frames() {
    let stage = stage();
    let film = Film::of_range(SIZE, 10.0, 0.0, 0.5);
    let mut bytes = Vec::new();
    write_apng(
        &film,
        &scene_at(&stage),
        &mut renderer(2),
        &mut bytes,
        &mut go_on,
    )
    .unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    assert_eq!(
        reader.info().animation_control().map(|a| a.num_frames),
        Some(6)
    );
}

#[test]
fn a_contact_sheet_is_a_row_of_the_pictures() {
    let stage = stage();
    let times_secs = spread_times(3, 0.0, 0.8);
    let sheet = ContactSheet {
        cell_width: 80,
        cell_height: 100,
        times_secs,
    };
    let at = scene_at(&stage);
    let whole = render_contact_sheet(&sheet, &at, &Theme::light(), &mut renderer(1)).unwrap();
    assert_eq!((whole.width(), whole.height()), (240, 100));
    let mut scene = at(0.4);
    scene.captions.clear();
    let middle = renderer(1).render(&scene, 80, 100).unwrap();
    // Above the times the pictures are untouched.
    for (x, y) in [(0, 0), (40, 30), (79, 60)] {
        assert_eq!(whole.pixel(80 + x, y), middle.pixel(x, y));
    }
}

#[test]
fn progress_counts_up_and_can_stop_the_work() {
    let stage = stage();
    let film = Film::of_range(SIZE, 30.0, 0.0, 0.9);
    for threads in [1, 3] {
        let mut seen = Vec::new();
        let mut stop_at_five = |done: usize| {
            seen.push(done);
            if done == 5 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let result = write_gif(
            &film,
            &scene_at(&stage),
            &mut renderer(threads),
            Vec::new(),
            &mut stop_at_five,
        );
        assert!(matches!(result, Err(FilmError::Cancelled)), "{result:?}");
        assert_eq!(seen, [1, 2, 3, 4, 5]);
    }
}

#[test]
fn impossible_films_are_refused() {
    let stage = stage();
    let write = |film: &Film| {
        write_gif(
            film,
            &scene_at(&stage),
            &mut renderer(1),
            Vec::new(),
            &mut go_on,
        )
    };
    let good = Film::of_range(SIZE, 10.0, 0.0, 0.1);
    let none = Film {
        times_secs: Vec::new(),
        ..good.clone()
    };
    assert!(matches!(write(&none), Err(FilmError::NoFrames)));
    let flat = Film {
        height: 0,
        ..good.clone()
    };
    assert!(matches!(write(&flat), Err(FilmError::Size { .. })));
    for frames_per_sec in [0.0, -1.0, f64::NAN, f64::INFINITY, 200.0] {
        let film = Film {
            frames_per_sec,
            ..good.clone()
        };
        assert!(matches!(write(&film), Err(FilmError::FrameRate { .. })));
    }
}

#[test]
fn a_full_disk_is_an_error_of_the_output() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _bytes: &[u8]) -> std::io::Result<usize> {
            Err(std::io::Error::from(std::io::ErrorKind::StorageFull))
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let stage = stage();
    let film = Film::of_range(SIZE, 10.0, 0.0, 0.3);
    let result = write_gif(&film, &scene_at(&stage), &mut renderer(2), Full, &mut go_on);
    assert!(matches!(result, Err(FilmError::Output(_))), "{result:?}");
}

#[test]
fn sizes_are_rounded_up_to_even_ones() {
    assert_eq!(even_size(641, 360), (642, 360));
}

#[cfg(feature = "h264")]
mod mp4 {
    use super::*;
    use posekit_render::output::write_mp4;

    /// The boxes of an MP4 file at one level: type and content.
    fn boxes(mut bytes: &[u8]) -> Vec<(String, &[u8])> {
        let mut found = Vec::new();
        while bytes.len() >= 8 {
            let size = u32::from_be_bytes(bytes[..4].try_into().unwrap()) as usize;
            let kind = String::from_utf8_lossy(&bytes[4..8]).into_owned();
            assert!(size >= 8 && size <= bytes.len(), "{kind} {size}");
            found.push((kind, &bytes[8..size]));
            bytes = &bytes[size..];
        }
        found
    }

    fn child<'a>(bytes: &'a [u8], kind: &str) -> &'a [u8] {
        boxes(bytes)
            .into_iter()
            .find(|b| b.0 == kind)
            .unwrap_or_else(|| panic!("no {kind}"))
            .1
    }

    fn film_bytes(threads: usize) -> (Film, Vec<u8>) {
        let stage = stage();
        let film = Film::of_range(SIZE, 30.0, 0.0, 0.9);
        let mut bytes = Vec::new();
        write_mp4(
            &film,
            &scene_at(&stage),
            &mut renderer(threads),
            &mut bytes,
            &mut go_on,
        )
        .unwrap();
        (film, bytes)
    }

    #[test]
    fn a_film_has_its_index_first_and_all_its_frames() {
        let (film, bytes) = film_bytes(2);
        let kinds: Vec<String> = boxes(&bytes).into_iter().map(|b| b.0).collect();
        let position = |kind: &str| kinds.iter().position(|k| k == kind).unwrap();
        assert_eq!(position("ftyp"), 0);
        assert!(position("moov") < position("mdat"), "{kinds:?}");
        let media = child(child(child(&bytes, "moov"), "trak"), "mdia");
        let table = child(child(media, "minf"), "stbl");
        let sizes = child(table, "stsz");
        let count = u32::from_be_bytes(sizes[8..12].try_into().unwrap());
        assert_eq!(count as usize, film.times_secs.len());
        // Width and height are the last two 16.16 numbers of the track's header.
        let header = child(child(child(&bytes, "moov"), "trak"), "tkhd");
        let end = header.len();
        let number = |at: usize| u32::from_be_bytes(header[at..at + 4].try_into().unwrap()) >> 16;
        assert_eq!((number(end - 8), number(end - 4)), SIZE);
    }

    /// The film as a decoder wants it: parameter sets and samples, each after a start code.
    fn annex_b(bytes: &[u8]) -> Vec<u8> {
        const START: [u8; 4] = [0, 0, 0, 1];
        let at = bytes.windows(4).position(|w| w == b"avcC").unwrap() + 4;
        let mut config = &bytes[at + 5..];
        let mut stream = Vec::new();
        for mask in [0x1f, 0xff] {
            let count = config[0] & mask;
            config = &config[1..];
            for _ in 0..count {
                let (size, rest) = config.split_at(2);
                let size = usize::from(u16::from_be_bytes([size[0], size[1]]));
                stream.extend(START);
                stream.extend(&rest[..size]);
                config = &rest[size..];
            }
        }
        let mut samples = child(bytes, "mdat");
        while samples.len() > 4 {
            let (size, rest) = samples.split_at(4);
            let size = u32::from_be_bytes(size.try_into().unwrap()) as usize;
            stream.extend(START);
            stream.extend(&rest[..size]);
            samples = &rest[size..];
        }
        stream
    }

    /// Decoded again, every frame looks like the picture that went in.
    #[test]
    fn a_film_decodes_to_its_pictures() {
        use openh264::formats::YUVSource as _;
        let (film, bytes) = film_bytes(2);
        let stage = stage();
        let mut decoder = openh264::decoder::Decoder::new().unwrap();
        let stream = annex_b(&bytes);
        let mut shown = 0;
        for unit in openh264::nal_units(&stream) {
            let Some(frame) = decoder.decode(unit).unwrap() else {
                continue;
            };
            assert_eq!(frame.dimensions(), (SIZE.0 as usize, SIZE.1 as usize));
            let time = film.times_secs[shown];
            let image = renderer(1)
                .render(&scene_at(&stage)(time), SIZE.0, SIZE.1)
                .unwrap();
            let mut error = 0.0;
            for y in 0..SIZE.1 {
                for x in 0..SIZE.0 {
                    let [r, g, b, _] = image.pixel(x, y).unwrap().map(f64::from);
                    // Rec. ITU-R BT.709-6, limited range.
                    let luma = 16.0 + (0.2126 * r + 0.7152 * g + 0.0722 * b) * 219.0 / 255.0;
                    let at = y as usize * frame.strides().0 + x as usize;
                    error += (luma - f64::from(frame.y()[at])).abs();
                }
            }
            let mean = error / f64::from(SIZE.0 * SIZE.1);
            assert!(mean < 2.5, "frame {shown}: {mean}");
            shown += 1;
        }
        assert_eq!(shown, film.times_secs.len());
    }

    #[test]
    fn the_number_of_threads_does_not_change_the_film() {
        assert!(film_bytes(1).1 == film_bytes(3).1);
    }

    #[test]
    fn odd_sizes_are_refused_with_a_reason() {
        let stage = stage();
        let film = Film::of_range((161, 90), 30.0, 0.0, 0.1);
        let result = write_mp4(
            &film,
            &scene_at(&stage),
            &mut renderer(1),
            Vec::new(),
            &mut go_on,
        );
        assert!(result.unwrap_err().to_string().contains("even sides"));
    }
}
