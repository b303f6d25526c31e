//! How followers leave a wide shape for a column where there is no room for it.

use super::safety::BODY_LENGTH;
use crate::text::{Flag, Optional, number, settings};

settings! {
    /// A follower that narrows files in behind its lead where the way of its place is not free, and goes back where it is. It
    /// needs `proximity` and `heading = "path"`. Lengths and speeds that are left out are for a robot of 0.42 m, and as much
    /// more as the body is longer.
    #[derive(Copy)]
    pub struct Narrowing from NarrowingPart {
        /// Whether the follower narrows.
        pub narrows: bool = false, Flag, Live;
        /// How far behind the robot before it in the column (d), m; if left out 1 m.
        pub spacing: Option<f64> = None, Optional(number("m").above(0.0).up_to(1000.0)), Live;
        /// How far beside the lead's track those of a wing keep in the column (s), m; if left out 0.3 m.
        pub stagger: Option<f64> = None, Optional(number("m").from(0.0).up_to(1000.0)), Live;
        /// What has to be free beyond the body and the `margin` of `safety`, on either side, m; if left out 0.08 m.
        pub room: Option<f64> = None, Optional(number("m").from(0.0).up_to(1000.0)), Live;
        /// Fastest that its place moves against its leader, m/s; if left out 0.25 m/s.
        pub rate: Option<f64> = None, Optional(number("m/s").above(0.0).up_to(100.0)), Live;
        /// Strongest that its place accelerates, m/s²; if left out 0.4 m/s².
        pub acceleration: Option<f64> = None, Optional(number("m/s²").above(0.0).up_to(100.0)), Live;
        /// How long a wider way has to be free before it is taken, s.
        pub patience: f64 = 0.5, number("s").from(0.0).up_to(1000.0), Live;
    }
}

impl Narrowing {
    /// How far a robot of `length` m is behind the one before it, m.
    pub fn spacing_of(&self, length: f64) -> f64 {
        self.spacing.unwrap_or(length / BODY_LENGTH)
    }

    /// How far beside the lead's track, m.
    pub fn stagger_of(&self, length: f64) -> f64 {
        self.stagger.unwrap_or(0.3 * length / BODY_LENGTH)
    }

    /// What has to be free beside it, m.
    pub fn room_of(&self, length: f64) -> f64 {
        self.room.unwrap_or(0.08 * length / BODY_LENGTH)
    }

    /// Fastest that its place moves, m/s.
    pub fn rate_of(&self, length: f64) -> f64 {
        self.rate.unwrap_or(0.25 * length / BODY_LENGTH)
    }

    /// Strongest that its place accelerates, m/s².
    pub fn acceleration_of(&self, length: f64) -> f64 {
        self.acceleration.unwrap_or(0.4 * length / BODY_LENGTH)
    }

    /// By how much strips are longer than the way to drive, behind and ahead, m.
    pub fn reserve_of(&self, length: f64) -> [f64; 2] {
        [0.3, 0.5].map(|reserve| reserve * length / BODY_LENGTH)
    }

    pub(crate) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}
