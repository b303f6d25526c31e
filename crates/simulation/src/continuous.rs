//! Law, observer and plant as one differential equation: the time of the theorems.
//!
//! Classical Runge-Kutta with a step well below the observers' time constants; speeds stop at their bounds after
//! every step. It costs about 1/ε evaluations per simulated second, which is the price of continuous time.

use formation::{Estimate, Formation, FormationState};
use vocabulary::{EdgeSample, Motion, Observation, Pose, math, wrap};
use world::{Unicycles, World};

/// Longest step, s.
const STEP_MAX: f64 = 2.5e-4;
/// Steps per smallest ε: leaves 1e-6 of a transient's size.
const STEPS_PER_EPSILON: f64 = 8.0;

/// All that moves in continuous time.
#[derive(Clone)]
pub(crate) struct Continuous {
    pub(crate) world: Unicycles,
    step: f64,
    observations: Vec<Observation>,
}

/// State of the whole system, or its rate of change.
#[derive(Debug, Clone)]
struct State {
    /// x, y, θ, v per robot.
    robots: Vec<[f64; 4]>,
    /// Per edge.
    estimates: Vec<Estimate>,
    /// Memories of custom laws, per edge.
    memories: Vec<Vec<f64>>,
}

impl Continuous {
    pub(crate) fn new(world: Unicycles, formation: &Formation) -> Self {
        let mut system = Self { world, step: STEP_MAX, observations: Vec::new() };
        system.keep_pace(formation);
        system
    }

    /// Chooses the step for the observers of `formation`.
    pub(crate) fn keep_pace(&mut self, formation: &Formation) {
        let observing = formation.laws().iter().filter(|e| e.observes());
        let fastest = observing.flat_map(|e| e.observer.epsilon).fold(f64::INFINITY, f64::min);
        self.step = STEP_MAX.min(fastest / STEPS_PER_EPSILON);
    }

    /// One control period from `time`.
    pub(crate) fn advance(
        &mut self,
        formation: &Formation,
        state: &mut FormationState,
        time: f64,
        period: f64,
    ) {
        let mut scratch = state.clone();
        let robots = self.world.snapshot().robots.iter().map(|r| variables(&r.motion)).collect();
        let memories = state.customs.iter().map(|custom| custom.memory().to_vec()).collect();
        let mut y = State { robots, estimates: state.estimates.clone(), memories };
        let steps = (period / self.step).ceil();
        let h = period / steps;
        for k in 0..steps as usize {
            let t = time + k as f64 * h;
            let k1 = self.rate(formation, &mut scratch, t, &y);
            let k2 = self.rate(formation, &mut scratch, t + h / 2.0, &y.plus(&k1, h / 2.0));
            let k3 = self.rate(formation, &mut scratch, t + h / 2.0, &y.plus(&k2, h / 2.0));
            let k4 = self.rate(formation, &mut scratch, t + h, &y.plus(&k3, h));
            for (rate, weight) in [(&k1, 1.0), (&k2, 2.0), (&k3, 2.0), (&k4, 1.0)] {
                y = y.plus(rate, h * weight / 6.0);
            }
            bound_speeds(formation, t + h, &mut y);
        }
        state.estimates.clone_from(&y.estimates);
        for (custom, memory) in state.customs.iter_mut().zip(&y.memories) {
            custom.set_memory(memory);
        }
        let motions: Vec<Motion> = y.robots.iter().map(motion).collect();
        self.world.place(time + period, &motions);
    }

    fn rate(&mut self, formation: &Formation, scratch: &mut FormationState, t: f64, y: &State) -> State {
        self.observations.clear();
        let observe = |edge: &vocabulary::Edge| {
            let (leader, follower) = (motion(&y.robots[edge.leader]), motion(&y.robots[edge.follower]));
            Observation::true_of([&leader, &follower])
        };
        self.observations.extend(formation.edges().iter().map(observe));
        scratch.estimates.clone_from(&y.estimates);
        for (custom, memory) in scratch.customs.iter_mut().zip(&y.memories) {
            custom.set_memory(memory);
        }
        let mut out = State { robots: vec![[0.0; 4]; y.robots.len()], ..y.clone() };
        formation.evaluate(t, &self.observations, scratch, &mut out.memories);
        for (robot, lead) in formation.leads() {
            let drive = lead.at(t);
            out.robots[*robot] =
                unicycle(y.robots[*robot][2], drive.speed, drive.acceleration, drive.turn_rate);
        }
        for (index, edge) in formation.edges().iter().enumerate() {
            let (seen, applied) = (&self.observations[index], scratch.decisions[index].applied);
            let speed = formation.limits(edge.follower).clamp_speed(seen.own_speed);
            let heading = y.robots[edge.follower][2];
            out.robots[edge.follower] = unicycle(heading, speed, applied.acceleration, applied.turn_rate);
            let sample = EdgeSample {
                relative: seen.relative,
                own_speed: speed,
                acceleration: applied.acceleration,
                turn_rate: applied.turn_rate,
            };
            let law = &formation.laws()[index];
            out.estimates[index] = if law.observes() {
                law.observer.derivative(&y.estimates[index], &sample)
            } else {
                Estimate::default()
            };
        }
        out
    }
}

/// d[x, y, θ, v]/dt (eq 1).
fn unicycle(heading: f64, speed: f64, acceleration: f64, turn_rate: f64) -> [f64; 4] {
    let (sin, cos) = math::sin_cos(heading);
    [speed * cos, speed * sin, turn_rate, acceleration]
}

fn variables(m: &Motion) -> [f64; 4] {
    [m.pose.x, m.pose.y, m.pose.heading, m.speed]
}

fn motion(y: &[f64; 4]) -> Motion {
    Motion { pose: Pose::new(y[0], y[1], wrap(y[2])), speed: y[3], ..Motion::default() }
}

fn bound_speeds(formation: &Formation, t: f64, y: &mut State) {
    for edge in formation.edges() {
        let speed = &mut y.robots[edge.follower][3];
        *speed = formation.limits(edge.follower).clamp_speed(*speed);
    }
    for (robot, lead) in formation.leads() {
        y.robots[*robot][3] = lead.at(t).speed;
    }
}

impl State {
    fn plus(&self, rate: &Self, h: f64) -> Self {
        let mut out = self.clone();
        for (y, d) in out.robots.iter_mut().zip(&rate.robots) {
            for (y, d) in y.iter_mut().zip(d) {
                *y += h * d;
            }
        }
        for (y, d) in out.estimates.iter_mut().zip(&rate.estimates) {
            for i in 0..2 {
                y.output[i] += h * d.output[i];
                y.rates[i] += h * d.rates[i];
            }
        }
        for (y, d) in out.memories.iter_mut().flatten().zip(rate.memories.iter().flatten()) {
            *y += h * d;
        }
        out
    }
}
