//! The data of a run behind its figures: motions of robots, states of edges, and efforts.

use crate::effort::{CommandEffort, EffortSums};
use figures::Rgb;
use metrics::{Digest, Metrics, MetricsBuilder};
use scene::Scene;
use simulation::Simulation;
use vocabulary::math;
use vocabulary::{Command, Edge, FleetInfo, Motion, Pose, StepRecord, wrap};

/// One edge at one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeRow {
    /// Set point minus truth, [m, rad].
    pub error: [f64; 2],
    /// Command before limits.
    pub asked: Command,
    /// Applied command.
    pub applied: Command,
    /// Rates of [distance, bearing] as the law knew them, [m/s, rad/s].
    pub estimated: [f64; 2],
    /// The true ones: of unicycles by eqs 6-7, on wheels by differences.
    pub rates: [f64; 2],
    /// Set point: [distance in m, bearing in rad].
    pub set_point: [f64; 2],
}

/// A run, from its first sample to its last.
#[derive(Clone)]
pub struct Trace {
    /// What it is called in tables, such as `line, OFB, ε = 0.001 s`.
    pub name: String,
    /// The scene that ran.
    pub scene: Scene,
    /// Names, bodies, edges.
    pub fleet: FleetInfo,
    /// Colour of every robot.
    pub colours: Vec<Rgb>,
    /// s, of every sample kept.
    pub times: Vec<f64>,
    /// Samples by robot.
    pub robots: Vec<Vec<Motion>>,
    /// Samples by edge.
    pub edges: Vec<Vec<EdgeRow>>,
    /// Whom the follower of each edge follows, by sample kept; empty where that never changes.
    leaders: Vec<Vec<Option<usize>>>,
    /// Errors of the whole run; the late ones count from [`Trace::late_from`].
    pub metrics: Metrics,
    /// Commands, by edge.
    pub efforts: Vec<CommandEffort>,
    /// Digest of the trajectory.
    pub digest: String,
}

/// Samples times robots that are kept at most; longer runs are kept every so often.
const MOST_ROWS: u64 = 4_000_000;

impl Trace {
    /// Time from which errors count as settled ones, s.
    pub fn late_from(&self) -> f64 {
        self.scene.judging().settled_after
    }

    /// Index of the sample at or after `time`, the last one after the end.
    pub fn sample_at(&self, time: f64) -> usize {
        let after = self.times.partition_point(|t| *t < time - 1e-9);
        after.min(self.times.len().saturating_sub(1))
    }

    /// Whether the follower of an edge follows at the end.
    pub fn follows(&self, edge: usize) -> bool {
        self.metrics.edges.get(edge).is_some_and(|edge| edge.ended.is_none())
    }

    /// Settled ‖e‖ of an edge: root mean square from [`Trace::late_from`] on, m and rad taken together.
    pub fn settled(&self, edge: usize) -> Option<f64> {
        let [distance, bearing] = self.metrics.edges.get(edge)?.late_rms_error;
        Some(math::hypot(distance, bearing))
    }

    /// √∫‖e‖² dt of an edge over the whole run, m and rad taken together.
    pub fn over_the_run(&self, edge: usize) -> Option<f64> {
        let [distance, bearing] = self.metrics.edges.get(edge)?.ise;
        Some((distance + bearing).sqrt())
    }

    /// Who follows whom at a kept sample: number and robots of every edge.
    pub(crate) fn pairs(&self, sample: usize) -> impl Iterator<Item = (usize, Edge)> {
        let leaders = self.leaders.get(sample);
        self.fleet.edges.iter().enumerate().filter_map(move |(index, edge)| match leaders {
            None => Some((index, *edge)),
            Some(leaders) => Some((index, Edge { leader: (*leaders.get(index)?)?, ..*edge })),
        })
    }

