//! Tokens to a syntax tree. A line with a mistake is passed over, and the next one is read.

mod expressions;
mod statements;

use super::law_text::{LawText, Stretch};
use super::mistake::MistakeList;
use super::names;
use super::syntax::{Block, Expression, ExpressionKind, FunctionSyntax, LawSyntax, Named, ParameterSyntax};
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
        let written = if let TokenKind::Unit(text) = self.kind() { text } else { "" };
        let (unit, size) = self.unit().unwrap_or((Unit::NUMBER, 1.0));
        let default_at = self.since(default_at);
        let mut parameter = ParameterSyntax {
            name,
            at,
            unit,
            unit_name: unit.name_of(size, written),
            unit_size: size,
            default,
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
                    && other != (unit, size)
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
                parameter.range = [low, high];
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
