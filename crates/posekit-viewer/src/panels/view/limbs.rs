//! What is asked of limbs, drawn over the picture: the chain, what is held, what is missing, and the
//! solver's next update as lectures draw it.
//!
//! Of an update: the vector a from the joint to the effector, b from the joint to the target, the axis of
//! the turn, and the angle between them as a filled arc.

use egui::epaint::PathStroke;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};
use glam::Vec3;
use posekit::ik::TraceUpdate;

use crate::gizmo::{Sector, Viewport};
use crate::picture::painter::Shot;
use crate::state::session::{Handles, Session};
use crate::theme::{CURVES, Palette};

/// The colours of a, b, and the axis and angle.
const A: Color32 = CURVES[3];
const B: Color32 = CURVES[4];
const TURN: Color32 = CURVES[5];

/// Radius of the arc on the screen, points.
const ARC_POINTS: f32 = 46.0;

/// A gap between effector and target of fewer points is not drawn.
const SEEN_GAP: f32 = 3.0;

/// Paints it.
pub(super) fn paint(ui: &Ui, rect: Rect, session: &Session, shot: &Shot) {
    if session.handles() != Handles::Targets {
        return;
    }
    // As it is in the picture, which may be one behind.
    let pose = shot
        .poses
        .iter()
        .find(|(id, _)| Some(*id) == session.active_id());
    let Some((_, pose)) = pose else {
        return;
    };
    let viewport = Viewport::new(shot.camera, rect);
    let sketch = Sketch {
        painter: ui.painter().with_clip_rect(rect),
        viewport,
        palette: Palette::in_ui(ui),
        place: session.active_place(),
        joints: pose
            .positions
            .iter()
            .map(|&joint| viewport.project(joint))
            .collect(),
    };
    if session.stepper().is_none() {
        sketch.dots();
    }
    for pin in session.pins() {
        sketch.pin(pin.position, pin.joint.index());
    }
    let Some(effector) = session.effector() else {
        return;
    };
    let chain = session.ik_chain();
    sketch.chain(&chain.iter().map(|joint| joint.index()).collect::<Vec<_>>());
    if let Some(stepper) = session.stepper() {
        if let Some(target) = session.target() {
            sketch.goal(target.position);
        }
        if let Some(update) = stepper.next() {
            sketch.update(update);
        }
    } else if let Some(target) = session.target() {
        sketch.missing(effector.index(), target.position);
    }
}

/// What is drawn with.
struct Sketch {
    painter: Painter,
    viewport: Viewport,
    palette: Palette,
    /// From the motion's space to the stage's.
    place: Vec3,
    /// Where the joints are on the screen.
    joints: Vec<Option<Pos2>>,
}

impl Sketch {
    fn at(&self, point: Vec3) -> Option<Pos2> {
        self.viewport.project(point + self.place)
    }

    fn joint(&self, index: usize) -> Option<Pos2> {
        self.joints.get(index).copied().flatten()
    }

    fn rim(&self) -> Color32 {
        self.palette.raised.gamma_multiply(0.8)
    }

    /// What can be dragged.
    fn dots(&self) {
        let edge = Stroke::new(1.2, self.palette.accent.gamma_multiply(0.75));
        let fill = self.palette.raised.gamma_multiply(0.55);
        for place in self.joints.iter().flatten() {
            self.painter.circle(*place, 2.8, fill, edge);
        }
    }

    fn chain(&self, joints: &[usize]) {
        let places: Option<Vec<Pos2>> = joints.iter().map(|&joint| self.joint(joint)).collect();
        let Some(places) = places.filter(|places| places.len() > 1) else {
            return;
        };
        let accent = self.palette.accent;
        self.painter
            .add(Shape::line(places.clone(), Stroke::new(5.0, self.rim())));
        self.painter
            .add(Shape::line(places.clone(), Stroke::new(2.6, accent)));
        for place in &places[1..] {
            self.painter
                .circle(*place, 3.6, self.palette.raised, Stroke::new(1.6, accent));
        }
        // The start keeps its place: it is drawn as a foot on the ground.
        let start = Rect::from_center_size(places[0], vec2(10.0, 10.0));
        self.painter.rect(
            start,
            2.0,
            accent,
            Stroke::new(1.5, self.rim()),
            egui::StrokeKind::Outside,
        );
    }

    /// A diamond where a joint is held, and a line from the joint if it is not there.
    fn pin(&self, position: Vec3, joint: usize) {
        let Some(here) = self.at(position) else {
            return;
        };
        if let Some(there) = self.joint(joint)
            && there.distance(here) > SEEN_GAP
        {
            let line = Stroke::new(1.6, self.palette.error);
            self.painter
                .extend(Shape::dashed_line(&[there, here], line, 4.0, 3.0));
        }
        let corner = |x: f32, y: f32| here + vec2(x, y);
        self.painter.add(Shape::convex_polygon(
            vec![
                corner(0.0, -7.0),
                corner(7.0, 0.0),
                corner(0.0, 7.0),
                corner(-7.0, 0.0),
            ],
            self.palette.warning,
            Stroke::new(1.6, self.palette.raised),
        ));
    }

    /// A target with a cross.
    fn goal(&self, position: Vec3) {
        let Some(here) = self.at(position) else {
            return;
        };
        for (width, color) in [(4.5, self.rim()), (2.0, B)] {
            let stroke = Stroke::new(width, color);
            self.painter.circle_stroke(here, 7.0, stroke);
            for way in [vec2(1.0, 0.0), vec2(0.0, 1.0)] {
                self.painter
                    .line_segment([here - way * 11.0, here - way * 4.0], stroke);
                self.painter
                    .line_segment([here + way * 4.0, here + way * 11.0], stroke);
            }
        }
    }

