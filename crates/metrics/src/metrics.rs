//! Errors, effort and clearance of a run, gathered as it goes.

use crate::certificates::CertificateMetrics;
use crate::clearance::Clearance;
use crate::contacts::{ContactLog, ContactMetrics};
use crate::measurements::{MeasurementMetrics, MeasurementSums};
use crate::plan_tracking::{PlanTrackingMetrics, PlanTrackingSums};
use crate::safety::{SafetyMetrics, SafetySums};
use crate::statistics::RootMeanSquare;
use serde::Serialize;
use vocabulary::{
    Condition, Contact, EdgeState, EntityId, FleetInfo, Judging, Motion, StepRecord, Word, math,
};

/// `metrics.json`. Every pair is [distance, bearing] or [acceleration, turn rate].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Metrics {
    /// Time of the last sample, s.
    pub duration: f64,
    /// Per edge.
    pub edges: Vec<EdgeMetrics>,
    /// Per robot.
    pub robots: Vec<RobotMetrics>,
    /// Least room between any robot and another body, m; `None` where there is no other.
    pub clearance_min: Option<f64>,
    /// When that was, s.
    pub clearance_min_time: Option<f64>,
    /// Between whom.
    pub clearance_min_robots: Option<[String; 2]>,
    /// Contacts of robots with each other, with props and with the ground.
    pub contacts: usize,
    /// Largest impulse of a contact, N s.
    pub contact_impulse_max: f64,
    /// The first contacts, in the order in which they began; all are in the table.
    pub first_contacts: Vec<ContactMetrics>,
    /// |error| under which an edge counts as settled, [m, rad].
    pub settling_band: [f64; 2],
    /// What happened to the formation, in the order of time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventSummary>,
    /// Custom laws that broke off, in the order of time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub law_faults: Vec<LawFaultMetrics>,
    /// What the theorems say of every edge, where they were checked.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub certificates: Vec<CertificateMetrics>,
}

/// One robot over a run.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct RobotMetrics {
    /// Its name.
    pub robot: String,
    /// Least room to anything else but ramps and the ground, m; `None` where there is nothing else.
    pub clearance_min: Option<f64>,
    /// To what.
    pub nearest: Option<String>,
    /// When that was, s.
    pub clearance_min_time: Option<f64>,
    /// Largest height of its ground point over the ground, m.
    pub lift_max: f64,
    /// At the end: able, overturned, stuck, fallen, failed or removed.
    pub condition: String,
    /// What its safety filter did; `None` where it had none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safety: Option<SafetyMetrics>,
    /// How well it kept to its formation's plan; `None` where it had none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan: Option<PlanTrackingMetrics>,
}

/// One edge over a run.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct EdgeMetrics {
    /// Who is followed.
    pub leader: String,
    /// Who follows.
    pub follower: String,
    /// Error at the end, [m, rad].
    pub final_error: [f64; 2],
    /// Root mean square over the run, [m, rad].
    pub rms_error: [f64; 2],
    /// Root mean square since the edge settled, [m, rad]; `None` if it did not.
    pub settled_rms_error: Option<[f64; 2]>,
    /// ∫ |e| dt, [m s, rad s].
    pub iae: [f64; 2],
    /// ∫ e² dt, [m² s, rad² s].
    pub ise: [f64; 2],
    /// Largest |error|, [m, rad].
    pub peak_error: [f64; 2],
    /// Largest |error| from a given time to the end, [m, rad].
    pub late_peak_error: [f64; 2],
    /// Root mean square from that time to the end, [m, rad].
    pub late_rms_error: [f64; 2],
    /// Time from which both errors stay within the band, s; `None` if they do not.
    pub settling_time: Option<f64>,
    /// ∫ |command applied| dt, [m/s, rad].
    pub effort: [f64; 2],
    /// Largest |estimated rate|, [m/s, rad/s]: shows peaking.
    pub peak_rates: [f64; 2],
    /// Share of the samples at which a limit cut the command.
    pub limited: f64,
    /// Samples at which the distance was below its minimum.
    pub too_close: u64,
    /// [slowest, fastest] speed of the follower, m/s.
    pub speeds: [f64; 2],
    /// [slowest, fastest] speed of the follower since it settled, m/s; `None` if it did not.
    pub settled_speeds: Option<[f64; 2]>,
    /// How it stood while its leader stood; `None` where that did not stand for long enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standing: Option<StandingMetrics>,
    /// How far it filed in; `None` where it did not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub narrowing: Option<NarrowingMetrics>,
    /// How well it saw its leader; `None` where it is told the truth.
    pub measurements: Option<MeasurementMetrics>,
    /// Since when the follower has followed nobody, s; `None` where it follows at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ended: Option<f64>,
}

