//! What a moment is made of, as messages: names and units of fields are those of the tables.

use super::record::{FieldValue, Fields, Record};
use vocabulary::{Contact, EdgeState, EntityId, FACES, MeasurementRecord, Placement, Relative, RobotState};

fn coordinates(relative: &mut Relative) -> [&mut f64; 3] {
    [&mut relative.distance, &mut relative.bearing, &mut relative.view_angle]
}

impl Record for RobotState {
    const NAME: &'static str = "RobotState";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let (motion, attitude) = (&mut self.motion, &mut self.attitude);
        f.number("x_m", &mut motion.pose.x)?;
        f.number("y_m", &mut motion.pose.y)?;
        f.number("heading_rad", &mut motion.pose.heading)?;
        f.number("speed_m_s", &mut motion.speed)?;
        f.number("acceleration_m_s2", &mut motion.acceleration)?;
        f.number("turn_rate_rad_s", &mut motion.turn_rate)?;
        f.number("height_m", &mut attitude.height)?;
        f.number("roll_rad", &mut attitude.roll)?;
        f.number("pitch_rad", &mut attitude.pitch)?;
        f.word("condition", &mut self.condition)?;
        f.number("camera_pan_rad", &mut self.camera_pan)?;
        let mut rotation = self.wheels.map(|wheel| wheel.rotation);
        let mut steering = self.wheels.map(|wheel| wheel.steering);
        let mut compression = self.wheels.map(|wheel| wheel.compression);
        f.numbers("wheel_rotation_rad", &mut rotation)?;
        f.numbers("wheel_steering_rad", &mut steering)?;
        f.numbers("wheel_compression_m", &mut compression)?;
        for (k, wheel) in self.wheels.iter_mut().enumerate() {
            (wheel.rotation, wheel.steering, wheel.compression) = (rotation[k], steering[k], compression[k]);
        }
        Some(())
    }
}

impl Record for EdgeState {
    const NAME: &'static str = "EdgeState";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.several(["distance_m", "bearing_rad", "view_angle_rad"], coordinates(&mut self.relative))?;
        f.several(["set_distance_m", "set_bearing_rad"], self.set_point.each_mut())?;
        f.number("heading_behind_rad", &mut self.behind)?;
        f.several(["error_distance_m", "error_bearing_rad"], self.error.each_mut())?;
        f.number("asked_acceleration_m_s2", &mut self.asked.acceleration)?;
        f.number("asked_turn_rate_rad_s", &mut self.asked.turn_rate)?;
        f.number("applied_acceleration_m_s2", &mut self.applied.acceleration)?;
        f.number("applied_turn_rate_rad_s", &mut self.applied.turn_rate)?;
        f.several(["rate_distance_m_s", "rate_bearing_rad_s"], self.rates.each_mut())?;
        f.several(["estimate_distance_m", "estimate_bearing_rad"], self.estimate.each_mut())?;
        let seen = ["seen_distance_m", "seen_bearing_rad", "seen_view_angle_rad"];
        f.several(seen, coordinates(&mut self.seen))?;
        f.number("age_s", &mut self.age)?;
        f.word("sight", &mut self.sight)?;
        f.flag("limited", &mut self.limited)?;
        f.flag("too_close", &mut self.too_close)?;
        f.word("phase", &mut self.phase)?;
        f.number("displacement_m", &mut self.displacement)?;
        f.number("narrowing", &mut self.narrowing)
    }
}

