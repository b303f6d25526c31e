//! Many runs at once: threads make them, one of them takes the rows.

use crate::experiment::Experiment;
use crate::row::RunRow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, scope};
use std::time::Duration;

/// What happens while runs are made.
#[derive(Debug)]
pub enum Progressed {
    /// A run has ended.
    Ended(RunRow),
    /// Some time has gone by.
    Waited,
}

/// How long nothing may happen before that is said.
const PATIENCE: Duration = Duration::from_millis(100);
/// Names of threads that make runs begin so.
pub const THREAD: &str = "run";

/// Makes the runs `indices` of an experiment on `threads` threads. `take` gets each row as its run ends, and says whether to
/// go on; runs that are under way when it says no are given up. `clock` tells seconds since any moment.
///
/// Rows do not depend on the number of threads; their order does.
///
/// # Errors
/// What `take` returned. Where the system gives no threads, there are no rows.
pub fn run_all<E>(
    experiment: &Experiment,
    indices: impl Iterator<Item = u64> + Send,
    threads: usize,
    clock: &(dyn Fn() -> f64 + Sync),
    mut take: impl FnMut(Progressed) -> Result<bool, E>,
) -> Result<(), E> {
    let (stop, left) = (AtomicBool::new(false), Mutex::new(indices));
    let go_on = || !stop.load(Ordering::Relaxed);
    let next = || left.lock().unwrap_or_else(PoisonError::into_inner).next();
    let (sender, rows) = sync_channel::<RunRow>(4 * threads.max(1));
    let work = |sender: &std::sync::mpsc::SyncSender<RunRow>| {
        while go_on()
            && let Some(row) = next().and_then(|index| experiment.run(index, &|| clock(), &go_on))
            && sender.send(row).is_ok()
        {}
    };
    scope(|scope| {
        for number in 0..threads.max(1) {
            let sender = sender.clone();
            // Where the system gives fewer threads, those that are there do the work.
            let _ =
                Builder::new().name(format!("{THREAD} {number}")).spawn_scoped(scope, move || work(&sender));
        }
        drop(sender);
        loop {
            let event = match rows.recv_timeout(PATIENCE) {
                Ok(row) => Progressed::Ended(row),
                Err(RecvTimeoutError::Timeout) => Progressed::Waited,
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            };
            let on = take(event);
            if !matches!(on, Ok(true)) {
                stop.store(true, Ordering::Relaxed);
                // Nobody waits for rows that nobody takes.
                drop(rows);
                return on.map(drop);
            }
        }
    })
}
