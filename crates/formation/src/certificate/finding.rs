//! Statements of the theorems held against what an edge went through.

use super::constants::Constants;
use super::ledger::Falls;
use super::premise::{Premise, Spell};
use super::tally::{Margin, Tally};
use super::witness::Witness;
use crate::law::Switching;
use vocabulary::{LawKind, Word, words};

words! {
    /// What the theorems state, in the order of the paper.
    pub enum Statement {
        /// β > ‖g_v V_i‖ + ‖d(g_v V_i)/dt‖/k₁₂ (Lemma 4.1).
        RobustGain = "robust-gain",
        /// P ≥ 0 (eq 28).
        NonNegative = "p-non-negative",
        /// V falls: wherever ‖r‖ > σ₁‖η‖, which is everywhere for robust state feedback (eqs 30, 44).
        TrackingDecrease = "v-falls",
        /// ε ≤ ε₁ (below eq 45).
        Epsilon = "epsilon",
        /// W falls wherever it is above ρε² (eqs 45, 47).
        ObserverDecrease = "w-falls",
        /// W ≤ ρε² from T_ε on (eq 49).
        Trapped = "w-trapped",
        /// ‖e‖ + ‖de/dt‖ + ‖η‖ ≤ δ₀ in the end (eqs 51-53).
        UltimateBound = "ultimate-bound",
    }
}

impl Statement {
    /// Where the paper states it.
    pub fn source(self) -> &'static str {
        self.texts()[0]
    }

    /// The statement in symbols.
    pub fn symbols(self) -> &'static str {
        self.texts()[1]
    }

    fn texts(self) -> [&'static str; 2] {
        match self {
            Self::RobustGain => ["Lemma 4.1", "β > ‖gᵥVᵢ‖ + ‖d(gᵥVᵢ)/dt‖/k₁₂"],
            Self::NonNegative => ["eq 28", "P ≥ 0"],
            Self::TrackingDecrease => ["eqs 29-30, 44", "V falls"],
            Self::Epsilon => ["eqs 44-46", "ε ≤ ε₁"],
            Self::ObserverDecrease => ["eqs 45-47", "W falls above ρε²"],
            Self::Trapped => ["eqs 48-49", "W ≤ ρε² from T_ε on"],
            Self::UltimateBound => ["eqs 51-53", "‖e‖+‖de/dt‖+‖η‖ ≤ δ₀ in the end"],
        }
    }
}

/// What became of a statement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatementOutcome {
    /// At every sample.
    Holds,
    /// Not at this time, s, for the first time.
    Violated(f64),
    /// The paper does not claim it here.
    PremiseNotMet,
}

impl StatementOutcome {
    /// One word for it, for machines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Violated(_) => "violated",
            Self::PremiseNotMet => "premise-not-met",
        }
    }
}

/// Samples at which the numbers say otherwise: from the first to the last, not always in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Against {
    /// s.
    pub first: f64,
    /// s.
    pub last: f64,
    /// Whether that is every sample.
    pub throughout: bool,
}

/// A statement held against a run.
#[derive(Debug, Clone, PartialEq)]
pub struct StatementFinding {
    /// What is stated.
    pub statement: Statement,
    /// What it rests on and what was not so.
    pub unmet: Vec<Premise>,
    /// Samples at which the numbers say otherwise, premises or not; `None` where they are as stated throughout, or
    /// where there are no numbers.
    pub against: Option<Against>,
    /// The least room to the other side, in the statement's own unit; `None` where there are no numbers.
    pub margin: Option<f64>,
}

impl StatementFinding {
    /// Holds, violated, or premise not met.
    pub fn outcome(&self) -> StatementOutcome {
        match (self.unmet.is_empty(), self.against) {
            (false, _) => StatementOutcome::PremiseNotMet,
            (true, Some(against)) => StatementOutcome::Violated(against.first),
            (true, None) => StatementOutcome::Holds,
        }
    }
}

/// What a run's making says about premises, besides what samples show.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each bears on other premises")]
pub struct Circumstances {
    /// The period over which the law is held, s; `None` in continuous time.
    pub held: Option<f64>,
    /// Whether the observer sees samples only.
    pub sampled_measurement: bool,
    /// Whether the follower goes by measurements.
    pub measures: bool,
    /// Whether a custom law takes the place of the paper's.
    pub custom: bool,
    /// Whether the follower or its leader is a vehicle on wheels.
    pub wheels: bool,
    /// Whether the follower has several leaders.
    pub several_leaders: bool,
    /// When the leader first moved as no bounded d²u/dt² allows, s; `None` where it is smooth.
    pub rough_leader: Option<f64>,
}

/// All statements, held against what a witness has seen.
pub fn certify(witness: &Witness, circumstances: &Circumstances) -> Vec<StatementFinding> {
    let view = FindingView { witness, circumstances, constants: Constants::of(witness) };
    Statement::WORDS.iter().map(|(_, statement, _)| view.finding(*statement)).collect()
}

struct FindingView<'a> {
    witness: &'a Witness,
    circumstances: &'a Circumstances,
    constants: Option<Constants>,
}

