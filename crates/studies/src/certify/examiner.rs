//! Goes along with a run and certifies its edges.

use crate::certify::measured::MeasuredTracking;
use formation::certificate::{
    Circumstances, Constants, Instant, Premise, Statement, StatementFinding, StatementOutcome, Witness,
    certify,
};
use formation::{Custom, EdgeLaw, Estimate, SetPointTrajectory, Switching};
use metrics::{CertificateMetrics, LawFaultMetrics, StatementMetrics};
use scene::Scene;
use simulation::Simulation;
use vocabulary::{Edge, FleetInfo, LawKind, Motion, MotionInput, MotionPhase, StepRecord, TimeMode, Word};

/// A change of a held command below this is rounding, m/s² or rad/s.
const STEADY: f64 = 1e-9;

/// What is known of one edge over a stretch of a run in which its law stayed the same.
#[derive(Debug, Clone)]
pub struct Certificate {
    /// Index of the edge.
    pub edge: usize,
    /// Who follows whom in it.
    pub pair: Edge,
    /// First and last sample, s.
    pub span: [f64; 2],
    /// All statements of the paper.
    pub findings: Vec<StatementFinding>,
    /// Constants of section 4.3; `None` unless the law is output feedback.
    pub constants: Option<Constants>,
    /// What it is made of.
    pub witness: Witness,
    /// Error at the end of the stretch, [m, rad].
    pub final_error: [f64; 2],
    /// What tanh in place of sign leaves of the error where the leader goes on as at the end of the stretch, [m, rad]:
    /// k² e + β tanh(slope e) = g_v V_i; `None` for other laws.
    pub smoothing: Option<[f64; 2]>,
    /// Whether a custom law takes the place of the paper's, of which alone the statements speak.
    pub custom: bool,
    /// Why the custom law broke off, and when, if it did.
    pub fault: Option<LawFaultMetrics>,
    /// What holds for any law.
    pub measured: MeasuredTracking,
}

impl Certificate {
    /// The finding about a statement.
    pub fn finding(&self, statement: Statement) -> Option<&StatementFinding> {
        self.findings.iter().find(|finding| finding.statement == statement)
    }

    /// The certificate as `metrics.json` holds it.
    pub fn metrics(&self, fleet: &FleetInfo) -> CertificateMetrics {
        let [leader, follower] = fleet.pair(self.pair);
        let statement = |finding: &StatementFinding| StatementMetrics {
            statement: finding.statement.word().to_owned(),
            source: finding.statement.source().to_owned(),
            outcome: finding.outcome().name().to_owned(),
            against_from: finding.against.map(|against| against.first),
            against_to: finding.against.map(|against| against.last),
            margin: finding.margin.filter(|margin| margin.is_finite()),
            unmet: finding.unmet.iter().map(Premise::words).collect(),
        };
        let finite = |value: f64| Some(value).filter(|v| v.is_finite());
        CertificateMetrics {
            leader: leader.to_owned(),
            follower: follower.to_owned(),
            span: self.span,
            statements: self.findings.iter().map(statement).collect(),
            ultimate_error: self.constants.and_then(|c| finite(c.error)),
            epsilon_1: self.constants.and_then(|c| finite(c.epsilon_1)),
        }
    }

    /// Whether every statement holds or is not claimed, and the law gave its commands to the end.
    pub fn unbroken(&self) -> bool {
        self.fault.is_none()
            && !self.findings.iter().any(|finding| matches!(finding.outcome(), StatementOutcome::Violated(_)))
    }
}

/// Goes along with a run.
pub struct Examiner {
    edges: Vec<CertifiedStretch>,
    /// Stretches that are over.
    closed: Vec<Certificate>,
    /// Lead robots that do not drive exactly as their path says: on wheels, or with a safety filter.
    chasing: Vec<bool>,
    wheels: Vec<bool>,
    /// Robots with several leaders.
    several: Vec<bool>,
    mode: TimeMode,
    period: f64,
    last: Vec<MotionInput>,
    keeps: bool,
}

/// An edge since its law last changed.
struct CertifiedStretch {
    witness: Witness,
    set_point: SetPointTrajectory,
    measures: bool,
    custom: Option<Custom>,
    fault: Option<LawFaultMetrics>,
    /// Whether the law is one of the paper's.
    built_in: bool,
    measured: MeasuredTracking,
    rough_leader: Option<f64>,
    /// Of the bearing's set point, rad/s, where it moves with a path's heading.
    last_rate: Option<f64>,
    final_error: [f64; 2],
    leader: usize,
    /// Its follower follows nobody any more.
    over: bool,
}

