//! The formation that plans: bodies, who follows whom, and the places at every level, from the shape to the column.

use crate::convex::{Convex, corners};
use crate::error::{InputError, checked};
use crate::limits::TravelLimits;
use vocabulary::{PathFilter, Pose, math};

/// What a robot takes up, seen from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyShape {
    /// Round.
    Disc {
        /// m.
        radius: f64,
    },
    /// A rectangle along the heading.
    Rectangle {
        /// From the robot's reference point to its front, m.
        front: f64,
        /// To its back, m, positive.
        back: f64,
        /// m.
        half_width: f64,
    },
}

/// A robot that follows.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowerModel {
    /// Number of the robot that it follows: 0 is the lead, k the k-th follower.
    pub leader: usize,
    /// Its place at every level, [forward, left] of its leader in the heading that it is held against, m.
    pub places: Vec<[f64; 2]>,
    /// The filter of that heading; without one it is the leader's own.
    pub heading: Option<PathFilter>,
    /// Its body.
    pub body: BodyShape,
}

/// A lead and its followers, at levels 0, the shape, to the last, the column.
#[derive(Debug, Clone, PartialEq)]
pub struct FormationModel {
    lead: BodyShape,
    followers: Vec<FollowerModel>,
    levels: usize,
}

/// A robot on a circle that the lead has driven for long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyRobot {
    /// In the lead's frame.
    pub pose: Pose,
    /// Its speed per speed of the lead.
    pub ratio: f64,
    /// The same along the heading that its place is held against: negative for one that would have to reverse.
    pub forward: f64,
}

/// Followers go no slower than this share of the lead's speed: where they would nearly stand they would lose their heading.
pub(crate) const SLOWEST_SHARE: f64 = 0.15;
/// Levels at most.
const LEVELS_MOST: usize = 1000;
/// Curvatures that are tried on the way to the largest.
const CURVATURES: usize = 96;

impl BodyShape {
    /// Radius of the circle around the reference point that holds the body, m.
    pub fn reach(&self) -> f64 {
        match *self {
            Self::Disc { radius } => radius,
            Self::Rectangle { front, back, half_width } => {
                let long = front.max(back);
                (long * long + half_width * half_width).sqrt()
            }
        }
    }

    /// Radius of the largest circle around the reference point within the body, m.
    pub fn core(&self) -> f64 {
        match *self {
            Self::Disc { radius } => radius,
            Self::Rectangle { front, back, half_width } => front.min(back).min(half_width).max(0.0),
        }
    }

    /// What a robot of this shape takes up at a pose.
    pub fn at(&self, pose: Pose) -> Convex {
        match *self {
            Self::Disc { radius } => Convex::new(&[[pose.x, pose.y]], radius),
            Self::Rectangle { front, back, half_width } => {
                Convex::new(&corners(pose, [-back, front], half_width), 0.0)
            }
        }
    }

    fn check(&self, whose: &dyn Fn() -> String) -> Result<(), InputError> {
        let part = |name: &str| format!("{name} of {}", whose());
        match *self {
            Self::Disc { radius } => {
                checked(radius, radius > 0.0, || part("the radius"), "positive, m")?;
            }
            Self::Rectangle { front, back, half_width } => {
                checked(half_width, half_width > 0.0, || part("half the width"), "positive, m")?;
                checked(front, front >= 0.0, || part("the way to the front"), "0 or more, m")?;
                checked(back, back >= 0.0, || part("the way to the back"), "0 or more, m")?;
                checked(front + back, front + back > 0.0, || part("the length"), "positive, m")?;
            }
        }
        Ok(())
    }
}

impl FollowerModel {
    /// A follower that narrows from its place in the shape to that in the column in `steps` levels:
    /// c(λ) = (1 − λ) c_V + λ c_column, `ends` = [c_V, c_column], each [forward, left] of its leader, m.
    pub fn narrowing(leader: usize, ends: [[f64; 2]; 2], steps: usize, body: BodyShape) -> Self {
        let place = |level: usize| {
            let share = if steps == 0 { 0.0 } else { level as f64 / steps as f64 };
            [0, 1].map(|k| (1.0 - share) * ends[0][k] + share * ends[1][k])
        };
        Self { leader, places: (0..=steps).map(place).collect(), heading: None, body }
    }

    /// The same with its place held against a filtered heading.
    #[must_use]
    pub fn with_heading(self, heading: Option<PathFilter>) -> Self {
        Self { heading, ..self }
    }
}

