//! Ctrl-C: noticed between two steps, so that what is written is whole.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Begins to listen; a second Ctrl-C ends the program at once.
pub(crate) fn watch() {
    let listen = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    // Without a handler Ctrl-C still ends the program, only less gently.
    drop(listen);
}

/// Whether the program has been asked to stop.
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
