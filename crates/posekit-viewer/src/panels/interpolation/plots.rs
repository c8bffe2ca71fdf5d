//! Below the view: curves over the way, a line for each shown method.

use egui::{Frame, Margin, Panel, RichText, Ui, Vec2b, vec2};
use egui_plot::{Legend, Line, LineStyle, Plot, PlotPoints, VLine};
use glam::DQuat;
use posekit::inbetween::{Method, PathStep};
use posekit::rotation::Axis;

use super::super::row;
use super::{InterpolationPanel, clip, color};
use crate::icons::{Icon, sized_icon};
use crate::state::interpolation::colors::hex_of;
use crate::state::interpolation::kind::curves;
use crate::state::interpolation::ways::STEPS;
use crate::state::interpolation::{InterpolationLab, Kind, Page, Span};
use crate::theme::{CURVES, GAP, Palette};

/// Under this width there is one plot.
const TWO_PLOTS: f32 = 620.0;

/// How high the curves are first, as a share of the window, and at least, points.
const CURVES_SHARE: f32 = 0.26;
const LOWEST: f32 = 120.0;

/// What a plot is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// How fast each method turns.
    Speed,
    /// How far each is from slerp.
    Deviation,
    /// The determinant of what each makes.
    Determinant,
    /// How far its axes are from right angles.
    Shear,
    /// The angles of slerp's orientations, in the order that is chosen.
    Angles,
}

impl Quantity {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 5] = [
        Self::Speed,
        Self::Deviation,
        Self::Determinant,
        Self::Shear,
        Self::Angles,
    ];

    /// The name shown.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Speed => "Speed",
            Self::Deviation => "Strays",
            Self::Determinant => "Det",
            Self::Shear => "Shear",
            Self::Angles => "Angles",
        }
    }

    /// What it is, with its unit.
    #[must_use]
    pub const fn says(self) -> &'static str {
        match self {
            Self::Speed => {
                "How fast it turns, in degrees for a way from key to key; of the nearest rotation"
            }
            Self::Deviation => "How far from slerp, in degrees; of the nearest rotation",
            Self::Determinant => "1 for a rotation: the factor by which volumes change",
            Self::Shear => "How far axes are from right angles, in degrees",
            Self::Angles => {
                "The Euler angles of slerp's orientations in the order chosen at the left; dashed the curves of the angles as they were set, where those are shown"
            }
        }
    }

    fn value(self, step: &PathStep) -> f64 {
        match self {
            Self::Speed => step.speed_deg,
            Self::Deviation => step.deviation_deg,
            Self::Determinant => step.blend.determinant(),
            Self::Shear => step.blend.shear_deg(),
            Self::Angles => 0.0,
        }
    }

    const fn unit(self) -> &'static str {
        match self {
            Self::Determinant => "",
            _ => "\u{b0}",
        }
    }
}

/// Shows the curves of the page.
pub(super) fn show_below(
    ui: &mut Ui,
    lab: &mut InterpolationLab,
    panel: &mut InterpolationPanel,
    has_legend: bool,
) {
    let ground = Frame::NONE.fill(ui.visuals().panel_fill);
    // In a low window the view needs its room for the rings of start and end.
    let height = (CURVES_SHARE * ui.available_height()).clamp(LOWEST, 230.0);
    let id = egui::Id::unique(("interpolation plots", panel.is_closed));
    let below = Panel::bottom(id).frame(ground.inner_margin(Margin::symmetric(10, 4)));
    let below = if panel.is_closed {
        below.resizable(false).exact_size(34.0)
    } else {
        below
            .resizable(true)
            .default_size(height)
            .size_range(LOWEST..=460.0)
    };
    below.show(ui, |ui| match lab.page() {
        _ if panel.is_closed => {
            ui.horizontal_centered(|ui| {
                eye(ui, panel);
                ui.label(RichText::new("Curves").color(Palette::in_ui(ui).quiet));
            });
        }
        Page::Clip => {
            ui.horizontal(|ui| {
                ui.set_min_height(26.0);
                eye(ui, panel);
                let quiet = Palette::in_ui(ui).quiet;
                let text = "Mean angle of all joints to the truth, in degrees, over the frames: 0 at the kept ones";
                ui.add(egui::Label::new(RichText::new(text).small().color(quiet)).truncate());
            });
            clip::plot::show(ui, lab, has_legend);
        }
        Page::Orientations => {
            let room = ui.available_size();
            let count: u8 = if room.x >= TWO_PLOTS { 2 } else { 1 };
            let width = (room.x - 3.0 * GAP * f32::from(count - 1)) / f32::from(count);
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 3.0 * GAP;
                for index in 0..usize::from(count) {
                    ui.vertical(|ui| {
                        ui.set_width(width);
                        ui.horizontal(|ui| {
                            if index == 0 {
                                eye(ui, panel);
                            }
                            choices(ui, panel, index);
                        });
                        plot(ui, lab, (panel.plots[index], index), has_legend);
                    });
                }
            });
        }
    });
}

fn eye(ui: &mut Ui, panel: &mut InterpolationPanel) {
    let (icon, says) = match panel.is_closed {
        true => (Icon::EyeOff, "Show the curves"),
        false => (Icon::Eye, "Hide the curves: more room for the view"),
    };
    if sized_icon(ui, icon, says, false, vec2(24.0, 24.0)).clicked() {
        panel.is_closed = !panel.is_closed;
    }
}

fn choices(ui: &mut Ui, panel: &mut InterpolationPanel, index: usize) {
    let options = Quantity::ALL.map(|quantity| (quantity.name(), quantity.says()));
    let mut quantities = Quantity::ALL.iter();
    let now = quantities.position(|quantity| *quantity == panel.plots[index]);
    let room = ui.available_width();
    let salt = ["left plot", "right plot"][index];
    if let Some(chosen) = row::one_of(ui, salt, room, now, &options) {
        panel.plots[index] = Quantity::ALL[chosen];
    }
}

