//! Undo and redo without a limit.
//!
//! A step holds whatever turns the state before it into the one after it, and back; the history
//! keeps steps in order and says whose turn it is. What belongs to one gesture, such as all that
//! happens from pressing a button to letting it go, is one step.

/// A gesture: what is recorded while one lasts becomes one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gesture(u64);

/// A step with its name.
#[derive(Clone, Debug, PartialEq)]
struct Entry<S> {
    name: String,
    gesture: Option<Gesture>,
    step: S,
}

/// Steps that were done, and steps that were undone.
#[derive(Clone, Debug)]
pub struct History<S> {
    done: Vec<Entry<S>>,
    undone: Vec<Entry<S>>,
    next_gesture: u64,
}

impl<S> Default for History<S> {
    fn default() -> Self {
        Self {
            done: Vec::new(),
            undone: Vec::new(),
            next_gesture: 0,
        }
    }
}

impl<S> History<S> {
    /// A new gesture.
    pub fn gesture(&mut self) -> Gesture {
        self.next_gesture += 1;
        Gesture(self.next_gesture)
    }

    /// Records a step that was done. What was undone before cannot be redone any more.
    pub fn record(&mut self, name: impl Into<String>, step: S) {
        self.undone.clear();
        self.done.push(Entry {
            name: name.into(),
            gesture: None,
            step,
        });
    }

    /// Records the first step of a gesture; of a gesture whose step stands last already nothing is
    /// recorded, since that step leads back to before the gesture. True when it was recorded.
    pub fn record_in(
        &mut self,
        gesture: Gesture,
        name: impl Into<String>,
        step: impl FnOnce() -> S,
    ) -> bool {
        let last = self.done.last().and_then(|entry| entry.gesture);
        if last == Some(gesture) {
            return false;
        }
        self.undone.clear();
        self.done.push(Entry {
            name: name.into(),
            gesture: Some(gesture),
            step: step(),
        });
        true
    }

    /// Undoes the last step: `back` does it. The step's name, or `None` when there is none.
    pub fn undo(&mut self, back: impl FnOnce(&mut S)) -> Option<&str> {
        let mut entry = self.done.pop()?;
        back(&mut entry.step);
        // A gesture that was undone is over: what comes next is a step of its own.
        entry.gesture = None;
        self.undone.push(entry);
        self.undone.last().map(|entry| entry.name.as_str())
    }

    /// Does the last step that was undone again: `forth` does it.
    pub fn redo(&mut self, forth: impl FnOnce(&mut S)) -> Option<&str> {
        let mut entry = self.undone.pop()?;
        forth(&mut entry.step);
        self.done.push(entry);
        self.done.last().map(|entry| entry.name.as_str())
    }

    /// Undoes the step of a gesture if it stands last, and forgets it: the gesture was given up.
    pub fn give_up(&mut self, gesture: Gesture, back: impl FnOnce(&mut S)) -> bool {
        if self.done.last().and_then(|entry| entry.gesture) != Some(gesture) {
            return false;
        }
        if let Some(mut entry) = self.done.pop() {
            back(&mut entry.step);
        }
        true
    }

    /// The name of what would be undone.
    #[must_use]
    pub fn undo_name(&self) -> Option<&str> {
        self.done.last().map(|entry| entry.name.as_str())
    }

    /// The name of what would be redone.
    #[must_use]
    pub fn redo_name(&self) -> Option<&str> {
        self.undone.last().map(|entry| entry.name.as_str())
    }

    /// How many steps can be undone.
    #[must_use]
    pub fn len(&self) -> usize {
        self.done.len()
    }

    /// The steps that can be undone, oldest first.
    pub fn steps(&self) -> impl Iterator<Item = &S> {
        self.done.iter().map(|entry| &entry.step)
    }

    /// Whether there is nothing to undo.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.done.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state of one number; a step holds the other number.
    fn set(history: &mut History<i32>, state: &mut i32, value: i32) {
        history.record(format!("set {value}"), *state);
        *state = value;
    }

    #[test]
    fn a_thousand_steps_go_back_and_forth() {
        let (mut history, mut state) = (History::default(), 0);
        for value in 1..=1000 {
            set(&mut history, &mut state, value);
        }
        for value in (0..1000).rev() {
            assert!(
                history
                    .undo(|step| std::mem::swap(step, &mut state))
                    .is_some()
            );
            assert_eq!(state, value);
        }
        assert_eq!(history.undo(|_| ()), None);
        for value in 1..=1000 {
            let name = history.redo(|step| std::mem::swap(step, &mut state));
            assert_eq!(name, Some(format!("set {value}").as_str()));
            assert_eq!(state, value);
        }
        assert_eq!(history.redo(|_| ()), None);
    }

    #[test]
    fn a_new_step_forgets_what_was_undone() {
        let (mut history, mut state) = (History::default(), 0);
        set(&mut history, &mut state, 1);
        set(&mut history, &mut state, 2);
        history.undo(|step| std::mem::swap(step, &mut state));
        set(&mut history, &mut state, 9);
        assert_eq!(history.redo_name(), None);
        history.undo(|step| std::mem::swap(step, &mut state));
        assert_eq!((state, history.undo_name()), (1, Some("set 1")));
    }

    #[test]
    fn a_gesture_is_one_step_and_can_be_given_up() {
        let (mut history, mut state) = (History::default(), 0);
        let gesture = history.gesture();
        for value in 1..50 {
            let before = state;
            history.record_in(gesture, "drag", || before);
            state = value;
        }
        assert_eq!(history.len(), 1);
        history.undo(|step| std::mem::swap(step, &mut state));
        assert_eq!(state, 0);
        history.redo(|step| std::mem::swap(step, &mut state));
        assert_eq!(state, 49);
        let other = history.gesture();
        let before = state;
        assert!(history.record_in(other, "drag", || before));
        state = 77;
        assert!(!history.give_up(gesture, |_| ()), "it is not the last");
        assert!(history.give_up(other, |step| std::mem::swap(step, &mut state)));
        assert_eq!((state, history.len(), history.redo_name()), (49, 1, None));
    }
}
