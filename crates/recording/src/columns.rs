//! What the tables of a run have in their columns: a function for every kind of row.

use crate::{Column, NamedColumn, TableKind};
use vocabulary::{
    Constraint, Contact, EdgeState, EntityId, EventRecord, FleetInfo, LawQuantity, MeasurementRecord,
    Placement, PlannedPath, PlannedPoint, Pose, RobotState, SafetyState, Word,
};

/// A value of a row.
pub(crate) enum Cell<'a> {
    Text(&'a str),
    Number(f64),
    Flag(bool),
}

use Cell::{Flag, Number, Text};

/// Takes the values of a row one after the other, each with the name of its column, which ends in its unit.
pub(crate) type Row<'a> = dyn FnMut(&'static str, Cell<'_>) + 'a;

/// The columns of a table, empty, and their names.
pub(crate) fn empty(kind: TableKind) -> Vec<NamedColumn> {
    let mut columns = vec![];
    let mut add = |name, cell: Cell<'_>| {
        let column = match cell {
            Text(_) => Column::Text(vec![]),
            Number(_) => Column::Number(vec![]),
            Flag(_) => Column::Flag(vec![]),
        };
        columns.push(NamedColumn::new(name, column));
    };
    match kind {
        TableKind::Robots => robot(0.0, "", &RobotState::default(), &mut add),
        TableKind::Edges => edge(0.0, [""; 2], &EdgeState::default(), &mut add),
        TableKind::Contacts => contact([""; 2], &Contact::default(), &mut add),
        TableKind::Props => prop(0.0, "", &Placement::default(), &mut add),
        TableKind::Safety => safety(0.0, &FleetInfo::default(), &SafetyState::default(), &mut add),
        TableKind::Laws => law(0.0, "", &LawQuantity::default(), 0.0, &mut add),
        TableKind::Events => event(0.0, &FleetInfo::default(), &EventRecord::default(), &mut add),
        TableKind::Plans => plan(0.0, &FleetInfo::default(), &one_point(), &mut add),
        TableKind::Measurements => measurement([""; 2], &MeasurementRecord::default(), &mut add),
    }
    columns
}

