//! What a run has to show.

use crate::text::{
    Couple, Flag, Optional, angle_within, form::Angle, form::Number, integer, number, settings,
};
use std::f64::consts::PI;
use vocabulary::Judging;

/// Size of a distance error.
const LENGTH: Number = number("m").from(0.0);
/// Size of a bearing error.
const TURN: Angle = angle_within(0.0, PI);
/// Sizes of both.
const ERROR: Couple<Number, Angle> = Couple(LENGTH, TURN);
/// Sizes of the rates of both.
const RATES: Couple<Number, Number> = Couple(number("m/s").from(0.0), number("rad/s").from(0.0));
/// Size of a push.
const IMPULSE: Number = number("N s").from(0.0);

settings! {
    /// What a run has to show, so that a scene is a test. What is left out is not asked for.
    #[derive(Copy)]
    pub struct Expect from ExpectPart {
        /// Whether the run has to reach its duration.
        pub completed: bool = true, Flag;
        /// Whether no two bodies may ever touch.
        pub no_contact: bool = false, Flag;
        /// Largest |distance error| of any edge at the end, m.
        pub final_distance_error: Option<f64> = None, Optional(LENGTH);
        /// Largest |bearing error| of any edge at the end, rad.
        pub final_bearing_error: Option<f64> = None, Optional(TURN);
        /// Time after which the errors of every edge stay inside `settling_band`, s.
        pub settling_time: Option<f64> = None, Optional(number("s").from(0.0));
        /// |error| [m, rad] under which an edge counts as settled.
        pub settling_band: [f64; 2] = [0.02, 0.02], ERROR;
        /// Smallest distance between the outlines of any two bodies over the run, m.
        pub clearance_min: Option<f64> = None, Optional(LENGTH);
        /// [slowest, fastest] speed any follower may have, m/s: once its edge has settled if there is a
        /// `settling_time`, else over the whole run.
        pub speed_within: Option<[f64; 2]> = None, Optional(Couple(number("m/s"), number("m/s")));
        /// What the largest |estimated rate| of [distance, bearing] of some edge has to reach, [m/s, rad/s]: peaking.
        pub rate_peak_at_least: Option<[f64; 2]> = None, Optional(RATES);
        /// What no |estimated rate| of [distance, bearing] of any edge may exceed, [m/s, rad/s].
        pub rate_peak_at_most: Option<[f64; 2]> = None, Optional(RATES);
        /// What no |error| of any edge may exceed over the whole run, [m, rad].
        pub error_peak_at_most: Option<[f64; 2]> = None, Optional(ERROR);
        /// What no |error| of any edge may exceed from `settled_after` to the end, [m, rad].
        pub settled_error_at_most: Option<[f64; 2]> = None, Optional(ERROR);
        /// What the root mean square of no edge's error may exceed from `settled_after` to the end, [m, rad].
        pub settled_rms_at_most: Option<[f64; 2]> = None, Optional(ERROR);
        /// What no |turn rate| of any follower may exceed whose leader has stood for 2 s, rad/s.
        pub standing_turn_rate_at_most: Option<f64> = None, Optional(number("rad/s").from(0.0));
        /// How far from its set point any follower may be whose leader has stood for 2 s, m.
        pub standing_error_at_most: Option<f64> = None, Optional(LENGTH);
        /// Time from which on every follower that filed in keeps its place in the shape again, s, wherever it is by then; one
        /// at least has to have filed in.
        pub wide_again_by: Option<f64> = None, Optional(number("s").from(0.0));
        /// Share of the measurements that arrived in which every follower has to have recognised its leader.
        pub in_view_at_least: Option<f64> = None, Optional(number("").from(0.0).up_to(1.0));
        /// Time from which `settled_error_at_most` and `settled_rms_at_most` hold, s.
        pub settled_after: Option<f64> = None, Optional(number("s").from(0.0));
        /// Number of contacts of two bodies, props and ground included, over the run.
        pub contacts_exactly: Option<u32> = None, Optional(integer::<u32>(0, 1_000_000));
        /// [least, most] that the largest impulse of any contact may be, N s; 0 where nothing touches.
        pub contact_impulse_within: Option<[f64; 2]> = None, Optional(Couple(IMPULSE, IMPULSE));
        /// Whether every robot has to be able to drive at the end: not overturned, stuck or fallen.
        pub all_able: bool = false, Flag;
        /// Largest share of the samples at which a limit or a safety filter may cut the command of any follower.
        pub limited_at_most: Option<f64> = None, Optional(number("").from(0.0).up_to(1.0));
        /// Whether every event has to take place.
        pub no_event_refused: bool = false, Flag;
        /// Whether no robot may be left waiting, or have given up, at the end of a run in which something happened.
        pub nobody_left_behind: bool = true, Flag;
        /// Whether every lead robot with goals has to be at the last of them at the end.
        pub arrived: bool = false, Flag;
        /// Largest height of any robot's ground point over the ground, m: jumps and climbs.
        pub lift_at_most: Option<f64> = None, Optional(LENGTH);
    }
}

/// Share of a run from which errors are late ones, where its scene does not say.
const LATE: f64 = 0.5;

impl Expect {
    /// What a run of `duration` s is judged by. Late errors count from `settled_after` on, or from half time where a
    /// scene gives none that comes.
    pub fn judging(&self, duration: f64) -> Judging {
        let said = self.settled_after.filter(|time| *time < duration);
        Judging { settling_band: self.settling_band, settled_after: said.unwrap_or(LATE * duration) }
    }
}
