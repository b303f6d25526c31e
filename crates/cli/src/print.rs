//! Printing, and the subcommands that only print.

use crate::program::Program;
use clap::CommandFactory;
use clap_complete::Shell;
use std::borrow::Cow;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use vocabulary::readable;

/// Whether standard output refused something, for other reasons than that its reader has gone.
static LOST: AtomicBool = AtomicBool::new(false);

/// Whether standard output is for something else than results for people.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// Leaves standard output to [`verbatim`]: results for people go to standard error from here on.
pub(crate) fn make_way() {
    TAKEN.store(true, Ordering::Relaxed);
}

/// Prints a line to standard output; a reader that has gone away is no error.
pub(crate) fn say(text: &str) {
    if TAKEN.load(Ordering::Relaxed) {
        return note(text);
    }
    write(format!("{}\n", harmless(text)).as_bytes());
}

/// Prints a text to standard output as it is.
pub(crate) fn verbatim(text: &str) {
    write(text.as_bytes());
}

/// Text with every character spelt out that would move a terminal's cursor, colour it or turn the direction of reading:
/// titles and names come from files. The spelling is that of JSON and TOML. Numbers with very many digits are written with an
/// exponent.
pub(crate) fn harmless(text: &str) -> Cow<'_, str> {
    match readable(text) {
        Cow::Borrowed(text) => spelt(text),
        Cow::Owned(text) => Cow::Owned(spelt(&text).into_owned()),
    }
}

fn spelt(text: &str) -> Cow<'_, str> {
    let harmful = |c: char| {
        (c.is_control() && c != '\n' && c != '\t')
            || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(harmful) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if harmful(c) {
            // Writing to a text cannot fail.
            let _ = std::fmt::Write::write_fmt(&mut clean, format_args!("\\u{:04X}", u32::from(c)));
        } else {
            clean.push(c);
        }
    }
    Cow::Owned(clean)
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

/// Prints a line to standard error; there is no place left to report that it is closed.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", harmless(text));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_steer_a_terminal_is_spelt_out() {
        assert_eq!(
            harmless("a\u{1b}[31mred\u{7}\u{9b}2J \u{202e}x"),
            "a\\u001B[31mred\\u0007\\u009B2J \\u202Ex"
        );
        let fine = "two lines\n\tω = 3 rad/s, 隊列, مرحبا";
        assert!(matches!(harmless(fine), Cow::Borrowed(text) if text == fine));
        // The spelling reads back as what it was.
        let title = "a\u{9b}b\u{1b}";
        let value = serde_json::json!(title);
        let read: String = serde_json::from_str(&harmless(&value.to_string())).expect("JSON");
        assert_eq!(read, title);
    }
}
