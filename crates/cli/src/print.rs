//! Printing, and the subcommands that only print.

use crate::args::Program;
use clap::CommandFactory;
use clap_complete::Shell;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether standard output refused something, for other reasons than that its reader has gone.
static LOST: AtomicBool = AtomicBool::new(false);

/// Prints a line to standard output; a reader that has gone away is no error.
pub(crate) fn say(text: &str) {
    write(format!("{text}\n").as_bytes());
}

fn write(bytes: &[u8]) {
    let mut out = std::io::stdout().lock();
    if let Err(error) = out.write_all(bytes).and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        LOST.store(true, Ordering::Relaxed);
    }
}

/// Whether something that was printed did not arrive.
pub(crate) fn lost() -> bool {
    LOST.load(Ordering::Relaxed)
}

/// Prints a line to standard error.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Prints JSON, indented.
pub(crate) fn json(value: &serde_json::Value) {
    say(&format!("{value:#}"));
}

pub(crate) fn schema() {
    json(&scene::schema());
}

pub(crate) fn completions(shell: Shell) {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Program::command(), "echelon", &mut text);
    write(&text);
}
