//! What a safety filter did with a command: which barriers acted, and how far the command was moved.

use crate::{Command, EntityId, FleetInfo};

/// A bound on the command [dv/dt, ω] of a robot, named by what it keeps the robot from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Constraint {
    /// It cannot brake harder.
    #[default]
    Braking,
    /// It cannot accelerate harder.
    Driving,
    /// It cannot turn faster to the left.
    LeftTurn,
    /// It cannot turn faster to the right.
    RightTurn,
    /// It must not come closer to this robot.
    Robot(usize),
    /// It must not come closer to this prop.
    Prop(usize),
    /// It must stay within this side of its arena: 0 smallest x, 1 smallest y, 2 largest x, 3 largest y.
    Edge(usize),
    /// Its leader must stay near enough to be seen.
    ViewDistance,
    /// Its leader must not leave the picture on the left.
    ViewLeft,
    /// Its leader must not leave the picture on the right.
    ViewRight,
}

/// One barrier at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BarrierState {
    /// What it keeps the robot from.
    pub constraint: Constraint,
    /// The barrier function h: m of room beyond the margin, or rad of the view; below zero the set is left.
    pub value: f64,
    /// Room that the applied command leaves of its row A u ≥ b, in the row's unit; below zero where it had to give way.
    pub slack: f64,
    /// Direction from the robot to what it is about, rad in the world's frame.
    pub direction: f64,
}

/// What the filter of one robot did at a control sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SafetyState {
    /// Whose filter it is.
    pub robot: usize,
    /// What was decided, within the robot's limits.
    pub wished: Command,
    /// What the filter made of it.
    pub applied: Command,
    /// How far it moved the command: √((a − a₀)² + max(v, 0.25 m/s)² (ω − ω₀)²), m/s².
    pub moved: f64,
    /// What [the collision barriers, the view barriers] had to give way by, together; 0 where they leave a command.
    pub relaxed: [f64; 2],
    /// The barriers and limits that hold the command where it is: one on an edge of what is left, two in a corner.
    pub acting: Vec<Constraint>,
    /// Two or three constraints that leave no command, the first conflict met; empty where there is one.
    pub conflict: Vec<Constraint>,
    /// The barriers that forbid some command within the limits, the tightest first.
    pub barriers: Vec<BarrierState>,
}

impl Constraint {
    /// The word of its kind, and the index of what it is about; 0 where it is about nothing more.
    pub fn code(self) -> [usize; 2] {
        match self {
            Self::Braking => [0, 0],
            Self::Driving => [1, 0],
            Self::LeftTurn => [2, 0],
            Self::RightTurn => [3, 0],
            Self::Robot(index) => [4, index],
            Self::Prop(index) => [5, index],
            Self::Edge(side) => [6, side],
            Self::ViewDistance => [7, 0],
            Self::ViewLeft => [8, 0],
            Self::ViewRight => [9, 0],
        }
    }

    /// The words of the kinds, in the order of [`Constraint::code`].
    pub const KINDS: [&'static str; 10] = [
        "braking",
        "driving",
        "left_turn",
        "right_turn",
        "robot",
        "prop",
        "edge",
        "view_distance",
        "view_left",
        "view_right",
    ];

    /// The constraint of a code; `None` where there is none.
    pub fn of_code([kind, index]: [usize; 2]) -> Option<Self> {
        Some(match kind {
            0 => Self::Braking,
            1 => Self::Driving,
            2 => Self::LeftTurn,
            3 => Self::RightTurn,
            4 => Self::Robot(index),
            5 => Self::Prop(index),
            6 => Self::Edge(index),
            7 => Self::ViewDistance,
            8 => Self::ViewLeft,
            9 => Self::ViewRight,
            _ => return None,
        })
    }

    /// Whether it is about the leader's picture.
    pub fn is_view(self) -> bool {
        matches!(self, Self::ViewDistance | Self::ViewLeft | Self::ViewRight)
    }

    /// Whether its barrier is an angle, in rad.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::ViewLeft | Self::ViewRight)
    }

    /// Whether its name is that of a robot or a prop.
    fn is_named(self) -> bool {
        matches!(self, Self::Robot(_) | Self::Prop(_))
    }

    /// Whether it is what the robot's actuators can do.
    pub fn is_limit(self) -> bool {
        matches!(self, Self::Braking | Self::Driving | Self::LeftTurn | Self::RightTurn)
    }

    /// As people say it: the name of a robot or prop, else words.
    pub fn name(self, fleet: &FleetInfo) -> &str {
        match self {
            Self::Robot(index) => fleet.name(EntityId::Robot(index)),
            Self::Prop(index) => fleet.name(EntityId::Prop(index)),
            Self::Edge(side) => ["west edge", "south edge", "east edge", "north edge"][side % 4],
            Self::Braking => "braking limit",
            Self::Driving => "driving limit",
            Self::LeftTurn => "left turn limit",
            Self::RightTurn => "right turn limit",
            Self::ViewDistance => "view distance",
            Self::ViewLeft => "left of the view",
            Self::ViewRight => "right of the view",
        }
    }
}

