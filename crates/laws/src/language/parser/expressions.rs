//! Expressions, from the signs that bind least to those that bind most.

use super::super::syntax::{Arithmetic, Block, Choice, Expression, ExpressionKind, Junction, Named};
use super::super::token::TokenKind;
use super::{DEPTH_MAX, Parsed, Parser, is_word_of_expressions};

impl<'a> Parser<'a, '_> {
    pub(super) fn expression(&mut self) -> Parsed<Expression<'a>> {
        self.deeper(Self::disjunction)
    }

    pub(super) fn disjunction(&mut self) -> Parsed<Expression<'a>> {
        self.joined(Junction::Or, "or", "||", Self::conjunction)
    }

    pub(super) fn conjunction(&mut self) -> Parsed<Expression<'a>> {
        self.joined(Junction::And, "and", "&&", Self::negation)
    }

    pub(super) fn joined(
        &mut self,
        junction: Junction,
        word: &str,
        foreign: &str,
        read: fn(&mut Self) -> Parsed<Expression<'a>>,
    ) -> Parsed<Expression<'a>> {
        let first = read(self)?;
        let from = first.at;
        let mut all = vec![first];
        loop {
            if self.known(foreign) == foreign {
                self.note(format!("write `{word}`"));
                self.at += 1;
            } else if !self.is_word(word) {
                break;
            }
            all.push(read(self)?);
        }
        Ok(match all.len() {
            1 => all.remove(0),
            _ => Expression { kind: ExpressionKind::Joined(junction, all), at: self.since(from) },
        })
    }

    pub(super) fn negation(&mut self) -> Parsed<Expression<'a>> {
        let from = self.here();
        if self.known("!") == "!" {
            self.note("write `not`");
            self.at += 1;
        } else if !self.is_word("not") {
            return self.comparison();
        }
        let value = self.deeper(Self::negation)?;
        Ok(Expression { kind: ExpressionKind::Not(Box::new(value)), at: self.since(from) })
    }

    pub(super) fn comparison(&mut self) -> Parsed<Expression<'a>> {
        let left = self.sum()?;
        let TokenKind::Sign(sign @ ("<" | "<=" | ">" | ">=" | "==" | "!=")) = self.kind() else {
            if self.known("=") == "=" {
                return self.lost("to compare, write `==`");
            }
            return Ok(left);
        };
        self.at += 1;
        let right = self.sum()?;
        let at = self.since(left.at);
        if matches!(self.kind(), TokenKind::Sign("<" | "<=" | ">" | ">=" | "==" | "!=")) {
            let middle = self.text.quote(right.at);
            return self.lost(format!("join two comparisons by `and`, with {middle} in both"));
        }
        Ok(Expression { kind: ExpressionKind::Comparison(sign, Box::new([left, right])), at })
    }

    pub(super) fn sum(&mut self) -> Parsed<Expression<'a>> {
        self.chain(
            |sign| match sign {
                "+" => Some(Arithmetic::Plus),
                "-" => Some(Arithmetic::Minus),
                _ => None,
            },
            Self::product,
        )
    }

    pub(super) fn product(&mut self) -> Parsed<Expression<'a>> {
        self.chain(
            |sign| match sign {
                "*" => Some(Arithmetic::Times),
                "/" => Some(Arithmetic::Over),
                _ => None,
            },
            Self::signed_power,
        )
    }

    pub(super) fn chain(
        &mut self,
        meaning: fn(&str) -> Option<Arithmetic>,
        read: fn(&mut Self) -> Parsed<Expression<'a>>,
    ) -> Parsed<Expression<'a>> {
        let first = read(self)?;
        let from = first.at;
        let mut rest = vec![];
        while let TokenKind::Sign(sign) = self.kind()
            && let Some(arithmetic) = meaning(sign)
        {
            self.at += 1;
            rest.push((arithmetic, read(self)?));
        }
        if rest.is_empty() {
            return Ok(first);
        }
        Ok(Expression { kind: ExpressionKind::Chain(Box::new(first), rest), at: self.since(from) })
    }

    /// A sign binds less than a power: −x² is −(x²).
    pub(super) fn signed_power(&mut self) -> Parsed<Expression<'a>> {
        let from = self.here();
        if self.is("+") {
            return self.deeper(Self::signed_power);
        }
        if !self.is("-") {
            return self.power();
        }
        let value = self.deeper(Self::signed_power)?;
        Ok(Expression { kind: ExpressionKind::Negative(Box::new(value)), at: self.since(from) })
    }

    pub(super) fn power(&mut self) -> Parsed<Expression<'a>> {
        let base = self.primary()?;
        let from = base.at;
        let exponent = match self.kind() {
            TokenKind::Sign("^") => {
                self.at += 1;
                self.deeper(Self::signed_power)?
            }
            TokenKind::Sign("**") => {
                self.note("write `^`");
                self.at += 1;
                self.deeper(Self::signed_power)?
            }
            TokenKind::Sign(raised @ ("²" | "³")) => {
                let at = self.here();
                self.at += 1;
                Expression { kind: ExpressionKind::Number(if raised == "²" { 2.0 } else { 3.0 }, None), at }
            }
            _ => return Ok(base),
        };
        Ok(Expression { kind: ExpressionKind::Power(Box::new([base, exponent])), at: self.since(from) })
    }

    /// A value with its members.
    pub(super) fn primary(&mut self) -> Parsed<Expression<'a>> {
        let mut value = self.atom()?;
        let from = value.at;
        let mut members = 0;
        while self.is(".") {
            let TokenKind::Name(member) = self.kind() else {
                return self.lost(format!("here should stand `x`, `y` or a quantity, not {}", self.found()));
            };
            members += 1;
            if members > DEPTH_MAX {
                return self.lost("there is nothing so deep inside");
            }
            self.at += 1;
            value =
                Expression { kind: ExpressionKind::Member(Box::new(value), member), at: self.since(from) };
        }
        if self.known("'") == "'" {
            return self
                .lost("a derivative stands on the left of `=`; name its value by `let` to use it twice");
        }
        Ok(value)
    }

    pub(super) fn atom(&mut self) -> Parsed<Expression<'a>> {
        let from = self.here();
        let kind = match self.kind() {
            TokenKind::Number(number) => {
                self.at += 1;
                match self.unit() {
                    Some((unit, scale)) => ExpressionKind::Number(number * scale, Some(unit)),
                    None => ExpressionKind::Number(number, None),
                }
            }
            TokenKind::Sign("(") => {
                self.at += 1;
                let first = self.expression()?;
                if self.is(",") {
                    let second = self.expression()?;
                    if self.known(",") == "," {
                        return self.lost("a vector has two components");
                    }
                    self.expect(")")?;
                    ExpressionKind::Vector(Box::new([first, second]))
                } else {
                    self.expect(")")?;
                    return Ok(Expression { at: self.since(from), ..first });
                }
            }
            TokenKind::Name("if") => {
                self.at += 1;
                ExpressionKind::If(Box::new(self.choice()?))
            }
            TokenKind::Name(truth @ ("true" | "false")) => {
                self.at += 1;
                ExpressionKind::Truth(truth == "true")
            }
            TokenKind::Name(name)
                if self.token(1).kind == TokenKind::Sign("(") && !is_word_of_expressions(name) =>
            {
                self.at += 2;
                let mut arguments = vec![];
                while !self.is(")") {
                    arguments.push(self.expression()?);
                    if !self.is(",") {
                        self.expect(")")?;
                        break;
                    }
                }
                ExpressionKind::Call(Named { name, at: from, value: arguments })
            }
            TokenKind::Name(name) if !is_word_of_expressions(name) => {
                self.at += 1;
                ExpressionKind::Name(name)
            }
            TokenKind::Sign("{") => {
                return self.lost("braces stand behind `if`, `else`, `repeat` and `function f(x)`");
            }
            TokenKind::Unit(_) => return self.lost("a unit stands behind a number: `1 [m]`"),
            TokenKind::Sign("/") => {
                return self.lost("here should stand a value, not `/`; comments begin with `#`");
            }
            _ => return self.lost(format!("here should stand a value, not {}", self.found())),
        };
        Ok(Expression { kind, at: self.since(from) })
    }

    /// Behind `if`.
    pub(super) fn choice(&mut self) -> Parsed<Choice<'a>> {
        let condition = self.expression()?;
        let then = self.block()?;
        let mut otherwise = None;
        if self.is_word("else") {
            let from = self.here();
            otherwise = Some(if self.is_word("if") {
                let choice = self.deeper(Self::choice)?;
                let at = self.since(from);
                let value = Expression { kind: ExpressionKind::If(Box::new(choice)), at };
                Block { statements: vec![], value: Some(value), at }
            } else {
                self.block()?
            });
        }
        Ok(Choice { condition, then, otherwise })
    }
}
