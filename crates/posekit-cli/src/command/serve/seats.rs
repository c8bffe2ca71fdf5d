//! Room for a number of connections, and who has to leave when it is full.
//!
//! A connection has a seat. When all are taken, the one on which nothing has moved for the longest time
//! leaves, so that those who say nothing or do not read keep nobody out. One that waits for the server
//! itself is not idle.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::Notify;
use tokio::task::AbortHandle;

/// On a connection that moves, something moves at least this often: nobody has to leave before.
const LEAST_IDLE: Duration = Duration::from_secs(1);

/// Room for a number of connections.
#[derive(Debug)]
pub(super) struct Seats {
    most: usize,
    taken: Mutex<BTreeMap<u64, Taken>>,
    freed: Notify,
}

#[derive(Debug)]
struct Taken {
    activity: Arc<Activity>,
    task: AbortHandle,
}

/// What moves on a connection.
#[derive(Debug)]
pub(super) struct Activity {
    moved: Mutex<Instant>,
    answering: AtomicUsize,
    is_cut: AtomicBool,
}

impl Activity {
    fn new() -> Self {
        Self {
            moved: Mutex::new(Instant::now()),
            answering: AtomicUsize::new(0),
            is_cut: AtomicBool::new(false),
        }
    }

    /// Bytes came or went.
    pub(super) fn move_on(&self) {
        *self.moved.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
    }

    /// What was not taken of an answer is not worth keeping: the connection is to end at once.
    pub(super) fn cut(&self) {
        self.is_cut.store(true, Ordering::Relaxed);
    }

    /// Whether it is.
    pub(super) fn is_cut(&self) -> bool {
        self.is_cut.load(Ordering::Relaxed)
    }

    /// While what this gives lives, the server works for the connection.
    pub(super) fn answering(self: &Arc<Self>) -> Answering {
        self.answering.fetch_add(1, Ordering::Relaxed);
        Answering(Arc::clone(self))
    }

    fn idle_for(&self) -> Duration {
        if self.answering.load(Ordering::Relaxed) > 0 {
            return Duration::ZERO;
        }
        self.moved
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .elapsed()
    }
}

/// See [`Activity::answering`].
#[derive(Debug)]
pub(super) struct Answering(Arc<Activity>);

impl Drop for Answering {
    fn drop(&mut self) {
        self.0.answering.fetch_sub(1, Ordering::Relaxed);
        self.0.move_on();
    }
}

impl Seats {
    /// Room for `most` connections, one at least.
    pub(super) fn new(most: usize) -> Arc<Self> {
        Arc::new(Self {
            most: most.max(1),
            taken: Mutex::default(),
            freed: Notify::new(),
        })
    }

    /// Waits until there is room, for which another may have to leave.
    pub(super) async fn make_room(&self) {
        while let Some(wait) = self.show_out() {
            let freed = self.freed.notified();
            // Whichever is first.
            let _ = tokio::time::timeout(wait, freed).await;
        }
    }

    /// Shows one out where there is no room; how long until that is possible, if it is not yet.
    fn show_out(&self) -> Option<Duration> {
        let mut taken = self.taken();
        if taken.len() < self.most {
            return None;
        }
        let idle = taken
            .iter()
            .map(|(&id, seat)| (seat.activity.idle_for(), id));
        let (idle_for, id) = idle.max()?;
        if idle_for < LEAST_IDLE {
            return Some(LEAST_IDLE - idle_for);
        }
        let seat = taken.remove(&id)?;
        seat.activity.cut();
        seat.task.abort();
        None
    }

    /// Starts a connection's task on a seat.
    pub(super) fn seat<F>(self: &Arc<Self>, id: u64, talk: impl FnOnce(Arc<Activity>) -> F)
    where
        F: Future<Output = ()> + Send + 'static,
    {
        let activity = Arc::new(Activity::new());
        let leaves = Leaves {
            seats: Arc::clone(self),
            id,
        };
        let talk = talk(Arc::clone(&activity));
        // It runs only after this function: one thread runs all.
        let task = tokio::spawn(async move {
            let _leaves = leaves;
            talk.await;
        });
        let task = task.abort_handle();
        self.taken().insert(id, Taken { activity, task });
    }

    fn taken(&self) -> MutexGuard<'_, BTreeMap<u64, Taken>> {
        // A map of seats is as good as it was when something panicked.
        self.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Gives a seat back when its task ends, however it ends.
struct Leaves {
    seats: Arc<Seats>,
    id: u64,
}

impl Drop for Leaves {
    fn drop(&mut self) {
        self.seats.taken().remove(&self.id);
        self.seats.freed.notify_one();
    }
}
