//! The numbers of a moment as matrices, for those who compute with them: a row per robot or edge, and the columns that the
//! tables have.

use crate::columns::{self, Cell};
use vocabulary::{EdgeState, FleetInfo, RobotState, StepRecord};

/// The time is one number, not a column.
const TIME: &str = "time_s";

/// Names of the columns of [`robot_numbers`], which end in their units.
pub fn robot_columns() -> Vec<&'static str> {
    let mut names = vec![];
    columns::robot(0.0, "", &RobotState::default(), &mut |name, cell| {
        names.extend(number(name, &cell).map(|_| name));
    });
    names
}

/// Names of the columns of [`edge_numbers`], which end in their units.
pub fn edge_columns() -> Vec<&'static str> {
    let mut names = vec![];
    columns::edge(0.0, [""; 2], &EdgeState::default(), &mut |name, cell| {
        names.extend(number(name, &cell).map(|_| name));
    });
    names
}

/// The numbers of all robots, robot by robot, in the order of [`FleetInfo::robots`].
pub fn robot_numbers(record: &StepRecord) -> Vec<f64> {
    let mut numbers = vec![];
    for robot in &record.snapshot.robots {
        columns::robot(0.0, "", robot, &mut |name, cell| numbers.extend(number(name, &cell)));
    }
    numbers
}

/// The numbers of all edges, edge by edge, in the order of [`FleetInfo::edges`]; NaN where the follower follows nobody.
/// Flags are 0 or 1.
pub fn edge_numbers(fleet: &FleetInfo, record: &StepRecord) -> Vec<f64> {
    let mut numbers = vec![];
    for (index, state) in record.edges.iter().enumerate() {
        let follows = record.edge(fleet, index).is_some();
        columns::edge(0.0, [""; 2], state, &mut |name, cell| {
            numbers.extend(number(name, &cell).map(|value| if follows { value } else { f64::NAN }));
        });
    }
    numbers
}

/// The number in a cell, if there is one and it is not the time.
fn number(name: &str, cell: &Cell<'_>) -> Option<f64> {
    match cell {
        Cell::Number(value) if name != TIME => Some(*value),
        Cell::Flag(flag) => Some(f64::from(u8::from(*flag))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Edge, Snapshot};

    #[test]
    fn a_row_has_a_number_for_every_column() {
        let mut robots = vec![RobotState::default(); 2];
        robots[1].motion.pose.x = 3.0;
        let edge = EdgeState { limited: true, age: 0.5, ..EdgeState::default() };
        let record = StepRecord {
            snapshot: Snapshot { time: 1.0, robots, props: vec![] },
            edges: vec![edge; 2],
            leaders: vec![Some(0), None],
            ..StepRecord::default()
        };
        let fleet = FleetInfo { edges: vec![Edge { leader: 0, follower: 1 }; 2], ..FleetInfo::default() };
        let (names, numbers) = (robot_columns(), robot_numbers(&record));
        assert_eq!((numbers.len(), names[0]), (2 * names.len(), "x_m"));
        assert_eq!(numbers[names.len()], 3.0);
        let (names, numbers) = (edge_columns(), edge_numbers(&fleet, &record));
        assert_eq!(numbers.len(), 2 * names.len());
        let limited = names.iter().position(|name| *name == "limited").expect("a column");
        assert_eq!(numbers[limited], 1.0);
        assert!(numbers[names.len()..].iter().all(|value| value.is_nan()));
    }
}
