//! Laws as WebAssembly modules, made from C, Rust, Zig and the like: what the host asks of a module, and what it offers.
//!
//! A program without the feature `wasm` knows a module when it sees one, and says that it reads law files only.

#[cfg(feature = "wasm")]
mod declared;
#[cfg(feature = "wasm")]
mod host;
#[cfg(feature = "wasm")]
mod wasm_law;

use crate::CustomLaw;
use std::sync::Arc;
#[cfg(feature = "wasm")]
pub use wasm_law::WasmLaw;

/// Whether `bytes` begin as a WebAssembly module does.
pub fn is_module(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\0asm")
}

/// The law of a WebAssembly module.
///
/// # Errors
/// What is wrong with it, one message each.
#[cfg(feature = "wasm")]
pub fn read_module(bytes: &[u8]) -> Result<Arc<dyn CustomLaw>, Vec<String>> {
    WasmLaw::new(bytes).map(|law| Arc::new(law) as Arc<dyn CustomLaw>)
}

/// The law of a WebAssembly module.
///
/// # Errors
/// That this program is built without.
#[cfg(not(feature = "wasm"))]
pub fn read_module(_: &[u8]) -> Result<Arc<dyn CustomLaw>, Vec<String>> {
    Err(vec!["this law is a WebAssembly module, and this program reads law files only".to_owned()])
}
