//! A custom law as one follower uses it, and what it carries from sample to sample.

use laws::{CustomLaw, Declaration, Fault, Input, Quantity};
use std::sync::Arc;
use vocabulary::{Command, LawQuantity, LawState};

/// A custom law and its parameters.
#[derive(Debug, Clone)]
pub struct Custom {
    law: Arc<dyn CustomLaw>,
    parameters: Vec<f64>,
    quantities: Arc<[LawQuantity]>,
}

/// Two are the same where their law is the same piece and their parameters are equal.
impl PartialEq for Custom {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.law, &other.law) && self.parameters == other.parameters
    }
}

impl Custom {
    /// A law, and its parameters in the order of its declaration.
    pub fn new(law: Arc<dyn CustomLaw>, parameters: Vec<f64>) -> Self {
        let Declaration { memory, shown, .. } = law.declaration();
        let quantity = |own: &Quantity| LawQuantity { name: own.name.clone(), unit: own.unit.to_string() };
        let quantities = memory.iter().chain(shown).map(quantity).collect();
        Self { law, parameters, quantities }
    }

    /// The law.
    pub fn law(&self) -> &dyn CustomLaw {
        &*self.law
    }

    /// Its parameters, in the order of its declaration.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// What `state` holds, of the follower number `robot`, for records.
    pub fn record(&self, robot: usize, state: &CustomState, out: &mut LawState) {
        out.robot = robot;
        out.quantities.clone_from(&self.quantities);
        out.values.clear();
        out.values.extend_from_slice(&state.memory);
        out.values.extend_from_slice(&state.shown);
        out.values.resize(self.quantities.len(), 0.0);
        out.fault.clear();
        if let Some(fault) = &state.fault {
            out.fault = fault.to_string();
        }
    }
}

/// What a follower carries for its custom law.
#[derive(Debug, Clone, Default)]
pub struct CustomState {
    /// The law that left this; `None` before its first sample, and after its leader was lost or changed.
    law: Option<Arc<dyn CustomLaw>>,
    memory: Vec<f64>,
    shown: Vec<f64>,
    /// The memory as it was before this sample.
    before: Vec<f64>,
    /// The parameters with which the law broke off; it is not asked again before these or the law change.
    failed: Option<Vec<f64>>,
    /// Why it broke off, at the sample at which it did.
    fault: Option<Fault>,
    /// Whether a law for many followers has met the leader.
    met: bool,
}

impl CustomState {
    /// What the law carries, in the order of its declaration; empty before its first sample.
    pub fn memory(&self) -> &[f64] {
        &self.memory
    }

    /// What the law shows of its last sample, in the order of its declaration.
    pub fn shown(&self) -> &[f64] {
        &self.shown
    }

    /// Why the law broke off, at the sample at which it did.
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// Whether it has broken off.
    pub fn is_failed(&self) -> bool {
        self.failed.is_some()
    }

    /// The follower loses sight of its leader, or gets another one: it meets it anew.
    pub(crate) fn forget(&mut self) {
        self.law = None;
        self.met = false;
    }

    /// Whether a law for many followers meets the leader now.
    pub(crate) fn meets(&mut self) -> bool {
        !std::mem::replace(&mut self.met, true)
    }

    /// The command of a control sample; `None` where the law has broken off.
    pub(crate) fn decide(&mut self, custom: &Custom, input: &Input<'_>) -> Option<Command> {
        self.run(custom, |state| {
            state.meet(custom, input)?;
            state.before.clone_from(&state.memory);
            custom.law.decide(input, &custom.parameters, &mut state.memory, &mut state.shown)
        })
    }

    /// The command of an instant of continuous time; `rates` become the time derivatives of the memory.
    pub(crate) fn derive(
        &mut self,
        custom: &Custom,
        input: &Input<'_>,
        rates: &mut Vec<f64>,
    ) -> Option<Command> {
        self.run(custom, |state| {
            state.meet(custom, input)?;
            state.before.clone_from(&state.memory);
            rates.clear();
            rates.resize(state.memory.len(), 0.0);
            custom.law.derive(input, &custom.parameters, &state.memory, rates)
        })
    }

    /// Puts another memory in place of the present one, as far as there is one.
    pub fn set_memory(&mut self, memory: &[f64]) {
        if self.memory.len() == memory.len() {
            self.memory.copy_from_slice(memory);
        }
    }

    fn run(
        &mut self,
        custom: &Custom,
        law: impl FnOnce(&mut Self) -> Result<Command, Fault>,
    ) -> Option<Command> {
        self.fault = None;
        let same = self.law.as_ref().is_some_and(|law| Arc::ptr_eq(law, &custom.law));
        if self.failed.as_ref().is_some_and(|parameters| same && *parameters == custom.parameters) {
            return None;
        }
        self.failed = None;
        match law(self) {
            Ok(command) => Some(command),
            Err(fault) => {
                self.memory.clone_from(&self.before);
                self.law = Some(Arc::clone(&custom.law));
                self.failed = Some(custom.parameters.clone());
                self.fault = Some(fault);
                None
            }
        }
    }

    /// Where another law is at work than before, its memory begins; what the former law carried by the same name and in the
    /// same unit goes on.
    fn meet(&mut self, custom: &Custom, input: &Input<'_>) -> Result<(), Fault> {
        if self.law.as_ref().is_some_and(|law| Arc::ptr_eq(law, &custom.law)) {
            return Ok(());
        }
        let declared = custom.law.declaration();
        let former = self.law.take();
        let carried = std::mem::take(&mut self.memory);
        self.memory.resize(declared.memory.len(), 0.0);
        self.before.clone_from(&self.memory);
        self.shown.clear();
        self.shown.resize(declared.shown.len(), 0.0);
        custom.law.start(input, &custom.parameters, &mut self.memory)?;
        if let Some(former) = former {
            let known = former.declaration().memory.iter().zip(carried);
            for (quantity, value) in known {
                if let Some(index) = declared.memory.iter().position(|own| own == quantity) {
                    self.memory[index] = value;
                }
            }
        }
        self.law = Some(Arc::clone(&custom.law));
        Ok(())
    }
}
