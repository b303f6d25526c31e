//! One number for a whole trajectory.

use vocabulary::{Contact, Relative, StepRecord};
use xxhash_rust::xxh3::Xxh3;

/// A running 128-bit digest (XXH3) of every number of every moment, in order: equal only for bitwise equal runs, but for
/// the sign of zeros, which processors set differently.
#[derive(Clone, Default)]
pub struct Digest {
    hash: Xxh3,
    bytes: Vec<u8>,
}

impl Digest {
    /// Takes in a moment.
    pub fn push(&mut self, record: &StepRecord) {
        self.bytes.clear();
        let bytes = &mut self.bytes;
        numbers(record, |_, _, value| bytes.extend((value + 0.0).to_le_bytes()));
        self.hash.update(&self.bytes);
    }

    /// 32 hexadecimal digits.
    pub fn text(&self) -> String {
        format!("{:032x}", self.hash.digest128())
    }
}

/// What a number of a moment belongs to, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberOwner {
    /// The moment itself.
    Time,
    /// A robot.
    Robot(usize),
    /// An edge of the formation.
    Edge(usize),
    /// A prop.
    Prop(usize),
    /// A contact.
    Contact(usize),
    /// A measurement of a leader.
    Measurement(usize),
}

/// Hands every number of a moment that a digest covers to `visit`, in order: what it belongs to, its name, its value.
pub fn numbers(record: &StepRecord, mut visit: impl FnMut(NumberOwner, &'static str, f64)) {
    let mut put = |part, numbers: &[(&'static str, f64)]| {
        for (name, value) in numbers {
            visit(part, name, *value);
        }
    };
    put(NumberOwner::Time, &[("time", record.snapshot.time)]);
    for (k, robot) in record.snapshot.robots.iter().enumerate() {
        let (m, attitude) = (&robot.motion, &robot.attitude);
        put(NumberOwner::Robot(k), &[("x", m.pose.x), ("y", m.pose.y), ("heading", m.pose.heading)]);
        put(
            NumberOwner::Robot(k),
            &[("speed", m.speed), ("acceleration", m.acceleration), ("turn rate", m.turn_rate)],
        );
        let attitude = [("height", attitude.height), ("roll", attitude.roll), ("pitch", attitude.pitch)];
        put(NumberOwner::Robot(k), &attitude);
    }
    for (k, edge) in record.edges.iter().enumerate() {
        let ([distance, bearing], [d, b], [rate, turning]) = (edge.set_point, edge.error, edge.rates);
        put(NumberOwner::Edge(k), &[("distance set point", distance), ("bearing set point", bearing)]);
        put(NumberOwner::Edge(k), &[("distance error", d), ("bearing error", b)]);
        let command = edge.applied;
        put(NumberOwner::Edge(k), &[("commanded acceleration", command.acceleration)]);
        put(NumberOwner::Edge(k), &[("commanded turn rate", command.turn_rate)]);
        put(NumberOwner::Edge(k), &[("distance rate", rate), ("bearing rate", turning)]);
    }
    for (k, prop) in record.snapshot.props.iter().enumerate() {
        put(NumberOwner::Prop(k), &prop.position.map(|value| ("position", value)));
        put(NumberOwner::Prop(k), &prop.rotation.map(|value| ("rotation", value)));
    }
    for (k, contact) in record.contacts.iter().enumerate() {
        let Contact { begin, end, impulse, .. } = *contact;
        put(NumberOwner::Contact(k), &[("begin", begin), ("end", end), ("impulse", impulse)]);
    }
    for (k, frame) in record.frames.iter().enumerate() {
        let Relative { distance, bearing, view_angle } = frame.measurement.relative;
        put(NumberOwner::Measurement(k), &[("stamp", frame.measurement.stamp), ("arrival", frame.arrival)]);
        let measured = [("distance", distance), ("bearing", bearing), ("view angle", view_angle)];
        put(NumberOwner::Measurement(k), &measured);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{RobotState, Snapshot};

    fn digest(values: &[f64]) -> String {
        let mut digest = Digest::default();
        for (k, x) in values.iter().enumerate() {
            let mut robot = RobotState::default();
            robot.motion.pose.x = *x;
            digest.push(&StepRecord {
                snapshot: Snapshot { time: k as f64, robots: vec![robot], props: vec![] },
                ..StepRecord::default()
            });
        }
        digest.text()
    }

    #[test]
    fn the_last_bit_and_the_order_count() {
        assert_eq!(digest(&[1.0, 2.0]), digest(&[1.0, 2.0]));
        assert_ne!(digest(&[1.0, 2.0]), digest(&[2.0, 1.0]));
        assert_ne!(digest(&[1.0]), digest(&[1.0_f64.next_up()]));
        assert_eq!(digest(&[0.0]), digest(&[-0.0]));
        assert_eq!(digest(&[]).len(), 32);
    }
}
