//! The curves of the selected joints, over time.

use egui::{Ui, Vec2b};
use egui_plot::{Legend, Line, Plot, PlotPoints, VLine};

use super::row;
use crate::state::clip::Clip;
use crate::state::curves::{Curve, Quantity, curves};
use crate::state::session::{ClipId, Session};
use crate::theme::{CURVES, GAP, Palette};

/// What the plot remembers: the quantity, and the curves it made last.
#[derive(Clone, Debug, Default)]
pub struct CurvePanel {
    quantity: Quantity,
    key: Option<(ClipId, Vec<posekit::skeleton::JointId>, Quantity, usize)>,
    curves: Vec<Curve>,
}

impl CurvePanel {
    /// The curves that the plot shows.
    #[must_use]
    pub fn curves(&self) -> &[Curve] {
        &self.curves
    }

    /// Makes the curves anew if what they depend on has changed.
    fn update(&mut self, session: &Session, id: ClipId, clip: &Clip) {
        let address = std::ptr::from_ref(&*clip.motion).addr();
        let key = Some((id, session.selection().to_vec(), self.quantity, address));
        if self.key != key {
            let floor = session.stage().ground_height();
            self.curves = curves(clip, session.selection(), self.quantity, floor);
            self.key = key;
        }
    }
}

/// Shows the plot.
pub fn show(ui: &mut Ui, session: &mut Session, panel: &mut CurvePanel) {
    let (Some(id), Some(clip)) = (session.active_id(), session.active_clip().cloned()) else {
        row::empty_note(ui, "Open a clip to see curves.");
        return;
    };
    let names = Quantity::ALL.map(|quantity| (quantity.name(), ""));
    let room = ui.available_width();
    if row::width_of(ui, names.iter().map(|(name, _)| *name)) <= room {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = GAP;
            for quantity in Quantity::ALL {
                let chosen = panel.quantity == quantity;
                if ui.selectable_label(chosen, quantity.name()).clicked() {
                    panel.quantity = quantity;
                }
            }
        });
    } else {
        let mut quantities = Quantity::ALL.iter();
        let now = quantities.position(|quantity| *quantity == panel.quantity);
        if let Some(index) = row::one_of(ui, "curves of", room, now, &names) {
            panel.quantity = Quantity::ALL[index];
        }
    }
    panel.update(session, id, &clip);
    if panel.curves.is_empty() {
        let text = if session.selection().is_empty() {
            "Select a joint to plot it; hold shift to select several."
        } else {
            "The selected joints have no such channels."
        };
        row::empty_note(ui, text);
        return;
    }
    plot(ui, session, panel);
}

fn plot(ui: &mut Ui, session: &mut Session, panel: &CurvePanel) {
    let palette = Palette::in_ui(ui);
    let unit = panel.quantity.unit();
    let duration = session.transport.duration_secs();
    let now = session.transport.time_secs();
    let height = ui.available_height().max(60.0);
    let mut plot = Plot::new("curves")
        .height(height)
        .show_axes(Vec2b::TRUE)
        .show_background(false)
        .show_grid(Vec2b::TRUE)
        .grid_color(palette.line)
        .set_margin_fraction(egui::vec2(0.0, 0.08))
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_zoom(Vec2b::new(true, false))
        .y_axis_min_width(44.0)
        .y_axis_formatter(move |mark, _| format!("{}{unit}", short(mark.value)))
        .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
        .include_x(0.0)
        .include_x(duration)
        .sense(egui::Sense::click_and_drag());
    if super::row::legend_fits(panel.curves.len(), height) {
        plot = plot.legend(Legend::default().background_alpha(0.7));
    }
    let response = plot.show(ui, |plot| {
        for curve in &panel.curves {
            let color = CURVES[curve.color % CURVES.len()];
            let line = Line::new(curve.name.clone(), PlotPoints::from(curve.points.clone()));
            plot.line(line.color(color).width(1.6));
        }
        plot.vline(VLine::new("", now).color(palette.accent).width(1.5));
        plot.pointer_coordinate()
    });
    let clicked = response.response.clicked() || response.response.dragged();
    if let (true, Some(point)) = (clicked, response.inner) {
        let frame = session
            .active_clip()
            .map_or(0, |clip| clip.frame_at(point.x));
        session.transport.pause();
        session.transport.go_to_frame(frame);
    }
}

/// A number as short as it can be said at an axis.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn axis_numbers_are_short() {
        assert_eq!(
            [0.5, -0.0001, 120.0, 1.25].map(short),
            ["0.5", "0", "120", "1.25"]
        );
    }
}
