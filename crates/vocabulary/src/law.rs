//! Which law and observer a follower uses, and how they act in time.

use crate::words;
use serde::Serialize;

words! {
    /// Which law a follower uses; the paper's own words are read for the same.
    pub enum LawKind {
        /// Knows its leader's motion (eq 20).
        FullState = "full-state" | "fsfb",
        /// Knows the rates of distance and bearing, not its leader's motion (eq 22).
        RobustState = "robust-state" | "rsfb",
        /// Knows distance and bearing only (eq 42).
        OutputFeedback = "output-feedback" | "ofb",
    }
}

words! {
    /// Against what heading the bearing of a follower is held.
    pub enum HeadingReference {
        /// The leader's own, as in the paper: when the leader turns, its followers swing at once.
        Leader = "leader",
        /// The leader's, filtered along its path: it moves with the distance travelled, so at a stop it stands.
        Path = "path",
    }
}

words! {
    /// What drives a follower at an instant.
    pub enum MotionPhase = Law {
        /// Its law.
        Law = "law",
        /// Near a stand: a tracker of its set point that is not singular at rest.
        Track = "track",
        /// At a stand: it brakes and keeps its heading.
        Hold = "hold",
    }
}

words! {
    /// How measurements become an estimate of [distance, bearing] and of their rates.
    pub enum ObserverKind {
        /// The high-gain observer, carried on by eqs 31-32 and corrected by each measurement.
        HighGain = "high-gain",
        /// Two unscented Kalman filters, one for the relative position and one for the leader's speed and turn rate.
        Unscented = "unscented",
    }
}

words! {
    /// How law and observer act in time.
    pub enum TimeMode {
        /// Law and observer act in continuous time; unicycles only.
        Continuous = "continuous",
        /// The law is evaluated every period and held; the observer sees the plant between samples.
        Sampled = "sampled",
        /// As sampled, but the observer sees samples only.
        Measured = "measured",
    }
}

/// Where the estimate of [distance in m, bearing in rad] starts; that of their rates starts at 0.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObserverStart {
    /// At the first measurement, s(0).
    #[default]
    Measured,
    /// At these values.
    At([f64; 2]),
    /// At the first measurement plus these.
    Offset([f64; 2]),
}
