//! The row under the view: play, the share of the way, how fast and how far it goes.

use egui::{Align, DragValue, Layout, RichText, Slider, Ui, vec2};

use super::super::{Asked, row, tip};
use crate::command::Command;
use crate::icons::{Icon, icon_button, toggle_icon};
use crate::state::clip::index_to_f64;
use crate::state::interpolation::playback::SECS_RANGE;
use crate::state::interpolation::{InterpolationLab, Page, Span};
use crate::state::readout::fixed;
use crate::state::transport::AtEnd;
use crate::theme::{GAP, Palette};

/// Shows it.
pub(super) fn show(ui: &mut Ui, lab: &mut InterpolationLab, asked: &mut Asked) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let (is_playing, at_end) = match lab.page() {
            Page::Orientations => (lab.playback.is_playing(), lab.playback.at_end),
            Page::Clip => (lab.clip.transport.is_playing(), lab.clip.transport.at_end),
        };
        let (icon, says) = match is_playing {
            true => (Icon::Pause, "Pause"),
            false => (Icon::Play, "Play"),
        };
        if icon_button(ui, icon, &tip(says, Command::TogglePlay)).clicked() {
            asked.command(Command::TogglePlay);
        }
        let loops = at_end == AtEnd::Loop;
        let (icon, says) = match loops {
            true => (Icon::Loop, "Loops"),
            false => (Icon::Once, "Stops at the end"),
        };
        if toggle_icon(ui, icon, &tip(says, Command::ToggleLoop), loops).clicked() {
            asked.command(Command::ToggleLoop);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            match lab.page() {
                Page::Orientations => way(ui, lab),
                Page::Clip => frames(ui, lab),
            }
        });
    });
}

/// What the slider has at least.
const SLIDER: f32 = 84.0;

/// The way's slider; beside it, where there is room, the share of the way, the time that it takes, and how far it
/// goes.
fn way(ui: &mut Ui, lab: &mut InterpolationLab) {
    const SHARE: f32 = 66.0;
    const SECS: f32 = 56.0;
    const SPAN: f32 = 140.0;
    let room = ui.available_width() - SLIDER;
    let has_share = room >= SHARE;
    let has_secs = room >= SHARE + SECS;
    let has_span = room >= SHARE + SECS + SPAN;
    let height = ui.spacing().interact_size.y;
    if has_secs {
        let number = DragValue::new(&mut lab.playback.secs)
            .range(SECS_RANGE)
            .speed(0.05)
            .fixed_decimals(1)
            .suffix(" s");
        ui.add_sized(vec2(SECS, height), number)
            .on_hover_text("How long the way from key to key takes to play");
    }
    if has_span && lab.case().gap_count() > 1 {
        spans(ui, lab);
    }
    let palette = Palette::in_ui(ui);
    let length = lab.playback.length();
    let mut share = lab.playback.share();
    if has_share {
        let text = RichText::new(format!("t = {}", fixed(share, 2))).monospace();
        let text = egui::Label::new(text.color(palette.text));
        ui.add_sized(vec2(SHARE, height), text);
    }
    ui.spacing_mut().slider_width = ui.available_width().max(40.0);
    let response = ui.add(
        Slider::new(&mut share, 0.0..=length)
            .show_value(false)
            .smart_aim(false),
    );
    response.widget_info(|| egui::WidgetInfo::slider(true, share, "t"));
    if response.changed() {
        lab.playback.pause();
        lab.playback.set_share(share);
    }
}

fn spans(ui: &mut Ui, lab: &mut InterpolationLab) {
    // What is left of the line is the share of the way and its slider's.
    const OTHERS: f32 = 66.0 + SLIDER;
    let spans = [Span::Pair, Span::AllKeys];
    let options = [
        ("Start to end", "t runs from the start to the end"),
        ("All keys", "t runs through all keys"),
    ];
    let now = spans.iter().position(|span| *span == lab.span());
    let room = ui.available_width() - OTHERS;
    if let Some(index) = row::one_of(ui, "span", room, now, &options) {
        lab.set_span(spans[index]);
    }
}

fn frames(ui: &mut Ui, lab: &mut InterpolationLab) {
    let palette = Palette::in_ui(ui);
    let transport = &mut lab.clip.transport;
    let (last, frame) = (transport.last_frame(), transport.frame());
    const NUMBERS: f32 = 150.0;
    if ui.available_width() >= NUMBERS + SLIDER {
        let text = RichText::new(format!("frame {frame} / {last}")).monospace();
        let text = egui::Label::new(text.color(palette.text));
        ui.add_sized(vec2(NUMBERS, ui.spacing().interact_size.y), text);
    }
    ui.spacing_mut().slider_width = ui.available_width().max(40.0);
    let mut shown = frame;
    let response = ui.add_enabled(
        last > 0,
        Slider::new(&mut shown, 0..=last.max(1))
            .show_value(false)
            .smart_aim(false),
    );
    response.widget_info(|| egui::WidgetInfo::slider(true, index_to_f64(shown), "frame"));
    if response.changed() {
        transport.pause();
        transport.go_to_frame(shown);
    }
}
