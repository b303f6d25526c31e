//! Statements of the theorems held against what an edge went through.

use super::constants::Constants;
use super::premise::{Premise, Spell};
use super::witness::{Row, Witness};
use crate::law::{LawKind, Switching};

/// What the theorems state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Statement {
    /// β > ‖g_v V_i‖ + ‖d(g_v V_i)/dt‖/k₁₂ (Lemma 4.1).
    RobustGain,
    /// P ≥ 0 (eq 28).
    NonNegative,
    /// V falls: wherever ‖r‖ > σ₁‖η‖, which is everywhere for robust state feedback (eqs 30, 44).
    TrackingDecrease,
    /// ε ≤ ε₁ (below eq 45).
    Epsilon,
    /// W falls wherever it is above ρε² (eqs 45, 47).
    ObserverDecrease,
    /// W ≤ ρε² from T_ε on (eq 49).
    Trapped,
    /// ‖e‖ + ‖de/dt‖ + ‖η‖ ≤ δ₀ in the end (eqs 51-53).
    UltimateBound,
}

impl Statement {
    /// All of them, in the order of the paper.
    pub const ALL: [Self; 7] = [
        Self::RobustGain,
        Self::NonNegative,
        Self::TrackingDecrease,
        Self::Epsilon,
        Self::ObserverDecrease,
        Self::Trapped,
        Self::UltimateBound,
    ];

    /// The statement in symbols.
    pub fn words(self) -> &'static str {
        match self {
            Self::RobustGain => "β > ‖gᵥVᵢ‖ + ‖d(gᵥVᵢ)/dt‖/k₁₂",
            Self::NonNegative => "P ≥ 0",
            Self::TrackingDecrease => "V falls",
            Self::Epsilon => "ε ≤ ε₁",
            Self::ObserverDecrease => "W falls above ρε²",
            Self::Trapped => "W ≤ ρε² from T_ε on",
            Self::UltimateBound => "‖e‖+‖de/dt‖+‖η‖ ≤ δ₀ in the end",
        }
    }

    /// Where the paper states it.
    pub fn source(self) -> &'static str {
        match self {
            Self::RobustGain => "Lemma 4.1",
            Self::NonNegative => "eq 28",
            Self::TrackingDecrease => "eqs 29-30, 44",
            Self::Epsilon => "eqs 44-46",
            Self::ObserverDecrease => "eqs 45-47",
            Self::Trapped => "eqs 48-49",
            Self::UltimateBound => "eqs 51-53",
        }
    }

    /// One word for it, for machines.
    pub fn name(self) -> &'static str {
        match self {
            Self::RobustGain => "robust-gain",
            Self::NonNegative => "p-non-negative",
            Self::TrackingDecrease => "v-falls",
            Self::Epsilon => "epsilon",
            Self::ObserverDecrease => "w-falls",
            Self::Trapped => "w-trapped",
            Self::UltimateBound => "ultimate-bound",
        }
    }
}

/// What became of a statement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// At every sample.
    Holds,
    /// Not at this time, s, for the first time.
    Violated(f64),
    /// The paper does not claim it here.
    PremiseNotMet,
}

impl Outcome {
    /// One word for it, for machines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Violated(_) => "violated",
            Self::PremiseNotMet => "premise-not-met",
        }
    }
}

/// A statement held against a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What is stated.
    pub statement: Statement,
    /// What it rests on and what was not so.
    pub unmet: Vec<Premise>,
    /// Samples at which the numbers say otherwise, premises or not; `None` where they are as stated throughout, or where
    /// there are no numbers.
    pub against: Option<Spell>,
    /// The least room to the other side, in the statement's own unit; `None` where there are no numbers.
    pub margin: Option<f64>,
}

impl Finding {
    /// Holds, violated, or premise not met.
    pub fn outcome(&self) -> Outcome {
        match (self.unmet.is_empty(), self.against) {
            (false, _) => Outcome::PremiseNotMet,
            (true, Some(spell)) => Outcome::Violated(spell.first),
            (true, None) => Outcome::Holds,
        }
    }
}

