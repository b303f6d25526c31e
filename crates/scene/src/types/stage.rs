//! What pictures need beyond the robots.

use serde::Serialize;

/// Light and air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Environment {
    /// Height of the sun over the horizon, rad in (0, π/2].
    pub sun_elevation: f64,
    /// Direction to the sun, rad from the world's x axis, counter-clockwise.
    pub sun_azimuth: f64,
    /// Distance at which haze sets in, m, above 0.
    pub haze_from: f64,
}

/// How pictures look at the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Views {
    /// View used where the command line names none: `snake`, `snake-eye`, `top`, `orbit`, `follow:<robot>`, `fixed`.
    pub default: String,
}

/// How a film is made when the command line does not say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Film {
    /// View, as in [`Views::default`]; that one if `None`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// Frames a second of simulation time, 1 to 240.
    pub fps: u32,
    /// [width, height] in pixels, each even, 16 to 8192.
    pub size: [u32; 2],
}
