//! Two named things that touch.

/// What can touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum EntityId {
    /// Index of a robot in the cast.
    Robot(usize),
    /// Index of a prop in the cast.
    Prop(usize),
    /// The ground; only bodies touch it, wheels that stand on it do not count.
    #[default]
    Ground,
}

impl Contact {
    /// Whether a robot takes part.
    pub fn of_robot(&self) -> bool {
        self.things.iter().any(|thing| matches!(thing, EntityId::Robot(_)))
    }
}

/// One contact of two things, from their first touch until they have parted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Contact {
    /// Counts the contacts of a run from 0.
    pub number: u64,
    /// The two, in the order of [`EntityId`].
    pub things: [EntityId; 2],
    /// When they first touched, s.
    pub begin: f64,
    /// When they last touched, s.
    pub end: f64,
    /// Whether they are still together, or parted too short ago to tell.
    pub open: bool,
    /// Where they first touched, m.
    pub place: [f64; 3],
    /// Unit vector at that place from the first thing to the second.
    pub normal: [f64; 3],
    /// Sum of what they pushed each other apart with, N s; 0 where neither has a mass that moves.
    pub impulse: f64,
}