/// What a run's making says about premises, besides what samples show.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Circumstances {
    /// The period over which the law is held, s; `None` in continuous time.
    pub held: Option<f64>,
    /// Whether the observer sees samples only.
    pub sampled_measurement: bool,
    /// Whether the follower goes by looks.
    pub looks: bool,
    /// Whether the follower or its leader is a vehicle on wheels.
    pub wheels: bool,
    /// When the leader first moved as no bounded d²u/dt² allows, s; `None` where it is smooth.
    pub rough_leader: Option<f64>,
}

/// V may rise from sample to sample by this share of its largest value: what is left of the trapezoids' error.
const ROUNDING: f64 = 1e-6;

/// All statements, held against what a witness has seen.
pub fn certify(witness: &Witness, circumstances: &Circumstances) -> Vec<Finding> {
    let view = View { witness, circumstances, constants: Constants::of(witness), rows: witness.rows() };
    Statement::ALL.into_iter().map(|statement| view.finding(statement)).collect()
}

struct View<'a> {
    witness: &'a Witness,
    circumstances: &'a Circumstances,
    constants: Option<Constants>,
    rows: &'a [Row],
}

impl View<'_> {
    fn finding(&self, statement: Statement) -> Finding {
        let kind = self.witness.law().kind;
        let robust = kind != LawKind::FullState;
        let observes = kind == LawKind::OutputFeedback && self.constants.is_some();
        let applies = match statement {
            Statement::RobustGain | Statement::NonNegative | Statement::TrackingDecrease => robust,
            _ => observes,
        };
        if !applies {
            let premise = if robust { Premise::NoObserver } else { Premise::FullState };
            return Finding { statement, unmet: vec![premise], against: None, margin: None };
        }
        let unmet = self.unmet(statement);
        let (against, margin) = match statement {
            Statement::RobustGain => self.throughout(|row| row.margin),
            Statement::NonNegative => self.throughout(|row| row.p),
            Statement::TrackingDecrease => self.falls(
                |row| row.v,
                |row, constants| constants.is_none_or(|c| row.filtered > c.sigma_1 * row.observer_error),
            ),
            Statement::ObserverDecrease => {
                self.falls(|row| row.w, |row, constants| constants.is_some_and(|c| row.w > c.trap))
            }
            Statement::Epsilon => self.constant(|c| c.epsilon_1 - c.epsilon),
            Statement::Trapped => {
                let from = self.constants.map_or(0.0, |c| c.t_epsilon);
                let trap = self.constants.map_or(0.0, |c| c.trap);
                let (against, margin) = self.after(from, |row| trap - row.w);
                (against, margin)
            }
            Statement::UltimateBound => self.in_the_end(),
        };
        Finding { statement, unmet, against, margin }
    }

    /// Samples at which `room` is below zero, and its least value.
    fn throughout(&self, room: impl Fn(&Row) -> f64) -> (Option<Spell>, Option<f64>) {
        self.after(f64::NEG_INFINITY, room)
    }

    fn after(&self, from: f64, room: impl Fn(&Row) -> f64) -> (Option<Spell>, Option<f64>) {
        let rows = || self.rows.iter().filter(|row| row.time >= from);
        let least = rows().map(&room).reduce(f64::min);
        (self.spell(|row| row.time >= from && room(row) < 0.0), least)
    }

    /// Samples after which `value` rose although `where_it_falls`; the margin is the least fall, per sample.
    fn falls(
        &self,
        value: impl Fn(&Row) -> f64,
        where_it_falls: impl Fn(&Row, Option<&Constants>) -> bool,
    ) -> (Option<Spell>, Option<f64>) {
        let observing = self.constants.as_ref().filter(|_| self.observes());
        let largest = self.rows.iter().map(|row| value(row).abs()).fold(0.0, f64::max);
        let falls = |pair: &[Row]| match pair {
            [a, b] if where_it_falls(a, observing) => Some((a.time, value(a) - value(b))),
            _ => None,
        };
        let steps = || self.rows.windows(2).filter_map(falls);
        let risen: Vec<f64> =
            steps().filter(|(_, fall)| *fall < -ROUNDING * largest).map(|(time, _)| time).collect();
        let least = steps().map(|(_, fall)| fall).reduce(f64::min);
        (self.spell_of(&risen), least)
    }

    /// A statement about constants: it is so, or from the start not.
    fn constant(&self, room: impl Fn(&Constants) -> f64) -> (Option<Spell>, Option<f64>) {
        let margin = self.constants.as_ref().map(room);
        let (first, last) = self.ends();
        (margin.filter(|m| *m < 0.0).map(|_| Spell { first, last, share: 1.0 }), margin)
    }

    /// The bound of eq 53: violated where the last sample is outside.
    fn in_the_end(&self) -> (Option<Spell>, Option<f64>) {
        let Some(bound) = self.constants.map(|c| c.delta_0) else { return (None, None) };
        let room = |row: &Row| bound - (row.error + row.error_rate + row.observer_error);
        let margin = self.rows.last().map(room);
        let against = self.spell(|row| room(row) < 0.0);
        (against.filter(|_| margin.is_some_and(|m| m < 0.0)), margin)
    }

    fn observes(&self) -> bool {
        self.witness.law().kind == LawKind::OutputFeedback
    }

    fn ends(&self) -> (f64, f64) {
        (self.rows.first().map_or(0.0, |row| row.time), self.rows.last().map_or(0.0, |row| row.time))
    }

    fn spell(&self, at: impl Fn(&Row) -> bool) -> Option<Spell> {
        let times: Vec<f64> = self.rows.iter().filter(|row| at(row)).map(|row| row.time).collect();
        self.spell_of(&times)
    }

    fn spell_of(&self, times: &[f64]) -> Option<Spell> {
        let (first, last) = (*times.first()?, *times.last()?);
        Some(Spell { first, last, share: times.len() as f64 / self.rows.len().max(1) as f64 })
    }

    /// Premises of a statement that the run does not meet.
    fn unmet(&self, statement: Statement) -> Vec<Premise> {
        let (c, law) = (self.circumstances, self.witness.law());
        let rough = c.rough_leader.map(|at| Premise::LeaderNotSmooth { at });
        let smoothed = matches!(law.switching, Switching::Tanh(_)).then_some(Premise::Smoothed);
        let beta =
            || self.throughout(|row| row.margin).0.map(|spell| Premise::RobustGain { at: spell.first });
        let saturated = || self.spell(|row| row.limited).map(Premise::Saturated);
        let chatter = || self.spell(|row| row.chatters).map(Premise::Chatter);
        let at_bound = || self.spell(|row| row.at_speed_bound).map(Premise::SpeedBound);
        let close = || self.spell(|row| row.too_close).map(Premise::TooClose);
        let held = c.held.map(Premise::Held);
        let looks = c.looks.then_some(Premise::Looks);
        let wheels = c.wheels.then_some(Premise::Wheels);
        let samples = c.sampled_measurement.then_some(Premise::SampledMeasurement);
        let epsilon = || self.constants.filter(|k| k.epsilon > k.epsilon_1).map(|_| Premise::Epsilon);
        let list: Vec<Option<Premise>> = match statement {
            Statement::RobustGain | Statement::Epsilon => vec![rough],
            Statement::NonNegative => vec![smoothed, rough, beta()],
            Statement::TrackingDecrease => {
                vec![
                    smoothed,
                    chatter(),
                    saturated(),
                    at_bound(),
                    close(),
                    rough,
                    beta(),
                    held,
                    looks,
                    wheels,
                ]
            }
            Statement::ObserverDecrease | Statement::Trapped => {
                vec![close(), rough, samples, looks, wheels, epsilon()]
            }
            Statement::UltimateBound => {
                vec![
                    smoothed,
                    chatter(),
                    saturated(),
                    at_bound(),
                    close(),
                    rough,
                    beta(),
                    held,
                    samples,
                    looks,
                    wheels,
                    epsilon(),
                ]
            }
        };
        list.into_iter().flatten().collect()
    }
}
