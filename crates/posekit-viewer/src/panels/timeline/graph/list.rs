//! The list of channels: what is seen as curves, and what could be.

use egui::{Align, Layout, Rect, RichText, ScrollArea, Sense, Ui, pos2, vec2};
use posekit::rotation::EulerOrder;

use super::{GraphPanel, plane};
use crate::command::KeysCommand;
use crate::icons::{Icon, icon_button, sized_icon};
use crate::panels::row;
use crate::state::animate::graph::ChannelId;
use crate::state::animate::{Lane, Owner};
use crate::state::session::Session;
use crate::theme::{GAP, Palette};

/// Height of a row.
const LIST_ROW: f32 = 20.0;

/// The orders of angles that are offered.
const ORDERS: [EulerOrder; 6] = [
    EulerOrder::XYZ,
    EulerOrder::XZY,
    EulerOrder::YXZ,
    EulerOrder::YZX,
    EulerOrder::ZXY,
    EulerOrder::ZYX,
];

/// Shows the list.
pub(super) fn show(ui: &mut Ui, session: &mut Session, panel: &mut GraphPanel) {
    head(ui, panel);
    let Some(authored) = session.authored() else {
        return;
    };
    let lanes = authored.lanes();
    let (shown, others): (Vec<Lane>, Vec<Lane>) = lanes
        .into_iter()
        .filter(|lane| authored.track(*lane).is_some())
        .partition(|lane| panel.graph.curves().contains_key(lane));
    ScrollArea::vertical()
        .id_salt("channels")
        .min_scrolled_height(LIST_ROW)
        .auto_shrink([false, false])
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(GAP, 1.0);
            for lane in shown {
                lane_row(ui, session, panel, lane, true);
                channels(ui, session, panel, lane);
            }
            if others.is_empty() {
                return;
            }
            ui.add_space(GAP);
            let quiet = Palette::in_ui(ui).quiet;
            ui.label(RichText::new("Also keyed").small().color(quiet));
            for lane in others {
                lane_row(ui, session, panel, lane, false);
            }
        });
}

/// The order of angles, and what takes curves into view.
fn head(ui: &mut Ui, panel: &mut GraphPanel) {
    ui.horizontal(|ui| {
        ui.set_min_height(24.0);
        let order = panel.graph.order();
        let text = order.map_or("Angles as in file".to_owned(), name_of);
        egui::ComboBox::from_id_salt("order of angles")
            .selected_text(text)
            .width(124.0)
            .show_ui(ui, |ui| {
                let mut chosen = order;
                ui.selectable_value(&mut chosen, None, "Angles as in file");
                for order in ORDERS {
                    ui.selectable_value(&mut chosen, Some(order), name_of(order));
                }
                panel.graph.set_order(chosen);
            })
            .response
            .on_hover_text(
                "The order in which the angles of quaternions are shown. It changes what is drawn, not the \
                 keys. Euler curves have an order of their own: Rotation mode (right button) changes it.",
            );
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let says = "View all (Home); what is selected: the full stop";
            if icon_button(ui, Icon::Frame, says).clicked() {
                panel.run(KeysCommand::ViewAll);
            }
        });
    });
}

fn name_of(order: EulerOrder) -> String {
    let letters: String = order.axes().iter().map(|axis| axis.letter()).collect();
    format!("Angles {letters}")
}

/// A lane: an eye, and its name. A joint's is selected with it.
fn lane_row(
    ui: &mut Ui,
    session: &mut Session,
    panel: &mut GraphPanel,
    lane: Lane,
    is_shown: bool,
) {
    let Some(authored) = session.authored() else {
        return;
    };
    let name = lane.label(authored.scene(), authored.skeleton());
    let palette = Palette::in_ui(ui);
    let (rect, response) = row::row(ui, LIST_ROW, false, &name);
    let color = if is_shown {
        palette.text
    } else {
        palette.quiet
    };
    let seen = !panel.graph.seen_channels(lane).is_empty();
    let eye = Rect::from_min_size(
        rect.right_top() - vec2(LIST_ROW, 0.0),
        vec2(LIST_ROW, LIST_ROW),
    );
    let place = Rect::from_min_max(rect.min + vec2(GAP, 0.0), pos2(eye.left(), rect.bottom()));
    row::text_in(ui, place, RichText::new(&name).size(12.5), color);
    let (icon, says) = if seen {
        (Icon::Eye, format!("Hide {name}"))
    } else {
        (Icon::EyeOff, format!("Show {name}"))
    };
    let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(eye));
    if sized_icon(&mut inner, icon, &says, false, eye.size()).clicked() {
        if !is_shown {
            panel.graph.set_pinned(lane, true);
        } else if panel.graph.is_pinned(lane) && seen {
            panel.graph.set_pinned(lane, false);
        } else {
            set_all(panel, lane, !seen);
        }
    } else if response.clicked() {
        match lane.owner() {
            Owner::Joint(joint) => session.select(Some(joint)),
            _ if is_shown => set_all(panel, lane, true),
            _ => panel.graph.set_pinned(lane, true),
        }
    }
}

fn set_all(panel: &mut GraphPanel, lane: Lane, is_seen: bool) {
    for channel in 0..3 {
        panel.graph.set_seen(ChannelId { lane, channel }, is_seen);
    }
}

/// The channels of a lane: colour, letter, value at the time shown.
fn channels(ui: &mut Ui, session: &Session, panel: &mut GraphPanel, lane: Lane) {
    let Some(curves) = panel.graph.curves().get(&lane).cloned() else {
        return;
    };
    if curves.count() == 1 {
        return;
    }
    let now = curves.at(session.scene_secs());
    let unit = super::paint::unit_of(lane);
    for (channel, value) in now.into_iter().enumerate().take(curves.count()) {
        let id = ChannelId { lane, channel };
        let seen = panel.graph.is_seen(id);
        let name = super::paint::channel_name(lane, &curves, channel);
        let palette = Palette::in_ui(ui);
        let (rect, response) =
            ui.allocate_exact_size(vec2(ui.available_width(), LIST_ROW - 2.0), Sense::click());
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, seen, name));
        if response.hovered() {
            ui.painter().rect_filled(rect, 5.0, palette.hover);
        }
        let color = super::paint::channel_color(&curves, channel);
        let swatch = Rect::from_center_size(
            pos2(rect.left() + 4.0 * GAP, rect.center().y),
            vec2(9.0, 9.0),
        );
        if seen {
            ui.painter().rect_filled(swatch, 2.0, color);
        } else {
            let edge = egui::Stroke::new(1.2, color);
            ui.painter()
                .rect_stroke(swatch, 2.0, edge, egui::StrokeKind::Inside);
        }
        let text_color = if seen { palette.text } else { palette.quiet };
        let text = Rect::from_min_max(pos2(swatch.right() + 2.0 * GAP, rect.top()), rect.max);
        row::text_in(ui, text, RichText::new(name).size(12.5), text_color);
        let value = format!("{}{unit}", plane::number_text(value, 0.01));
        ui.painter().text(
            rect.right_center() - vec2(GAP, 0.0),
            egui::Align2::RIGHT_CENTER,
            value,
            egui::FontId::monospace(11.5),
            palette.quiet,
        );
        if response
            .on_hover_text(if seen {
                "Hide this curve"
            } else {
                "Show this curve"
            })
            .clicked()
        {
            panel.graph.set_seen(id, !seen);
        }
    }
}