fn numbers<const N: usize>(columns: [&'static str; N], values: [f64; N], row: &mut Row<'_>) {
    columns.into_iter().zip(values).for_each(|(column, value)| row(column, Number(value)));
}

/// A robot at a sample.
pub(crate) fn robot(time: f64, name: &str, robot: &RobotState, row: &mut Row<'_>) {
    let (m, a, [left, right, ..]) = (&robot.motion, &robot.attitude, &robot.wheels);
    row("time_s", Number(time));
    row("robot", Text(name));
    row("x_m", Number(m.pose.x));
    row("y_m", Number(m.pose.y));
    row("heading_rad", Number(m.pose.heading));
    row("speed_m_s", Number(m.speed));
    row("acceleration_m_s2", Number(m.acceleration));
    row("turn_rate_rad_s", Number(m.turn_rate));
    row("height_m", Number(a.height));
    row("roll_rad", Number(a.roll));
    row("pitch_rad", Number(a.pitch));
    row("steering_rad", Number(f64::midpoint(left.steering, right.steering)));
    row("condition", Text(robot.condition.word()));
}

/// An edge at a sample.
pub(crate) fn edge(time: f64, [leader, follower]: [&str; 2], edge: &EdgeState, row: &mut Row<'_>) {
    row("time_s", Number(time));
    row("leader", Text(leader));
    row("follower", Text(follower));
    numbers(["distance_m", "bearing_rad", "view_angle_rad"], edge.relative.coordinates(), row);
    numbers(["set_distance_m", "set_bearing_rad"], edge.set_point, row);
    row("heading_behind_rad", Number(edge.behind));
    numbers(["error_distance_m", "error_bearing_rad"], edge.error, row);
    row("asked_acceleration_m_s2", Number(edge.asked.acceleration));
    row("asked_turn_rate_rad_s", Number(edge.asked.turn_rate));
    row("applied_acceleration_m_s2", Number(edge.applied.acceleration));
    row("applied_turn_rate_rad_s", Number(edge.applied.turn_rate));
    numbers(["rate_distance_m_s", "rate_bearing_rad_s"], edge.rates, row);
    let seen = ["seen_distance_m", "seen_bearing_rad", "seen_view_angle_rad"];
    numbers(seen, edge.seen.coordinates(), row);
    row("age_s", Number(edge.age));
    row("sight", Text(edge.sight.word()));
    row("limited", Flag(edge.limited));
    row("too_close", Flag(edge.too_close));
    row("phase", Text(edge.phase.word()));
    row("displacement_m", Number(edge.displacement));
    row("narrowing", Number(edge.narrowing));
}

/// A contact that has ended.
pub(crate) fn contact([first, second]: [&str; 2], contact: &Contact, row: &mut Row<'_>) {
    row("first", Text(first));
    row("second", Text(second));
    row("begin_s", Number(contact.begin));
    row("end_s", Number(contact.end));
    numbers(["x_m", "y_m", "z_m"], contact.place, row);
    numbers(["normal_x", "normal_y", "normal_z"], contact.normal, row);
    row("impulse_n_s", Number(contact.impulse));
}

/// A prop that can move at a sample.
pub(crate) fn prop(time: f64, name: &str, placement: &Placement, row: &mut Row<'_>) {
    row("time_s", Number(time));
    row("prop", Text(name));
    numbers(["x_m", "y_m", "z_m"], placement.position, row);
    numbers(["qx", "qy", "qz", "qw"], placement.rotation, row);
}

/// A measurement that has arrived.
pub(crate) fn measurement([leader, follower]: [&str; 2], frame: &MeasurementRecord, row: &mut Row<'_>) {
    let (measured, region) = (&frame.measurement, &frame.region);
    row("leader", Text(leader));
    row("follower", Text(follower));
    row("outcome", Text(frame.outcome.word()));
    row("stamp_s", Number(measured.stamp));
    row("arrival_s", Number(frame.arrival));
    row("faces", Number(frame.faces() as f64));
    numbers(["distance_m", "bearing_rad", "view_angle_rad"], measured.relative.coordinates(), row);
    let truth = ["true_distance_m", "true_bearing_rad", "true_view_angle_rad"];
    numbers(truth, frame.truth.coordinates(), row);
    let deviation = ["deviation_distance_m", "deviation_bearing_rad", "deviation_view_angle_rad"];
    numbers(deviation, measured.deviation, row);
    row("pan_rad", Number(frame.pan));
    let sides = ["region_x_px", "region_y_px", "region_width_px", "region_height_px"];
    numbers(sides, [region.x, region.y, region.width, region.height].map(f64::from), row);
}

/// Names of constraints, one after the other.
pub(crate) fn names(fleet: &FleetInfo, list: &[Constraint]) -> String {
    list.iter().map(|constraint| constraint.name(fleet)).collect::<Vec<_>>().join(", ")
}

/// What a safety filter did at a sample.
pub(crate) fn safety(time: f64, fleet: &FleetInfo, state: &SafetyState, row: &mut Row<'_>) {
    let barriers: Vec<Constraint> = state.barriers.iter().map(|barrier| barrier.constraint).collect();
    row("time_s", Number(time));
    row("robot", Text(fleet.robots.get(state.robot).map_or("", |robot| &robot.name)));
    row("wished_acceleration_m_s2", Number(state.wished.acceleration));
    row("wished_turn_rate_rad_s", Number(state.wished.turn_rate));
    row("applied_acceleration_m_s2", Number(state.applied.acceleration));
    row("applied_turn_rate_rad_s", Number(state.applied.turn_rate));
    row("moved_m_s2", Number(state.moved));
    row("room_m", Number(state.least_room().map_or(f64::INFINITY, |barrier| barrier.value)));
    row("slack_m_s", Number(state.least_slack().unwrap_or(f64::INFINITY)));
    numbers(["relaxed_collisions", "relaxed_views"], state.relaxed, row);
    row("barriers", Text(&names(fleet, &barriers)));
    row("acting", Text(&names(fleet, &state.acting)));
    row("conflict", Text(&names(fleet, &state.conflict)));
}

/// A number of a custom law at a sample.
pub(crate) fn law(time: f64, follower: &str, quantity: &LawQuantity, value: f64, row: &mut Row<'_>) {
    row("time_s", Number(time));
    row("follower", Text(follower));
    row("quantity", Text(&quantity.name));
    row("value", Number(value));
    row("unit", Text(&quantity.unit));
}

/// Something that happened to the formation.
pub(crate) fn event(time: f64, fleet: &FleetInfo, event: &EventRecord, row: &mut Row<'_>) {
    let name = |robot: usize| fleet.name(EntityId::Robot(robot));
    row("time_s", Number(time));
    row("kind", Text(event.kind.word()));
    row("robot", Text(name(event.robot)));
    row("leader", Text(event.leader.map_or("", name)));
    row("refusal", Text(event.refusal.word()));
    row("words", Text(&event.words(fleet)));
}

/// The points of a plan, robot by robot.
pub(crate) fn plan(time: f64, fleet: &FleetInfo, plan: &PlannedPath, row: &mut Row<'_>) {
    let name = |robot: usize| fleet.robots.get(robot).map_or("", |robot| &*robot.name);
    let lead = plan.lead().map_or("", name);
    for point in &plan.points {
        for (robot, pose) in plan.robots.iter().zip(&point.poses) {
            row("time_s", Number(time));
            row("lead", Text(lead));
            row("robot", Text(name(*robot)));
            row("due_s", Number(point.time));
            row("x_m", Number(pose.x));
            row("y_m", Number(pose.y));
            row("heading_rad", Number(pose.heading));
            row("lead_speed_m_s", Number(point.speed));
            row("narrowing", Number(point.narrowing));
        }
    }
}

/// A plan of one row.
fn one_point() -> PlannedPath {
    let point = PlannedPoint { poses: vec![Pose::default()], ..PlannedPoint::default() };
    PlannedPath { robots: vec![0], points: vec![point] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `docs/formats.md` has the columns that there are, in their order.
    #[test]
    fn the_documentation_names_every_column() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/formats.md");
        let text = std::fs::read_to_string(path).expect("the page");
        for (name, kind, _) in TableKind::WORDS {
            let start = text.find(&format!("**`{name}`**")).expect("a paragraph");
            let paragraph = text[start..].split("\n\n").next().expect("an end");
            let named: Vec<&str> = paragraph.split('`').skip(3).step_by(2).collect();
            let empty = empty(*kind);
            let columns: Vec<&str> = empty.iter().map(|column| &*column.name).collect();
            assert_eq!(named, columns, "{name}");
        }
    }
}
