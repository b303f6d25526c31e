//! Unicycles without mass or slip (eq 1), moved exactly.
//!
//! A follower holds its command over a step: its path is an [`arc`], or two where its speed meets a bound.
//! A lead robot follows a prescribed motion: an arc, or integrated by Gauss-Legendre quadrature, whose error at
//! 1 m/s and 10 rad/s is below 1e-12 m per second.

use crate::{Handling, World, arc, prescribed::prescribed, touch::Touches};
use std::cell::RefCell;
use std::sync::Arc;
use vocabulary::{
    Body, Command, Condition, Contact, Limits, Motion, Pose, RobotState, Snapshot, StepInterpolant,
    Trajectory, math,
};

/// Parameters and start of one unicycle.
#[derive(Debug, Clone)]
pub struct Unicycle {
    /// Where it starts.
    pub pose: Pose,
    /// Its first speed, m/s; a lead robot takes it from its motion.
    pub speed: f64,
    /// Bounds on a follower's speed; its command comes within the others.
    pub limits: Limits,
    /// For the turning of its wheels.
    pub body: Body,
    /// The motion of a lead robot.
    pub lead: Option<Arc<dyn Trajectory>>,
}

/// A world of unicycles on the plane.
#[derive(Debug, Clone)]
pub struct Unicycles {
    robots: Vec<Unicycle>,
    snapshot: Snapshot,
    steps: Vec<UnicycleStep>,
    touches: Touches,
    started: f64,
    duration: f64,
}

/// How one robot moves over the current step.
#[derive(Debug, Clone, Default)]
struct UnicycleStep {
    start: Motion,
    sin: f64,
    cos: f64,
    /// When the speed meets its bound, and the motion from there.
    saturation_time: Option<(f64, Motion)>,
    end: Motion,
    /// Where a lead robot was found at an elapsed time, s: every follower asks for the same times, and an integral costs
    /// more than a search.
    found: RefCell<Vec<(f64, Motion)>>,
}

impl Unicycles {
    /// Robots at rest in time 0 at their starts.
    pub fn new(robots: Vec<Unicycle>) -> Self {
        let state = |robot: &Unicycle| {
            let drive = robot.lead.as_ref().map(|lead| lead.at(0.0));
            let (speed, turn_rate) = drive.map_or((robot.speed, 0.0), |d| (d.speed, d.turn_rate));
            let motion = Motion { pose: robot.pose, speed, acceleration: 0.0, turn_rate };
            RobotState { motion, ..RobotState::default() }
        };
        let snapshot = Snapshot { time: 0.0, robots: robots.iter().map(state).collect(), props: vec![] };
        let steps = vec![UnicycleStep::default(); robots.len()];
        Self { robots, snapshot, steps, touches: Touches::default(), started: 0.0, duration: 0.0 }
    }

    /// Sets every robot's motion at `time`, as integrated elsewhere (continuous time); wheels roll along.
    pub fn place(&mut self, time: f64, motions: &[Motion]) {
        let elapsed = time - self.snapshot.time;
        for ((state, robot), motion) in self.snapshot.robots.iter_mut().zip(&self.robots).zip(motions) {
            let mean_speed = f64::midpoint(state.motion.speed, motion.speed);
            roll(state, &robot.body, mean_speed * elapsed, motion);
        }
        self.snapshot.time = time;
        self.touch();
    }

    /// As [`World::advance`], but looks at no contacts.
    pub(crate) fn move_on(&mut self, duration: f64) {
        self.started = self.snapshot.time;
        self.duration = duration;
        for (index, robot) in self.robots.iter().enumerate() {
            let mut found = std::mem::take(&mut self.steps[index].found);
            found.get_mut().clear();
            let start = &self.snapshot.robots[index].motion;
            self.steps[index] = UnicycleStep { found, ..UnicycleStep::begin(start, robot, duration) };
        }
        for index in 0..self.robots.len() {
            let end = self.motion_of(index, duration);
            self.steps[index].end = end;
            let travelled = self.steps[index].travelled(duration);
            roll(&mut self.snapshot.robots[index], &self.robots[index].body, travelled, &end);
        }
        self.snapshot.time += duration;
    }

    /// Finds the bodies that touch: unicycles without mass drive through each other, but it is told.
    fn touch(&mut self) {
        let body = |index: usize| &self.robots[index].body;
        self.touches.find(&self.snapshot, body);
    }

