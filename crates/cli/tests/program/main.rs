//! The program as its users meet it: every subcommand, through its command line.

mod bad_input;
mod budget;
mod common;
mod dataset;
mod logs;
mod pictures;
mod replay;
mod runs;
