//! Standing still: what a follower does while its leader brakes to a stand, stands and starts again.
//!
//! The laws are singular at rest. Near it they give way to a tracker of the set point in the follower's own frame, and at
//! rest the follower holds: it brakes, and its heading stays. When its leader starts, the set point begins where the
//! follower stands, and goes back to its place once all drive. `docs/moving.md` has the equations.

use crate::column::cartesian;
use crate::offset::{Offset, OffsetBounds};
use std::f64::consts::FRAC_PI_2;
use vocabulary::{Command, MotionPhase, SetPoint, math, wrap};

/// Whether a follower stands, and how far its set point is from its place for that.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Standing {
    holds: bool,
    /// Time since the leader has stood, s.
    waited: f64,
    /// What is added to the set point.
    offset: Offset,
    /// Curvature of the follower's own way when it last drove, 1/m.
    curvature: f64,
}

/// What the rule looks at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StandingInput<'a> {
    /// s^d against the frame's heading, offset included.
    pub set_point: &'a SetPoint,
    /// The frame's heading less the follower's, rad, and its rate, rad/s.
    pub frame: [f64; 2],
    /// Where the follower is in its leader's frame: distance in m, bearing against the frame's heading in rad.
    pub place: [f64; 2],
    /// Its speed, m/s.
    pub own_speed: f64,
    /// What the leader is believed to do, m/s and m/s².
    pub leader: [f64; 2],
    /// How fast its steered wheels turn it at its speed, rad/s; infinite for who turns on the spot.
    pub turns_at_most: f64,
}

/// Below the first speed the tracker acts alone, above the second the law, damped and within the rule's bounds, m/s.
const BLEND: [f64; 2] = [0.1, 0.3];
/// Above the second speed the law is left alone, m/s.
const WHOLE: [f64; 2] = [0.3, 0.5];
/// From the first speed of the leader on to the second, the follower's own speed ceases to matter for that, m/s.
const FREES: [f64; 2] = [0.3, 0.6];
/// A leader slower than this stands, m/s.
const STANDS: f64 = 0.05;
/// One that is faster starts, m/s.
const STARTS: f64 = 0.1;
/// How long a leader has to stand, s; and how long at most the follower still closes up, s.
const WAITS: [f64; 2] = [0.1, 1.5];
/// A follower this near behind its place, m, holds.
const NEAR: f64 = 0.02;
/// Above this speed of the leader the offset is given back, m/s.
const GIVES_BACK: f64 = 0.4;
/// No faster than this.
const OFFSET_BOUNDS: OffsetBounds = OffsetBounds { rate: 0.2, acceleration: 0.3, onset: 0.0 };
/// Gain on speeds, 1/s.
const SPEED_GAIN: f64 = 6.0;
/// Gain on the place ahead, 1/s, and how much of it counts, m.
const AHEAD: [f64; 2] = [1.5, 0.6];
/// Gain on the place aside, 1/m², and how much of it counts, m.
const ASIDE: [f64; 2] = [1.0, 0.5];
/// Largest acceleration of the rule, m/s².
const ACCELERATION_MAX: f64 = 4.0;
/// Largest turn rate at rest, rad/s, and how it grows with speed, 1/m: of the tracker and of the law.
const TURN_MOST: [[f64; 2]; 2] = [[0.2, 3.0], [0.3, 6.0]];
/// Who turns round on steered wheels does so this fast if it can, rad/s.
const TURNS_ROUND: f64 = 2.0;
/// The law's turn rate is damped below about this speed, m/s.
const DAMPING_SPEED: f64 = 0.1;

impl Standing {
    /// What stays of it when its follower changes its leader: whether it holds.
    #[must_use]
    pub(crate) fn kept(&self) -> Self {
        Self { offset: Offset::default(), ..*self }
    }

    /// Whether the follower holds beside a leader that stands.
    pub(crate) fn holds(&self) -> bool {
        self.holds
    }

    /// How far its place is from its set point, m.
    pub(crate) fn offset(&self) -> &Offset {
        &self.offset
    }

    /// s^d with the offset, against the frame's heading.
    pub(crate) fn set_point(&self, base: &SetPoint, distance_min: f64) -> SetPoint {
        self.offset.displaces(base, distance_min)
    }

    /// Carries the offset on over a period: to zero while the formation drives.
    pub(crate) fn carry(&mut self, leader_speed: f64, period: f64) {
        let back = (!self.holds && leader_speed > GIVES_BACK).then_some([0.0; 2]);
        self.offset.carry(back, OFFSET_BOUNDS, period);
    }

