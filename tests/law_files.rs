//! The law files that ship, held against the laws of `formation` and driven in closed loop.

use formation::relative::Geometry;
use formation::{Heading, Law, LawInput, PathFilter, Switching};
use laws::{CustomLaw, Input, LawFile, LeaderInput, Noise};
use vocabulary::{Command, LawKind, Limits, MotionInput, Pose, Relative, SetPoint, math, wrap};

fn compiled(name: &str) -> LawFile {
    let text = laws::shipped(name).expect("a law").text;
    LawFile::compile(text).unwrap_or_else(|mistakes| panic!("{name}: {mistakes:?}"))
}

/// Evenly distributed numbers, by the generator SplitMix64.
struct Draw(u64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The parameters of a law file in its order, by name.
fn parameters(law: &LawFile, value: impl Fn(&str) -> Option<f64>) -> Vec<f64> {
    let all = law.declaration().parameters.iter();
    all.map(|parameter| value(&parameter.name).unwrap_or(parameter.default)).collect()
}

/// Over random positions, motions, set points and gains the three laws of the paper are those written in Rust, whatever the
/// bearing is held against.
#[test]
fn the_laws_of_the_paper_are_those_of_formation() {
    let mut draw = Draw(1);
    for (name, kind) in [
        ("full-state", LawKind::FullState),
        ("robust-state", LawKind::RobustState),
        ("output-feedback", LawKind::OutputFeedback),
    ] {
        let file = compiled(name);
        let mut worst = 0.0_f64;
        for round in 0..4000 {
            let heading = match round % 2 {
                0 => Heading::Leader,
                _ => Heading::Path(PathFilter { length: 1.0, lag: 0.0 }),
            };
            let mut pose =
                || Pose::new(draw.between(-4.0, 4.0), draw.between(-4.0, 4.0), draw.between(-3.2, 3.2));
            let [leader_pose, own_pose] = [pose(), pose()];
            let relative = Relative::between(leader_pose, own_pose);
            if relative.distance < 0.1 {
                continue;
            }
            let mut pair = |size: f64| [draw.between(-size, size), draw.between(-size, size)];
            let [gain, robust_gain, slope] =
                [pair(5.0), pair(5.0), pair(24.0)].map(|pair| pair.map(f64::abs));
            let set_point = SetPoint { value: pair(3.0), rate: pair(1.0), acceleration: pair(1.0) };
            let [told_rates, [speed, turn_rate], [acceleration, turn_acceleration]] =
                [pair(2.0), pair(1.5), pair(2.0)];
            let motion = MotionInput { speed, acceleration, turn_rate, turn_acceleration };
            let own_speed = draw.between(0.01, 1.6);
            let law = Law {
                kind,
                gain,
                robust_gain,
                switching: Switching::Tanh(slope),
                distance_min: 0.1,
                heading,
            };
            let geometry = Geometry::new(&relative, law.distance_min);
            let rates = match kind {
                LawKind::OutputFeedback => told_rates,
                _ => law.rates(&geometry, own_speed, &motion).into(),
            };
            let seen = heading.output(&relative, own_pose.heading);
            let error = [set_point.value[0] - seen.distance, wrap(set_point.value[1] - seen.bearing)];
            let asked = law.command(&LawInput {
                geometry: &geometry,
                error,
                set_point: &set_point,
                rates,
                own_speed,
                leader: &motion,
            });
            let (frame, leader_heading) = match heading {
                Heading::Leader => ([turn_rate, turn_acceleration], 0.0),
                Heading::Path(_) => ([0.0; 2], leader_pose.heading),
            };
            let leader = LeaderInput {
                relative: seen,
                rates,
                wanted: set_point,
                motion,
                frame,
                heading: leader_heading,
            };
            let input = Input {
                time: 0.0,
                period: 0.01,
                own_speed,
                own_acceleration: 0.0,
                own_turn_rate: 0.0,
                leaders: &[leader],
                noise: Noise::default(),
            };
            let parameters = parameters(&file, |name| {
                let channel = usize::from(name.ends_with('2'));
                match name.trim_end_matches(['1', '2']) {
                    "k" => Some(gain[channel]),
                    "beta" => Some(robust_gain[channel]),
                    "kappa" => Some(slope[channel]),
                    _ => None,
                }
            });
            let shown = &mut vec![0.0; file.declaration().shown.len()];
            let ours = file.decide(&input, &parameters, &mut [], shown).expect("a command");
            // A command is a sum of terms that may cancel: their size is what rounding goes by.
            let at = |name: &str| {
                let index = file.declaration().shown.iter().position(|shown| shown.name == name);
                shown[index.expect("a quantity")]
            };
            let size = at("b.x").abs() + (at("l") * at("b.y")).abs();
            let apart = (ours.acceleration - asked.acceleration).abs() / size
                + (ours.turn_rate - asked.turn_rate).abs() * own_speed / size;
            worst = worst.max(apart);
        }
        assert!(worst < 1e-12, "{name}: {worst:e}");
    }
}

/// A unicycle.
#[derive(Clone, Copy)]
struct Robot {
    pose: Pose,
    motion: MotionInput,
}

impl Robot {
    fn new(x: f64, y: f64, heading: f64, speed: f64) -> Self {
        Self { pose: Pose::new(x, y, heading), motion: MotionInput { speed, ..MotionInput::default() } }
    }

    /// Drives on for `h` s with its acceleration and turn rate, by the midpoint rule.
    fn drive(&mut self, h: f64) {
        let MotionInput { speed, acceleration, turn_rate, .. } = self.motion;
        let steps = 10;
        let dt = h / f64::from(steps);
        for step in 0..steps {
            let middle = (f64::from(step) + 0.5) * dt;
            let way = (speed + acceleration * middle) * dt;
            let heading = self.pose.heading + turn_rate * dt / 2.0;
            let (sin, cos) = math::sin_cos(heading);
            self.pose =
                Pose::new(self.pose.x + way * cos, self.pose.y + way * sin, heading + turn_rate * dt / 2.0);
        }
        self.motion.speed = Limits::PAPER.clamp_speed(speed + acceleration * h);
    }
}

/// What a follower is told of a leader by its true motion.
fn told(leader: &Robot, own: &Robot, wanted: [f64; 2]) -> LeaderInput {
    let relative = Relative::between(leader.pose, own.pose);
    let geometry = Geometry::new(&relative, 0.1);
    let rates = geometry.rates(own.motion.speed, leader.motion.speed, leader.motion.turn_rate).into();
    LeaderInput {
        relative,
        rates,
        wanted: SetPoint { value: wanted, ..SetPoint::default() },
        motion: leader.motion,
        frame: [leader.motion.turn_rate, leader.motion.turn_acceleration],
        heading: 0.0,
    }
}

/// The errors [distance, bearing] to each leader after `duration` s behind leaders that drive in circles.
fn driven(
    name: &str,
    leaders: &mut [Robot],
    own: &mut Robot,
    wanted: &[[f64; 2]],
    duration: f64,
) -> Vec<[f64; 2]> {
    let file = compiled(name);
    let parameters = parameters(&file, |_| None);
    let mut memory = vec![0.0; file.declaration().memory.len()];
    let mut shown = vec![0.0; file.declaration().shown.len()];
    let period = 0.01;
    let mut errors = vec![];
    for sample in 0..=(duration / period) as u64 {
        let tell: Vec<LeaderInput> =
            leaders.iter().zip(wanted).map(|(leader, wanted)| told(leader, own, *wanted)).collect();
        errors = tell
            .iter()
            .zip(wanted)
            .map(|(leader, wanted)| {
                [wanted[0] - leader.relative.distance, wrap(wanted[1] - leader.relative.bearing)]
            })
            .collect();
        let input = Input {
            time: sample as f64 * period,
            period,
            own_speed: own.motion.speed,
            own_acceleration: own.motion.acceleration,
            own_turn_rate: own.motion.turn_rate,
            leaders: &tell,
            noise: Noise { seed: 1, robot: 1, sample },
        };
        if sample == 0 {
            file.start(&input, &parameters, &mut memory).expect("a start");
        }
        let asked = file.decide(&input, &parameters, &mut memory, &mut shown).expect("a command");
        let Command { acceleration, turn_rate } = Limits::PAPER.saturate(asked, own.motion.speed);
        own.motion.acceleration = Limits::PAPER.admissible(acceleration, own.motion.speed);
        own.motion.turn_rate = turn_rate;
        for leader in leaders.iter_mut() {
            leader.drive(period);
        }
        own.drive(period);
    }
    errors
}

/// On either side of a leader that drives in a circle, every law for one leader takes up its place. What is left of the error is
/// what its kind of law leaves: nothing where it knows the leader's motion or adds up the error, millimetres where tanh stands for
/// sign, more with a slower observer.
#[test]
fn every_law_takes_up_its_place() {
    for (name, most) in [
        ("full-state", [1e-8, 1e-8]),
        ("robust-state", [5e-3, 8e-4]),
        ("output-feedback", [5e-3, 8e-4]),
        ("output-feedback-observer", [1.2e-2, 2.5e-3]),
        ("integral", [1e-5, 1e-5]),
        ("sliding-mode", [1e-3, 1e-4]),
        ("predictive", [1e-3, 1e-3]),
    ] {
        for bearing in [-2.356, 2.356] {
            let mut leader = Robot::new(0.0, 0.0, 0.3, 1.0);
            leader.motion.turn_rate = 0.3;
            let mut own = Robot::new(-2.0, -1.0, 0.0, 0.01);
            let errors = driven(name, &mut [leader], &mut own, &[[2.0, bearing]], 20.0);
            let is_small = errors[0].iter().zip(most).all(|(error, most)| error.abs() < most);
            assert!(is_small, "{name} at {bearing}: {errors:?}");
        }
    }
}

/// Two leaders drive straight on side by side, or turn about one centre; the distances to both are held.
#[test]
fn two_distances_are_held_at_once() {
    for (turn_rate, speeds, most) in [(0.0, [1.0, 1.0], 1e-6), (0.2, [1.0, 0.6], 1e-3)] {
        let mut leaders = [Robot::new(0.0, 0.0, 0.0, speeds[0]), Robot::new(0.0, 2.0, 0.0, speeds[1])];
        for leader in &mut leaders {
            leader.motion.turn_rate = turn_rate;
        }
        let mut own = Robot::new(-2.5, 0.5, 0.2, 0.5);
        let errors = driven("two-distances", &mut leaders, &mut own, &[[2.0, 0.0], [2.0, 0.0]], 15.0);
        assert!(errors.iter().all(|error| error[0].abs() < most), "{turn_rate}: {errors:?}");
    }
}
