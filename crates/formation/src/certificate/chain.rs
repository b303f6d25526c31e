//! How a disturbance of a lead robot's motion goes down a chain of followers: gains over frequency.
//!
//! Every edge is linearised about steady motion, its law acting in continuous time and without limits. From the
//! leader's deviation [δv, δω] follow the errors [δℓ, δψ] and the follower's own deviation, which is what the next one
//! follows.

use crate::edge_law::EdgeLaw;
use crate::law::{Law, LawInput, Switching};
use crate::observer::Estimate;
use crate::path_heading::PathHeading;
use crate::relative::Geometry;
use nalgebra::{Complex, DMatrix, DVector, Matrix2, SVector};
use vocabulary::{EdgeSample, LawKind, MotionInput, Relative, SetPoint, math, wrap};

/// What one edge makes of its leader's deviation [δv in m/s, δω in rad/s] at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// To its errors [m, rad].
    pub error: Matrix2<Complex<f64>>,
    /// To its own deviation [m/s, rad/s].
    pub passed_on: Matrix2<Complex<f64>>,
}

/// An edge about steady motion.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearEdge {
    /// ∂(dx/dt)/∂x; x = [ℓ, ψ, γ, v_j], with an observer ŝ₁ and ŝ₂, with a path's heading θ_i − θ̄ and κ̄.
    a: DMatrix<f64>,
    /// ∂(dx/dt)/∂[v_i, ω_i] and ∂(dx/dt)/∂[dv_i/dt, dω_i/dt].
    b: [DMatrix<f64>; 2],
    /// ∂ω_j/∂x, ∂ω_j/∂[v_i, ω_i], ∂ω_j/∂[dv_i/dt, dω_i/dt].
    turn: [DMatrix<f64>; 3],
    /// Where θ_i − θ̄ stands among the entries of x.
    heading: Option<usize>,
    /// What the follower does in steady motion.
    pub follower: MotionInput,
    /// Its error there, [m, rad].
    pub error: [f64; 2],
}

/// x, of which an edge has a part.
type State = SVector<f64, 10>;
/// Where in it θ_i − θ̄ and κ̄ stand.
const HEADING: [usize; 2] = [8, 9];

/// Why there is no linear edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotLinear {
    /// The follower has several leaders.
    SeveralLeaders,
    /// A custom law: what it does is not known here.
    CustomLaw,
    /// The sign has no slope.
    Sign,
    /// There is no steady motion: β is too small, or the place stands still.
    NoSteadyMotion,
}

struct ChainLink<'a> {
    law: &'a EdgeLaw,
    set_point: SetPoint,
}

