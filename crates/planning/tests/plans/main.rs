//! Plans for formations, held against an independent simulation and against the properties that they promise.

mod maps;
mod promises;
mod refusals;
mod walk;
mod ways;
