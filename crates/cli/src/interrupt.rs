//! Ctrl-C and its like: noticed between two steps, so that what is written is whole.
//!
//! Signals end the program as they always do until [`watch`] is called, which is when work begins that asks for them: who
//! waits for a pipe is not deaf. One that was ignored when the program began, as under `nohup` or behind `&` in a script,
//! stays ignored.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

/// Set by the first signal.
static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
    let asked = Arc::default();
    for signal in signals().into_iter().filter(|signal| !ignored(*signal)) {
        // A second one ends the program at once. The order counts: what comes first is asked first.
        let ends = flag::register_conditional_shutdown(signal, 130, Arc::clone(&asked));
        // Without a handler a signal still ends the program, only less gently.
        drop(ends.and_then(|_| flag::register(signal, Arc::clone(&asked))));
    }
    asked
});

/// Begins to listen.
pub(crate) fn watch() {
    LazyLock::force(&ASKED);
}

/// Whether the program has been asked to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Those that ask a program to end.
fn signals() -> Vec<i32> {
    #[cfg(unix)]
    return vec![SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    #[cfg(not(unix))]
    return vec![SIGINT, SIGTERM];
}

/// Whether a signal was ignored when the program began, as far as the system reports.
fn ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    is_ignored(&status, signal)
}

/// Whether `status`, as Linux has it of a process, names a signal among those that are ignored.
fn is_ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_read_from_the_mask() {
        // As `nohup` (1) and `&` in a plain shell (2, 3) leave it.
        let status = "Name:\techelon\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001007\nSigCgt:\t0\n";
        let ignored: Vec<i32> = (1..=15).filter(|signal| is_ignored(status, *signal)).collect();
        assert_eq!(ignored, [1, 2, 3, 13]);
        assert!(!is_ignored("", SIGINT));
    }
}
