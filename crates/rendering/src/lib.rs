//! Snapshots to pictures and films.