    fn motion_of(&self, robot: usize, elapsed: f64) -> Motion {
        let step = &self.steps[robot];
        match (&self.robots[robot].lead, step.saturation_time) {
            (Some(lead), _) => {
                step.found(elapsed, || prescribed(lead.as_ref(), step.start.pose, self.started, elapsed))
            }
            (None, Some((saturation_time, after))) if elapsed > saturation_time => {
                arc::after(&after, elapsed - saturation_time)
            }
            (None, _) => arc::after_with(&step.start, step.sin, step.cos, elapsed),
        }
    }
}

impl World for Unicycles {
    fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    fn apply(&mut self, commands: &[Command]) {
        for ((state, robot), command) in self.snapshot.robots.iter_mut().zip(&self.robots).zip(commands) {
            let motion = &mut state.motion;
            motion.turn_rate = command.turn_rate;
            motion.acceleration = match robot.lead {
                Some(_) => command.acceleration,
                None => robot.limits.admissible(command.acceleration, motion.speed),
            };
        }
    }

    fn apply_parameters(&mut self, handling: &[Handling]) {
        for ((state, robot), now) in self.snapshot.robots.iter_mut().zip(&mut self.robots).zip(handling) {
            robot.limits = now.limits;
            if robot.lead.is_none() {
                state.motion.speed = now.limits.clamp_speed(state.motion.speed);
            }
        }
    }

    fn release(&mut self, robot: usize) {
        let (unicycle, state) = (&mut self.robots[robot], &mut self.snapshot.robots[robot]);
        unicycle.lead = None;
        state.motion.speed = unicycle.limits.clamp_speed(state.motion.speed);
    }

    fn fail(&mut self, robot: usize, removed: bool) {
        self.release(robot);
        let state = &mut self.snapshot.robots[robot];
        state.condition = if removed { Condition::Removed } else { Condition::Failed };
        if removed {
            state.motion = Motion { pose: state.motion.pose, ..Motion::default() };
        }
    }

    fn advance(&mut self, duration: f64) {
        self.move_on(duration);
        self.touch();
    }

    fn contacts(&self) -> &[Contact] {
        self.touches.contacts()
    }

    fn save(&self) -> Box<dyn World> {
        Box::new(self.clone())
    }
}
impl StepInterpolant for Unicycles {
    fn duration(&self) -> f64 {
        self.duration
    }

    fn during(&self, robot: usize, elapsed: f64) -> Motion {
        // Observers ask for both ends of every step.
        let step = &self.steps[robot];
        if elapsed == self.duration {
            step.end
        } else if elapsed == 0.0 && self.robots[robot].lead.is_none() {
            step.start
        } else {
            self.motion_of(robot, elapsed)
        }
    }

    fn saturation_time(&self, robot: usize) -> Option<f64> {
        self.steps[robot].saturation_time.map(|(time, _)| time)
    }
}

/// Elapsed times that are kept: the nodes of a track, its middle, and the ends.
const FOUND: usize = 12;

impl UnicycleStep {
    fn begin(start: &Motion, robot: &Unicycle, duration: f64) -> Self {
        let (sin, cos) = math::sin_cos(start.pose.heading);
        let mut step = Self { start: *start, sin, cos, ..Self::default() };
        if robot.lead.is_some() || start.acceleration == 0.0 {
            return step;
        }
        let bound = if start.acceleration > 0.0 { robot.limits.speed_max } else { robot.limits.speed_min };
        let reach = (bound - start.speed) / start.acceleration;
        if reach < duration {
            let met = arc::after_with(start, sin, cos, reach.max(0.0));
            step.saturation_time = Some((reach.max(0.0), Motion { speed: bound, acceleration: 0.0, ..met }));
        }
        step
    }

    /// The motion after `elapsed` s, computed once.
    fn found(&self, elapsed: f64, motion: impl FnOnce() -> Motion) -> Motion {
        let mut found = self.found.borrow_mut();
        if let Some((_, motion)) = found.iter().find(|(at, _)| *at == elapsed) {
            return *motion;
        }
        let motion = motion();
        if found.len() < FOUND {
            found.push((elapsed, motion));
        }
        motion
    }

    /// Path length after `elapsed` s, m; for a lead robot to first order in its acceleration.
    fn travelled(&self, elapsed: f64) -> f64 {
        let run = |motion: &Motion, t: f64| t * (motion.speed + motion.acceleration * t / 2.0);
        match self.saturation_time {
            Some((saturation_time, after)) if elapsed > saturation_time => {
                run(&self.start, saturation_time) + run(&after, elapsed - saturation_time)
            }
            _ => run(&self.start, elapsed),
        }
    }
}

