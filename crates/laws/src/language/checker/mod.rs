//! A syntax tree to code, with its units checked on the way. Functions are written out where they are called, so their units
//! are checked at each call.

mod calls;
mod expressions;
mod statements;

use super::assembler::{Assembler, COST_MAX, Operand};
use super::code::Code;
use super::law_text::{LawText, Stretch};
use super::mistake::MistakeList;
use super::symbol::symbol;
use super::syntax::{Expression, LawSyntax, Named};
use super::typed::{Measured, Typed, described};
use crate::declaration::{Declaration, Parameter, Quantity};
use crate::input::InputKind;
use crate::unit::Unit;
use std::collections::{BTreeSet, HashSet};

/// How many parts of the tree are visited, functions written out: bounds the time that compiling takes.
const VISITS_MAX: usize = 200_000;
/// How deep the tree may be with its functions written out.
const DEPTH_MAX: usize = 128;

/// What becomes of a number of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// It stays.
    Kept,
    /// Statements set it.
    Set,
    /// The register that holds its derivative.
    Rate(u16),
}

impl Change {
    /// The number at the next sample, by Euler's forward step; `number` is what its register holds at the end of this one.
    pub(super) fn next(self, number: f64, period: f64, registers: &[f64]) -> f64 {
        match self {
            Self::Kept | Self::Set => number,
            Self::Rate(rate) => number + period * registers[usize::from(rate)],
        }
    }
}

/// A law that was checked.
#[derive(Debug, Clone)]
pub(super) struct CheckedLaw {
    pub(super) declaration: Declaration,
    /// Computes the memory at the start.
    pub(super) start: Code,
    /// Computes a sample.
    pub(super) step: Code,
    /// For each number of memory.
    pub(super) changes: Vec<Change>,
    /// How many instructions a sample takes at most.
    pub(super) cost: u64,
    /// Registers of acceleration and turn rate.
    pub(super) command: [u16; 2],
    /// Registers of the quantities that are shown.
    pub(super) shown: Vec<u16>,
    /// Where each number of memory is declared.
    pub(super) memory_places: Vec<Stretch>,
    /// Where each parameter is declared.
    pub(super) parameter_places: Vec<Stretch>,
}

/// Checks a law; what is wrong is noted in `mistakes`, and then there is none.
pub(super) fn check(
    text: LawText<'_>,
    syntax: &LawSyntax<'_>,
    mistakes: &mut MistakeList,
) -> Option<CheckedLaw> {
    let parameters = syntax.parameters.len();
    let mut checker = Checker {
        text,
        syntax,
        mistakes,
        leaders: syntax.leaders.unwrap_or(1),
        assembler: Assembler::new(parameters, 2 * syntax.memory.len()),
        scope: vec![],
        floor: 0,
        value_floor: 0,
        blocks: 0,
        memory: vec![],
        is_start: true,
        changing: HashSet::new(),
        counters: vec![],
        calls: vec![],
        visits: 0,
        depth: 0,
        largest: [None, None],
        reads: BTreeSet::new(),
        is_noisy: false,
    };
    checker.check_names();
    checker.start();
    let numbers: usize = checker.memory.iter().map(|memory| memory.value.operands().count()).sum();
    let start = std::mem::replace(&mut checker.assembler, Assembler::new(parameters, numbers));
    checker.too_large(&start);
    checker.is_start = false;
    checker.statements(&syntax.statements);
    let command = checker.command();
    checker.finish(start, command)
}

/// Something with a name inside the statements.
#[derive(Debug)]
struct Variable<'a> {
    name: &'a str,
    at: Stretch,
    value: Typed,
    kind: VariableKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum VariableKind {
    Let,
    Argument,
    Counter,
}

#[derive(Debug)]
struct MemoryVariable<'a> {
    name: &'a str,
    at: Stretch,
    value: Typed,
    is_set: bool,
    /// Its derivatives.
    rates: Option<Typed>,
}

struct Checker<'a, 's> {
    text: LawText<'a>,
    syntax: &'s LawSyntax<'a>,
    mistakes: &'s mut MistakeList,
    leaders: usize,
    assembler: Assembler,
    scope: Vec<Variable<'a>>,
    /// Variables from here on are seen: those of the function.
    floor: usize,
    /// Variables from here on may be set: those of the block that is a value.
    value_floor: usize,
    /// How many blocks are open.
    blocks: usize,
    memory: Vec<MemoryVariable<'a>>,
    /// Whether this is the start of memory.
    is_start: bool,
    /// Registers whose numbers change.
    changing: HashSet<u16>,
    /// Registers of the counters of open loops.
    counters: Vec<u16>,
    /// Functions that are being written out, and where they are called.
    calls: Vec<(&'a str, Stretch)>,
    visits: usize,
    depth: usize,
    /// Of what is written out and what is repeated, the largest: what a law that is too large is to be told.
    largest: [Option<LargePart>; 2],
    reads: BTreeSet<(usize, InputKind)>,
    is_noisy: bool,
}

/// A call or a loop, and its share of a law.
#[derive(Debug)]
struct LargePart {
    /// What it is, such as "the loop".
    what: String,
    at: Stretch,
    /// Of a call, parts of the tree; of a loop, instructions executed.
    size: u64,
}

/// Index of calls in [`Checker::largest`].
const CALLS: usize = 0;
/// Index of loops.
const LOOPS: usize = 1;

impl Checker<'_, '_> {
    fn mistake(&mut self, at: Stretch, message: impl Into<String>) -> Typed {
        let mut message = message.into();
        if let Some((name, call)) = self.calls.first() {
            let line = self.text.place(call.from).line;
            message = format!("{message} (in `{name}` as it is called in line {line})");
        }
        self.mistakes.add(at, message);
        Typed::Unknown
    }

