//! What keeps robots apart: their safety filters, and the proximity sensors that these need.

use super::VehicleKind;
use crate::ground::RegionForm;
use crate::text::{Flag, Optional, angle_within, number, settings};
use std::f64::consts::PI;

settings! {
    /// A filter that moves a robot's command as little as barriers ask, and names them. It needs `proximity`.
    #[derive(Copy)]
    pub struct Safety from SafetyPart {
        /// Whether commands pass through the filter.
        pub filter: bool = false, Flag, Live;
        /// Whether robots that lead have it, too: they then chase the motion of their path as their barriers allow.
        pub leads: bool = false, Flag;
        /// Room that is kept beyond the circles around bodies (D), m; if left out 0.05 m on robots of 0.42 m, and as
        /// much more as the body is longer.
        pub margin: Option<f64> = None, Optional(number("m").from(0.0).up_to(100.0)), Live;
        /// How far ahead of the middle of the body the barriers' point is (c), m; if left out 0.1 m, on steered wheels
        /// 0.3 m, and as much more as the body is longer than 0.42 m.
        pub point_ahead: Option<f64> = None, Optional(number("m").above(0.0).up_to(100.0)), Live;
        /// How fast room may be used up (α), 1/s: at most what the robot can brake, over its largest speed.
        pub gain: f64 = 2.0, number("1/s").above(0.0).up_to(1000.0), Live;
        /// How far ahead the speed is looked at (T_h), s.
        pub horizon: f64 = 0.1, number("s").above(0.0).up_to(10.0), Live;
        /// The robot stays within these [x from, y from, x to, y to], m; anywhere if left out.
        pub arena: Option<[f64; 4]> = None, Optional(RegionForm), Live;
        /// A follower stays within this distance of its leader while it can, m; at any if left out.
        pub view_distance: Option<f64> = None, Optional(number("m").above(0.0).up_to(1000.0)), Live;
        /// A follower keeps its leader within this angle off the middle of its picture while it can; at any if left out.
        pub view_angle: Option<f64> = None, Optional(angle_within(PI / 180.0, PI)), Live;
    }
}

settings! {
    /// A sensor of what is near a robot, all round: robots by their middles, props by their nearest points.
    #[derive(Copy)]
    pub struct Proximity from ProximityPart {
        /// How far it senses, m; a robot has no such sensor if left out.
        pub range: Option<f64> = None, Optional(number("m").above(0.0).up_to(1000.0));
        /// Measurements a second; at every control sample if left out.
        pub rate: Option<f64> = None, Optional(number("1/s").from(0.1).up_to(1000.0));
        /// Standard deviation of a distance, m.
        pub distance_noise: f64 = 0.0, number("m").from(0.0).up_to(10.0);
        /// Standard deviation of a direction.
        pub bearing_noise: f64 = 0.0, angle_within(0.0, PI);
        /// Time constant of the observer of velocities (ε), s.
        pub epsilon: f64 = 0.02, number("s").above(0.0).up_to(100.0);
    }
}

/// Length of the body that margins and points ahead were found for, m.
pub(super) const BODY_LENGTH: f64 = 0.42;

impl Safety {
    /// Margin of a robot of `length` m, m.
    pub fn margin_of(&self, length: f64) -> f64 {
        self.margin.unwrap_or(0.05 * length / BODY_LENGTH)
    }

    /// How far ahead of the middle of a body of `length` m the barriers' point is, m.
    pub fn point_ahead_of(&self, kind: VehicleKind, length: f64) -> f64 {
        let usual = if kind.steers() { 0.3 } else { 0.1 };
        self.point_ahead.unwrap_or(usual * length / BODY_LENGTH)
    }

    /// Whether a robot that leads, or one that follows, has the filter.
    pub fn acts(&self, leads: bool) -> bool {
        self.filter && (self.leads || !leads)
    }

    pub(crate) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}

impl Proximity {
    pub(crate) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}
