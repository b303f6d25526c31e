//! Writes code: chooses registers, folds constants, joins instructions, and counts what a call costs at most.

use super::code::{Code, Instruction, Operation, TextOrigin};
use super::law_text::Stretch;
use crate::input::InputKind;
use std::collections::HashMap;

/// The most instructions.
const CODE_MAX: usize = 20_000;
/// The most instructions that a call may execute.
pub(super) const COST_MAX: u64 = 200_000;
/// The most registers.
pub(super) const REGISTERS_MAX: usize = 4096;

/// Registers of constants while code is written; they are moved behind all others in the end.
const CONSTANTS: u16 = 0x8000;
/// Registers of inputs while code is written.
const INPUTS_FROM: u16 = 0x4000;

/// Where a number is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    Constant(f64),
    /// A register that nothing else refers to.
    Temporary(u16),
    /// The register of something that has a name.
    Named(u16),
}

/// Code that is being written.
#[derive(Debug)]
pub(super) struct Assembler {
    code: Code,
    constants: HashMap<u64, u16>,
    /// The first register that is free.
    free: u16,
    /// One above the largest register ever in use.
    top: u16,
    /// Instructions from here on are reached from the one before only.
    label: usize,
    /// Instructions executed at most.
    pub(super) cost: u64,
    pub(super) origin: TextOrigin,
    too_large: bool,
}

impl Assembler {
    /// Code whose first registers hold parameters and memory.
    pub(super) fn new(parameters: usize, memory: usize) -> Self {
        let taken = (memory + parameters).min(REGISTERS_MAX);
        Self {
            code: Code { parameters, memory, ..Code::default() },
            constants: HashMap::new(),
            free: taken as u16,
            top: taken as u16,
            label: 0,
            cost: 0,
            origin: TextOrigin { at: Stretch::default(), owner: 0 },
            too_large: memory + parameters > REGISTERS_MAX,
        }
    }

    /// What is too large for a law, if anything is.
    pub(super) fn excess(&self) -> Option<String> {
        if self.too_large || self.code.instructions.len() >= CODE_MAX {
            Some(format!(
                "this law is too large: it may have {CODE_MAX} instructions, functions written out, and hold {REGISTERS_MAX} numbers"
            ))
        } else if self.cost > COST_MAX {
            Some(format!(
                "this law takes too long: a sample may take {COST_MAX} instructions, and this could take {}",
                self.cost
            ))
        } else {
            None
        }
    }

    /// What the instructions that follow belong to.
    pub(super) fn begin(&mut self, owner: String) {
        self.origin.owner = self.code.owners.len().min(usize::from(u16::MAX)) as u16;
        self.code.owners.push(owner);
    }

    /// The first free register, to which [`Assembler::release`] can return.
    pub(super) fn mark(&self) -> u16 {
        self.free
    }

    /// Frees the registers from `mark` on.
    pub(super) fn release(&mut self, mark: u16) {
        self.free = mark;
    }

    /// Takes a register.
    pub(super) fn reserve(&mut self) -> u16 {
        let register = self.free;
        if usize::from(register) + 1 >= REGISTERS_MAX {
            self.too_large = true;
            return register;
        }
        self.free += 1;
        self.top = self.top.max(self.free);
        register
    }

    /// The operand of an input.
    pub(super) fn input(&mut self, leader: usize, kind: InputKind) -> Operand {
        let known = self.code.inputs.iter().position(|(l, k, _)| (*l, *k) == (leader, kind));
        let index = known.unwrap_or_else(|| {
            self.code.inputs.push((leader, kind, self.origin.at));
            self.code.inputs.len() - 1
        });
        Operand::Named(INPUTS_FROM + index as u16)
    }

    fn constant(&mut self, value: f64) -> u16 {
        let next = self.code.constants.len();
        if next >= REGISTERS_MAX {
            self.too_large = true;
            return CONSTANTS;
        }
        let constants = &mut self.code.constants;
        *self.constants.entry(value.to_bits()).or_insert_with(|| {
            constants.push(value);
            CONSTANTS + next as u16
        })
    }

    /// The register that holds an operand.
    pub(super) fn register(&mut self, operand: Operand) -> u16 {
        match operand {
            Operand::Constant(value) => self.constant(value),
            Operand::Temporary(register) | Operand::Named(register) => register,
        }
    }

    fn emit(&mut self, instruction: Instruction) {
        if self.code.instructions.len() < CODE_MAX {
            self.code.instructions.push(instruction);
            self.code.origins.push(self.origin);
        }
        self.cost = self.cost.saturating_add(1);
    }

    /// Takes back the last instruction if it made this temporary by one of `operations`, and nothing jumps behind it.
    fn take_back(&mut self, operand: Operand, operations: &[Operation]) -> Option<Instruction> {
        let Operand::Temporary(register) = operand else { return None };
        let last = *self.code.instructions.last()?;
        let fits = self.code.instructions.len() > self.label
            && self.code.instructions.len() < CODE_MAX
            && last.to == register
            && operations.contains(&last.operation);
        fits.then(|| {
            self.code.instructions.pop();
            self.code.origins.pop();
            self.cost -= 1;
            last
        })
    }

