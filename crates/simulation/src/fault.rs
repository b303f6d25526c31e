//! What ends a run before its time: pictures that cannot be taken, a law that gives no commands, or a number that is not
//! finite.

use std::fmt;
use thiserror::Error;
use vocabulary::{
    Contact, Edge, EdgeState, EntityId, FleetInfo, MeasurementRecord, Motion, Placement, RobotState,
    SafetyState, StepRecord,
};

/// Why a run ended before its time.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Fault {
    /// Cameras could not take their pictures.
    #[error("{0}")]
    CameraRenderer(String),
    /// A quantity is not a finite number.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
    /// A law for many followers gave no commands.
    #[error("{0}")]
    Law(String),
}

/// A quantity that is not a finite number. Its record is in no table, log or picture.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct NotFinite {
    /// The robots or the prop that it belongs to.
    pub whose: String,
    /// What it is.
    pub quantity: &'static str,
    /// s.
    pub time: f64,
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { whose, quantity, time } = self;
        write!(f, "the {quantity} of {whose} is not a finite number at {time:.2} s")
    }
}

/// The first quantity of `record` that is not a finite number.
pub(crate) fn not_finite(record: &StepRecord, fleet: &FleetInfo) -> Option<NotFinite> {
    let StepRecord { snapshot, edges, contacts, frames, safety, laws: _, leaders: _, events: _, plans: _ } =
        record;
    let named = |thing| format!("`{}`", fleet.name(thing));
    let found = |whose: String, quantity| NotFinite { whose, quantity, time: snapshot.time };
    let mut robots = snapshot.robots.iter().enumerate();
    if let Some((k, quantity)) = robots.find_map(|(k, robot)| Some((k, of_robot(robot)?))) {
        return Some(found(named(EntityId::Robot(k)), quantity));
    }
    let between = |edge: usize| {
        let quoted = |edge: &Edge| fleet.pair(*edge).map(|name| format!("`{name}`")).join(" → ");
        fleet.edges.get(edge).map_or_else(String::new, quoted)
    };
    if let Some((k, quantity)) = edges.iter().enumerate().find_map(|(k, edge)| Some((k, of_edge(edge)?))) {
        return Some(found(between(k), quantity));
    }
    if let Some(k) = snapshot.props.iter().position(|prop| !is_placed(prop)) {
        return Some(found(named(EntityId::Prop(k)), "placement"));
    }
    if let Some(contact) = contacts.iter().find(|contact| !is_told(contact)) {
        let [a, b] = contact.things.map(named);
        return Some(found(format!("{a} and {b}"), "contact"));
    }
    if let Some(frame) = frames.iter().find(|frame| !is_seen(frame)) {
        return Some(found(between(frame.edge), "measurement"));
    }
    let state = safety.iter().find(|state| !is_filtered(state))?;
    Some(found(named(EntityId::Robot(state.robot)), "filtered command"))
}

fn finite<const N: usize>(values: [f64; N]) -> bool {
    values.into_iter().all(f64::is_finite)
}

/// Name of the first group whose numbers are not all finite.
fn first<const N: usize>(groups: [(&'static str, bool); N]) -> Option<&'static str> {
    groups.into_iter().find(|(_, good)| !good).map(|(name, _)| name)
}

fn of_robot(robot: &RobotState) -> Option<&'static str> {
    let RobotState { motion, attitude, wheels, camera_pan, condition: _ } = robot;
    let Motion { pose, speed, acceleration, turn_rate } = *motion;
    first([
        ("position", finite([pose.x, pose.y])),
        ("heading", pose.heading.is_finite()),
        ("speed", speed.is_finite()),
        ("acceleration", acceleration.is_finite()),
        ("turn rate", turn_rate.is_finite()),
        ("height or tilt", finite([attitude.height, attitude.roll, attitude.pitch])),
        ("motion of a wheel", wheels.iter().all(|w| finite([w.rotation, w.steering, w.compression]))),
        ("direction of the camera", camera_pan.is_finite()),
    ])
}

fn of_edge(edge: &EdgeState) -> Option<&'static str> {
    first([
        ("relative position", finite(edge.relative.coordinates())),
        ("relative position as seen", finite(edge.seen.coordinates()) && edge.age.is_finite()),
        ("set point", finite(edge.set_point)),
        ("error", finite(edge.error)),
        ("command asked for", finite([edge.asked.acceleration, edge.asked.turn_rate])),
        ("command", finite([edge.applied.acceleration, edge.applied.turn_rate])),
        ("estimate", finite(edge.rates) && finite(edge.estimate)),
    ])
}

fn is_placed(prop: &Placement) -> bool {
    finite(prop.position) && finite(prop.rotation)
}

fn is_told(contact: &Contact) -> bool {
    finite(contact.place) && finite(contact.normal) && finite([contact.begin, contact.end, contact.impulse])
}

fn is_filtered(state: &SafetyState) -> bool {
    let SafetyState { wished, applied, moved, relaxed, barriers, .. } = state;
    let commands = [wished.acceleration, wished.turn_rate, applied.acceleration, applied.turn_rate];
    finite(commands)
        && moved.is_finite()
        && finite(*relaxed)
        && barriers.iter().all(|barrier| finite([barrier.value, barrier.slack, barrier.direction]))
}

fn is_seen(frame: &MeasurementRecord) -> bool {
    let MeasurementRecord { measurement, arrival, truth, pan, .. } = frame;
    let places = [measurement.relative, *truth].iter().all(|r| finite(r.coordinates()));
    let corners = frame.tags.iter().flatten().flatten().all(|corner| finite(*corner));
    places && corners && finite(measurement.deviation) && finite([measurement.stamp, *arrival, *pan])
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, Edge, RobotInfo};

    #[test]
    fn what_is_no_number_is_named_with_its_owner_and_time() {
        let member = |name: &str| RobotInfo::new(name, name == "ann", Body::default());
        let fleet = FleetInfo {
            robots: vec![member("ann"), member("bob")],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..FleetInfo::default()
        };
        let mut record = StepRecord::default();
        record.snapshot.time = 2.5;
        record.snapshot.robots = vec![RobotState::default(); 2];
        record.edges = vec![EdgeState::default()];
        assert_eq!(not_finite(&record, &fleet), None);
        record.edges[0].applied.turn_rate = f64::INFINITY;
        let told = not_finite(&record, &fleet).expect("an edge").to_string();
        assert_eq!(told, "the command of `ann` → `bob` is not a finite number at 2.50 s");
        record.snapshot.robots[1].motion.turn_rate = f64::NAN;
        let told = not_finite(&record, &fleet).expect("a robot").to_string();
        assert_eq!(told, "the turn rate of `bob` is not a finite number at 2.50 s");
    }
}