impl ChainLink<'_> {
    /// dx/dt and ω_j.
    fn rate(&self, x: &State, leader: &MotionInput) -> (State, f64) {
        let relative = Relative { distance: x[0], bearing: x[1], view_angle: x[2] };
        let law = &self.law.law;
        let geometry = Geometry::new(&relative, law.distance_min);
        let rates = geometry.rates(x[3], leader.speed, leader.turn_rate);
        // With a path's heading ψ + θ_i and ψ^d + θ̄ take the place of ψ and ψ^d. Both are counted from θ_i here, which is
        // the same but for the rates.
        let filter = law.heading.filter();
        let behind = PathHeading { heading: 0.0, behind: x[HEADING[0]], curvature: x[HEADING[1]] };
        let turning = filter.map_or(0.0, |_| leader.turn_rate);
        let mut set_point = self.set_point;
        set_point.value[1] -= behind.behind;
        set_point.rate[1] += filter.map_or(0.0, |filter| behind.rate(filter, leader.speed));
        let estimate = Estimate { output: [x[4], x[5]], rates: [x[6], x[7]] };
        let observes = law.kind == LawKind::OutputFeedback;
        let error = [set_point.value[0] - x[0], wrap(set_point.value[1] - x[1])];
        let command = law.command(&LawInput {
            geometry: &geometry,
            error,
            set_point: &set_point,
            rates: if observes { estimate.rates } else { [rates.x, rates.y + turning] },
            own_speed: x[3],
            leader,
        });
        let mut out = State::zeros();
        out[0] = rates.x;
        out[1] = rates.y;
        out[2] = rates.y + leader.turn_rate - command.turn_rate;
        out[3] = command.acceleration;
        if observes {
            let sample = EdgeSample {
                relative,
                own_speed: x[3],
                acceleration: command.acceleration,
                turn_rate: command.turn_rate,
            };
            let d = self.law.observer.derivative(&estimate, &sample);
            out.fixed_rows_mut::<4>(4).copy_from(&SVector::<f64, 4>::new(
                d.output[0],
                d.output[1] - turning,
                d.rates[0],
                d.rates[1],
            ));
        }
        if let Some(filter) = filter {
            let [rise, fall] = filter.curvature_gains();
            out[HEADING[0]] = leader.turn_rate - behind.rate(filter, leader.speed);
            out[HEADING[1]] = leader.speed * (rise * behind.behind - fall * behind.curvature);
        }
        (out, command.turn_rate)
    }

    /// The entries of x that this edge has.
    fn entries(&self) -> Vec<usize> {
        let law = &self.law.law;
        let observer = if law.kind == LawKind::OutputFeedback { 4..8 } else { 4..4 };
        let heading = law.heading.filter().map_or(&[][..], |_| &HEADING);
        (0..4).chain(observer).chain(heading.iter().copied()).collect()
    }

    /// How dx/dt and ω_j change with each of the `entries` of x.
    fn by_state(&self, x: &State, leader: &MotionInput, entries: &[usize]) -> Vec<(State, f64)> {
        let column = |k: &usize| {
            let mut shift = State::zeros();
            shift[*k] = STEP;
            slope([x + shift, x - shift].map(|x| self.rate(&x, leader)))
        };
        entries.iter().map(column).collect()
    }

    /// The state at rest next to `x`, by Newton's method.
    fn settle(&self, mut x: State, leader: &MotionInput, entries: &[usize]) -> Option<State> {
        let size = entries.len();
        for _ in 0..50 {
            let (rate, _) = self.rate(&x, leader);
            let columns = self.by_state(&x, leader, entries);
            let slopes = DMatrix::from_fn(size, size, |i, j| columns[j].0[entries[i]]);
            let step = slopes.lu().solve(&DVector::from_fn(size, |i, _| rate[entries[i]]))?;
            // Half a step at most where it is far: tanh bends.
            let short = (0.2 / step.amax()).min(1.0);
            for (entry, step) in entries.iter().zip(step.iter()) {
                x[*entry] -= short * step;
            }
            if step.amax() < 1e-11 {
                let stands =
                    x[3] > 1e-6 && x[0] > self.law.law.distance_min && x.iter().all(|v| v.is_finite());
                return stands.then_some(x);
            }
        }
        None
    }
}

/// Step of central differences.
const STEP: f64 = 1e-6;

fn slope([after, before]: [(State, f64); 2]) -> (State, f64) {
    ((after.0 - before.0) / (2.0 * STEP), (after.1 - before.1) / (2.0 * STEP))
}

