//! The numbers of a camera, light or prop, each property with its key button.

use egui::{Color32, DragValue, Response, Sense, Stroke, Ui, vec2};
use glam::{DQuat, DVec3};
use posekit::rotation::EulerOrder;
use posekit_render::color::{linear_from_srgb, srgb_from_linear};

use super::super::row;
use crate::state::animate::place::is_simple_shape;
use crate::state::animate::{Authored, Lane, LaneValue, Owner};
use crate::state::edit::Gesture;
use crate::state::session::{KeyState, Session};
use crate::state::things::{Part, Picked};
use crate::theme::{GAP, Palette};

/// The order of the axes in which a prop's rotation is shown.
const EULER: EulerOrder = EulerOrder::XYZ;

/// Angles of view that are offered, degrees.
const FOV_DEG: std::ops::RangeInclusive<f64> = 1.0..=150.0;

/// Shows the name and the properties of what is picked.
pub(super) fn show(ui: &mut Ui, session: &mut Session, picked: Picked) {
    name(ui, session, picked.owner);
    mesh_note(ui, session, picked.owner);
    for lane in picked.owner.lanes() {
        let Some(value) = session.value_of(lane) else {
            continue;
        };
        row::line(ui, lane.property(), |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            key_button(ui, session, lane);
            let changed = edit(ui, session, (lane, value));
            if let Some((value, response)) = changed
                && let Some(gesture) = gesture_of(ui, session, &response)
            {
                let owner = session.name_of(lane.owner()).unwrap_or_default();
                let property = lane.property().to_lowercase();
                let step = format!("Set the {property} of {}", owner.to_lowercase());
                session.set_values(&step, &[(lane, value)], Some(gesture));
            }
        });
    }
    if let Owner::Camera(_) = picked.owner {
        row::line(ui, "Handle", |ui| {
            for (name, part) in [("Camera", Part::Body), ("Target", Part::Target)] {
                let on = picked.part == part;
                if ui.selectable_label(on, name).clicked() && !on {
                    session.pick(Some(Picked { part, ..picked }));
                }
            }
        });
        ui.horizontal(|ui| {
            let command = crate::command::Command::CameraToView;
            let says = super::tip("The camera takes the place of the view", command);
            if ui.button("Camera to view").on_hover_text(says).clicked() {
                session.camera_to_view();
            }
        });
    }
}

/// What stands for a mesh file, and for which.
fn mesh_note(ui: &mut Ui, session: &Session, owner: Owner) {
    let Owner::Prop(index) = owner else { return };
    let scene = session.authored().map(Authored::scene);
    let shape = scene.and_then(|scene| scene.props.get(index).map(|prop| &prop.shape));
    if let Some(file) = shape.filter(|shape| !is_simple_shape(shape)) {
        let says = format!("Mesh files cannot be read yet: a box is shown in place of {file}");
        row::empty_note(ui, &says);
    }
}

/// The name is taken when the field is left.
fn name(ui: &mut Ui, session: &mut Session, owner: Owner) {
    let Some(scene) = session.authored().map(Authored::scene) else {
        return;
    };
    let now = match owner {
        Owner::Joint(_) => None,
        Owner::Camera(i) => scene.cameras.get(i).map(|it| &it.name),
        Owner::Light(i) => scene.lights.get(i).map(|it| &it.name),
        Owner::Prop(i) => scene.props.get(i).map(|it| &it.name),
    };
    let Some(now) = now.cloned() else { return };
    let id = ui.make_persistent_id(("thing name", owner));
    let mut text: String = ui
        .data(|data| data.get_temp(id))
        .unwrap_or_else(|| now.clone());
    row::line(ui, "Name", |ui| {
        let field = egui::TextEdit::singleline(&mut text)
            .id(id.with("field"))
            .desired_width(ui.available_width() - 4.0);
        let response = ui.add(field);
        if response.lost_focus() {
            let given_up = ui.input(|i| i.key_pressed(egui::Key::Escape));
            if !given_up && text.trim() != now && !text.trim().is_empty() {
                session.rename_thing(owner, text.trim());
            }
            ui.data_mut(|data| data.remove_temp::<String>(id));
        } else if response.has_focus() {
            ui.data_mut(|data| data.insert_temp(id, text.clone()));
        }
    });
}

/// Shows a value to be changed: the new one, and the field that was used.
fn edit(
    ui: &mut Ui,
    session: &Session,
    (lane, value): (Lane, LaneValue),
) -> Option<(LaneValue, Response)> {
    let step = f64::from(session.stage().stature()) / 400.0;
    let (value, response) = match (lane, value) {
        (Lane::CameraFov(_), LaneValue::Number(mut degrees)) => {
            let field = DragValue::new(&mut degrees).speed(0.2).range(FOV_DEG);
            let response = field_of(ui, field.suffix("\u{b0}").max_decimals(2), lane, "");
            (LaneValue::Number(degrees), response)
        }
        (_, LaneValue::Number(mut number)) => {
            let field = DragValue::new(&mut number).speed(0.01);
            let field = field.range(0.0..=f64::INFINITY).max_decimals(3);
            let response = field_of(ui, field, lane, "");
            (LaneValue::Number(number), response)
        }
        (Lane::LightColor(_), LaneValue::Vector(color)) => {
            let (color, response) = color_field(ui, color);
            (LaneValue::Vector(color), response)
        }
        (_, LaneValue::Vector(mut vector)) => {
            let speed = if matches!(lane, Lane::PropScale(_)) {
                0.01 * vector.abs().max_element().max(0.01)
            } else {
                step
            };
            let response = three(ui, lane, vector.as_mut(), speed, "");
            (LaneValue::Vector(vector), response)
        }
        (_, LaneValue::Orientation(orientation)) => {
            let euler = EULER.from_quat(orientation);
            // Zero has one sign.
            let shown = euler
                .angles_rad
                .map(|angle| (angle.to_degrees() * 1e9).round() / 1e9 + 0.0);
            let mut angles = shown;
            let response = three(ui, lane, &mut angles, 0.5, "\u{b0}");
            // Angles are one way to write an orientation of several: what was not touched stays.
            let turned = if angles == shown {
                orientation
            } else {
                DQuat::normalize(EULER.to_quat(angles.map(f64::to_radians)))
            };
            (LaneValue::Orientation(turned), response)
        }
    };
    response.changed().then_some((value, response))
}

