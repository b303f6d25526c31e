//! What a safety filter did, as a message: names for people, codes for reading it back.

use super::record::{FieldValue, Fields, Record};
use vocabulary::{BarrierState, Constraint, FleetInfo, SafetyState};

/// What one filter did, and the names of what acted.
#[derive(Default)]
pub(super) struct SafetyRecord {
    pub(super) state: SafetyState,
    acting: String,
    conflict: String,
}

impl SafetyRecord {
    pub(super) fn new(state: &SafetyState, fleet: &FleetInfo) -> Self {
        let names = |list: &[Constraint]| crate::columns::names(fleet, list);
        Self { acting: names(&state.acting), conflict: names(&state.conflict), state: state.clone() }
    }
}

/// Constraints as [kind, index] each, kinds counted in the order of [`Constraint::KINDS`].
fn constraints<F: Fields>(f: &mut F, name: &'static str, list: &mut Vec<Constraint>) -> Option<()> {
    let code = |constraint: &Constraint| constraint.code().map(|number| number as f64);
    let mut codes: Vec<f64> = list.iter().flat_map(code).collect();
    f.field(name, FieldValue::Series(&mut codes))?;
    let (pairs, rest) = codes.as_chunks::<2>();
    let whole = |x: f64| (x >= 0.0 && x.fract() == 0.0 && x < 1e9).then_some(x as usize);
    let read = |[kind, index]: &[f64; 2]| Constraint::of_code([whole(*kind)?, whole(*index)?]);
    *list = pairs.iter().map(read).collect::<Option<_>>()?;
    rest.is_empty().then_some(())
}

impl Record for SafetyRecord {
    const NAME: &'static str = "Safety";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let state = &mut self.state;
        f.number("wished_acceleration_m_s2", &mut state.wished.acceleration)?;
        f.number("wished_turn_rate_rad_s", &mut state.wished.turn_rate)?;
        f.number("applied_acceleration_m_s2", &mut state.applied.acceleration)?;
        f.number("applied_turn_rate_rad_s", &mut state.applied.turn_rate)?;
        f.number("moved_m_s2", &mut state.moved)?;
        f.several(["relaxed_collisions", "relaxed_views"], state.relaxed.each_mut())?;
        f.text("acting", &mut self.acting)?;
        f.text("conflict", &mut self.conflict)?;
        constraints(f, "acting_codes", &mut state.acting)?;
        constraints(f, "conflict_codes", &mut state.conflict)?;
        let mut about: Vec<Constraint> = state.barriers.iter().map(|barrier| barrier.constraint).collect();
        let mut values: Vec<f64> = state.barriers.iter().map(|barrier| barrier.value).collect();
        let mut slacks: Vec<f64> = state.barriers.iter().map(|barrier| barrier.slack).collect();
        let mut directions: Vec<f64> = state.barriers.iter().map(|barrier| barrier.direction).collect();
        constraints(f, "barrier_codes", &mut about)?;
        f.field("barrier_values", FieldValue::Series(&mut values))?;
        f.field("barrier_slacks", FieldValue::Series(&mut slacks))?;
        f.field("barrier_directions_rad", FieldValue::Series(&mut directions))?;
        let count = about.len();
        [values.len(), slacks.len(), directions.len()].iter().all(|length| *length == count).then_some(())?;
        let barrier = |k: usize| BarrierState {
            constraint: about[k],
            value: values[k],
            slack: slacks[k],
            direction: directions[k],
        };
        state.barriers = (0..count).map(barrier).collect();
        Some(())
    }
}