    /// What is missing between the effector and its target.
    fn missing(&self, effector: usize, target: Vec3) {
        let (Some(here), Some(there)) = (self.joint(effector), self.at(target)) else {
            return;
        };
        if here.distance(there) > SEEN_GAP {
            let line = Stroke::new(1.8, self.palette.error);
            self.painter
                .extend(Shape::dashed_line(&[here, there], line, 5.0, 4.0));
            self.painter.circle_stroke(here, 5.0, line);
        }
    }

    /// The next update, as lectures draw it.
    fn update(&self, update: &TraceUpdate) {
        let pivot = update.pivot_in_world.as_vec3();
        let (a, b) = (update.to_effector.as_vec3(), update.to_target.as_vec3());
        let axis = update.axis_in_world.as_vec3();
        #[expect(clippy::cast_possible_truncation, reason = "an angle")]
        let angle_rad = update.amount as f32;
        self.arc(pivot, (a, axis, angle_rad));
        self.vector(pivot, b, B, "b");
        self.vector(pivot, a, A, "a");
        self.axis(pivot, axis);
        if let Some(here) = self.at(pivot) {
            self.painter
                .circle(here, 5.0, TURN, Stroke::new(1.6, self.palette.raised));
        }
        self.angle(pivot, (a, axis, angle_rad));
    }

    /// The arc from a as far as the joint will turn.
    fn arc(&self, pivot: Vec3, (a, axis, angle_rad): (Vec3, Vec3, f32)) {
        let radius = self
            .viewport
            .length_of(ARC_POINTS, pivot + self.place)
            .min(0.8 * a.length());
        if let Some(direction) = a.try_normalize()
            && axis.is_normalized()
        {
            let sector = Sector {
                middle: pivot + self.place,
                axis,
                from: direction * radius,
                angle_rad,
            };
            sector.draw(&self.painter, &self.viewport, TURN);
        }
    }

    fn vector(&self, from: Vec3, vector: Vec3, color: Color32, name: &str) {
        let (Some(foot), Some(tip)) = (self.at(from), self.at(from + vector)) else {
            return;
        };
        let length = foot.distance(tip);
        if length < 2.0 {
            return;
        }
        let along = (tip - foot) / length;
        let across = along.rot90();
        let head = 11.0_f32.min(length);
        let neck = tip - along * head;
        let rim = Stroke::new(5.0, self.rim());
        self.painter.line_segment([foot, neck], rim);
        self.painter
            .line_segment([foot, neck], Stroke::new(2.4, color));
        self.painter.add(Shape::convex_polygon(
            vec![tip, neck + across * 4.5, neck - across * 4.5],
            color,
            Stroke::new(1.0, self.rim()),
        ));
        let side = if name == "a" { 1.0 } else { -1.0 };
        let middle = foot + along * (0.62 * length) + across * (side * 13.0);
        self.letter(middle, name, color);
    }

    /// The axis, through the joint.
    fn axis(&self, pivot: Vec3, axis: Vec3) {
        let half = self.viewport.length_of(34.0, pivot + self.place);
        let ends = [self.at(pivot - axis * half), self.at(pivot + axis * half)];
        if let [Some(start), Some(end)] = ends
            && start.distance(end) > 6.0
        {
            let dashes = Shape::dashed_line(&[start, end], Stroke::new(1.6, TURN), 5.0, 3.0);
            self.painter.extend(dashes);
            self.painter.add(Shape::Path(egui::epaint::PathShape {
                points: arrow_head(start, end),
                closed: true,
                fill: TURN,
                stroke: PathStroke::NONE,
            }));
        }
    }

    /// The angle in degrees, beside the arc.
    fn angle(&self, pivot: Vec3, (a, axis, angle_rad): (Vec3, Vec3, f32)) {
        let Some(here) = self.at(pivot) else { return };
        let half = glam::Quat::from_axis_angle(axis.normalize_or(Vec3::Y), angle_rad / 2.0);
        let out = half * a.normalize_or(Vec3::X);
        let reach = self
            .viewport
            .length_of(ARC_POINTS + 22.0, pivot + self.place);
        let place = self.at(pivot + out * reach).unwrap_or(here);
        let text = format!("{:.1}\u{b0}", angle_rad.to_degrees());
        let font = FontId::monospace(12.5);
        let galley = self.painter.layout_no_wrap(text, font, self.palette.text);
        let card = Align2::CENTER_CENTER
            .anchor_size(place, galley.size())
            .expand2(vec2(6.0, 3.0));
        self.painter.rect(
            card,
            5.0,
            self.palette.raised.gamma_multiply(0.94),
            Stroke::new(1.0, TURN),
            egui::StrokeKind::Outside,
        );
        self.painter
            .galley(card.min + vec2(6.0, 3.0), galley, self.palette.text);
    }

    fn letter(&self, place: Pos2, name: &str, color: Color32) {
        let font = FontId::proportional(15.0);
        for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
            self.painter.text(
                pos2(place.x + x, place.y + y),
                Align2::CENTER_CENTER,
                name,
                font.clone(),
                self.rim(),
            );
        }
        self.painter
            .text(place, Align2::CENTER_CENTER, name, font, color);
    }
}

fn arrow_head(start: Pos2, end: Pos2) -> Vec<Pos2> {
    let along = (end - start).normalized();
    let across = along.rot90();
    let neck = end - along * 8.0;
    vec![end, neck + across * 3.5, neck - across * 3.5]
}
