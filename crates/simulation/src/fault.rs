//! What ends a run before its time: pictures that cannot be taken, or a number that is none.

use std::fmt;
use thiserror::Error;
use vocabulary::{Cast, Contact, EdgeState, Frame, Moment, Motion, Placement, RobotState, Thing};

/// Why a run ended before its time.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Fault {
    /// Cameras could not take their pictures.
    #[error("{0}")]
    Eyes(String),
    /// A quantity is no finite number.
    #[error(transparent)]
    NotFinite(#[from] NotFinite),
}

/// A quantity that is no finite number: no table, log or picture has it.
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
        write!(f, "the {quantity} of {whose} is no finite number at {time:.2} s")
    }
}

/// The first quantity of `moment` that is no finite number.
pub(crate) fn not_finite(moment: &Moment, cast: &Cast) -> Option<NotFinite> {
    let Moment { snapshot, edges, contacts, frames } = moment;
    let named = |thing| format!("`{}`", cast.name(thing));
    let found = |whose: String, quantity| NotFinite { whose, quantity, time: snapshot.time };
    let mut robots = snapshot.robots.iter().enumerate();
    if let Some((k, quantity)) = robots.find_map(|(k, robot)| Some((k, of_robot(robot)?))) {
        return Some(found(named(Thing::Robot(k)), quantity));
    }
    let between = |edge: usize| {
        cast.edges.get(edge).map_or_else(String::new, |edge| {
            format!("{} → {}", named(Thing::Robot(edge.leader)), named(Thing::Robot(edge.follower)))
        })
    };
    if let Some((k, quantity)) = edges.iter().enumerate().find_map(|(k, edge)| Some((k, of_edge(edge)?))) {
        return Some(found(between(k), quantity));
    }
    if let Some(k) = snapshot.props.iter().position(|prop| !is_placed(prop)) {
        return Some(found(named(Thing::Prop(k)), "placement"));
    }
    if let Some(contact) = contacts.iter().find(|contact| !is_told(contact)) {
        let [a, b] = contact.things.map(named);
        return Some(found(format!("{a} and {b}"), "contact"));
    }
    let frame = frames.iter().find(|frame| !is_seen(frame))?;
    Some(found(between(frame.edge), "look"))
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
    let (truth, seen) = (edge.relative, edge.seen);
    first([
        ("relative position", finite([truth.distance, truth.bearing, truth.view_angle])),
        ("relative position as seen", finite([seen.distance, seen.bearing, seen.view_angle, edge.age])),
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

fn is_seen(frame: &Frame) -> bool {
    let Frame { sighting, arrival, truth, pan, .. } = frame;
    let places = [sighting.relative, *truth].iter().all(|r| finite([r.distance, r.bearing, r.view_angle]));
    let corners = frame.tags.iter().flatten().flatten().all(|corner| finite(*corner));
    places && corners && finite(sighting.deviation) && finite([sighting.stamp, *arrival, *pan])
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, Edge, Member};

    #[test]
    fn what_is_no_number_is_named_with_its_owner_and_time() {
        let member = |name: &str| Member::new(name, name == "ann", Body::default());
        let cast = Cast {
            members: vec![member("ann"), member("bob")],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..Cast::default()
        };
        let mut moment = Moment::default();
        moment.snapshot.time = 2.5;
        moment.snapshot.robots = vec![RobotState::default(); 2];
        moment.edges = vec![EdgeState::default()];
        assert_eq!(not_finite(&moment, &cast), None);
        moment.edges[0].applied.turn_rate = f64::INFINITY;
        let told = not_finite(&moment, &cast).expect("an edge").to_string();
        assert_eq!(told, "the command of `ann` → `bob` is no finite number at 2.50 s");
        moment.snapshot.robots[1].motion.turn_rate = f64::NAN;
        let told = not_finite(&moment, &cast).expect("a robot").to_string();
        assert_eq!(told, "the turn rate of `bob` is no finite number at 2.50 s");
    }
}
