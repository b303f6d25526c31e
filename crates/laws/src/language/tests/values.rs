//! What expressions are worth.

use super::{compiled, input, leaders, run, shown};
use crate::{CustomLaw, InputKind, Noise};
use std::f64::consts::PI;
use vocabulary::{math, wrap};

#[test]
fn operators_and_functions_are_those_of_rust() {
    let (x, y) = (0.7312_f64, -2.418_f64);
    let cases = [
        ("x + y", x + y),
        ("x - y", x - y),
        ("x * y", x * y),
        ("x / y", x / y),
        ("-x", -x),
        ("+x", x),
        ("x - y - 3", x - y - 3.0),
        ("x / y / 3", x / y / 3.0),
        ("x + y * 3", x + y * 3.0),
        ("x * y + 3", x * y + 3.0),
        ("x * y - 3", x * y - 3.0),
        ("3 - x * y", 3.0 - x * y),
        ("x * y + x * x", x * y + x * x),
        ("(x + y) * 3", (x + y) * 3.0),
        ("-x ^ 2", -(x * x)),
        ("x ^ 2", x * x),
        ("x²", x * x),
        ("x³", x * x * x),
        ("x ^ 3", math::powi(x, 3)),
        ("x ^ 7", math::powi(x, 7)),
        ("x ^ 1", x),
        ("x ^ 0", 1.0),
        ("x ^ -2", math::powi(x, -2)),
        ("x ^ 0.5", x.sqrt()),
        ("x ^ 1.7", math::powf(x, 1.7)),
        ("x ^ 40", math::powf(x, 40.0)),
        ("x ^ y", math::powf(x, y)),
        ("2 ^ 3 ^ 2", 512.0),
        ("abs(y)", y.abs()),
        ("sign(y)", -1.0),
        ("sign(x)", 1.0),
        ("sign(x - x)", 0.0),
        ("sqrt(x)", x.sqrt()),
        ("min(x, y)", y),
        ("max(x, y)", x),
        ("clamp(y, -1, x)", -1.0),
        ("clamp(5, y, x)", x),
        ("floor(y)", -3.0),
        ("sin(x)", math::sin(x)),
        ("cos(x)", math::cos(x)),
        ("tan(x)", math::tan(x)),
        ("asin(x)", math::asin(x)),
        ("acos(x)", math::acos(x)),
        ("atan(y)", math::atan(y)),
        ("atan2(x, y)", math::atan2(x, y)),
        ("wrap(y * 3)", wrap(y * 3.0)),
        ("hypot(x, y)", math::hypot(x, y)),
        ("tanh(x)", math::tanh(x)),
        ("exp(y)", math::exp(y)),
        ("ln(x)", math::ln(x)),
        ("dot((x, y), (3, x))", x * 3.0 + y * x),
        ("length((x, y))", (x * x + y * y).sqrt()),
        ("rotate((x, y), 0.3).x", math::cos(0.3) * x - math::sin(0.3) * y),
        ("rotate((x, y), 0.3).y", math::sin(0.3) * x + math::cos(0.3) * y),
        ("noise(3) + 0 * x", Noise { seed: 7, robot: 2, sample: 41 }.normal(3)),
        ("pi + 0 * x", PI),
        ("π", PI),
        ("x · y × 2 − 1", x * y * 2.0 - 1.0),
        (".5 + 5. + 1e-3 + 2E2", 0.5 + 5.0 + 1e-3 + 200.0),
        ("if x < y { 1 } else { 2 }", 2.0),
        ("if x > y { 1 } else { 2 }", 1.0),
        ("if x <= x { 1 } else { 2 }", 1.0),
        ("if x ≥ x { 1 } else { 2 }", 1.0),
        ("if x == y { 1 } else { 2 }", 2.0),
        ("if x != y { 1 } else { 2 }", 1.0),
        ("if not (x < y) { 1 } else { 2 }", 1.0),
        ("if x < y and x > 0 { 1 } else { 2 }", 2.0),
        ("if x < y or x > 0 { 1 } else { 2 }", 1.0),
        ("if x < y or x < 0 and true { 1 } else if false { 3 } else { 2 }", 2.0),
        ("if x > y { if x > 5 { 4 } else { 5 } } else { 2 } + 1", 6.0),
        ("x - if x > 0 { y } else { x } * 2", x - y * 2.0),
    ];
    for (text, wanted) in cases {
        let law = format!("parameter x = {x} in -9 .. 9\nparameter y = {y} in -9 .. 9\nlet r = {text}");
        assert_eq!(shown(&law), [wanted], "{text}");
        // With numbers in place of parameters it is computed when it is compiled, to the same bits.
        let letters = |c: char| if c.is_alphanumeric() && !matches!(c, '²' | '³') { 'a' } else { ' ' };
        let mut folded = String::new();
        for (index, c) in text.char_indices() {
            let before = text[..index].chars().next_back().map_or(' ', letters);
            let after = text[index + c.len_utf8()..].chars().next().map_or(' ', letters);
            let is_alone = before == ' ' && after == ' ' && !text[..index].ends_with('.');
            match c {
                'x' if is_alone => folded = format!("{folded}({x})"),
                'y' if is_alone => folded = format!("{folded}({y})"),
                _ => folded.push(c),
            }
        }
        assert_eq!(shown(&format!("let r = {folded}")), [wanted], "{folded}");
    }
}