fn plot(
    ui: &mut Ui,
    lab: &mut InterpolationLab,
    (quantity, index): (Quantity, usize),
    has_legend: bool,
) {
    let palette = Palette::in_ui(ui);
    let unit = quantity.unit();
    let length = lab.playback.length();
    let height = ui.available_height().max(50.0);
    let mut plot = Plot::new(("interpolation plot", index, quantity.name()))
        .height(height)
        .width(ui.available_width())
        .show_axes(Vec2b::TRUE)
        .show_background(false)
        .show_grid(Vec2b::TRUE)
        .grid_color(palette.line)
        .set_margin_fraction(vec2(0.01, 0.08))
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_zoom(false)
        .allow_double_click_reset(false)
        .y_axis_min_width(46.0)
        .y_axis_formatter(move |mark, _| format!("{}{unit}", short(mark.value)))
        .x_axis_formatter(|mark, _| short(mark.value))
        .include_x(0.0)
        .include_x(length)
        .include_y(0.0)
        .sense(egui::Sense::click_and_drag());
    if quantity == Quantity::Determinant {
        plot = plot.include_y(1.0);
    }
    // In a low plot the colours are told by the view, or by the list at the side.
    let lines = lines(lab, quantity);
    let is_told = has_legend || quantity == Quantity::Angles;
    if is_told && row::legend_fits(lines.len(), height) {
        plot = plot.legend(Legend::default().background_alpha(0.7));
    }
    let now = lab.playback.share();
    let response = plot.show(ui, |plot| {
        for (name, points, hex) in lines {
            let line = Line::new(name.clone(), PlotPoints::from(points));
            // Slerp is drawn last and broad: others lie on it.
            let is_slerp = name == "slerp";
            let line = line.color(hex).width(if is_slerp { 2.6 } else { 1.6 });
            let line = match name.as_str() {
                "squad" | "nlerp" => line.style(LineStyle::dashed_loose()),
                name if name.starts_with("curve ") => line.style(LineStyle::dashed_dense()),
                _ => line,
            };
            plot.line(line);
        }
        plot.vline(VLine::new("", now).color(palette.accent).width(1.4));
        plot.pointer_coordinate()
    });
    let clicked = response.response.clicked() || response.response.dragged();
    if let (true, Some(point)) = (clicked, response.inner) {
        lab.playback.pause();
        lab.playback.set_share(point.x);
    }
}

type Curve = (String, Vec<[f64; 2]>, egui::Color32);

fn lines(lab: &InterpolationLab, quantity: Quantity) -> Vec<Curve> {
    if quantity == Quantity::Angles {
        let mut lines = angles(lab);
        if lab.is_shown(Kind::Curves) {
            lines.extend(angles_of_curves(lab));
        }
        return lines;
    }
    let mut lines: Vec<Curve> = lab
        .ways()
        .map(|way| {
            let points = way.steps.iter().map(|step| [step.t, quantity.value(step)]);
            let finite = points.filter(|point| point[1].is_finite());
            let hex = color(hex_of(way.kind));
            let name = way.kind.name(lab.case().order());
            (name, finite.collect(), hex)
        })
        .collect();
    lines.reverse();
    lines
}

/// The angles as they were set, with straight pieces between the keys.
fn angles_of_curves(lab: &InterpolationLab) -> Vec<Curve> {
    let (case, length) = (lab.case(), lab.playback.length());
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let start = match lab.span() {
        Span::Pair => case.gap() as f64,
        Span::AllKeys => 0.0,
    };
    let Some(curves) = curves(case) else {
        return Vec::new();
    };
    let order = case.order();
    let axes = order.axes().iter().enumerate();
    axes.map(|(index, axis)| {
        let points = (0..=STEPS).map(|step| {
            #[expect(clippy::cast_precision_loss, reason = "a small number")]
            let t = length * step as f64 / STEPS as f64;
            [t, curves.angles_deg().sample(start + t)[index]]
        });
        let name = format!("curve {} {}", axis.letter(), index + 1);
        (name, points.collect(), color_of_axis(*axis))
    })
    .collect()
}

fn color_of_axis(axis: Axis) -> egui::Color32 {
    match axis {
        Axis::X => CURVES[0],
        Axis::Y => CURVES[1],
        Axis::Z => CURVES[2],
    }
}

/// The angles of slerp's orientations, run on from step to step.
fn angles(lab: &InterpolationLab) -> Vec<Curve> {
    let Some(way) = lab.way(Method::Slerp) else {
        return Vec::new();
    };
    let order = lab.case().order();
    let mut previous: Option<[f64; 3]> = None;
    let mut curves: Vec<Vec<[f64; 2]>> = vec![Vec::new(); 3];
    for step in &way.steps {
        let turned: DQuat = step.rotation;
        let angles = match previous {
            Some(before) => order.from_quat_near(turned, before).angles_rad,
            None => order.from_quat(turned).angles_rad,
        };
        previous = Some(angles);
        for (curve, angle) in curves.iter_mut().zip(angles) {
            curve.push([step.t, angle.to_degrees()]);
        }
    }
    let axes = order.axes().iter().enumerate().zip(curves);
    axes.map(|((index, axis), curve)| {
        let name = format!("{} {}", axis.letter(), index + 1);
        (name, curve, color_of_axis(*axis))
    })
    .collect()
}

/// A number as short as it can be said at an axis.
pub(super) fn short(value: f64) -> String {
    if value.abs() >= 1e4 {
        return format!("{:.0}k", value / 1e3);
    }
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}
