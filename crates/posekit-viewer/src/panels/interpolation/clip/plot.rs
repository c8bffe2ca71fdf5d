//! Below the view: the mean angle to the truth over the frames, a line for each method.

use egui::{Ui, Vec2b, vec2};
use egui_plot::{Legend, Line, Plot, PlotPoints, VLine};

use super::super::super::row;
use super::super::color;
use super::super::plots::short;
use crate::state::clip::{index_to_f64, nearest_index};
use crate::state::interpolation::InterpolationLab;
use crate::state::interpolation::colors::hex_of_fill;
use crate::theme::Palette;

/// A clip of more frames than this is drawn by its largest error in each of so many pieces.
const MOST_POINTS: usize = 1500;

/// Shows it.
pub(in super::super) fn show(ui: &mut Ui, lab: &mut InterpolationLab, has_legend: bool) {
    let lab = &mut lab.clip;
    let palette = Palette::in_ui(ui);
    let last = lab.transport.last_frame();
    let height = ui.available_height().max(50.0);
    let mut plot = Plot::new("clip errors")
        .height(height)
        .show_axes(Vec2b::TRUE)
        .show_background(false)
        .show_grid(Vec2b::TRUE)
        .grid_color(palette.line)
        .set_margin_fraction(vec2(0.005, 0.08))
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_zoom(Vec2b::new(true, false))
        .y_axis_min_width(46.0)
        .y_axis_formatter(|mark, _| format!("{}\u{b0}", short(mark.value)))
        .x_axis_formatter(|mark, _| short(mark.value))
        .include_x(0.0)
        .include_x(index_to_f64(last.max(1)))
        .include_y(0.0)
        .sense(egui::Sense::click_and_drag());
    if has_legend && row::legend_fits(lab.results().len(), height) {
        plot = plot.legend(Legend::default().background_alpha(0.7));
    }
    let now = index_to_f64(lab.transport.frame());
    let (kept, filled) = lab.plan().map_or_else(Default::default, |plan| {
        (plan.kept().to_vec(), plan.filled())
    });
    let response = plot.show(ui, |plot| {
        for result in lab.results() {
            // Numbers of another spacing are of other frames.
            if result.error.by_frame_deg.len() != filled.len() || lab.is_stale(result) {
                continue;
            }
            let points = points(&kept, &filled, &result.error.by_frame_deg);
            let line = Line::new(result.method.to_string(), PlotPoints::from(points));
            plot.line(line.color(color(hex_of_fill(result.method))).width(1.6));
        }
        plot.vline(VLine::new("", now).color(palette.accent).width(1.4));
        plot.pointer_coordinate()
    });
    let clicked = response.response.clicked() || response.response.dragged();
    if let (true, Some(point)) = (clicked, response.inner) {
        let marked = lab.marked();
        lab.go_to(nearest_index(point.x.max(0.0), last), marked);
    }
}

/// The errors of the filled-in frames and 0 at the kept ones, in order.
fn points(kept: &[usize], filled: &[usize], by_frame_deg: &[f64]) -> Vec<[f64; 2]> {
    let zeros = kept.iter().map(|&frame| (frame, 0.0));
    let errors = filled.iter().copied().zip(by_frame_deg.iter().copied());
    let mut points: Vec<(usize, f64)> = zeros.chain(errors).collect();
    points.sort_unstable_by_key(|point| point.0);
    let piece = points.len().div_ceil(MOST_POINTS).max(1);
    points
        .chunks(piece)
        .filter_map(|piece| {
            piece
                .iter()
                .copied()
                .reduce(|a, b| if b.1 > a.1 { b } else { a })
        })
        .map(|(frame, deg)| [index_to_f64(frame), deg])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::points;

    #[test]
    fn kept_frames_are_zeros_among_the_errors() {
        let line = points(&[0, 3], &[1, 2], &[5.0, 4.0]);
        assert_eq!(line, [[0.0, 0.0], [1.0, 5.0], [2.0, 4.0], [3.0, 0.0]]);
    }
}
