//! Notices when the scene's file changes on disk and when the program shall end.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

/// Interval between two checks of the file.
const INTERVAL: Duration = Duration::from_millis(400);

/// Watches one file on its own thread.
pub(crate) struct FileWatcher(Arc<Watched>);

/// What the thread and the window share.
#[derive(Default)]
struct Watched {
    /// The file, and its modification time at the last check.
    file: Mutex<Option<(PathBuf, Option<SystemTime>)>>,
    changed: AtomicBool,
    stopped: AtomicBool,
}

impl FileWatcher {
    /// Starts the thread; `wake` is called when the file has changed, or when `stop` says that the program shall end.
    pub(crate) fn start(wake: impl Fn() + Send + 'static, stop: Option<fn() -> bool>) -> Self {
        let shared = Arc::new(Watched::default());
        let weak = Arc::downgrade(&shared);
        let work = move || {
            while let Some(watched) = weak.upgrade() {
                if watched.look() {
                    watched.changed.store(true, Relaxed);
                    wake();
                }
                if stop.is_some_and(|stop| stop()) {
                    watched.stopped.store(true, Relaxed);
                    wake();
                }
                drop(watched);
                std::thread::sleep(INTERVAL);
            }
        };
        // Without the thread the user reloads the file.
        let _ = std::thread::Builder::new().name("watch".to_owned()).spawn(work);
        Self(shared)
    }

    /// Watches this file from now on.
    pub(crate) fn look_at(&self, path: Option<PathBuf>) {
        let mut file = self.0.file.lock().unwrap_or_else(PoisonError::into_inner);
        *file = path.map(|path| {
            let time = modified(&path);
            (path, time)
        });
        self.0.changed.store(false, Relaxed);
    }

    /// Whether the program shall end.
    pub(crate) fn stopped(&self) -> bool {
        self.0.stopped.load(Relaxed)
    }

    /// Whether the file has changed since the last call.
    pub(crate) fn changed(&self) -> bool {
        self.0.changed.swap(false, Relaxed)
    }
}

impl Watched {
    /// Whether the file was written since the last check.
    fn look(&self) -> bool {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((path, before)) = &mut *file else { return false };
        // A file that is missing for a moment is being written.
        modified(path).is_some_and(|now| before.replace(now) != Some(now))
    }
}

fn modified(path: &PathBuf) -> Option<SystemTime> {
    fs::metadata(path).and_then(|meta| meta.modified()).ok()
}
