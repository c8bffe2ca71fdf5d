//! How the gizmo looks: painted over the picture, each line with a rim that parts it from what is
//! behind it.

use egui::epaint::{PathShape, PathStroke};
use egui::{Align2, Color32, FontId, Painter, Pos2, Shape as Mark, Stroke};
use glam::{Quat, Vec3};
use posekit::rotation::Axis;

use super::drag::axes_told;
use super::shapes::MIDDLE_POINTS;
use super::{Amount, Drag, Gizmo, Handle, Outline, Shape, Viewport, shapes};
use crate::theme::{CURVES, Palette};

/// Width of lines, points.
const WIDTH: f32 = 2.4;
/// Width of the line under the pointer.
const WIDTH_HOVERED: f32 = 4.0;
/// The rim at both sides of a line.
const RIM: f32 = 1.4;

/// Corners of a whole turn that is filled.
const FAN_CORNERS: f32 = 72.0;

/// The colour of an axis.
#[must_use]
pub fn axis_color(axis: Axis) -> Color32 {
    CURVES[axis.index()]
}

/// Paints a gizmo: the handle under the pointer stands out; while one is dragged the others step
/// back, and how far it went is shown.
pub fn draw(
    painter: &Painter,
    gizmo: &Gizmo,
    viewport: &Viewport,
    (hovered, drag): (Option<Handle>, Option<&Drag>),
    palette: &Palette,
) {
    let brush = Brush { painter, palette };
    if let Some(drag) = drag {
        brush.way(drag, gizmo, viewport);
    }
    let taken = drag.map(Drag::handle);
    for shape in shapes(gizmo, viewport) {
        let emphasis = match taken {
            Some(taken) if taken == shape.handle => Emphasis::Strong,
            Some(_) => Emphasis::Weak,
            None if hovered == Some(shape.handle) => Emphasis::Strong,
            None => Emphasis::Plain,
        };
        // A ring that turns is shown by what it sweeps.
        if emphasis == Emphasis::Weak && shape.handle.turns() {
            continue;
        }
        brush.shape(&shape, emphasis);
    }
    if let Some(drag) = drag {
        brush.amount(drag, gizmo, viewport);
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Emphasis {
    Weak,
    Plain,
    Strong,
}

struct Brush<'a> {
    painter: &'a Painter,
    palette: &'a Palette,
}

impl Brush<'_> {
    fn color(&self, handle: Handle) -> Color32 {
        match handle.axis() {
            Some(axis) => axis_color(axis),
            None => self.palette.quiet,
        }
    }

    fn rim(&self, opacity: f32) -> Color32 {
        self.palette.raised.gamma_multiply(0.75 * opacity)
    }

    fn shape(&self, shape: &Shape, emphasis: Emphasis) {
        let (width, strength) = match emphasis {
            Emphasis::Weak => (WIDTH, 0.35),
            Emphasis::Plain => (WIDTH, 0.92),
            Emphasis::Strong => (WIDTH_HOVERED, 1.0),
        };
        let opacity = shape.opacity * strength;
        let mut color = self.color(shape.handle);
        if emphasis == Emphasis::Strong {
            color = color.lerp_to_gamma(self.palette.text, 0.12);
        }
        match &shape.outline {
            Outline::Disc(middle) => self.disc(*middle, emphasis, opacity),
            Outline::Square(corners) => {
                let fill = if emphasis == Emphasis::Strong {
                    0.7
                } else {
                    0.4
                };
                self.square(corners, color, opacity, fill);
            }
            Outline::Arrow(foot, tip) => self.arrow(*foot, *tip, width, color, opacity),
            Outline::Ring(corners) => self.ring(corners, width, color, opacity),
        }
    }

    fn disc(&self, middle: Pos2, emphasis: Emphasis, opacity: f32) {
        let radius = if emphasis == Emphasis::Strong {
            MIDDLE_POINTS
        } else {
            MIDDLE_POINTS - 1.5
        };
        let edge = self.palette.text.gamma_multiply(opacity);
        let fill = self.palette.raised.gamma_multiply(0.8 * opacity);
        self.painter
            .circle(middle, radius + RIM, self.rim(opacity), Stroke::NONE);
        self.painter
            .circle(middle, radius, fill, Stroke::new(1.8, edge));
    }

    fn square(&self, corners: &[Pos2; 4], color: Color32, opacity: f32, fill: f32) {
        self.painter.add(Mark::convex_polygon(
            corners.to_vec(),
            color.gamma_multiply(fill * opacity),
            Stroke::new(1.5, color.gamma_multiply(opacity)),
        ));
    }

    fn arrow(&self, foot: Pos2, tip: Pos2, width: f32, color: Color32, opacity: f32) {
        let along = (tip - foot).normalized();
        let across = along.rot90();
        let head = 6.0 + 2.6 * width;
        let neck = tip - along * head.min((tip - foot).length());
        let half = 0.36 * head;
        let rim = self.rim(opacity);
        self.painter
            .line_segment([foot, neck], Stroke::new(width + 2.0 * RIM, rim));
        self.painter.line_segment(
            [foot, neck],
            Stroke::new(width, color.gamma_multiply(opacity)),
        );
        self.painter.add(Mark::convex_polygon(
            vec![tip, neck + across * half, neck - across * half],
            color.gamma_multiply(opacity),
            Stroke::new(RIM * 0.7, rim),
        ));
    }

    /// The far half is faint, the near half lies over it.
    fn ring(&self, corners: &[(Pos2, bool)], width: f32, color: Color32, opacity: f32) {
        let pieces = |near: bool| {
            let mut pieces: Vec<Vec<Pos2>> = Vec::new();
            let mut open = false;
            for pair in corners.windows(2) {
                if (pair[0].1 && pair[1].1) == near {
                    match pieces.last_mut().filter(|_| open) {
                        Some(piece) => piece.push(pair[1].0),
                        None => pieces.push(vec![pair[0].0, pair[1].0]),
                    }
                    open = true;
                } else {
                    open = false;
                }
            }
            pieces
        };
        for piece in pieces(false) {
            let stroke = Stroke::new(1.2, color.gamma_multiply(0.38 * opacity));
            self.painter.add(Mark::line(piece, stroke));
        }
        for piece in pieces(true) {
            let rim = Stroke::new(width + 2.0 * RIM, self.rim(opacity * 0.8));
            self.painter.add(Mark::line(piece.clone(), rim));
            let stroke = Stroke::new(width, color.gamma_multiply(opacity));
            self.painter.add(Mark::line(piece, stroke));
        }
    }

    /// What a drag has swept: the way moved, or the angle turned as a filled piece of the ring.
    fn way(&self, drag: &Drag, gizmo: &Gizmo, viewport: &Viewport) {
        let color = self.color(drag.handle());
        match drag.amount() {
            Amount::Moved(_) => {
                let from = viewport.project(drag.gizmo().position);
                let to = viewport.project(gizmo.position);
                if let (Some(from), Some(to)) = (from, to) {
                    let line = Stroke::new(1.2, color.gamma_multiply(0.8));
                    self.painter
                        .extend(Mark::dashed_line(&[from, to], line, 5.0, 4.0));
                    self.painter.circle_stroke(from, 3.5, line);
                }
            }
            Amount::Turned {
                axis,
                from,
                angle_rad,
            } => {
                let sector = Sector {
                    middle: gizmo.position,
                    axis,
                    from: from * gizmo.radius(viewport),
                    angle_rad,
                };
                sector.draw(self.painter, viewport, color);
            }
        }
    }

    fn amount(&self, drag: &Drag, gizmo: &Gizmo, viewport: &Viewport) {
        let Some(middle) = viewport.project(gizmo.position) else {
            return;
        };
        let text = amount_text(drag);
        let font = FontId::monospace(12.5);
        let galley = self.painter.layout_no_wrap(text, font, self.palette.text);
        let at = middle + egui::vec2(18.0, -26.0 - galley.size().y);
        let card = Align2::LEFT_TOP
            .anchor_size(at, galley.size())
            .expand2(egui::vec2(7.0, 4.0));
        self.painter.rect(
            card,
            5.0,
            self.palette.raised.gamma_multiply(0.94),
            Stroke::new(1.0, self.palette.line),
            egui::StrokeKind::Outside,
        );
        self.painter
            .galley(card.min + egui::vec2(7.0, 4.0), galley, self.palette.text);
    }
}

