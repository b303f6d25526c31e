//! Turns a panic of the window library into a message: winit panics when another program destroys the window.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// What `show` returns, or why it panicked. What was not saved is on disk already.
///
/// A second panic on this thread, raised while the first one unwinds or where nothing may unwind, would abort the process
/// without a word: `abandon` gets the message first, and may end the process itself.
///
/// # Errors
/// What the panic said.
pub(crate) fn guarded<T>(
    show: impl FnOnce() -> T,
    abandon: impl Fn(&str) + Send + Sync + 'static,
) -> Result<T, String> {
    let here = thread::current().id();
    let first = Mutex::new(None::<String>);
    let before = take_hook();
    set_hook(Box::new(move |info| {
        // Other threads report as usual; this one stays silent until the panic is caught.
        if thread::current().id() != here {
            return before(info);
        }
        let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
        match first.take() {
            None => *first = Some(text(info.payload()).to_owned()),
            Some(first) => abandon(&message(&format!("{first}; then: {}", text(info.payload())))),
        }
    }));
    // Nothing of what it worked on is used again.
    let shown = catch_unwind(AssertUnwindSafe(show));
    drop(take_hook());
    shown.map_err(|panic| message(text(&*panic)))
}

/// What a panic was raised with.
fn text(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason was given")
}

/// What the user is told of a panic.
fn message(panic: &str) -> String {
    let destroyed = ["Drawable", "BadWindow", "X11Error", "ConnectionError", "Surface", "surface"];
    if destroyed.iter().any(|error| panic.contains(error)) {
        "another program destroyed the window; the next start offers what was not saved".to_owned()
    } else {
        format!("the window ended because of a bug: {panic}. The next start offers what was not saved")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, exit};

    const DESTROYED: &str =
        "called `Result::unwrap()` on an `Err` value: X11(X11Error { error_kind: Drawable })";

    #[test]
    fn a_destroyed_window_is_reported() {
        let guarded = |text: &'static str| guarded(|| -> () { std::panic::panic_any(text) }, |_| ());
        assert!(guarded(DESTROYED).is_err_and(|message| message.contains("another program destroyed")));
        assert!(guarded("index out of bounds").is_err_and(|message| message.contains("index out of bounds")));
        assert_eq!(super::guarded(|| 7, |_| ()), Ok(7));
    }

    /// Panics once more when it is dropped.
    struct Grenade;

    impl Drop for Grenade {
        fn drop(&mut self) {
            panic!("the surface is gone too");
        }
    }

    /// A process of its own: whatever the hook does not end, the runtime aborts.
    #[test]
    fn a_second_panic_is_reported_before_the_process_ends() {
        const CHILD: &str = "ECHELON_TEST_SECOND_PANIC";
        if std::env::var_os(CHILD).is_some() {
            let show = || {
                let _held = Grenade;
                std::panic::panic_any(DESTROYED)
            };
            let abandon = |message: &str| {
                eprintln!("{message}");
                exit(3)
            };
            guarded::<()>(show, abandon).unwrap_err();
            exit(0);
        }
        let name = "window_guard::tests::a_second_panic_is_reported_before_the_process_ends";
        let child = Command::new(std::env::current_exe().unwrap())
            .args([name, "--exact", "--nocapture"])
            .env(CHILD, "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&child.stderr);
        assert_eq!(child.status.code(), Some(3), "{said}");
        assert!(said.contains("another program destroyed the window"), "{said}");
        assert!(!said.contains("panicked"), "{said}");
    }
}
