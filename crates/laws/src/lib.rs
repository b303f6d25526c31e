//! Control laws that users write.
//!
//! A custom law comes with a [`Declaration`]: its parameters with units and ranges, its memory, how many leaders it looks at
//! and what it has to know of them. It is told an [`Input`] and decides a [`vocabulary::Command`], dv/dt and ω. It has no
//! clock, no files, no other robots, and no randomness but [`Noise`], so a run replays bit for bit.
//!
//! A [`BatchLaw`] decides for many followers at once.
//!
//! A [`LawFile`] is a custom law that is written as text, in a language of its own: `docs/law-files.md` is its reference.

mod batch_law;
mod custom_law;
mod declaration;
mod input;
mod language;
mod module;
mod noise;
mod shipped;
mod unit;

pub use batch_law::{BatchInput, BatchLaw};
pub use custom_law::{CustomLaw, Fault, Place};
pub use declaration::{Declaration, Knowledge, Parameter, Quantity, Scale};
pub use input::{INPUTS, Input, InputKind, LEADERS_MAX, LeaderInput};
pub use language::{LawFile, Mistake};
#[cfg(feature = "wasm")]
pub use module::WasmLaw;
pub use module::{is_module, read_module};
pub use noise::Noise;
pub use shipped::{SHIPPED_LAWS, ShippedLaw, TEMPLATE, shipped};
pub use unit::Unit;
