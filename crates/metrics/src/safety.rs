//! What the safety filter of one robot did over a run.

use serde::Serialize;
use vocabulary::{Constraint, FleetInfo, SafetyState};

/// The filter of one robot over a run.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct SafetyMetrics {
    /// Share of the samples at which it moved the command.
    pub moved: f64,
    /// The farthest that it moved it, m/s².
    pub moved_max: f64,
    /// The least value of a barrier that forbade some command, m beyond the margin; `None` where none did.
    pub room_min: Option<f64>,
    /// To what.
    pub room_min_to: Option<String>,
    /// When that was, s.
    pub room_min_time: Option<f64>,
    /// Share of the samples at which [collision barriers, view barriers] left no command.
    pub relaxed: [f64; 2],
    /// What [collision barriers, view barriers] gave way by at most.
    pub relaxed_max: [f64; 2],
    /// What left no command when it was first so; empty where there was always one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub first_conflict: Vec<String>,
}

/// Running sums of one filter.
#[derive(Debug, Clone, Default)]
pub(crate) struct SafetySums {
    samples: u64,
    moved: u64,
    moved_max: f64,
    room: Option<(f64, Constraint, f64)>,
    relaxed: [u64; 2],
    relaxed_max: [f64; 2],
    first_conflict: Vec<Constraint>,
}

impl SafetySums {
    pub(crate) fn add(&mut self, time: f64, state: &SafetyState) {
        self.samples += 1;
        self.moved += u64::from(state.is_moved());
        self.moved_max = self.moved_max.max(state.moved);
        if let Some(barrier) = state.least_room()
            && self.room.is_none_or(|(least, ..)| barrier.value < least)
        {
            self.room = Some((barrier.value, barrier.constraint, time));
        }
        for class in 0..2 {
            self.relaxed[class] += u64::from(state.relaxed[class] > 0.0);
            self.relaxed_max[class] = self.relaxed_max[class].max(state.relaxed[class]);
        }
        if self.first_conflict.is_empty() {
            self.first_conflict.clone_from(&state.conflict);
        }
    }

    pub(crate) fn finish(&self, fleet: &FleetInfo) -> Option<SafetyMetrics> {
        let share = |count: u64| count as f64 / self.samples as f64;
        let name = |constraint: Constraint| constraint.name(fleet).to_owned();
        (self.samples > 0).then(|| SafetyMetrics {
            moved: share(self.moved),
            moved_max: self.moved_max,
            room_min: self.room.map(|(room, ..)| room),
            room_min_to: self.room.map(|(_, to, _)| name(to)),
            room_min_time: self.room.map(|(.., time)| time),
            relaxed: self.relaxed.map(share),
            relaxed_max: self.relaxed_max,
            first_conflict: self.first_conflict.iter().map(|constraint| name(*constraint)).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::BarrierState;

    #[test]
    fn sums_tell_shares_extremes_and_the_first_conflict() {
        let mut sums = SafetySums::default();
        assert_eq!(sums.finish(&FleetInfo::default()), None);
        let barrier =
            |value| BarrierState { constraint: Constraint::Edge(1), value, ..BarrierState::default() };
        for (time, value, moved) in [(0.0, 0.5, 0.0), (1.0, -0.1, 2.0), (2.0, 0.2, 1.0), (3.0, 0.3, 0.0)] {
            let conflict = if time == 1.0 { vec![Constraint::Braking, Constraint::Edge(1)] } else { vec![] };
            let relaxed = if time == 1.0 { [0.3, 0.0] } else { [0.0; 2] };
            let barriers = vec![barrier(value)];
            sums.add(time, &SafetyState { moved, barriers, conflict, relaxed, ..SafetyState::default() });
        }
        let metrics = sums.finish(&FleetInfo::default()).expect("a filter");
        assert_eq!((metrics.moved, metrics.moved_max), (0.5, 2.0));
        assert_eq!((metrics.room_min, metrics.room_min_time), (Some(-0.1), Some(1.0)));
        assert_eq!(metrics.room_min_to.as_deref(), Some("south edge"));
        assert_eq!((metrics.relaxed, metrics.relaxed_max), ([0.25, 0.0], [0.3, 0.0]));
        assert_eq!(metrics.first_conflict, ["braking limit", "south edge"]);
    }
}
