//! What happened to the formation, as a message: a sentence for people, codes for reading it back.

use super::messages::thing;
use super::record::{Fields, Record};
use vocabulary::{EntityId, EventRecord, FleetInfo};

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
        // Both are counted from 1, since 0 is none.
        let mut number = event.event.map_or(0, |event| event as u64 + 1);
        f.count("event_number", &mut number)?;
        event.event = number.checked_sub(1).and_then(|event| usize::try_from(event).ok());
        let mut leader = event.leader.map_or(0, |leader| leader as u64 + 1);
        f.count("leader_number", &mut leader)?;
        event.leader = leader.checked_sub(1).and_then(|leader| usize::try_from(leader).ok());
        f.word("refusal", &mut event.refusal)?;
        let mut obstacle = event.obstacle.unwrap_or(EntityId::Ground);
        thing(f, ["obstacle_kind", "obstacle_index"], &mut obstacle)?;
        event.obstacle = Some(obstacle).filter(|thing| *thing != EntityId::Ground);
        f.several(["measured", "bound"], event.measured.each_mut())
    }
}