    fn quote(&self, expression: &Expression<'_>) -> String {
        self.text.quote(expression.at)
    }

    fn line(&self, at: Stretch) -> u32 {
        self.text.place(at.from).line
    }

    fn too_large(&mut self, assembler: &Assembler) {
        if let Some(excess) = assembler.excess() {
            let takes_long = assembler.cost > COST_MAX;
            let part = if takes_long {
                self.most_of(LOOPS, assembler.cost).or_else(|| self.most_of(CALLS, self.visits as u64))
            } else {
                self.most_of(CALLS, self.visits as u64)
            };
            self.say_too_large(&excess, part);
        }
    }

    /// Notes that a law is too large, where its largest part stands if that is most of it.
    fn say_too_large(&mut self, what: &str, part: Option<(String, Stretch)>) {
        match part {
            Some((part, at)) => self.mistakes.add(at, format!("{what}; {part} is most of it")),
            None => self.mistakes.add(Stretch::default(), what),
        }
    }

    /// The largest call or loop, if it is more than half of `all`.
    fn most_of(&self, kind: usize, all: u64) -> Option<(String, Stretch)> {
        let part = self.largest[kind].as_ref().filter(|part| part.size > all / 2)?;
        Some((format!("{} in line {}", part.what, self.line(part.at)), part.at))
    }

    /// Notes the size of a call or a loop.
    fn measure(&mut self, kind: usize, size: u64, at: Stretch, what: impl FnOnce() -> String) {
        if self.largest[kind].as_ref().is_none_or(|part| part.size < size) {
            self.largest[kind] = Some(LargePart { what: what(), at, size });
        }
    }

    /// Every name of the file stands for one thing.
    fn check_names(&mut self) {
        let syntax = self.syntax;
        let numbers = syntax.parameters.iter().map(|p| (p.name, p.at));
        let numbers: Vec<_> = numbers.chain(syntax.memory.iter().map(|m| (m.name, m.at))).collect();
        let functions: Vec<_> = syntax.functions.iter().map(|f| (f.name, f.at)).collect();
        for mut list in [numbers, functions] {
            list.sort_by_key(|(name, at)| (*name, at.from));
            for pair in list.windows(2) {
                if pair[0].0 == pair[1].0 {
                    let line = self.line(pair[0].1);
                    self.mistakes
                        .add(pair[1].1, format!("`{}` is defined already, in line {line}", pair[1].0));
                }
            }
        }
    }

    /// The start of the memory, in its order.
    fn start(&mut self) {
        let mut register = self.syntax.parameters.len() as u16;
        for Named { name, at, value: expression } in &self.syntax.memory {
            self.assembler.begin(format!("the start of `{name}`"));
            let mark = self.assembler.mark();
            let value = self.expression(expression);
            let value = if let Typed::Truth(_) = value {
                let quoted = self.quote(expression);
                self.mistake(
                    expression.at,
                    format!("{quoted} is a condition: memory holds numbers, such as 0 and 1"),
                )
            } else {
                value
            };
            let kept = value.with(|operand| {
                self.assembler.put(register, operand);
                register += 1;
                Operand::Named(register - 1)
            });
            self.assembler.release(mark);
            let value = with_bare_zero_as_number(kept);
            if self.syntax.set.contains(name) {
                self.changing.extend(value.operands().filter_map(register_of));
            }
            self.memory.push(MemoryVariable { name, at: *at, value, is_set: false, rates: None });
        }
    }