impl LinearEdge {
    /// About a leader that drives steadily at `leader`, its accelerations zero.
    ///
    /// # Errors
    /// [`NotLinear`] where there is no steady motion to linearise about.
    pub fn about(law: &EdgeLaw, leader: &MotionInput) -> Result<Self, NotLinear> {
        if !law.is_built_in() {
            return Err(NotLinear::CustomLaw);
        }
        if law.law.kind != LawKind::FullState && law.law.switching == Switching::Sign {
            return Err(NotLinear::Sign);
        }
        let set_point = SetPoint { value: law.set_point.at(0.0).value, ..SetPoint::default() };
        let edge = ChainLink { law, set_point };
        let entries = edge.entries();
        let guess = near(&law.law, &set_point, leader).ok_or(NotLinear::NoSteadyMotion)?;
        let x = edge.settle(guess, leader, &entries).ok_or(NotLinear::NoSteadyMotion)?;
        let follower = MotionInput { speed: x[3], turn_rate: leader.turn_rate, ..MotionInput::default() };
        let error = [set_point.value[0] - x[0], wrap(set_point.value[1] - x[HEADING[0]] - x[1])];
        let states = edge.by_state(&x, leader, &entries);
        let by_leader = |change: fn(&mut MotionInput, f64)| {
            let at = |h: f64| {
                let mut moved = *leader;
                change(&mut moved, h);
                edge.rate(&x, &moved)
            };
            slope([STEP, -STEP].map(at))
        };
        let speeds = [by_leader(|d, h| d.speed += h), by_leader(|d, h| d.turn_rate += h)];
        let accelerations =
            [by_leader(|d, h| d.acceleration += h), by_leader(|d, h| d.turn_acceleration += h)];
        let matrix = |columns: &[(State, f64)]| {
            DMatrix::from_fn(entries.len(), columns.len(), |i, j| columns[j].0[entries[i]])
        };
        let turn = |columns: &[(State, f64)]| DMatrix::from_fn(1, columns.len(), |_, j| columns[j].1);
        Ok(Self {
            a: matrix(&states),
            b: [matrix(&speeds), matrix(&accelerations)],
            turn: [turn(&states), turn(&speeds), turn(&accelerations)],
            heading: entries.iter().position(|entry| *entry == HEADING[0]),
            follower,
            error,
        })
    }

    /// The response at `frequency` rad/s, above zero; `None` at a pole.
    pub fn at(&self, frequency: f64) -> Option<Response> {
        let s = Complex::new(0.0, frequency);
        let complex = |m: &DMatrix<f64>| m.map(|x| Complex::new(x, 0.0));
        let size = self.a.nrows();
        let left = DMatrix::<Complex<f64>>::identity(size, size) * s - complex(&self.a);
        let right = complex(&self.b[0]) + complex(&self.b[1]) * s;
        let x = left.lu().solve(&right)?;
        let turn = complex(&self.turn[0]) * &x + complex(&self.turn[1]) + complex(&self.turn[2]) * s;
        // The set point moves with the filtered heading, which is the last but one of the entries.
        let moved = |i: usize, j: usize| match self.heading {
            Some(entry) if i == 1 => x[(entry, j)],
            _ => Complex::new(0.0, 0.0),
        };
        Some(Response {
            error: Matrix2::from_fn(|i, j| -x[(i, j)] - moved(i, j)),
            passed_on: Matrix2::from_fn(|i, j| if i == 0 { x[(3, j)] } else { turn[(0, j)] }),
        })
    }

    /// Whether a deviation dies out when the leader drives steadily.
    pub fn stable(&self) -> bool {
        self.a.complex_eigenvalues().iter().all(|z| z.re < 0.0)
    }
}

/// The state of an edge in steady motion, but for what its observer is off.
fn near(law: &Law, set_point: &SetPoint, leader: &MotionInput) -> Option<State> {
    let mut error = [0.0; 2];
    // On a circle the filtered heading is behind by its lag.
    let lag = law.heading.filter().map_or(0.0, |filter| filter.lag);
    let curvature = if leader.speed > 0.0 { leader.turn_rate / leader.speed } else { 0.0 };
    let behind = lag * curvature;
    // What the leader's motion does depends a little on where the follower ends: this settles in a few rounds.
    for _ in 0..100 {
        let [distance, bearing] = [set_point.value[0] - error[0], set_point.value[1] - behind - error[1]];
        let (x, y) = (distance * math::cos(bearing), distance * math::sin(bearing));
        let (ahead, aside) = (leader.speed - leader.turn_rate * y, leader.turn_rate * x);
        let speed = math::hypot(ahead, aside);
        // θ_j − θ_i, and γ = ψ + θ_i − θ_j.
        let view_angle = wrap(bearing - math::atan2(aside, ahead));
        let relative = Relative { distance, bearing, view_angle };
        let geometry = Geometry::new(&relative, law.distance_min);
        let effect = geometry.leader_effect(speed, leader);
        let next = [0, 1].map(|i| match law.kind {
            LawKind::FullState => 0.0,
            LawKind::RobustState | LawKind::OutputFeedback => residual(law, i, effect[i]),
        });
        let moved = (next[0] - error[0]).abs().max((next[1] - error[1]).abs());
        error = next;
        if moved < 1e-13 {
            let turning = law.heading.filter().map_or(0.0, |_| leader.turn_rate);
            let kept = law.heading.filter().map_or(0.0, |filter| curvature - filter.gain() * behind);
            return Some(State::from([
                distance, bearing, view_angle, speed, distance, bearing, 0.0, turning, behind, kept,
            ]));
        }
    }
    None
}

