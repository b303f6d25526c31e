//! One number for a whole trajectory.

use vocabulary::{Relative, StepRecord};
use xxhash_rust::xxh3::Xxh3;

/// A running 128-bit digest (XXH3) of every f64 of every moment, in order: equal only for bitwise equal runs.
#[derive(Clone, Default)]
pub struct Digest {
    hash: Xxh3,
    bytes: Vec<u8>,
}

impl Digest {
    /// Takes in a moment: time, poses, speeds, commands, estimates, props, contacts, measurements of leaders.
    pub fn push(&mut self, record: &StepRecord) {
        self.bytes.clear();
        let mut put = |values: &[f64]| self.bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        put(&[record.snapshot.time]);
        for robot in &record.snapshot.robots {
            let m = &robot.motion;
            put(&[m.pose.x, m.pose.y, m.pose.heading, m.speed, m.acceleration, m.turn_rate]);
            put(&[robot.attitude.height, robot.attitude.roll, robot.attitude.pitch]);
        }
        for edge in &record.edges {
            put(&[edge.set_point[0], edge.set_point[1], edge.error[0], edge.error[1]]);
            put(&[edge.applied.acceleration, edge.applied.turn_rate, edge.rates[0], edge.rates[1]]);
        }
        for prop in &record.snapshot.props {
            put(&prop.position);
            put(&prop.rotation);
        }
        for contact in &record.contacts {
            put(&[contact.begin, contact.end, contact.impulse]);
        }
        for frame in &record.frames {
            let Relative { distance, bearing, view_angle } = frame.measurement.relative;
            put(&[frame.measurement.stamp, frame.arrival, distance, bearing, view_angle]);
        }
        self.hash.update(&self.bytes);
    }

    /// 32 hexadecimal digits.
    pub fn text(&self) -> String {
        format!("{:032x}", self.hash.digest128())
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
        assert_eq!(digest(&[]).len(), 32);
    }
}
