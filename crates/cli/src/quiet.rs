//! Keeps a graphics driver from printing errors that are none.
//!
//! Without `XDG_RUNTIME_DIR`, or with an empty one, as in containers, Mesa's device selection asks a window system that is not there and
//! prints two lines that begin with `error:`. A variable keeps it from asking; since changing the environment of a
//! running program is unsafe, the program starts itself again with it.

#[cfg(target_os = "linux")]
pub(crate) fn restart_if_needed() {
    use std::os::unix::process::CommandExt;
    const QUIET: &str = "NODEVICE_SELECT";
    // An empty one is none: that is how the specification has it, and how Mesa takes it.
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if set("XDG_RUNTIME_DIR") || set(QUIET) {
        return;
    }
    if let Ok(program) = std::env::current_exe() {
        // Returns only where it failed; then the lines are printed, and nothing else is lost.
        let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).env(QUIET, "1").exec();
    }
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn restart_if_needed() {}
