//! Files that somebody asked for: looked at before the work, whole or not there after it.
//!
//! - [`Place`] looks at a file or folder before the work begins, and makes the folders that are missing.
//! - [`Draft`] and [`DraftFolder`] are written under a name of their own and take their final name when they are complete.
//! - [`Claim`] keeps two programs from writing one folder.

mod claim;
mod draft;
mod error;
mod place;

pub use claim::Claim;
pub use draft::{Draft, DraftFolder, scratch, write_whole};
pub use error::Error;
pub use place::Place;
