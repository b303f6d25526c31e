//! Long work without the interpreter: signals are looked after every few milliseconds, and progress is told.

use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// Between two looks: an interrupt is felt as immediate within a tenth of a second.
const PAUSE: Duration = Duration::from_millis(30);

/// Looks after signals while work goes on.
pub(crate) struct Watch {
    due: AtomicBool,
    raised: Mutex<Option<PyErr>>,
    /// Called with what is done and the total.
    progress: Option<Py<PyAny>>,
    total: AtomicU64,
    pauses: AtomicU64,
}

impl Watch {
    /// Whether the work goes on, of which so much is done: not after Ctrl-C, nor where `progress` raises.
    pub(crate) fn goes_on(&self, done: u64) -> bool {
        if !self.due.swap(false, Relaxed) {
            return true;
        }
        let looked = Python::attach(|py| self.look(py, done));
        looked
            .map_err(|error| *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error))
            .is_ok()
    }

    /// How long the work has been going on, s, to a few hundredths.
    pub(crate) fn seconds(&self) -> f64 {
        self.pauses.load(Relaxed) as f64 * PAUSE.as_secs_f64()
    }

    /// The work has so many steps.
    pub(crate) fn expect(&self, total: u64) {
        self.total.store(total, Relaxed);
    }

    fn look(&self, py: Python<'_>, done: u64) -> PyResult<()> {
        py.check_signals()?;
        if let Some(progress) = &self.progress {
            progress.call1(py, (done, self.total.load(Relaxed)))?;
        }
        Ok(())
    }
}

/// Does `work` without the interpreter; `progress` is called now and then with what is done of `total`, and at the end.
///
/// # Errors
/// What a signal handler or `progress` raised.
pub(crate) fn detached<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    total: u64,
    work: impl FnOnce(&Watch) -> T + Send,
) -> PyResult<T> {
    let watch = Watch {
        due: AtomicBool::new(false),
        raised: Mutex::new(None),
        progress,
        total: AtomicU64::new(total),
        pauses: AtomicU64::new(0),
    };
    let done = py.detach(|| {
        thread::scope(|scope| {
            let (stop, stopped) = channel::<()>();
            let (due, pauses) = (&watch.due, &watch.pauses);
            let ticks = move || {
                while stopped.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                    due.store(true, Relaxed);
                    pauses.fetch_add(1, Relaxed);
                }
            };
            thread::Builder::new().spawn_scoped(scope, ticks)?;
            let done = work(&watch);
            // Ends the ticks.
            drop(stop);
            std::io::Result::Ok(done)
        })
    })?;
    let raised = watch.raised.lock().unwrap_or_else(PoisonError::into_inner).take();
    let ended = match raised {
        Some(error) => Err(error),
        None => watch.look(py, watch.total.load(Relaxed)),
    };
    // What a law raised at the same time is not to be taken for the fault of the next work on this thread.
    ended.map(|()| done).inspect_err(|_| drop(crate::law::raised()))
}
