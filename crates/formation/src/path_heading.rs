//! The heading against which a follower holds its bearing: the leader's own, or one filtered along the leader's path.
//!
//! Counted from the leader's own heading, a bearing swings with every turn of the leader, and a follower swings more than
//! its leader. Counted from a heading θ̄ that follows the leader's only as it drives, the follower tracks the direction
//! φ = ψ + θ_i of the line to it, φ^d = ψ^d + θ̄, and what its leader does to φ is free of the leader's turn rate.
//! The filter is [`PathFilter`].

use vocabulary::{HeadingReference, PathFilter, Relative, wrap};

/// Against what heading a bearing is held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Heading {
    /// The leader's own.
    #[default]
    Leader,
    /// The leader's, filtered along its path.
    Path(PathFilter),
}

/// θ̄ and κ̄ of one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathHeading {
    /// θ̄, rad in (−π, π].
    pub heading: f64,
    /// κ̄, 1/m.
    pub curvature: f64,
    /// e = θ_i − θ̄ at the last sample, rad.
    pub behind: f64,
}

impl Heading {
    /// Its filter, if it has one.
    pub fn filter(&self) -> Option<&PathFilter> {
        match self {
            Self::Leader => None,
            Self::Path(filter) => Some(filter),
        }
    }

    /// Its word.
    pub fn reference(&self) -> HeadingReference {
        match self {
            Self::Leader => HeadingReference::Leader,
            Self::Path(_) => HeadingReference::Path,
        }
    }

    /// What a law and its observer work on for a follower that heads for `own_heading` rad: with a filter, the direction
    /// φ = γ + θ_j of the line takes the place of the bearing.
    #[must_use]
    pub fn output(&self, relative: &Relative, own_heading: f64) -> Relative {
        match self {
            Self::Leader => *relative,
            Self::Path(_) => Relative { bearing: wrap(relative.view_angle + own_heading), ..*relative },
        }
    }
}

impl PathHeading {
    /// As it is behind a leader that has driven a curve of `curvature` 1/m for long, and heads for `leader_heading` rad.
    pub fn steady(filter: &PathFilter, leader_heading: f64, curvature: f64) -> Self {
        let (behind, left) = (filter.lag * curvature, 1.0 - filter.lag / filter.length);
        Self { heading: wrap(leader_heading - behind), curvature: left * left * curvature, behind }
    }

    /// Goes on over `travelled` m of the leader's way, at the end of which it heads for `leader_heading` rad. Exact for a
    /// heading that is held.
    pub fn advance(&mut self, filter: &PathFilter, leader_heading: f64, travelled: f64) {
        let e = wrap(leader_heading - self.heading);
        [self.behind, self.curvature] = filter.step([e, self.curvature], travelled);
        self.heading = wrap(leader_heading - self.behind);
    }

    /// dθ̄/dt in rad/s for a leader at `speed` m/s.
    pub fn rate(&self, filter: &PathFilter, speed: f64) -> f64 {
        speed * (self.curvature + filter.gain() * self.behind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The equations by small Euler steps, an independent way.
    fn by_steps(filter: &PathFilter, start: &PathHeading, leader: f64, travelled: f64) -> [f64; 2] {
        let (mut heading, mut curvature) = (start.heading, start.curvature);
        let n = 200_000;
        let ds = travelled / f64::from(n);
        let (l, t) = (filter.length, filter.lag);
        for _ in 0..n {
            let e = leader - heading;
            heading += ds * (curvature + (2.0 * l - t) / (l * l) * e);
            curvature += ds * ((1.0 - t / l) * (1.0 - t / l) * e - t * curvature) / (l * l);
        }
        [heading, curvature]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn a_step_is_that_of_the_equations(
            length in 0.3..3.0, share in 0.0..2.0, leader in -1.0..1.0, curvature in -0.5..0.5, travelled in 0.0..2.0
        ) {
            let filter = PathFilter { length, lag: share * length };
            let mut state = PathHeading { heading: 0.2, curvature, behind: 0.0 };
            let expected = by_steps(&filter, &state, leader, travelled);
            state.advance(&filter, leader, travelled);
            prop_assert!((state.heading - expected[0]).abs() < 1e-4, "{state:?} {expected:?}");
            prop_assert!((state.curvature - expected[1]).abs() < 1e-4, "{state:?} {expected:?}");
        }
    }

    #[test]
    fn at_rest_nothing_moves_whatever_the_leader_measures() {
        let filter = PathFilter { length: 1.0, lag: 1.0 };
        let mut state = PathHeading { heading: 0.1, curvature: 0.3, behind: 0.0 };
        state.advance(&filter, 2.0, 0.0);
        assert!((state.heading - 0.1).abs() < 1e-15 && state.curvature == 0.3);
        assert_eq!(state.rate(&filter, 0.0), 0.0);
    }

    /// On a circle of radius R the filtered heading ends τ/R behind, and turns with the leader.
    #[test]
    fn on_a_circle_it_lags_by_its_lag_over_the_radius() {
        for lag in [0.0, 0.4, 1.0, 1.6] {
            let filter = PathFilter { length: 0.8, lag };
            let mut state = PathHeading::steady(&filter, 0.0, 0.0);
            let (radius, step) = (5.0, 1e-3);
            let mut heading = 0.0;
            for _ in 0..40_000 {
                heading = wrap(heading + step / radius);
                state.advance(&filter, heading, step);
            }
            assert!((state.behind - lag / radius).abs() < 1e-3, "{lag}: {state:?}");
            assert!((state.behind - filter.steady(2.0, 2.0 / radius)).abs() < 1e-3, "{lag}: {state:?}");
            assert!((state.rate(&filter, 2.0) - 2.0 / radius).abs() < 1e-3, "{lag}: {state:?}");
        }
    }

    /// A heading that begins steady stays so on the circle.
    #[test]
    fn what_begins_steady_on_a_circle_stays_so() {
        let (filter, curvature) = (PathFilter { length: 1.0, lag: 0.6 }, 0.25);
        let mut heading = PathHeading::steady(&filter, 0.3, curvature);
        let began = heading;
        for k in 1..=400 {
            heading.advance(&filter, 0.3 + 0.01 * curvature * f64::from(k), 0.01);
        }
        assert!((heading.behind - began.behind).abs() < 2e-3, "{heading:?}");
        assert!((heading.curvature - began.curvature).abs() < 2e-3, "{heading:?}");
        assert!((began.rate(&filter, 2.0) - 0.5).abs() < 1e-12);
    }
}
