//! Cameras, lights and props in the view: what is drawn over the picture, and what the pointer picks.

use egui::{Color32, FontId, Painter, Pos2, Rect, Response, Stroke, Ui, vec2};
use glam::Vec3;
use posekit_render::camera::Camera;
use posekit_render::color::Color;

use super::{points_of, project};
use crate::picture::painter::Shot;
use crate::state::session::Session;
use crate::state::things::{Part, Picked, Symbol, camera_corners};
use crate::theme::Palette;

/// A symbol is taken from this near, points.
const REACH: f32 = 13.0;

/// How far from a camera its frame is drawn, in statures.
const FRAME_STATURES: f32 = 0.3;

/// Radius of a light's disc, points.
const BULB: f32 = 6.0;

/// The edges of a box, by its corners: bit 0 is x, bit 1 is y, bit 2 is z.
const EDGES: [(usize, usize); 12] = [
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
];

/// What the pointer is over.
pub(super) fn hovered(
    ui: &Ui,
    response: &Response,
    session: &Session,
    camera: &Camera,
) -> Option<Picked> {
    if response.dragged() || !response.hovered() || session.transport.is_playing() {
        return None;
    }
    let pointer = ui.input(|i| i.pointer.hover_pos())?;
    let symbols = session.symbols();
    let looks_through = session.looks_through();
    let seen = |symbol: &&Symbol| !is_eye(symbol, looks_through);
    let near = symbols.iter().filter(seen).flat_map(|symbol| {
        let has_target = session
            .picked()
            .is_some_and(|it| it.owner == symbol.owner());
        let points = symbol.points().into_iter();
        points.filter(move |(picked, _)| picked.part == Part::Body || has_target)
    });
    let near = near
        .filter(|(picked, _)| !matches!(picked.owner, crate::state::animate::Owner::Prop(_)))
        .filter_map(|(picked, point)| {
            let at = project(camera, point, response.rect)?;
            Some((picked, at.distance(pointer)))
        })
        .filter(|(_, distance)| *distance <= REACH)
        .min_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((picked, _)) = near {
        return Some(picked);
    }
    let place = pointer - response.rect.min;
    let (origin, direction) = camera.ray((place.x, place.y), points_of(response.rect));
    symbols
        .iter()
        .filter_map(|symbol| Some((symbol.owner(), symbol.met_by(origin, direction)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(owner, _)| Picked::body(owner))
}

/// Whether it is the camera that the view looks through.
fn is_eye(symbol: &Symbol, looks_through: Option<usize>) -> bool {
    matches!(symbol, Symbol::Camera { index, .. } if Some(*index) == looks_through)
}

/// Draws cameras, lights and the outline of the prop that is picked over the picture.
pub(super) fn paint(
    ui: &Ui,
    rect: Rect,
    session: &Session,
    (shot, hovered): (&Shot, Option<Picked>),
) {
    let sketch = Sketch {
        canvas: &ui.painter().with_clip_rect(rect),
        rect,
        camera: &shot.camera,
        palette: Palette::in_ui(ui),
        aspect: session.frame_aspect(),
        stature: session.stage().stature(),
        floor: session.stage().ground_height(),
    };
    if session.looks_through().is_some() {
        sketch.frame(session.frame_shares());
    }
    let picked = session.picked();
    for symbol in session.symbols() {
        if is_eye(&symbol, session.looks_through()) {
            continue;
        }
        let is = |other: Option<Picked>| other.filter(|it| it.owner == symbol.owner());
        let color = match (is(picked), is(hovered)) {
            (Some(_), _) => sketch.palette.accent,
            (None, Some(_)) => sketch.palette.accent.gamma_multiply(0.75),
            (None, None) => sketch.palette.text.gamma_multiply(0.8),
        };
        sketch.symbol(&symbol, color, is(picked).or(is(hovered)).is_some());
        if is(hovered).is_some()
            && let Some(name) = session.name_of(symbol.owner())
        {
            let at = symbol.points().first().map(|(_, at)| *at);
            sketch.name(at, name);
        }
    }
}

/// Drawing over the picture.
struct Sketch<'a> {
    canvas: &'a Painter,
    rect: Rect,
    camera: &'a Camera,
    palette: Palette,
    aspect: f32,
    stature: f32,
    floor: f32,
}

impl Sketch<'_> {
    fn at(&self, point: Vec3) -> Option<Pos2> {
        project(self.camera, point, self.rect)
    }

    fn line(&self, from: Vec3, to: Vec3, stroke: Stroke) {
        if let (Some(from), Some(to)) = (self.at(from), self.at(to)) {
            self.canvas.line_segment([from, to], stroke);
        }
    }

    fn symbol(&self, symbol: &Symbol, color: Color32, is_marked: bool) {
        match symbol {
            Symbol::Camera { camera, .. } => self.frustum(camera, color, is_marked),
            Symbol::Light {
                position,
                color: shines,
                strength,
                ..
            } => self.bulb(*position, *shines * strength.min(1.0), color, is_marked),
            Symbol::Prop { placed, .. } if is_marked => {
                let corner = |index: usize| {
                    let side = |bit: usize| if index >> bit & 1 == 1 { 0.5 } else { -0.5 };
                    placed.transform_point3(Vec3::new(side(0), side(1), side(2)))
                };
                for (a, b) in EDGES {
                    self.line(corner(a), corner(b), Stroke::new(1.4, color));
                }
            }
            Symbol::Prop { .. } => {}
        }
    }

    /// A pyramid with its top at the eye, and a triangle on the side that is up.
    fn frustum(&self, camera: &Camera, color: Color32, is_marked: bool) {
        let corners = camera_corners(camera, self.aspect, FRAME_STATURES * self.stature);
        let stroke = Stroke::new(if is_marked { 2.0 } else { 1.4 }, color);
        for (index, &corner) in corners.iter().enumerate() {
            self.line(camera.eye, corner, stroke);
            self.line(corner, corners[(index + 1) % 4], stroke);
        }
        let (left, right) = (corners[0], corners[1]);
        let up = corners[0] - corners[3];
        let (a, b) = (left.lerp(right, 0.3), left.lerp(right, 0.7));
        let top = left.lerp(right, 0.5) + up * 0.25;
        self.line(a + up * 0.06, top, stroke);
        self.line(b + up * 0.06, top, stroke);
        self.line(a + up * 0.06, b + up * 0.06, stroke);
        if let Some(eye) = self.at(camera.eye) {
            self.canvas.circle_filled(eye, 3.0, color);
        }
        if is_marked {
            self.line(
                camera.eye,
                camera.target,
                Stroke::new(1.0, color.gamma_multiply(0.5)),
            );
            if let Some(target) = self.at(camera.target) {
                self.canvas.circle_stroke(target, 5.0, stroke);
                self.canvas.circle_filled(target, 1.6, color);
            }
        }
    }

    /// A disc of the light's colour with rays, and a line down to the floor when it is marked.
    fn bulb(&self, position: Vec3, shines: Vec3, color: Color32, is_marked: bool) {
        let Some(at) = self.at(position) else { return };
        if is_marked {
            let foot = Vec3::new(position.x, self.floor, position.z);
            self.line(position, foot, Stroke::new(1.0, color.gamma_multiply(0.5)));
        }
        let [r, g, b] = Color {
            r: shines.x,
            g: shines.y,
            b: shines.z,
        }
        .to_srgb_bytes();
        let width = if is_marked { 2.0 } else { 1.4 };
        self.canvas.circle(
            at,
            BULB,
            Color32::from_rgb(r, g, b),
            Stroke::new(width, color),
        );
        for ray in 0..8u8 {
            let (sin, cos) = (f32::from(ray) * std::f32::consts::FRAC_PI_4).sin_cos();
            let way = vec2(cos, sin);
            let ends = [at + way * (BULB + 3.5), at + way * (BULB + 7.5)];
            self.canvas.line_segment(ends, Stroke::new(width, color));
        }
    }

    /// Darkens what the camera that is looked through does not see.
    fn frame(&self, (width, height): (f32, f32)) {
        let size = vec2(self.rect.width() * width, self.rect.height() * height);
        let frame = Rect::from_center_size(self.rect.center(), size);
        let shade = Color32::from_black_alpha(110);
        let (all, x, y) = (self.rect, frame.x_range(), frame.y_range());
        for (xs, ys) in [
            (all.x_range(), egui::Rangef::new(all.top(), y.min)),
            (all.x_range(), egui::Rangef::new(y.max, all.bottom())),
            (egui::Rangef::new(all.left(), x.min), y),
            (egui::Rangef::new(x.max, all.right()), y),
        ] {
            let bar = Rect::from_x_y_ranges(xs, ys);
            self.canvas.rect_filled(bar, 0.0, shade);
        }
        let stroke = Stroke::new(1.2, self.palette.accent);
        self.canvas
            .rect_stroke(frame, 0.0, stroke, egui::StrokeKind::Outside);
    }

    fn name(&self, at: Option<Vec3>, name: String) {
        let Some(at) = at.and_then(|at| self.at(at)) else {
            return;
        };
        let font = FontId::proportional(13.0);
        let galley = self.canvas.layout_no_wrap(name, font, self.palette.text);
        let place = at + vec2(14.0, -14.0 - galley.size().y);
        let card = Rect::from_min_size(place, galley.size()).expand2(vec2(7.0, 4.0));
        self.canvas.rect(
            card,
            5.0,
            self.palette.raised.gamma_multiply(0.94),
            Stroke::new(1.0, self.palette.line),
            egui::StrokeKind::Outside,
        );
        self.canvas.galley(place, galley, self.palette.text);
    }
}
