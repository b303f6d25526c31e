//! `digests` prints the digest of every shipped scene, `digests NAME/SENSING` every number of that run with its bits.

use std::io::{Write, stdout};
use std::process::ExitCode;

fn main() -> ExitCode {
    match print(std::env::args().nth(1).as_deref()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print(traced: Option<&str>) -> Result<(), String> {
    let cases = digests::cases();
    let mut out = stdout().lock();
    let Some(name) = traced else {
        return cases.iter().try_for_each(|case| {
            let line = case.line()?;
            written(writeln!(out, "{line}"))
        });
    };
    let case = cases.iter().find(|case| case.name() == name);
    let case = case.ok_or_else(|| format!("no case is called `{name}`"))?;
    let mut outcome = Ok(());
    case.trace(|line| {
        if outcome.is_ok() {
            outcome = writeln!(out, "{line}");
        }
    })?;
    written(outcome)
}

/// A reader that has seen enough is no failure.
fn written(outcome: std::io::Result<()>) -> Result<(), String> {
    match outcome {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
