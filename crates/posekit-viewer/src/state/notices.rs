//! Notices: short messages that go away by themselves, or when they are answered.

use super::session::ClipId;

/// How long a notice stays that only tells something, seconds.
const STAYS_SECS: f64 = 5.0;

/// How long one stays that tells of a failure.
const FAILURE_STAYS_SECS: f64 = 20.0;

/// More notices than this are not shown at once; the oldest go.
const MOST: usize = 4;

/// What a notice is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoticeKind {
    /// Something was done.
    Done,
    /// Something did not work.
    Failure,
    /// A clip's file has changed; it can be read again.
    Changed(ClipId),
}

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// What it is about.
    pub kind: NoticeKind,
    /// What it says.
    pub text: String,
    /// When it goes away, in the window's time; `None` stays until answered.
    pub until_secs: Option<f64>,
}

/// The messages shown now, oldest first.
#[derive(Clone, Debug, Default)]
pub struct Notices {
    shown: Vec<Notice>,
    last: Option<Notice>,
}

impl Notices {
    /// Shows a message at a time of the window's clock.
    pub fn add(&mut self, kind: NoticeKind, text: impl Into<String>, now_secs: f64) {
        let until_secs = match kind {
            NoticeKind::Done => Some(now_secs + STAYS_SECS),
            NoticeKind::Failure => Some(now_secs + FAILURE_STAYS_SECS),
            NoticeKind::Changed(clip) => {
                self.answer(clip);
                None
            }
        };
        let text = text.into();
        self.shown.retain(|notice| notice.text != text);
        let notice = Notice {
            kind,
            text,
            until_secs,
        };
        self.last = Some(notice.clone());
        self.shown.push(notice);
        if self.shown.len() > MOST {
            self.shown.remove(0);
        }
    }

    /// Takes away the question about a clip's changed file.
    pub fn answer(&mut self, clip: ClipId) {
        self.shown
            .retain(|notice| notice.kind != NoticeKind::Changed(clip));
    }

    /// Takes away a message.
    pub fn dismiss(&mut self, index: usize) {
        if index < self.shown.len() {
            self.shown.remove(index);
        }
    }

    /// Lets go what had its time. Returns after how many seconds the next one goes.
    pub fn tick(&mut self, now_secs: f64) -> Option<f64> {
        self.shown
            .retain(|notice| notice.until_secs.is_none_or(|until| until > now_secs));
        let times = self.shown.iter().filter_map(|notice| notice.until_secs);
        times.reduce(f64::min).map(|until| until - now_secs)
    }

    /// The messages, oldest first.
    #[must_use]
    pub fn shown(&self) -> &[Notice] {
        &self.shown
    }

    /// The message that came last, even when it is no longer shown.
    #[must_use]
    pub fn last(&self) -> Option<&Notice> {
        self.last.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_go_when_their_time_is_over() {
        let mut notices = Notices::default();
        notices.add(NoticeKind::Done, "saved", 10.0);
        notices.add(NoticeKind::Failure, "cannot", 10.0);
        assert_eq!(notices.tick(11.0), Some(4.0));
        assert_eq!(notices.tick(16.0), Some(14.0));
        assert_eq!(notices.shown().len(), 1);
        assert_eq!(notices.tick(40.0), None);
        let last = notices.last().map(|notice| notice.text.as_str());
        assert_eq!(last, Some("cannot"));
    }

    #[test]
    fn the_same_message_is_not_shown_twice_and_many_do_not_pile_up() {
        let mut notices = Notices::default();
        for n in 0..9 {
            notices.add(NoticeKind::Done, format!("number {}", n / 2), f64::from(n));
        }
        let texts: Vec<_> = notices
            .shown()
            .iter()
            .map(|notice| notice.text.as_str())
            .collect();
        assert_eq!(texts, ["number 1", "number 2", "number 3", "number 4"]);
    }
}