/// What a smoothed robust term leaves of the error: k² e + β tanh(slope e) = `effect`, by bisection; m or rad.
///
/// For the sign it is zero while |effect| < β, and (|effect| − β)/k² beyond.
pub fn residual(law: &Law, channel: usize, effect: f64) -> f64 {
    let (k, beta) = (law.gain[channel], law.robust_gain[channel]);
    let size = effect.abs();
    let found = match law.switching {
        Switching::Sign => ((size - beta) / (k * k)).max(0.0),
        Switching::Tanh(slope) => {
            let (mut low, mut high) = (0.0, size / (k * k));
            for _ in 0..200 {
                let middle = f64::midpoint(low, high);
                let more = k * k * middle + beta * math::tanh(slope[channel] * middle) < size;
                if more { low = middle } else { high = middle }
            }
            f64::midpoint(low, high)
        }
    };
    found.copysign(effect)
}

/// What comes down a chain of edges at one frequency: the errors of its last edge, per deviation of the first leader.
pub fn down_the_chain(edges: &[Response]) -> Option<Matrix2<Complex<f64>>> {
    let (last, before) = edges.split_last()?;
    let arrived = before.iter().fold(Matrix2::identity(), |sum, edge| edge.passed_on * sum);
    Some(last.error * arrived)
}

/// By how much a deviation grows from follower to follower at most, in a long chain of equal edges at one frequency.
pub fn growth(response: &Response) -> f64 {
    // Eigenvalues of 2×2 in closed form.
    let m = &response.passed_on;
    let (half, det) = ((m[(0, 0)] + m[(1, 1)]) * 0.5, m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)]);
    let root = (half * half - det).sqrt();
    (half + root).norm().max((half - root).norm())
}

