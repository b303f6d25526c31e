//! A law that was written as text.

use super::assembler::REGISTERS_MAX;
use super::checker::{Change, CheckedLaw, check};
use super::code::Code;
use super::fault_finder::{fault_of_start, fault_of_step};
use super::interpreter::run;
use super::law_text::{LawText, Stretch};
use super::mistake::{Mistake, MistakeList};
use super::parser::parse;
use crate::custom_law::{CustomLaw, Fault};
use crate::declaration::Declaration;
use crate::input::Input;
use vocabulary::Command;

/// The longest text, in bytes.
const TEXT_MAX: usize = 100_000;

/// A law that was written as text, ready to run.
///
/// It always ends: loops are counted, functions do not call themselves, and what a call costs at most is known before it runs.
#[derive(Debug, Clone)]
pub struct LawFile {
    text: String,
    law: CheckedLaw,
}

impl LawFile {
    /// Compiles the text of a law file.
    ///
    /// # Errors
    /// What is wrong with it, in the order of the text, at most 20 mistakes.
    pub fn compile(text: &str) -> Result<Self, Vec<Mistake>> {
        let law_text = LawText::new(text);
        let mut mistakes = MistakeList::default();
        if text.len() > TEXT_MAX {
            mistakes.add(
                Stretch::default(),
                format!("this text is too long for a law: {TEXT_MAX} bytes are enough"),
            );
            return Err(mistakes.in_order(law_text));
        }
        let syntax = parse(law_text, &mut mistakes);
        match syntax.and_then(|syntax| check(law_text, &syntax, &mut mistakes)) {
            Some(law) if mistakes.is_empty() => Ok(Self { text: text.to_owned(), law }),
            _ => Err(mistakes.in_order(law_text)),
        }
    }

    /// The text that it was compiled from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// How many instructions a sample executes at most.
    pub fn instructions(&self) -> u64 {
        self.law.cost
    }
}

/// The same text is the same law.
impl PartialEq for LawFile {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Eq for LawFile {}

/// Something that is done with as few registers as will do: they have to be cleared.
trait RegisterUse {
    type Outcome;

    /// Does it with `N` registers.
    fn with<const N: usize>(self) -> Self::Outcome;
}

#[inline]
fn with_registers<U: RegisterUse>(code: &Code, user: U) -> U::Outcome {
    match code.registers() {
        0..=128 => user.with::<128>(),
        129..=512 => user.with::<512>(),
        _ => user.with::<REGISTERS_MAX>(),
    }
}

impl CustomLaw for LawFile {
    fn declaration(&self) -> &Declaration {
        &self.law.declaration
    }

    fn start(&self, input: &Input<'_>, parameters: &[f64], memory: &mut [f64]) -> Result<(), Fault> {
        let is_finite = with_registers(&self.law.start, Start { law: &self.law, input, parameters, memory });
        if is_finite {
            Ok(())
        } else {
            Err(fault_of_start(&self.law, LawText::new(&self.text), input, parameters))
        }
    }

    fn decide(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &mut [f64],
        shown: &mut [f64],
    ) -> Result<Command, Fault> {
        let decision = Decision { law: &self.law, input, parameters, memory, shown };
        with_registers(&self.law.step, decision)
            .ok_or_else(|| fault_of_step(&self.law, LawText::new(&self.text), input, parameters, memory))
    }

    fn derive(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &[f64],
        rates: &mut [f64],
    ) -> Result<Command, Fault> {
        let derivation = Derivation { law: &self.law, input, parameters, memory, rates };
        with_registers(&self.law.step, derivation)
            .ok_or_else(|| fault_of_step(&self.law, LawText::new(&self.text), input, parameters, memory))
    }
}

/// Whether a whole start is finite.
struct Start<'a> {
    law: &'a CheckedLaw,
    input: &'a Input<'a>,
    parameters: &'a [f64],
    memory: &'a mut [f64],
}

impl RegisterUse for Start<'_> {
    type Outcome = bool;

    fn with<const N: usize>(self) -> bool {
        let code = &self.law.start;
        let mut registers = [0.0; N];
        code.fill(&mut registers, self.input, self.parameters, &[]);
        run(code, &mut registers, self.input.noise, &mut ());
        for (number, register) in self.memory.iter_mut().zip(&registers[code.parameters..]) {
            *number = *register;
        }
        self.memory.iter().all(|number| number.is_finite())
    }
}

/// A control sample; no command where it or the memory is not finite, and the memory is then what it was.
struct Decision<'a> {
    law: &'a CheckedLaw,
    input: &'a Input<'a>,
    parameters: &'a [f64],
    memory: &'a mut [f64],
    shown: &'a mut [f64],
}

impl RegisterUse for Decision<'_> {
    type Outcome = Option<Command>;

    fn with<const N: usize>(self) -> Option<Command> {
        let law = self.law;
        let mut registers = [0.0; N];
        law.step.fill(&mut registers, self.input, self.parameters, self.memory);
        run(&law.step, &mut registers, self.input.noise, &mut ());
        let first = law.step.parameters;
        for (number, change) in registers[first..].iter().zip(&law.changes) {
            let next = change.next(*number, self.input.period, &registers);
            if !next.is_finite() {
                return None;
            }
        }
        let command = finite_command(law, &registers)?;
        for ((number, change), next) in self.memory.iter_mut().zip(&law.changes).zip(&registers[first..]) {
            *number = change.next(*next, self.input.period, &registers);
        }
        for (number, register) in self.shown.iter_mut().zip(&law.shown) {
            *number = registers[usize::from(*register)];
        }
        Some(command)
    }
}

/// An instant of continuous time; no command where it or a derivative is not finite.
struct Derivation<'a> {
    law: &'a CheckedLaw,
    input: &'a Input<'a>,
    parameters: &'a [f64],
    memory: &'a [f64],
    rates: &'a mut [f64],
}

impl RegisterUse for Derivation<'_> {
    type Outcome = Option<Command>;

    fn with<const N: usize>(self) -> Option<Command> {
        let law = self.law;
        let mut registers = [0.0; N];
        law.step.fill(&mut registers, self.input, self.parameters, self.memory);
        run(&law.step, &mut registers, self.input.noise, &mut ());
        for (number, change) in self.rates.iter_mut().zip(&law.changes) {
            *number = match change {
                Change::Rate(rate) => registers[usize::from(*rate)],
                Change::Kept | Change::Set => 0.0,
            };
            if !number.is_finite() {
                return None;
            }
        }
        finite_command(law, &registers)
    }
}

fn finite_command(law: &CheckedLaw, registers: &[f64]) -> Option<Command> {
    let [acceleration, turn_rate] = law.command.map(|register| registers[usize::from(register)]);
    (acceleration.is_finite() && turn_rate.is_finite()).then_some(Command { acceleration, turn_rate })
}

#[cfg(test)]
impl super::interpreter::Watch for u64 {
    fn executed(&mut self) {
        *self += 1;
    }

    fn before(&mut self, _: usize, _: &super::code::Instruction, _: f64, _: &[f64]) {}
}

#[cfg(test)]
impl LawFile {
    /// How many instructions a sample executes.
    pub(super) fn executed(&self, input: &Input<'_>) -> u64 {
        let code = &self.law.step;
        let mut registers = [0.0; 512];
        let parameters: Vec<f64> =
            self.law.declaration.parameters.iter().map(|parameter| parameter.default).collect();
        code.fill(&mut registers, input, &parameters, &vec![0.0; code.memory]);
        let mut count = 0;
        run(code, &mut registers, input.noise, &mut count);
        count
    }
}
