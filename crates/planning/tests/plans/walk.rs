//! Plans walked by an independent integration, and what every plan promises.

use planning::{BodyShape, Convex, FormationModel, Leg, Map, Mission, MotionPlan, TravelLimits, trial};
use vocabulary::{Pose, math, wrap};

/// A walk over legs by small steps: the lead by its curvature, followers by the differential equations of their held headings, with
/// the velocity of every robot for its heading. Nothing of the planner's own walk is used.
pub(crate) struct Walk {
    lead: Pose,
    /// θ̄ and κ̄ of every follower.
    pub(crate) held: Vec<[f64; 2]>,
    pub(crate) positions: Vec<[f64; 2]>,
    /// Velocity per speed of the lead.
    pub(crate) velocities: Vec<[f64; 2]>,
    /// Way of the lead in a step, m.
    step: f64,
}

impl Walk {
    pub(crate) fn new(model: &FormationModel, lead: Pose) -> Self {
        let n = model.robots();
        let held = vec![[lead.heading, 0.0]; n - 1];
        Self { lead, held, positions: vec![[0.0; 2]; n], velocities: vec![[0.0; 2]; n], step: 0.0 }
    }

    pub(crate) fn place(&mut self, model: &FormationModel, level: f64, rate: f64) {
        let (sin, cos) = math::sin_cos(self.lead.heading);
        self.positions[0] = [self.lead.x, self.lead.y];
        self.velocities[0] = [cos, sin];
        for (k, follower) in model.followers().iter().enumerate() {
            let below = (level as usize).min(model.levels() - 1);
            let [a, b] = [below, (below + 1).min(model.levels() - 1)].map(|level| follower.places[level]);
            let share = level - below as f64;
            let [x, y] = [0, 1].map(|i| a[i] + share * (b[i] - a[i]));
            let [dx, dy] = [0, 1].map(|i| rate * (b[i] - a[i]));
            let turn = self.turn(model, k);
            let (sin, cos) = math::sin_cos(self.held[k][0]);
            let [px, py] = [cos * x - sin * y, sin * x + cos * y];
            let leader = follower.leader;
            self.positions[k + 1] = [self.positions[leader][0] + px, self.positions[leader][1] + py];
            let own = [cos * dx - sin * dy - turn * py, sin * dx + cos * dy + turn * px];
            self.velocities[k + 1] = [0, 1].map(|i| self.velocities[leader][i] + own[i]);
        }
    }

    /// dθ̄ per metre of the lead. Without a filter θ̄ is the direction in which the leader drives.
    pub(crate) fn turn(&mut self, model: &FormationModel, follower: usize) -> f64 {
        let of = &model.followers()[follower];
        if of.heading.is_some() {
            return self.held_rate(model, follower)[0];
        }
        let [vx, vy] = self.velocities[of.leader];
        let (before, now) = (self.held[follower][0], math::atan2(vy, vx));
        self.held[follower][0] = now;
        if self.step > 0.0 { wrap(now - before) / self.step } else { 0.0 }
    }

    /// dθ̄ and dκ̄ per metre of the lead.
    pub(crate) fn held_rate(&self, model: &FormationModel, follower: usize) -> [f64; 2] {
        let of = &model.followers()[follower];
        let Some(filter) = of.heading else { return [0.0; 2] };
        let [vx, vy] = self.velocities[of.leader];
        let (length, lag) = (filter.length, filter.lag);
        let speed = math::hypot(vx, vy);
        let [held, kappa] = self.held[follower];
        let e = wrap(math::atan2(vy, vx) - held);
        let share = 1.0 - lag / length;
        let turn = kappa + (2.0 * length - lag) / (length * length) * e;
        [speed * turn, speed * (share * share * e - lag * kappa) / (length * length)]
    }

    /// Walks a leg and visits every step, with the curvature and the way gone.
    pub(crate) fn leg(&mut self, model: &FormationModel, leg: &Leg, visit: &mut dyn FnMut(&Self, f64)) {
        for pair in leg.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let span = b.way - a.way;
            let steps = (span / 2e-3).ceil();
            let step = span / steps;
            self.step = step;
            for k in 0..steps as usize {
                let share = (k as f64 + 0.5) / steps;
                let curvature = a.curvature + share * (b.curvature - a.curvature);
                let level = a.level + share * share * (3.0 - 2.0 * share) * (b.level - a.level);
                let rate = 6.0 * share * (1.0 - share) * (b.level - a.level) / span;
                let direction = leg.direction();
                let heading = self.lead.heading + 0.5 * direction * step * curvature;
                let (sin, cos) = math::sin_cos(heading);
                self.lead.x += direction * step * cos;
                self.lead.y += direction * step * sin;
                self.lead.heading += direction * step * curvature;
                self.place(model, level, rate);
                for follower in 0..self.held.len() {
                    let rate = self.held_rate(model, follower);
                    for (value, rate) in self.held[follower].iter_mut().zip(rate) {
                        *value += step * rate;
                    }
                }
                visit(self, step);
            }
        }
    }
}