impl CertifiedStretch {
    fn of(law: &EdgeLaw, leader: usize, keeps: bool) -> Self {
        let witness = Witness::new(law.law, law.observer);
        Self {
            witness: if keeps { witness.keeping() } else { witness },
            set_point: law.set_point.clone(),
            measures: law.tracker.is_some(),
            custom: law.custom.clone(),
            fault: None,
            built_in: law.is_built_in(),
            measured: MeasuredTracking::default(),
            rough_leader: None,
            last_rate: None,
            final_error: [0.0; 2],
            leader,
            over: false,
        }
    }

    fn fits(&self, law: &EdgeLaw, leader: usize) -> bool {
        self.witness.law == law.law
            && self.leader == leader
            && !self.over
            && self.witness.observer == law.observer
            && self.set_point == law.set_point
            && self.measures == law.tracker.is_some()
            && self.custom == law.custom
            && self.built_in == law.is_built_in()
    }
}

impl Examiner {
    /// For a run of `scene` that has not begun. Where it `keeps`, every sample stays in the witness of its certificate;
    /// else its memory does not grow with the run.
    pub fn new(scene: &Scene, simulation: &Simulation, keeps: bool) -> Self {
        let wheels: Vec<bool> = scene.robots.iter().map(|robot| robot.vehicle.kind.has_wheels()).collect();
        let chasing = scene
            .robots
            .iter()
            .zip(&wheels)
            .map(|(robot, wheels)| robot.role.follow().is_none() && (*wheels || robot.safety.acts(true)));
        Self {
            edges: simulation
                .formation()
                .laws()
                .iter()
                .zip(simulation.formation().edges())
                .map(|(law, edge)| CertifiedStretch::of(law, edge.leader, keeps))
                .collect(),
            closed: Vec::new(),
            chasing: chasing.collect(),
            wheels,
            several: simulation.fleet().several_leaders(),
            mode: simulation.mode(),
            period: simulation.period(),
            last: Vec::new(),
            keeps,
        }
    }

    /// Takes in the moment that `simulation` has just come to.
    pub fn push(&mut self, simulation: &Simulation) {
        let (record, formation) = (simulation.record(), simulation.formation());
        let drives = self.drives(simulation, record);
        for (index, (edge, law)) in formation.edges().iter().zip(formation.laws()).enumerate() {
            if !formation.graph().is_in_force(index) {
                self.edges[index].over = true;
                continue;
            }
            if !self.edges[index].fits(law, edge.leader) {
                let next = CertifiedStretch::of(law, edge.leader, self.keeps);
                let over = std::mem::replace(&mut self.edges[index], next);
                if over.witness.span().is_some() {
                    self.closed.push(self.certificate(index, *edge, &over));
                }
            }
            let rough = self.jumps(simulation, *edge, &drives).then_some(record.snapshot.time);
            let stretch = &mut self.edges[index];
            stretch.rough_leader = stretch.rough_leader.or(rough);
            stretch.final_error = record.edges[index].error;
            let speed = record.snapshot.robots[edge.follower].motion.speed;
            stretch.measured.push(&record.edges[index], speed, self.period);
            stretch.fault = stretch.fault.take().or_else(|| fault(simulation, edge.follower));
            let mut now = instant(simulation, index, *edge, law, &drives);
            if law.law.heading.filter().is_some() {
                let change = |before: f64, now: f64| (now - before) / self.period;
                let rate = now.set_point.rate[1];
                let before = stretch.last_rate.replace(rate).unwrap_or(rate);
                now.untold[1] = change(before, rate) - now.set_point.acceleration[1];
            }
            stretch.witness.push(&now);
        }
        self.last = drives;
    }

    /// The certificates of all edges, in their order, and of each stretch by stretch.
    pub fn finish(mut self, simulation: &Simulation) -> Vec<Certificate> {
        let mut all = std::mem::take(&mut self.closed);
        for (index, (edge, stretch)) in simulation.formation().edges().iter().zip(&self.edges).enumerate() {
            if stretch.witness.span().is_some() {
                all.push(self.certificate(index, *edge, stretch));
            }
        }
        all.sort_by_key(|certificate| certificate.edge);
        all
    }

    /// The certificate of an edge as things are; `None` before the first sample.
    pub fn so_far(&self, simulation: &Simulation, edge: usize) -> Option<Certificate> {
        let stretch = self.edges.get(edge).filter(|stretch| stretch.witness.span().is_some())?;
        Some(self.certificate(edge, *simulation.formation().edges().get(edge)?, stretch))
    }

