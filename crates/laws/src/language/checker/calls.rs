//! Calls: of functions of the law, which are written out, and of those of the language.

use super::super::assembler::Operand;
use super::super::builtin::{BUILTINS, Builtin, BuiltinKind};
use super::super::code::Operation;
use super::super::law_text::Stretch;
use super::super::names;
use super::super::syntax::{Expression, FunctionSyntax, Named};
use super::super::typed::{Measured, Typed, described};
use super::{CALLS, Checker, POWERS, Variable, VariableKind, base_kept};
use crate::unit::Unit;

impl<'a> Checker<'a, '_> {
    pub(super) fn call(&mut self, call: &Named<'a, Vec<Expression<'a>>>, at: Stretch) -> Typed {
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

    pub(super) fn takes(
        &mut self,
        name: &str,
        wanted: usize,
        arguments: &[Expression<'_>],
        at: Stretch,
    ) -> bool {
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
    pub(super) fn written_out(
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
        let visits = self.visits;
        self.calls.push((function.name, at));
        let value = self.value_block(&function.body);
        self.calls.pop();
        if self.calls.is_empty() {
            let size = (self.visits - visits) as u64;
            self.measure(CALLS, size, at, || format!("the call of `{}`", function.name));
        }
        self.floor = floor;
        self.scope.truncate(scope);
        self.settle(mark, &value);
        value
    }

    pub(super) fn builtin(&mut self, builtin: &Builtin, arguments: &[Expression<'a>], at: Stretch) -> Typed {
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
    pub(super) fn rotated(&mut self, arguments: &[Expression<'a>], values: [Typed; 2], at: Stretch) -> Typed {
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

    pub(super) fn vector(
        &mut self,
        name: &str,
        expression: &Expression<'_>,
        value: Typed,
    ) -> Option<[Measured; 2]> {
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
    pub(super) fn uniform(
        &mut self,
        name: &str,
        expression: &Expression<'_>,
        value: Typed,
    ) -> Option<[Measured; 2]> {
        let [x, y] = self.vector(name, expression, value)?;
        let Some(unit) = x.common(y) else {
            let quoted = self.quote(expression);
            let message = format!("`{name}` takes a vector in one unit, {quoted} {}", value.described());
            self.mistake(expression.at, message);
            return None;
        };
        Some([x, y].map(|number| Measured { unit, ..number }))
    }

    pub(super) fn noise(
        &mut self,
        expression: &Expression<'_>,
        value: Typed,
        at: Stretch,
        mark: u16,
    ) -> Typed {
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
