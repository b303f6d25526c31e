//! The three leader-follower laws: full state (20), robust state (22) and output feedback (42).
//!
//! All three ask for ϖ = −g⁻¹ b with
//! b = d²s^d/dt² + g0 + g_s ds/dt + 2 K de/dt + K² e + extra,
//! where extra is g_v V_i for full state feedback and ū = β sign(e) (or β tanh(slope · e)) for the other two.
//! Output feedback takes ds/dt from the observer. Saturation follows in [`vocabulary::Limits`].

use crate::path_heading::Heading;
use crate::relative::Geometry;
use laws::Knowledge;
use nalgebra::Vector2;
use vocabulary::{Command, LawKind, MotionInput, SetPoint, math};

/// How the robust term switches (eq 23).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Switching {
    /// β sign(e), as the theorems ask.
    Sign,
    /// β tanh(slope · e), as the paper's simulations use; slopes in [1/m, 1/rad].
    Tanh([f64; 2]),
}

/// Parameters of a law; gains are diagonal, [distance, bearing].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Which of the three.
    pub kind: LawKind,
    /// K, 1/s.
    pub gain: [f64; 2],
    /// β, [m/s², rad/s²].
    pub robust_gain: [f64; 2],
    /// Shape of the robust term.
    pub switching: Switching,
    /// ℓ_min, m: the laws divide by no less; positive.
    pub distance_min: f64,
    /// Against what heading the bearing is held. Against a path's, "bearing" means the direction φ of the line in all of
    /// the law and its observer, and the leader's turn rate and its change are taken as zero: they do nothing to φ.
    pub heading: Heading,
}

/// What a law looks at.
#[derive(Debug, Clone, Copy)]
pub struct LawInput<'a> {
    /// Relative position, distance kept off zero.
    pub geometry: &'a Geometry,
    /// e, [m, rad], bearing wrapped.
    pub error: [f64; 2],
    /// s^d and its derivatives.
    pub set_point: &'a SetPoint,
    /// ds/dt or its estimate, [m/s, rad/s].
    pub rates: [f64; 2],
    /// v_j, m/s, positive.
    pub own_speed: f64,
    /// The leader's motion; only full state feedback looks at it.
    pub leader: &'a MotionInput,
}

impl Law {
    /// d[ℓ, ψ]/dt, or d[ℓ, φ]/dt, [m/s, rad/s].
    pub fn rates(&self, geometry: &Geometry, follower_speed: f64, leader: &MotionInput) -> Vector2<f64> {
        let turn_rate = match self.heading {
            Heading::Leader => leader.turn_rate,
            Heading::Path(_) => 0.0,
        };
        geometry.rates(follower_speed, leader.speed, turn_rate)
    }

    /// What the law has to know of its leader.
    pub fn knows(&self) -> Knowledge {
        match self.kind {
            LawKind::FullState => Knowledge::Motion,
            LawKind::RobustState => Knowledge::Rates,
            LawKind::OutputFeedback => Knowledge::Output,
        }
    }

    /// g_v V_i, [m/s², rad/s²].
    pub fn leader_effect(
        &self,
        geometry: &Geometry,
        follower_speed: f64,
        leader: &MotionInput,
    ) -> Vector2<f64> {
        let turn_acceleration = match self.heading {
            Heading::Leader => leader.turn_acceleration,
            // The turn rate stays where it turns the leader's velocity (column 5 of g_v).
            Heading::Path(_) => 0.0,
        };
        geometry.leader_effect(follower_speed, &MotionInput { turn_acceleration, ..*leader })
    }

    /// The command before saturation, eqs 20, 22, 42.
    pub fn command(&self, input: &LawInput<'_>) -> Command {
        let (geometry, v) = (input.geometry, input.own_speed);
        let rates = Vector2::from(input.rates);
        let mut b = Vector2::from(input.set_point.acceleration)
            + geometry.line.drift(v)
            + geometry.line.rate_column(v) * rates.x
            + self.feedback(input);
        b += match self.kind {
            LawKind::FullState => self.leader_effect(geometry, v, input.leader),
            LawKind::RobustState | LawKind::OutputFeedback => self.robust_term(input.error),
        };
        let u = geometry.line.minus_inverse_input(v, &b);
        Command { acceleration: u.x, turn_rate: u.y }
    }

    /// 2 K de/dt + K² e, [m/s², rad/s²].
    fn feedback(&self, input: &LawInput<'_>) -> Vector2<f64> {
        let channel = |i: usize| {
            let k = self.gain[i];
            2.0 * k * (input.set_point.rate[i] - input.rates[i]) + k * k * input.error[i]
        };
        Vector2::new(channel(0), channel(1))
    }

    /// ū of eq 23, [m/s², rad/s²].
    pub fn robust_term(&self, error: [f64; 2]) -> Vector2<f64> {
        let channel = |i: usize| {
            self.robust_gain[i]
                * match self.switching {
                    Switching::Sign => sign(error[i]),
                    Switching::Tanh(slope) => math::tanh(slope[i] * error[i]),
                }
        };
        Vector2::new(channel(0), channel(1))
    }
}

/// sign(0) = 0, unlike [`f64::signum`] (below eq 23).
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