#[test]
fn vectors_are_computed_by_components() {
    for (text, wanted) in [
        ("(1, 2) + (3, 5)", [4.0, 7.0]),
        ("(1, 2) - (3, 5)", [-2.0, -3.0]),
        ("(1, 2) * 3", [3.0, 6.0]),
        ("3 * (1, 2)", [3.0, 6.0]),
        ("(1, 2) / 4", [0.25, 0.5]),
        ("(1, 2) * (3, 5)", [3.0, 10.0]),
        ("(1, 2) / (4, 8)", [0.25, 0.25]),
        ("-(1, 2)", [-1.0, -2.0]),
        ("abs((-1, 2))", [1.0, 2.0]),
        ("(3, 4) ^ 2", [9.0, 16.0]),
        ("max((1, 5), (2, 3))", [2.0, 5.0]),
        ("clamp((1, 5), (2, 3), (4, 4))", [2.0, 4.0]),
        ("if true { (1, 2) } else { (3, 4) }", [1.0, 2.0]),
        ("rotate((1, 0), pi / 2) + (0, 1)", [math::cos(PI / 2.0), math::sin(PI / 2.0) + 1.0]),
    ] {
        assert_eq!(shown(&format!("let r = {text}")), wanted, "{text}");
        let hidden = text.replace(['1'], "one").replace("(0, one)", "(0 * one, one)");
        assert_eq!(shown(&format!("parameter one = 1 in 0 .. 2\nlet r = {hidden}")), wanted, "{hidden}");
    }
    assert_eq!(shown("let v = (1, 2)\nv = (v.y, v.x)"), [2.0, 1.0]);
    assert_eq!(shown("let a = 1\na = 2\nlet v = (a, a)\na = 3"), [3.0, 2.0, 2.0]);
}

#[test]
fn every_input_is_told() {
    for (kind, name, ..) in crate::INPUTS {
        let law = compiled(&format!("knows motion\nlet r = {name}\ncommand = 0, 0"));
        let leaders = leaders();
        let wanted = input(&leaders).value(0, kind);
        assert_eq!(run(&law, 1).expect("a sample").shown, [wanted], "{name}");
        assert_eq!(law.declaration().reads, [(0, kind)], "{name}");
        assert_eq!(
            law.declaration().shown[0].unit,
            crate::INPUTS.iter().find(|i| i.0 == kind).expect("it").2
        );
    }
    let pairs = [
        ("leader.output", [2.0, 0.5]),
        ("leader.rates", [0.125, -0.375]),
        ("wanted.output", [3.0, 1.5]),
        ("wanted.rates", [0.1, 0.2]),
        ("wanted.accelerations", [0.3, 0.4]),
    ];
    for (name, wanted) in pairs {
        assert_eq!(shown(&format!("let r = {name}")), wanted, "{name}");
        assert_eq!(shown(&format!("let r = {name}.y")), wanted[1..], "{name}");
    }
}

#[test]
fn several_leaders_have_numbers() {
    let law = compiled(
        "leaders 3\nknows motion\nlet d = leader1.distance + leader3.distance\nlet w = wanted2.output\n\
         let f = frame3.turn_rate\nlet s = leader2.speed\ncommand = 0, 0",
    );
    assert_eq!(run(&law, 1).expect("a sample").shown, [6.0, 4.0, 2.5, 2.9, 2.1]);
    let reads = [
        (0, InputKind::Distance),
        (1, InputKind::WantedDistance),
        (1, InputKind::WantedBearing),
        (1, InputKind::LeaderSpeed),
        (2, InputKind::Distance),
        (2, InputKind::FrameTurnRate),
    ];
    assert_eq!(law.declaration().reads, reads);
    assert_eq!(law.declaration().leaders, 3);
    assert_eq!(shown("let d = leader1.distance"), [2.0]);
}
