//! What the viewer shows, in words for whoever looks on from outside: the page that it stands in.
//!
//! A picture that stands still does not tell whether a key was taken or is still on its way; these
//! words do.

use egui::Rect;

use super::Viewer;
use crate::panels::export::ExportWindow;
use crate::panels::text::TextPlaces;
use crate::state::notices::NoticeKind;

/// Where parts of the window are that a pointer may be sent to, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Places {
    /// The view of the figure.
    pub(super) view: Rect,
    /// The part of the time line on which frames are: its ends are the first frame and the last.
    pub(super) time_line: Rect,
    /// The text.
    pub(super) text: TextPlaces,
}

impl Default for Places {
    fn default() -> Self {
        Self {
            view: Rect::ZERO,
            time_line: Rect::ZERO,
            text: TextPlaces::NONE,
        }
    }
}

/// What the viewer shows: names and values, always the same names in the same order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Status(Vec<(&'static str, String)>);

impl Status {
    /// What is said under a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&str> {
        let found = self.0.iter().find(|(known, _)| *known == name);
        found.map(|(_, value)| value.as_str())
    }

    /// All names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.0.iter().map(|(name, value)| (*name, value.as_str()))
    }
}

impl Viewer {
    /// What is shown now. `docs/viewer.md` says what each name means.
    #[must_use]
    pub fn status(&self, ctx: &egui::Context) -> Status {
        let session = &self.session;
        let transport = &session.transport;
        let clip = session.active_clip().map(|clip| clip.name.clone());
        let notice = self.notices.last();
        let kind = notice.map_or("", |notice| match notice.kind {
            NoticeKind::Done => "done",
            NoticeKind::Failure => "failure",
            NoticeKind::Changed(_) => "changed",
        });
        let (first, last) = transport.range();
        let place = |rect: Rect| place_text(rect * ctx.zoom_factor());
        Status(vec![
            ("clip", clip.unwrap_or_default()),
            ("shown", session.shown().count().to_string()),
            ("mode", session.mode().name().to_owned()),
            ("frame", transport.frame().to_string()),
            ("last-frame", transport.last_frame().to_string()),
            ("range", format!("{first} {last}")),
            ("playing", transport.is_playing().to_string()),
            ("camera", self.camera_text()),
            ("working", self.is_working().to_string()),
            ("export", self.export_text()),
            ("saved", self.saved_count.to_string()),
            ("notice", notice.map_or("", |n| &n.text).to_owned()),
            ("notice-kind", kind.to_owned()),
            ("notices", self.notices.shown().len().to_string()),
            ("view-place", place(self.places.view)),
            ("time-line-place", place(self.places.time_line)),
            ("text", self.text_text()),
            ("text-place", place(self.places.text.lines)),
            ("text-row-place", place(self.places.text.row)),
            ("pictures", self.picture_count.to_string()),
            ("drawn", self.is_drawn().to_string()),
        ])
    }

    /// From where the view looks: degrees about the figure from its front, degrees above the horizon.
    fn camera_text(&self) -> String {
        let orbit = self.session.camera.still();
        let about = orbit.yaw_rad - self.session.stage().facing_yaw_rad();
        let about = about.to_degrees().rem_euclid(360.0).round() % 360.0;
        format!("{about:.0} {:.0}", orbit.pitch_rad.to_degrees())
    }

    fn text_text(&self) -> String {
        if !self.layout.text {
            return "closed".to_owned();
        }
        self.text.status(&self.session)
    }

    fn export_text(&self) -> String {
        match &self.export {
            ExportWindow::Closed => "closed".to_owned(),
            ExportWindow::Choosing(_) => "choosing".to_owned(),
            ExportWindow::Running(running) => {
                let (done, total) = running.frames();
                format!("{done} of {total}")
            }
        }
    }
}

fn place_text(rect: Rect) -> String {
    if rect.is_negative() {
        return String::new();
    }
    let Rect { min, max } = rect;
    format!("{:.0} {:.0} {:.0} {:.0}", min.x, min.y, max.x, max.y)
}
