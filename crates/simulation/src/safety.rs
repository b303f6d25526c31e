//! Safety filters in the loop: what robots sense near them, the barriers of that, and the commands that these leave.

use crate::sensing::SensingPipeline;
use formation::{EdgeLaw, Formation, FormationState};
use perception::proximity::{ProximityConfig, ProximityState, Sensed};
use safety::{Filter, HalfPlane, Neighbour, Parameters, Placed, Sight, Wish, barrier};
use std::f64::consts::PI;
use std::sync::Arc;
use vocabulary::{
    Body, Command, Constraint, EntityId, Limits, Motion, Observation, SafetyState, Snapshot, wrap,
};

/// What safety filters go by, beside their barriers.
#[derive(Debug, Clone)]
pub struct SafetyConfig {
    /// Proximity sensors.
    pub proximity: ProximityConfig,
    /// Whether a robot has wheels, whose driver looks after its speed.
    pub wheels: Vec<bool>,
    /// Farthest that cameras turn from straight ahead, rad.
    pub pan_max: f64,
    /// Fastest turn of a camera, rad/s.
    pub pan_rate: f64,
}

/// Filters of all robots, and what they remember.
#[derive(Clone)]
pub(crate) struct SafetyPipeline {
    config: Arc<SafetyConfig>,
    /// Barriers, per robot; `None` where its filter is off.
    pub(crate) filters: Vec<Option<Parameters>>,
    sensors: Vec<ProximityState>,
    period: f64,
    workspace: Workspace,
    /// What the filters did at the last sample.
    states: Vec<SafetyState>,
    count: usize,
}

/// Accelerations beyond this are none, m/s²: a polygon of commands has corners.
const MOST_ACCELERATION: f64 = 1e4;

/// Reused from robot to robot.
#[derive(Debug, Clone, Default)]
struct Workspace {
    filter: Filter,
    near: Vec<Sensed>,
    collisions: Vec<HalfPlane>,
    views: Vec<HalfPlane>,
}

impl SafetyPipeline {
    pub(crate) fn new(config: Arc<SafetyConfig>, filters: Vec<Option<Parameters>>, period: f64) -> Self {
        Self {
            sensors: vec![ProximityState::default(); filters.len()],
            period,
            workspace: Workspace::default(),
            states: vec![],
            count: 0,
            config,
            filters,
        }
    }

    /// What the filters did at the last sample, in the order of the robots.
    pub(crate) fn told(&self) -> &[SafetyState] {
        &self.states[..self.count]
    }

    /// How far a robot senses, m.
    pub(crate) fn range(&self, robot: usize) -> Option<f64> {
        self.config.proximity.sensors[robot].map(|sensor| sensor.range)
    }

    /// Followers that narrow look for room in what they sense. Where a robot has a filter, it senses from the filter's point.
    pub(crate) fn look(
        &mut self,
        formation: &Formation,
        time: f64,
        observations: &[Observation],
        state: &mut FormationState,
        snapshot: &Snapshot,
    ) {
        let graph = formation.graph();
        let narrows = |(index, law): (usize, &EdgeLaw)| {
            (law.narrowing.is_some() && graph.is_in_force(index)).then(|| graph.edges()[index].follower)
        };
        for robot in formation.laws().iter().enumerate().filter_map(narrows) {
            let motion = &snapshot.robots[robot].motion;
            let own = placed(motion, &self.config.proximity.robots[robot].body);
            let middle = own.pose.world_from_body(own.middle, 0.0);
            let from = self.filters[robot].map_or(middle, |parameters| own.point_ahead(&parameters));
            self.config.proximity.take(&mut self.sensors[robot], robot, from, snapshot, true);
        }
        formation.look(time, observations, state, &mut |robot, [x, y], radius| {
            let pose = &snapshot.robots[robot].motion.pose;
            let place = [pose.x + x, pose.y + y];
            let range = self.range(robot).unwrap_or(0.0);
            let leader = graph.leader_of(robot).unwrap_or(robot);
            let arena = self.filters[robot].and_then(|parameters| parameters.arena);
            arena.is_none_or(|arena| within(arena, place, radius))
                && self.sensors[robot].is_free(place, radius, range, leader)
        });
    }

    /// A control sample begins.
    pub(crate) fn begin(&mut self) {
        self.count = 0;
    }

    /// All commands of a control sample are decided.
    pub(crate) fn end(&mut self) {
        self.states[..self.count].sort_by_key(|state| state.robot);
    }