    fn certificate(&self, index: usize, edge: Edge, stretch: &CertifiedStretch) -> Certificate {
        let witness = &stretch.witness;
        let wheels = |robot: usize| self.wheels.get(robot).copied().unwrap_or(false);
        let several = self.several.get(edge.follower).copied().unwrap_or(false);
        let circumstances = Circumstances {
            held: (self.mode != TimeMode::Continuous).then_some(self.period),
            sampled_measurement: self.mode == TimeMode::Measured,
            measures: stretch.measures,
            custom: !stretch.built_in,
            wheels: wheels(edge.leader) || wheels(edge.follower),
            several_leaders: several,
            rough_leader: stretch.rough_leader,
        };
        let law = &witness.law;
        let effect = witness.last_effect();
        let custom = !stretch.built_in;
        let smoothed =
            !custom && law.kind != LawKind::FullState && matches!(law.switching, Switching::Tanh(_));
        Certificate {
            edge: index,
            pair: Edge { leader: stretch.leader, ..edge },
            span: witness.span().unwrap_or_default(),
            findings: certify(witness, &circumstances),
            constants: Constants::of(witness)
                .filter(|_| !custom && !several && law.kind == LawKind::OutputFeedback),
            final_error: stretch.final_error,
            smoothing: smoothed
                .then(|| [0, 1].map(|i| formation::certificate::chain::residual(law, i, effect[i]))),
            witness: witness.clone(),
            custom,
            fault: stretch.fault.clone(),
            measured: stretch.measured,
        }
    }

    /// How every robot moves: what is prescribed where it is driven exactly, else what it does, and the change of its
    /// turn rate since the sample before.
    fn drives(&self, simulation: &Simulation, record: &StepRecord) -> Vec<MotionInput> {
        let motion = |(robot, state): (usize, &vocabulary::RobotState)| {
            let Motion { speed, acceleration, turn_rate, .. } = state.motion;
            let before = self.last.get(robot).map_or(turn_rate, |last| last.turn_rate);
            let turn_acceleration = (turn_rate - before) / self.period;
            MotionInput { speed, acceleration, turn_rate, turn_acceleration }
        };
        let mut drives: Vec<MotionInput> = record.snapshot.robots.iter().enumerate().map(motion).collect();
        for (robot, trajectory) in simulation.formation().leads() {
            if !self.chasing.get(*robot).copied().unwrap_or(true) {
                drives[*robot] = trajectory.at(record.snapshot.time);
            }
        }
        drives
    }

    /// Whether an edge's leader has just done what no smooth leader does: it is commanded, and its command stepped.
    fn jumps(&self, simulation: &Simulation, edge: Edge, drives: &[MotionInput]) -> bool {
        let formation = simulation.formation();
        let above = formation.graph().edge_of(edge.leader);
        let filtered = |robot: usize| simulation.record().safety.iter().any(|state| state.robot == robot);
        if above.is_none() && !filtered(edge.leader) {
            return false;
        }
        if self.mode == TimeMode::Continuous {
            let Some(above) = above else { return false };
            let (built_in, law) = (formation.laws()[above].is_built_in(), &formation.laws()[above].law);
            let sign = built_in && law.kind != LawKind::FullState && law.switching == Switching::Sign;
            return sign || simulation.record().edges[above].limited;
        }
        let (Some(last), Some(now)) = (self.last.get(edge.leader), drives.get(edge.leader)) else {
            return false;
        };
        (now.turn_rate - last.turn_rate).abs() > STEADY
            || (now.acceleration - last.acceleration).abs() > STEADY
    }
}

/// Why the custom law of `follower` broke off at the moment that `simulation` has just come to, if it did.
fn fault(simulation: &Simulation, follower: usize) -> Option<LawFaultMetrics> {
    let record = simulation.record();
    let state = record.laws.iter().find(|law| law.robot == follower && !law.fault.is_empty())?;
    Some(LawFaultMetrics {
        robot: simulation.fleet().robots[follower].name.clone(),
        time: record.snapshot.time,
        // Its next sample is counted already.
        sample: simulation.sample() - 1,
        fault: state.fault.clone(),
    })
}

/// One edge at the moment that `simulation` has just come to.
fn instant(
    simulation: &Simulation,
    index: usize,
    edge: Edge,
    law: &EdgeLaw,
    drives: &[MotionInput],
) -> Instant {
    let record = simulation.record();
    let (state, time) = (&record.edges[index], record.snapshot.time);
    let limits = simulation.formation().limits(edge.follower);
    let speed = record.snapshot.robots[edge.follower].motion.speed;
    let observes = law.observes();
    let diverted = record.is_filtered(edge.follower);
    let mut set_point = law.set_point.at(time);
    // It moves with the heading it is held against, and where its follower stands.
    set_point.rate = simulation.decision(index).set_point_rate;
    Instant {
        time,
        relative: state.relative,
        follower_speed: speed.max(limits.speed_min),
        leader: drives[edge.leader],
        set_point,
        error: state.error,
        estimate: observes.then_some(Estimate { output: state.estimate, rates: state.rates }),
        limited: state.limited && !diverted,
        at_speed_bound: speed <= limits.speed_min || speed >= limits.speed_max,
        untold: [0.0; 2],
        stands: state.phase != MotionPhase::Law,
        diverted,
        too_close: state.too_close,
    }
}
