//! Icons, drawn: they are sharp at every size and take the colour of the text beside them.

use egui::epaint::{PathShape, PathStroke};
use egui::{Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, pos2, vec2};

use crate::theme::Palette;

/// What an icon shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// A triangle to the right.
    Play,
    /// Two bars.
    Pause,
    /// A triangle and a bar to the right.
    NextFrame,
    /// A triangle and a bar to the left.
    PreviousFrame,
    /// To the end.
    ToEnd,
    /// To the start.
    ToStart,
    /// An arrow in a circle.
    Loop,
    /// An arrow that ends at a bar.
    Once,
    /// An eye.
    Eye,
    /// A crossed eye.
    EyeOff,
    /// A cross.
    Close,
    /// A sun.
    Sun,
    /// A moon.
    Moon,
    /// A folder.
    Folder,
    /// A question mark in a circle.
    Help,
    /// A wave in axes.
    Curves,
    /// A bar left in a frame.
    SideLeft,
    /// A bar right in a frame.
    SideRight,
    /// A frame with corners.
    Frame,
    /// A triangle with an exclamation mark.
    Warning,
    /// An arrow upwards out of a tray.
    Export,
    /// An arrow downwards into a tray.
    Download,
    /// Lines of text.
    Text,
    /// Three sliders.
    Sliders,
    /// A magnifying glass.
    Search,
    /// A sheet with a corner.
    File,
    /// A standing figure.
    Figure,
    /// A film camera.
    Camera,
    /// A box.
    Box,
    /// A ball.
    Ball,
    /// An arrow that turns back to the left.
    Undo,
    /// An arrow that turns back to the right.
    Redo,
}

/// A square button that shows an icon and says what it does when hovered.
pub fn icon_button(ui: &mut Ui, icon: Icon, says: &str) -> Response {
    toggle_icon(ui, icon, says, false)
}

/// A square button that shows an icon and whether it is on.
pub fn toggle_icon(ui: &mut Ui, icon: Icon, says: &str, on: bool) -> Response {
    let side = ui.spacing().interact_size.y.max(28.0);
    sized_icon(ui, icon, says, on, Vec2::splat(side))
}

/// As [`toggle_icon`], in a size.
pub fn sized_icon(ui: &mut Ui, icon: Icon, says: &str, on: bool, size: Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let name = says.lines().next().unwrap_or(says);
    response
        .widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, ui.is_enabled(), on, name));
    if ui.is_rect_visible(rect) {
        let palette = Palette::in_ui(ui);
        let fill = if on {
            palette.accent_soft
        } else if response.hovered() {
            palette.hover
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(rect, 6.0, fill);
        if response.has_focus() {
            let edge = Stroke::new(1.5, palette.accent);
            ui.painter()
                .rect_stroke(rect, 6.0, edge, egui::StrokeKind::Inside);
        }
        let color = if on {
            palette.accent
        } else if response.hovered() {
            palette.text
        } else {
            palette.quiet
        };
        let color = if ui.is_enabled() {
            color
        } else {
            color.gamma_multiply(0.4)
        };
        draw(
            ui.painter(),
            icon,
            Rect::from_center_size(rect.center(), Vec2::splat(16.0)),
            color,
        );
    }
    response.on_hover_text(says)
}

