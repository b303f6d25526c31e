//! A course for tests and for looking: props of all kinds, hills, ice, and robots that stand on the ground.

use std::sync::Arc;
use vocabulary::math;
use vocabulary::{
    Attitude, Body, Condition, Contact, EntityId, FleetInfo, Mobility, Placement, Pose, Prop, RobotInfo,
    Solid, StepRecord, Terrain,
};

/// Big wheels on 1/10 of a truck.
pub(crate) const TRUCK: Body =
    Body { length: 0.49, width: 0.39, height: 0.32, wheelbase: 0.30, track: 0.285, wheel_radius: 0.0825 };
/// A car for people.
pub(crate) const CAR: Body =
    Body { length: 4.5, width: 1.8, height: 1.45, wheelbase: 2.7, track: 1.55, wheel_radius: 0.32 };
/// Turns on the spot.
pub(crate) const ROVER: Body =
    Body { length: 0.42, width: 0.40, height: 0.25, wheelbase: 0.2, track: 0.34, wheel_radius: 0.0825 };

/// A prop that stands upright at (x, y), turned by `heading`.
pub(crate) fn prop(solid: Solid, mobility: Mobility, x: f64, y: f64, heading: f64) -> Prop {
    let placement = Placement::upright(Pose::new(x, y, heading), 0.0);
    Prop { name: format!("prop at {x} {y}"), solid, placement, mobility }
}

/// Twenty props around the origin.
pub(crate) fn props() -> Vec<Prop> {
    use Mobility::{Fixed, Guided, Loose};
    let block = |x: f64, y: f64, z: f64| Solid::Block { size: [x, y, z] };
    let crate_of = |side: f64| block(side, side, side);
    let cone = Solid::Cone { radius: 0.12, height: 0.32 };
    let mut all = vec![
        prop(block(4.0, 0.15, 0.5), Fixed, 6.5, 2.6, 0.25),
        prop(block(0.15, 2.5, 0.5), Fixed, 8.6, 1.6, 0.25),
        prop(Solid::Cylinder { radius: 0.15, height: 1.1 }, Fixed, 4.2, 1.2, 0.0),
        prop(Solid::Cylinder { radius: 0.15, height: 1.1 }, Fixed, 4.2, -1.4, 0.0),
        prop(Solid::Wedge { size: [1.2, 0.8, 0.22] }, Fixed, 1.6, -2.4, 0.3),
        prop(Solid::Wedge { size: [0.7, 0.6, 0.15] }, Fixed, 3.1, 2.6, 2.2),
        prop(crate_of(0.3), Loose, 5.6, -0.4, 0.4),
        prop(crate_of(0.3), Loose, 5.95, -0.55, 0.9),
        prop(crate_of(0.22), Loose, 2.3, 0.9, 0.1),
        prop(block(0.4, 0.3, 0.2), Loose, 2.7, 1.3, 0.7),
        prop(Solid::Cylinder { radius: 0.14, height: 0.4 }, Loose, 6.4, -1.4, 0.0),
        prop(block(0.5, 0.35, 0.4), Guided, 6.9, 0.7, 1.0),
        prop(Solid::Cylinder { radius: 0.2, height: 0.5 }, Guided, 7.4, -1.9, 1.0),
        prop(block(1.0, 0.5, 0.12), Fixed, -1.6, 1.6, -0.2),
    ];
    all.extend(
        (0..6).map(|k| prop(cone, Loose, 1.0 + 1.1 * f64::from(k), -0.9 - 0.25 * f64::from(k % 2), 0.0)),
    );
    let top = crate_of(0.2);
    let mut stacked = prop(top, Loose, 5.62, -0.42, 0.9);
    stacked.placement.position[2] = 0.3;
    all.push(stacked);
    all
}

