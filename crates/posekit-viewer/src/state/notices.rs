//! Notices: short messages that go away by themselves, or when they are answered.

use super::session::ClipId;

/// How long a notice stays that only tells something, seconds.
const STAYS_SECS: f64 = 5.0;

/// How long one stays that tells of a failure.
const FAILURE_STAYS_SECS: f64 = 20.0;

/// More notices than this are not shown at once; of those that only tell something the oldest go first.
const MOST: usize = 3;

/// As many messages are kept to be looked up.
const KEPT: usize = 200;

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
    /// How often it was said.
    pub count: usize,
    /// When it goes away, in the window's time; `None` stays until answered.
    pub until_secs: Option<f64>,
}

/// The messages: those shown now, and those that came before.
#[derive(Clone, Debug, Default)]
pub struct Notices {
    shown: Vec<Notice>,
    /// All messages, oldest first.
    all: Vec<Notice>,
    /// How many went for lack of room, and were not looked up.
    unseen: usize,
}

impl Notices {
    /// Shows a message at a time of the window's clock. One that is shown already is counted.
    pub fn add(&mut self, kind: NoticeKind, text: impl Into<String>, now_secs: f64) {
        let until_secs = match kind {
            NoticeKind::Done => Some(now_secs + STAYS_SECS),
            NoticeKind::Failure => Some(now_secs + FAILURE_STAYS_SECS),
            NoticeKind::Changed(clip) => {
                self.answer(clip);
                None
            }
        };
        let notice = Notice {
            kind,
            text: text.into(),
            count: 1,
            until_secs,
        };
        let shown = add_to(&mut self.shown, notice.clone());
        self.shown.push(shown);
        let kept = add_to(&mut self.all, notice);
        self.all.push(kept);
        if self.all.len() > KEPT {
            self.all.remove(0);
        }
        if self.shown.len() > MOST {
            let told = |notice: &Notice| notice.kind == NoticeKind::Done;
            let oldest = self.shown[..MOST].iter().position(told).unwrap_or(0);
            self.shown.remove(oldest);
            self.unseen += 1;
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
        if self.shown.is_empty() {
            self.unseen = 0;
        }
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
        self.all.last()
    }

    /// All messages that are kept, oldest first.
    #[must_use]
    pub fn all(&self) -> &[Notice] {
        &self.all
    }

    /// How many went for lack of room since messages were shown.
    #[must_use]
    pub fn unseen(&self) -> usize {
        self.unseen
    }

    /// All messages were looked up.
    pub fn set_seen(&mut self) {
        self.unseen = 0;
    }
}

/// The message as it is said once more, if it is among these: it is taken out and counted.
fn add_to(notices: &mut Vec<Notice>, notice: Notice) -> Notice {
    let same = |other: &Notice| other.kind == notice.kind && other.text == notice.text;
    match notices.iter().position(same) {
        Some(index) => Notice {
            count: notices.remove(index).count + 1,
            ..notice
        },
        None => notice,
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
    fn equal_messages_are_counted_and_many_do_not_pile_up() {
        let mut notices = Notices::default();
        for n in 0..9 {
            notices.add(NoticeKind::Done, format!("number {}", n / 2), f64::from(n));
        }
        let shown = |notices: &Notices| -> Vec<(String, usize)> {
            let shown = notices.shown().iter();
            shown
                .map(|notice| (notice.text.clone(), notice.count))
                .collect()
        };
        let counted = |text: &str, count| (text.to_owned(), count);
        let last = [
            counted("number 2", 2),
            counted("number 3", 2),
            counted("number 4", 1),
        ];
        assert_eq!(shown(&notices), last);
        assert_eq!((notices.unseen(), notices.all().len()), (2, 5));
        notices.set_seen();
        assert_eq!(notices.unseen(), 0);
    }

    #[test]
    fn what_went_wrong_stays_while_other_messages_come() {
        let mut notices = Notices::default();
        notices.add(NoticeKind::Failure, "cannot", 0.0);
        for n in 0..500 {
            notices.add(NoticeKind::Done, format!("number {n}"), 0.0);
        }
        assert_eq!(notices.shown()[0].text, "cannot");
        assert_eq!(notices.shown().len(), 3);
        assert_eq!(notices.all().len(), KEPT);
    }
}