    /// What an operation makes of its sources. Registers from `mark` on are free afterwards, but for the result.
    pub(super) fn apply(&mut self, operation: Operation, sources: &[Operand], mark: u16) -> Operand {
        if let Some(value) = folded(operation, sources) {
            self.free = mark;
            return Operand::Constant(value);
        }
        let instruction = self.joined(operation, sources).unwrap_or_else(|| {
            let mut registers = [0; 3];
            for (register, source) in registers.iter_mut().zip(sources) {
                *register = self.register(*source);
            }
            let [a, b, c] = registers;
            Instruction { operation, to: 0, a, b, c }
        });
        self.free = mark;
        let to = self.reserve();
        self.emit(Instruction { to, ..instruction });
        Operand::Temporary(to)
    }

    /// A sum with a product in it, as one instruction that rounds twice as the two did.
    fn joined(&mut self, operation: Operation, sources: &[Operand]) -> Option<Instruction> {
        let [a, b] = *sources else { return None };
        let (first, second) = match operation {
            Operation::Add => (Operation::MultiplyAdd, Operation::MultiplyAdd),
            Operation::Subtract => (Operation::MultiplySubtract, Operation::SubtractProduct),
            _ => return None,
        };
        let product = [Operation::Multiply];
        if let Some(last) = self.take_back(b, &product) {
            let c = self.register(a);
            return Some(Instruction { operation: second, c, ..last });
        }
        let last = self.take_back(a, &product)?;
        let c = self.register(b);
        Some(Instruction { operation: first, c, ..last })
    }

    /// Puts an operand into a register.
    pub(super) fn put(&mut self, to: u16, operand: Operand) {
        if let Operand::Temporary(register) = operand
            && self.code.instructions.len() > self.label
            && let Some(last) = self.code.instructions.last_mut()
            && last.to == register
            && !last.operation.is_jump()
        {
            last.to = to;
            return;
        }
        let a = self.register(operand);
        if a != to {
            self.emit(Instruction { operation: Operation::Move, to, a, b: 0, c: 0 });
        }
    }

    /// Where the next instruction will stand; one may jump there.
    pub(super) fn here(&mut self) -> usize {
        self.label = self.code.instructions.len();
        self.label
    }

    /// Jumps somewhere else, for [`Assembler::lead`] to say where.
    pub(super) fn jump(&mut self) -> usize {
        self.emit(Instruction { operation: Operation::Jump, to: 0, a: 0, b: 0, c: 0 });
        self.code.instructions.len() - 1
    }

    /// Jumps where a condition is false, for [`Assembler::lead`] to say where to.
    pub(super) fn jump_unless(&mut self, condition: Operand) -> usize {
        let compared = self.take_back(condition, &[Operation::Less, Operation::LessOrEqual]);
        let instruction = match compared {
            Some(last) if last.operation == Operation::Less => {
                Instruction { operation: Operation::JumpUnlessLess, to: 0, ..last }
            }
            Some(last) => Instruction { operation: Operation::JumpUnlessLessOrEqual, to: 0, ..last },
            None => {
                let a = self.register(condition);
                Instruction { operation: Operation::JumpUnless, to: 0, a, b: 0, c: 0 }
            }
        };
        self.emit(instruction);
        self.code.instructions.len() - 1
    }

    /// Says that instruction `jump` leads to the next one.
    pub(super) fn lead(&mut self, jump: usize) {
        let here = self.here() as u16;
        if let Some(instruction) =
            self.code.instructions.get_mut(jump).filter(|found| found.operation.is_jump())
        {
            instruction.to = here;
        }
    }

    /// Ends a loop that began at `from` with its `counter` at 1.
    pub(super) fn again(&mut self, from: usize, counter: u16, rounds: u32) {
        let b = self.constant(f64::from(rounds));
        self.emit(Instruction { operation: Operation::Again, to: from as u16, a: counter, b, c: 0 });
        self.here();
    }

    /// The code, and a function that maps registers as they were given out to those of the code.
    pub(super) fn finish(mut self) -> (Code, impl Fn(u16) -> u16) {
        let inputs = self.top;
        let constants = inputs + self.code.inputs.len() as u16;
        let map = move |register: u16| match register {
            CONSTANTS.. => register - CONSTANTS + constants,
            INPUTS_FROM.. => register - INPUTS_FROM + inputs,
            _ => register,
        };
        self.code.input_base = usize::from(inputs);
        for instruction in &mut self.code.instructions {
            let Instruction { a, b, c, to, operation } = *instruction;
            // What is not a source is 0, which is a register as good as any.
            let to = if operation.is_jump() { to } else { map(to) };
            *instruction = Instruction { operation, to, a: map(a), b: map(b), c: map(c) };
        }
        (self.code, map)
    }

    /// Whether there are more registers than there may be, now that all are known.
    pub(super) fn overflows(&self) -> bool {
        usize::from(self.top) + self.code.inputs.len() + self.code.constants.len() > REGISTERS_MAX
    }
}

/// The value of an operation on constants. Where it is not finite, the law runs into it, if it gets there.
fn folded(operation: Operation, sources: &[Operand]) -> Option<f64> {
    if operation == Operation::Noise {
        return None;
    }
    let mut values = [0.0; 3];
    for (value, source) in values.iter_mut().zip(sources) {
        let Operand::Constant(constant) = source else { return None };
        *value = *constant;
    }
    let [a, b, c] = values;
    let value = operation.value(a, b, c);
    value.is_finite().then_some(value)
}
