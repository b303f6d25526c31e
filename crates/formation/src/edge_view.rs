//! What a law looks at on one edge at an instant.

use crate::law::{Law, LawInput};
use crate::path_heading::Heading;
use crate::relative::Geometry;
use laws::LeaderInput;
use vocabulary::{MotionInput, Relative, SetPoint, wrap};

/// What the law of a follower looks at on one edge.
pub(crate) struct EdgeView {
    pub(crate) geometry: Geometry,
    /// What the law works on.
    pub(crate) output: Relative,
    /// Bearing from the leader's own heading, rad.
    pub(crate) bearing: f64,
    /// s^d against the heading it is held against.
    pub(crate) place: SetPoint,
    /// s^d of what the law works on.
    pub(crate) set_point: SetPoint,
    /// Rates of what the law works on, as the follower knows them.
    pub(crate) rates: [f64; 2],
    pub(crate) own_speed: f64,
    pub(crate) leader: MotionInput,
}

impl EdgeView {
    pub(crate) fn law_input(&self) -> LawInput<'_> {
        LawInput {
            geometry: &self.geometry,
            error: self.error(),
            set_point: &self.set_point,
            rates: self.rates,
            own_speed: self.own_speed,
            leader: &self.leader,
        }
    }

    /// What the law would make zero, [m, rad].
    pub(crate) fn error(&self) -> [f64; 2] {
        tracking_error(&self.set_point, &self.output)
    }

    pub(crate) fn leader_input(&self, law: &Law) -> LeaderInput {
        LeaderInput {
            relative: Relative { distance: self.geometry.line.distance, ..self.output },
            rates: self.rates,
            wanted: self.set_point,
            motion: self.leader,
            frame: match law.heading {
                Heading::Leader => [self.leader.turn_rate, self.leader.turn_acceleration],
                Heading::Path(_) => [0.0; 2],
            },
            heading: wrap(self.output.bearing - self.bearing),
        }
    }
}

/// e = s^d − s, [m, rad], bearing wrapped (eq 14).
fn tracking_error(set_point: &SetPoint, output: &Relative) -> [f64; 2] {
    [set_point.value[0] - output.distance, wrap(set_point.value[1] - output.bearing)]
}