/// One measurement of an edge: its index is that of its channel.
impl Record for MeasurementRecord {
    const NAME: &'static str = "Measurement";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let measurement = &mut self.measurement;
        f.word("outcome", &mut self.outcome)?;
        f.number("stamp_s", &mut measurement.stamp)?;
        f.number("arrival_s", &mut self.arrival)?;
        f.several(["distance_m", "bearing_rad", "view_angle_rad"], coordinates(&mut measurement.relative))?;
        let truth = ["true_distance_m", "true_bearing_rad", "true_view_angle_rad"];
        f.several(truth, coordinates(&mut self.truth))?;
        let deviation = ["deviation_distance_m", "deviation_bearing_rad", "deviation_view_angle_rad"];
        f.several(deviation, measurement.deviation.each_mut())?;
        f.number("pan_rad", &mut self.pan)?;
        f.count("region_x_px", &mut self.region.x)?;
        f.count("region_y_px", &mut self.region.y)?;
        f.count("region_width_px", &mut self.region.width)?;
        f.count("region_height_px", &mut self.region.height)?;
        // Which faces were seen, a bit each, and eight coordinates for each of them.
        let mut faces =
            self.tags.iter().enumerate().fold(0, |bits, (k, t)| bits | u64::from(t.is_some()) << k);
        let mut corners: Vec<f64> = self.tags.iter().flatten().flatten().flatten().copied().collect();
        f.count("seen_faces_bits", &mut faces)?;
        f.field("corners_px", FieldValue::Series(&mut corners))?;
        let mut corners = corners.into_iter();
        for (face, tag) in self.tags.iter_mut().enumerate().take(FACES) {
            *tag = None;
            if faces & 1 << face != 0 {
                let mut quad = [[0.0; 2]; 4];
                for value in quad.iter_mut().flatten() {
                    *value = corners.next().unwrap_or_default();
                }
                *tag = Some(quad);
            }
        }
        Some(())
    }
}

/// Where a prop is.
impl Record for Placement {
    const NAME: &'static str = "PropState";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.several(["x_m", "y_m", "z_m"], self.position.each_mut())?;
        f.several(["qx", "qy", "qz", "qw"], self.rotation.each_mut())
    }
}

/// A contact and the names of who takes part.
#[derive(Default)]
pub(super) struct ContactRecord {
    pub(super) contact: Contact,
    pub(super) names: [String; 2],
}

pub(super) fn thing<F: Fields>(f: &mut F, names: [&'static str; 2], thing: &mut EntityId) -> Option<()> {
    let (mut kind, mut index) = match *thing {
        EntityId::Ground => (0, 0),
        EntityId::Robot(index) => (1, index),
        EntityId::Prop(index) => (2, index),
    };
    f.field(names[0], FieldValue::Choice(&mut kind, &["ground", "robot", "prop"]))?;
    f.count(names[1], &mut index)?;
    *thing = [EntityId::Ground, EntityId::Robot(index), EntityId::Prop(index)][kind];
    Some(())
}

impl Record for ContactRecord {
    const NAME: &'static str = "Contact";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Self { contact: c, names: [first, second] } = self;
        f.text("first", first)?;
        f.text("second", second)?;
        f.number("begin_s", &mut c.begin)?;
        f.number("end_s", &mut c.end)?;
        f.several(["x_m", "y_m", "z_m"], c.place.each_mut())?;
        f.several(["normal_x", "normal_y", "normal_z"], c.normal.each_mut())?;
        f.number("impulse_n_s", &mut c.impulse)?;
        f.flag("open", &mut c.open)?;
        f.count("number", &mut c.number)?;
        thing(f, ["first_kind", "first_index"], &mut c.things[0])?;
        thing(f, ["second_kind", "second_index"], &mut c.things[1])
    }
}

/// Closes a moment: all messages before it that carry its sequence number belong to it, and nothing is missing.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct SampleNumber {
    pub(super) number: u64,
    pub(super) time: f64,
    /// Of robots, edges, props, contacts, measurements, safety filters and events.
    pub(super) counts: [usize; 7],
    /// Of custom laws.
    pub(super) laws: usize,
    /// Of plans.
    pub(super) plans: usize,
    /// Whom the follower of each edge follows; `None` where it follows nobody. Empty where that never changes.
    pub(super) leaders: Vec<Option<usize>>,
}

impl Record for SampleNumber {
    const NAME: &'static str = "Sample";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.count("number", &mut self.number)?;
        f.number("time_s", &mut self.time)?;
        let names = ["robots", "edges", "props", "contacts", "measurements", "safety", "events"];
        names.into_iter().zip(&mut self.counts).try_for_each(|(name, count)| f.count(name, count))?;
        let index = |leader: &Option<usize>| leader.map_or(-1.0, |leader| leader as f64);
        let mut leaders: Vec<f64> = self.leaders.iter().map(index).collect();
        f.field("leader_indices", FieldValue::Series(&mut leaders))?;
        let whole = |x: f64| x.fract() == 0.0 && (-1.0..1e9).contains(&x);
        leaders.iter().all(|x| whole(*x)).then_some(())?;
        self.leaders = leaders.iter().map(|x| (*x >= 0.0).then_some(*x as usize)).collect();
        f.count("laws", &mut self.laws)?;
        f.count("plans", &mut self.plans)
    }
}
