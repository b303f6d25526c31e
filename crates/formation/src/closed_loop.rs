//! A custom law in closed loop with one exact unicycle behind leaders that drive on steadily: where the follower settles, and
//! the poles of the loop there.
//!
//! The loop is a map from one control sample to the next: the law decides, and the follower drives for a period. Its state is
//! the follower's pose and speed in the leaders' common frame, its last command, and the law's memory. The poles are s = ln z / T for the
//! eigenvalues z of the map's derivative, which is taken by central differences. Rates are true, and no limit acts.

use crate::relative::Geometry;
use laws::{CustomLaw, Fault, Input, InputKind, LeaderInput, Noise};
use nalgebra::DMatrix;
use vocabulary::{Command, MotionInput, Pose, Relative, SetPoint, math, wrap};

/// Leaders, and where the follower shall be.
#[derive(Debug, Clone, PartialEq)]
pub struct SteadyLeaders {
    /// Place of each leader in the frame that all of them share, m.
    pub places: Vec<[f64; 2]>,
    /// Wanted [distance in m, bearing in rad] from each; `None` where a part is left free.
    pub wanted: Vec<[Option<f64>; 2]>,
    /// Speed of the frame along its x axis, m/s.
    pub speed: f64,
    /// Its turn rate, rad/s.
    pub turn_rate: f64,
    /// Control period, s.
    pub period: f64,
    /// Where the follower starts in the frame, m.
    pub start: [f64; 2],
}

/// How a loop ends.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopEnd {
    /// When it ends, s.
    pub time: f64,
    /// Errors of distance and bearing for each leader, [m, rad]; 0 for a part that is left free.
    pub errors: Vec<[f64; 2]>,
    /// What the law asks for.
    pub command: Command,
    /// The follower's speed, m/s.
    pub speed: f64,
    /// How far pose and speed still moved in the last second, m, rad and m/s.
    pub moved: f64,
    /// Poles, 1/s, the slowest first; `None` where the follower does not settle.
    pub poles: Option<Vec<Pole>>,
    /// Memory that nothing else depends on, by its index: its pole is left out.
    pub apart: Vec<usize>,
}

/// A pole, 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pole {
    /// Real part.
    pub re: f64,
    /// Imaginary part; poles come in pairs where it is not 0.
    pub im: f64,
}

/// How long a follower may take to settle, s.
const LONGEST: f64 = 60.0;
/// Over this time it must stand still in the frame, s.
const STILL: f64 = 1.0;
/// Still is what moves by less than this, m, rad and m/s.
const LEAST: f64 = 1e-9;
/// What has gone by this factor after one sample has no pole worth telling.
const GONE: f64 = 1e-6;
/// Step of the differences.
const STEP: f64 = 1e-6;
/// Pose and speed of the follower.
const BODY: usize = 4;
/// These, and the last command: [dv/dt, ω].
const OWN: usize = 6;
/// Steps of the integration in a period.
const STEPS: u32 = 8;

struct ClosedLoop<'a> {
    law: &'a dyn CustomLaw,
    parameters: &'a [f64],
    leaders: &'a SteadyLeaders,
    /// Poses and motions of the leaders in the frame.
    motions: Vec<(Pose, MotionInput)>,
}

/// Lets a follower settle, and linearises the loop there.
///
/// # Errors
/// The law's [`Fault`].
pub fn close(law: &dyn CustomLaw, parameters: &[f64], leaders: &SteadyLeaders) -> Result<LoopEnd, Fault> {
    let closed = ClosedLoop { law, parameters, leaders, motions: motions(leaders) };
    let mut state = closed.start()?;
    let mut sample = 0;
    // What reads the clock may rest for a while and move on.
    let reads_time = law.declaration().reads.iter().any(|(_, kind)| *kind == InputKind::Time);
    let still = (STILL / leaders.period).ceil() as usize;
    let longest = (LONGEST / leaders.period).ceil() as usize;
    let (mut settled, mut moved) = (false, 0.0_f64);
    let mut command = Command::default();
    for _ in 0..longest / still {
        let before = state.clone();
        moved = 0.0;
        for _ in 0..still {
            (state, command) = closed.next(&state, sample)?;
            sample += 1;
            let change = state.iter().zip(&before).take(BODY).map(|(now, before)| (now - before).abs());
            moved = change.fold(moved, f64::max);
        }
        settled = moved < LEAST;
        if settled && !reads_time || !state.iter().all(|x| x.abs() < 1e6) {
            break;
        }
    }
    let errors = (0..closed.motions.len()).map(|k| closed.error(k, &state)).collect();
    let (poles, apart) = if settled { closed.poles(&state, sample)? } else { (None, vec![]) };
    let time = sample as f64 * leaders.period;
    Ok(LoopEnd { time, errors, command, speed: state[3], moved, poles, apart })
}