    /// Pose of a robot at a kept sample.
    pub(crate) fn pose(&self, robot: usize, sample: usize) -> Option<Pose> {
        Some(self.robots.get(robot)?.get(sample)?.pose)
    }

    /// The first robot that leads, or the first of all.
    pub(crate) fn guide(&self) -> usize {
        self.fleet.robots.iter().position(|member| member.leads).unwrap_or(0)
    }

    /// The colour of a robot.
    pub(crate) fn robot_colour(&self, robot: usize) -> Rgb {
        self.colours.get(robot).copied().unwrap_or_default()
    }

    /// Name of an edge's follower.
    pub fn follower(&self, edge: usize) -> &str {
        let robot = self.fleet.edges.get(edge).and_then(|edge| self.fleet.robots.get(edge.follower));
        robot.map_or("", |member| &member.name)
    }

    /// The follower's colour.
    pub(crate) fn colour(&self, edge: usize) -> Rgb {
        self.fleet.edges.get(edge).map_or_else(Rgb::default, |edge| self.robot_colour(edge.follower))
    }
}

/// Builds a [`Trace`] from records.
pub struct Tracer {
    trace: Trace,
    metrics: MetricsBuilder,
    efforts: Vec<EffortSums>,
    digest: Digest,
    every: u64,
    sample: u64,
}

impl Tracer {
    /// For a run of `scene`; its robots have these colours, and its commands count as those of the transient until
    /// `transient` s.
    pub fn new(
        name: impl Into<String>,
        scene: &Scene,
        simulation: &Simulation,
        colours: &[Rgb],
        transient: f64,
    ) -> Self {
        let fleet = simulation.fleet().clone();
        let (robots, edges) = (fleet.robots.len(), fleet.edges.len());
        let metrics = MetricsBuilder::new(&fleet, scene.judging());
        Self {
            every: (simulation.len() * robots as u64).div_ceil(MOST_ROWS).max(1),
            sample: 0,
            efforts: vec![EffortSums::until(transient); edges],
            digest: Digest::default(),
            trace: Trace {
                name: name.into(),
                scene: scene.clone(),
                colours: colours.to_vec(),
                times: vec![],
                robots: vec![vec![]; robots],
                edges: vec![vec![]; edges],
                leaders: vec![],
                metrics: metrics.finish(),
                efforts: vec![],
                digest: String::new(),
                fleet,
            },
            metrics,
        }
    }

    /// Adds a moment.
    pub fn push(&mut self, record: &StepRecord) {
        let time = record.snapshot.time;
        self.metrics.push(record);
        self.digest.push(record);
        for (sums, edge) in self.efforts.iter_mut().zip(&record.edges) {
            sums.push(time, edge.asked, edge.applied);
        }
        if self.sample.is_multiple_of(self.every) {
            self.keep(record);
        }
        self.sample += 1;
    }

    fn keep(&mut self, record: &StepRecord) {
        let robots = &record.snapshot.robots;
        self.trace.times.push(record.snapshot.time);
        for (kept, robot) in self.trace.robots.iter_mut().zip(robots) {
            kept.push(robot.motion);
        }
        let Self { trace, .. } = self;
        if !record.leaders.is_empty() {
            trace.leaders.push(record.leaders.clone());
        }
        for (index, (kept, state)) in trace.edges.iter_mut().zip(&record.edges).enumerate() {
            let edge = record.edge(&trace.fleet, index).unwrap_or(trace.fleet.edges[index]);
            kept.push(EdgeRow {
                error: state.error,
                asked: state.asked,
                applied: state.applied,
                estimated: state.rates,
                rates: rates(edge, |robot| robots.get(robot).map(|r| r.motion)),
                set_point: state.set_point,
            });
        }
    }

