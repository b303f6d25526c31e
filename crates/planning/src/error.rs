//! What is wrong with a map, a formation or a mission: what, where, the range, the fix.

use thiserror::Error;

/// Why an input makes no sense. What makes sense and has no way is a [`NoWay`](crate::NoWay).
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InputError {
    /// A number that is not finite.
    #[error("{what} is not a finite number")]
    NotFinite {
        /// The number.
        what: String,
    },
    /// A number out of its range.
    #[error("{what} is {value}, but has to be {range}")]
    OutOfRange {
        /// The number.
        what: String,
        /// What it is.
        value: f64,
        /// What it may be, in words.
        range: &'static str,
    },
    /// A goal for which the grid of the search would be too large.
    #[error(
        "the goal is {away:.0} m away, but may be {most:.0} m away at most: make a tour of goals that are nearer to each other"
    )]
    TooFar {
        /// From the start, m.
        away: f64,
        /// m.
        most: f64,
    },
    /// Too few corners, or all on one line.
    #[error("{what} has {corners} corners and no area: give at least three corners that are not on one line")]
    NoArea {
        /// The polygon.
        what: String,
        /// How many corners it has.
        corners: usize,
    },
    /// A corner that points inwards, or sides that cross.
    #[error("{what} is not convex at corner {corner}: split it into convex parts")]
    NotConvex {
        /// The polygon.
        what: String,
        /// Number of the corner, from 0.
        corner: usize,
    },
    /// A follower before its leader.
    #[error(
        "follower {follower} follows robot {leader}: list leaders before their followers; robot 0 is the lead"
    )]
    LeaderAfterFollower {
        /// Number of the follower, from 1.
        follower: usize,
        /// Number of its leader.
        leader: usize,
    },
    /// Not the same number of levels for everybody.
    #[error(
        "follower {follower} has places for {found} levels, but the first has {expected}: give one for each level"
    )]
    UnevenLevels {
        /// Number of the follower, from 1.
        follower: usize,
        /// Its places.
        found: usize,
        /// Those of the first follower.
        expected: usize,
    },
    /// A level that is not there.
    #[error("the goal asks for level {level}, but the formation has levels 0 to {last}")]
    NoSuchLevel {
        /// For which.
        level: usize,
        /// The last one.
        last: usize,
    },
    /// Only a lone robot may reverse.
    #[error("a formation of {robots} robots cannot reverse: leave `reverses` to a robot alone")]
    ReversesTogether {
        /// How many there are.
        robots: usize,
    },
    /// Not one held heading for every follower.
    #[error("there are held headings for {found} followers, but {expected} follow: give one for each")]
    WrongCount {
        /// Given.
        found: usize,
        /// Wanted.
        expected: usize,
    },
    /// A tour without goals.
    #[error("a tour needs at least one goal")]
    NoGoals,
}

/// `value`, if it is finite and `ok`.
pub(crate) fn checked(
    value: f64,
    ok: bool,
    what: impl FnOnce() -> String,
    range: &'static str,
) -> Result<f64, InputError> {
    if !value.is_finite() {
        return Err(InputError::NotFinite { what: what() });
    }
    if ok { Ok(value) } else { Err(InputError::OutOfRange { what: what(), value, range }) }
}
