//! Notices over the view: what was done, what did not work, what has changed on disk; and all of them, to be
//! looked up.

use egui::text::TextWrapping;
use egui::{
    Align, Align2, Frame, Label, Layout, Margin, RichText, ScrollArea, Stroke, Ui, Vec2, vec2,
};

use super::{Asked, Request};
use crate::icons::{Icon, icon_button, sized_icon};
use crate::state::notices::{Notice, NoticeKind, Notices};
use crate::theme::{GAP, Palette};

/// A notice is this wide where there is room.
const WIDTH: f32 = 460.0;

/// Longer messages end in an ellipsis; the whole is in the list of all.
const MOST_LINES: u8 = 3;

/// What lies under the notices at the bottom of the view: the line that says what the pointer does.
const HINT_ROOM: f32 = 40.0;

/// What lies beside and around the text of a card.
const CARD: Vec2 = vec2(22.0, 12.0);

/// A line of text is about as high as this.
const LINE: f32 = 18.0;

/// How many of the newest messages are shown, and how many lines of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shown {
    count: u8,
    lines: u8,
}

impl Shown {
    /// As much as has its place in so much height: of `most` messages, each with something to press that is
    /// `row` high, with a card more where some came earlier. One is shown always.
    fn within(height: f32, most: u8, has_earlier: bool, row: f32) -> Self {
        let card = |lines: u8| (f32::from(lines) * LINE).max(row) + CARD.y + GAP;
        let fits = |shown: Self| {
            let cards = f32::from(shown.count) * card(shown.lines);
            let earlier = if has_earlier || shown.count < most {
                card(1)
            } else {
                0.0
            };
            cards + earlier <= height
        };
        let all = (1..=MOST_LINES)
            .rev()
            .map(|lines| Self { count: most, lines });
        let fewer = (1..most).rev().map(|count| Self { count, lines: 1 });
        let one = Self { count: 1, lines: 1 };
        all.chain(fewer).find(|shown| fits(*shown)).unwrap_or(one)
    }
}

/// Shows the notices at the bottom of a part of the window in which nothing is to be pressed, over the line that
/// says what the pointer does. True when all are asked for.
pub fn show(ui: &Ui, over: egui::Rect, notices: &mut Notices, asked: &mut Asked) -> bool {
    if notices.shown().is_empty() {
        return false;
    }
    let mut dismissed = None;
    let mut wants_all = false;
    let width = WIDTH.min(over.width() - 4.0 * GAP);
    if width < 120.0 {
        return false;
    }
    let row = ui.spacing().interact_size.y;
    let most = u8::try_from(notices.shown().len()).unwrap_or(u8::MAX);
    let unseen = notices.unseen();
    // In a low view the line of the pointer gives its room.
    let hint = HINT_ROOM.min(0.2 * over.height());
    let shown = Shown::within(over.height() - hint, most, unseen > 0, row);
    let first = usize::from(most - shown.count);
    let earlier = unseen + first;
    egui::Area::new(egui::Id::unique("notices"))
        .order(egui::Order::Middle)
        .pivot(Align2::CENTER_BOTTOM)
        .fixed_pos(over.center_bottom() - Vec2::new(0.0, hint))
        .constrain_to(over)
        .show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = GAP;
            ui.set_width(width);
            if earlier > 0 {
                let text = match earlier {
                    1 => "1 earlier message: show all".to_owned(),
                    count => format!("{count} earlier messages: show all"),
                };
                card(ui, width, |ui| {
                    let link = ui.link(RichText::new(text).small());
                    wants_all = link.clicked();
                });
            }
            for (index, notice) in notices.shown().iter().enumerate().skip(first) {
                card(ui, width, |ui| {
                    if message(ui, notice, shown.lines, asked) {
                        dismissed = Some(index);
                    }
                });
            }
        });
    if let Some(index) = dismissed {
        notices.dismiss(index);
    }
    if wants_all {
        notices.set_seen();
    }
    wants_all
}

fn card(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui)) {
    let palette = Palette::in_ui(ui);
    Frame::new()
        .fill(palette.raised)
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(8)
        .inner_margin(Margin::symmetric(10, 6))
        .show(ui, |ui| {
            ui.set_width(width - CARD.x);
            ui.horizontal(contents);
        });
}