    /// Begins and ends holding; `base` is the set point without offset, `input` holds it with.
    pub(crate) fn switch(&mut self, base: &SetPoint, input: &StandingInput<'_>, turn_rate: f64, period: f64) {
        let [leader_speed, _] = input.leader;
        if self.holds {
            if leader_speed > STARTS {
                let [[x, y], [goal_x, goal_y]] = [input.place, base.value].map(cartesian);
                (self.holds, self.waited) = (false, 0.0);
                self.offset = Offset::at([x - goal_x, y - goal_y]);
            }
            return;
        }
        if input.own_speed > BLEND[0] {
            self.curvature = (turn_rate / input.own_speed).clamp(-2.0, 2.0);
        }
        if leader_speed >= STANDS {
            self.waited = 0.0;
            return;
        }
        self.waited += period;
        let [ahead, _] = input.missing();
        self.holds = self.waited > WAITS[0] && (ahead < NEAR || self.waited > WAITS[1]);
    }

    /// The command in place of the `law`'s, and what acts.
    pub(crate) fn command(&self, law: Command, input: &StandingInput<'_>) -> (Command, MotionPhase) {
        let v = input.own_speed;
        if self.holds {
            let turn_rate = self.curvature * v;
            return (Command { acceleration: -SPEED_GAIN * v, turn_rate }, MotionPhase::Hold);
        }
        let [leader_speed, leader_acceleration] = input.leader;
        let [ahead, aside] = input.missing();
        // How the place moves in the frame, and how far the follower heads beside that.
        let [rate_x, rate_y] = velocity(input.set_point);
        let (forward, left) = (leader_speed + rate_x, rate_y);
        let speed = math::hypot(forward, left);
        let direction = if speed > STANDS { math::atan2(left, forward) } else { 0.0 };
        let off = wrap(input.frame[0] + direction);
        // Behind a leader that drives on, a slow follower is the law's: it has more reach than the tracker.
        let free = smooth((leader_speed - FREES[0]) / (FREES[1] - FREES[0]));
        let free_speed = WHOLE[1] * free;
        // Steered wheels turn only while they roll: who heads away from its place would brake, and stand there.
        let keeps_on = SPEED_GAIN * (free_speed - v);
        let turns = law.turn_rate.abs() > input.turns_at_most
            || (off.abs() > FRAC_PI_2 && input.turns_at_most.is_finite());
        let drives_on = turns && law.acceleration < keeps_on;
        let law = if drives_on {
            Command { acceleration: keeps_on, turn_rate: round(law.turn_rate, off) }
        } else {
            law
        };
        let wanted = speed * math::cos(off) + AHEAD[0] * ahead.clamp(-AHEAD[1], AHEAD[1]);
        let turn = input.frame[1]
            + speed * (ASIDE[0] * aside.clamp(-ASIDE[1], ASIDE[1]) + 2.0 * ASIDE[0].sqrt() * math::sin(off));
        let feed_forward =
            leader_acceleration.clamp(-ACCELERATION_MAX, ACCELERATION_MAX) * math::cos(off).max(0.0);
        let track = bounded_command(
            Command { acceleration: SPEED_GAIN * (wanted.max(0.0) - v) + feed_forward, turn_rate: turn },
            v,
            TURN_MOST[0],
        );
        let damping = v * v / (v * v + DAMPING_SPEED * DAMPING_SPEED);
        let tamed = bounded_command(Command { turn_rate: law.turn_rate * damping, ..law }, v, TURN_MOST[1]);
        let slower = leader_speed.min(v + free_speed);
        let heads = smooth((TURNED_MOST - off.abs()) / TURNED_WIDTH).max(free);
        let [share, whole] = [BLEND, WHOLE].map(|[from, to]| smooth((slower - from) / (to - from)) * heads);
        if whole >= 1.0 {
            return (law, if drives_on { MotionPhase::Track } else { MotionPhase::Law });
        }
        (mix(track, mix(tamed, law, whole), share), MotionPhase::Track)
    }
}

/// A turn rate with which a follower that heads away by more than a right angle turns round: one that heads straight away is asked
/// for none.
fn round(turn_rate: f64, off: f64) -> f64 {
    if off.abs() < FRAC_PI_2 { turn_rate } else { turn_rate.abs().max(TURNS_ROUND).copysign(turn_rate) }
}

