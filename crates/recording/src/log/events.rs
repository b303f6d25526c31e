//! What happened to the formation, as a message: a sentence for people, codes for reading it back.

use super::messages::thing;
use super::record::{Fields, Record};
use vocabulary::{EntityId, EventRecord, FleetInfo, TourGoal};

/// An event and its sentence.
#[derive(Default)]
pub(super) struct EventMessage {
    pub(super) event: EventRecord,
    words: String,
}

impl EventMessage {
    pub(super) fn new(event: &EventRecord, fleet: &FleetInfo) -> Self {
        Self { event: *event, words: event.words(fleet) }
    }
}

impl Record for EventMessage {
    const NAME: &'static str = "Event";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Self { event, words } = self;
        f.text("words", words)?;
        f.word("kind", &mut event.kind)?;
        f.count("robot_index", &mut event.robot)?;
        number(f, "event_number", &mut event.event)?;
        number(f, "leader_number", &mut event.leader)?;
        f.word("refusal", &mut event.refusal)?;
        let mut obstacle = event.obstacle.unwrap_or(EntityId::Ground);
        thing(f, ["obstacle_kind", "obstacle_index"], &mut obstacle)?;
        event.obstacle = Some(obstacle).filter(|thing| *thing != EntityId::Ground);
        f.several(["measured", "bound"], event.measured.each_mut())?;
        let (mut goal, mut round) = (event.goal.map(|at| at.goal), event.goal.and_then(|at| at.round));
        number(f, "goal_number", &mut goal)?;
        number(f, "round_number", &mut round)?;
        event.goal = goal.map(|goal| TourGoal { goal, round });
        Some(())
    }
}

/// A number that is counted from 1, since 0 is none.
fn number<F: Fields>(f: &mut F, name: &'static str, value: &mut Option<usize>) -> Option<()> {
    let mut counted = value.map_or(0, |value| value as u64 + 1);
    f.count(name, &mut counted)?;
    *value = counted.checked_sub(1).and_then(|value| usize::try_from(value).ok());
    Some(())
}
