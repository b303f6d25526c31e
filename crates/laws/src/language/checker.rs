//! A syntax tree to code, with its units checked on the way. Functions are written out where they are called, so their units
//! are checked at each call.

use super::assembler::{Assembler, Operand};
use super::builtin::{BUILTINS, Builtin, BuiltinKind};
use super::code::{Code, Operation};
use super::law_text::{LawText, Stretch};
use super::mistake::MistakeList;
use super::names;
use super::symbol::symbol;
use super::syntax::{
    Arithmetic, Block, Choice, Expression, ExpressionKind, FunctionSyntax, Junction, LawSyntax, Named,
    Statement,
};
use super::typed::{Measured, Typed, described};
use crate::declaration::{Declaration, Knowledge, Parameter, Quantity};
use crate::input::{INPUTS, InputKind};
use crate::unit::Unit;
use std::collections::{BTreeSet, HashSet};

/// How many parts of the tree are visited, functions written out: bounds the time that compiling takes.
const VISITS_MAX: usize = 200_000;
/// How deep the tree may be with its functions written out.
const DEPTH_MAX: usize = 128;
/// The largest power that is multiplied out.
const POWER_MAX: f64 = 16.0;

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
    reads: BTreeSet<(usize, InputKind)>,
    is_noisy: bool,
}

