//! Narrowing: a follower leaves its place for one in the column where the way that its place takes is not free.
//!
//! Between its place c_V and the one in the column it takes c(λ) = (1 − λ) c_V + λ c_column with the smallest λ whose strip
//! is free: the way of that place as its leader drives on, along the curve that the leader is on. It sees what its own
//! sensor tells; nobody decides for others. `docs/narrowing.md` has the equations.

use crate::column::{Filing, cartesian};
use crate::offset::{Offset, OffsetBounds};
use vocabulary::{SetPoint, math};

/// How a follower narrows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrowing {
    /// How it files in.
    pub filing: Filing,
    /// Its place in the column, [forward, left] of its leader, m: the formation gives it.
    pub column: [f64; 2],
    /// Half the width of the strip, m.
    pub half_width: f64,
    /// Fastest that its place moves, m/s.
    pub rate: f64,
    /// Strongest that it does, m/s².
    pub acceleration: f64,
    /// How long a wider strip has to be free, s.
    pub patience: f64,
    /// By how much the strip is longer than the way to drive while the place moves: behind and ahead, m.
    pub reserve: [f64; 2],
}

/// What one follower remembers of its narrowing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NarrowingState {
    /// Number of the place that is taken, see [`Narrowing::place`].
    level: u8,
    /// How long a wider strip has been free, s.
    free: f64,
    /// Time until it looks again, s.
    rest: f64,
    /// Number of the place that a plan hands out; `None` where there is no plan.
    planned: Option<u8>,
    /// From the set point to the place it is at.
    offset: Offset,
}

/// Where a follower looks for room.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outlook {
    /// Its place c_V, [forward, left] in m.
    pub wide: [f64; 2],
    /// Where it is itself, forward of its leader, m.
    pub ahead: f64,
    /// From the follower to its leader in the world's directions, m.
    pub leader: [f64; 2],
    /// Heading of the leader, rad.
    pub heading: f64,
    /// By how much the heading that places are held against is behind that, rad.
    pub behind: f64,
    /// Curvature of the leader's way, 1/m.
    pub curvature: f64,
    /// Its speed, m/s.
    pub speed: f64,
}

/// Steps of λ from the place to the column.
const STEPS: u8 = 8;
/// Steps from the column to a single file, in which nobody keeps to its side.
const FILE_STEPS: u8 = 4;
/// Time between two looks, s.
const LOOKS: f64 = 0.1;
/// A leader slower than this stands, m/s: nobody goes to another place then.
const STANDS: f64 = 0.1;
/// Farthest that a curve is followed, rad.
const TURN_MOST: f64 = std::f64::consts::FRAC_PI_2;
/// How fast one goes back that narrows no more.
const GIVES_BACK: OffsetBounds = OffsetBounds { rate: 0.25, acceleration: 0.4, onset: 0.0 };
/// Nearer than this, m, it is back.
const BACK: f64 = 1e-4;
/// Points of a strip are this far apart, as a share of its half width.
const STRIDE: f64 = 0.4;

impl Narrowing {
    /// Number of the place in the column, see [`Narrowing::place`].
    pub const COLUMN: u8 = STEPS;
    /// Number of the place in a single file.
    pub const FILE: u8 = STEPS + FILE_STEPS;

    /// Place number `level` of one whose set point is at `wide`, [forward, left] in m: from 0, the set point, over λ = level/8
    /// to 8, the column, and on to 12, a single file.
    pub fn place(&self, wide: [f64; 2], level: u8) -> [f64; 2] {
        let share = f64::from(level.min(STEPS)) / f64::from(STEPS);
        let file = f64::from(level.saturating_sub(STEPS)) / f64::from(FILE_STEPS);
        let [x, y] = [0, 1].map(|k| (1.0 - share) * wide[k] + share * self.column[k]);
        [x, y * (1.0 - file)]
    }

