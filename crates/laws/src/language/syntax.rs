//! The syntax tree of a law file.

use super::law_text::Stretch;
use crate::declaration::{Knowledge, Scale};
use crate::unit::Unit;
use std::collections::HashSet;

/// A whole file, as it is written.
#[derive(Debug, Default)]
pub(super) struct LawSyntax<'a> {
    pub(super) leaders: Option<usize>,
    pub(super) knows: Knowledge,
    pub(super) parameters: Vec<ParameterSyntax<'a>>,
    pub(super) memory: Vec<Named<'a, Expression<'a>>>,
    pub(super) functions: Vec<FunctionSyntax<'a>>,
    pub(super) statements: Vec<Statement<'a>>,
    /// One vector, or two numbers.
    pub(super) command: Option<Vec<Expression<'a>>>,
    /// Names that are set somewhere.
    pub(super) set: HashSet<&'a str>,
}

/// A name that is defined, with what it is.
#[derive(Debug)]
pub(super) struct Named<'a, T> {
    pub(super) name: &'a str,
    pub(super) at: Stretch,
    pub(super) value: T,
}

#[derive(Debug)]
pub(super) struct ParameterSyntax<'a> {
    pub(super) name: &'a str,
    pub(super) at: Stretch,
    pub(super) unit: Unit,
    /// As it is declared.
    pub(super) unit_name: String,
    /// What one of it is in SI.
    pub(super) unit_size: f64,
    pub(super) default: f64,
    pub(super) range: [f64; 2],
    pub(super) scale: Scale,
    pub(super) help: &'a str,
    pub(super) symbol: Option<&'a str>,
}

#[derive(Debug)]
pub(super) struct FunctionSyntax<'a> {
    pub(super) name: &'a str,
    pub(super) at: Stretch,
    pub(super) arguments: Vec<&'a str>,
    pub(super) body: Block<'a>,
}

/// Statements, and the value that stands behind them.
#[derive(Debug, Default)]
pub(super) struct Block<'a> {
    pub(super) statements: Vec<Statement<'a>>,
    pub(super) value: Option<Expression<'a>>,
    pub(super) at: Stretch,
}

#[derive(Debug)]
pub(super) enum Statement<'a> {
    /// `let name = value`.
    Let(Named<'a, Expression<'a>>),
    /// `name = value`.
    Set(Named<'a, Expression<'a>>),
    /// `name' = value`.
    Rate(Named<'a, Expression<'a>>),
    /// `repeat count as counter { body }`.
    Repeat { count: u32, counter: Option<Named<'a, ()>>, body: Block<'a>, at: Stretch },
    /// An `if` whose value, if it has one, is not used.
    If(Box<Choice<'a>>),
}

/// `if condition { then } else { otherwise }`.
#[derive(Debug)]
pub(super) struct Choice<'a> {
    pub(super) condition: Expression<'a>,
    pub(super) then: Block<'a>,
    pub(super) otherwise: Option<Block<'a>>,
}

#[derive(Debug)]
pub(super) struct Expression<'a> {
    pub(super) kind: ExpressionKind<'a>,
    pub(super) at: Stretch,
}

#[derive(Debug)]
pub(super) enum ExpressionKind<'a> {
    /// Something that could not be read, and was reported.
    Broken,
    /// A number in SI units, with its unit where one is written.
    Number(f64, Option<Unit>),
    Truth(bool),
    Name(&'a str),
    /// `value.name`.
    Member(Box<Expression<'a>>, &'a str),
    /// `(x, y)`.
    Vector(Box<[Expression<'a>; 2]>),
    Negative(Box<Expression<'a>>),
    Not(Box<Expression<'a>>),
    /// Sums or products from left to right; a list, so that no tree is deeper than its text is nested.
    Chain(Box<Expression<'a>>, Vec<(Arithmetic, Expression<'a>)>),
    /// `base ^ exponent`.
    Power(Box<[Expression<'a>; 2]>),
    Comparison(&'static str, Box<[Expression<'a>; 2]>),
    /// Joined by `and`, or by `or`.
    Joined(Junction, Vec<Expression<'a>>),
    Call(Named<'a, Vec<Expression<'a>>>),
    If(Box<Choice<'a>>),
}

/// The four signs of arithmetic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arithmetic {
    Plus,
    Minus,
    Times,
    Over,
}

/// How conditions are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Junction {
    And,
    Or,
}
