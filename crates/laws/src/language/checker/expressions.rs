//! Expressions without calls: names, arithmetic, comparisons and choices, with their units.

use super::super::assembler::Operand;
use super::super::builtin::BUILTINS;
use super::super::code::Operation;
use super::super::law_text::Stretch;
use super::super::names;
use super::super::syntax::{Arithmetic, Block, Choice, Expression, ExpressionKind, Junction, Statement};
use super::super::typed::{Measured, Typed, described};
use super::{Checker, DEPTH_MAX, POWERS, base_kept};
use crate::declaration::Knowledge;
use crate::input::{INPUTS, InputKind};
use crate::unit::Unit;

/// The largest power that is multiplied out.
const POWER_MAX: f64 = 16.0;

impl<'a> Checker<'a, '_> {
    /// Goes one level deeper, if that is still possible.
    pub(super) fn visit(&mut self, at: Stretch) -> bool {
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

    pub(super) fn expression(&mut self, expression: &Expression<'a>) -> Typed {
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

    pub(super) fn apply(
        &mut self,
        at: Stretch,
        operation: Operation,
        sources: &[Operand],
        mark: u16,
    ) -> Operand {
        self.assembler.origin.at = at;
        self.assembler.apply(operation, sources, mark)
    }

    /// The number that a value is.
    pub(super) fn number(&mut self, expression: &Expression<'_>, value: Typed) -> Option<Measured> {
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

    pub(super) fn condition(&mut self, expression: &Expression<'a>) -> Operand {
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
    pub(super) fn each(
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
    pub(super) fn named(&mut self, name: &str, at: Stretch) -> Typed {
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

    pub(super) fn unknown_name(&self, name: &str) -> String {
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

    pub(super) fn input(&mut self, leader: usize, kind: InputKind, unit: Unit, at: Stretch) -> Measured {
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

    pub(super) fn member(&mut self, base: &Expression<'a>, member: &str, at: Stretch) -> Typed {
        if let ExpressionKind::Name(group) = base.kind {
            let stem = group.trim_end_matches(|c: char| c.is_ascii_digit());
            if matches!(stem, "leader" | "wanted" | "frame") || group == "own" {
                return self.input_of(group, member, at);
            }
            if stem != "own"
                && let Some(input) = self.input_meant(group, member)
            {
                return self.mistake(at, format!("nothing is called `{group}`; did you mean `{input}`?"));
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

    /// The input that `group.member` resembles where nothing is called `group`.
    fn input_meant(&self, group: &str, member: &str) -> Option<String> {
        if matches!(member, "x" | "y") || self.is_named(group) {
            return None;
        }
        let inputs = names::input_names(self.leaders);
        let own = |input: &&String| input.split_once('.').is_some_and(|(_, of)| of == member);
        // A right member tells more than its group.
        let exact = inputs.iter().filter(own).map(String::as_str);
        let nearest = |names: &mut dyn Iterator<Item = &str>| {
            names::nearest(&format!("{group}.{member}"), names).map(str::to_owned)
        };
        nearest(&mut exact.into_iter()).or_else(|| nearest(&mut inputs.iter().map(String::as_str)))
    }

    /// Whether something of this name is seen here.
    fn is_named(&self, name: &str) -> bool {
        self.scope[self.floor..].iter().any(|variable| variable.name == name)
            || self.memory.iter().any(|memory| memory.name == name)
            || self.syntax.parameters.iter().any(|parameter| parameter.name == name)
    }

    /// `leader.distance` and the like.
    pub(super) fn input_of(&mut self, group: &str, member: &str, at: Stretch) -> Typed {
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

    pub(super) fn chain(&mut self, first: &Expression<'a>, rest: &[(Arithmetic, Expression<'a>)]) -> Typed {
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

    pub(super) fn sum(
        &mut self,
        arithmetic: Arithmetic,
        sides: [(&Expression<'_>, Typed); 2],
        mark: u16,
    ) -> Typed {
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
    pub(super) fn common(
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

    pub(super) fn differ(&mut self, sides: [(&Expression<'_>, Typed); 2], done: &str) -> Typed {
        let [left, right] =
            sides.map(|(expression, value)| format!("{} {}", self.quote(expression), value.described()));
        let at = sides[0].0.at.through(sides[1].0.at);
        let mut message = format!("{left}, {right}: they cannot be {done}");
        for (this, other) in [(sides[0], sides[1]), (sides[1], sides[0])] {
            if let (ExpressionKind::Number(value, None), Typed::Number(other)) = (&this.0.kind, other.1) {
                message = format!("{message}; with a unit it is `{value} [{}]`", other.unit);
            }
            if let (Typed::Number(_), Typed::Vector(_)) = (this.1, other.1) {
                let quoted = self.quote(this.0);
                let quoted = quoted.trim_matches('`');
                message = format!("{message}; for both components write `({quoted}, {quoted})`");
            }
        }
        self.mistake(at, message)
    }

    pub(super) fn product(
        &mut self,
        arithmetic: Arithmetic,
        sides: [(&Expression<'_>, Typed); 2],
        mark: u16,
    ) -> Typed {
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

    pub(super) fn power(&mut self, base: &Expression<'a>, exponent: &Expression<'a>, at: Stretch) -> Typed {
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
    pub(super) fn raised(&mut self, base: Operand, power: f64, at: Stretch, mark: u16) -> Operand {
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

    pub(super) fn comparison(&mut self, sign: &str, both: &[Expression<'a>; 2], at: Stretch) -> Typed {
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
    pub(super) fn choice(&mut self, choice: &Choice<'a>, at: Stretch) -> Typed {
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

    pub(super) fn value_of_branch(&mut self, block: &Block<'a>, to: [u16; 2]) -> Typed {
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
    pub(super) fn value_block(&mut self, block: &Block<'a>) -> Typed {
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
}