/// Hills of half a metre, level around the origin, with a sheet of ice.
pub(crate) fn hills() -> Terrain {
    let (cell, side) = (0.25, 121);
    let origin = [-12.0, -15.0];
    let place = |k: usize| (origin[0] + (k % side) as f64 * cell, origin[1] + (k / side) as f64 * cell);
    let height = |k: usize| {
        let (x, y) = place(k);
        let swell =
            0.22 * math::sin(0.9 * x) * math::cos(0.7 * y + 0.4) + 0.10 * math::sin(1.9 * x + 1.1 * y);
        let hill = 1.5 * math::exp(-(math::powi(x - 9.0, 2) + math::powi(y - 3.5, 2)) / 9.0);
        let ditch = -0.25 * math::exp(-math::powi(y + 4.0, 2) / 0.3);
        swell + hill + ditch
    };
    let grip = |k: usize| {
        let (x, y) = place(k);
        if math::hypot(x - 1.5, y - 2.2) < 1.4 { 0.25 } else { 1.0 }
    };
    let count = side * side;
    Terrain {
        origin,
        cell,
        columns: side,
        rows: side,
        heights: (0..count).map(height).collect(),
        grip: (0..count).map(grip).collect(),
    }
}

/// Puts every prop of a cast on its terrain.
fn settle(fleet: &mut FleetInfo) {
    let Some(terrain) = fleet.terrain.clone() else { return };
    for prop in &mut fleet.props {
        let [x, y, z] = prop.placement.position;
        prop.placement.position = [x, y, z + terrain.at(x, y).height];
    }
}

/// Gives a cast bodies, and hills and props to drive among.
pub(crate) fn furnish(fleet: &mut FleetInfo, body: Body, hilly: bool, with_props: bool) {
    for (k, member) in fleet.robots.iter_mut().enumerate() {
        *member = RobotInfo::new(member.name.clone(), member.leads, body);
        member.shell = member.shell.map(|shell| shell.tagged(k));
    }
    fleet.terrain = hilly.then(|| Arc::new(hills()));
    fleet.props = if with_props { props() } else { vec![] };
    settle(fleet);
}

/// A contact at a place.
pub(crate) fn touch(number: u64, begin: f64, place: [f64; 3]) -> Contact {
    Contact {
        number,
        things: [EntityId::Robot(0), EntityId::Prop(0)],
        begin,
        end: begin,
        open: true,
        place,
        normal: [1.0, 0.0, 0.0],
        impulse: 1.0,
    }
}

/// Robots as they stand on the terrain of a cast, and its props where they start.
pub(crate) fn grounded(fleet: &FleetInfo, mut record: StepRecord) -> StepRecord {
    record.snapshot.props = fleet.props.iter().map(|p| p.placement).collect();
    for (robot, member) in record.snapshot.robots.iter_mut().zip(&fleet.robots) {
        for wheel in &mut robot.wheels {
            wheel.rotation *= 0.045 / member.body.wheel_radius;
        }
        let Some(terrain) = &fleet.terrain else { continue };
        let pose = robot.motion.pose;
        let at = |forward: f64, left: f64| {
            let [x, y] = pose.world_from_body(forward, left);
            terrain.at(x, y).height
        };
        let (base, half) = (member.body.wheelbase, 0.5 * member.body.track);
        let wheels = [at(base, half), at(base, -half), at(0.0, half), at(0.0, -half)];
        let front = 0.5 * (wheels[0] + wheels[1]);
        let rear = 0.5 * (wheels[2] + wheels[3]);
        let left = 0.5 * (wheels[0] + wheels[2]) - 0.5 * (wheels[1] + wheels[3]);
        robot.attitude = Attitude {
            height: rear,
            roll: math::atan2(left, 2.0 * half),
            pitch: -math::atan2(front - rear, base),
        };
    }
    record
}

/// A moment of the same robots farther apart.
pub(crate) fn enlarge(record: &mut StepRecord, scale: f64) {
    for robot in &mut record.snapshot.robots {
        let pose = &mut robot.motion.pose;
        (pose.x, pose.y) = (scale * pose.x, scale * pose.y);
    }
    for edge in &mut record.edges {
        edge.relative.distance *= scale;
        edge.set_point[0] *= scale;
        edge.error[0] *= scale;
    }
}

/// Lays a robot on its roof.
pub(crate) fn overturn(fleet: &FleetInfo, record: &mut StepRecord, robot: usize) {
    let state = &mut record.snapshot.robots[robot];
    state.attitude.roll = 2.9;
    state.attitude.height += fleet.robots[robot].body.height + 0.1;
    state.condition = Condition::Overturned;
}
