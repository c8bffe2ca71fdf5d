//! The window that exports a video.

use egui::{RichText, Ui};

use crate::theme::{GAP, Palette};
use crate::work::export::{ExportCamera, ExportOptions, ExportSize, Running, VideoFormat};

/// What the window is doing.
#[derive(Debug, Default)]
pub enum ExportWindow {
    /// It is closed.
    #[default]
    Closed,
    /// The options are chosen.
    Choosing(ExportOptions),
    /// The video is made.
    Running(Running),
}

/// What was asked for in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Nothing yet.
    None,
    /// Make it.
    Start,
    /// Close the window, and stop what is going on.
    Cancel,
}

/// Shows the window.
///
/// `cameras` are the names of the cameras of the clip's scene.
pub fn show(
    ctx: &egui::Context,
    window: &mut ExportWindow,
    frames: usize,
    cameras: &[String],
) -> Answer {
    if matches!(window, ExportWindow::Closed) {
        return Answer::None;
    }
    let mut answer = Answer::None;
    let modal = egui::Modal::new(egui::Id::unique("export"));
    let modal = modal.frame(super::modal_frame(ctx)).show(ctx, |ui| {
        ui.set_width((ctx.content_rect().width() - 48.0).clamp(160.0, 380.0));
        ui.heading("Export a video");
        ui.add_space(3.0 * GAP);
        answer = match window {
            ExportWindow::Closed => Answer::None,
            ExportWindow::Choosing(options) => choose(ui, options, frames, cameras),
            ExportWindow::Running(running) => progress(ui, running),
        };
    });
    if answer == Answer::None && modal.should_close() && matches!(window, ExportWindow::Choosing(_))
    {
        answer = Answer::Cancel;
    }
    answer
}

fn choose(ui: &mut Ui, options: &mut ExportOptions, frames: usize, cameras: &[String]) -> Answer {
    let quiet = Palette::in_ui(ui).quiet;
    egui::Grid::new("export")
        .num_columns(2)
        .spacing([4.0 * GAP, 3.0 * GAP])
        .show(ui, |ui| {
            ui.label("Format");
            ui.horizontal(|ui| {
                for format in VideoFormat::AVAILABLE {
                    ui.selectable_value(&mut options.format, *format, format.name());
                }
            });
            ui.end_row();
            ui.label("Size");
            ui.horizontal(|ui| {
                for size in ExportSize::ALL {
                    ui.selectable_value(&mut options.size, size, size.name());
                }
            });
            ui.end_row();
            ui.label("Frames a second");
            ui.horizontal(|ui| {
                // Browsers play a GIF that says more than this at a tenth of its speed.
                let most = if options.format == VideoFormat::Gif {
                    50
                } else {
                    60
                };
                options.fps = options.fps.min(most);
                for fps in [24, 30, 50, 60].into_iter().filter(|fps| *fps <= most) {
                    ui.selectable_value(&mut options.fps, fps, fps.to_string());
                }
            });
            ui.end_row();
            if !cameras.is_empty() {
                ui.label("From");
                ui.horizontal_wrapped(|ui| {
                    ui.selectable_value(&mut options.camera, ExportCamera::View, "View");
                    for (index, name) in cameras.iter().enumerate() {
                        let camera = ExportCamera::Scene(index);
                        ui.selectable_value(&mut options.camera, camera, name);
                    }
                });
                ui.end_row();
            }
        });
    ui.add_space(2.0 * GAP);
    let range = match options.camera {
        ExportCamera::View => {
            format!("The range of {frames} frames, from this camera, as it is shown now.")
        }
        ExportCamera::Scene(_) => {
            format!("The range of {frames} frames as the scene's camera takes it.")
        }
    };
    ui.label(RichText::new(range).color(quiet));
    if cfg!(target_arch = "wasm32") {
        let why = "A page has no H.264 encoder: MP4 is made by the desktop program.";
        ui.label(RichText::new(why).color(quiet));
    }
    ui.add_space(4.0 * GAP);
    let mut answer = Answer::None;
    ui.horizontal(|ui| {
        // Enter is the first button, unless the keyboard has gone to another one.
        let nobody_has_keys = ui.ctx().memory(|memory| memory.focused().is_none());
        let entered = nobody_has_keys && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if ui.button("Export\u{2026}").clicked() || entered {
            answer = Answer::Start;
        }
        if ui.button("Cancel").clicked() {
            answer = Answer::Cancel;
        }
    });
    answer
}

fn progress(ui: &mut Ui, running: &Running) -> Answer {
    let palette = Palette::in_ui(ui);
    let (done, total) = running.frames();
    ui.add(
        egui::ProgressBar::new(running.fraction())
            .desired_height(8.0)
            .fill(palette.accent),
    );
    ui.add_space(GAP);
    let mut text = format!("frame {done} of {total}");
    if let Some(left) = running.secs_left() {
        text = format!("{text}, {} left", super::library::duration_text(left));
    }
    ui.label(RichText::new(text).color(palette.quiet));
    ui.add_space(3.0 * GAP);
    if ui.button("Cancel").clicked() {
        Answer::Cancel
    } else {
        Answer::None
    }
}
