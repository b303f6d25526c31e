//! What happens to a formation while it drives: robots change their leader, fail, join and part.

use crate::{EntityId, FleetInfo, words};
use std::fmt;

words! {
    /// What happened to a robot, or should have.
    pub enum EventKind = Follow {
        /// It follows another robot from now on.
        Follow = "follow",
        /// It takes another place behind the robot that it follows.
        Move = "move",
        /// Those who follow it take their places anew.
        Assign = "assign",
        /// It follows nobody from now on, and drives on its own.
        Lead = "lead",
        /// It failed, and brakes to a stand.
        Stop = "stop",
        /// It failed, and rolls to a stand.
        Coast = "coast",
        /// It failed, and is taken away.
        Remove = "remove",
        /// Its leader failed and nobody else may lead it: it waits.
        Wait = "wait",
        /// It has waited in vain, or has been held up for too long, and stays where it is for good.
        GiveUp = "give_up",
        /// It takes another way to its goal.
        Reroute = "reroute",
        /// It has no way to its goal: it stops, and waits for one.
        Halt = "halt",
        /// It is at a goal.
        Arrive = "arrive",
        /// Its custom law gave a number that is not finite, or broke off: it brakes and stays where it is.
        LawFault = "law_fault",
    }
}

words! {
    /// Why an event did not take place.
    pub enum Refusal = None {
        /// It did.
        None = "none",
        /// The wanted leader follows that robot, directly or through others.
        Cycle = "cycle",
        /// The wanted leader has failed, or waits, or follows one that does.
        Leaderless = "leaderless",
        /// The robot itself has failed.
        Failed = "failed",
        /// The wanted leader is too far away.
        Far = "far",
        /// The wanted place is too near to the leader.
        Near = "near",
        /// The wanted place is too far away from the leader.
        PlaceFar = "place_far",
        /// The leader cannot be seen from the wanted place: it is too far ahead or beside it.
        Bearing = "bearing",
        /// Something stands between the two.
        Hidden = "hidden",
        /// On the leader's present curve the place moves faster than the robot can.
        Speed = "speed",
        /// There is no such place or robot any more.
        Nothing = "nothing",
        /// Another event came before it had taken hold.
        Overtaken = "overtaken",
        /// It is about a robot with several leaders, which keeps them.
        Several = "several",
    }
}

/// Which of the goals of a tour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TourGoal {
    /// Its number in a round, from 0.
    pub goal: usize,
    /// Number of the round, from 0; `None` where there is but one.
    pub round: Option<usize>,
}

impl fmt::Display for TourGoal {
    /// Both are counted from 1.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "goal {}", self.goal + 1)?;
        self.round.map_or(Ok(()), |round| write!(f, " in round {}", round + 1))
    }
}

/// An event of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EventRecord {
    /// What happened.
    pub kind: EventKind,
    /// To which robot.
    pub robot: usize,
    /// Whom it follows from now on, or should have followed.
    pub leader: Option<usize>,
    /// Why it did not happen; `Refusal::None` where it did.
    pub refusal: Refusal,
    /// What stands in the way of a refused event, with [`Refusal::Hidden`], or of a plan.
    pub obstacle: Option<EntityId>,
    /// What was measured, and the bound that it exceeds, m, rad or m/s; zero where a refusal is not about a number.
    pub measured: [f64; 2],
    /// Where a robot is that arrives, on a tour.
    pub goal: Option<TourGoal>,
    /// By which event of the scene, counted from 0 in its order; `None` where none asked for it at this moment.
    pub event: Option<usize>,
}

impl EventRecord {
    /// An event that takes place.
    pub fn done(kind: EventKind, robot: usize, leader: Option<usize>) -> Self {
        Self { kind, robot, leader, ..Self::default() }
    }

    /// Whether it took place.
    pub fn happened(&self) -> bool {
        self.refusal == Refusal::None
    }