/// From `a` at share 0 to `b` at share 1.
fn mix(a: Command, b: Command, share: f64) -> Command {
    let mix = |a: f64, b: f64| if share > 0.0 { a + share * (b - a) } else { a };
    Command { acceleration: mix(a.acceleration, b.acceleration), turn_rate: mix(a.turn_rate, b.turn_rate) }
}

/// Turned away by more than this the tracker acts alone, rad, and the blend's width.
const TURNED_MOST: f64 = 2.5;
const TURNED_WIDTH: f64 = 0.6;

impl StandingInput<'_> {
    /// What the follower lacks to its place, [forward, left] in its own frame, m.
    fn missing(&self) -> [f64; 2] {
        let [[x, y], [goal_x, goal_y]] =
            [self.place, [self.set_point.value[0], self.set_point.value[1]]].map(cartesian);
        let (sin, cos) = math::sin_cos(self.frame[0]);
        let (dx, dy) = (goal_x - x, goal_y - y);
        [cos * dx - sin * dy, sin * dx + cos * dy]
    }
}

fn bounded_command(command: Command, speed: f64, [at_rest, growth]: [f64; 2]) -> Command {
    // Whoever rolls back on a slope has a speed below zero.
    let most = at_rest + growth * speed.abs();
    let number = |x: f64| if x.is_nan() { 0.0 } else { x };
    Command {
        acceleration: number(command.acceleration).clamp(-ACCELERATION_MAX, ACCELERATION_MAX),
        turn_rate: number(command.turn_rate).clamp(-most, most),
    }
}

/// d[x, y]/dt of a set point in its frame.
fn velocity(set_point: &SetPoint) -> [f64; 2] {
    let (sin, cos) = math::sin_cos(set_point.value[1]);
    let [along, across] = [set_point.rate[0], set_point.value[0] * set_point.rate[1]];
    [along * cos - across * sin, along * sin + across * cos]
}

