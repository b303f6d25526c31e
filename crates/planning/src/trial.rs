//! Maps and formations for trials: random obstacles on 40 m by 40 m, and seven in a V.

use crate::convex::Convex;
use crate::formation_model::{BodyShape, FollowerModel, FormationModel};
use crate::map::Map;
use crate::mission::{Mission, PlanGoal, PlanStart};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::{FRAC_PI_4, PI, SQRT_2};
use vocabulary::{PathFilter, Pose};

/// Random numbers that are the same everywhere.
#[derive(Debug, Clone)]
pub struct Draws(ChaCha8Rng);

impl Draws {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Evenly from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        low + share * (high - low)
    }
}

/// Side of a map, m.
pub const SIDE: f64 = 40.0;
/// How far robots stay off obstacles, m.
pub const CLEARANCE: f64 = 0.25;
/// Radius of a robot, m.
pub const RADIUS: f64 = 0.22;
/// Levels of the V beyond the shape.
pub const STEPS: usize = 4;
/// Around these no obstacle's middle is nearer than [`FREE`].
const KEPT_FREE: [[f64; 2]; 2] = [[6.5, 6.5], [31.0, 31.0]];
const FREE: f64 = 6.5;

/// A map of `count` obstacles: three in five are discs of 0.15 to 0.5 m, the others boxes of up to 2 m by 0.8 m. Around the
/// start and the goal of [`mission`] there are none.
pub fn map(seed: u64, count: usize) -> Map {
    spread(seed, count, SIDE)
}

/// The same on a square of `side` m, [`SIDE`] at least.
pub fn spread(seed: u64, count: usize, side: f64) -> Map {
    let side = side.max(SIDE);
    let mut draws = Draws::new(seed);
    let mut obstacles = vec![];
    while obstacles.len() < count {
        let at = [(); 2].map(|()| draws.between(1.0, side - 1.0));
        if KEPT_FREE.iter().any(|middle| crate::convex::apart(at, *middle) < FREE) {
            continue;
        }
        obstacles.push(if draws.between(0.0, 1.0) < 0.6 {
            Convex::new(&[at], draws.between(0.15, 0.5))
        } else {
            let half = [draws.between(0.2, 1.0), draws.between(0.1, 0.4)];
            let pose = Pose::new(at[0], at[1], draws.between(0.0, PI));
            Convex::new(&crate::convex::corners(pose, [-half[0], half[0]], half[1]), 0.0)
        });
    }
    let ground = Convex::new(&[[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]], 0.0);
    Map::new(ground, obstacles, CLEARANCE).unwrap_or_else(|error| unreachable!("{error}"))
}

/// Seven robots of 0.44 m in a V: each 2 m behind and beside its leader, headings held along the path. In the column the wings
/// close like a zipper.
pub fn vee() -> FormationModel {
    let body = BodyShape::Disc { radius: RADIUS };
    let heading = Some(PathFilter { length: 1.0, lag: 1.0 });
    let followers = (1..7).map(|robot: usize| {
        let side = if robot % 2 == 1 { 1.0 } else { -1.0 };
        let wide = [-SQRT_2, side * SQRT_2];
        let column = match robot {
            1 => [-1.0, 0.3],
            2 => [-2.0, -0.3],
            _ => [-2.0, 0.0],
        };
        FollowerModel::narrowing(robot.saturating_sub(2), [wide, column], STEPS, body).with_heading(heading)
    });
    FormationModel::new(body, followers.collect()).unwrap_or_else(|error| unreachable!("{error}"))
}

/// The same with places held against leaders' own headings.
pub fn without_filters(model: &FormationModel) -> FormationModel {
    let followers = model.followers().iter().map(|follower| follower.clone().with_heading(None));
    FormationModel::new(model.body(0), followers.collect()).unwrap_or_else(|error| unreachable!("{error}"))
}

/// From one corner of the map to the other, in the V at both ends.
pub fn mission() -> Mission {
    let start = PlanStart::at(Pose::new(8.0, 8.0, FRAC_PI_4));
    Mission { start, goal: PlanGoal::at(Pose::new(33.0, 33.0, FRAC_PI_4)).at_level(0) }
}