    /// The trace of the run so far.
    pub fn finish(mut self) -> Trace {
        self.trace.metrics = self.metrics.finish();
        self.trace.efforts = self.efforts.iter().map(|effort| effort.sums).collect();
        self.trace.digest = self.digest.text();
        // Wheels slip sideways, and what a heading and a speed say is not all of the motion.
        if self.trace.scene.robots.iter().any(|robot| robot.vehicle.kind.has_wheels()) {
            let times = &self.trace.times;
            self.trace.edges.iter_mut().for_each(|rows| differences(times, rows));
        }
        self.trace
    }
}

/// Puts central differences in the place of the true rates.
fn differences(times: &[f64], rows: &mut [EdgeRow]) {
    let last = rows.len().saturating_sub(1);
    let slope = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
        let step = (times[b] - times[a]).max(1e-12);
        let place = |row: &EdgeRow, channel: usize| row.set_point[channel] - row.error[channel];
        let [distance, bearing] = [0, 1].map(|channel| place(&rows[b], channel) - place(&rows[a], channel));
        [distance / step, wrap(bearing) / step]
    };
    let slopes: Vec<[f64; 2]> = (0..rows.len().min(times.len())).map(slope).collect();
    rows.iter_mut().zip(slopes).for_each(|(row, slope)| row.rates = slope);
}

/// Rates of distance and bearing of a follower from how both move (eqs 6-7), [m/s, rad/s].
fn rates(edge: Edge, motion: impl Fn(usize) -> Option<Motion>) -> [f64; 2] {
    let (Some(leader), Some(follower)) = (motion(edge.leader), motion(edge.follower)) else {
        return [0.0; 2];
    };
    let velocity = |m: &Motion| [m.speed * math::cos(m.pose.heading), m.speed * math::sin(m.pose.heading)];
    let (v, w) = (velocity(&follower), velocity(&leader));
    let apart = [follower.pose.x - leader.pose.x, follower.pose.y - leader.pose.y];
    let moving = [v[0] - w[0], v[1] - w[1]];
    let square = apart[0] * apart[0] + apart[1] * apart[1];
    if square == 0.0 {
        return [0.0; 2];
    }
    let along = (apart[0] * moving[0] + apart[1] * moving[1]) / square.sqrt();
    [along, (apart[0] * moving[1] - apart[1] * moving[0]) / square - leader.turn_rate]
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Pose, Relative};

    #[test]
    fn differences_pass_the_turn_of_a_bearing() {
        let times = [0.0, 0.1, 0.2];
        let row = |error: [f64; 2]| EdgeRow { error, ..EdgeRow::default() };
        let mut rows = [row([-1.0, -3.1]), row([-1.1, 3.13]), row([-1.2, 3.03])];
        differences(&times, &mut rows);
        let found = rows[1].rates;
        let wanted = std::f64::consts::TAU - 6.13;
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - wanted / 0.2).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn rates_are_the_derivatives_of_distance_and_bearing() {
        let start = [
            Motion { pose: Pose::new(1.0, 2.0, 0.4), speed: 1.1, turn_rate: 0.3, ..Motion::default() },
            Motion { pose: Pose::new(-0.5, 1.0, -0.2), speed: 0.7, turn_rate: -0.6, ..Motion::default() },
        ];
        let at = |time: f64| {
            let pose = |m: &Motion| {
                let heading = m.pose.heading + m.turn_rate * time;
                let (sin, cos) = math::sin_cos(m.pose.heading + 0.5 * m.turn_rate * time);
                Pose::new(m.pose.x + m.speed * time * cos, m.pose.y + m.speed * time * sin, heading)
            };
            Relative::between(pose(&start[0]), pose(&start[1]))
        };
        let step = 1e-5;
        let (before, after) = (at(-step), at(step));
        let slope =
            [after.distance - before.distance, after.bearing - before.bearing].map(|d| d / (2.0 * step));
        let found = rates(Edge { leader: 0, follower: 1 }, |k| Some(start[k]));
        assert!((0..2).all(|k| (slope[k] - found[k]).abs() < 1e-8), "{slope:?} {found:?}");
    }
}