/// How the leaders of a rigid frame move.
fn motions(leaders: &SteadyLeaders) -> Vec<(Pose, MotionInput)> {
    let motion = |[x, y]: &[f64; 2]| {
        let (ahead, left) = (leaders.speed - leaders.turn_rate * y, leaders.turn_rate * x);
        let motion = MotionInput {
            speed: math::hypot(ahead, left),
            turn_rate: leaders.turn_rate,
            ..MotionInput::default()
        };
        (Pose::new(*x, *y, math::atan2(left, ahead)), motion)
    };
    leaders.places.iter().map(motion).collect()
}

impl ClosedLoop<'_> {
    /// [x, y, heading, speed, dv/dt, ω] of a follower that drives along with the frame, and the memory with which it meets its leaders.
    fn start(&self) -> Result<Vec<f64>, Fault> {
        let [x, y] = self.leaders.start;
        let (ahead, left) = (self.leaders.speed - self.leaders.turn_rate * y, self.leaders.turn_rate * x);
        let count = self.law.declaration().memory.len();
        let speed = math::hypot(ahead, left);
        let mut state = vec![x, y, math::atan2(left, ahead), speed, 0.0, self.leaders.turn_rate];
        state.resize(OWN + count, 0.0);
        let mut memory = vec![0.0; count];
        self.with_input(&state, 0, |input| self.law.start(input, self.parameters, &mut memory))?;
        state[OWN..].copy_from_slice(&memory);
        Ok(state)
    }

    /// Asks the law with what it sees in a state at a sample.
    fn with_input<T>(&self, state: &[f64], sample: u64, work: impl FnOnce(&Input<'_>) -> T) -> T {
        let own = Pose::new(state[0], state[1], wrap(state[2]));
        let leader = |((pose, motion), wanted): (&(Pose, MotionInput), &[Option<f64>; 2])| {
            let relative = Relative::between(*pose, own);
            let geometry = Geometry::new(&relative, 0.1);
            let at = [relative.distance, relative.bearing];
            LeaderInput {
                relative,
                rates: geometry.rates(state[3], motion.speed, motion.turn_rate).into(),
                wanted: SetPoint { value: [0, 1].map(|k| wanted[k].unwrap_or(at[k])), ..SetPoint::default() },
                motion: *motion,
                frame: [motion.turn_rate, 0.0],
                heading: 0.0,
            }
        };
        let leaders: Vec<_> = self.motions.iter().zip(&self.leaders.wanted).map(leader).collect();
        work(&Input {
            time: sample as f64 * self.leaders.period,
            period: self.leaders.period,
            own_speed: state[3],
            own_acceleration: state[4],
            own_turn_rate: state[5],
            leaders: &leaders,
            noise: Noise::default(),
        })
    }

    /// The state a period later, and the command that led there.
    fn next(&self, state: &[f64], sample: u64) -> Result<(Vec<f64>, Command), Fault> {
        let mut next = state.to_vec();
        let mut shown = vec![0.0; self.law.declaration().shown.len()];
        let memory = &mut next[OWN..];
        let decided = self
            .with_input(state, sample, |input| self.law.decide(input, self.parameters, memory, &mut shown));
        let command = decided.map_err(|fault| self.dated(&fault, sample))?;
        let h = self.leaders.period / f64::from(STEPS);
        let mut body = [state[0], state[1], state[2], state[3]];
        let rate = |[x, y, heading, speed]: [f64; 4]| {
            let (sin, cos) = math::sin_cos(heading);
            let turn = self.leaders.turn_rate;
            [
                speed * cos - self.leaders.speed + turn * y,
                speed * sin - turn * x,
                command.turn_rate - turn,
                command.acceleration,
            ]
        };
        let along = |from: [f64; 4], by: [f64; 4], h: f64| [0, 1, 2, 3].map(|k| from[k] + h * by[k]);
        for _ in 0..STEPS {
            let k1 = rate(body);
            let k2 = rate(along(body, k1, h / 2.0));
            let k3 = rate(along(body, k2, h / 2.0));
            let k4 = rate(along(body, k3, h));
            body = [0, 1, 2, 3].map(|k| body[k] + h / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]));
        }
        next[..BODY].copy_from_slice(&body);
        [next[4], next[5]] = [command.acceleration, command.turn_rate];
        Ok((next, command))
    }

    /// A fault with the time at which it happened.
    fn dated(&self, fault: &Fault, sample: u64) -> Fault {
        let time = sample as f64 * self.leaders.period;
        Fault { place: fault.place, message: format!("{} (t = {time:.2} s)", fault.message) }
    }

    fn error(&self, leader: usize, state: &[f64]) -> [f64; 2] {
        let own = Pose::new(state[0], state[1], wrap(state[2]));
        let relative = Relative::between(self.motions[leader].0, own);
        let [distance, bearing] = self.leaders.wanted[leader];
        [
            distance.map_or(0.0, |wanted| wanted - relative.distance),
            bearing.map_or(0.0, |wanted| wrap(wanted - relative.bearing)),
        ]
    }

    /// Poles about a state, and memory apart.
    fn poles(&self, state: &[f64], sample: u64) -> Result<(Option<Vec<Pole>>, Vec<usize>), Fault> {
        let count = state.len();
        let mut jacobian = DMatrix::zeros(count, count);
        for k in 0..count {
            let size = STEP * state[k].abs().max(1.0);
            let shifted = |by: f64| {
                let mut state = state.to_vec();
                state[k] += by;
                self.next(&state, sample)
            };
            let ((above, _), (below, _)) = (shifted(size)?, shifted(-size)?);
            for row in 0..count {
                jacobian[(row, k)] = (above[row] - below[row]) / (2.0 * size);
            }
        }
        // A counter, say, changes nothing but itself, and most laws do not look at their last command.
        let acts = |k: &usize| (0..count).any(|row| row != *k && jacobian[(row, *k)] != 0.0);
        let kept: Vec<usize> = (0..count).filter(|k| *k < BODY || acts(k)).collect();
        let apart = (OWN..count).filter(|k| !kept.contains(k)).map(|k| k - OWN).collect();
        let map = jacobian.select_rows(&kept).select_columns(&kept);
        let pole = |z: &nalgebra::Complex<f64>| Pole {
            re: math::ln(math::hypot(z.re, z.im)) / self.leaders.period,
            im: math::atan2(z.im, z.re) / self.leaders.period,
        };
        let roots = map.complex_eigenvalues();
        let lasting = roots.iter().filter(|z| math::hypot(z.re, z.im) > GONE);
        let mut poles: Vec<Pole> = lasting.map(pole).collect();
        poles.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
        Ok((Some(poles), apart))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use laws::{LawFile, shipped};

    fn behind(period: f64, turn_rate: f64) -> SteadyLeaders {
        let root = 2.0_f64.sqrt();
        SteadyLeaders {
            places: vec![[0.0, 0.0]],
            wanted: vec![[Some(2.0), Some(-0.75 * std::f64::consts::PI)]],
            speed: 1.0,
            turn_rate,
            period,
            start: [-root - 0.05, -root + 0.02],
        }
    }

    fn closed(name: &str, change: &[(&str, f64)], leaders: &SteadyLeaders) -> LoopEnd {
        let law = LawFile::compile(shipped(name).expect("a law").text).expect("a law");
        let value = |parameter: &laws::Parameter| {
            let given = change.iter().find(|(name, _)| *name == parameter.name);
            given.map_or(parameter.default, |(_, value)| *value)
        };
        let parameters: Vec<f64> = law.declaration().parameters.iter().map(value).collect();
        close(&law, &parameters, leaders).expect("no fault")
    }

    /// Full state feedback leaves d²e/dt² + 2 k de/dt + k² e = 0 in each channel (eq 21): double poles at −k₁ and −k₂.
    #[test]
    fn full_state_feedback_has_the_poles_that_its_gains_say() {
        for turn_rate in [0.0, 0.3] {
            let end = closed("full-state", &[("k1", 2.0), ("k2", 3.0)], &behind(1e-3, turn_rate));
            let poles = end.poles.expect("it settles");
            assert_eq!(poles.len(), 4);
            // Holding the command for a period parts a double pole; sum and product of the two hardly change.
            for (pair, k) in poles.chunks(2).zip([2.0, 3.0]) {
                let (sum, product) =
                    (pair[0].re + pair[1].re, pair[0].re * pair[1].re - pair[0].im * pair[1].im);
                assert!((sum + 2.0 * k).abs() < 0.02 && (product - k * k).abs() < 0.04, "{pair:?} for {k}");
            }
            assert!(end.errors[0].iter().all(|error| error.abs() < 1e-6));
        }
    }

    /// The error obeys p³ + 2 k p² + k² p + k²/T = 0, as the file says, behind a leader that is so slow that its motion, which
    /// the law does not know, does next to nothing.
    #[test]
    fn an_integral_has_the_poles_that_its_text_says() {
        let gains = [("k1", 2.0), ("k2", 4.0), ("T", 2.0)];
        let slow = SteadyLeaders { speed: 0.01, ..behind(2e-4, 0.0) };
        let end = closed("integral", &gains, &slow);
        let poles = end.poles.expect("it settles");
        assert_eq!(poles.len(), 6, "{poles:?}");
        // How far a root is off, by a step of Newton's.
        let off = |p: nalgebra::Complex<f64>, k: f64| {
            let value =
                p * p * p + p * p * (2.0 * k) + p * (k * k) + nalgebra::Complex::new(k * k / 2.0, 0.0);
            let slope = p * p * 3.0 + p * (4.0 * k) + nalgebra::Complex::new(k * k, 0.0);
            (value / slope).norm()
        };
        for pole in &poles {
            let p = nalgebra::Complex::new(pole.re, pole.im);
            let least = off(p, 2.0).min(off(p, 4.0));
            assert!(least < 0.01, "{pole:?}: {least}");
        }
    }

    #[test]
    fn a_law_that_drives_away_does_not_settle_and_a_counter_is_no_pole() {
        let law = LawFile::compile(
            "knows rates\nmemory n = 0\nn = n + 1\ncommand = wanted.distance - leader.distance, 0",
        );
        assert!(law.is_err(), "its units are wrong");
        let law = LawFile::compile("memory n = 0\nn = n + 1\ncommand = 1 [m/s^2], 0").expect("a law");
        let end = close(&law, &[], &behind(0.01, 0.0)).expect("no fault");
        assert_eq!(end.poles, None);
        let template = LawFile::compile(laws::TEMPLATE).expect("a law");
        let end = close(&template, &[2.0, 0.8], &behind(0.01, 0.0)).expect("no fault");
        assert_eq!(end.poles.map(|poles| poles.len()), Some(4));
        let counts =
            LawFile::compile(&format!("memory n = 0\nn = n + 1\n{}", laws::TEMPLATE)).expect("a law");
        let end = close(&counts, &[2.0, 0.8], &behind(0.01, 0.0)).expect("no fault");
        assert_eq!((end.apart, end.poles.map(|poles| poles.len())), (vec![0, 1], Some(4)));
    }

    /// A gain that grows for five seconds is the grown one where the loop is linearised; what breaks off later is told.
    #[test]
    fn a_law_that_reads_the_clock_is_followed_for_a_minute() {
        let law = |gain: &str| {
            LawFile::compile(
                &laws::TEMPLATE
                    .replace("let e =", &format!("let grown = {gain}\nlet e ="))
                    .replace("k^2", "grown^2"),
            )
            .expect("a law")
        };
        let late = close(&law("k + 3 [1/s] * min(time / 5 [s], 1)"), &[2.0, 0.8], &behind(0.01, 0.0))
            .expect("no fault");
        let grown = close(&law("k + 3 [1/s]"), &[2.0, 0.8], &behind(0.01, 0.0)).expect("no fault");
        assert!(late.time > 59.0 && grown.time < 59.0, "{} {}", late.time, grown.time);
        let (late, grown) = (late.poles.expect("it settles"), grown.poles.expect("it settles"));
        for (late, grown) in late.iter().zip(&grown) {
            assert!(
                (late.re - grown.re).abs() < 1e-3 && (late.im - grown.im).abs() < 1e-3,
                "{late:?} {grown:?}"
            );
        }
        let fault =
            close(&law("k * sqrt(1 - time / 5 [s])"), &[2.0, 0.8], &behind(0.01, 0.0)).expect_err("a fault");
        assert!(fault.message.ends_with("(t = 5.01 s)"), "{fault}");
    }
}