/// A message with what can be done about it. True when it is dismissed.
fn message(ui: &mut Ui, notice: &Notice, lines: u8, asked: &mut Asked) -> bool {
    let mut is_dismissed = false;
    dot(ui, notice);
    // From the right, so that what is left for the text is known.
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        is_dismissed = sized_icon(ui, Icon::Close, "Dismiss", false, Vec2::splat(24.0)).clicked();
        if let NoticeKind::Changed(clip) = notice.kind
            && ui.button("Reload").clicked()
        {
            asked.requests.push(Request::Reload(clip));
        }
        if notice.count > 1 {
            let text = format!("\u{d7}{}", notice.count);
            let label = ui.label(RichText::new(text).color(Palette::in_ui(ui).quiet));
            label.on_hover_text(format!("Said {} times", notice.count));
        }
        let room = vec2(ui.available_width(), 24.0);
        let layout = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(room, layout, |ui| {
            ui.set_min_width(room.x);
            let text = egui::WidgetText::from(notice.text.as_str());
            let mut job = std::sync::Arc::unwrap_or_clone(text.into_layout_job(
                ui.style(),
                egui::FontSelection::Default,
                Align::Min,
            ));
            job.wrap = TextWrapping {
                max_width: room.x,
                max_rows: usize::from(lines),
                ..TextWrapping::default()
            };
            let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
            let is_cut = galley.elided;
            let label = ui.add(Label::new(galley));
            if is_cut {
                label.on_hover_text(&notice.text);
            }
        });
    });
    is_dismissed
}

fn dot(ui: &mut Ui, notice: &Notice) {
    let palette = Palette::in_ui(ui);
    let color = match notice.kind {
        NoticeKind::Done => palette.good,
        NoticeKind::Failure => palette.error,
        NoticeKind::Changed(_) => palette.accent,
    };
    let (dot, _) = ui.allocate_exact_size(Vec2::splat(10.0), egui::Sense::hover());
    ui.painter().circle_filled(dot.center(), 4.0, color);
}

/// Shows all messages in a window of their own, the last first. False when it was closed.
pub fn show_all(ctx: &egui::Context, notices: &Notices) -> bool {
    let mut open = true;
    let screen = ctx.content_rect();
    let modal = egui::Modal::new(egui::Id::unique("messages"));
    let modal = modal.frame(super::modal_frame(ctx)).show(ctx, |ui| {
        ui.set_width((screen.width() - 64.0).clamp(160.0, 620.0));
        ui.horizontal(|ui| {
            ui.heading("Messages");
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if icon_button(ui, Icon::Close, "Close  (Esc)").clicked() {
                    open = false;
                }
            });
        });
        ui.add_space(GAP);
        let height = (screen.height() - 140.0).max(80.0);
        let area = ScrollArea::vertical()
            .auto_shrink([false, true])
            .max_height(height)
            .min_scrolled_height(height.min(240.0));
        area.show(ui, |ui| {
            for notice in notices.all().iter().rev() {
                ui.horizontal_top(|ui| {
                    dot(ui, notice);
                    let text = match notice.count {
                        1 => notice.text.clone(),
                        count => format!("{} (\u{d7}{count})", notice.text),
                    };
                    ui.add(Label::new(text).wrap().selectable(true));
                });
            }
            if notices.all().is_empty() {
                super::row::empty_note(ui, "No messages yet.");
            }
        });
    });
    open && !modal.should_close()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_messages_are_shown_as_have_their_place() {
        let within = |height, most, has_earlier| {
            let shown = Shown::within(height, most, has_earlier, 24.0);
            (shown.count, shown.lines)
        };
        assert_eq!(within(600.0, 3, true), (3, 3));
        assert_eq!(within(600.0, 1, false), (1, 3));
        assert_eq!(within(160.0, 3, false), (3, 2));
        assert_eq!(within(130.0, 3, false), (3, 1));
        assert_eq!(within(100.0, 3, false), (1, 1));
        assert_eq!(within(20.0, 3, true), (1, 1), "one is shown always");
        for height in [60.0, 90.0, 120.0, 150.0, 200.0, 300.0] {
            let (count, lines) = within(height, 3, false);
            assert!(count >= 1 && lines >= 1 && (count == 3 || lines == 1));
        }
    }
}