pub(crate) fn clearance(map: &Map, model: &FormationModel, walk: &Walk) -> f64 {
    let of = |robot: usize| {
        let BodyShape::Disc { radius } = model.body(robot) else { panic!("discs only") };
        let point = walk.positions[robot];
        let obstacles = map.obstacles().iter().map(|obstacle| obstacle.distance(point));
        obstacles.fold(-map.ground().distance(point), f64::min) - radius
    };
    (0..model.robots()).map(of).fold(f64::INFINITY, f64::min)
}

/// Least clearance and the largest speed of a follower, m/s, on the way of a plan.
pub(crate) fn walked(map: &Map, model: &FormationModel, plan: &MotionPlan) -> [f64; 2] {
    let mut walk = Walk::new(model, plan.legs[0].start);
    let (mut least, mut fastest) = (f64::INFINITY, 0.0_f64);
    let (mut count, mut gone) = (0, 0.0);
    for leg in &plan.legs {
        walk.leg(model, leg, &mut |walk, step| {
            count += 1;
            let speed = plan.at_way(gone + 0.5 * step).map_or(0.0, |point| point.speed.abs());
            gone += step;
            if count % 10 == 0 {
                least = least.min(clearance(map, model, walk));
            }
            let followers = walk.velocities[1..].iter();
            fastest = followers.fold(fastest, |most, [x, y]| most.max(speed * math::hypot(*x, *y)));
        });
    }
    [least, fastest]
}

/// Curvature, sharpness, speeds and accelerations of a plan.
pub(crate) fn within_limits(plan: &MotionPlan, limits: &TravelLimits) {
    for leg in &plan.legs {
        for pair in leg.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let sharpness = (b.curvature - a.curvature).abs() / (b.way - a.way);
            assert!(sharpness <= limits.sharpness * (1.0 + 1e-6), "{sharpness}");
            assert!(b.curvature.abs() <= limits.curvature * (1.0 + 1e-9));
        }
    }
    for pair in plan.points.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let way = b.way - a.way;
        if way <= 0.0 {
            continue;
        }
        let rise = (b.speed * b.speed - a.speed * a.speed) / (2.0 * way);
        assert!(rise <= limits.acceleration + 1e-9 && rise >= -limits.braking - 1e-9, "{rise}");
        let speed = a.speed.abs().max(b.speed.abs());
        assert!(speed <= limits.speed + 1e-12);
        let steering = (b.curvature - a.curvature).abs() / way * speed;
        assert!(steering <= limits.steering * (1.0 + 1e-9), "{steering}");
        assert!(a.curvature.abs().max(b.curvature.abs()) * speed * speed <= limits.lateral * (1.0 + 1e-9));
        let moved = |robot: usize| {
            let [p, q] = [a.robots[robot], b.robots[robot]];
            math::hypot(q.x - p.x, q.y - p.y)
        };
        // Followers' ways are chords of at most an eighth of a metre of the lead.
        let outer = (1..a.robots.len()).map(moved).fold(0.0, f64::max) / way * speed;
        assert!(outer <= limits.outer * (1.0 + 1e-6), "{outer}");
        assert!(b.time > a.time);
    }
}

pub(crate) fn reaches(plan: &MotionPlan, mission: &Mission) {
    let (first, last) = (&plan.points[0], &plan.points[plan.points.len() - 1]);
    let start = mission.start.pose;
    assert_eq!([first.pose.x, first.pose.y, first.pose.heading], [start.x, start.y, start.heading]);
    let goal = mission.goal;
    assert!(math::hypot(last.pose.x - goal.position[0], last.pose.y - goal.position[1]) <= goal.tolerance);
    if let Some(heading) = goal.heading {
        assert!(wrap(last.pose.heading - heading).abs() <= goal.heading_tolerance);
    }
    if let Some(level) = goal.level {
        assert_eq!(last.level, level as f64);
    }
    assert_eq!(last.speed, 0.0);
}

/// As [`walked`], with obstacles near the way only.
pub(crate) fn walked_near(map: &Map, plan: &MotionPlan) -> [f64; 2] {
    let near: Vec<Convex> = map
        .obstacles()
        .iter()
        .filter(|obstacle| {
            plan.points.iter().any(|point| obstacle.distance([point.pose.x, point.pose.y]) < 12.0)
        })
        .cloned()
        .collect();
    let map = Map::new(map.ground().clone(), near, map.clearance()).expect("a map");
    walked(&map, &trial::vee(), plan)
}