/// Draws an icon into a square.
pub fn draw(painter: &Painter, icon: Icon, rect: Rect, color: Color32) {
    let pen = Pen {
        painter,
        rect,
        color,
    };
    match icon {
        Icon::Play => pen.fill(&[(0.22, 0.10), (0.90, 0.50), (0.22, 0.90)]),
        Icon::Pause => {
            pen.bar(0.20, 0.12, 0.40, 0.88);
            pen.bar(0.60, 0.12, 0.80, 0.88);
        }
        Icon::NextFrame => {
            pen.fill(&[(0.36, 0.18), (0.92, 0.50), (0.36, 0.82)]);
            pen.bar(0.12, 0.18, 0.24, 0.82);
        }
        Icon::PreviousFrame => {
            pen.fill(&[(0.64, 0.18), (0.08, 0.50), (0.64, 0.82)]);
            pen.bar(0.76, 0.18, 0.88, 0.82);
        }
        Icon::ToEnd => {
            pen.fill(&[(0.08, 0.18), (0.64, 0.50), (0.08, 0.82)]);
            pen.bar(0.74, 0.18, 0.86, 0.82);
        }
        Icon::ToStart => {
            pen.fill(&[(0.92, 0.18), (0.36, 0.50), (0.92, 0.82)]);
            pen.bar(0.14, 0.18, 0.26, 0.82);
        }
        Icon::Loop => {
            pen.arc((0.5, 0.5), 0.36, -60.0, 215.0);
            pen.fill(&[(0.56, -0.04), (0.88, 0.20), (0.54, 0.38)]);
        }
        Icon::Undo => {
            pen.line(&UNDO);
            pen.line(&UNDO_HEAD);
        }
        Icon::Redo => {
            let mirrored = |(x, y): (f32, f32)| (1.0 - x, y);
            pen.line(&UNDO.map(mirrored));
            pen.line(&UNDO_HEAD.map(mirrored));
        }
        Icon::Once => {
            pen.line(&[(0.06, 0.50), (0.66, 0.50)]);
            pen.line(&[(0.44, 0.26), (0.68, 0.50), (0.44, 0.74)]);
            pen.line(&[(0.90, 0.18), (0.90, 0.82)]);
        }
        Icon::Eye | Icon::EyeOff => {
            pen.line(&EYE_TOP);
            pen.line(&EYE_BOTTOM);
            pen.dot((0.5, 0.5), 0.14);
            if icon == Icon::EyeOff {
                pen.line(&[(0.14, 0.90), (0.86, 0.10)]);
            }
        }
        Icon::Close => {
            pen.line(&[(0.22, 0.22), (0.78, 0.78)]);
            pen.line(&[(0.78, 0.22), (0.22, 0.78)]);
        }
        Icon::Sun => {
            pen.ring((0.5, 0.5), 0.20);
            for spoke in 0..8u8 {
                let (sin, cos) = (f32::from(spoke) * std::f32::consts::FRAC_PI_4).sin_cos();
                let at = |r: f32| (0.5 + r * cos, 0.5 + r * sin);
                pen.line(&[at(0.34), at(0.48)]);
            }
        }
        Icon::Moon => pen.moon(),
        Icon::Camera => {
            pen.outline(&[(0.06, 0.26), (0.66, 0.26), (0.66, 0.80), (0.06, 0.80)]);
            pen.fill(&[(0.70, 0.53), (0.96, 0.30), (0.96, 0.76)]);
        }
        Icon::Box => {
            pen.outline(&[(0.08, 0.36), (0.64, 0.36), (0.64, 0.92), (0.08, 0.92)]);
            pen.line(&[(0.08, 0.36), (0.36, 0.10), (0.92, 0.10), (0.64, 0.36)]);
            pen.line(&[(0.92, 0.10), (0.92, 0.64), (0.64, 0.92)]);
        }
        Icon::Ball => {
            pen.ring((0.5, 0.5), 0.40);
            pen.arc((0.5, 0.10), 0.56, 45.0, 135.0);
        }
        Icon::Folder => pen.outline(&[
            (0.06, 0.20),
            (0.40, 0.20),
            (0.50, 0.32),
            (0.94, 0.32),
            (0.94, 0.84),
            (0.06, 0.84),
        ]),
        Icon::File => {
            pen.outline(&[
                (0.18, 0.06),
                (0.60, 0.06),
                (0.84, 0.30),
                (0.84, 0.94),
                (0.18, 0.94),
            ]);
            pen.line(&[(0.58, 0.08), (0.58, 0.32), (0.82, 0.32)]);
        }
        Icon::Help => {
            pen.ring((0.5, 0.5), 0.44);
            pen.arc((0.5, 0.40), 0.14, -180.0, 70.0);
            pen.line(&[(0.52, 0.52), (0.50, 0.62)]);
            pen.dot((0.5, 0.76), 0.055);
        }
        Icon::Curves => {
            pen.line(&[(0.08, 0.06), (0.08, 0.92), (0.96, 0.92)]);
            pen.line(&CURVE);
        }
        Icon::SideLeft | Icon::SideRight => {
            pen.outline(&[(0.06, 0.14), (0.94, 0.14), (0.94, 0.86), (0.06, 0.86)]);
            let (left, right) = if icon == Icon::SideLeft {
                (0.06, 0.34)
            } else {
                (0.66, 0.94)
            };
            pen.bar(left, 0.14, right, 0.86);
        }
        Icon::Frame => {
            for (x, y) in [(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9)] {
                let inward = |c: f32| if c < 0.5 { c + 0.24 } else { c - 0.24 };
                pen.line(&[(inward(x), y), (x, y), (x, inward(y))]);
            }
            pen.dot((0.5, 0.5), 0.11);
        }
        Icon::Warning => {
            pen.outline(&[(0.50, 0.08), (0.96, 0.90), (0.04, 0.90)]);
            pen.line(&[(0.50, 0.38), (0.50, 0.62)]);
            pen.dot((0.5, 0.76), 0.06);
        }
        Icon::Export => {
            pen.line(&[(0.08, 0.62), (0.08, 0.92), (0.92, 0.92), (0.92, 0.62)]);
            pen.line(&[(0.50, 0.70), (0.50, 0.08)]);
            pen.line(&[(0.26, 0.30), (0.50, 0.06), (0.74, 0.30)]);
        }
        Icon::Download => {
            pen.line(&[(0.08, 0.62), (0.08, 0.92), (0.92, 0.92), (0.92, 0.62)]);
            pen.line(&[(0.50, 0.06), (0.50, 0.68)]);
            pen.line(&[(0.26, 0.46), (0.50, 0.70), (0.74, 0.46)]);
        }
        Icon::Text => {
            for (y, end) in [(0.14, 0.94), (0.38, 0.70), (0.62, 0.94), (0.86, 0.52)] {
                pen.line(&[(0.06, y), (end, y)]);
            }
        }
        Icon::Sliders => {
            for (y, x) in [(0.18, 0.66), (0.50, 0.32), (0.82, 0.56)] {
                pen.line(&[(0.06, y), (0.94, y)]);
                pen.dot((x, y), 0.12);
            }
        }
        Icon::Search => {
            pen.ring((0.42, 0.42), 0.30);
            pen.line(&[(0.64, 0.64), (0.92, 0.92)]);
        }
        Icon::Figure => {
            pen.ring((0.5, 0.16), 0.13);
            pen.line(&[(0.5, 0.32), (0.5, 0.60)]);
            pen.line(&[(0.16, 0.40), (0.84, 0.40)]);
            pen.line(&[(0.28, 0.96), (0.5, 0.60), (0.72, 0.96)]);
        }
    }
}

