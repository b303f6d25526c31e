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
        return cases
            .iter()
            .try_for_each(|case| writeln!(out, "{}", case.line()?).map_err(|error| error.to_string()));
    };
    let case =
        cases.iter().find(|case| case.name() == name).ok_or_else(|| format!("no case is called `{name}`"))?;
    let mut written = Ok(());
    case.trace(|line| {
        if written.is_ok() {
            written = writeln!(out, "{line}");
        }
    })?;
    // Whoever compares stops at the first difference.
    match written {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