    /// How far ahead of the leader strips end, m, for a leader at `speed` m/s.
    pub fn foresight(&self, wide: [f64; 2], speed: f64) -> f64 {
        let way = math::hypot(wide[0] - self.column[0], wide[1] - self.column[1]);
        let time = way / self.rate + self.rate / self.acceleration + SETTLES;
        (speed * time + wide[0] + self.reserve[1]).max(self.reserve[1])
    }
}

/// What an offset takes longer than one that brakes as hard as it may, s.
const SETTLES: f64 = 0.5;

impl NarrowingState {
    /// From the set point to the place it is at.
    pub(crate) fn offset(&self) -> &Offset {
        &self.offset
    }

    /// Looks for the widest place that is free, every now and then: `free` is asked whether a circle of that radius, m, around
    /// a place in the world's directions from the follower is free as far as it senses.
    pub(crate) fn look(
        &mut self,
        rule: &Narrowing,
        outlook: &Outlook,
        period: f64,
        free: &mut dyn FnMut([f64; 2], f64) -> bool,
    ) {
        self.rest = (self.rest - period).max(0.0);
        if self.rest > 1e-9 || outlook.speed < STANDS {
            return;
        }
        self.rest += LOOKS;
        // Whoever sees less room than a plan did keeps to what it sees.
        let wanted = outlook.widest(rule, free).max(self.planned.unwrap_or(0));
        if wanted >= self.level {
            (self.level, self.free) = (wanted, 0.0);
            return;
        }
        self.free += LOOKS.max(period);
        if self.free > rule.patience {
            self.level = wanted;
        }
    }

    /// A plan hands out how far to file in, 0 at the set point to 1 in the column; `None` where there is none any more.
    pub fn hand_out(&mut self, narrowing: Option<f64>) {
        self.planned = narrowing.map(|share| (share.clamp(0.0, 1.0) * f64::from(STEPS)).ceil() as u8);
    }

    /// Carries the place on over a period.
    pub(crate) fn carry(&mut self, rule: &Narrowing, base: &SetPoint, leader_speed: f64, period: f64) {
        let wide = cartesian(base.value);
        let [x, y] = rule.place(wide, self.level);
        let goal = (leader_speed >= STANDS).then_some([x - wide[0], y - wide[1]]);
        let bounds = OffsetBounds { rate: rule.rate, acceleration: rule.acceleration, onset: 0.0 };
        self.offset.carry(goal, bounds, period);
    }

    /// Goes back to the set point of a follower that narrows no more.
    pub(crate) fn give_back(&mut self, period: f64) {
        if *self == Self::default() {
            return;
        }
        self.offset.carry(Some([0.0; 2]), GIVES_BACK, period);
        let [x, y] = self.offset.value;
        if math::hypot(x, y) < BACK {
            *self = Self::default();
        }
    }

    /// s^d moved to the place it is at.
    pub(crate) fn moves(&self, base: &SetPoint, distance_min: f64) -> SetPoint {
        self.offset.displaces(base, distance_min)
    }

