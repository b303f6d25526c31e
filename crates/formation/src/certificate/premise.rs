//! What the theorems take for granted, and when it was not so.

/// A stretch of the run in which something was so: from its first to its last sample, not always in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spell {
    /// s.
    pub first: f64,
    /// s.
    pub last: f64,
    /// Share of all samples.
    pub share: f64,
}

/// What a statement rests on and what is not met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Premise {
    /// The law has no robust term: it is told its leader's motion and cancels it.
    FullState,
    /// The law is none of the paper's.
    CustomLaw,
    /// The law has no observer.
    NoObserver,
    /// The follower has several leaders.
    SeveralLeaders,
    /// β tanh(slope e) stands in for β sign(e).
    Smoothed,
    /// The sign switched from sample to sample, faster than a run in steps follows.
    Chatter(Spell),
    /// A bound cut the command.
    Saturated(Spell),
    /// The speed stood at its bound.
    SpeedBound(Spell),
    /// A safety filter moved the command.
    Filtered(Spell),
    /// Near a stand the law gave way to the standing rule.
    Standing(Spell),
    /// The leader's speed or turn rate changed between two samples as no bounded d²u/dt² allows.
    LeaderNotSmooth {
        /// When first, s.
        at: f64,
    },
    /// The law is held over periods of this length, s.
    Held(f64),
    /// The observer sees samples only.
    SampledMeasurement,
    /// The follower measures where its leader is: what it knows is late and noisy.
    Measurements,
    /// A vehicle on wheels: it does what it is told only nearly.
    Wheels,
    /// The distance was below ℓ_min.
    TooClose(Spell),
    /// The condition of Lemma 4.1 on β is violated.
    RobustGain {
        /// When first, s.
        at: f64,
    },
    /// ε is above ε₁.
    Epsilon,
}

impl Premise {
    /// What is not met, in a few words.
    pub fn words(&self) -> String {
        let spell = |what: &str, spell: &Spell| {
            if spell.first == spell.last {
                format!("{what} at {:.2} s", spell.first)
            } else {
                format!(
                    "{what} between {:.2} and {:.2} s ({} of the samples)",
                    spell.first,
                    spell.last,
                    percent(spell.share)
                )
            }
        };
        match self {
            Self::FullState => "the law is told its leader's motion and has no robust term".to_owned(),
            Self::CustomLaw => "the law is none of the paper's".to_owned(),
            Self::NoObserver => "the law has no observer".to_owned(),
            Self::SeveralLeaders => {
                "the theorems are about one leader, and the follower has several".to_owned()
            }
            Self::Smoothed => "tanh instead of sign".to_owned(),
            Self::Chatter(when) => spell("the sign switches faster than steps follow", when),
            Self::Saturated(when) => spell("saturation active", when),
            Self::SpeedBound(when) => spell("v at its bound", when),
            Self::Filtered(when) => spell("a safety filter moves the command", when),
            Self::Standing(when) => spell("the standing rule acts in place of the law", when),
            Self::LeaderNotSmooth { at } => format!("leader not smooth at {at:.2} s"),
            Self::Held(period) => format!("sampled: the law is held for {} ms", 1e3 * period),
            Self::SampledMeasurement => "the observer sees samples only".to_owned(),
            Self::Measurements => "the follower goes by measurements, which are late and noisy".to_owned(),
            Self::Wheels => "a vehicle on wheels does what it is told only nearly".to_owned(),
            Self::TooClose(when) => spell("distance below its minimum", when),
            Self::RobustGain { at } => format!("β too small for Lemma 4.1 at {at:.2} s"),
            Self::Epsilon => "ε above ε₁".to_owned(),
        }
    }
}

/// A share in words that are never "0 %" for what happened.
fn percent(share: f64) -> String {
    if share < 0.01 { "under 1 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}
