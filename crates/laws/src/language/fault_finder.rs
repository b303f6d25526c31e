//! Why a number of a law is not finite: runs a sample again, and follows each number that is not finite to where it arose.

use super::assembler::REGISTERS_MAX;
use super::checker::{Change, CheckedLaw};
use super::code::{Code, Instruction, Operation};
use super::interpreter::{Watch, run};
use super::law_text::LawText;
use crate::custom_law::Fault;
use crate::input::{INPUTS, Input};

/// The fault of a sample in which the command or the memory is not finite.
pub(super) fn fault_of_step(
    law: &CheckedLaw,
    text: LawText<'_>,
    input: &Input<'_>,
    parameters: &[f64],
    memory: &[f64],
) -> Fault {
    let trace = Trace::of(&law.step, input, parameters, memory);
    let first = law.step.parameters;
    for register in law.command {
        if let Some(fault) = trace.fault(law, text, register) {
            return fault;
        }
    }
    for (index, change) in law.changes.iter().enumerate() {
        let number = (first + index) as u16;
        let registers = match change {
            Change::Rate(rate) => [*rate, number],
            Change::Kept | Change::Set => [number; 2],
        };
        if let Some(fault) = registers.into_iter().find_map(|register| trace.fault(law, text, register)) {
            return fault;
        }
        let value = trace.registers[usize::from(number)];
        if !change.next(value, input.period, &trace.registers).is_finite() {
            return fault_of_memory(law, text, index, "grows beyond all numbers");
        }
    }
    Fault { place: None, message: "the command or the memory is not finite".to_owned() }
}

/// The fault of a start at which the memory is not finite.
pub(super) fn fault_of_start(
    law: &CheckedLaw,
    text: LawText<'_>,
    input: &Input<'_>,
    parameters: &[f64],
) -> Fault {
    let trace = Trace::of(&law.start, input, parameters, &[]);
    let first = law.start.parameters;
    let numbers = (first..first + law.changes.len()).map(|register| register as u16);
    let mut faults = numbers.filter_map(|register| trace.fault(law, text, register));
    faults
        .next()
        .unwrap_or_else(|| Fault { place: None, message: "the memory is not finite at the start".to_owned() })
}

fn fault_of_memory(law: &CheckedLaw, text: LawText<'_>, index: usize, what: &str) -> Fault {
    let place = law.memory_places.get(index).map(|at| text.place(at.from));
    let name = law.declaration.memory.get(index).map_or("", |memory| memory.name.as_str());
    Fault { place, message: format!("`{name}` {what}") }
}

/// What made a number that is not finite.
#[derive(Debug, Clone, Copy)]
enum Cause {
    /// Instruction number `at`, from these sources.
    Instruction { at: usize, value: f64, sources: [f64; 3] },
    /// It was not finite in this register from the beginning.
    Given(u16, f64),
}

/// A run, with what made each number that is not finite.
struct Trace<'a> {
    code: &'a Code,
    registers: Vec<f64>,
    causes: Vec<Option<Cause>>,
}

impl Watch for Vec<Option<Cause>> {
    fn before(&mut self, at: usize, instruction: &Instruction, value: f64, registers: &[f64]) {
        let inherited = instruction.sources().find_map(|source| self[usize::from(source)]);
        let [a, b, c] =
            [instruction.a, instruction.b, instruction.c].map(|source| registers[usize::from(source)]);
        let own = Cause::Instruction { at, value, sources: [a, b, c] };
        self[usize::from(instruction.to)] = (!value.is_finite()).then_some(inherited.unwrap_or(own));
    }
}

impl<'a> Trace<'a> {
    fn of(code: &'a Code, input: &Input<'_>, parameters: &[f64], memory: &[f64]) -> Self {
        let mut registers = vec![0.0; REGISTERS_MAX];
        code.fill(&mut registers, input, parameters, memory);
        let given = registers
            .iter()
            .enumerate()
            .map(|(register, value)| (!value.is_finite()).then_some(Cause::Given(register as u16, *value)));
        let mut causes: Vec<Option<Cause>> = given.collect();
        if let Some(registers) = registers.first_chunk_mut::<REGISTERS_MAX>() {
            run(code, registers, input.noise, &mut causes);
        }
        Self { code, registers, causes }
    }

    /// Why the number in a register is not finite, if it is not.
    fn fault(&self, law: &CheckedLaw, text: LawText<'_>, register: u16) -> Option<Fault> {
        Some(match self.causes[usize::from(register)]? {
            Cause::Instruction { at, value, sources } => self.fault_of_instruction(text, at, value, sources),
            Cause::Given(register, value) => self.fault_of_given(law, text, register, value),
        })
    }

    fn fault_of_instruction(&self, text: LawText<'_>, at: usize, value: f64, sources: [f64; 3]) -> Fault {
        let origin = self.code.origins[at];
        let owner = &self.code.owners[usize::from(origin.owner)];
        let [a, b, _] = sources;
        let reason = match self.code.instructions[at].operation {
            Operation::Divide if b == 0.0 => format!("{a} divided by 0"),
            Operation::Root => format!("the square root of {a}"),
            Operation::Logarithm => format!("the logarithm of {a}"),
            Operation::Arcsine => format!("the arc sine of {a}"),
            Operation::Arccosine => format!("the arc cosine of {a}"),
            Operation::Power => format!("{a} to the power of {b}"),
            Operation::Exponential => format!("the exponential of {a}"),
            _ => "beyond all numbers".to_owned(),
        };
        let quoted = text.quote(origin.at);
        Fault {
            place: Some(text.place(origin.at.from)),
            message: format!("{quoted} {}: {reason}, in {owner}", is_what(value)),
        }
    }

    fn fault_of_given(&self, law: &CheckedLaw, text: LawText<'_>, register: u16, value: f64) -> Fault {
        let register = usize::from(register);
        if let Some(parameter) = law.declaration.parameters.get(register) {
            let place = law.parameter_places.get(register).map(|at| text.place(at.from));
            return Fault {
                place,
                message: format!("the parameter `{}` {}", parameter.name, is_what(value)),
            };
        }
        if register < self.code.parameters + self.code.memory {
            return fault_of_memory(law, text, register - self.code.parameters, is_what(value));
        }
        let input = register.checked_sub(self.code.input_base).and_then(|index| self.code.inputs.get(index));
        let (place, name) = input.map_or((None, "a number"), |(_, kind, at)| {
            let name = INPUTS.iter().find(|(known, ..)| known == kind).map_or("", |(_, name, ..)| *name);
            (Some(text.place(at.from)), name)
        });
        Fault { place, message: format!("what the law is told {}: `{name}`", is_what(value)) }
    }
}

fn is_what(value: f64) -> &'static str {
    if value.is_nan() { "is not a number" } else { "is infinite" }
}