    /// λ of the place it is at: how far it is from the set point on the way to the column, 0 to 1.
    pub(crate) fn share(&self, rule: &Narrowing, base: &SetPoint) -> f64 {
        let wide = cartesian(base.value);
        let way = [0, 1].map(|k| rule.column[k] - wide[k]);
        let square = way[0] * way[0] + way[1] * way[1];
        let along = self.offset.value[0] * way[0] + self.offset.value[1] * way[1];
        if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl Outlook {
    /// Number of the widest place whose strip is free. Where none is, it files in: there its leader has driven.
    fn widest(&self, rule: &Narrowing, free: &mut dyn FnMut([f64; 2], f64) -> bool) -> u8 {
        (0..Narrowing::FILE).find(|level| self.strip_is_free(rule, *level, free)).unwrap_or(Narrowing::FILE)
    }

    fn strip_is_free(
        &self,
        rule: &Narrowing,
        level: u8,
        free: &mut dyn FnMut([f64; 2], f64) -> bool,
    ) -> bool {
        let place = rule.place(self.wide, level);
        let most = if self.curvature == 0.0 { f64::INFINITY } else { TURN_MOST / self.curvature.abs() };
        let from = (self.ahead - place[0]).min(0.0) - rule.reserve[0];
        let to = (rule.foresight(self.wide, self.speed) - place[0]).min(most);
        let stride = STRIDE * rule.half_width;
        let points = ((to - from) / stride).ceil().clamp(1.0, MOST_POINTS);
        (0..=points as u32).all(|k| {
            let way = from + (to - from) * f64::from(k) / points;
            free(self.passes(place, way), rule.half_width)
        })
    }

    /// Where `place` is once the leader has driven `way` m on, in the world's directions from the follower, m.
    fn passes(&self, place: [f64; 2], way: f64) -> [f64; 2] {
        let turn = self.curvature * way;
        let [along, across] = if turn.abs() < 1e-9 {
            [way, 0.0]
        } else {
            let (sin, cos) = math::sin_cos(turn);
            [sin / self.curvature, (1.0 - cos) / self.curvature]
        };
        let turned = |[x, y]: [f64; 2], angle: f64| {
            let (sin, cos) = math::sin_cos(angle);
            [cos * x - sin * y, sin * x + cos * y]
        };
        let drives = turned([along, across], self.heading);
        let stands = turned(place, self.heading + turn - self.behind);
        [0, 1].map(|k| self.leader[k] + drives[k] + stands[k])
    }
}

/// Points of a strip at most: a leader may be as fast as it likes.
const MOST_POINTS: f64 = 1000.0;

#[cfg(test)]
mod tests {
    use super::*;

    const RULE: Narrowing = Narrowing {
        filing: Filing { spacing: 1.0, stagger: 0.3 },
        column: [-1.0, 0.3],
        half_width: 0.37,
        rate: 0.25,
        acceleration: 0.4,
        patience: 0.5,
        reserve: [0.3, 0.5],
    };
    const WIDE: [f64; 2] = [-std::f64::consts::SQRT_2, std::f64::consts::SQRT_2];

    fn straight(speed: f64) -> Outlook {
        Outlook {
            wide: WIDE,
            ahead: WIDE[0],
            leader: [0.0; 2],
            heading: 0.0,
            behind: 0.0,
            curvature: 0.0,
            speed,
        }
    }

    /// Whether a circle is free of two walls from x = 9 m to 9.4 m with a gate of `width` m around y = 0.
    fn gate(width: f64, [x, y]: [f64; 2], radius: f64) -> bool {
        let along = (9.0 - x).max(x - 9.4).max(0.0);
        let sides =
            [1.0, -1.0].map(|side| (0.5 * width - side * y).max(side * y - 0.5 * width - 6.0).max(0.0));
        sides.iter().all(|across| math::hypot(along, *across) >= radius)
    }

    /// Wing, gate in m, pose of the leader, its speed in m/s, forward place of the follower in m; and the number of the
    /// place that an independent implementation in Python takes, which samples strips every centimetre.
    type Case = (f64, f64, [f64; 3], f64, f64, u8);
    const CASES: &[Case] = &[
        (-1.0, 3.0354, [3.6394, 0.1191, -0.0154], 1.0392, -2.1467, 2),
        (-1.0, 2.6972, [7.4095, 0.0319, -0.1181], 1.0915, -2.0820, 5),
        (-1.0, 2.5378, [11.5812, 0.0031, 0.0676], 0.8280, -2.0258, 5),
        (1.0, 2.6391, [8.0787, 0.1034, -0.0927], 1.1923, -1.3803, 4),
        (1.0, 2.1494, [9.5858, -0.1504, -0.1303], 0.5540, -1.4831, 5),
        (-1.0, 2.6051, [8.7270, 0.2529, -0.1195], 1.0832, -1.9059, 3),
        (-1.0, 3.0711, [8.8830, 0.0042, -0.1187], 1.0078, -1.2656, 3),
        (1.0, 2.0059, [10.6147, -0.0162, -0.0078], 1.1049, -2.3040, 6),
        (-1.0, 2.7158, [5.3420, 0.0092, -0.1295], 0.8704, -2.2264, 7),
        (1.0, 3.1289, [8.4142, 0.0510, -0.1235], 0.9542, -1.7183, 2),
        (1.0, 2.4262, [9.2608, 0.1925, 0.1381], 0.4169, -2.2162, 6),
        (1.0, 2.4490, [10.0229, 0.2035, -0.0817], 0.5318, -1.7215, 7),
        (1.0, 3.5508, [4.6458, -0.0486, 0.0545], 0.8620, -2.1349, 1),
        (1.0, 3.1641, [7.3812, 0.1886, 0.0194], 1.0415, -1.4662, 4),
        (-1.0, 3.5829, [7.4784, -0.2243, -0.0735], 0.7643, -1.4135, 3),
        (1.0, 2.1401, [5.9616, 0.2066, -0.0048], 0.8313, -2.0633, 7),
        (1.0, 1.4828, [12.9909, 0.0914, -0.0796], 0.7480, -1.0387, 0),
        (1.0, 3.4759, [7.4233, 0.1060, -0.1318], 0.8445, -2.0928, 0),
        (-1.0, 5.3035, [2.0132, 0.0020, -0.0190], 0.5626, -2.0126, 0),
        (-1.0, 5.1115, [9.5263, -0.0217, -0.0834], 0.9128, -2.3394, 0),
        (1.0, 3.7933, [2.6298, -0.2984, -0.0915], 0.6733, -1.1078, 0),
    ];

    #[test]
    fn places_are_those_of_an_independent_implementation() {
        for &(side, width, [x, y, heading], speed, ahead, expected) in CASES {
            let column = if side > 0.0 { [-1.0, 0.3] } else { [-2.0, -0.3] };
            let rule = Narrowing { column, ..RULE };
            let outlook = Outlook {
                wide: [WIDE[0], side * WIDE[1]],
                ahead,
                leader: [x, y],
                heading,
                ..straight(speed)
            };
            let found = outlook.widest(&rule, &mut |place, radius| gate(width, place, radius));
            assert_eq!(found, expected, "{side} {width} {x} {y} {heading}");
        }
    }

    /// Offsets of the same implementation, in steps of 0.01 s: 5 s to the column, then to a quarter of the way.
    #[test]
    fn a_place_moves_as_in_an_independent_implementation() {
        let base = SetPoint { value: [2.0, 0.75 * std::f64::consts::PI], ..SetPoint::default() };
        let mut state = NarrowingState::default();
        let expected = [
            (50, [1.954_171_361_738_170_2, 2.366_961_823_443_290_8]),
            (200, [1.635_174_572_489_565_4, 2.461_085_817_065_032]),
            (500, [1.094_220_134_425_374_4, 2.791_694_983_766_314]),
            (600, [1.145_840_734_727_055_2, 2.740_359_785_695_628_3]),
            (1000, [1.722_524_091_558_060_9, 2.431_333_110_049_016]),
        ];
        let mut expected = expected.iter();
        let mut next = expected.next();
        for k in 1..=1000 {
            state.level = if k <= 500 { 8 } else { 2 };
            state.carry(&RULE, &base, 0.8, 0.01);
            if let Some((_, [distance, bearing])) = next.filter(|(at, _)| *at == k) {
                let found = state.moves(&base, 0.1);
                assert!((found.value[0] - distance).abs() < 1e-12, "{k}: {found:?}");
                assert!((found.value[1] - bearing).abs() < 1e-12, "{k}: {found:?}");
                next = expected.next();
            }
        }
        assert!(next.is_none());
        state.level = Narrowing::COLUMN;
        for _ in 0..2000 {
            state.carry(&RULE, &base, 0.8, 0.01);
        }
        assert!((state.share(&RULE, &base) - 1.0).abs() < 1e-9);
    }

    /// The way of a place against the leader's drive in small steps.
    #[test]
    fn a_strip_follows_the_leaders_curve() {
        let outlook =
            Outlook { leader: [1.0, -2.0], heading: 0.4, behind: 0.1, curvature: 0.2, ..straight(0.8) };
        let (mut at, mut heading, steps, way) = ([1.0, -2.0], 0.4, 100_000, 3.0);
        let step = way / f64::from(steps);
        for _ in 0..steps {
            let (sin, cos) = math::sin_cos(heading + 0.5 * 0.2 * step);
            at = [at[0] + step * cos, at[1] + step * sin];
            heading += 0.2 * step;
        }
        let (sin, cos) = math::sin_cos(heading - 0.1);
        let [x, y] = [-1.5, 0.8];
        let expected = [at[0] + cos * x - sin * y, at[1] + sin * x + cos * y];
        let found = outlook.passes([x, y], way);
        assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1e-8), "{found:?} {expected:?}");
    }

