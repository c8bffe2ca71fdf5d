//! The scene's cameras, lights and props: a list to pick from, and the numbers of the one that is picked.

mod fields;

use egui::{Rect, RichText, Ui, pos2, vec2};

use super::{row, tip};
use crate::command::Command;
use crate::icons::{self, Icon, sized_icon};
use crate::state::animate::Owner;
use crate::state::session::{NewThing, Session};
use crate::state::things::Picked;
use crate::theme::{GAP, Palette};

/// Height of a thing's row.
const THING_ROW: f32 = 24.0;

/// Shows the part of the inspector that is about cameras, lights and props.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let Some(owners) = session.authored().map(|it| it.owners_around()) else {
        return;
    };
    row::heading(ui, "Cameras, lights, props", |ui| {
        let menu = egui::containers::menu::MenuButton::new("Add");
        let (button, _) = menu.ui(ui, |ui| {
            for what in NewThing::ALL {
                if ui.button(what.name()).clicked() {
                    session.add_thing(what);
                }
            }
            let three = ui.button("Three-point lights");
            let says = "A key, a fill and a rim light around what the view looks at, in place of the studio light";
            if three.on_hover_text(says).clicked() {
                session.add_three_point_lights();
            }
        });
        button.on_hover_text("A camera where the view is, a light, or a prop beside the figure");
    });
    if owners.is_empty() {
        let says =
            "A shot is taken by its camera, lit by its lights, and has props standing around.";
        row::empty_note(ui, says);
    }
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for owner in owners {
            thing_row(ui, session, owner);
        }
    });
    if let Some(mut on) = session.studio_light() {
        ui.checkbox(&mut on, "Studio light")
            .on_hover_text("The light that pictures have without any lights; it casts the shadow");
        session.set_studio_light(on);
    }
    let picked = session.picked();
    if let Some(picked) = picked {
        ui.add_space(GAP);
        let fields = ui.scope(|ui| fields::show(ui, session, picked)).response;
        // What is picked in the view may have its numbers out of sight.
        if scrolled_to(ui) != Some(picked) {
            ui.scroll_to_rect(fields.rect, None);
        }
    }
    ui.data_mut(|data| data.insert_temp(egui::Id::unique(SCROLLED_TO), picked));
}

/// Under this name egui remembers whose numbers were scrolled to.
const SCROLLED_TO: &str = "thing scrolled to";

fn scrolled_to(ui: &Ui) -> Option<Picked> {
    let kept: Option<Option<Picked>> = ui.data(|data| data.get_temp(egui::Id::unique(SCROLLED_TO)));
    kept.flatten()
}

fn thing_row(ui: &mut Ui, session: &mut Session, owner: Owner) {
    let Some(authored) = session.authored() else {
        return;
    };
    let full = owner.name(authored.scene(), authored.skeleton());
    let picked = session.picked().is_some_and(|it| it.owner == owner);
    let (rect, response) = row::row(ui, THING_ROW, picked, &full);
    let palette = Palette::in_ui(ui);
    let mark = Rect::from_center_size(pos2(rect.left() + 14.0, rect.center().y), vec2(14.0, 14.0));
    let color = if picked {
        palette.accent
    } else {
        palette.quiet
    };
    icons::draw(ui.painter(), icon_of(session, owner), mark, color);
    let buttons = match owner {
        Owner::Camera(_) => 48.0,
        _ => 24.0,
    };
    let text = Rect::from_min_max(
        pos2(rect.left() + 28.0, rect.top()),
        pos2(rect.right() - buttons - GAP, rect.bottom()),
    );
    row::text_in(ui, text, RichText::new(&full), palette.text);
    if response.clicked() {
        session.pick(Some(Picked::body(owner)));
    }
    let place = Rect::from_min_max(pos2(rect.right() - buttons, rect.top()), rect.max);
    let mut ui = ui.new_child(
        egui::UiBuilder::new()
            .max_rect(place)
            .layout(egui::Layout::right_to_left(egui::Align::Center)),
    );
    ui.spacing_mut().item_spacing.x = 0.0;
    let size = vec2(24.0, 22.0);
    let says = format!("Delete {full}");
    if sized_icon(&mut ui, Icon::Close, &says, false, size).clicked() {
        session.remove_thing(owner);
    }
    if let Owner::Camera(index) = owner {
        let on = session.looks_through() == Some(index);
        let says = tip(&format!("Look through {full}"), Command::LookThrough);
        if sized_icon(&mut ui, Icon::Eye, &says, on, size).clicked() {
            session.look_through((!on).then_some(index));
        }
    }
}

fn icon_of(session: &Session, owner: Owner) -> Icon {
    let shape = |index: usize| {
        let props = session.authored().map(|it| &it.scene().props);
        props.and_then(|props| props.get(index).map(|prop| prop.shape.clone()))
    };
    match owner {
        Owner::Joint(_) => Icon::Figure,
        Owner::Camera(_) => Icon::Camera,
        Owner::Light(_) => Icon::Sun,
        Owner::Prop(index) if shape(index).as_deref() == Some("sphere") => Icon::Ball,
        Owner::Prop(_) => Icon::Box,
    }
}
