//! Statements: what they name, set, choose and repeat.

use super::super::assembler::Operand;
use super::super::assembler::REGISTERS_MAX;
use super::super::law_text::Stretch;
use super::super::names;
use super::super::syntax::{Block, Choice, Expression, ExpressionKind, Named, Statement};
use super::super::typed::{Measured, Typed};
use super::{Checker, LOOPS, VISITS_MAX, Variable, VariableKind, register_of, with_bare_zero_as_number};
use crate::unit::Unit;

impl<'a> Checker<'a, '_> {
    pub(super) fn statements(&mut self, statements: &[Statement<'a>]) {
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
                    self.repeat(*count, counter.as_ref(), body, *at);
                }
            }
            self.assembler.origin.owner = owner;
        }
    }

    /// Whether so much was visited, or so many mistakes were found, that there is no use in going on.
    pub(super) fn is_exhausted(&self) -> bool {
        self.visits >= VISITS_MAX || self.mistakes.is_full() || self.assembler.excess().is_some()
    }

    pub(super) fn define(&mut self, named: &Named<'a, Expression<'a>>) {
        let Named { name, at, value: expression } = named;
        self.assembler.begin(format!("`{name}`"));
        let mark = self.assembler.mark();
        let value = self.expression(expression);
        let value = with_bare_zero_as_number(self.keep(value, mark, self.syntax.set.contains(name)));
        self.check_new(name, *at);
        self.scope.push(Variable { name, at: *at, value, kind: VariableKind::Let });
    }

    /// A name that is defined here must not be seen already.
    pub(super) fn check_new(&mut self, name: &str, at: Stretch) {
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
    pub(super) fn keep(&mut self, value: Typed, mark: u16, is_own: bool) -> Typed {
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
    pub(super) fn settle(&mut self, mark: u16, value: &Typed) {
        let used = value.operands().filter_map(register_of).filter(|register| *register >= mark);
        let above = used.filter(|register| usize::from(*register) < REGISTERS_MAX).max();
        self.assembler.release(above.map_or(mark, |register| register + 1));
    }

    pub(super) fn set(&mut self, named: &Named<'a, Expression<'a>>) {
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
    pub(super) fn target(&mut self, name: &str, at: Stretch) -> Option<Typed> {
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

    pub(super) fn both_ways(&mut self, name: &str, at: Stretch) {
        self.mistake(at, format!("`{name}` is set and has a derivative: it can only have one of the two"));
    }

    /// Whether a value may be put where there is one like `target`.
    pub(super) fn matches(
        &mut self,
        name: &str,
        target: Typed,
        value: Typed,
        expression: &Expression<'_>,
    ) -> bool {
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

    pub(super) fn assign(&mut self, target: Typed, value: Typed) {
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

    pub(super) fn rate(&mut self, named: &Named<'a, Expression<'a>>) {
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

    pub(super) fn repeat(
        &mut self,
        count: u32,
        counter: Option<&Named<'a, ()>>,
        body: &Block<'a>,
        at: Stretch,
    ) {
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
        let rounds = round.saturating_mul(u64::from(count));
        self.assembler.cost = before.saturating_add(rounds);
        self.measure(LOOPS, rounds, at, || "the loop".to_owned());
        self.assembler.release(mark);
    }

    /// A block whose value, if it has one, is not used.
    pub(super) fn block_of_statements(&mut self, block: &Block<'a>) {
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
    pub(super) fn branch(&mut self, choice: &Choice<'a>) {
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
    pub(super) fn other_branch<T>(&mut self, before: u64, check: impl FnOnce(&mut Self) -> T) -> T {
        let first = std::mem::replace(&mut self.assembler.cost, before);
        let checked = check(self);
        self.assembler.cost = self.assembler.cost.max(first);
        checked
    }
}