    #[test]
    fn it_goes_back_once_a_wider_way_has_been_free_for_a_while_and_nowhere_while_its_leader_stands() {
        let mut state = NarrowingState::default();
        let base = SetPoint { value: [2.0, 0.75 * std::f64::consts::PI], ..SetPoint::default() };
        let drive = |state: &mut NarrowingState, free: bool, speed: f64, samples: u32| {
            for _ in 0..samples {
                state.look(&RULE, &straight(speed), 0.01, &mut |_, _| free);
                state.carry(&RULE, &base, speed, 0.01);
            }
            state.level
        };
        assert_eq!(drive(&mut state, false, 0.8, 1), Narrowing::FILE);
        assert_eq!(drive(&mut state, false, 0.8, 100), Narrowing::FILE);
        let moving = state.offset.value;
        assert!(moving != [0.0; 2]);
        // The leader stands: whatever is free, the place comes to rest.
        assert_eq!(drive(&mut state, true, 0.0, 500), Narrowing::FILE);
        assert!(math::hypot(state.offset.rate[0], state.offset.rate[1]) < 1e-6);
        assert_eq!(drive(&mut state, true, 0.8, 40), Narrowing::FILE);
        assert_eq!(drive(&mut state, true, 0.8, 40), 0);
    }

    #[test]
    fn a_place_goes_back_without_a_jump_where_the_rule_is_taken_away() {
        let base = SetPoint { value: [2.0, 0.75 * std::f64::consts::PI], ..SetPoint::default() };
        let mut state = NarrowingState { level: Narrowing::COLUMN, ..NarrowingState::default() };
        for _ in 0..1000 {
            state.carry(&RULE, &base, 0.8, 0.01);
        }
        let mut before = state.offset.value;
        for _ in 0..2000 {
            state.give_back(0.01);
            let now = state.offset.value;
            assert!(math::hypot(now[0] - before[0], now[1] - before[1]) < 0.0026);
            before = now;
        }
        assert_eq!(state, NarrowingState::default());
    }

    #[test]
    fn the_numbers_of_places_lead_from_the_set_point_over_the_column_to_a_single_file() {
        assert_eq!(RULE.place(WIDE, 0), WIDE);
        assert_eq!(RULE.place(WIDE, Narrowing::COLUMN), RULE.column);
        assert_eq!(RULE.place(WIDE, Narrowing::FILE), [-1.0, 0.0]);
        let half = RULE.place(WIDE, 4);
        assert!(
            (half[0] - 0.5 * (WIDE[0] - 1.0)).abs() < 1e-15
                && (half[1] - 0.5 * (WIDE[1] + 0.3)).abs() < 1e-15
        );
    }
}