#[cfg(test)]
pub(crate) fn test_law() -> Law {
    use vocabulary::PathFilter;
    Law {
        kind: LawKind::OutputFeedback,
        gain: [5.0; 2],
        robust_gain: [5.0; 2],
        switching: Switching::Tanh([24.53; 2]),
        distance_min: 0.1,
        heading: Heading::Path(PathFilter { length: 1.0, lag: 0.0 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relative::second_rates;
    use proptest::prelude::*;
    use std::f64::consts::PI;
    use vocabulary::{Limits, Pose, Relative, wrap};

    const LIMITS: Limits = Limits::PAPER;

    fn law(kind: LawKind) -> Law {
        Law {
            kind,
            gain: [5.0, 4.0],
            robust_gain: [5.0, 3.0],
            switching: Switching::Tanh([24.53; 2]),
            distance_min: 0.1,
            heading: Heading::Leader,
        }
    }

    fn any_f64() -> impl Strategy<Value = f64> {
        prop_oneof![
            4 => -1e3..1e3,
            1 => Just(0.0),
            1 => Just(f64::NAN),
            1 => Just(f64::INFINITY),
            1 => Just(f64::NEG_INFINITY),
            1 => Just(f64::MAX),
            1 => Just(f64::MIN_POSITIVE),
        ]
    }

    proptest! {
        /// Put into eq 8, the full state law leaves d²e/dt² + 2 K de/dt + K² e = 0 (eq 21).
        #[test]
        fn full_state_feedback_linearises_the_error(
            x in -4.0..4.0, y in -4.0..4.0, h in -PI..PI, v in 0.05..1.6,
            lv in 0.0..1.5, la in -1.0..1.0, lw in -1.0..1.0, ldw in -1.0..1.0, sd in 0.5..4.0, sb in -PI..PI,
        ) {
            let r = Relative::between(Pose::default(), Pose::new(x, y, h));
            prop_assume!(r.distance > 0.2);
            let geometry = Geometry::new(&r, 0.1);
            let leader = MotionInput { speed: lv, acceleration: la, turn_rate: lw, turn_acceleration: ldw };
            let set_point = SetPoint { value: [sd, sb], rate: [0.1, -0.2], acceleration: [0.3, 0.1] };
            let rates = geometry.rates(v, lv, lw);
            let error = [sd - r.distance, wrap(sb - r.bearing)];
            let law = law(LawKind::FullState);
            let u = law.command(&LawInput {
                geometry: &geometry, error, set_point: &set_point, rates: rates.into(), own_speed: v, leader: &leader,
            });
            let second = second_rates(&geometry, v, &Vector2::new(u.acceleration, u.turn_rate), &rates, &leader);
            for i in 0..2 {
                let (k, de) = (law.gain[i], set_point.rate[i] - rates[i]);
                let residue = set_point.acceleration[i] - second[i] + 2.0 * k * de + k * k * error[i];
                prop_assert!(residue.abs() < 1e-8 * (1.0 + second.norm()), "channel {i}: {residue}");
            }
        }

        /// No input may produce NaN or an unbounded command.
        #[test]
        fn saturated_commands_are_finite_for_any_input(
            n in proptest::collection::vec(any_f64(), 16), which in 0_usize..3, sign in any::<bool>(),
        ) {
            let kind = [LawKind::FullState, LawKind::RobustState, LawKind::OutputFeedback][which];
            let mut law = law(kind);
            if sign { law.switching = Switching::Sign; }
            let r = vocabulary::Relative { distance: n[0], bearing: n[1], view_angle: n[2] };
            let geometry = Geometry::new(&r, law.distance_min);
            let leader = MotionInput { speed: n[3], acceleration: n[4], turn_rate: n[5], turn_acceleration: n[6] };
            let set_point = SetPoint { value: [n[7], n[8]], rate: [n[9], n[10]], acceleration: [n[11], n[12]] };
            let own_speed = LIMITS.clamp_speed(n[13]);
            prop_assert!(own_speed >= LIMITS.speed_min);
            let asked = law.command(&LawInput {
                geometry: &geometry, error: [n[14], n[15]], set_point: &set_point, rates: [n[5], n[6]], own_speed,
                leader: &leader,
            });
            let cut = LIMITS.saturate(asked, 1.0);
            prop_assert!(cut.acceleration.is_finite() && cut.turn_rate.abs() <= 11.5);
        }
    }

    #[test]
    fn on_its_set_point_behind_a_steady_leader_nothing_is_asked() {
        let root = 2.0_f64.sqrt();
        let r = Relative::between(Pose::default(), Pose::new(-root, -root, 0.0));
        let geometry = Geometry::new(&r, 0.1);
        let set_point = SetPoint { value: [2.0, -0.75 * PI], ..SetPoint::default() };
        let leader = MotionInput { speed: 1.0, ..MotionInput::default() };
        let u = law(LawKind::FullState).command(&LawInput {
            geometry: &geometry,
            error: [0.0; 2],
            set_point: &set_point,
            rates: [0.0; 2],
            own_speed: 1.0,
            leader: &leader,
        });
        assert!(u.acceleration.abs() < 1e-12 && u.turn_rate.abs() < 1e-12, "{u:?}");
    }

    #[test]
    fn both_shapes_of_the_robust_term() {
        let mut law = law(LawKind::RobustState);
        assert!((law.robust_term([0.1, -0.1]).x - 5.0 * math::tanh(2.453_f64)).abs() < 1e-15);
        law.switching = Switching::Sign;
        assert_eq!(law.robust_term([1e-9, -2.0]), Vector2::new(5.0, -3.0));
        assert_eq!(law.robust_term([0.0, -0.0]), Vector2::zeros());
    }
}