/// A custom law that gave no command.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawFaultMetrics {
    /// Whose law.
    pub robot: String,
    /// s.
    pub time: f64,
    /// Number of the control sample.
    pub sample: u64,
    /// Where in its text, and why.
    pub fault: String,
}

/// Something that happened to the formation, or was refused.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventSummary {
    /// s.
    pub time: f64,
    /// Which event of the scene asked for it, counted from 0; `None` where it came of itself.
    pub event: Option<usize>,
    /// What, by the word of its kind.
    pub kind: &'static str,
    /// To which robot.
    pub robot: String,
    /// Whether it took place.
    pub happened: bool,
    /// What, in one sentence.
    pub words: String,
}

/// A follower while its leader stands, from [`STANDING_AFTER`] on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Default)]
pub struct StandingMetrics {
    /// Largest |turn rate| of the follower, rad/s.
    pub turn_rate: f64,
    /// Farthest from its set point, m.
    pub error: f64,
}

/// A follower that files in where there is no room.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Default)]
pub struct NarrowingMetrics {
    /// Largest share of the way from its set point to the column (λ), 0 to 1.
    pub largest: f64,
    /// When it left its set point, s.
    pub begin: f64,
    /// From when on it is back at it, s; `None` where it is not at the end.
    pub end: Option<f64>,
}

/// A follower is at its set point with less than this of the way to the column.
const WIDE: f64 = 0.01;

/// A leader at this speed or less stands, m/s.
const STANDING_SPEED: f64 = 0.01;
/// How long it has to have stood, s.
pub const STANDING_AFTER: f64 = 2.0;

/// Gathers [`Metrics`].
#[derive(Clone)]
pub struct MetricsBuilder {
    fleet: FleetInfo,
    judging: Judging,
    edges: Vec<EdgeSums>,
    samples: u64,
    time: f64,
    clearance: Clearance,
    contacts: ContactLog,
    lifts: Vec<f64>,
    conditions: Vec<Condition>,
    safety: Vec<SafetySums>,
    plans: Vec<PlanTrackingSums>,
    events: Vec<EventSummary>,
    law_faults: Vec<LawFaultMetrics>,
}

/// Running sums of one edge.
#[derive(Debug, Clone, Default)]
struct EdgeSums {
    /// What needs no more than the samples so far.
    metrics: EdgeMetrics,
    /// Who was followed last.
    leader: Option<usize>,
    /// Since when nobody is, s.
    ended: Option<f64>,
    last: EdgeState,
    errors: RootMeanSquare<2>,
    late_errors: RootMeanSquare<2>,
    measurements: MeasurementSums,
    limited: u64,
    /// Since when the leader has stood, s; `None` while it drives.
    stands: Option<f64>,
    /// Since the edge was last outside its band; `None` while it is.
    settled: Option<Settled>,
}

#[derive(Debug, Clone, Copy)]
struct Settled {
    since: f64,
    errors: RootMeanSquare<2>,
    speeds: [f64; 2],
}

impl MetricsBuilder {
    /// For a run of `fleet`.
    pub fn new(fleet: &FleetInfo, judging: Judging) -> Self {
        let mut edge = EdgeSums::default();
        edge.metrics.speeds = [f64::INFINITY, 0.0];
        let edges = vec![edge; fleet.edges.len()];
        Self {
            judging,
            edges,
            samples: 0,
            time: 0.0,
            clearance: Clearance::new(fleet),
            contacts: ContactLog::default(),
            lifts: vec![0.0; fleet.robots.len()],
            conditions: vec![Condition::Able; fleet.robots.len()],
            safety: vec![SafetySums::default(); fleet.robots.len()],
            plans: vec![PlanTrackingSums::default(); fleet.robots.len()],
            events: vec![],
            law_faults: vec![],
            fleet: fleet.clone(),
        }
    }

