//! The lab without its window: what runs, what is kept of it, what actions mean, and what panels show. One program, for
//! linking takes longer than testing.

mod branches;
mod commands;
mod common;
mod edits;
mod events;
mod history;
mod laws;
mod leaders;
mod links;
mod pacing;
mod panels;
mod prediction;
mod recorded;
mod scene_draft;
mod staying;
mod sweeps;
