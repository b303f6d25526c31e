//! Notices when the scene's file changes on disk, and when the program is told to end.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Between two looks at the file.
const EVERY: Duration = Duration::from_millis(400);

/// Looks at one file again and again, on a thread of its own.
pub(crate) struct FileWatcher {
    seen: Arc<Mutex<Seen>>,
    changed: Arc<AtomicBool>,
    stopped: Arc<AtomicBool>,
}

/// The file, and when it was written last.
type Seen = Option<(PathBuf, Option<SystemTime>)>;

impl FileWatcher {
    /// Starts the thread; `wake` is called when the file has changed, or when `stop` says that the program shall end.
    pub(crate) fn start(wake: impl Fn() + Send + 'static, stop: Option<fn() -> bool>) -> Self {
        let seen = Arc::new(Mutex::new(None));
        let changed = Arc::new(AtomicBool::new(false));
        let stopped = Arc::new(AtomicBool::new(false));
        let (watched, flag, end) = (Arc::downgrade(&seen), Arc::clone(&changed), Arc::clone(&stopped));
        let work = move || {
            while let Some(watched) = watched.upgrade() {
                if changes(&watched) {
                    flag.store(true, Relaxed);
                    wake();
                }
                drop(watched);
                if stop.is_some_and(|stop| stop()) {
                    end.store(true, Relaxed);
                    wake();
                }
                std::thread::sleep(EVERY);
            }
        };
        // Without it the file is read again by hand.
        let _ = std::thread::Builder::new().name("watch".to_owned()).spawn(work);
        Self { seen, changed, stopped }
    }

    /// Looks at this file from now on, as it is now.
    pub(crate) fn look_at(&self, path: Option<PathBuf>) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        *seen = path.map(|path| {
            let time = written(&path);
            (path, time)
        });
        self.changed.store(false, Relaxed);
    }

    /// Whether the program shall end.
    pub(crate) fn stopped(&self) -> bool {
        self.stopped.load(Relaxed)
    }

    /// Whether the file has changed since the last question.
    pub(crate) fn changed(&self) -> bool {
        self.changed.swap(false, Relaxed)
    }
}

fn written(path: &PathBuf) -> Option<SystemTime> {
    fs::metadata(path).and_then(|meta| meta.modified()).ok()
}

fn changes(watched: &Mutex<Seen>) -> bool {
    let mut seen = watched.lock().unwrap_or_else(PoisonError::into_inner);
    let Some((path, before)) = &mut *seen else { return false };
    let now = written(path);
    // A file that is gone for a moment is being written.
    let changed = now.is_some() && now != *before;
    if changed {
        *before = now;
    }
    changed
}
