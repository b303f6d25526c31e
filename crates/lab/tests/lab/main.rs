//! The lab without its window: what runs, what is kept of it, what actions mean, and what panels show. One program, for
//! linking takes longer than testing.

mod branches;
mod common;
mod deeds;
mod draft;
mod forecast;
mod futures;
mod history;
mod pacing;
mod panels;
mod recorded;
mod staying;
