//! One number of what an agent observes.

use laws::{INPUTS, Input, InputKind};
use std::str::FromStr;
use vocabulary::{math, wrap};

/// What a number is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// What a law is told.
    Told(InputKind),
    /// A set point minus what is told.
    Error { wanted: InputKind, told: InputKind, angle: bool },
}

/// What is made of it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Function {
    Plain,
    Sin,
    Cos,
}

/// One number of what an agent observes: what its law is told, scaled and within bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObservationColumn {
    source: Source,
    function: Function,
    /// What becomes 1.
    scale: f64,
    /// Bound on the number after it is scaled.
    limit: f64,
}

/// Differences of a set point and what is told.
const ERRORS: [(&str, Source); 4] = [
    ("error.distance", error(InputKind::WantedDistance, InputKind::Distance)),
    (
        "error.bearing",
        Source::Error { wanted: InputKind::WantedBearing, told: InputKind::Bearing, angle: true },
    ),
    ("error.distance_rate", error(InputKind::WantedDistanceRate, InputKind::DistanceRate)),
    ("error.bearing_rate", error(InputKind::WantedBearingRate, InputKind::BearingRate)),
];

const fn error(wanted: InputKind, told: InputKind) -> Source {
    Source::Error { wanted, told, angle: false }
}

impl ObservationColumn {
    /// The names of all columns but those within `sin(…)` and `cos(…)`.
    pub fn names() -> impl Iterator<Item = &'static str> {
        INPUTS.iter().map(|(_, name, ..)| *name).chain(ERRORS.iter().map(|(name, _)| *name))
    }

    /// The same where `scale` becomes 1 and nothing is beyond `limit` after that; both positive.
    #[must_use]
    pub fn scaled(self, scale: f64, limit: f64) -> Self {
        Self { scale, limit, ..self }
    }

    /// The number.
    pub(crate) fn value(&self, input: &Input<'_>) -> f64 {
        let value = match self.source {
            Source::Told(kind) => input.value(0, kind),
            Source::Error { wanted, told, angle } => {
                let error = input.value(0, wanted) - input.value(0, told);
                if angle { wrap(error) } else { error }
            }
        };
        let value = match self.function {
            Function::Plain => value,
            Function::Sin => math::sin(value),
            Function::Cos => math::cos(value),
        };
        (value / self.scale).clamp(-self.limit, self.limit)
    }
}

impl FromStr for ObservationColumn {
    type Err = String;

    /// By name, such as `error.distance` or `sin(leader.view_angle)`; not scaled, without bounds.
    fn from_str(text: &str) -> Result<Self, String> {
        let within = |start: &str| text.strip_prefix(start).and_then(|rest| rest.strip_suffix(')'));
        let (function, name) = match (within("sin("), within("cos(")) {
            (Some(name), _) => (Function::Sin, name),
            (_, Some(name)) => (Function::Cos, name),
            _ => (Function::Plain, text),
        };
        let told = INPUTS.iter().find(|(_, own, ..)| *own == name).map(|(kind, ..)| Source::Told(*kind));
        let error = ERRORS.iter().find(|(own, _)| *own == name).map(|(_, source)| *source);
        let source = told.or(error).ok_or_else(|| {
            let all: Vec<&str> = Self::names().collect();
            format!(
                "there is no observation `{text}`: there is {}, and sin(…) and cos(…) of them",
                all.join(", ")
            )
        })?;
        Ok(Self { source, function, scale: 1.0, limit: f64::INFINITY })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use laws::{LeaderInput, Noise};
    use vocabulary::Relative;

    #[test]
    fn a_column_is_scaled_within_bounds_and_angles_are_wrapped() {
        let relative = Relative { distance: 3.0, bearing: -3.0, view_angle: 0.5 };
        let mut leader = LeaderInput { relative, ..LeaderInput::default() };
        leader.wanted.value = [1.0, 3.0];
        let input = Input {
            time: 0.0,
            period: 0.01,
            own_speed: 1.0,
            own_acceleration: 0.0,
            own_turn_rate: 0.0,
            leaders: &[leader],
            noise: Noise::default(),
        };
        let value = |name: &str, scale: f64, limit: f64| {
            name.parse::<ObservationColumn>().expect("a column").scaled(scale, limit).value(&input)
        };
        assert_eq!(value("error.distance", 0.5, 10.0), -4.0);
        assert_eq!(value("error.distance", 0.5, 3.0), -3.0);
        assert!((value("error.bearing", 1.0, 10.0) - (6.0 - std::f64::consts::TAU)).abs() < 1e-12);
        assert_eq!(value("sin(leader.view_angle)", 1.0, 1.0), math::sin(0.5));
        assert!(
            "leader.distanse"
                .parse::<ObservationColumn>()
                .is_err_and(|text| text.contains("leader.distance,"))
        );
    }
}
