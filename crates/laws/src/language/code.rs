//! Code of a register machine.

use super::law_text::Stretch;
use crate::input::{Input, InputKind};
use vocabulary::{math, wrap};

/// What an instruction does with its sources a, b, c. Jumps stand at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(super) enum Operation {
    Move,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    /// a b + c, rounded twice.
    MultiplyAdd,
    /// a b − c, rounded twice.
    MultiplySubtract,
    /// c − a b, rounded twice.
    SubtractProduct,
    Minimum,
    Maximum,
    Absolute,
    Sign,
    Root,
    Floor,
    Wrap,
    Sine,
    Cosine,
    Tangent,
    Arcsine,
    Arccosine,
    Arctangent,
    HyperbolicTangent,
    Exponential,
    Logarithm,
    /// The angle of (b, a).
    Arctangent2,
    Hypotenuse,
    Power,
    Less,
    LessOrEqual,
    Equal,
    NotEqual,
    Noise,
    /// To `to`.
    Jump,
    /// To `to` unless a is true.
    JumpUnless,
    /// To `to` unless a < b.
    JumpUnlessLess,
    /// To `to` unless a ≤ b.
    JumpUnlessLessOrEqual,
    /// Counts a up, and goes to `to` while it is not above b.
    Again,
}

use Operation as O;

impl Operation {
    /// How many sources it has.
    pub(super) fn sources(self) -> usize {
        match self {
            O::Jump => 0,
            O::MultiplyAdd | O::MultiplySubtract | O::SubtractProduct => 3,
            O::Add
            | O::Subtract
            | O::Multiply
            | O::Divide
            | O::Minimum
            | O::Maximum
            | O::Arctangent2
            | O::Hypotenuse
            | O::Power
            | O::Less
            | O::LessOrEqual
            | O::Equal
            | O::NotEqual
            | O::JumpUnlessLess
            | O::JumpUnlessLessOrEqual
            | O::Again => 2,
            _ => 1,
        }
    }

    pub(super) fn is_jump(self) -> bool {
        self >= O::Jump
    }

    /// What it makes of its sources; jumps and noise make nothing.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "the interpreter is one match over all operations")]
    pub(super) fn value(self, a: f64, b: f64, c: f64) -> f64 {
        match self {
            O::Move => a,
            O::Negate => -a,
            O::Add => a + b,
            O::Subtract => a - b,
            O::Multiply => a * b,
            O::Divide => a / b,
            O::MultiplyAdd => a * b + c,
            O::MultiplySubtract => a * b - c,
            O::SubtractProduct => c - a * b,
            O::Minimum => a.min(b),
            O::Maximum => a.max(b),
            O::Absolute => a.abs(),
            // sign(0) is 0, unlike `f64::signum`.
            O::Sign => {
                if a == 0.0 {
                    0.0
                } else {
                    a.signum()
                }
            }
            O::Root => a.sqrt(),
            O::Floor => a.floor(),
            O::Wrap => wrap(a),
            O::Sine => math::sin(a),
            O::Cosine => math::cos(a),
            O::Tangent => math::tan(a),
            O::Arcsine => math::asin(a),
            O::Arccosine => math::acos(a),
            O::Arctangent => math::atan(a),
            O::HyperbolicTangent => math::tanh(a),
            O::Exponential => math::exp(a),
            O::Logarithm => math::ln(a),
            O::Arctangent2 => math::atan2(a, b),
            O::Hypotenuse => math::hypot(a, b),
            O::Power => math::powf(a, b),
            O::Less => f64::from(u8::from(a < b)),
            O::LessOrEqual => f64::from(u8::from(a <= b)),
            O::Equal => f64::from(u8::from(a == b)),
            O::NotEqual => f64::from(u8::from(a != b)),
            O::Noise | O::Jump | O::JumpUnless | O::JumpUnlessLess | O::JumpUnlessLessOrEqual | O::Again => {
                0.0
            }
        }
    }
}

/// One instruction; `a`, `b`, `c` and, but for jumps, `to` are registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Instruction {
    pub(super) operation: Operation,
    pub(super) to: u16,
    pub(super) a: u16,
    pub(super) b: u16,
    pub(super) c: u16,
}

impl Instruction {
    /// The sources that it has.
    pub(super) fn sources(&self) -> impl Iterator<Item = u16> {
        [self.a, self.b, self.c].into_iter().take(self.operation.sources())
    }
}

/// Which text an instruction comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TextOrigin {
    /// The expression.
    pub(super) at: Stretch,
    /// The number of the statement, in [`Code::owners`].
    pub(super) owner: u16,
}

/// Code with what its registers start with: parameters, memory, intermediate values, inputs, constants.
#[derive(Debug, Clone, Default)]
pub(super) struct Code {
    pub(super) instructions: Vec<Instruction>,
    /// One for each instruction.
    pub(super) origins: Vec<TextOrigin>,
    /// What the statements define, such as "`b`" or "the command".
    pub(super) owners: Vec<String>,
    /// Number of parameters.
    pub(super) parameters: usize,
    /// Numbers of memory.
    pub(super) memory: usize,
    /// Inputs that are read, the leader counted from 0, and where they are read first.
    pub(super) inputs: Vec<(usize, InputKind, Stretch)>,
    /// The register of the first input; those of the constants follow.
    pub(super) input_base: usize,
    pub(super) constants: Vec<f64>,
}

impl Code {
    /// How many registers it needs.
    pub(super) fn registers(&self) -> usize {
        self.input_base + self.inputs.len() + self.constants.len()
    }

    /// Puts what the code starts from into its registers.
    #[inline]
    pub(super) fn fill(&self, registers: &mut [f64], input: &Input<'_>, parameters: &[f64], memory: &[f64]) {
        let copy = |into: &mut [f64], from: &[f64]| {
            for (into, from) in into.iter_mut().zip(from) {
                *into = *from;
            }
        };
        let (below, above) = registers.split_at_mut(self.input_base);
        let (gains, rest) = below.split_at_mut(self.parameters);
        copy(gains, parameters);
        copy(&mut rest[..self.memory], memory);
        for (register, (leader, kind, _)) in above.iter_mut().zip(&self.inputs) {
            *register = input.value(*leader, *kind);
        }
        copy(&mut above[self.inputs.len()..], &self.constants);
    }
}
