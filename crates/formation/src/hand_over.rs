//! Hand-over: a follower that has changed its leader goes from where it is to its place, and its command does not jump.
//!
//! The set point begins where the follower is relative to its new leader, at rest unless the two drive at very different
//! speeds, and moves to its place at a bounded speed and acceleration. What the law would have asked for in place of the last command is added to it at first, and
//! fades. `docs/events.md` has figures.

use crate::column::cartesian;
use crate::offset::{Offset, OffsetBounds};
use vocabulary::{Command, SetPoint, math};

/// How a follower changes its leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandOverParameters {
    /// Its place moves no faster than this, m/s.
    pub speed: f64,
    /// And speeds up and brakes by no more than this, m/s².
    pub acceleration: f64,
    /// Time constant with which the difference to its last command fades, s.
    pub fade: f64,
}

/// A follower on its way from where it changed its leader to its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandOver {
    parameters: HandOverParameters,
    /// From its place to where its set point is; `None` before it has seen its new leader.
    offset: Option<Offset>,
    last: Command,
    /// What is added to the law's command; `None` before the first.
    surplus: Option<Command>,
}

/// Time constant with which the acceleration of a place sets in, s: a jump of it would be one of the command.
const ONSET: f64 = 0.15;
/// Nearer to its place than this, m, and slower, m/s, a hand-over is over.
const OVER: f64 = 1e-4;

impl HandOver {
    /// A hand-over that begins with the next sample; `last` is what the follower was told last.
    pub fn new(parameters: HandOverParameters, last: Command) -> Self {
        Self { parameters, offset: None, last, surplus: None }
    }

    /// What the follower was told last.
    pub(crate) fn last(&self) -> Command {
        self.last
    }

    /// Begins anew when the leader comes into sight again.
    pub(crate) fn forget(&mut self) {
        self.offset = None;
    }

    /// Carries it on over a period. `at` is where the follower is, `goal` its place, both [distance, bearing] in m and rad
    /// against the same heading, `moving` the rates of `at`; the place stays where it is where the follower `waits`. False
    /// when it is over.
    pub(crate) fn advance(
        &mut self,
        at: [f64; 2],
        moving: [f64; 2],
        goal: [f64; 2],
        waits: bool,
        period: f64,
    ) -> bool {
        let HandOverParameters { speed, acceleration, fade } = self.parameters;
        let offset = self.offset.get_or_insert_with(|| {
            let [[x, y], [goal_x, goal_y]] = [at, goal].map(cartesian);
            let (sin, cos) = math::sin_cos(at[1]);
            let [along, across] = [moving[0], at[0] * moving[1]];
            let rate = [along * cos - across * sin, along * sin + across * cos];
            let fast = !waits && math::hypot(rate[0], rate[1]) > speed;
            let rate = if fast { rate } else { [0.0; 2] };
            Offset { rate, ..Offset::at([x - goal_x, y - goal_y]) }
        });
        offset.carry(
            (!waits).then_some([0.0; 2]),
            OffsetBounds { rate: speed, acceleration, onset: ONSET },
            period,
        );
        if let Some(surplus) = &mut self.surplus {
            let keeps = math::exp(-period / fade);
            surplus.acceleration *= keeps;
            surplus.turn_rate *= keeps;
        }
        let small = |v: [f64; 2]| math::hypot(v[0], v[1]) < OVER;
        // Before its first command there is nothing to fade.
        let faded = self.surplus.is_some_and(|s| small([s.acceleration, s.turn_rate]));
        !(small(offset.value) && small(offset.rate) && faded)
    }

    /// Where it is on its way, from its place.
    pub(crate) fn offset(&self) -> Offset {
        self.offset.unwrap_or_default()
    }

    /// s^d on the way.
    pub(crate) fn set_point(&self, base: &SetPoint, distance_min: f64) -> SetPoint {
        self.offset().displaces(base, distance_min)
    }

