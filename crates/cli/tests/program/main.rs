//! The program as its users meet it: every subcommand, through its command line.

mod bad_input;
mod budget;
mod certify;
mod ci;
mod common;
mod dataset;
mod figures;
mod films;
mod law_modules;
mod laws;
mod links;
mod logs;
mod outputs;
mod pictures;
mod replay;
mod runs;
#[cfg(unix)]
mod signals;
mod sweeps;
