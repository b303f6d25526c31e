//! Printing, and the subcommands that only print.

use crate::args::Program;
use clap::CommandFactory;
use clap_complete::Shell;
use std::io::Write;

/// Prints a line to standard output; a reader that has gone away is no error.
pub(crate) fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
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
    let _ = std::io::stdout().write_all(&text);
}
