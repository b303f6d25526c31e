//! A window that is taken away from outside: the library that holds it panics then, and the lab says so in words.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::thread;

/// What `show` returns; in words where it panicked, on whose thread nothing is printed meanwhile. What was not saved is on
/// disk already.
///
/// # Errors
/// What the panic said.
pub(crate) fn told<T>(show: impl FnOnce() -> T) -> Result<T, String> {
    let here = thread::current().id();
    let before = take_hook();
    // Other threads tell theirs as ever.
    set_hook(Box::new(move |info| {
        if thread::current().id() != here {
            before(info);
        }
    }));
    // Nothing of what it worked on is used again.
    let shown = catch_unwind(AssertUnwindSafe(show));
    drop(take_hook());
    shown.map_err(|panic| words(&*panic))
}

fn words(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason was given");
    let lost =
        ["Drawable", "BadWindow", "X11Error", "ConnectionError"].iter().any(|word| said.contains(word));
    if lost {
        "the window was taken away from outside; what was not saved is offered at the next start".to_owned()
    } else {
        format!(
            "the window ended by a mistake of ours: {said}. What was not saved is offered at the next start"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_that_is_taken_away_is_told_in_words() {
        let fault = "called `Result::unwrap()` on an `Err` value: X11(X11Error { error_kind: Drawable })";
        let told = |text: &'static str| told(|| -> () { std::panic::panic_any(text) });
        assert!(told(fault).is_err_and(|words| words.contains("taken away from outside")));
        assert!(told("index out of bounds").is_err_and(|words| words.contains("index out of bounds")));
        assert_eq!(super::told(|| 7), Ok(7));
    }
}
