//! Tokens to a syntax tree. A line with a mistake is passed over, and the next one is read.

use super::law_text::{LawText, Stretch};
use super::mistake::MistakeList;
use super::names;
use super::syntax::{
    Arithmetic, Block, Choice, Expression, ExpressionKind, FunctionSyntax, Junction, LawSyntax, Named,
    ParameterSyntax, Statement,
};
use super::token::{Token, TokenKind, tokens};
use crate::declaration::{Knowledge, Scale};
use crate::input::LEADERS_MAX;
use crate::unit::Unit;
use std::collections::HashSet;

/// How deep brackets and braces may be nested.
const DEPTH_MAX: usize = 64;
/// The most rounds of one loop.
const ROUNDS_MAX: u32 = 10_000;

/// A mistake was noted, and the rest of the statement has no meaning.
struct Lost;

type Parsed<T> = Result<T, Lost>;

/// Reads a file; what cannot be read is noted in `mistakes`. Nothing where it was not read to its end.
pub(super) fn parse<'a>(text: LawText<'a>, mistakes: &mut MistakeList) -> Option<LawSyntax<'a>> {
    let tokens = tokens(text, mistakes);
    let mut parser =
        Parser { text, tokens: &tokens, at: 0, depth: 0, mistakes, set: HashSet::new(), is_abandoned: false };
    let mut law = LawSyntax::default();
    let mut ended = false;
    while parser.kind() != TokenKind::End && !parser.mistakes.is_full() {
        if parser.kind() == TokenKind::Stop {
            parser.at += 1;
            continue;
        }
        if law.command.is_some() && !ended {
            ended = true;
            parser.note("nothing comes behind `command`, which is the last line");
        }
        let from = parser.at;
        if parser.item(&mut law).is_err() {
            parser.recover();
        }
        if parser.at == from {
            // A brace that closes nothing.
            parser.note("this closes nothing");
            parser.at += 1;
        }
    }
    if law.command.is_none() && !parser.mistakes.is_full() {
        parser.note("a law ends with what it asks for: `command = acceleration, turn_rate`");
    }
    law.set = parser.set;
    let is_whole = !parser.is_abandoned && !parser.mistakes.is_full();
    is_whole.then_some(law)
}

struct Parser<'a, 't> {
    text: LawText<'a>,
    tokens: &'t [Token<'a>],
    at: usize,
    depth: usize,
    mistakes: &'t mut MistakeList,
    set: HashSet<&'a str>,
    /// Whether the rest of the text is not read, and nothing is said of it.
    is_abandoned: bool,
}

