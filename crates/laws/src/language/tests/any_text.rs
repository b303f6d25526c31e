//! Any text at all.

use super::{compiled, input, leaders, run, shown};
use crate::language::LawFile;
use proptest::prelude::*;
use vocabulary::math;

/// Texts that are nearly laws: lines of the laws that ship, words and signs.
fn nearly_a_law() -> impl Strategy<Value = String> {
    let lines: Vec<&'static str> = crate::SHIPPED_LAWS.iter().flat_map(|law| law.text.lines()).collect();
    let words = vec![
        "let",
        "repeat",
        "9",
        "as",
        "i",
        "if",
        "else",
        "{",
        "}",
        "(",
        ")",
        "=",
        "==",
        "+",
        "-",
        "*",
        "/",
        "^",
        ",",
        ".",
        "..",
        "'",
        "\"",
        "[m]",
        "[",
        "x",
        "leader.distance",
        "leader2",
        "wanted.output",
        "memory",
        "parameter",
        "in",
        "log",
        "function",
        "f(",
        "command",
        "=",
        "0",
        "1e300",
        "noise(",
        "sqrt(",
        "and",
        "not",
        "\n",
        "\n",
        ";",
        "#",
        "²",
        "ψ",
        "\u{feff}",
        "\r\n",
    ];
    let part = prop_oneof![
        2 => proptest::sample::select(lines).prop_map(|line| format!("\n{line}\n")),
        5 => proptest::sample::select(words).prop_map(|word| format!("{word} ")),
    ];
    proptest::collection::vec(part, 0..60).prop_map(|parts| parts.concat())
}

/// Statements with branches and loops.
fn statements() -> impl Strategy<Value = String> {
    let plain = proptest::sample::select(vec![
        "a = a + b * 2",
        "b = sin(a) - b / 3",
        "a = if a > b { sin(cos(a)) } else { b }",
        "b = if a > b { 1 } else if b < 0 { tanh(a) } else { -b }",
        "if a > 1 or not (b < a) { a = 1 }",
        "a = noise(3)",
    ]);
    plain.prop_map(str::to_owned).prop_recursive(4, 24, 3, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(one, other)| format!("{one}\n{other}")),
            (inner.clone(), inner.clone())
                .prop_map(|(one, other)| format!("if a < b {{ {one} }} else {{ {other} }}")),
            (1..6, inner).prop_map(|(count, inner)| format!("repeat {count} {{ {inner} }}")),
        ]
    })
}

proptest! {
    #[test]
    fn any_text_is_a_law_or_is_refused_in_words(text in prop_oneof![nearly_a_law(), ".{0,200}"]) {
        match LawFile::compile(&text) {
            Ok(law) => { let _ = run(&law, 2); }
            Err(mistakes) => {
                prop_assert!(!mistakes.is_empty() && mistakes.len() <= 20);
                prop_assert!(mistakes.windows(2).all(|pair| pair[0].place <= pair[1].place));
                for mistake in &mistakes {
                    prop_assert!(mistake.place <= mistake.end && !mistake.message.is_empty(), "{mistake:?}");
                    prop_assert!(!mistake.message.contains(char::is_control), "{mistake:?}");
                }
            }
        }
    }

    /// No sample executes more instructions than were counted, whatever its branches.
    #[test]
    fn the_count_is_never_passed(text in statements()) {
        let law = compiled(&format!("let a = time / 1 [s]\nlet b = 1\n{text}\ncommand = 0, 0"));
        prop_assert!(law.executed(&input(&leaders())) <= law.instructions());
    }

    /// A polynomial in x and y is what Rust makes of it, in the same order.
    #[test]
    fn sums_of_products_have_the_bits_of_rust(x in -9.0..9.0, y in -9.0..9.0, z in -9.0..9.0) {
        let text = format!(
            "parameter x = {x} in -9 .. 9\nparameter y = {y} in -9 .. 9\nparameter z = {z} in -9 .. 9\n\
             let a = x * y + z - y * z * x + (x - y * z) * (x * z - y) - x / y * z\n\
             let b = sin(x) * y - cos(y) * z\nlet c = (a - b * x) / (1 + z * z)"
        );
        let a = x * y + z - y * z * x + (x - y * z) * (x * z - y) - x / y * z;
        let b = math::sin(x) * y - math::cos(y) * z;
        let c = (a - b * x) / (1.0 + z * z);
        prop_assert_eq!(shown(&text), [a, b, c]);
    }
}