    /// Takes in a moment.
    pub fn push(&mut self, record: &StepRecord) {
        let time = record.snapshot.time;
        let step = if self.samples == 0 { 0.0 } else { time - self.time };
        for (index, state) in record.edges.iter().enumerate() {
            let sums = &mut self.edges[index];
            let Some(pair) = record.edge(&self.fleet, index) else {
                sums.ends(time);
                continue;
            };
            let (robots, edge) = (&record.snapshot.robots, state);
            let [leader, follower] = [pair.leader, pair.follower].map(|k| &robots[k].motion);
            sums.follows(pair.leader);
            sums.push(edge, follower.speed, time, step, &self.judging);
            sums.stand(edge, [leader, follower], time);
        }
        for frame in &record.frames {
            if let Some(edge) = self.edges.get_mut(frame.edge) {
                edge.measurements.add(frame);
            }
        }
        for (index, robot) in record.snapshot.robots.iter().enumerate() {
            let pose = robot.motion.pose;
            let lift = robot.attitude.height - self.fleet.surface(pose.x, pose.y).height;
            self.lifts[index] = self.lifts[index].max(lift);
            self.conditions[index] = robot.condition;
        }
        for state in &record.safety {
            if let Some(sums) = self.safety.get_mut(state.robot) {
                sums.add(time, state);
            }
        }
        PlanTrackingSums::push(&mut self.plans, record);
        for state in record.laws.iter().filter(|state| !state.fault.is_empty()) {
            self.law_faults.push(LawFaultMetrics {
                robot: self.fleet.name(EntityId::Robot(state.robot)).to_owned(),
                time,
                sample: self.samples,
                fault: state.fault.clone(),
            });
        }
        for event in &record.events {
            let words = event.words(&self.fleet);
            self.events.push(EventSummary {
                time,
                event: event.event,
                kind: event.kind.word(),
                robot: self.fleet.name(EntityId::Robot(event.robot)).to_owned(),
                happened: event.happened(),
                words,
            });
        }
        self.clearance.push(&record.snapshot);
        for contact in &record.contacts {
            self.clearance.touch(contact);
        }
        self.contacts.push(&record.contacts);
        self.samples += 1;
        self.time = time;
    }

    /// The metrics of all moments so far.
    pub fn finish(&self) -> Metrics {
        let name = |thing: EntityId| self.fleet.name(thing).to_owned();
        let robot = |index: usize| name(EntityId::Robot(index));
        let pairs = self.edges.iter().zip(&self.fleet.edges);
        let rooms = self.clearance.least().iter().enumerate();
        let least = rooms.filter_map(|(k, room)| Some((k, (*room)?)));
        let least = least.min_by(|a, b| a.1.clearance.total_cmp(&b.1.clearance));
        Metrics {
            duration: self.time,
            edges: pairs
                .map(|(s, e)| s.finish(robot(s.leader.unwrap_or(e.leader)), robot(e.follower), self.samples))
                .collect(),
            events: self.events.clone(),
            law_faults: self.law_faults.clone(),
            robots: (0..self.fleet.robots.len()).map(|k| self.robot(k)).collect(),
            clearance_min: least.map(|(_, room)| room.clearance),
            clearance_min_time: least.map(|(_, room)| room.time),
            clearance_min_robots: least.map(|(k, room)| [robot(k), name(room.nearest)]),
            contacts: self.contacts.count,
            contact_impulse_max: self.contacts.largest,
            first_contacts: self.contacts.first(&self.fleet),
            settling_band: self.judging.settling_band,
            certificates: vec![],
        }
    }

    /// The contacts that have not ended, as if they ended now.
    pub fn close_contacts(&self) -> Vec<Contact> {
        self.contacts.close()
    }

    fn robot(&self, index: usize) -> RobotMetrics {
        let room = self.clearance.least()[index];
        RobotMetrics {
            robot: self.fleet.name(EntityId::Robot(index)).to_owned(),
            clearance_min: room.map(|r| r.clearance),
            nearest: room.map(|r| self.fleet.name(r.nearest).to_owned()),
            clearance_min_time: room.map(|r| r.time),
            lift_max: self.lifts[index],
            condition: self.conditions[index].word().to_owned(),
            safety: self.safety[index].finish(&self.fleet),
            plan: self.plans[index].finish(),
        }
    }
}

impl EdgeSums {
    /// Nobody is followed.
    fn ends(&mut self, time: f64) {
        self.ended.get_or_insert(time);
        (self.settled, self.stands) = (None, None);
    }

    /// This robot is followed.
    fn follows(&mut self, leader: usize) {
        (self.leader, self.ended) = (Some(leader), None);
    }