impl<'a> Parser<'a, '_> {
    fn token(&self, ahead: usize) -> Token<'a> {
        let last = self.tokens.len() - 1;
        self.tokens[(self.at + ahead).min(last)]
    }

    fn kind(&self) -> TokenKind<'a> {
        self.token(0).kind
    }

    fn here(&self) -> Stretch {
        self.token(0).at
    }

    /// The stretch from `from` to the token before this one.
    fn since(&self, from: Stretch) -> Stretch {
        let before = self.tokens[..self.at].last().map_or(from, |token| token.at);
        from.through(before)
    }

    fn mistake(&mut self, at: Stretch, message: impl Into<String>) {
        if !self.is_abandoned {
            self.mistakes.add(at, message);
        }
    }

    fn note(&mut self, message: impl Into<String>) {
        self.mistake(self.here(), message);
    }

    fn lost<T>(&mut self, message: impl Into<String>) -> Parsed<T> {
        self.note(message);
        Err(Lost)
    }

    fn is(&mut self, sign: &str) -> bool {
        let found = self.kind() == TokenKind::Sign(self.known(sign));
        self.at += usize::from(found);
        found
    }

    /// The sign, if it is the one that stands here.
    fn known(&self, sign: &str) -> &'static str {
        match self.kind() {
            TokenKind::Sign(here) if here == sign => here,
            _ => "",
        }
    }

    fn is_word(&mut self, word: &str) -> bool {
        let found = self.kind() == TokenKind::Name(word);
        self.at += usize::from(found);
        found
    }

    /// What stands here, for "found …".
    fn found(&self) -> String {
        match self.kind() {
            TokenKind::End => "the end of the file".to_owned(),
            TokenKind::Stop => "the end of the line".to_owned(),
            _ => self.text.quote(self.here()),
        }
    }

    fn expect(&mut self, sign: &str) -> Parsed<()> {
        if self.is(sign) {
            Ok(())
        } else {
            self.lost(format!("here should stand `{sign}`, not {}", self.found()))
        }
    }

    /// A name that is being defined.
    fn new_name(&mut self) -> Parsed<Named<'a, ()>> {
        let TokenKind::Name(name) = self.kind() else {
            return self.lost(format!("here should stand a name, not {}", self.found()));
        };
        let at = self.here();
        if let Some(message) = names::reserved(name) {
            return self.lost(message);
        }
        self.at += 1;
        Ok(Named { name, at, value: () })
    }

    /// The end of a statement; a brace that closes is left where it is.
    fn end_of_statement(&mut self) -> Parsed<()> {
        match self.kind() {
            TokenKind::Stop => {
                self.at += 1;
                Ok(())
            }
            TokenKind::End | TokenKind::Sign("}") => Ok(()),
            TokenKind::Quoted(_) | TokenKind::Unit(_) => {
                self.lost(format!("{} does not belong here: a unit stands behind a number", self.found()))
            }
            _ => self.lost(format!(
                "the statement should end here, with the line or `;`, not go on with {}",
                self.found()
            )),
        }
    }

    /// Passes over the rest of a statement, with the blocks in it.
    fn recover(&mut self) {
        let mut open = 0_usize;
        loop {
            match self.kind() {
                TokenKind::End => return,
                TokenKind::Sign("}") if open == 0 => return,
                TokenKind::Sign("{") => open += 1,
                TokenKind::Sign("}") => open -= 1,
                TokenKind::Stop if open == 0 => {
                    self.at += 1;
                    return;
                }
                _ => {}
            }
            self.at += 1;
        }
    }

    /// One level deeper.
    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth >= DEPTH_MAX {
            self.note(format!("this is nested too deeply: there may be {DEPTH_MAX} levels"));
            self.is_abandoned = true;
            self.at = self.tokens.len() - 1;
            return Err(Lost);
        }
        self.depth += 1;
        let read = read(self);
        self.depth -= 1;
        read
    }

    /// A line of the file.
    fn item(&mut self, law: &mut LawSyntax<'a>) -> Parsed<()> {
        let TokenKind::Name(word) = self.kind() else {
            return self.unused_value();
        };
        let at = self.here();
        match word {
            "leaders" => {
                self.at += 1;
                let known = law.leaders.is_some();
                let leaders = self.leaders()?;
                if known {
                    self.mistake(at, "the number of leaders is said twice");
                }
                law.leaders = Some(leaders);
            }
            "knows" => {
                self.at += 1;
                if law.knows != Knowledge::Output {
                    self.mistake(at, "what the law knows is said twice");
                }
                law.knows = match self.kind() {
                    TokenKind::Name("motion") => Knowledge::Motion,
                    TokenKind::Name("rates") => Knowledge::Rates,
                    _ => {
                        return self
                            .lost(format!("here should stand `rates` or `motion`, not {}", self.found()));
                    }
                };
                self.at += 1;
            }
            "parameter" => {
                self.at += 1;
                let parameter = self.parameter()?;
                law.parameters.push(parameter);
            }
            "memory" => {
                self.at += 1;
                let name = self.new_name()?;
                let value = self.definition(&name);
                law.memory.push(Named { name: name.name, at: name.at, value });
                return Ok(());
            }
            "function" => {
                self.at += 1;
                let function = self.function()?;
                law.functions.push(function);
            }
            "command" => {
                self.at += 1;
                let mut parts = vec![];
                let read = self.command(&mut parts);
                if read.is_err() {
                    parts = vec![Expression { kind: ExpressionKind::Broken, at }];
                    self.recover();
                }
                law.command.get_or_insert(parts);
                return Ok(());
            }
            _ => {
                let mut block = Block::default();
                self.statement(&mut block)?;
                law.statements.append(&mut block.statements);
                if let Some(value) = block.value {
                    self.mistake(value.at, "this value is not used: name it, `let x = …`");
                }
                return Ok(());
            }
        }
        self.end_of_statement()
    }

    fn unused_value(&mut self) -> Parsed<()> {
        if self.kind() == TokenKind::Sign("}") {
            return Ok(());
        }
        let value = self.expression()?;
        self.mistake(value.at, "this value is not used: name it, `let x = …`");
        self.end_of_statement()
    }

    fn leaders(&mut self) -> Parsed<usize> {
        let number = match self.kind() {
            TokenKind::Number(number) => (1..=LEADERS_MAX).find(|count| *count as f64 == number),
            _ => None,
        };
        let Some(number) = number else {
            return self.lost(format!(
                "here should stand how many leaders there are, 1 to {LEADERS_MAX}, not {}",
                self.found()
            ));
        };
        self.at += 1;
        Ok(number)
    }

    fn command(&mut self, parts: &mut Vec<Expression<'a>>) -> Parsed<()> {
        self.expect("=")?;
        parts.push(self.expression()?);
        if self.is(",") {
            parts.push(self.expression()?);
        }
        self.end_of_statement()
    }

    /// A number with its sign.
    fn signed(&mut self) -> Parsed<f64> {
        let negative = self.is("-");
        match self.kind() {
            TokenKind::Number(number) => {
                self.at += 1;
                Ok(if negative { -number } else { number })
            }
            _ => self.lost(format!("here should stand a number, not {}", self.found())),
        }
    }

    /// A unit in brackets, where one stands here, with what one of it is in SI.
    fn unit(&mut self) -> Option<(Unit, f64)> {
        let TokenKind::Unit(text) = self.kind() else { return None };
        let read = Unit::parse(text);
        let unit = read.unwrap_or_else(|message| {
            self.note(message);
            (Unit::NUMBER, 1.0)
        });
        self.at += 1;
        Some(unit)
    }

    fn parameter(&mut self) -> Parsed<ParameterSyntax<'a>> {
        let Named { name, at, .. } = self.new_name()?;
        self.expect("=")?;
        let default_at = self.here();
        let default = self.signed()?;
        let (unit, scale) = self.unit().unwrap_or((Unit::NUMBER, 1.0));
        let default_at = self.since(default_at);
        let mut parameter = ParameterSyntax {
            name,
            at,
            unit,
            default: default * scale,
            range: [0.0; 2],
            scale: Scale::Linear,
            help: "",
            symbol: None,
        };
        let mut range = None;
        loop {
            if self.is_word("in") {
                let from = self.here();
                if let TokenKind::Unit(_) = self.kind() {
                    return self.lost("a range is written `0.1 .. 20`");
                }
                let low = self.signed()?;
                self.expect("..")?;
                let high = self.signed()?;
                if let Some(other) = self.unit()
                    && other != (unit, scale)
                {
                    self.mistake(
                        self.since(from),
                        "the range is in the unit of the parameter: leave its unit out",
                    );
                }
                let at = self.since(from);
                if low >= high {
                    self.mistake(at, "the range should go from the smaller to the larger value");
                } else if !(low..=high).contains(&default) {
                    self.mistake(default_at, format!("{default} is not in the range {low} .. {high}"));
                }
                range = Some((low, at));
                parameter.range = [low * scale, high * scale];
            } else if self.is_word("log") {
                parameter.scale = Scale::Logarithmic;
            } else if self.is_word("symbol") {
                let TokenKind::Quoted(symbol) = self.kind() else {
                    return self
                        .lost(format!("here should stand the symbol in quotes, not {}", self.found()));
                };
                parameter.symbol = Some(symbol);
                self.at += 1;
            } else if let TokenKind::Quoted(help) = self.kind() {
                parameter.help = help;
                self.at += 1;
            } else {
                break;
            }
        }
        match range {
            None => self.mistake(at, "a parameter has a range for its slider: `in 0.1 .. 20`"),
            Some((low, at)) if parameter.scale == Scale::Logarithmic && low <= 0.0 => {
                self.mistake(at, "a range with `log` begins above 0");
            }
            Some(_) => {}
        }
        Ok(parameter)
    }

    fn function(&mut self) -> Parsed<FunctionSyntax<'a>> {
        let Named { name, at, .. } = self.new_name()?;
        self.expect("(")?;
        let mut arguments: Vec<&str> = vec![];
        while !self.is(")") {
            let argument = self.new_name()?;
            if arguments.contains(&argument.name) {
                self.mistake(argument.at, format!("`{}` is there twice", argument.name));
            }
            arguments.push(argument.name);
            if !self.is(",") {
                self.expect(")")?;
                break;
            }
        }
        let body = if self.is("=") {
            let value = self.expression()?;
            Block { at: value.at, value: Some(value), statements: vec![] }
        } else if self.known("{") == "{" {
            self.block()?
        } else {
            return self.lost(format!("here should stand `=` or `{{`, not {}", self.found()));
        };
        Ok(FunctionSyntax { name, at, arguments, body })
    }

    /// `= value` and the end of the statement. What cannot be read is broken, so that its name is known all the same.
    fn definition(&mut self, name: &Named<'a, ()>) -> Expression<'a> {
        let read = self.expect("=").and_then(|()| self.expression());
        let ended = read.and_then(|value| self.end_of_statement().map(|()| value));
        ended.unwrap_or_else(|Lost| {
            self.recover();
            Expression { kind: ExpressionKind::Broken, at: name.at }
        })
    }

    /// `{ … }`.
    fn block(&mut self) -> Parsed<Block<'a>> {
        let from = self.here();
        self.expect("{")?;
        self.deeper(|parser| {
            let mut block = Block::default();
            loop {
                match parser.kind() {
                    TokenKind::Stop => parser.at += 1,
                    TokenKind::Sign("}") => break,
                    TokenKind::End => {
                        parser.mistake(from, "the `}` for this is missing");
                        return Err(Lost);
                    }
                    _ => {
                        if let Some(value) = block.value.take() {
                            parser.unused(value, &mut block);
                        }
                        if parser.statement(&mut block).is_err() {
                            parser.recover();
                        }
                    }
                }
                if parser.mistakes.is_full() {
                    return Err(Lost);
                }
            }
            parser.at += 1;
            block.at = parser.since(from);
            Ok(block)
        })
    }

    /// A value that turned out not to be the last line of its block.
    fn unused(&mut self, value: Expression<'a>, block: &mut Block<'a>) {
        match value.kind {
            ExpressionKind::If(choice) => block.statements.push(Statement::If(choice)),
            _ => self
                .mistakes
                .add(value.at, "this value is not used: only the last line of a block is its value"),
        }
    }

    /// A statement inside or outside a block; what may be the value of the block becomes it.
    fn statement(&mut self, block: &mut Block<'a>) -> Parsed<()> {
        let from = self.here();
        let next = self.token(1).kind;
        match self.kind() {
            TokenKind::Name("let") => {
                self.at += 1;
                let name = self.new_name()?;
                let value = self.definition(&name);
                block.statements.push(Statement::Let(Named { name: name.name, at: name.at, value }));
                return Ok(());
            }
            TokenKind::Name("repeat") => {
                self.at += 1;
                let repeat = self.repeat(from)?;
                block.statements.push(repeat);
            }
            TokenKind::Name(
                word @ ("leaders" | "knows" | "parameter" | "memory" | "function" | "command"),
            ) => {
                return self.lost(format!("`{word}` stands outside of all braces"));
            }
            TokenKind::Name(name) if next == TokenKind::Sign("=") => {
                let name = if name == "command" { return Err(Lost) } else { self.new_name()? };
                self.set.insert(name.name);
                let value = self.definition(&name);
                block.statements.push(Statement::Set(Named { name: name.name, at: name.at, value }));
                return Ok(());
            }
            TokenKind::Name(_) if next == TokenKind::Sign("'") => {
                let name = self.new_name()?;
                self.at += 1;
                let value = self.definition(&name);
                block.statements.push(Statement::Rate(Named { name: name.name, at: name.at, value }));
                return Ok(());
            }
            TokenKind::Name(name)
                if matches!(next, TokenKind::Sign("+" | "-" | "*" | "/"))
                    && self.token(2).kind == TokenKind::Sign("=") =>
            {
                let sign = self.text.quote(self.token(1).at).replace('`', "");
                return self.lost(format!("write `{name} = {name} {sign} …`"));
            }
            TokenKind::Name(name)
                if next == TokenKind::Sign(".")
                    && matches!(self.token(3).kind, TokenKind::Sign("=" | "'")) =>
            {
                let part = self.text.quote(self.token(2).at);
                return self
                    .lost(format!("{part} of `{name}` cannot be set alone: set both, `{name} = (…, …)`"));
            }
            TokenKind::Name(word)
                if matches!(next, TokenKind::Name(_) | TokenKind::Number(_) | TokenKind::Sign("{"))
                    && names::said_here(word).is_some() =>
            {
                return self.lost(names::said_here(word).unwrap_or_default());
            }
            _ => {
                let value = self.expression()?;
                block.value = Some(value);
                self.end_of_statement()?;
                if let Some(Expression { kind: ExpressionKind::If(_), .. }) = &block.value
                    && self.depth == 0
                    && let Some(value) = block.value.take()
                {
                    self.unused(value, block);
                }
                return Ok(());
            }
        }
        self.end_of_statement()
    }

    fn repeat(&mut self, from: Stretch) -> Parsed<Statement<'a>> {
        let number = match self.kind() {
            TokenKind::Number(number)
                if number.fract() == 0.0 && (1.0..=f64::from(ROUNDS_MAX)).contains(&number) =>
            {
                number
            }
            _ => {
                return self.lost(format!(
                    "here should stand how often to repeat, a number from 1 to {ROUNDS_MAX} that is written out, not {}",
                    self.found()
                ));
            }
        };
        self.at += 1;
        let counter = if self.is_word("as") { Some(self.new_name()?) } else { None };
        let head = self.since(from);
        let body = self.block()?;
        Ok(Statement::Repeat { count: number as u32, counter, body, at: head })
    }

    fn expression(&mut self) -> Parsed<Expression<'a>> {
        self.deeper(Self::disjunction)
    }

    fn disjunction(&mut self) -> Parsed<Expression<'a>> {
        self.joined(Junction::Or, "or", "||", Self::conjunction)
    }

    fn conjunction(&mut self) -> Parsed<Expression<'a>> {
        self.joined(Junction::And, "and", "&&", Self::negation)
    }

    fn joined(
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

    fn negation(&mut self) -> Parsed<Expression<'a>> {
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

    fn comparison(&mut self) -> Parsed<Expression<'a>> {
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

    fn sum(&mut self) -> Parsed<Expression<'a>> {
        self.chain(
            |sign| match sign {
                "+" => Some(Arithmetic::Plus),
                "-" => Some(Arithmetic::Minus),
                _ => None,
            },
            Self::product,
        )
    }

    fn product(&mut self) -> Parsed<Expression<'a>> {
        self.chain(
            |sign| match sign {
                "*" => Some(Arithmetic::Times),
                "/" => Some(Arithmetic::Over),
                _ => None,
            },
            Self::signed_power,
        )
    }

    fn chain(
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
    fn signed_power(&mut self) -> Parsed<Expression<'a>> {
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

    fn power(&mut self) -> Parsed<Expression<'a>> {
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
    fn primary(&mut self) -> Parsed<Expression<'a>> {
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

    fn atom(&mut self) -> Parsed<Expression<'a>> {
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
    fn choice(&mut self) -> Parsed<Choice<'a>> {
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

/// Whether a word cannot be the name of a value.
fn is_word_of_expressions(name: &str) -> bool {
    matches!(
        name,
        "let"
            | "repeat"
            | "as"
            | "else"
            | "and"
            | "or"
            | "not"
            | "in"
            | "function"
            | "parameter"
            | "memory"
            | "command"
            | "leaders"
            | "knows"
    )
}