/// Frequencies at which responses are looked at: evenly in their logarithm, rad/s.
pub fn frequencies() -> impl Iterator<Item = f64> {
    (0..=240).map(|k| 1e-2 * math::powf(10_f64, f64::from(k) / 60.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Law;
    use crate::observer::Observer;
    use crate::path_heading::Heading;
    use crate::set_point::SetPointTrajectory;

    fn edge(kind: LawKind, epsilon: f64) -> EdgeLaw {
        let law = Law {
            kind,
            gain: [5.0; 2],
            robust_gain: [5.0; 2],
            switching: Switching::Tanh([24.53; 2]),
            distance_min: 0.1,
            heading: Heading::Leader,
        };
        let observer =
            Observer { epsilon: [epsilon; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 };
        let set_point = SetPointTrajectory::constant(2.0, -0.75 * std::f64::consts::PI);
        EdgeLaw {
            law,
            custom: None,
            batch: None,
            observer,
            tracker: None,
            set_point,
            free: [false; 2],
            standing: false,
            narrowing: None,
        }
    }

    const AHEAD: MotionInput =
        MotionInput { speed: 1.0, acceleration: 0.0, turn_rate: 0.0, turn_acceleration: 0.0 };
    const ROUND: MotionInput = MotionInput { turn_rate: 0.3, ..AHEAD };

    fn linear(kind: LawKind, epsilon: f64, leader: &MotionInput) -> LinearEdge {
        LinearEdge::about(&edge(kind, epsilon), leader).expect("steady motion")
    }

    /// What the reference solutions end at, which were integrated independently.
    #[test]
    fn steady_errors_are_those_of_the_reference_solutions() {
        for (kind, epsilon, leader, wanted, room) in [
            (LawKind::FullState, 1e-3, AHEAD, [0.0, 0.0], 1e-9),
            (LawKind::RobustState, 1e-3, AHEAD, [3.399e-3, 0.0], 1e-6),
            (LawKind::OutputFeedback, 1e-3, AHEAD, [0.003_469_507_901, -2.456_929_665e-6], 1e-10),
            (LawKind::OutputFeedback, 0.1, AHEAD, [0.011_226_779_19, -0.000_787_177_906_8], 1e-9),
            (LawKind::RobustState, 1e-3, ROUND, [4.85e-3, -7.2e-4], 1e-5),
            (LawKind::OutputFeedback, 0.1, ROUND, [0.016_371_823_77, -0.004_257_534_883], 1e-8),
        ] {
            let found = linear(kind, epsilon, &leader).error;
            for i in 0..2 {
                assert!(
                    (found[i] - wanted[i]).abs() < room,
                    "{kind:?} ε {epsilon}: {found:?}, not {wanted:?}"
                );
            }
        }
    }

    #[test]
    fn full_state_feedback_rejects_what_its_leader_does() {
        let edge = linear(LawKind::FullState, 1e-3, &AHEAD);
        assert!(edge.stable());
        for frequency in [0.1, 1.0, 10.0] {
            let error = edge.at(frequency).expect("a response").error;
            assert!(error.iter().all(|x| x.norm() < 1e-6), "{error}");
        }
    }

    /// Slowly, a follower does as its leader does.
    #[test]
    fn slow_changes_are_passed_on_whole() {
        for kind in [LawKind::RobustState, LawKind::OutputFeedback] {
            let edge = linear(kind, 1e-3, &AHEAD);
            assert!(edge.stable());
            let response = edge.at(1e-3).expect("a response");
            // A turn of the leader swings the follower out: it stands √2 m to the right.
            let rigid = Matrix2::new(1.0, 2.0_f64.sqrt(), 0.0, 1.0).map(|x| Complex::new(x, 0.0));
            assert!((response.passed_on - rigid).norm() < 0.02, "{}", response.passed_on);
            assert!((growth(&response) - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn a_chain_of_one_is_its_edge_and_of_two_passes_on() {
        let response = linear(LawKind::RobustState, 1e-3, &AHEAD).at(2.0).expect("a response");
        assert_eq!(down_the_chain(&[response]), Some(response.error));
        let two = down_the_chain(&[response, response]).expect("two");
        assert!((two - response.error * response.passed_on).norm() < 1e-12);
        assert_eq!(down_the_chain(&[]), None);
    }

    #[test]
    fn what_tanh_leaves_solves_its_equation() {
        let law = edge(LawKind::RobustState, 1e-3).law;
        let e = residual(&law, 0, 0.5);
        assert!(e > 0.0 && (25.0 * e + 5.0 * math::tanh(24.53 * e) - 0.5).abs() < 1e-12);
        assert_eq!(residual(&law, 0, -0.5), -e);
        let sign = Law { switching: Switching::Sign, ..law };
        assert_eq!((residual(&sign, 0, 4.9), residual(&sign, 0, 30.0)), (0.0, 1.0));
    }

    #[test]
    fn the_sign_has_no_slope_and_a_place_that_stands_still_no_motion() {
        let mut sign = edge(LawKind::RobustState, 1e-3);
        sign.law.switching = Switching::Sign;
        assert_eq!(LinearEdge::about(&sign, &AHEAD), Err(NotLinear::Sign));
        let still = MotionInput { speed: 0.0, ..AHEAD };
        assert_eq!(
            LinearEdge::about(&edge(LawKind::RobustState, 1e-3), &still),
            Err(NotLinear::NoSteadyMotion)
        );
    }
}