    fn command(&mut self) -> Option<[Operand; 2]> {
        let parts = self.syntax.command.as_ref()?;
        self.assembler.begin("the command".to_owned());
        let values: Vec<Typed> = parts.iter().map(|part| self.expression(part)).collect();
        let wanted = [("an acceleration", Unit::new(1, -2)), ("a turn rate", Unit::new(0, -1).angular())];
        let numbers = match values[..] {
            [Typed::Vector(both)] => both,
            [Typed::Number(_)] => {
                self.mistake(parts[0].at, "the command has two parts: `command = acceleration, turn_rate`");
                return None;
            }
            [Typed::Number(acceleration), Typed::Number(turn_rate)] => [acceleration, turn_rate],
            _ => {
                for (part, value) in parts.iter().zip(&values).filter(|(_, value)| **value != Typed::Unknown)
                {
                    if !matches!(value, Typed::Number(_)) {
                        let quoted = self.quote(part);
                        self.mistake(
                            part.at,
                            format!("{quoted} {}: this should be a number", value.described()),
                        );
                    }
                }
                return None;
            }
        };
        for (number, (index, (what, unit))) in numbers.iter().zip(wanted.into_iter().enumerate()) {
            if !number.fits(unit) {
                let part = parts.get(index).unwrap_or(&parts[0]);
                let quoted = if parts.len() == 1 {
                    format!("{}.{}", self.quote(part), ["x", "y"][index])
                } else {
                    self.quote(part)
                };
                self.mistake(
                    part.at,
                    format!("the command asks for {what} in {unit}, {quoted} {}", described(number.unit)),
                );
            }
        }
        Some(numbers.map(|number| number.operand))
    }

    fn finish(mut self, start: Assembler, command: Option<[Operand; 2]>) -> Option<CheckedLaw> {
        let mut assembler = std::mem::replace(&mut self.assembler, Assembler::new(0, 0));
        let command = command.map(|both| both.map(|operand| assembler.register(operand)));
        let mut declaration = Declaration {
            title: self.text.title(),
            leaders: self.leaders,
            knows: self.syntax.knows,
            reads: self.reads.iter().copied().collect(),
            continuous: !self.is_noisy && self.memory.iter().all(|memory| !memory.is_set),
            ..Declaration::default()
        };
        for parameter in &self.syntax.parameters {
            declaration.parameters.push(Parameter {
                name: parameter.name.to_owned(),
                symbol: parameter.symbol.map_or_else(|| symbol(parameter.name), str::to_owned),
                unit: parameter.unit,
                unit_name: parameter.unit_name.clone(),
                unit_size: parameter.unit_size,
                default: parameter.default,
                range: parameter.range,
                scale: parameter.scale,
                help: parameter.help.to_owned(),
            });
        }
        let mut changes = vec![];
        let mut memory_places = vec![];
        for memory in &self.memory {
            declaration.memory.extend(quantities(memory.name, &memory.value));
            let rates: Vec<Operand> = memory.rates.iter().flat_map(Typed::operands).collect();
            for index in 0..memory.value.operands().count() {
                memory_places.push(memory.at);
                changes.push(match rates.get(index) {
                    Some(rate) => Change::Rate(assembler.register(*rate)),
                    None if memory.is_set => Change::Set,
                    None => Change::Kept,
                });
            }
        }
        let mut shown = vec![];
        for variable in &self.scope {
            declaration.shown.extend(quantities(variable.name, &variable.value));
            shown.extend(variable.value.operands().map(|operand| assembler.register(operand)));
        }
        for assembler in [&start, &assembler] {
            if assembler.overflows() || self.visits >= VISITS_MAX {
                let part = self.most_of(CALLS, self.visits as u64);
                self.say_too_large(TOO_LARGE, part);
            }
            self.too_large(assembler);
        }
        if !self.mistakes.is_empty() {
            return None;
        }
        let cost = assembler.cost;
        let (step, map) = assembler.finish();
        for change in &mut changes {
            if let Change::Rate(register) = change {
                *register = map(*register);
            }
        }
        Some(CheckedLaw {
            declaration,
            start: start.finish().0,
            changes,
            cost,
            command: command?.map(&map),
            shown: shown.into_iter().map(map).collect(),
            step,
            memory_places,
            parameter_places: self.syntax.parameters.iter().map(|parameter| parameter.at).collect(),
        })
    }
}

const POWERS: &str = "the powers of this unit are too large, or have no place in a unit";
const TOO_LARGE: &str = "this law is too large once its functions are written out";

/// An operand that may be read several times.
fn base_kept(operand: Operand) -> Operand {
    match operand {
        Operand::Temporary(register) => Operand::Named(register),
        other => other,
    }
}

fn register_of(operand: Operand) -> Option<u16> {
    match operand {
        Operand::Constant(_) => None,
        Operand::Temporary(register) | Operand::Named(register) => Some(register),
    }
}

/// A 0 that has got a name is a number.
fn with_bare_zero_as_number(value: Typed) -> Typed {
    let plain = |number| Measured { is_bare_zero: false, ..number };
    match value {
        Typed::Number(number) => Typed::Number(plain(number)),
        Typed::Vector(both) => Typed::Vector(both.map(plain)),
        other => other,
    }
}

/// The numbers of a value by name: "e", or "e.x" and "e.y".
fn quantities(name: &str, value: &Typed) -> Vec<Quantity> {
    let quantity = |name: String, unit| Quantity { name, unit };
    match value {
        Typed::Unknown => vec![],
        Typed::Number(number) => vec![quantity(name.to_owned(), number.unit)],
        Typed::Vector([x, y]) => {
            vec![quantity(format!("{name}.x"), x.unit), quantity(format!("{name}.y"), y.unit)]
        }
        Typed::Truth(_) => vec![quantity(name.to_owned(), Unit::NUMBER)],
    }
}