/// 3x² − 2x³ from 0 to 1.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(
        set_point: &SetPoint,
        [v, leader, acceleration]: [f64; 3],
        place: [f64; 2],
    ) -> StandingInput<'_> {
        StandingInput {
            set_point,
            frame: [0.0; 2],
            place,
            own_speed: v,
            leader: [leader, acceleration],
            turns_at_most: f64::INFINITY,
        }
    }

    /// Commands of an independent implementation in Python.
    #[test]
    fn commands_are_those_of_an_independent_implementation() {
        let set_point =
            |value: f64, rate: [f64; 2]| SetPoint { value: [2.0, value], rate, acceleration: [0.0; 2] };
        for (motion, frame, place, goal, law, wanted) in [
            (
                [0.05, 0.3, -0.314],
                [0.044, -0.026],
                [1.962, 2.388],
                set_point(2.26, [-0.097, 0.034]),
                [-0.385, -0.266],
                [2.635_908_529_276_430_4, -0.166_003_058_179_135_24],
            ),
            (
                [0.12, 0.2, 0.595],
                [-0.03, 0.067],
                [1.886, 2.392],
                set_point(2.273, [0.027, 0.037]),
                [0.037, 0.241],
                [1.431_699_773_435_658, 0.038_900_305_464_237_055],
            ),
            (
                [0.25, 0.29, 0.257],
                [0.421, -0.021],
                [2.081, 2.333],
                set_point(2.39, [0.076, -0.04]),
                [-0.582, -0.283],
                [-0.442_833_503_710_941_77, -0.147_375_401_550_873_8],
            ),
            (
                [0.0, 0.08, 0.218],
                [0.429, 0.071],
                [2.195, 2.401],
                set_point(2.274, [0.072, 0.046]),
                [0.648, 0.069],
                [2.907_654_140_029_571_5, 0.108_326_787_033_142_37],
            ),
        ] {
            let input = StandingInput { frame, ..input(&goal, motion, place) };
            let law = Command { acceleration: law[0], turn_rate: law[1] };
            let (found, phase) = Standing::default().command(law, &input);
            assert_eq!(phase, MotionPhase::Track);
            assert!((found.acceleration - wanted[0]).abs() < 1e-12, "{found:?}, not {wanted:?}");
            assert!((found.turn_rate - wanted[1]).abs() < 1e-12, "{found:?}, not {wanted:?}");
        }
    }

    #[test]
    fn at_speed_the_law_is_left_alone() {
        let goal = SetPoint { value: [2.0, 2.3], ..SetPoint::default() };
        let law = Command { acceleration: -9.0, turn_rate: 11.0 };
        let found = Standing::default().command(law, &input(&goal, [0.6, 0.6, 0.0], [1.5, 2.0]));
        assert_eq!(found, (law, MotionPhase::Law));
    }

    /// Its place is behind it, and it can only get there by turning round, which its wheels do while they roll.
    #[test]
    fn steered_wheels_drive_on_behind_a_leader_that_does() {
        let goal = SetPoint { value: [2.0, 2.3], ..SetPoint::default() };
        let law = Command { acceleration: -5.0, turn_rate: -824.0 };
        let on = |v: f64, leader: f64| StandingInput {
            turns_at_most: 1.8 * v,
            ..input(&goal, [v, leader, 0.0], [3.0, 2.0])
        };
        let standing = Standing::default();
        assert_eq!(
            standing.command(law, &on(0.0, 0.8)),
            (Command { acceleration: 3.0, ..law }, MotionPhase::Track)
        );
        // From above it brakes to that speed, and where its wheels turn it as asked the law is left alone.
        assert_eq!(standing.command(law, &on(0.8, 0.8)).0.acceleration, 6.0 * (0.5 - 0.8));
        let gentle = Command { acceleration: -2.5, turn_rate: 0.2 };
        assert_eq!(standing.command(gentle, &on(0.8, 0.8)), (gentle, MotionPhase::Law));
        // Behind a leader that stops it stops.
        assert!(standing.command(law, &on(0.3, 0.1)).0.acceleration < 0.0);
        // Unicycles turn on the spot.
        let unicycle = input(&goal, [0.0, 0.8, 0.0], [3.0, 2.0]);
        assert_eq!(standing.command(law, &unicycle), (law, MotionPhase::Law));
    }

    /// What the law asks for at rest may be anything.
    #[test]
    fn a_command_is_finite_whatever_the_law_asks_for() {
        let goal = SetPoint { value: [2.0, 2.3], ..SetPoint::default() };
        for value in [f64::NAN, f64::INFINITY, -1e300] {
            let law = Command { acceleration: value, turn_rate: value };
            for v in [0.0, 0.2, 0.4] {
                let (found, _) = Standing::default().command(law, &input(&goal, [v, v, 0.0], [1.5, 2.0]));
                assert!(
                    v > WHOLE[0] || found.acceleration.abs() <= ACCELERATION_MAX + SPEED_GAIN,
                    "{found:?}"
                );
                assert!(v > WHOLE[0] || found.turn_rate.is_finite(), "{found:?}");
            }
        }
    }

    /// It holds beside its leader, and when that starts its set point is where it stands, and goes back to its place.
    #[test]
    fn it_holds_and_starts_from_where_it_stands() {
        let (period, goal) = (0.01, SetPoint { value: [2.0, 2.3], ..SetPoint::default() });
        let mut standing = Standing::default();
        let place = [1.9, 2.2];
        let step = |standing: &mut Standing, v: f64, leader: f64| {
            standing.carry(leader, period);
            let now = standing.set_point(&goal, 0.1);
            standing.switch(&goal, &input(&now, [v, leader, 0.0], place), 0.1, period);
            standing.set_point(&goal, 0.1)
        };
        for _ in 0..200 {
            step(&mut standing, 0.0, 0.0);
        }
        let (held, phase) = standing
            .command(Command { acceleration: 3.0, turn_rate: 5.0 }, &input(&goal, [0.0, 0.0, 0.0], place));
        assert_eq!((held.acceleration.abs(), held.turn_rate, phase), (0.0, 0.0, MotionPhase::Hold));
        let began = step(&mut standing, 0.0, 0.2);
        assert!((began.value[0] - place[0]).abs() < 1e-12 && (began.value[1] - place[1]).abs() < 1e-12);
        let mut last = began;
        for _ in 0..1000 {
            let now = step(&mut standing, 0.8, 0.8);
            let [a, b] = [last, now].map(|s| cartesian([s.value[0], s.value[1]]));
            let moved = math::hypot(b[0] - a[0], b[1] - a[1]) / period;
            assert!(moved <= OFFSET_BOUNDS.rate + 1e-9, "{moved} m/s");
            last = now;
        }
        assert!((last.value[0] - 2.0).abs() < 1e-3 && (last.value[1] - 2.3).abs() < 1e-3, "{last:?}");
    }
}
