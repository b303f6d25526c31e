//! Blocks and their statements.

use super::super::law_text::Stretch;
use super::super::names;
use super::super::syntax::{Block, Expression, ExpressionKind, Named, Statement};
use super::super::token::TokenKind;
use super::{Lost, Parsed, Parser, ROUNDS_MAX};

impl<'a> Parser<'a, '_> {
    /// `{ … }`.
    pub(super) fn block(&mut self) -> Parsed<Block<'a>> {
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
    pub(super) fn unused(&mut self, value: Expression<'a>, block: &mut Block<'a>) {
        match value.kind {
            ExpressionKind::If(choice) => block.statements.push(Statement::If(choice)),
            _ => self
                .mistakes
                .add(value.at, "this value is not used: only the last line of a block is its value"),
        }
    }

    /// A statement inside or outside a block; what may be the value of the block becomes it.
    pub(super) fn statement(&mut self, block: &mut Block<'a>) -> Parsed<()> {
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

    pub(super) fn repeat(&mut self, from: Stretch) -> Parsed<Statement<'a>> {
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
}