/// Three numbers beside each other.
fn three(ui: &mut Ui, lane: Lane, numbers: &mut [f64; 3], speed: f64, suffix: &str) -> Response {
    let width = ((ui.available_width() - 2.0 * 2.0) / 3.0).max(40.0);
    let mut responses = Vec::with_capacity(3);
    for (axis, number) in ["x", "y", "z"].into_iter().zip(numbers) {
        let field = DragValue::new(number).speed(speed).max_decimals(3);
        ui.scope(|ui| {
            ui.spacing_mut().interact_size.x = width;
            ui.set_max_width(width);
            responses.push(field_of(ui, field.suffix(suffix), lane, axis));
        });
    }
    let mut all = responses.into_iter();
    let first = all.next();
    let joined = all.fold(first, |joined, next| joined.map(|joined| joined | next));
    joined.unwrap_or_else(|| ui.label(""))
}

/// A number with the name by which it is found: `Position x`.
fn field_of(ui: &mut Ui, field: DragValue<'_>, lane: Lane, axis: &str) -> Response {
    let response = ui.add(field.update_while_editing(false));
    let name = format!("{} {axis}", lane.property());
    let name = name.trim_end().to_owned();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, &name));
    response
}

/// A linear colour, chosen as it looks.
fn color_field(ui: &mut Ui, color: DVec3) -> (DVec3, Response) {
    #[expect(clippy::cast_possible_truncation, reason = "a colour on the screen")]
    let encoded = |part: f64| srgb_from_linear(part.clamp(0.0, 1.0) as f32);
    let shown = color.to_array().map(encoded);
    let mut chosen = shown;
    let response = ui.color_edit_button_rgb(&mut chosen);
    let mut new = color.to_array();
    for ((new, chosen), shown) in new.iter_mut().zip(chosen).zip(shown) {
        if (chosen - shown).abs() > 1e-6 {
            let linear = f64::from(linear_from_srgb(chosen));
            *new = (linear * 1e4).round() / 1e4;
        }
    }
    (new.into(), response)
}

/// The key button: a diamond, full with a key at the time shown, empty with keys elsewhere.
fn key_button(ui: &mut Ui, session: &mut Session, lane: Lane) {
    let state = session.key_state(lane);
    let (says, is_keyed) = match state {
        KeyState::Unkeyed => ("Not keyed: key it here", false),
        KeyState::Keyed => ("Keyed at other times: key it here", true),
        KeyState::KeyHere => ("Delete the key at this time", true),
        KeyState::Changed => ("Changed: key it, or it is gone at another time", true),
    };
    let (rect, response) = ui.allocate_exact_size(vec2(18.0, 20.0), Sense::click());
    let name = format!("Key {}", lane.property().to_lowercase());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_keyed, &name));
    let palette = Palette::in_ui(ui);
    let color = match state {
        KeyState::Changed => palette.warning,
        _ if response.hovered() || is_keyed => palette.accent,
        _ => palette.quiet,
    };
    let (center, r) = (rect.center(), 5.0);
    let diamond = [(0.0, -r), (r, 0.0), (0.0, r), (-r, 0.0)].map(|(x, y)| center + vec2(x, y));
    let fill = match state {
        KeyState::KeyHere | KeyState::Changed => color,
        KeyState::Unkeyed | KeyState::Keyed => Color32::TRANSPARENT,
    };
    let width = if is_keyed { 1.6 } else { 1.0 };
    ui.painter().add(egui::Shape::convex_polygon(
        diamond.to_vec(),
        fill,
        Stroke::new(width, color),
    ));
    if response.on_hover_text(says).clicked() {
        session.toggle_key(lane);
    }
    ui.add_space(GAP - 2.0);
}

/// All that happens while a field is dragged, or a colour is chosen, is one gesture; anything else is
/// one of its own.
fn gesture_of(ui: &Ui, session: &mut Session, response: &Response) -> Option<Gesture> {
    let id = egui::Id::unique("thing gesture");
    let started = ui.input(|i| i.pointer.primary_pressed());
    let held = response.dragged() || ui.input(|i| i.pointer.primary_down());
    let running: Option<Gesture> = ui.data(|data| data.get_temp(id));
    if let (Some(gesture), true, false) = (running, held, started) {
        return Some(gesture);
    }
    let gesture = session.author(|authored| authored.gesture())?;
    ui.data_mut(|data| data.insert_temp(id, gesture));
    Some(gesture)
}