/// A command that is moved by less is not, m/s².
const MOVED: f64 = 1e-6;

/// Constraints in a sentence: robots and props by their names, everything else with its article.
fn list(constraints: &[Constraint], fleet: &FleetInfo) -> String {
    let said = |constraint: &Constraint| {
        let article = if constraint.is_named() { "" } else { "the " };
        format!("{article}{}", constraint.name(fleet))
    };
    let all: Vec<String> = constraints.iter().map(said).collect();
    match all.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [some @ .., last] => format!("{} and {last}", some.join(", ")),
    }
}

impl SafetyState {
    /// What leaves no command, as "no way between bob, wall-2 and the left of the view"; `None` where there is one.
    pub fn conflict_words(&self, fleet: &FleetInfo) -> Option<String> {
        let alone = self.conflict.len() == 1;
        let preposition = if alone { "past" } else { "between" };
        (!self.conflict.is_empty()).then(|| format!("no way {preposition} {}", list(&self.conflict, fleet)))
    }

    /// The barriers that hold the command where it is, as "bob and the north edge"; `None` where limits alone do, or
    /// nothing moves it.
    pub fn acting_words(&self, fleet: &FleetInfo) -> Option<String> {
        let acting = self.acting.iter().filter(|constraint| self.is_moved() && !constraint.is_limit());
        let acting: Vec<Constraint> = acting.copied().collect();
        (!acting.is_empty()).then(|| list(&acting, fleet))
    }

    /// The least slack of its barriers: the room that the applied command leaves, in the unit of the row; `None` where
    /// nothing is near.
    pub fn least_slack(&self) -> Option<f64> {
        self.barriers.iter().map(|barrier| barrier.slack).min_by(f64::total_cmp)
    }

    /// Whether it moved the command, beyond rounding.
    pub fn is_moved(&self) -> bool {
        self.moved > MOVED
    }

    /// The least value of a barrier that keeps the robot from running into something, m; `None` where none is near.
    pub fn least_room(&self) -> Option<&BarrierState> {
        let near = self.barriers.iter().filter(|barrier| !barrier.constraint.is_view());
        near.min_by(|a, b| a.value.total_cmp(&b.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_leads_back_to_its_constraint() {
        for kind in 0..Constraint::KINDS.len() {
            let constraint = Constraint::of_code([kind, 3]).expect("a kind");
            assert_eq!(constraint.code()[0], kind);
            assert_eq!(Constraint::of_code(constraint.code()), Some(constraint));
        }
        assert_eq!(Constraint::of_code([Constraint::KINDS.len(), 0]), None);
    }

    #[test]
    fn what_acts_and_what_leaves_no_command_is_said_in_a_sentence() {
        let robot = |name: &str| crate::RobotInfo::new(name, false, crate::Body::default());
        let fleet = FleetInfo { robots: vec![robot("ann"), robot("bob")], ..FleetInfo::default() };
        let mut state = SafetyState {
            moved: 0.4,
            acting: vec![Constraint::Braking, Constraint::Robot(1), Constraint::Edge(3)],
            conflict: vec![Constraint::Robot(1), Constraint::LeftTurn, Constraint::ViewLeft],
            ..SafetyState::default()
        };
        assert_eq!(state.acting_words(&fleet).as_deref(), Some("bob and the north edge"));
        let conflict = "no way between bob, the left turn limit and the left of the view";
        assert_eq!(state.conflict_words(&fleet).as_deref(), Some(conflict));
        (state.moved, state.conflict) = (0.0, vec![Constraint::Robot(1)]);
        assert_eq!((state.acting_words(&fleet), state.least_slack()), (None, None));
        assert_eq!(state.conflict_words(&fleet).as_deref(), Some("no way past bob"));
        let barrier = |slack| BarrierState { slack, ..BarrierState::default() };
        state.barriers = vec![barrier(0.3), barrier(-0.1)];
        assert_eq!(state.least_slack(), Some(-0.1));
    }
}