/// A drag's way in words: `X 0.250`, `+32.5 deg`.
#[must_use]
pub(super) fn amount_text(drag: &Drag) -> String {
    match drag.amount() {
        Amount::Turned { angle_rad, .. } => {
            let degrees = angle_rad.to_degrees();
            match drag.handle().axis() {
                Some(axis) => format!("{} {degrees:+.1}\u{b0}", axis.letter()),
                None => format!("{degrees:+.1}\u{b0}"),
            }
        }
        Amount::Moved(along) => {
            let told = axes_told(drag.handle()).into_iter().map(|axis| {
                let value = along[axis.index()];
                format!("{} {value:+.3}", axis.letter())
            });
            told.collect::<Vec<_>>().join("  ")
        }
    }
}

/// A piece of a disc in space.
#[derive(Clone, Copy, Debug)]
pub struct Sector {
    /// The disc's middle, world space.
    pub middle: Vec3,
    /// The disc's axis, unit length.
    pub axis: Vec3,
    /// From the middle to the rim where the piece begins.
    pub from: Vec3,
    /// How far it goes about the axis, radians.
    pub angle_rad: f32,
}

impl Sector {
    /// Points on the rim, from the beginning to the end.
    #[must_use]
    pub fn rim(&self) -> Vec<Vec3> {
        let angle = self
            .angle_rad
            .clamp(-std::f32::consts::TAU, std::f32::consts::TAU);
        let steps = (angle.abs() / std::f32::consts::TAU * FAN_CORNERS)
            .ceil()
            .max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most FAN_CORNERS"
        )]
        let count = steps as usize;
        let point = |i: usize| {
            let turned = Quat::from_axis_angle(self.axis, angle * i as f32 / steps);
            self.middle + turned * self.from
        };
        (0..=count).map(point).collect()
    }

    /// Paints it: filled faintly, with its two edges and its rim.
    pub fn draw(&self, painter: &Painter, viewport: &Viewport, color: Color32) {
        let Some(middle) = viewport.project(self.middle) else {
            return;
        };
        let rim: Option<Vec<Pos2>> = self
            .rim()
            .into_iter()
            .map(|point| viewport.project(point))
            .collect();
        let Some(rim) = rim else { return };
        let fill = color.gamma_multiply(0.22);
        let mut mesh = egui::Mesh::default();
        mesh.colored_vertex(middle, fill);
        for (index, &point) in (1_u32..).zip(&rim) {
            mesh.colored_vertex(point, fill);
            if index > 1 {
                mesh.add_triangle(0, index - 1, index);
            }
        }
        painter.add(Mark::mesh(mesh));
        let edge = Stroke::new(1.4, color.gamma_multiply(0.9));
        if let (Some(&first), Some(&last)) = (rim.first(), rim.last()) {
            painter.line_segment([middle, first], edge);
            painter.line_segment([middle, last], edge);
        }
        painter.add(Mark::Path(PathShape {
            points: rim,
            closed: false,
            fill: Color32::TRANSPARENT,
            stroke: PathStroke::new(2.0, color),
        }));
    }
}