    fn push(&mut self, edge: &EdgeState, speed: f64, time: f64, step: f64, judging: &Judging) {
        let commands = |e: &EdgeState| [e.applied.acceleration, e.applied.turn_rate];
        let (now, before, late) = (commands(edge), commands(&self.last), time >= judging.settled_after);
        let m = &mut self.metrics;
        for i in 0..2 {
            let (e, last) = (edge.error[i], self.last.error[i]);
            // Trapezoids; the first sample has no width.
            m.iae[i] += step * (e.abs() + last.abs()) / 2.0;
            m.ise[i] += step * (e * e + last * last) / 2.0;
            m.effort[i] += step * (now[i].abs() + before[i].abs()) / 2.0;
            m.peak_error[i] = m.peak_error[i].max(e.abs());
            if late {
                m.late_peak_error[i] = m.late_peak_error[i].max(e.abs());
            }
            m.peak_rates[i] = m.peak_rates[i].max(edge.rates[i].abs());
        }
        m.too_close += u64::from(edge.too_close);
        m.speeds = [m.speeds[0].min(speed), m.speeds[1].max(speed)];
        self.errors.add(edge.error);
        if late {
            self.late_errors.add(edge.error);
        }
        self.measurements.know(edge, step);
        self.narrow(edge.narrowing, time);
        self.limited += u64::from(edge.limited);
        self.settle(edge, speed, time, judging.settling_band);
        self.last = *edge;
    }

    fn stand(&mut self, edge: &EdgeState, [leader, follower]: [&Motion; 2], time: f64) {
        if leader.speed.abs() > STANDING_SPEED {
            self.stands = None;
            return;
        }
        if time - *self.stands.get_or_insert(time) < STANDING_AFTER {
            return;
        }
        // Between the two ends of the distances, an angle of the bearing's error apart.
        let ([wanted, _], [off, turned]) = (edge.set_point, edge.error);
        let (distance, chord) = (wanted - off, 2.0 * math::sin(0.5 * turned));
        let error = (off * off + wanted * distance * chord * chord).max(0.0).sqrt();
        let standing = self.metrics.standing.get_or_insert_default();
        standing.turn_rate = standing.turn_rate.max(follower.turn_rate.abs());
        standing.error = standing.error.max(error);
    }

    fn narrow(&mut self, share: f64, time: f64) {
        if share < WIDE {
            if let Some(found) = &mut self.metrics.narrowing {
                found.end.get_or_insert(time);
            }
            return;
        }
        let found = self
            .metrics
            .narrowing
            .get_or_insert(NarrowingMetrics { begin: time, ..NarrowingMetrics::default() });
        found.largest = found.largest.max(share);
        found.end = None;
    }

    fn settle(&mut self, edge: &EdgeState, speed: f64, time: f64, band: [f64; 2]) {
        // On its way to another place it has not settled.
        let away = edge.displacement > band[0];
        if away || edge.error[0].abs() > band[0] || edge.error[1].abs() > band[1] {
            self.settled = None;
            return;
        }
        let fresh = Settled { since: time, errors: RootMeanSquare::EMPTY, speeds: [f64::INFINITY, 0.0] };
        let settled = self.settled.get_or_insert(fresh);
        settled.errors.add(edge.error);
        settled.speeds = [settled.speeds[0].min(speed), settled.speeds[1].max(speed)];
    }

