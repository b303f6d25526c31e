//! A run in the hand: what may be changed while it goes, and copies of it.

use crate::parameters::{ParameterSet, sample_at};
use crate::step::{Setup, Simulation, pending};
use formation::EdgeLaw;
use std::sync::Arc;
use vocabulary::StepRecord;

impl Simulation {
    /// From the next sample on the laws, set points and limits of `setup` hold, until something else does. Poses, time,
    /// motions of lead robots and what observers believe stay; changes that are to come stay too. `setup` is that of a
    /// scene which this run's scene leads to while it goes, see [`scene::Scene::sets_to`]; any other is not taken.
    pub fn apply_parameters(&mut self, setup: &Setup) {
        let fits = setup.formation.edges() == self.formation.edges()
            && setup.fleet.robots.len() == self.fleet.robots.len();
        debug_assert!(fits, "the setup of another formation");
        if fits {
            self.adopted = Some(Arc::new(ParameterSet::of(setup)));
        }
    }

    /// The changes of `setup` that are due at the next sample or later take the place of those that were to come.
    pub fn reschedule(&mut self, setup: &Setup) {
        self.changes = pending(&setup.changes, self.period);
        self.changes.retain(|(sample, _)| *sample >= self.sample);
    }

    /// The last moment, as it was when it was computed.
    pub fn record(&self) -> &StepRecord {
        &self.record
    }

    /// Followers are told the truth from now on, whatever their sensors: to look ahead where pictures cannot be drawn.
    pub fn trust(&mut self) {
        self.sensing = None;
        let limits = (0..self.fleet.robots.len()).map(|robot| *self.formation.limits(robot)).collect();
        self.formation.apply_parameters(trusting(self.formation.laws()), limits);
        let told = |parameters: &ParameterSet| ParameterSet {
            laws: trusting(&parameters.laws),
            ..parameters.clone()
        };
        self.adopted = self.adopted.take().map(|parameters| Arc::new(told(&parameters)));
        for (_, parameters) in &mut self.changes {
            *parameters = Arc::new(told(parameters));
        }
    }

    /// Number of the next control sample, from 0; its time is this times the period.
    pub fn sample(&self) -> u64 {
        self.sample
    }

    /// Goes on until `duration` s at least.
    pub fn extend_to(&mut self, duration: f64) {
        self.last_sample = self.last_sample.max(sample_at(duration, self.period));
        self.fleet.duration = self.fleet.duration.max(duration);
    }

    /// Adds to the rates an edge's observer estimates, [m/s, rad/s]: to watch it recover.
    pub fn disturb_observer(&mut self, edge: usize, by: [f64; 2]) {
        if let Some(estimate) = self.state.estimates.get_mut(edge) {
            estimate.rates[0] += by[0];
            estimate.rates[1] += by[1];
        }
        if let Some(sensing) = &mut self.sensing {
            sensing.disturb(edge, by);
        }
    }

    /// A copy of the whole run as it stands: it goes on to the same future, bit for bit.
    #[must_use]
    pub fn save(&self) -> Self {
        Self {
            fleet: self.fleet.clone(),
            formation: self.formation.clone(),
            state: self.state.clone(),
            plant: self.plant.save(),
            observations: self.observations.clone(),
            sensing: self.sensing.clone(),
            frames: self.frames.clone(),
            record: self.record.clone(),
            spare: self.spare.clone(),
            fault: self.fault.clone(),
            changes: self.changes.clone(),
            adopted: self.adopted.clone(),
            ..*self
        }
    }
}

/// Laws of followers that are told the truth.
fn trusting(laws: &[EdgeLaw]) -> Vec<EdgeLaw> {
    laws.iter().map(|law| EdgeLaw { looks: None, ..law.clone() }).collect()
}
