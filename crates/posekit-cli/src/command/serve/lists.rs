//! The list as it is now: built away from the thread that serves, once for all who wait, and kept for a
//! moment.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use super::list::Written;

/// Building lists takes at most this share of the time, however large the folder is.
const REST_PER_BUILD: u32 = 4;
/// Who waits for a new list for longer gets the one before.
const PATIENCE: Duration = Duration::from_secs(2);

/// Where the list comes from, and the newest that was built.
pub(super) struct Lists {
    build: Box<dyn Fn() -> Written + Send + Sync>,
    least_age: Duration,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    newest: Option<Newest>,
    /// The list that is being built, for who waits.
    coming: Option<watch::Receiver<Option<Arc<Written>>>>,
}

struct Newest {
    list: Arc<Written>,
    good_until: Instant,
}

impl fmt::Debug for Lists {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lists")
            .field("least_age", &self.least_age)
            .finish_non_exhaustive()
    }
}

impl Lists {
    /// Lists that `build` builds. One is good for `least_age`, and longer where building takes long.
    pub(super) fn new(
        least_age: Duration,
        build: impl Fn() -> Written + Send + Sync + 'static,
    ) -> Arc<Self> {
        Arc::new(Self {
            build: Box::new(build),
            least_age,
            state: Mutex::default(),
        })
    }

    /// The list, built anew if the newest is too old; nothing if it cannot be built.
    pub(super) async fn current(self: &Arc<Self>) -> Option<Arc<Written>> {
        let (mut coming, before) = {
            let mut state = self.state();
            let newest = state.newest.as_ref();
            if let Some(newest) = newest.filter(|newest| Instant::now() < newest.good_until) {
                return Some(Arc::clone(&newest.list));
            }
            let before = newest.map(|newest| Arc::clone(&newest.list));
            let coming = state.coming.get_or_insert_with(|| self.start());
            (coming.clone(), before)
        };
        let arrives = coming.wait_for(Option::is_some);
        let Some(before) = before else {
            return arrives.await.ok()?.clone();
        };
        match tokio::time::timeout(PATIENCE, arrives).await {
            Ok(Ok(list)) => list.clone(),
            _ => Some(before),
        }
    }

    /// Starts building. It goes on when nobody waits any more, so that who hangs up starts no second one.
    fn start(self: &Arc<Self>) -> watch::Receiver<Option<Arc<Written>>> {
        let (tell, coming) = watch::channel(None);
        let lists = Arc::clone(self);
        tokio::spawn(async move {
            let builder = Arc::clone(&lists);
            let begun = Instant::now();
            let built = tokio::task::spawn_blocking(move || (builder.build)()).await;
            let ended = Instant::now();
            let mut state = lists.state();
            state.coming = None;
            // A build that panicked ends the waiting: `tell` goes.
            if let Ok(built) = built {
                let list = Arc::new(built);
                let rest = lists.least_age.max((ended - begun) * REST_PER_BUILD);
                state.newest = Some(Newest {
                    list: Arc::clone(&list),
                    good_until: ended + rest,
                });
                tell.send_replace(Some(list));
            }
        });
        coming
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it is held, and a half-written state would still be a state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::mpsc;

    fn written(mark: String) -> Written {
        Written {
            json: "{}".into(),
            html: "".into(),
            mark,
            shortage: None,
        }
    }

    fn run(test: impl Future<Output = ()>) {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build();
        runtime.unwrap().block_on(test);
    }

    /// Lists that are built when the sender sends, and how many were begun.
    fn held_back(least_age: Duration) -> (Arc<Lists>, mpsc::Sender<()>, Arc<AtomicUsize>) {
        let (go, gate) = mpsc::channel();
        let gate = Mutex::new(gate);
        let begun = Arc::new(AtomicUsize::new(0));
        let count = Arc::clone(&begun);
        let lists = Lists::new(least_age, move || {
            let number = count.fetch_add(1, Ordering::SeqCst);
            gate.lock().unwrap().recv().unwrap();
            written(number.to_string())
        });
        (lists, go, begun)
    }

    #[test]
    fn many_wait_for_one_build_and_the_thread_is_free_meanwhile() {
        run(async {
            let (lists, go, begun) = held_back(Duration::from_secs(3600));
            let waiting: Vec<_> = (0..20)
                .map(|_| {
                    let lists = Arc::clone(&lists);
                    tokio::spawn(async move { lists.current().await.unwrap().mark.clone() })
                })
                .collect();
            while begun.load(Ordering::SeqCst) == 0 {
                // This thread serves others while the list is built.
                tokio::task::yield_now().await;
            }
            assert!(waiting.iter().all(|one| !one.is_finished()));
            go.send(()).unwrap();
            for one in waiting {
                assert_eq!(one.await.unwrap(), "0");
            }
            assert_eq!(lists.current().await.unwrap().mark, "0", "kept");
            assert_eq!(begun.load(Ordering::SeqCst), 1);
        });
    }

    #[test]
    fn who_hangs_up_starts_no_second_build() {
        run(async {
            let (lists, go, begun) = held_back(Duration::from_secs(3600));
            for _ in 0..3 {
                let other = Arc::clone(&lists);
                let one = tokio::spawn(async move { other.current().await.map(|_| ()) });
                while begun.load(Ordering::SeqCst) == 0 {
                    tokio::task::yield_now().await;
                }
                one.abort();
            }
            go.send(()).unwrap();
            assert_eq!(lists.current().await.unwrap().mark, "0");
            assert_eq!(begun.load(Ordering::SeqCst), 1);
        });
    }

    #[test]
    fn a_list_that_grew_old_is_built_anew() {
        run(async {
            let begun = AtomicUsize::new(0);
            let lists = Lists::new(Duration::ZERO, move || {
                written(begun.fetch_add(1, Ordering::SeqCst).to_string())
            });
            let first = lists.current().await.unwrap().mark.clone();
            // Until four times as long as the build took is over.
            while lists.current().await.unwrap().mark == first {
                tokio::task::yield_now().await;
            }
        });
    }

    #[test]
    fn a_build_that_fails_is_told_and_tried_again() {
        run(async {
            let begun = AtomicUsize::new(0);
            let lists = Lists::new(Duration::ZERO, move || {
                assert!(
                    begun.fetch_add(1, Ordering::SeqCst) > 0,
                    "the first build fails"
                );
                written("second".into())
            });
            assert!(lists.current().await.is_none());
            assert_eq!(lists.current().await.unwrap().mark, "second");
        });
    }
}
