//! The run as a whole: its time, what is sensed, and what it has to show.

use serde::Serialize;

/// Length, control period and mode of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Time {
    /// Length of the run, s.
    pub duration: f64,
    /// Control period, s; at most the duration.
    pub period: f64,
    /// How law and observer act between control samples.
    pub mode: Mode,
}

/// How law and observer act in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Law and observer act in continuous time; unicycles only.
    Continuous,
    /// The law is evaluated every period and held; the observer sees the plant between samples.
    #[default]
    Sampled,
    /// As sampled, but the observer sees samples only.
    Measured,
}

/// What a robot knows of its leader.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sensing {
    /// Where observations come from.
    pub kind: SensingKind,
}

/// Where observations come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SensingKind {
    /// The true relative position, without noise or delay.
    #[default]
    Truth,
}

/// What a run has to show, so that a scene is a test. What is `None` is not asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Expect {
    /// The run reaches its duration.
    pub completed: bool,
    /// No two bodies ever touch.
    pub no_contact: bool,
    /// Largest |distance error| of any edge at the end, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub final_distance_error: Option<f64>,
    /// Largest |bearing error| of any edge at the end, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub final_bearing_error: Option<f64>,
    /// Time after which every edge stays inside [`Expect::settling_band`], s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling_time: Option<f64>,
    /// |error| [m, rad] under which an edge counts as settled.
    pub settling_band: [f64; 2],
    /// Smallest distance between the outlines of any two bodies over the run, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance_min: Option<f64>,
    /// Smallest and largest speed of any follower after [`Expect::settling_time`] (0 if absent), m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_within: Option<[f64; 2]>,
    /// Largest |estimated rate| of [distance, bearing] of any edge reaches at least this, [m/s, rad/s]: peaking.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_peak_at_least: Option<[f64; 2]>,
    /// Largest |estimated rate| of [distance, bearing] of any edge stays under this, [m/s, rad/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate_peak_at_most: Option<[f64; 2]>,
    /// Largest |error| [m, rad] of any edge over the whole run stays under this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_peak_at_most: Option<[f64; 2]>,
}
