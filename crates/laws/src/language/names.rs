//! Words that names may not be, and names that may have been meant.

use crate::input::{INPUTS, LEADERS_MAX};

/// The words of the language.
const WORDS: [&str; 17] = [
    "let",
    "repeat",
    "as",
    "if",
    "else",
    "and",
    "or",
    "not",
    "true",
    "false",
    "function",
    "parameter",
    "memory",
    "command",
    "leaders",
    "knows",
    "in",
];

/// What may not be a name, and why not.
pub(super) fn reserved(name: &str) -> Option<String> {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    if WORDS.contains(&name) {
        Some(format!("`{name}` is a word of the language: choose another name"))
    } else if matches!(stem, "leader" | "wanted" | "frame")
        || name == "own"
        || INPUTS.iter().any(|(_, input, ..)| *input == name)
    {
        Some(format!("`{name}` is what the law is told: choose another name"))
    } else if matches!(name, "pi" | "π") {
        Some(format!("`{name}` is 3.14159…: choose another name"))
    } else {
        None
    }
}

/// The word of another language, and how it is said here.
pub(super) fn said_here(word: &str) -> Option<&'static str> {
    Some(match word {
        "for" | "while" | "loop" => "loops are counted: `repeat 10 as i { … }`",
        "fn" | "def" | "func" => "functions are written `function f(x) = x * x`",
        "var" | "const" | "local" | "auto" | "double" | "float" => "numbers are named by `let x = …`",
        "return" => "the value of a function is its last line, without a word before it",
        "elif" | "elseif" | "elsif" => "write `else if`",
        "then" | "end" | "begin" => "blocks stand in braces: `if x > 0 { 1 } else { 2 }`",
        "state" => "what is carried from sample to sample is `memory x = 0`",
        "param" | "gain" => "parameters are written `parameter k = 5 [1/s] in 0.1 .. 20`",
        "import" | "use" | "include" => "a law file stands alone",
        "print" => "every `let` can be plotted; nothing is printed",
        _ => return None,
    })
}

/// A function of another language, and how it is called here.
pub(super) fn called_here(name: &str) -> Option<&'static str> {
    Some(match name {
        "log" => "the natural logarithm is `ln(x)`",
        "log10" => "write `ln(x) / ln(10)`",
        "pow" | "power" => "powers are written `x ^ 2`",
        "sqr" | "square" => "a square is written `x ^ 2`",
        "sgn" | "signum" => "write `sign(x)`",
        "arctan" => "write `atan(x)`",
        "arctan2" => "write `atan2(y, x)`",
        "arcsin" => "write `asin(x)`",
        "arccos" => "write `acos(x)`",
        "atanh" | "artanh" | "arctanh" => "write `ln((1 + x) / (1 - x)) / 2`",
        "asinh" | "arsinh" => "write `ln(x + sqrt(x^2 + 1))`",
        "acosh" | "arcosh" => "write `ln(x + sqrt(x^2 - 1))`",
        "sinh" => "write `(exp(x) - exp(-x)) / 2`",
        "cosh" => "write `(exp(x) + exp(-x)) / 2`",
        "fabs" => "write `abs(x)`",
        "norm" | "magnitude" => "write `length(v)`",
        "sat" | "saturate" | "saturation" | "limit" => "write `clamp(x, low, high)`",
        "wrapToPi" | "wrap_to_pi" | "angdiff" => "write `wrap(angle)`",
        "rand" | "random" | "randn" | "normal" => "write `noise(1)`: normally distributed, variance 1",
        "mod" | "fmod" | "rem" => "write `x - y * floor(x / y)`, or `wrap(angle)` for angles",
        "ceil" => "write `-floor(-x)`",
        "round" => "write `floor(x + 0.5)`",
        "vec" | "vec2" | "vector" => "a vector is written `(x, y)`",
        "rad" | "radians" | "deg2rad" => "write the unit behind a number: `30 [deg]`",
        _ => return None,
    })
}

/// The one of `known` that is nearest to `name`, where one is near.
pub(super) fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let scored = known.map(|known| (strsim::jaro_winkler(name, known), known));
    let best = scored.filter(|(score, _)| *score > 0.82).max_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, known)| known)
}

/// "; did you mean `…`?" with the one of `known` that is nearest to `name`, where one is near.
pub(crate) fn did_you_mean<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    nearest(name, known).map_or_else(String::new, |known| format!("; did you mean `{known}`?"))
}

/// All names of inputs as a law with so many leaders writes them.
pub(super) fn input_names(leaders: usize) -> Vec<String> {
    let pairs = ["leader.output", "leader.rates", "wanted.output", "wanted.rates", "wanted.accelerations"];
    let all: Vec<&str> = INPUTS.iter().map(|(_, name, ..)| *name).chain(pairs).collect();
    let numbered = |name: &&str| match name.split_once('.') {
        Some((group, rest)) if leaders > 1 && group != "own" => {
            (1..=leaders.min(LEADERS_MAX)).map(|k| format!("{group}{k}.{rest}")).collect()
        }
        _ => vec![(*name).to_owned()],
    };
    all.iter().flat_map(numbered).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_named_by_the_number_of_their_leader_where_there_are_several() {
        assert!(input_names(1).contains(&"leader.distance".to_owned()));
        let two = input_names(2);
        for name in ["leader1.distance", "wanted2.output", "frame2.turn_rate", "own.speed", "time"] {
            assert!(two.contains(&name.to_owned()), "{name}");
        }
        assert!(!two.contains(&"leader.distance".to_owned()));
    }

    #[test]
    fn what_the_law_is_told_cannot_be_named() {
        for name in ["let", "leader", "leader2", "wanted", "own", "time", "pi", "π"] {
            assert!(reserved(name).is_some(), "{name}");
        }
        assert!(["e", "log", "leading", "symbol"].iter().all(|name| reserved(name).is_none()));
    }
}
