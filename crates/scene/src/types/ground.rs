//! The ground: its relief and how well it grips.

use serde::Serialize;
use std::sync::Arc;
use vocabulary::Terrain;

/// The ground of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ground {
    /// The recipe of its heights.
    #[serde(flatten)]
    pub relief: Relief,
    /// Multiplies the tyres' own coefficient of friction.
    pub friction: f64,
    /// Where it grips otherwise; the last one holds where several lie over each other.
    pub patches: Vec<Patch>,
    /// Heights and grip (`friction` and `patches` in it), made by the recipe; `None` is flat at z = 0 with grip 1.
    #[serde(skip)]
    pub terrain: Option<Arc<Terrain>>,
}

/// How the heights of the ground are made. Regions are [x from, y from, x to, y to] in m.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Relief {
    /// z = 0 everywhere.
    Flat {
        /// Side of the cells in which patches are told apart, m.
        cell: f64,
    },
    /// Bumps of many sizes.
    Rough(Noise),
    /// Smooth hills and hollows.
    Hills(Noise),
    /// Measured or made elsewhere.
    Table {
        /// The point with the smallest x and y, [m, m].
        origin: [f64; 2],
        /// Distance between neighbouring points, m.
        cell: f64,
        /// m over z = 0: rows along x, the first with the smallest y; at least two by two, all of one length.
        heights: Vec<Vec<f64>>,
    },
}

/// Heights out of a seed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    /// Largest |height|, m.
    pub amplitude: f64,
    /// Length of the largest waves, m.
    pub wavelength: f64,
    /// Same seed, same ground.
    pub seed: u64,
    /// Where it is, [m, m, m, m]; it fades to 0 towards its edges.
    pub region: [f64; 4],
    /// Side of a cell, m.
    pub cell: f64,
}

/// A place that grips otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Patch {
    /// [x from, y from, x to, y to], m.
    pub region: [f64; 4],
    /// Multiplies the tyres' own coefficient of friction there.
    pub friction: f64,
}