impl<'a> Checker<'a, '_> {
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
            self.mistakes.add(Stretch::default(), excess);
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
                self.mistakes.add(Stretch::default(), TOO_LARGE);
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

    // Statements.

    fn statements(&mut self, statements: &[Statement<'a>]) {
        for statement in statements {
            if self.is_exhausted() {
                return;
            }
            let owner = self.assembler.origin.owner;
            match statement {
                Statement::Let(named) => self.define(named),
                Statement::Set(named) => self.set(named),
                Statement::Rate(named) => self.rate(named),
                Statement::If(choice) => self.branch(choice),
                Statement::Repeat { count, counter, body, at } => {
                    self.assembler.origin.at = *at;
                    self.repeat(*count, counter.as_ref(), body);
                }
            }
            self.assembler.origin.owner = owner;
        }
    }

    /// Whether so much was visited, or so many mistakes were found, that there is no use in going on.
    fn is_exhausted(&self) -> bool {
        self.visits >= VISITS_MAX || self.mistakes.is_full() || self.assembler.excess().is_some()
    }

    fn define(&mut self, named: &Named<'a, Expression<'a>>) {
        let Named { name, at, value: expression } = named;
        self.assembler.begin(format!("`{name}`"));
        let mark = self.assembler.mark();
        let value = self.expression(expression);
        let value = with_bare_zero_as_number(self.keep(value, mark, self.syntax.set.contains(name)));
        self.check_new(name, *at);
        self.scope.push(Variable { name, at: *at, value, kind: VariableKind::Let });
    }

    /// A name that is defined here must not be seen already.
    fn check_new(&mut self, name: &str, at: Stretch) {
        let variable =
            self.scope[self.floor..].iter().find(|variable| variable.name == name).map(|known| known.at);
        let memory = self.syntax.memory.iter().find(|memory| memory.name == name).map(|known| known.at);
        let parameter =
            self.syntax.parameters.iter().find(|parameter| parameter.name == name).map(|known| known.at);
        if let Some(known) = variable.or(memory) {
            let line = self.line(known);
            self.mistake(at, format!("`{name}` is defined already, in line {line}; to change it, write `{name} = …` without `let`"));
        } else if let Some(known) = parameter {
            let line = self.line(known);
            self.mistake(at, format!("`{name}` is a parameter, in line {line}: choose another name"));
        }
    }

    /// Keeps a value in registers from `mark` on, for a name; `is_own` if they will change.
    fn keep(&mut self, value: Typed, mark: u16, is_own: bool) -> Typed {
        self.settle(mark, &value);
        let changing = std::mem::take(&mut self.changing);
        let mut own = vec![];
        let kept = value.with(|operand| {
            let is_copied = match operand {
                Operand::Temporary(register) => {
                    own.push(register);
                    return Operand::Named(register);
                }
                Operand::Constant(_) => is_own,
                Operand::Named(register) => is_own || changing.contains(&register),
            };
            if !is_copied {
                return operand;
            }
            let register = self.assembler.reserve();
            self.assembler.put(register, operand);
            own.push(register);
            Operand::Named(register)
        });
        self.changing = changing;
        // A register is used again behind its block: what was known of it then is no longer true.
        for register in own {
            if is_own {
                self.changing.insert(register);
            } else {
                self.changing.remove(&register);
            }
        }
        kept
    }

    /// Frees the registers from `mark` on, but for those of a value.
    fn settle(&mut self, mark: u16, value: &Typed) {
        let used = value.operands().filter_map(register_of).filter(|register| *register >= mark);
        let above = used.filter(|register| usize::from(*register) < super::assembler::REGISTERS_MAX).max();
        self.assembler.release(above.map_or(mark, |register| register + 1));
    }

    fn set(&mut self, named: &Named<'a, Expression<'a>>) {
        let Named { name, at, value: expression } = named;
        self.assembler.begin(format!("`{name}`"));
        let mark = self.assembler.mark();
        let value = self.expression(expression);
        if let Some(target) = self.target(name, *at)
            && self.matches(name, target, value, expression)
        {
            self.assign(target, value);
        }
        self.assembler.release(mark);
    }

    /// What `name = …` sets.
    fn target(&mut self, name: &str, at: Stretch) -> Option<Typed> {
        let index = self.scope[self.floor..].iter().rposition(|variable| variable.name == name);
        if let Some(index) = index.map(|index| index + self.floor) {
            let variable = &self.scope[index];
            let value = variable.value;
            let message = match variable.kind {
                VariableKind::Let if index >= self.value_floor => return Some(value),
                VariableKind::Let => format!(
                    "`{name}` is defined outside of this value, which may not change it: use `if` as a statement"
                ),
                VariableKind::Argument => format!("`{name}` is an argument: name a new value by `let`"),
                VariableKind::Counter => format!("`{name}` counts the rounds: it cannot be set"),
            };
            self.mistake(at, message);
            return None;
        }
        if let Some(index) = self.memory.iter().position(|memory| memory.name == name) {
            if !self.calls.is_empty() || self.value_floor > 0 {
                self.mistake(at, format!("`{name}` is memory: a value or a function may not set it"));
                return None;
            }
            let memory = &mut self.memory[index];
            memory.is_set = true;
            let value = memory.value;
            if memory.rates.is_some() {
                self.both_ways(name, at);
            }
            return Some(value);
        }
        let message = if self.syntax.parameters.iter().any(|parameter| parameter.name == name) {
            format!("`{name}` is a parameter: a law cannot set it")
        } else {
            let known: Vec<&str> = self.scope[self.floor..].iter().map(|variable| variable.name).collect();
            let known = known.into_iter().chain(self.syntax.memory.iter().map(|memory| memory.name));
            let meant = names::did_you_mean(name, known);
            format!("`{name}` is not defined here: write `let {name} = …`{meant}")
        };
        self.mistake(at, message);
        None
    }

    fn both_ways(&mut self, name: &str, at: Stretch) {
        self.mistake(at, format!("`{name}` is set and has a derivative: it can only have one of the two"));
    }

    /// Whether a value may be put where there is one like `target`.
    fn matches(&mut self, name: &str, target: Typed, value: Typed, expression: &Expression<'_>) -> bool {
        let pairs = match (target, value) {
            (Typed::Unknown, _) | (_, Typed::Unknown) => return false,
            (Typed::Number(target), Typed::Number(value)) => vec![(target, value)],
            (Typed::Vector(target), Typed::Vector(value)) => target.into_iter().zip(value).collect(),
            (Typed::Truth(_), Typed::Truth(_)) => return true,
            _ => {
                let quoted = self.quote(expression);
                let message = format!("`{name}` {}, {quoted} {}", target.described(), value.described());
                self.mistake(expression.at, message);
                return false;
            }
        };
        let wrong = pairs.iter().find(|(target, value)| !value.fits(target.unit));
        if let Some((start, found)) = wrong {
            let quoted = self.quote(expression);
            let mut message = format!("`{name}` {}, {quoted} {}", target.described(), value.described());
            if start.unit == Unit::NUMBER {
                let unit = found.unit;
                message = format!(
                    "{message}; if `{name}` starts at a plain number, give that a unit: `0 [{unit}]`"
                );
            }
            self.mistake(expression.at, message);
        }
        wrong.is_none()
    }

    fn assign(&mut self, target: Typed, value: Typed) {
        let registers: Vec<u16> = target.operands().filter_map(register_of).collect();
        let mut operands: Vec<Operand> = value.operands().collect();
        // (x, y) = (y, x): the second must not read what the first has written.
        if let ([first, ..], [_, second]) = (&registers[..], &mut operands[..])
            && *second == Operand::Named(*first)
        {
            let copy = self.assembler.reserve();
            self.assembler.put(copy, *second);
            *second = Operand::Named(copy);
        }
        for (register, operand) in registers.into_iter().zip(operands) {
            self.assembler.put(register, operand);
        }
    }

    fn rate(&mut self, named: &Named<'a, Expression<'a>>) {
        let Named { name, at, value: expression } = named;
        self.assembler.begin(format!("the derivative of `{name}`"));
        let mark = self.assembler.mark();
        let value = self.expression(expression);
        let value = self.keep(value, mark, false);
        let Some(index) = self.memory.iter().position(|memory| memory.name == *name) else {
            let known = self.syntax.memory.iter().map(|memory| memory.name);
            let meant = names::did_you_mean(name, known);
            self.mistake(*at, format!("only memory has a derivative: write `memory {name} = …`{meant}"));
            return;
        };
        if self.blocks > 0 || self.floor > 0 {
            self.mistake(
                *at,
                format!(
                    "`{name}'` stands outside of all braces: write `{name}' = if … {{ … }} else {{ … }}`"
                ),
            );
            return;
        }
        let memory = &self.memory[index];
        if memory.rates.is_some() {
            self.mistake(*at, format!("`{name}'` is there twice"));
            return;
        }
        if memory.is_set {
            self.both_ways(name, *at);
        }
        let memory = &mut self.memory[index];
        memory.rates = Some(value);
        let per_second = |number: Measured| {
            let unit = number.unit.divide(Unit::new(0, 1)).unwrap_or(number.unit);
            Measured { unit, ..number }
        };
        let target = match memory.value {
            Typed::Number(number) => Typed::Number(per_second(number)),
            Typed::Vector(both) => Typed::Vector(both.map(per_second)),
            other => other,
        };
        let pairs: Vec<(Measured, Measured)> = match (target, value) {
            (Typed::Unknown, _) | (_, Typed::Unknown) => return,
            (Typed::Number(target), Typed::Number(value)) => vec![(target, value)],
            (Typed::Vector(target), Typed::Vector(value)) => target.into_iter().zip(value).collect(),
            _ => {
                let quoted = self.quote(expression);
                let message = format!(
                    "`{name}` {}, so {quoted} cannot be its derivative: it {}",
                    self.memory[index].value.described(),
                    value.described()
                );
                self.mistake(expression.at, message);
                return;
            }
        };
        if let Some((wanted, found)) = pairs.iter().find(|(target, value)| !value.fits(target.unit)) {
            let quoted = self.quote(expression);
            let mut message = format!("`{name}'` {}, {quoted} {}", target.described(), value.described());
            if wanted.unit == Unit::new(0, -1)
                && let Some(unit) = found.unit.multiply(Unit::new(0, 1))
            {
                message = format!(
                    "{message}; with this derivative, `{name}` starts at a number in {unit}, such as `0 [{unit}]`"
                );
            }
            self.mistake(expression.at, message);
        }
    }

    fn repeat(&mut self, count: u32, counter: Option<&Named<'a, ()>>, body: &Block<'a>) {
        let mark = self.assembler.mark();
        let register = self.assembler.reserve();
        self.assembler.put(register, Operand::Constant(1.0));
        let before = self.assembler.cost;
        let from = self.assembler.here();
        let scope = self.scope.len();
        if let Some(Named { name, at, .. }) = counter {
            self.check_new(name, *at);
            let value = Typed::Number(Measured::new(Operand::Named(register), Unit::NUMBER));
            self.scope.push(Variable { name, at: *at, value, kind: VariableKind::Counter });
        }
        self.counters.push(register);
        self.block_of_statements(body);
        self.counters.pop();
        self.scope.truncate(scope);
        self.assembler.again(from, register, count);
        let round = self.assembler.cost - before;
        self.assembler.cost = before.saturating_add(round.saturating_mul(u64::from(count)));
        self.assembler.release(mark);
    }

    /// A block whose value, if it has one, is not used.
    fn block_of_statements(&mut self, block: &Block<'a>) {
        let scope = self.scope.len();
        let mark = self.assembler.mark();
        self.blocks += 1;
        self.statements(&block.statements);
        match &block.value {
            Some(Expression { kind: ExpressionKind::If(choice), .. }) => self.branch(choice),
            Some(value) => {
                self.mistake(value.at, "this value is not used: set something, `x = …`");
            }
            None => {}
        }
        self.blocks -= 1;
        self.scope.truncate(scope);
        self.assembler.release(mark);
    }

    /// An `if` as a statement.
    fn branch(&mut self, choice: &Choice<'a>) {
        if !self.visit(choice.condition.at) {
            return;
        }
        let mark = self.assembler.mark();
        let condition = self.condition(&choice.condition);
        self.assembler.release(mark);
        let unless = self.assembler.jump_unless(condition);
        let before = self.assembler.cost;
        self.block_of_statements(&choice.then);
        if let Some(otherwise) = &choice.otherwise {
            let end = self.assembler.jump();
            self.assembler.lead(unless);
            self.other_branch(before, |checker| checker.block_of_statements(otherwise));
            self.assembler.lead(end);
        } else {
            self.assembler.lead(unless);
        }
        self.depth -= 1;
    }

    /// The second of two branches, of which the dearer one counts; `before` is the cost before the first.
    fn other_branch<T>(&mut self, before: u64, check: impl FnOnce(&mut Self) -> T) -> T {
        let first = std::mem::replace(&mut self.assembler.cost, before);
        let checked = check(self);
        self.assembler.cost = self.assembler.cost.max(first);
        checked
    }

    // Values.

    /// Goes one level deeper, if that is still possible.
    fn visit(&mut self, at: Stretch) -> bool {
        self.visits += 1;
        if self.is_exhausted() {
            return false;
        }
        if self.depth >= DEPTH_MAX {
            self.mistake(
                at,
                format!("this is nested too deeply: there may be {DEPTH_MAX} levels, functions written out"),
            );
            return false;
        }
        self.depth += 1;
        true
    }

    fn expression(&mut self, expression: &Expression<'a>) -> Typed {
        if !self.visit(expression.at) {
            return Typed::Unknown;
        }
        let at = expression.at;
        let value = match &expression.kind {
            ExpressionKind::Broken => Typed::Unknown,
            ExpressionKind::Number(value, unit) => Typed::Number(Measured {
                operand: Operand::Constant(*value),
                unit: unit.unwrap_or(Unit::NUMBER),
                is_bare_zero: *value == 0.0 && unit.is_none(),
            }),
            ExpressionKind::Truth(truth) => Typed::Truth(Operand::Constant(f64::from(u8::from(*truth)))),
            ExpressionKind::Name(name) => self.named(name, at),
            ExpressionKind::Member(base, member) => self.member(base, member, at),
            ExpressionKind::Vector(both) => {
                let [x, y] = [&both[0], &both[1]].map(|part| (part, self.expression(part)));
                match [self.number(x.0, x.1), self.number(y.0, y.1)] {
                    [Some(x), Some(y)] => Typed::Vector([x, y]),
                    _ => Typed::Unknown,
                }
            }
            ExpressionKind::Negative(of) => {
                let mark = self.assembler.mark();
                let value = self.expression(of);
                self.each(of, value, mark, |checker, number, mark| {
                    let operand = checker.apply(at, Operation::Negate, &[number.operand], mark);
                    Some(Measured { operand, ..number })
                })
            }
            ExpressionKind::Not(of) => {
                let mark = self.assembler.mark();
                let condition = self.condition(of);
                Typed::Truth(self.apply(at, Operation::Subtract, &[Operand::Constant(1.0), condition], mark))
            }
            ExpressionKind::Chain(first, rest) => self.chain(first, rest),
            ExpressionKind::Power(both) => self.power(&both[0], &both[1], at),
            ExpressionKind::Comparison(sign, both) => self.comparison(sign, both, at),
            ExpressionKind::Joined(junction, all) => {
                let operation = match junction {
                    Junction::And => Operation::Minimum,
                    Junction::Or => Operation::Maximum,
                };
                let mark = self.assembler.mark();
                let mut joined = None;
                for part in all {
                    let condition = self.condition(part);
                    joined = Some(match joined {
                        Some(before) => self.apply(at, operation, &[before, condition], mark),
                        None => condition,
                    });
                }
                joined.map_or(Typed::Unknown, Typed::Truth)
            }
            ExpressionKind::Call(call) => self.call(call, at),
            ExpressionKind::If(choice) => self.choice(choice, at),
        };
        self.depth -= 1;
        value
    }

    fn apply(&mut self, at: Stretch, operation: Operation, sources: &[Operand], mark: u16) -> Operand {
        self.assembler.origin.at = at;
        self.assembler.apply(operation, sources, mark)
    }

    /// The number that a value is.
    fn number(&mut self, expression: &Expression<'_>, value: Typed) -> Option<Measured> {
        match value {
            Typed::Number(number) => Some(number),
            Typed::Unknown => None,
            Typed::Vector(_) | Typed::Truth(_) => {
                let quoted = self.quote(expression);
                self.mistake(
                    expression.at,
                    format!("{quoted} {}: this should be a number", value.described()),
                );
                None
            }
        }
    }

    fn condition(&mut self, expression: &Expression<'a>) -> Operand {
        match self.expression(expression) {
            Typed::Truth(operand) => return operand,
            Typed::Unknown => {}
            value => {
                let quoted = self.quote(expression);
                let message =
                    format!("{quoted} {}: this should be a condition, such as `x > 0`", value.described());
                self.mistake(expression.at, message);
            }
        }
        Operand::Constant(1.0)
    }

    /// A value of each number of a number or vector.
    fn each(
        &mut self,
        expression: &Expression<'_>,
        value: Typed,
        mark: u16,
        mut of: impl FnMut(&mut Self, Measured, u16) -> Option<Measured>,
    ) -> Typed {
        match value {
            Typed::Unknown => Typed::Unknown,
            Typed::Number(number) => of(self, number, mark).map_or(Typed::Unknown, Typed::Number),
            Typed::Vector([x, y]) => {
                // The second number still needs its registers.
                let mut next = |checker: &mut Self, number| {
                    let mark = checker.assembler.mark();
                    of(checker, number, mark)
                };
                match [next(self, x), next(self, y)] {
                    [Some(x), Some(y)] => Typed::Vector([x, y]),
                    _ => Typed::Unknown,
                }
            }
            Typed::Truth(_) => {
                self.number(expression, value);
                Typed::Unknown
            }
        }
    }

    /// The value of a name.
    fn named(&mut self, name: &str, at: Stretch) -> Typed {
        if let Some(variable) = self.scope[self.floor..].iter().rev().find(|variable| variable.name == name) {
            return variable.value;
        }
        if let Some(memory) = self.memory.iter().find(|memory| memory.name == name) {
            return memory.value;
        }
        if let Some(index) = self.syntax.parameters.iter().position(|parameter| parameter.name == name) {
            let unit = self.syntax.parameters[index].unit;
            return Typed::Number(Measured::new(Operand::Named(index as u16), unit));
        }
        if matches!(name, "pi" | "π") {
            return Typed::Number(Measured::new(Operand::Constant(std::f64::consts::PI), Unit::NUMBER));
        }
        if let Some((kind, _, unit, _)) =
            INPUTS.iter().find(|(kind, input, ..)| !kind.is_per_leader() && *input == name)
        {
            return Typed::Number(self.input(0, *kind, *unit, at));
        }
        let message = self.unknown_name(name);
        self.mistake(at, message)
    }

    fn unknown_name(&self, name: &str) -> String {
        let syntax = self.syntax;
        if syntax.memory.iter().any(|memory| memory.name == name) {
            return format!("`{name}` is declared further down: a start may use the memory above it");
        }
        let is_let =
            |statement: &&Statement<'_>| matches!(statement, Statement::Let(named) if named.name == name);
        if let Some(Statement::Let(named)) = syntax.statements.iter().find(is_let) {
            return if self.is_start {
                format!(
                    "`{name}` is computed at every sample: a start may use inputs, parameters and functions"
                )
            } else if self.floor > 0 {
                format!("a function does not see `{name}`: hand it over as an argument")
            } else {
                format!("`{name}` is defined further down, in line {}", self.line(named.at))
            };
        }
        let group = name.trim_end_matches(|c: char| c.is_ascii_digit());
        if group == "own" && group != name {
            return format!("`{name}` has no number: write `own.speed`");
        }
        if matches!(group, "leader" | "wanted" | "frame" | "own") {
            let names = names::input_names(1);
            let example = names.iter().find(|input| input.starts_with(group));
            let example = example.map_or_else(String::new, |example| example.replacen(group, name, 1));
            return format!("`{name}` alone is no number: write what of it, such as `{example}`");
        }
        if BUILTINS.iter().any(|builtin| builtin.name == name)
            || syntax.functions.iter().any(|f| f.name == name)
        {
            return format!("`{name}` is a function: write `{name}(…)`");
        }
        if let Some(here) = names::said_here(name) {
            return here.to_owned();
        }
        let inputs = names::input_names(self.leaders);
        let known = self.scope[self.floor..].iter().map(|variable| variable.name);
        let known = known.chain(self.memory.iter().map(|memory| memory.name));
        let known = known.chain(syntax.parameters.iter().map(|parameter| parameter.name));
        let known = known.chain(inputs.iter().map(String::as_str));
        format!("nothing is called `{name}`{}", names::did_you_mean(name, known))
    }

    fn input(&mut self, leader: usize, kind: InputKind, unit: Unit, at: Stretch) -> Measured {
        if kind.is_motion() && self.syntax.knows != Knowledge::Motion {
            let quoted = self.text.quote(at);
            let add = match self.syntax.knows {
                Knowledge::Rates => "write `knows motion` in place of `knows rates`",
                _ => "add the line `knows motion`",
            };
            self.mistake(
                at,
                format!("only a law that knows the motion of its leader can read {quoted}: {add}"),
            );
        }
        self.reads.insert((leader, kind));
        self.assembler.origin.at = at;
        Measured::new(self.assembler.input(leader, kind), unit)
    }

    fn member(&mut self, base: &Expression<'a>, member: &str, at: Stretch) -> Typed {
        if let ExpressionKind::Name(group) = base.kind {
            let stem = group.trim_end_matches(|c: char| c.is_ascii_digit());
            if matches!(stem, "leader" | "wanted" | "frame") || group == "own" {
                return self.input_of(group, member, at);
            }
        }
        let value = self.expression(base);
        let index = match member {
            "x" => 0,
            "y" => 1,
            _ => {
                if value == Typed::Unknown {
                    return value;
                }
                let quoted = self.quote(base);
                return self.mistake(
                    at,
                    format!(
                        "{quoted} {}: there is no `.{member}`, a vector has `.x` and `.y`",
                        value.described()
                    ),
                );
            }
        };
        match value {
            Typed::Vector(both) => Typed::Number(both[index]),
            Typed::Unknown => Typed::Unknown,
            _ => {
                let quoted = self.quote(base);
                self.mistake(at, format!("{quoted} {}: only a vector has `.{member}`", value.described()))
            }
        }
    }

    /// `leader.distance` and the like.
    fn input_of(&mut self, group: &str, member: &str, at: Stretch) -> Typed {
        let stem = group.trim_end_matches(|c: char| c.is_ascii_digit());
        let name = format!("{stem}.{member}");
        let pair = |first, second| Some([first, second]);
        let kinds = match name.as_str() {
            "leader.output" => pair(InputKind::Distance, InputKind::Bearing),
            "leader.rates" => pair(InputKind::DistanceRate, InputKind::BearingRate),
            "wanted.output" => pair(InputKind::WantedDistance, InputKind::WantedBearing),
            "wanted.rates" => pair(InputKind::WantedDistanceRate, InputKind::WantedBearingRate),
            "wanted.accelerations" => {
                pair(InputKind::WantedDistanceAcceleration, InputKind::WantedBearingAcceleration)
            }
            _ => None,
        };
        let entry = INPUTS.iter().find(|(_, input, ..)| *input == name);
        if entry.is_none() && kinds.is_none() {
            let known = names::input_names(if group == stem { 1 } else { self.leaders.max(2) });
            let written = format!("{group}.{member}");
            let meant = names::did_you_mean(&written, known.iter().map(String::as_str));
            return self.mistake(at, format!("there is no `{written}`{meant}"));
        }
        let leader = if group == "own" || group == stem {
            if group != "own" && self.leaders > 1 {
                let message =
                    format!("this law has {} leaders: write which, `{stem}1.{member}`", self.leaders);
                return self.mistake(at, message);
            }
            0
        } else {
            match group[stem.len()..].parse::<usize>() {
                Ok(number @ 1..) if number <= self.leaders => number - 1,
                Ok(number @ 1..=crate::input::LEADERS_MAX) => {
                    let has = if self.leaders == 1 {
                        "one leader".to_owned()
                    } else {
                        format!("{} leaders", self.leaders)
                    };
                    return self
                        .mistake(at, format!("this law has {has}: for `{group}`, write `leaders {number}`"));
                }
                _ => {
                    let most = crate::input::LEADERS_MAX;
                    return self.mistake(
                        at,
                        format!("there is no `{group}`: leaders count from 1 to {most} at most"),
                    );
                }
            }
        };
        match (entry, kinds) {
            (Some((kind, _, unit, _)), _) => Typed::Number(self.input(leader, *kind, *unit, at)),
            (None, Some(kinds)) => Typed::Vector(kinds.map(|kind| {
                let unit = INPUTS
                    .iter()
                    .find(|(input, ..)| *input == kind)
                    .map_or(Unit::NUMBER, |(_, _, unit, _)| *unit);
                self.input(leader, kind, unit, at)
            })),
            (None, None) => Typed::Unknown,
        }
    }

    fn chain(&mut self, first: &Expression<'a>, rest: &[(Arithmetic, Expression<'a>)]) -> Typed {
        let mark = self.assembler.mark();
        let mut value = self.expression(first);
        let mut at = first.at;
        for (index, (arithmetic, expression)) in rest.iter().enumerate() {
            let right = self.expression(expression);
            let before = Expression { kind: ExpressionKind::Broken, at };
            let left = if index == 0 { first } else { &before };
            at = at.through(expression.at);
            value = match arithmetic {
                Arithmetic::Plus | Arithmetic::Minus => {
                    self.sum(*arithmetic, [(left, value), (expression, right)], mark)
                }
                Arithmetic::Times | Arithmetic::Over => {
                    self.product(*arithmetic, [(left, value), (expression, right)], mark)
                }
            };
            if self.is_exhausted() {
                return Typed::Unknown;
            }
        }
        value
    }

    fn sum(&mut self, arithmetic: Arithmetic, sides: [(&Expression<'_>, Typed); 2], mark: u16) -> Typed {
        let (operation, done) = match arithmetic {
            Arithmetic::Plus => (Operation::Add, "added"),
            _ => (Operation::Subtract, "subtracted"),
        };
        let at = sides[0].0.at.through(sides[1].0.at);
        self.common(sides, done, mark, |checker, numbers, unit, mark| {
            let operand = checker.apply(at, operation, &numbers.map(|number| number.operand), mark);
            Measured::new(operand, unit)
        })
    }

    /// A value of two numbers of one unit, or of two vectors of the same.
    fn common(
        &mut self,
        sides: [(&Expression<'_>, Typed); 2],
        done: &str,
        mark: u16,
        of: impl Fn(&mut Self, [Measured; 2], Unit, u16) -> Measured,
    ) -> Typed {
        let [left, right] = sides;
        match (left.1, right.1) {
            (Typed::Unknown, _) | (_, Typed::Unknown) => Typed::Unknown,
            (Typed::Number(a), Typed::Number(b)) => match a.common(b) {
                Some(unit) => Typed::Number(of(self, [a, b], unit, mark)),
                None => self.differ(sides, done),
            },
            (Typed::Vector([ax, ay]), Typed::Vector([bx, by])) => match (ax.common(bx), ay.common(by)) {
                (Some(x), Some(y)) => {
                    let free = self.assembler.mark();
                    let x = of(self, [ax, bx], x, free);
                    let free = self.assembler.mark();
                    Typed::Vector([x, of(self, [ay, by], y, free)])
                }
                _ => self.differ(sides, done),
            },
            (Typed::Truth(_), _) => self.each(left.0, left.1, mark, |_, number, _| Some(number)),
            (_, Typed::Truth(_)) => self.each(right.0, right.1, mark, |_, number, _| Some(number)),
            _ => self.differ(sides, done),
        }
    }

    fn differ(&mut self, sides: [(&Expression<'_>, Typed); 2], done: &str) -> Typed {
        let [left, right] =
            sides.map(|(expression, value)| format!("{} {}", self.quote(expression), value.described()));
        let at = sides[0].0.at.through(sides[1].0.at);
        let mut message = format!("{left}, {right}: they cannot be {done}");
        for (this, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
            if let (ExpressionKind::Number(value, None), Typed::Number(other)) = (&this.0.kind, other.1) {
                message = format!("{message}; with a unit it is `{value} [{}]`", other.unit);
            }
        }
        self.mistake(at, message)
    }

    fn product(&mut self, arithmetic: Arithmetic, sides: [(&Expression<'_>, Typed); 2], mark: u16) -> Typed {
        let at = sides[0].0.at.through(sides[1].0.at);
        let one = |checker: &mut Self, [a, b]: [Measured; 2], mark: u16| {
            let (operation, unit) = match arithmetic {
                Arithmetic::Times => (Operation::Multiply, a.unit.multiply(b.unit)),
                _ => (Operation::Divide, a.unit.divide(b.unit)),
            };
            let operand = checker.apply(at, operation, &[a.operand, b.operand], mark);
            let Some(unit) = unit else {
                checker.mistake(at, POWERS);
                return None;
            };
            Some(Measured::new(operand, unit))
        };
        let (a, b) = (sides[0].1, sides[1].1);
        let pairs = match (a, b) {
            (Typed::Unknown, _) | (_, Typed::Unknown) => return Typed::Unknown,
            (Typed::Number(a), Typed::Number(b)) => {
                return one(self, [a, b], mark).map_or(Typed::Unknown, Typed::Number);
            }
            (Typed::Vector([x, y]), Typed::Number(b)) => [[x, b], [y, b]],
            (Typed::Vector([ax, ay]), Typed::Vector([bx, by])) => [[ax, bx], [ay, by]],
            (Typed::Number(a), Typed::Vector([x, y])) if arithmetic == Arithmetic::Times => [[a, x], [a, y]],
            (Typed::Number(_), Typed::Vector(_)) => {
                return self.mistake(at, "a number cannot be divided by a vector");
            }
            (Typed::Truth(_), _) => return self.each(sides[0].0, a, mark, |_, number, _| Some(number)),
            (_, Typed::Truth(_)) => return self.each(sides[1].0, b, mark, |_, number, _| Some(number)),
        };
        let [x, y] = pairs.map(|pair| {
            let free = self.assembler.mark();
            one(self, pair, free)
        });
        x.zip(y).map_or(Typed::Unknown, |(x, y)| Typed::Vector([x, y]))
    }

    fn power(&mut self, base: &Expression<'a>, exponent: &Expression<'a>, at: Stretch) -> Typed {
        let mark = self.assembler.mark();
        let value = self.expression(base);
        let raised = self.expression(exponent);
        let Some(raised) = self.number(exponent, raised) else { return Typed::Unknown };
        if raised.unit != Unit::NUMBER {
            let quoted = self.quote(exponent);
            return self.mistake(
                exponent.at,
                format!("an exponent is a number, {quoted} {}", described(raised.unit)),
            );
        }
        self.each(base, value, mark, |checker, number, mark| {
            let Operand::Constant(power) = raised.operand else {
                if number.unit != Unit::NUMBER {
                    let quoted = checker.quote(base);
                    let message = format!(
                        "{quoted} {}: its exponent has to be written out as a number",
                        described(number.unit)
                    );
                    checker.mistake(at, message);
                    return None;
                }
                let operand = checker.apply(at, Operation::Power, &[number.operand, raised.operand], mark);
                return Some(Measured::new(operand, Unit::NUMBER));
            };
            let Some(unit) = number.unit.power(power) else {
                checker.mistake(at, POWERS);
                return None;
            };
            Some(Measured::new(checker.raised(number.operand, power, at, mark), unit))
        })
    }

    /// A power whose exponent is known: small whole ones are multiplied out, as `math::powi` does.
    fn raised(&mut self, base: Operand, power: f64, at: Stretch, mark: u16) -> Operand {
        let whole = power.abs();
        if power == 0.5 {
            return self.apply(at, Operation::Root, &[base], mark);
        }
        if power.fract() != 0.0 || whole == 0.0 || whole > POWER_MAX {
            return self.apply(at, Operation::Power, &[base, Operand::Constant(power)], mark);
        }
        // The base is used several times.
        let base = base_kept(base);
        let mut product = base;
        for factor in 1..whole as u32 {
            let is_last = factor + 1 == whole as u32 && power > 0.0;
            let free = if is_last { mark } else { self.assembler.mark() };
            product = self.apply(at, Operation::Multiply, &[product, base], free);
        }
        if power < 0.0 {
            product = self.apply(at, Operation::Divide, &[Operand::Constant(1.0), product], mark);
        }
        product
    }

    fn comparison(&mut self, sign: &str, both: &[Expression<'a>; 2], at: Stretch) -> Typed {
        let mark = self.assembler.mark();
        let [left, right] = [&both[0], &both[1]].map(|side| (side, self.expression(side)));
        let sides = [left, right];
        if let [(_, Typed::Vector(_)), _] | [_, (_, Typed::Vector(_))] = sides {
            return self
                .mistake(at, "vectors cannot be compared: compare `.x` and `.y`, or their `length(…)`");
        }
        let compared = self.common(sides, "compared", mark, |checker, [a, b], _, mark| {
            let (operation, sources) = match sign {
                "<" => (Operation::Less, [a, b]),
                ">" => (Operation::Less, [b, a]),
                "<=" => (Operation::LessOrEqual, [a, b]),
                ">=" => (Operation::LessOrEqual, [b, a]),
                "==" => (Operation::Equal, [a, b]),
                _ => (Operation::NotEqual, [a, b]),
            };
            Measured::new(
                checker.apply(at, operation, &sources.map(|number| number.operand), mark),
                Unit::NUMBER,
            )
        });
        match compared {
            Typed::Number(number) => Typed::Truth(number.operand),
            _ => Typed::Unknown,
        }
    }

    /// An `if` as a value.
    fn choice(&mut self, choice: &Choice<'a>, at: Stretch) -> Typed {
        let mark = self.assembler.mark();
        let condition = self.condition(&choice.condition);
        self.assembler.release(mark);
        let to = [self.assembler.reserve(), self.assembler.reserve()];
        let unless = self.assembler.jump_unless(condition);
        let before = self.assembler.cost;
        let then = self.value_of_branch(&choice.then, to);
        let end = self.assembler.jump();
        self.assembler.lead(unless);
        let Some(block) = &choice.otherwise else {
            return self.mistake(at, "an `if` that is a value needs an `else { … }`");
        };
        let otherwise = self.other_branch(before, |checker| checker.value_of_branch(block, to));
        self.assembler.lead(end);
        let joined = match (then, otherwise) {
            (Typed::Unknown, _) | (_, Typed::Unknown) => return Typed::Unknown,
            (Typed::Number(a), Typed::Number(b)) => a.common(b).map(|unit| {
                let is_bare_zero = a.is_bare_zero && b.is_bare_zero;
                Typed::Number(Measured { operand: Operand::Temporary(to[0]), unit, is_bare_zero })
            }),
            (Typed::Vector([ax, ay]), Typed::Vector([bx, by])) => {
                ax.common(bx).zip(ay.common(by)).map(|(x, y)| {
                    Typed::Vector(
                        [(to[0], x), (to[1], y)]
                            .map(|(to, unit)| Measured::new(Operand::Temporary(to), unit)),
                    )
                })
            }
            (Typed::Truth(_), Typed::Truth(_)) => Some(Typed::Truth(Operand::Temporary(to[0]))),
            _ => None,
        };
        let Some(joined) = joined else {
            let [a, b] = [then, otherwise].map(|value| value.described());
            return self.mistake(at, format!("the first branch {a}, the other {b}: they need the same unit"));
        };
        self.settle(mark, &joined);
        joined
    }

    fn value_of_branch(&mut self, block: &Block<'a>, to: [u16; 2]) -> Typed {
        let mark = self.assembler.mark();
        let value = self.value_block(block);
        let operands: Vec<Operand> = value.operands().collect();
        for (to, operand) in to.into_iter().zip(operands) {
            self.assembler.put(to, operand);
        }
        self.assembler.release(mark);
        value
    }

    /// The value of a block.
    fn value_block(&mut self, block: &Block<'a>) -> Typed {
        let scope = self.scope.len();
        let floor = std::mem::replace(&mut self.value_floor, scope.max(1));
        self.blocks += 1;
        self.statements(&block.statements);
        let value = match &block.value {
            Some(value) => self.expression(value),
            None => self.mistake(block.at, "this block needs a value: its last line should be one"),
        };
        self.blocks -= 1;
        self.value_floor = floor;
        self.scope.truncate(scope);
        value
    }

    // Functions.

    fn call(&mut self, call: &Named<'a, Vec<Expression<'a>>>, at: Stretch) -> Typed {
        let Named { name, value: arguments, .. } = call;
        let syntax = self.syntax;
        if let Some(function) = syntax.functions.iter().find(|function| function.name == *name) {
            return self.written_out(function, arguments, at);
        }
        let is_builtin = BUILTINS.iter().any(|builtin| builtin.name == *name);
        let is_seen = self.scope[self.floor..].iter().any(|variable| variable.name == *name)
            || self.memory.iter().any(|memory| memory.name == *name)
            || syntax.parameters.iter().any(|parameter| parameter.name == *name);
        if is_seen && !is_builtin {
            return match self.named(name, call.at) {
                Typed::Vector(_) => self.mistake(
                    call.at,
                    format!("`{name}` is a vector: its components are `{name}.x` and `{name}.y`"),
                ),
                _ => self
                    .mistake(call.at, format!("`{name}` is no function: to multiply, write `{name} * (…)`")),
            };
        }
        let Some(builtin) = BUILTINS.iter().find(|builtin| builtin.name == *name) else {
            let known = BUILTINS.iter().map(|builtin| builtin.name);
            let meant = match names::called_here(name) {
                Some(here) => format!(": {here}"),
                None => names::did_you_mean(
                    name,
                    known.chain(syntax.functions.iter().map(|function| function.name)),
                ),
            };
            return self.mistake(call.at, format!("there is no function `{name}`{meant}"));
        };
        if !self.takes(name, builtin.arguments, arguments, at) {
            return Typed::Unknown;
        }
        self.builtin(builtin, arguments, at)
    }

    fn takes(&mut self, name: &str, wanted: usize, arguments: &[Expression<'_>], at: Stretch) -> bool {
        let counted = |count: usize| match count {
            1 => "one argument".to_owned(),
            _ => format!("{count} arguments"),
        };
        if wanted != arguments.len() {
            self.mistake(at, format!("`{name}` takes {}, here are {}", counted(wanted), arguments.len()));
        }
        wanted == arguments.len()
    }

    /// A function of the file, with these arguments.
    fn written_out(
        &mut self,
        function: &FunctionSyntax<'a>,
        arguments: &[Expression<'a>],
        at: Stretch,
    ) -> Typed {
        if !self.takes(function.name, function.arguments.len(), arguments, at) {
            return Typed::Unknown;
        }
        if self.calls.iter().any(|(name, _)| *name == function.name) {
            return self.mistake(at, format!("`{}` calls itself: a law has to end", function.name));
        }
        let mark = self.assembler.mark();
        let values: Vec<Typed> = arguments.iter().map(|argument| self.expression(argument)).collect();
        let scope = self.scope.len();
        for (name, value) in function.arguments.iter().zip(values) {
            // It may be used more than once.
            let value = value.with(base_kept);
            self.scope.push(Variable { name, at, value, kind: VariableKind::Argument });
        }
        let floor = std::mem::replace(&mut self.floor, scope);
        self.calls.push((function.name, at));
        let value = self.value_block(&function.body);
        self.calls.pop();
        self.floor = floor;
        self.scope.truncate(scope);
        self.settle(mark, &value);
        value
    }

    fn builtin(&mut self, builtin: &Builtin, arguments: &[Expression<'a>], at: Stretch) -> Typed {
        let name = builtin.name;
        let mark = self.assembler.mark();
        let values: Vec<Typed> = arguments.iter().map(|argument| self.expression(argument)).collect();
        let one = |checker: &mut Self, operation: Operation, number: Measured, unit: Unit, mark: u16| {
            Some(Measured::new(checker.apply(at, operation, &[number.operand], mark), unit))
        };
        let plain = |checker: &mut Self, number: Measured| {
            let is_plain = number.unit == Unit::NUMBER;
            if !is_plain {
                let quoted = checker.quote(&arguments[0]);
                checker.mistake(
                    arguments[0].at,
                    format!("`{name}` takes a number, {quoted} {}", described(number.unit)),
                );
            }
            is_plain
        };
        match (builtin.kind, &values[..]) {
            (BuiltinKind::Number(operation), [value]) => {
                self.each(&arguments[0], *value, mark, |checker, number, mark| {
                    if plain(checker, number) {
                        one(checker, operation, number, Unit::NUMBER, mark)
                    } else {
                        None
                    }
                })
            }
            (BuiltinKind::Angle(operation), [value]) => {
                self.each(&arguments[0], *value, mark, |checker, number, mark| {
                    if plain(checker, number) {
                        one(checker, operation, number, Unit::ANGLE, mark)
                    } else {
                        None
                    }
                })
            }
            (BuiltinKind::Same(operation), [value]) => {
                self.each(&arguments[0], *value, mark, |checker, number, mark| {
                    one(checker, operation, number, number.unit, mark)
                })
            }
            (BuiltinKind::Sign, [value]) => {
                self.each(&arguments[0], *value, mark, |checker, number, mark| {
                    one(checker, Operation::Sign, number, Unit::NUMBER, mark)
                })
            }
            (BuiltinKind::Root, [value]) => {
                self.each(&arguments[0], *value, mark, |checker, number, mark| {
                    let unit = number.unit.power(0.5);
                    if unit.is_none() {
                        checker.mistake(at, POWERS);
                    }
                    one(checker, Operation::Root, number, unit?, mark)
                })
            }
            (BuiltinKind::Common(operation), [a, b]) => {
                let sides = [(&arguments[0], *a), (&arguments[1], *b)];
                self.common(sides, "compared", mark, |checker, numbers, unit, mark| {
                    Measured::new(
                        checker.apply(at, operation, &numbers.map(|number| number.operand), mark),
                        unit,
                    )
                })
            }
            (BuiltinKind::Direction, [a, b]) => {
                let sides = [(&arguments[0], *a), (&arguments[1], *b)];
                self.common(
                    sides,
                    "taken for the two components of a vector",
                    mark,
                    |checker, numbers, _, mark| {
                        let operands = numbers.map(|number| number.operand);
                        Measured::new(checker.apply(at, Operation::Arctangent2, &operands, mark), Unit::ANGLE)
                    },
                )
            }
            (BuiltinKind::Clamp, [x, low, high]) => {
                let mut clamped = *x;
                for (index, (bound, operation)) in
                    [(low, Operation::Maximum), (high, Operation::Minimum)].into_iter().enumerate()
                {
                    let sides = [(&arguments[0], clamped), (&arguments[index + 1], *bound)];
                    // The other bound still needs its register.
                    let free = if index == 0 { self.assembler.mark() } else { mark };
                    clamped = self.common(sides, "compared", free, |checker, numbers, unit, mark| {
                        Measured::new(
                            checker.apply(at, operation, &numbers.map(|number| number.operand), mark),
                            unit,
                        )
                    });
                }
                clamped
            }
            (BuiltinKind::Dot, [a, b]) => {
                let both = [self.vector(name, &arguments[0], *a), self.vector(name, &arguments[1], *b)];
                let [Some([ax, ay]), Some([bx, by])] = both else { return Typed::Unknown };
                let units = [ax.unit.multiply(bx.unit), ay.unit.multiply(by.unit)];
                let [Some(x), Some(y)] = units else { return self.mistake(at, POWERS) };
                if x != y {
                    let message = format!(
                        "the products of the components differ: the first {}, the other {}",
                        described(x),
                        described(y)
                    );
                    return self.mistake(at, message);
                }
                let free = self.assembler.mark();
                let x = self.apply(at, Operation::Multiply, &[ax.operand, bx.operand], free);
                let free = self.assembler.mark();
                let y_product = self.apply(at, Operation::Multiply, &[ay.operand, by.operand], free);
                Typed::Number(Measured::new(self.apply(at, Operation::Add, &[x, y_product], mark), y))
            }
            (BuiltinKind::Length, [value]) => {
                let Some([x, y]) = self.uniform(name, &arguments[0], *value) else { return Typed::Unknown };
                let free = self.assembler.mark();
                let first = self.apply(at, Operation::Multiply, &[x.operand, x.operand], free);
                let free = self.assembler.mark();
                let second = self.apply(at, Operation::Multiply, &[y.operand, y.operand], free);
                let free = self.assembler.mark();
                let sum = self.apply(at, Operation::Add, &[first, second], free);
                Typed::Number(Measured::new(self.apply(at, Operation::Root, &[sum], mark), x.unit))
            }
            (BuiltinKind::Rotate, [value, angle]) => self.rotated(arguments, [*value, *angle], at),
            (BuiltinKind::Noise, [value]) => self.noise(&arguments[0], *value, at, mark),
            _ => Typed::Unknown,
        }
    }

    /// (c x − s y, s x + c y).
    fn rotated(&mut self, arguments: &[Expression<'a>], values: [Typed; 2], at: Stretch) -> Typed {
        let vector = self.uniform("rotate", &arguments[0], values[0]);
        let angle = self.number(&arguments[1], values[1]);
        let (Some([x, y]), Some(angle)) = (vector, angle) else { return Typed::Unknown };
        if angle.unit != Unit::NUMBER {
            let quoted = self.quote(&arguments[1]);
            return self.mistake(
                arguments[1].at,
                format!("`rotate` takes an angle, {quoted} {}", described(angle.unit)),
            );
        }
        let mut next = |operation, sources: &[Operand]| {
            let free = self.assembler.mark();
            self.apply(at, operation, sources, free)
        };
        let sine = next(Operation::Sine, &[angle.operand]);
        let cosine = next(Operation::Cosine, &[angle.operand]);
        let [x_cosine, y_cosine] = [x, y].map(|number| next(Operation::Multiply, &[cosine, number.operand]));
        let y_sine = next(Operation::Multiply, &[sine, y.operand]);
        let first = next(Operation::Subtract, &[x_cosine, y_sine]);
        let x_sine = next(Operation::Multiply, &[sine, x.operand]);
        let second = next(Operation::Add, &[x_sine, y_cosine]);
        Typed::Vector([(first, x.unit), (second, x.unit)].map(|(operand, unit)| Measured::new(operand, unit)))
    }

    fn vector(&mut self, name: &str, expression: &Expression<'_>, value: Typed) -> Option<[Measured; 2]> {
        match value {
            Typed::Vector(both) => Some(both),
            Typed::Unknown => None,
            _ => {
                let quoted = self.quote(expression);
                self.mistake(
                    expression.at,
                    format!("`{name}` takes a vector, {quoted} {}", value.described()),
                );
                None
            }
        }
    }

    /// A vector whose components have one unit.
    fn uniform(&mut self, name: &str, expression: &Expression<'_>, value: Typed) -> Option<[Measured; 2]> {
        let [x, y] = self.vector(name, expression, value)?;
        let Some(unit) = x.common(y) else {
            let quoted = self.quote(expression);
            let message = format!("`{name}` takes a vector in one unit, {quoted} {}", value.described());
            self.mistake(expression.at, message);
            return None;
        };
        Some([x, y].map(|number| Measured { unit, ..number }))
    }

    fn noise(&mut self, expression: &Expression<'_>, value: Typed, at: Stretch, mark: u16) -> Typed {
        let Some(index) = self.number(expression, value) else { return Typed::Unknown };
        let is_counted = match index.operand {
            Operand::Constant(index) => index.fract() == 0.0 && (0.0..=1e9).contains(&index),
            Operand::Named(register) | Operand::Temporary(register) => self.counters.contains(&register),
        };
        if !is_counted || index.unit != Unit::NUMBER {
            let quoted = self.quote(expression);
            let message =
                format!("`noise` takes a whole number or the counter of a loop, `noise(1)`, not {quoted}");
            return self.mistake(expression.at, message);
        }
        self.is_noisy = true;
        Typed::Number(Measured::new(self.apply(at, Operation::Noise, &[index.operand], mark), Unit::NUMBER))
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
