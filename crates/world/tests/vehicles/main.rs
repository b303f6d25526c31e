//! The vehicles against independent models: closed forms, the kinematic bicycle, a single-track model, conservation laws.

mod alone;
mod common;
mod standing;
mod together;
mod truck;
