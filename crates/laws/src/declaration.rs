//! What a law says of itself. Sliders, checks, the schema, `tune` and captions go by it.

use crate::input::InputKind;
use crate::unit::Unit;

/// What a law says of itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Declaration {
    /// One line that says what it is; empty where the law has none.
    pub title: String,
    /// How many leaders its follower has, 1 to [`crate::LEADERS_MAX`].
    pub leaders: usize,
    /// What it has to know.
    pub knows: Knowledge,
    /// What is set in a scene, tuned in the lab and swept.
    pub parameters: Vec<Parameter>,
    /// What it carries from sample to sample.
    pub memory: Vec<Quantity>,
    /// What it offers to plots besides its memory.
    pub shown: Vec<Quantity>,
    /// What it reads, each once: the leader, counted from 0, and what of it; the leader is 0 for what belongs to none.
    pub reads: Vec<(usize, InputKind)>,
    /// Whether it may act in continuous time: its memory has derivatives, and is not set.
    pub continuous: bool,
}

impl Declaration {
    /// Whether it reads the rates of distance or bearing of a leader.
    pub fn reads_rates(&self) -> bool {
        self.reads.iter().any(|(_, kind)| matches!(kind, InputKind::DistanceRate | InputKind::BearingRate))
    }
}

/// What a law has to know of its leaders besides distance, bearing and view angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Knowledge {
    /// Nothing: rates are the estimates of the built-in observer.
    #[default]
    Output,
    /// The true rates of distance and bearing.
    Rates,
    /// The true rates, and the leader's speed, turn rate and their derivatives.
    Motion,
}

/// A number that is set outside the law.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name in the text of the law and in scenes.
    pub name: String,
    /// How it is written beside a slider, such as "ε".
    pub symbol: String,
    /// Its unit.
    pub unit: Unit,
    /// Its unit as it is declared, such as "deg", in which all its values are given; empty for a number.
    pub unit_name: String,
    /// What one of that unit is in m, s and rad.
    pub unit_size: f64,
    /// What it is where nobody sets it.
    pub default: f64,
    /// The least and the largest value.
    pub range: [f64; 2],
    /// How a slider divides the range.
    pub scale: Scale,
    /// One line that says what it does; empty where the law has none.
    pub help: String,
}

impl Parameter {
    /// A value as the law takes it, in m, s and rad.
    pub fn as_told(&self, value: f64) -> f64 {
        value * self.unit_size
    }

    /// Its unit as it stands behind a number: with a space before it, or nothing.
    pub fn behind(&self) -> String {
        if self.unit_name.is_empty() { String::new() } else { format!(" {}", self.unit_name) }
    }
}

/// How a slider divides a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios; the range is positive.
    Logarithmic,
}

/// A named number of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its name in the text of the law.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
}
