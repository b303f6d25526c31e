//! The language of law files: numbers, units, named memory, counted loops, and nothing that can go on for ever.
//!
//! Text becomes tokens (`token`), these a syntax tree (`parser`, `syntax`), and that code for a register machine (`checker`,
//! which also checks units, with `assembler`). `interpreter` runs the code; `fault_finder` runs it once more where a number is
//! not finite, to say why.

mod assembler;
mod builtin;
mod checker;
mod code;
mod fault_finder;
mod interpreter;
mod law_file;
mod law_text;
mod mistake;
mod names;
mod parser;
mod symbol;
mod syntax;
#[cfg(test)]
mod tests;
mod token;
mod typed;

pub use law_file::LawFile;
pub use mistake::Mistake;
#[cfg(feature = "wasm")]
pub(crate) use {names::did_you_mean, symbol::symbol, token::is_name};
