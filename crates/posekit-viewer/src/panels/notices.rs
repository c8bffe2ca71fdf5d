//! Notices over the view: what was done, what did not work, what has changed on disk.

use egui::{Align2, Frame, Margin, RichText, Stroke, Ui, Vec2};

use super::{Asked, Request};
use crate::icons::{Icon, sized_icon};
use crate::state::notices::{NoticeKind, Notices};
use crate::theme::{GAP, Palette};

/// Shows the notices at the top of a part of the window.
pub fn show(ui: &Ui, over: egui::Rect, notices: &mut Notices, asked: &mut Asked) {
    let mut dismissed = None;
    let palette = Palette::in_ui(ui);
    egui::Area::new(egui::Id::unique("notices"))
        .order(egui::Order::Foreground)
        .pivot(Align2::CENTER_TOP)
        .fixed_pos(over.center_top() + Vec2::new(0.0, 14.0))
        .show(ui.ctx(), |ui| {
            ui.set_max_width((over.width() - 40.0).clamp(200.0, 560.0));
            for (index, notice) in notices.shown().iter().enumerate() {
                let color = match notice.kind {
                    NoticeKind::Done => palette.good,
                    NoticeKind::Failure => palette.error,
                    NoticeKind::Changed(_) => palette.accent,
                };
                Frame::new()
                    .fill(palette.raised)
                    .stroke(Stroke::new(1.0, palette.line))
                    .corner_radius(8)
                    .inner_margin(Margin::symmetric(12, 8))
                    .shadow(ui.visuals().popup_shadow)
                    .show(ui, |ui| {
                        ui.horizontal(|ui| {
                            let (dot, _) =
                                ui.allocate_exact_size(Vec2::splat(10.0), egui::Sense::hover());
                            ui.painter().circle_filled(dot.center(), 4.0, color);
                            let room = (over.width() - 260.0).clamp(160.0, 440.0);
                            ui.scope(|ui| {
                                ui.set_max_width(room);
                                ui.add(egui::Label::new(RichText::new(&notice.text)).wrap());
                            });
                            if let NoticeKind::Changed(clip) = notice.kind
                                && ui.button("Reload").clicked()
                            {
                                asked.requests.push(Request::Reload(clip));
                            }
                            let size = Vec2::splat(22.0);
                            if sized_icon(ui, Icon::Close, "Dismiss", false, size).clicked() {
                                dismissed = Some(index);
                            }
                        });
                    });
                ui.add_space(GAP);
            }
        });
    if let Some(index) = dismissed {
        notices.dismiss(index);
    }
}
