//! Robots that lead by commands: they chase the motion that they shall have. Lead robots with a safety filter do, and those
//! that come to lead while a run goes.

use formation::lead::Delayed;
use std::sync::Arc;
use vocabulary::{Command, Limits, Motion, RobotInfo, Snapshot, Trajectory};
use world::{Unicycle, Unicycles, World, guide};

/// A robot and the motion that it chases.
#[derive(Debug, Clone)]
struct Chase {
    robot: usize,
    ideal: Unicycles,
}

/// All robots that chase a motion.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chases {
    chases: Vec<Chase>,
}

impl Chases {
    /// Robots that chase the motions of these from the start of the run.
    pub(crate) fn new(chased: &[(usize, Unicycle)]) -> Self {
        let chase = |(robot, ideal): &(usize, Unicycle)| Chase {
            robot: *robot,
            ideal: Unicycles::new(vec![ideal.clone()]),
        };
        Self { chases: chased.iter().map(chase).collect() }
    }

    /// A robot chases `motion` from where it is now, at `time` s.
    pub(crate) fn begin(
        &mut self,
        robot: usize,
        now: &Motion,
        limits: Limits,
        info: &RobotInfo,
        motion: Arc<dyn Trajectory>,
        time: f64,
    ) {
        self.end(robot);
        // Ideals count their time from their own start.
        let lead: Arc<dyn Trajectory> = Arc::new(Delayed { motion, by: -time });
        let ideal = Unicycle { pose: now.pose, speed: now.speed, limits, body: info.body, lead: Some(lead) };
        self.chases.push(Chase { robot, ideal: Unicycles::new(vec![ideal]) });
    }

    /// A robot chases nothing any more.
    pub(crate) fn end(&mut self, robot: usize) {
        self.chases.retain(|chase| chase.robot != robot);
    }

    /// What is chased goes on.
    pub(crate) fn advance(&mut self, period: f64) {
        self.chases.iter_mut().for_each(|chase| chase.ideal.advance(period));
    }

    /// The command of `robot`: where it chases a motion it is that of the chase, else the one that was `decided`.
    pub(crate) fn command(
        &self,
        robot: usize,
        decided: Command,
        snapshot: &Snapshot,
        info: &RobotInfo,
        limits: &Limits,
    ) -> Command {
        let Some(chase) = self.chases.iter().find(|chase| chase.robot == robot) else { return decided };
        let ideal = &chase.ideal.snapshot().robots[0].motion;
        guide::chase(ideal, &snapshot.robots[robot].motion, info.body.wheelbase, limits)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.chases.is_empty()
    }
}