    /// The command of a robot that wishes `wished`, as far as it is safe.
    pub(crate) fn admit(
        &mut self,
        robot: usize,
        wished: Command,
        formation: &Formation,
        observations: &[Observation],
        snapshot: &Snapshot,
        sensing: Option<&SensingPipeline>,
    ) -> Command {
        let Some(parameters) = self.filters[robot] else { return wished };
        let motion = &snapshot.robots[robot].motion;
        let sight = formation.graph().edge_of(robot).map(|edge| {
            let leader = formation.edges()[edge].leader;
            let seen = wrap(observations[edge].relative.view_angle - PI);
            let most = self.config.pan_max;
            // Where there is no camera, there might be one.
            let sensing = sensing.filter(|_| formation.laws()[edge].tracker.is_some());
            let pan = sensing.map_or(seen.clamp(-most, most), |sensing| sensing.age_and_pan(edge).1);
            (leader, pan)
        });
        self.gather(robot, &parameters, snapshot, sight);
        self.filter(robot, wished, motion, formation.limits(robot))
    }

    /// Turns what a robot senses into barriers.
    fn gather(
        &mut self,
        robot: usize,
        parameters: &Parameters,
        snapshot: &Snapshot,
        sight: Option<(usize, f64)>,
    ) {
        let Self { config, sensors, workspace, .. } = self;
        let Workspace { near, collisions, views, .. } = workspace;
        let motion = &snapshot.robots[robot].motion;
        let body = &config.proximity.robots[robot].body;
        let own = placed(motion, body);
        let from = own.point_ahead(parameters);
        config.proximity.sense(&mut sensors[robot], robot, from, snapshot, near);
        collisions.clear();
        views.clear();
        let things = near.iter().map(|sensed| Neighbour {
            constraint: match sensed.thing {
                EntityId::Robot(index) => Constraint::Robot(index),
                EntityId::Prop(index) => Constraint::Prop(index),
                EntityId::Ground => Constraint::Edge(0),
            },
            normal: sensed.normal,
            distance: sensed.distance,
            velocity: sensed.velocity,
        });
        let all = things.chain(barrier::edges(&own, parameters));
        collisions.extend(all.map(|neighbour| barrier::keep_apart(&own, &neighbour, parameters)));
        let Some((leader, pan)) = sight else { return };
        let seen = near.iter().find(|sensed| sensed.thing == EntityId::Robot(leader));
        // A leader beyond the sensor's range is out of these barriers' reach.
        let Some(seen) = seen else { return };
        let gap = seen.distance + config.proximity.robots[leader].body.radius();
        let velocity = own_velocity(motion);
        let sight = Sight {
            offset: [0, 1].map(|k| from[k] - gap * seen.normal[k] - [motion.pose.x, motion.pose.y][k]),
            velocity: [0, 1].map(|k| seen.velocity[k] - velocity[k]),
            pan,
            pan_max: config.pan_max,
            pan_rate: config.pan_rate,
        };
        views.extend(barrier::keep_in_view(&own, &sight, parameters));
    }

    /// The command that the barriers leave; what was done goes into the states.
    fn filter(&mut self, robot: usize, command: Command, motion: &Motion, limits: &Limits) -> Command {
        let bounds = self.bounds(robot, motion.speed, limits);
        let wish = Wish {
            command: Command {
                acceleration: command.acceleration.clamp(bounds[0], bounds[1]),
                turn_rate: command.turn_rate,
            },
            acceleration: bounds,
            turn_rate: limits.turn_rate_at(motion.speed.max(limits.speed_min)),
            speed: motion.speed,
        };
        if self.states.len() <= self.count {
            self.states.push(SafetyState::default());
        }
        let state = &mut self.states[self.count];
        self.count += 1;
        state.robot = robot;
        let Workspace { filter, collisions, views, .. } = &mut self.workspace;
        filter.apply(&wish, collisions, views, state);
        // Limits alone leave the command as it was decided: speeds meet their bounds at an instant of their own.
        if state.moved > 0.0 { state.applied } else { command }
    }

    /// [least, most] acceleration, m/s²: a unicycle has its speed within bounds at the next sample.
    fn bounds(&self, robot: usize, speed: f64, limits: &Limits) -> [f64; 2] {
        let most = limits.acceleration_max.min(MOST_ACCELERATION);
        if self.config.wheels[robot] {
            return [-most, most];
        }
        let to = |bound: f64| ((bound - speed) / self.period).clamp(-most, most);
        let [least, most] = [to(limits.speed_min), to(limits.speed_max)];
        [least.min(most), most]
    }
}

/// A robot as its barriers take it.
fn placed(motion: &Motion, body: &Body) -> Placed {
    Placed { pose: motion.pose, speed: motion.speed, middle: 0.5 * body.wheelbase, radius: body.radius() }
}

/// Whether a circle is within [x from, y from, x to, y to], m.
fn within([x0, y0, x1, y1]: [f64; 4], [x, y]: [f64; 2], radius: f64) -> bool {
    (x0 + radius..=x1 - radius).contains(&x) && (y0 + radius..=y1 - radius).contains(&y)
}

/// m/s.
fn own_velocity(motion: &Motion) -> [f64; 2] {
    let (sin, cos) = vocabulary::math::sin_cos(motion.pose.heading);
    [motion.speed * cos, motion.speed * sin]
}