    fn finish(&self, leader: String, follower: String, samples: u64) -> EdgeMetrics {
        EdgeMetrics {
            leader,
            follower,
            final_error: self.last.error,
            rms_error: self.errors.root().unwrap_or_default(),
            settled_rms_error: self.settled.and_then(|settled| settled.errors.root()),
            late_rms_error: self.late_errors.root().unwrap_or_default(),
            settling_time: self.settled.map(|s| s.since),
            limited: self.limited as f64 / samples.max(1) as f64,
            settled_speeds: self.settled.map(|s| s.speeds),
            measurements: self.measurements.finish(),
            ended: self.ended,
            ..self.metrics.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Edge, Pose, RobotInfo, RobotState, Snapshot};

    /// An error that falls by e^(−t) on an edge of two robots 1 m apart at the start.
    fn run() -> Metrics {
        let member = |name: &str| RobotInfo::new(name, name == "a", vocabulary::Body::default());
        let edges = vec![Edge { leader: 0, follower: 1 }];
        let fleet = FleetInfo { robots: vec![member("a"), member("b")], edges, ..FleetInfo::default() };
        let mut builder =
            MetricsBuilder::new(&fleet, Judging { settling_band: [0.1, 0.1], settled_after: 1.0 });
        for k in 0..=1000 {
            let time = f64::from(k) * 0.01;
            let mut robots = vec![RobotState::default(); 2];
            robots[1].motion.pose = Pose::new(-1.0 - (time - 5.0).abs(), 0.0, 0.0);
            robots[1].motion.speed = 1.0;
            let edge = EdgeState { error: [math::exp(-time), 0.0], ..EdgeState::default() };
            builder.push(&StepRecord {
                snapshot: Snapshot { time, robots, props: vec![] },
                edges: vec![edge],
                ..StepRecord::default()
            });
        }
        builder.finish()
    }

    #[test]
    fn integrals_and_settling_of_an_exponential() {
        let metrics = run();
        let edge = &metrics.edges[0];
        assert!((edge.iae[0] - 1.0).abs() < 1e-4 && (edge.ise[0] - 0.5).abs() < 1e-4);
        assert!((edge.final_error[0] - math::exp(-10.0_f64)).abs() < 1e-12);
        assert_eq!(edge.peak_error[0], 1.0);
        let settling = edge.settling_time.expect("it settles");
        assert!((settling - math::ln(10.0_f64)).abs() < 0.011, "{settling}");
        assert_eq!(edge.settled_speeds, Some([1.0, 1.0]));
    }

    #[test]
    fn clearance_is_least_when_they_are_closest() {
        let metrics = run();
        let length = vocabulary::Body::default().length;
        assert!((metrics.clearance_min.expect("two robots") - (1.0 - length)).abs() < 1e-12);
        assert!((metrics.clearance_min_time.expect("a time") - 5.0).abs() < 1e-12);
        assert_eq!(metrics.clearance_min_robots, Some(["a".to_owned(), "b".to_owned()]));
    }

    #[test]
    fn a_follower_that_files_in_is_back_from_the_last_sample_on_at_which_it_was_not() {
        let filed = |shares: &[f64]| {
            let mut sums = EdgeSums::default();
            for (k, share) in shares.iter().enumerate() {
                sums.narrow(*share, k as f64);
            }
            sums.metrics.narrowing
        };
        assert_eq!(filed(&[0.0, 0.005, 0.0]), None);
        let found = filed(&[0.0, 0.2, 0.7, 0.0, 0.3, 0.009, 0.0]).expect("it filed in");
        assert_eq!(found, NarrowingMetrics { largest: 0.7, begin: 1.0, end: Some(5.0) });
        assert_eq!(filed(&[0.0, 0.2]).expect("it filed in").end, None);
    }

    #[test]
    fn a_follower_is_judged_at_a_stand_when_its_leader_has_stood_for_a_while() {
        let fleet = FleetInfo {
            robots: vec![RobotInfo::new("a", true, vocabulary::Body::default()); 2],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..FleetInfo::default()
        };
        let mut builder =
            MetricsBuilder::new(&fleet, Judging { settling_band: [0.1, 0.1], settled_after: 1.0 });
        for (time, leader, turn_rate) in [(0.0, 0.0, 9.0), (1.9, 0.0, 8.0), (2.0, 0.0, -0.2), (3.0, 0.1, 7.0)]
        {
            let mut robots = vec![RobotState::default(); 2];
            (robots[0].motion.speed, robots[1].motion.turn_rate) = (leader, turn_rate);
            // Wanted at [2, 0], found at [0, 1.5].
            let error = [0.5, -0.5 * std::f64::consts::PI];
            let edge = EdgeState { set_point: [2.0, 0.0], error, ..EdgeState::default() };
            let snapshot = Snapshot { time, robots, props: vec![] };
            builder.push(&StepRecord { snapshot, edges: vec![edge], ..StepRecord::default() });
        }
        let found = builder.finish().edges[0].standing.expect("it stood");
        assert_eq!(found.turn_rate, 0.2);
        assert!((found.error - 2.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn an_edge_that_leaves_its_band_has_not_settled() {
        let fleet = FleetInfo {
            robots: vec![RobotInfo::new("a", true, vocabulary::Body::default()); 2],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..FleetInfo::default()
        };
        let mut builder =
            MetricsBuilder::new(&fleet, Judging { settling_band: [0.1, 0.1], settled_after: 1.0 });
        for error in [0.0, 0.05, 0.2] {
            let edge = EdgeState { error: [0.0, error], ..EdgeState::default() };
            let snapshot = Snapshot { time: error, robots: vec![RobotState::default(); 2], props: vec![] };
            builder.push(&StepRecord { snapshot, edges: vec![edge], ..StepRecord::default() });
        }
        let metrics = builder.finish();
        assert_eq!((metrics.edges[0].settling_time, metrics.edges[0].settled_rms_error), (None, None));
        assert_eq!(metrics.clearance_min, Some(0.0));
    }
}
