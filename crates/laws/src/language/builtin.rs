//! The functions of the language.

use super::code::Operation;

/// A function of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Builtin {
    pub(super) name: &'static str,
    pub(super) arguments: usize,
    pub(super) kind: BuiltinKind,
    /// One line about it.
    pub(super) help: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BuiltinKind {
    /// Of one number, without unit.
    Number(Operation),
    /// Of one number without unit, to an angle.
    Angle(Operation),
    /// Of one number of any unit, to one of that unit.
    Same(Operation),
    /// Of one number of any unit, to one without.
    Sign,
    /// Of one number, with half the powers of its unit.
    Root,
    /// Of two numbers of one unit, to one of that unit.
    Common(Operation),
    /// Of two numbers of one unit, to an angle.
    Direction,
    Clamp,
    Dot,
    Length,
    Rotate,
    Noise,
}

use BuiltinKind as B;
use Operation as O;

const fn builtin(name: &'static str, arguments: usize, kind: BuiltinKind, help: &'static str) -> Builtin {
    Builtin { name, arguments, kind, help }
}

/// All of them.
pub(super) const BUILTINS: [Builtin; 23] = [
    builtin("abs", 1, B::Same(O::Absolute), "absolute value"),
    builtin("sign", 1, B::Sign, "1, 0 or −1"),
    builtin("sqrt", 1, B::Root, "square root"),
    builtin("min", 2, B::Common(O::Minimum), "the smaller of two numbers"),
    builtin("max", 2, B::Common(O::Maximum), "the larger of two numbers"),
    builtin("clamp", 3, B::Clamp, "clamp(x, low, high): x, but at least low, and at most high"),
    builtin("floor", 1, B::Number(O::Floor), "the largest whole number that is not larger"),
    builtin("sin", 1, B::Number(O::Sine), "sine"),
    builtin("cos", 1, B::Number(O::Cosine), "cosine"),
    builtin("tan", 1, B::Number(O::Tangent), "tangent"),
    builtin("asin", 1, B::Angle(O::Arcsine), "arc sine"),
    builtin("acos", 1, B::Angle(O::Arccosine), "arc cosine"),
    builtin("atan", 1, B::Angle(O::Arctangent), "arc tangent"),
    builtin("atan2", 2, B::Direction, "atan2(y, x): the angle of the vector (x, y)"),
    builtin("wrap", 1, B::Angle(O::Wrap), "an angle brought into (−π, π]"),
    builtin("hypot", 2, B::Common(O::Hypotenuse), "√(x² + y²)"),
    builtin("tanh", 1, B::Number(O::HyperbolicTangent), "hyperbolic tangent"),
    builtin("exp", 1, B::Number(O::Exponential), "e to the power of x"),
    builtin("ln", 1, B::Number(O::Logarithm), "natural logarithm"),
    builtin("dot", 2, B::Dot, "scalar product of two vectors"),
    builtin("length", 1, B::Length, "length of a vector"),
    builtin("rotate", 2, B::Rotate, "rotate(v, angle): the vector turned counter-clockwise"),
    builtin(
        "noise",
        1,
        B::Noise,
        "noise(i): normally distributed, mean 0, variance 1; another for each i, sample and robot",
    ),
];
