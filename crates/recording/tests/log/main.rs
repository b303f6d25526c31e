//! Logs come back bit for bit, whole, cut off or written anew by others, and what is no log is one clear error.

mod anew;
mod common;
mod whole;
