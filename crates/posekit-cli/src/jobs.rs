//! Independent pieces of work on all cores, their results handed over in the order of the input.
//!
//! Results are given to the caller in input order while later pieces are still being worked on, and
//! no worker runs further ahead than a fixed window: what is held in memory does not grow with the
//! number of inputs, and the output of a run is the same whatever the number of workers. That order
//! and that bound are why this is a few lines on scoped threads and not a parallel iterator.

use std::any::Any;
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// How many results per worker may wait for a slow earlier one: enough that one long file among
/// short ones does not leave the other workers idle, few enough that memory stays small.
const WINDOW_PER_WORKER: usize = 8;

/// What a piece of work came to: its value, or the panic that it ended with.
pub(crate) type Worked<T> = Result<T, Box<dyn Any + Send>>;

/// The number of workers when the user does not say: one per core.
pub(crate) fn default_workers() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// How many threads a file may have to itself; 0 until something runs.
static HANDS: AtomicUsize = AtomicUsize::new(0);

/// How many threads each of the pieces of work that run now may use: all of them, where there is one.
pub(crate) fn hands() -> NonZeroUsize {
    NonZeroUsize::new(HANDS.load(Ordering::Relaxed)).unwrap_or(NonZeroUsize::MIN)
}

/// Runs `work(0)`, ..., `work(count - 1)` on up to `workers` threads and hands every result to
/// `emit`, on the calling thread and in order, until it breaks off.
pub(crate) fn in_order<T: Send>(
    count: usize,
    workers: NonZeroUsize,
    work: impl Fn(usize) -> T + Sync,
    mut emit: impl FnMut(usize, Worked<T>) -> ControlFlow<()>,
) {
    let worker_count = workers.get().min(count);
    HANDS.store(workers.get() / worker_count.max(1), Ordering::Relaxed);
    if worker_count <= 1 {
        for index in 0..count {
            if emit(index, catch_unwind(AssertUnwindSafe(|| work(index)))).is_break() {
                return;
            }
        }
        return;
    }
    let board = Board {
        state: Mutex::new(State {
            next: 0,
            emitted: 0,
            stopped: false,
            ready: BTreeMap::new(),
        }),
        changed: Condvar::new(),
        count,
        window: worker_count * WINDOW_PER_WORKER,
    };
    thread::scope(|scope| {
        for _ in 0..worker_count {
            scope.spawn(|| {
                while let Some(index) = board.take_next() {
                    board.deliver(index, catch_unwind(AssertUnwindSafe(|| work(index))));
                }
            });
        }
        // Dropped before the scope joins its threads, also when `emit` panics: nobody waits for
        // a caller that has gone.
        let _stop = StopOnDrop(&board);
        for index in 0..count {
            if emit(index, board.wait_for(index)).is_break() {
                return;
            }
        }
    });
}

struct State<T> {
    /// The first index that no worker has taken.
    next: usize,
    /// How many results the caller has taken.
    emitted: usize,
    stopped: bool,
    ready: BTreeMap<usize, Worked<T>>,
}

/// Where workers and the caller meet.
struct Board<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
    count: usize,
    window: usize,
}

impl<T> Board<T> {
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        // Work panics are caught before they reach the lock, so a poisoned state is still whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(&self, guard: MutexGuard<'a, State<T>>) -> MutexGuard<'a, State<T>> {
        self.changed
            .wait(guard)
            .unwrap_or_else(PoisonError::into_inner)
    }

    fn take_next(&self) -> Option<usize> {
        let mut state = self.lock();
        loop {
            if state.stopped || state.next >= self.count {
                return None;
            }
            if state.next < state.emitted + self.window {
                state.next += 1;
                return Some(state.next - 1);
            }
            state = self.wait(state);
        }
    }

    fn deliver(&self, index: usize, result: Worked<T>) {
        self.lock().ready.insert(index, result);
        self.changed.notify_all();
    }

    fn wait_for(&self, index: usize) -> Worked<T> {
        let mut state = self.lock();
        loop {
            if let Some(result) = state.ready.remove(&index) {
                state.emitted = index + 1;
                drop(state);
                self.changed.notify_all();
                return result;
            }
            state = self.wait(state);
        }
    }
}

struct StopOnDrop<'a, T>(&'a Board<T>);

impl<T> Drop for StopOnDrop<'_, T> {
    fn drop(&mut self) {
        self.0.lock().stopped = true;
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    fn workers(n: usize) -> NonZeroUsize {
        NonZeroUsize::new(n).unwrap()
    }

    #[test]
    fn results_come_in_order_whatever_the_number_of_workers() {
        for n in [1, 2, 7] {
            let mut seen = Vec::new();
            in_order(
                200,
                workers(n),
                |i| {
                    if i % 13 == 0 {
                        thread::sleep(Duration::from_millis(1));
                    }
                    i * i
                },
                |i, result| {
                    seen.push((i, result.unwrap()));
                    ControlFlow::Continue(())
                },
            );
            assert_eq!(seen, (0..200).map(|i| (i, i * i)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn no_more_results_are_held_than_the_window() {
        let started = AtomicUsize::new(0);
        let mut most_ahead = 0;
        in_order(
            500,
            workers(3),
            |_| started.fetch_add(1, Ordering::SeqCst),
            |i, _| {
                thread::sleep(Duration::from_micros(200));
                most_ahead = most_ahead.max(started.load(Ordering::SeqCst) - i);
                ControlFlow::Continue(())
            },
        );
        assert!(most_ahead <= 3 * WINDOW_PER_WORKER + 1, "{most_ahead}");
    }

    #[test]
    fn breaking_off_stops_the_workers() {
        let started = AtomicUsize::new(0);
        in_order(
            100_000,
            workers(2),
            |_| started.fetch_add(1, Ordering::SeqCst),
            |i, _| {
                if i == 10 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        assert!(started.load(Ordering::SeqCst) < 1000);
    }

    #[test]
    fn a_panic_is_one_result_and_not_the_end() {
        let mut good = 0;
        let mut bad = Vec::new();
        in_order(
            40,
            workers(2),
            |i| assert!(i != 5, "five"),
            |i, result| {
                match result {
                    Ok(()) => good += 1,
                    Err(_) => bad.push(i),
                }
                ControlFlow::Continue(())
            },
        );
        assert_eq!((good, bad), (39, vec![5]));
    }
}
