//! Watching the files that are open: a thread looks at their times once a second, so that the
//! window need not wake up to do it.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime};

use crate::load::{Event, Outbox};
use crate::state::clip::Source;
use crate::state::session::{ClipId, Session};

/// How often the files are looked at.
const EVERY: Duration = Duration::from_secs(1);

/// A file that is watched.
#[derive(Clone, Debug)]
struct Watched {
    clip: ClipId,
    path: PathBuf,
    stamp: Option<(SystemTime, u64)>,
}

/// Watches the files that are open.
#[derive(Debug)]
pub struct Watch {
    files: Arc<Mutex<Vec<Watched>>>,
}

impl Watch {
    /// Starts watching; changes go to `outbox`.
    #[must_use]
    pub fn new(outbox: Outbox) -> Self {
        let files = Arc::new(Mutex::new(Vec::new()));
        let watched = Arc::downgrade(&files);
        let look = move || {
            loop {
                std::thread::sleep(EVERY);
                let Some(files) = watched.upgrade() else {
                    break;
                };
                if !look_once(&files, &outbox) {
                    break;
                }
            }
        };
        // Without the thread nothing is watched, and nothing else is lost.
        drop(std::thread::Builder::new().name("watch".into()).spawn(look));
        Self { files }
    }

    /// Watches the files of the session's clips as they are now.
    pub fn set(&self, session: &Session) {
        let Ok(mut files) = self.files.lock() else {
            return;
        };
        let before = std::mem::take(&mut *files);
        for open in session.clips() {
            let Source::File(path) = &open.clip.source else {
                continue;
            };
            let known = before.iter().find(|watched| watched.clip == open.id);
            files.push(known.cloned().unwrap_or_else(|| Watched {
                clip: open.id,
                path: path.clone(),
                stamp: stamp(path),
            }));
        }
    }
}

/// When a file was changed last, and its size; `None` while it is not there.
fn stamp(path: &PathBuf) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Looks at all files. False when nobody listens any more.
fn look_once(files: &Mutex<Vec<Watched>>, outbox: &Outbox) -> bool {
    // The disk is asked without the lock, so that a slow one does not make the window wait.
    let Ok(snapshot) = files.lock().map(|files| files.clone()) else {
        return false;
    };
    for before in snapshot {
        let now = stamp(&before.path);
        // A file that is gone for a moment is being written anew.
        if now.is_none() || now == before.stamp {
            continue;
        }
        if let Ok(mut files) = files.lock()
            && let Some(watched) = files.iter_mut().find(|watched| watched.clip == before.clip)
        {
            watched.stamp = now;
        }
        if !outbox.send(Event::Changed { clip: before.clip }) {
            return false;
        }
    }
    true
}