    /// As people say it, in one sentence without its full stop.
    pub fn words(&self, fleet: &FleetInfo) -> String {
        let robot = fleet.name(EntityId::Robot(self.robot));
        let leader = self.leader.map_or("", |leader| fleet.name(EntityId::Robot(leader)));
        if self.happened() {
            return match self.kind {
                EventKind::Follow => format!("{robot} follows {leader}"),
                EventKind::Move => format!("{robot} takes another place behind {leader}"),
                EventKind::Assign => format!("those behind {robot} take their places anew"),
                EventKind::Lead => format!("{robot} drives on its own"),
                EventKind::Stop => format!("{robot} fails and stops"),
                EventKind::Coast => format!("{robot} fails and rolls to a stand"),
                EventKind::Remove => format!("{robot} fails and is taken away"),
                EventKind::Wait => format!("{robot} has lost its leader and waits"),
                EventKind::Reroute => format!("{robot} takes another way{}", self.around(fleet)),
                EventKind::Halt => format!("{robot} stops and looks for a way{}", self.around(fleet)),
                EventKind::Arrive => match self.goal {
                    Some(goal) => format!("{robot} is at {goal}"),
                    None => format!("{robot} is at its goal"),
                },
                EventKind::LawFault => format!("{robot} brakes: its law gives no command"),
                EventKind::GiveUp => format!("{robot} has waited in vain and stays where it is"),
            };
        }
        let wanted = match self.kind {
            EventKind::Follow => format!("{robot} cannot follow {leader}"),
            EventKind::Move => format!("{robot} cannot take another place behind {leader}"),
            EventKind::Assign => format!("those behind {robot} cannot take their places anew"),
            EventKind::Lead => format!("{robot} cannot drive on its own"),
            _ => format!("{robot} cannot fail"),
        };
        format!("{wanted}: {}", self.reason(fleet, leader))
    }

    /// What a way is planned around.
    fn around(&self, fleet: &FleetInfo) -> String {
        self.obstacle.map_or_else(String::new, |thing| format!(" around {}", fleet.name(thing)))
    }

    fn reason(&self, fleet: &FleetInfo, leader: &str) -> String {
        let [measured, bound] = self.measured;
        match self.refusal {
            Refusal::None => String::new(),
            Refusal::Cycle => format!("{leader} follows it"),
            Refusal::Leaderless => format!("{leader} does not drive, or follows one that does not"),
            Refusal::Failed => "it has failed".to_owned(),
            Refusal::Far => format!("it is {measured:.2} m away, more than {bound:.2} m"),
            Refusal::Near => format!("its place would be {measured:.2} m away, less than {bound:.2} m"),
            Refusal::PlaceFar => format!("its place would be {measured:.2} m away, more than {bound:.2} m"),
            Refusal::Bearing => format!(
                "from its place {leader} would be {:.0}° off straight ahead, more than {:.0}°",
                measured.to_degrees(),
                bound.to_degrees()
            ),
            Refusal::Hidden => match self.obstacle {
                Some(thing) => format!("{} stands between them", fleet.name(thing)),
                None => "the ground hides it".to_owned(),
            },
            Refusal::Speed => {
                format!("its place moves at {measured:.2} m/s, faster than the {bound:.2} m/s it can drive")
            }
            Refusal::Nothing if self.kind == EventKind::Assign => "there is nobody behind it".to_owned(),
            Refusal::Nothing => "there is nobody left to follow".to_owned(),
            Refusal::Overtaken => "another event came first".to_owned(),
            Refusal::Several => "who has several leaders keeps them".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, RobotInfo, Word};

    #[test]
    fn an_event_is_said_with_names_and_numbers() {
        let robots = ["ann", "bob"].map(|name| RobotInfo::new(name, false, Body::default())).to_vec();
        let fleet = FleetInfo { robots, ..FleetInfo::default() };
        let done = EventRecord::done(EventKind::Follow, 1, Some(0));
        assert_eq!(done.words(&fleet), "bob follows ann");
        let refused = EventRecord { refusal: Refusal::Far, measured: [5.25, 4.1], ..done };
        assert_eq!(refused.words(&fleet), "bob cannot follow ann: it is 5.25 m away, more than 4.10 m");
        let arrived = EventRecord::done(EventKind::Arrive, 0, None);
        assert_eq!(arrived.words(&fleet), "ann is at its goal");
        let goal = Some(TourGoal { goal: 1, round: None });
        assert_eq!(EventRecord { goal, ..arrived }.words(&fleet), "ann is at goal 2");
        let goal = Some(TourGoal { goal: 1, round: Some(2) });
        assert_eq!(EventRecord { goal, ..arrived }.words(&fleet), "ann is at goal 2 in round 3");
        for (_, refusal, _) in Refusal::WORDS {
            let words = EventRecord { refusal: *refusal, ..done }.words(&fleet);
            assert!(!words.ends_with(": "), "{words}");
        }
    }
}