impl FindingView<'_> {
    fn finding(&self, statement: Statement) -> StatementFinding {
        if self.circumstances.several_leaders {
            let unmet = vec![Premise::SeveralLeaders];
            return StatementFinding { statement, unmet, against: None, margin: None };
        }
        let kind = self.witness.law.kind;
        let robust = kind != LawKind::FullState;
        let observes = kind == LawKind::OutputFeedback && self.constants.is_some();
        let applies = match statement {
            Statement::RobustGain | Statement::NonNegative | Statement::TrackingDecrease => robust,
            _ => observes,
        };
        if self.circumstances.custom {
            return StatementFinding {
                statement,
                unmet: vec![Premise::CustomLaw],
                against: None,
                margin: None,
            };
        }
        if !applies {
            let premise = if robust { Premise::NoObserver } else { Premise::FullState };
            return StatementFinding { statement, unmet: vec![premise], against: None, margin: None };
        }
        let unmet = self.unmet(statement);
        let ledger = &self.witness.ledger;
        let (against, margin) = match statement {
            Statement::RobustGain => self.throughout(&ledger.margin()),
            Statement::NonNegative => self.throughout(&ledger.p),
            Statement::TrackingDecrease => {
                let bound = self.constants.filter(|_| self.observes()).map_or(0.0, |c| c.sigma_1);
                some_of(&ledger.v, bound)
            }
            Statement::ObserverDecrease => {
                self.constants.map_or((None, None), |c| some_of(&ledger.w, c.trap))
            }
            Statement::Epsilon => self.constant(|c| c.epsilon_1 - c.epsilon),
            Statement::Trapped => self.trapped(),
            Statement::UltimateBound => self.in_the_end(),
        };
        StatementFinding { statement, unmet, against, margin }
    }

    /// Samples at which a room is below zero, and its least value.
    fn throughout(&self, room: &Margin) -> (Option<Against>, Option<f64>) {
        let spell = room.below.spell(self.witness.ledger.samples);
        let against =
            |spell: Spell| Against { first: spell.first, last: spell.last, throughout: spell.share >= 1.0 };
        (spell.map(against), room.least)
    }

    /// A statement about constants: it is so, or from the start not.
    fn constant(&self, room: impl Fn(&Constants) -> f64) -> (Option<Against>, Option<f64>) {
        let margin = self.constants.as_ref().map(room);
        let [first, last] = self.witness.ledger.span;
        (margin.filter(|m| *m < 0.0).map(|_| Against { first, last, throughout: true }), margin)
    }

    /// The bound of eq 49, from T_ε on.
    fn trapped(&self) -> (Option<Against>, Option<f64>) {
        let Some(Constants { trap, t_epsilon, .. }) = self.constants else { return (None, None) };
        let ledger = &self.witness.ledger;
        let (ends, largest) = ledger.trapped.from(t_epsilon, trap);
        let throughout = ledger.span[0] >= t_epsilon && ledger.least_w > trap;
        let against = ends.map(|[first, last]| Against { first, last, throughout });
        (against, largest.map(|largest| trap - largest))
    }

    /// The bound of eq 53: violated where the last sample is outside.
    fn in_the_end(&self) -> (Option<Against>, Option<f64>) {
        let Some(bound) = self.constants.map(|c| c.delta_0) else { return (None, None) };
        let ledger = &self.witness.ledger;
        let [least, last] = ledger.whole;
        let ends = ledger.end.ends([bound, 0.0]).filter(|_| last > bound);
        let against = ends.map(|[first, last]| Against { first, last, throughout: least > bound });
        (against, Some(bound - last))
    }

    fn observes(&self) -> bool {
        self.witness.law.kind == LawKind::OutputFeedback
    }

    /// Premises of a statement that the run does not meet.
    fn unmet(&self, statement: Statement) -> Vec<Premise> {
        let (c, law, ledger) = (self.circumstances, &self.witness.law, &self.witness.ledger);
        let rough = c.rough_leader.map(|at| Premise::LeaderNotSmooth { at });
        let smoothed = matches!(law.switching, Switching::Tanh(_)).then_some(Premise::Smoothed);
        let spell = |tally: &Tally| tally.spell(ledger.samples);
        let beta = || spell(&ledger.margin().below).map(|spell| Premise::RobustGain { at: spell.first });
        let saturated = || spell(&ledger.limited).map(Premise::Saturated);
        let chatter = || spell(&ledger.chatters).map(Premise::Chatter);
        let at_bound = || spell(&ledger.at_speed_bound).map(Premise::SpeedBound);
        let stands = || spell(&ledger.stands).map(Premise::Standing);
        let filtered = || spell(&ledger.filtered).map(Premise::Filtered);
        let close = || spell(&ledger.too_close).map(Premise::TooClose);
        let held = c.held.map(Premise::Held);
        let measurements = c.measures.then_some(Premise::Measurements);
        let wheels = c.wheels.then_some(Premise::Wheels);
        let samples = c.sampled_measurement.then_some(Premise::SampledMeasurement);
        let epsilon = || self.constants.filter(|k| k.epsilon > k.epsilon_1).map(|_| Premise::Epsilon);
        let given_way = || [saturated(), at_bound(), filtered(), stands()];
        let tracking = || {
            let rest = [close(), rough, beta(), held];
            [vec![smoothed, chatter()], given_way().to_vec(), rest.to_vec()].concat()
        };
        let list: Vec<Option<Premise>> = match statement {
            Statement::RobustGain | Statement::Epsilon => vec![rough],
            Statement::NonNegative => vec![smoothed, rough, beta()],
            Statement::TrackingDecrease => [tracking(), vec![measurements, wheels]].concat(),
            Statement::ObserverDecrease | Statement::Trapped => {
                vec![close(), rough, samples, measurements, wheels, epsilon()]
            }
            Statement::UltimateBound => [tracking(), vec![samples, measurements, wheels, epsilon()]].concat(),
        };
        list.into_iter().flatten().collect()
    }
}

/// From a first to a last sample, and never all of them: each speaks of the step to the next.
fn some_of(falls: &Falls, bound: f64) -> (Option<Against>, Option<f64>) {
    let (ends, margin) = falls.found(bound);
    (ends.map(|[first, last]| Against { first, last, throughout: false }), margin)
}