/// An arrow's way back to the left, and its head.
const UNDO: [(f32, f32); 8] = [
    (0.14, 0.36),
    (0.60, 0.36),
    (0.74, 0.40),
    (0.84, 0.51),
    (0.84, 0.67),
    (0.74, 0.78),
    (0.60, 0.82),
    (0.36, 0.82),
];
const UNDO_HEAD: [(f32, f32); 3] = [(0.34, 0.14), (0.12, 0.36), (0.34, 0.58)];

const EYE_TOP: [(f32, f32); 7] = [
    (0.02, 0.50),
    (0.16, 0.34),
    (0.32, 0.24),
    (0.50, 0.20),
    (0.68, 0.24),
    (0.84, 0.34),
    (0.98, 0.50),
];
const EYE_BOTTOM: [(f32, f32); 7] = [
    (0.02, 0.50),
    (0.16, 0.66),
    (0.32, 0.76),
    (0.50, 0.80),
    (0.68, 0.76),
    (0.84, 0.66),
    (0.98, 0.50),
];
const CURVE: [(f32, f32); 8] = [
    (0.16, 0.66),
    (0.26, 0.44),
    (0.36, 0.32),
    (0.46, 0.40),
    (0.56, 0.60),
    (0.66, 0.66),
    (0.78, 0.48),
    (0.92, 0.18),
];

/// Draws in coordinates from 0 to 1, y down.
struct Pen<'a> {
    painter: &'a Painter,
    rect: Rect,
    color: Color32,
}

impl Pen<'_> {
    fn at(&self, (x, y): (f32, f32)) -> Pos2 {
        pos2(
            self.rect.left() + x * self.rect.width(),
            self.rect.top() + y * self.rect.height(),
        )
    }

    fn points(&self, points: &[(f32, f32)]) -> Vec<Pos2> {
        points.iter().map(|&point| self.at(point)).collect()
    }

    fn stroke(&self) -> Stroke {
        Stroke::new(1.4, self.color)
    }

    fn line(&self, points: &[(f32, f32)]) {
        self.painter
            .add(Shape::line(self.points(points), self.stroke()));
    }

    fn outline(&self, points: &[(f32, f32)]) {
        self.painter
            .add(Shape::closed_line(self.points(points), self.stroke()));
    }

    fn fill(&self, points: &[(f32, f32)]) {
        let shape = PathShape::convex_polygon(self.points(points), self.color, PathStroke::NONE);
        self.painter.add(shape);
    }

    fn bar(&self, left: f32, top: f32, right: f32, bottom: f32) {
        let rect = Rect::from_min_max(self.at((left, top)), self.at((right, bottom)));
        self.painter.rect_filled(rect, 1.0, self.color);
    }

    fn dot(&self, center: (f32, f32), radius: f32) {
        self.painter
            .circle_filled(self.at(center), radius * self.rect.width(), self.color);
    }

    fn ring(&self, center: (f32, f32), radius: f32) {
        self.painter
            .circle_stroke(self.at(center), radius * self.rect.width(), self.stroke());
    }

    fn arc(&self, center: (f32, f32), radius: f32, from_deg: f32, to_deg: f32) {
        const PIECES: u8 = 20;
        let middle = self.at(center);
        let point = |i: u8| {
            let t = f32::from(i) / f32::from(PIECES);
            let (sin, cos) = (from_deg + (to_deg - from_deg) * t).to_radians().sin_cos();
            middle + vec2(cos, sin) * radius * self.rect.width()
        };
        self.painter.add(Shape::line(
            (0..=PIECES).map(point).collect(),
            self.stroke(),
        ));
    }

    fn moon(&self) {
        // The outer edge of a disc, and back along the edge of the disc that covers it.
        let turn = |center: (f32, f32), radius: f32, from: f32, to: f32| {
            (0..=12u8).map(move |i| {
                let angle = (from + (to - from) * f32::from(i) / 12.0).to_radians();
                (
                    center.0 + radius * angle.cos(),
                    center.1 + radius * angle.sin(),
                )
            })
        };
        let outer = turn((0.46, 0.54), 0.42, 20.0, 290.0);
        let inner = turn((0.68, 0.36), 0.33, 243.0, 67.0);
        let edge: Vec<(f32, f32)> = outer.chain(inner).collect();
        self.outline(&edge);
    }
}
