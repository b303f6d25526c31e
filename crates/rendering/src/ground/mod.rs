//! The ground: its height, what robots drive on, and what is drawn on it.

pub(crate) mod decal_builder;
pub(crate) mod floor;
pub(crate) mod projection;
pub(crate) mod simplify;
pub(crate) mod trail;