impl FormationModel {
    /// Followers stand after their leaders in the list.
    ///
    /// # Errors
    /// A follower before its leader, levels that differ, or a number out of its range.
    pub fn new(lead: BodyShape, followers: Vec<FollowerModel>) -> Result<Self, InputError> {
        lead.check(&|| "the lead".into())?;
        let levels = followers.first().map_or(1, |follower| follower.places.len());
        let fits = (1..=LEVELS_MOST).contains(&levels);
        checked(levels as f64, fits, || "the number of levels".into(), "from 1 to 1000")?;
        for (k, follower) in followers.iter().enumerate() {
            let number = k + 1;
            if follower.leader >= number {
                return Err(InputError::LeaderAfterFollower { follower: number, leader: follower.leader });
            }
            let found = follower.places.len();
            if found != levels {
                return Err(InputError::UnevenLevels { follower: number, found, expected: levels });
            }
            if follower.places.iter().flatten().any(|value| !value.is_finite()) {
                return Err(InputError::NotFinite { what: format!("a place of follower {number}") });
            }
            follower.body.check(&|| format!("follower {number}"))?;
            if let Some(PathFilter { length, lag }) = follower.heading {
                let what = |name: &str| format!("{name} of follower {number}");
                checked(length, length > 0.0, || what("the heading's length"), "positive, m")?;
                let fits = (0.0..=2.0 * length).contains(&lag);
                checked(lag, fits, || what("the heading's lag"), "from 0 to twice its length, m")?;
            }
        }
        Ok(Self { lead, followers, levels })
    }

    /// A robot on its own.
    ///
    /// # Errors
    /// A size that is not positive.
    pub fn alone(body: BodyShape) -> Result<Self, InputError> {
        Self::new(body, vec![])
    }

    /// How many robots there are, the lead included.
    pub fn robots(&self) -> usize {
        1 + self.followers.len()
    }

    /// How many levels there are, one at least.
    pub fn levels(&self) -> usize {
        self.levels
    }

    /// The robots that follow.
    pub fn followers(&self) -> &[FollowerModel] {
        &self.followers
    }

    /// Body of robot `index`, 0 for the lead.
    pub fn body(&self, index: usize) -> BodyShape {
        if index == 0 { self.lead } else { self.followers[index - 1].body }
    }

    /// Where robots are behind a lead that has gone straight on, [forward, left] of the lead, m.
    pub fn places(&self, level: usize) -> Vec<[f64; 2]> {
        self.steady(level, 0.0).iter().map(|robot| [robot.pose.x, robot.pose.y]).collect()
    }

    /// The formation at some of its levels only: at one at least.
    #[must_use]
    pub fn with_levels(&self, levels: std::ops::Range<usize>) -> Self {
        let first = levels.start.min(self.levels - 1);
        let levels = first..levels.end.clamp(first + 1, self.levels);
        let keep = |follower: &FollowerModel| FollowerModel {
            places: follower.places[levels.clone()].to_vec(),
            ..follower.clone()
        };
        Self {
            lead: self.lead,
            followers: self.followers.iter().map(keep).collect(),
            levels: levels.len().max(1),
        }
    }

    /// Number of the robot at the end of the column: the farthest back of those that nobody follows.
    pub fn last(&self) -> Option<usize> {
        let places = self.places(self.levels - 1);
        let led = |robot: usize| self.followers.iter().any(|follower| follower.leader == robot);
        (1..self.robots())
            .filter(|robot| !led(*robot))
            .min_by(|a, b| places[*a][0].total_cmp(&places[*b][0]).then(b.cmp(a)))
    }

    /// The formation without the robot at the end of its column.
    #[must_use]
    pub fn without_last(&self) -> Option<Self> {
        let last = self.last()?;
        let mut smaller = self.clone();
        smaller.followers.remove(last - 1);
        for follower in &mut smaller.followers {
            follower.leader -= usize::from(follower.leader > last);
        }
        Some(smaller)
    }

