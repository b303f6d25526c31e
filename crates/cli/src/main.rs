//! The program `echelon`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(cli::program(std::env::args_os()))
}