/// Steepest steering angle that is drawn, rad: a unicycle can turn on the spot, front wheels can not show it.
const STEERING_MAX: f64 = 0.6;

fn roll(state: &mut RobotState, body: &Body, travelled: f64, end: &Motion) {
    state.motion = *end;
    let steering =
        math::atan2(body.wheelbase * end.turn_rate, end.speed.abs()).clamp(-STEERING_MAX, STEERING_MAX);
    for (index, wheel) in state.wheels.iter_mut().enumerate() {
        wheel.rotation += travelled / body.wheel_radius;
        wheel.steering = if index < 2 { steering } else { 0.0 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{MotionInput, wrap};

    const LIMITS: Limits = Limits::PAPER;

    #[derive(Debug)]
    struct Swing;

    impl Trajectory for Swing {
        fn at(&self, t: f64) -> MotionInput {
            MotionInput {
                speed: 1.0 + 0.5 * math::sin(3.0 * t),
                acceleration: 1.5 * math::cos(3.0 * t),
                turn_rate: 8.0 * math::cos(2.0 * t),
                turn_acceleration: -16.0 * math::sin(2.0 * t),
            }
        }
    }

    fn robot(speed: f64, lead: Option<Arc<dyn Trajectory>>) -> Unicycle {
        Unicycle { pose: Pose::new(0.0, 0.0, 0.3), speed, limits: LIMITS, body: Body::default(), lead }
    }

    /// θ is known in closed form; the path is checked against steps a hundred times finer.
    #[test]
    fn a_prescribed_motion_is_integrated_to_nano_metres() {
        let run = |step: f64| {
            let mut world = Unicycles::new(vec![robot(0.0, Some(Arc::new(Swing)))]);
            let mut time = 0.0;
            while time < 5.0 - 1e-9 {
                world.advance(step);
                time += step;
            }
            world.snapshot().robots[0].motion
        };
        let (coarse, fine) = (run(0.01), run(1e-4));
        assert!(math::hypot(coarse.pose.x - fine.pose.x, coarse.pose.y - fine.pose.y) < 1e-9);
        let heading = wrap(0.3 + 4.0 * math::sin(10.0_f64));
        assert!((coarse.pose.heading - heading).abs() < 1e-9);
    }

    #[test]
    fn a_speed_stops_at_its_bound_within_a_step() {
        let mut world = Unicycles::new(vec![robot(1.5, None)]);
        world.apply(&[Command { acceleration: 20.0, turn_rate: 1.0 }]);
        world.advance(0.01);
        let saturation_time = world.saturation_time(0).expect("the bound is met");
        assert!((saturation_time - 0.005).abs() < 1e-12);
        assert_eq!(world.snapshot().robots[0].motion.speed, 1.6);
        assert_eq!(world.during(0, 0.008).acceleration, 0.0);
        assert!((world.during(0, 0.002).speed - 1.54).abs() < 1e-12);
        let end = world.during(0, 0.01);
        assert_eq!(end.pose, world.snapshot().robots[0].motion.pose);
    }

    #[test]
    fn outward_at_a_bound_nothing_happens() {
        let mut world = Unicycles::new(vec![robot(0.01, None)]);
        world.apply(&[Command { acceleration: -5.0, turn_rate: 0.0 }]);
        assert_eq!(world.snapshot().robots[0].motion.acceleration, 0.0);
        world.advance(0.01);
        assert_eq!((world.saturation_time(0), world.snapshot().robots[0].motion.speed), (None, 0.01));
    }

    #[test]
    fn wheels_roll_as_far_as_the_robot_drives() {
        let mut world = Unicycles::new(vec![robot(1.0, None)]);
        world.apply(&[Command::default()]);
        world.advance(0.9);
        let wheel = world.snapshot().robots[0].wheels[2];
        assert!((wheel.rotation * Body::default().wheel_radius - 0.9).abs() < 1e-12);
    }

    #[test]
    fn any_finite_command_leaves_a_finite_world() {
        for command in [f64::MAX, -1e6, 1e6, f64::MIN_POSITIVE] {
            let mut world = Unicycles::new(vec![robot(1.0, None)]);
            let cut = LIMITS.saturate(Command { acceleration: command, turn_rate: command }, 1.0);
            for _ in 0..10 {
                world.apply(&[cut]);
                world.advance(0.01);
            }
            let motion = world.snapshot().robots[0].motion;
            assert!(motion.pose.x.is_finite() && motion.pose.heading.is_finite(), "{command}: {motion:?}");
            assert!((LIMITS.speed_min..=LIMITS.speed_max).contains(&motion.speed));
        }
    }
}