    /// All robots at `level` on a circle of `curvature` 1/m that the lead has driven for long: held headings are τ κ behind
    /// the leader's, κ that of the leader's own circle.
    pub fn steady(&self, level: usize, curvature: f64) -> Vec<SteadyRobot> {
        let mut robots = vec![SteadyRobot { pose: Pose::default(), ratio: 1.0, forward: 1.0 }];
        for follower in &self.followers {
            let leader = robots[follower.leader];
            let own = if leader.ratio > 0.0 { curvature / leader.ratio } else { 0.0 };
            let held = leader.pose.heading - follower.heading.map_or(0.0, |filter| filter.lag * own);
            let [forward, left] = follower.places[level.min(self.levels - 1)];
            let [x, y] = Pose { heading: held, ..leader.pose }.world_from_body(forward, left);
            // About the middle of the circle, (0, 1/κ), the velocity per speed of the lead.
            let velocity = [1.0 - curvature * y, curvature * x];
            let ratio = math::hypot(velocity[0], velocity[1]);
            let (sin, cos) = math::sin_cos(held);
            let heading = if ratio > 0.0 { math::atan2(velocity[1], velocity[0]) } else { held };
            let forward = cos * velocity[0] + sin * velocity[1];
            robots.push(SteadyRobot { pose: Pose { x, y, heading }, ratio, forward });
        }
        robots
    }

    /// Largest curvature at `level`, 1/m: of the vehicle; that at which no follower is faster than its bound while the lead
    /// drives at its speed for tight turns, and none has to stop or to reverse; that of followers on their own circles.
    pub fn largest_curvature(&self, level: usize, limits: &TravelLimits) -> f64 {
        let most = limits.curvature;
        let holds = |curvature: f64| {
            self.steady(level, curvature).iter().skip(1).all(|robot| {
                robot.ratio <= limits.fastest_share()
                    && robot.forward >= SLOWEST_SHARE
                    && limits.follower_curvature.is_none_or(|own| curvature <= own * robot.ratio)
            })
        };
        let tried = (1..=CURVATURES).map(|k| most * k as f64 / CURVATURES as f64);
        // To the left and to the right alike: a formation with one wing only has its smaller one.
        tried.take_while(|curvature| holds(*curvature) && holds(-*curvature)).last().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial;

    /// On a circle a follower is τ κ behind, and as fast as it is far from the middle.
    #[test]
    fn on_a_circle_everybody_is_on_a_circle() {
        let (model, curvature) = (trial::vee(), 0.12);
        let robots = model.steady(0, curvature);
        let [left, right] = [robots[1], robots[2]];
        let place = Pose::new(0.0, 0.0, -curvature).world_from_body(-2.0_f64.sqrt(), 2.0_f64.sqrt());
        assert!(math::hypot(left.pose.x - place[0], left.pose.y - place[1]) < 1e-12);
        assert!(left.ratio < 1.0 && right.ratio > 1.0);
        for robot in robots {
            let from_middle = math::hypot(robot.pose.x, robot.pose.y - 1.0 / curvature);
            assert!((robot.ratio - curvature * from_middle).abs() < 1e-12);
        }
    }

    /// The column follows the lead's track: it may turn as sharply as the lead. The V has an outermost robot.
    #[test]
    fn narrow_shapes_turn_more_sharply_than_wide_ones() {
        let (model, limits) = (trial::vee(), TravelLimits::default());
        let largest: Vec<f64> = (0..5).map(|level| model.largest_curvature(level, &limits)).collect();
        assert!(largest.windows(2).all(|pair| pair[0] < pair[1]), "{largest:?}");
        // A little more, and a robot of the V is too fast, or nearly stands.
        let holds = |curvature: f64| {
            let robots = model.steady(0, curvature);
            robots.iter().all(|robot| robot.ratio <= 2.0 && robot.forward >= SLOWEST_SHARE)
        };
        assert!(holds(largest[0]) && !holds(largest[0] + limits.curvature / CURVATURES as f64));
    }

    #[test]
    fn whoever_is_last_in_the_column_is_left_out_first() {
        let mut model = trial::vee();
        let mut left = vec![];
        while let Some(smaller) = model.without_last() {
            left.push(smaller.robots());
            model = smaller;
        }
        assert_eq!(left, [6, 5, 4, 3, 2, 1]);
        assert_eq!(trial::vee().last(), Some(6));
        assert_eq!(trial::vee().with_levels(9..12).levels(), 1);
        let line = FollowerModel::narrowing(1, [[-1.0, 0.0]; 2], 1, BodyShape::Disc { radius: 0.2 });
        let error = FormationModel::new(BodyShape::Disc { radius: 0.2 }, vec![line]).expect_err("refused");
        assert_eq!(
            error.to_string(),
            "follower 1 follows robot 1: list leaders before their followers; robot 0 is the lead"
        );
    }
}