    /// The command in place of the `asked` one: at first the last command, in the end what is asked for.
    pub(crate) fn command(&mut self, asked: Command) -> Command {
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let last = self.last;
        let surplus = self.surplus.get_or_insert_with(|| Command {
            acceleration: finite(last.acceleration - asked.acceleration),
            turn_rate: finite(last.turn_rate - asked.turn_rate),
        });
        Command {
            acceleration: asked.acceleration + surplus.acceleration,
            turn_rate: asked.turn_rate + surplus.turn_rate,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: HandOverParameters = HandOverParameters { speed: 0.4, acceleration: 0.5, fade: 0.5 };

    #[test]
    fn the_set_point_begins_where_the_follower_is_and_ends_at_its_place() {
        let goal = SetPoint { value: [2.0, 2.3], ..SetPoint::default() };
        let mut hand_over = HandOver::new(PARAMETERS, Command::default());
        assert!(hand_over.advance([4.0, 2.9], [0.1, 0.0], goal.value, false, 0.01));
        let began = hand_over.set_point(&goal, 0.1).value;
        // It is on its way already, so that the first command is that of a place that speeds up.
        assert!((began[0] - 4.0).abs() < 1e-4 && (began[1] - 2.9).abs() < 1e-4, "{began:?}");
        let mut samples = 0;
        while hand_over.advance([9.0, 0.0], [0.0; 2], goal.value, false, 0.01) {
            samples += 1;
            hand_over.command(Command::default());
            assert!(samples < 3000, "{hand_over:?}");
        }
        let ended = hand_over.set_point(&goal, 0.1).value;
        assert!((ended[0] - 2.0).abs() < 1e-3 && (ended[1] - 2.3).abs() < 1e-3, "{ended:?}");
    }

    /// A robot that stood joins a leader that drives at 0.8 m/s: its place does not run away from it.
    #[test]
    fn between_very_different_speeds_it_starts_with_the_difference() {
        let mut hand_over = HandOver::new(PARAMETERS, Command::default());
        hand_over.advance([2.0, std::f64::consts::PI], [0.8, 0.0], [2.0, 2.3], false, 0.01);
        let Offset { rate, .. } = hand_over.offset();
        assert!((rate[0] + 0.8).abs() < 0.0051 && rate[1].abs() < 0.0051, "{rate:?}");
        let mut last = 0.8_f64;
        for _ in 0..100 {
            hand_over.advance([2.0, 3.0], [0.0; 2], [2.0, 2.3], false, 0.01);
            let Offset { rate, acceleration, .. } = hand_over.offset();
            let speed = math::hypot(rate[0], rate[1]);
            assert!(
                speed <= last.max(0.4) + 1e-12 && math::hypot(acceleration[0], acceleration[1]) < 0.5 + 1e-9
            );
            last = speed;
        }
        assert!(last < 0.45, "{last}");
    }

    #[test]
    fn while_it_waits_its_place_stays() {
        let goal = [2.0, 2.3];
        let mut hand_over = HandOver::new(PARAMETERS, Command::default());
        hand_over.advance([4.0, 2.9], [-0.8, 0.1], goal, true, 0.01);
        let began = hand_over.offset();
        for _ in 0..100 {
            assert!(hand_over.advance([4.0, 2.9], [-0.8, 0.1], goal, true, 0.01));
        }
        assert_eq!(hand_over.offset().value, began.value);
    }

    #[test]
    fn the_command_goes_on_from_the_last_one() {
        let last = Command { acceleration: 0.3, turn_rate: -0.2 };
        let mut hand_over = HandOver::new(PARAMETERS, last);
        let asked = Command { acceleration: -4.0, turn_rate: 11.0 };
        hand_over.advance([2.0, 2.3], [0.0; 2], [2.0, 2.3], false, 0.01);
        let first = hand_over.command(asked);
        assert!((first.acceleration - 0.3).abs() < 1e-12 && (first.turn_rate + 0.2).abs() < 1e-12);
        for _ in 0..50 {
            hand_over.advance([2.0, 2.3], [0.0; 2], [2.0, 2.3], false, 0.01);
        }
        let later = hand_over.command(asked);
        assert!(((later.turn_rate - 11.0) / (first.turn_rate - 11.0) - math::exp(-1.0)).abs() < 1e-9);
        let nothing = HandOver::new(PARAMETERS, last).command(Command { acceleration: f64::NAN, ..last });
        assert!(nothing.acceleration.is_nan() && nothing.turn_rate == last.turn_rate);
    }
}
