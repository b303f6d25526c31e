//! The run as a whole: its time and its physics.

use crate::text::words::word;
use crate::text::{number, settings};
use vocabulary::{TimeMode, words};

settings! {
    /// Length, control period and mode of a run.
    #[derive(Copy)]
    pub struct Time from TimePart {
        /// Length of the run, s; it ends with the first control sample at or after that.
        pub duration: f64 = 15.0, number("s").above(0.0).up_to(1e5);
        /// Control period, s; at most the duration.
        pub period: f64 = 0.01, number("s").from(1e-5).up_to(1e5);
        /// How law and observer act between control samples.
        pub mode: TimeMode = TimeMode::Sampled, word::<TimeMode>();
    }
}

settings! {
    /// How vehicles with wheels and props that move are carried through time.
    #[derive(Copy)]
    pub struct Physics from PhysicsPart {
        /// Step of the physics, s.
        pub step: f64 = 0.005, number("s").from(1e-4).up_to(0.02);
        /// What a contact of two bodies does to the run.
        pub on_contact: OnContact = OnContact::Record, word::<OnContact>();
    }
}

words! {
    /// What a contact of two bodies does to the run.
    pub enum OnContact {
        /// It is recorded, and the run goes on.
        Record = "record",
        /// It is recorded, and the run ends there.
        Stop = "stop",
        /// It is recorded, and the run ends there as failed.
        Fail = "fail",
    }
}
