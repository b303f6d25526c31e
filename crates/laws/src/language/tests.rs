//! Tests of the language as a whole: what texts mean, and what is said of those that mean nothing.

use super::LawFile;
use crate::{CustomLaw, Fault, Input, InputKind, Knowledge, LeaderInput, Noise, Scale, Unit};
use proptest::prelude::*;
use std::f64::consts::PI;
use vocabulary::{Command, MotionInput, Relative, SetPoint, math, wrap};

fn compiled(text: &str) -> LawFile {
    LawFile::compile(text).unwrap_or_else(|mistakes| {
        let lines: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
        panic!("{}\nin\n{text}", lines.join("\n"))
    })
}

/// The mistakes in a text, such as "1:9-1:12 nothing is called `abc`".
fn mistakes(text: &str) -> Vec<String> {
    match LawFile::compile(text) {
        Ok(_) => vec![],
        Err(mistakes) => mistakes.iter().map(|m| format!("{}-{} {}", m.place, m.end, m.message)).collect(),
    }
}

/// The mistakes in a law that has `text` and a command.
fn mistakes_of(text: &str) -> Vec<String> {
    mistakes(&format!("{text}\ncommand = 0, 0"))
}

/// What a law is told: every number is another one.
fn leaders() -> [LeaderInput; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|k| LeaderInput {
        relative: Relative { distance: 2.0 + k, bearing: 0.5 + k, view_angle: -0.25 - k },
        rates: [0.125 + k, -0.375 - k],
        wanted: SetPoint {
            value: [3.0 + k, 1.5 + k],
            rate: [0.1 + k, 0.2 + k],
            acceleration: [0.3 + k, 0.4 + k],
        },
        motion: MotionInput {
            speed: 1.1 + k,
            acceleration: 0.6 + k,
            turn_rate: 0.7 + k,
            turn_acceleration: 0.8 + k,
        },
        frame: [0.9 + k, 1.9 + k],
        heading: 0.05 + k,
    })
}

fn input(leaders: &[LeaderInput]) -> Input<'_> {
    Input {
        time: 1.5,
        period: 0.01,
        own_speed: 0.75,
        own_acceleration: -0.5,
        own_turn_rate: 0.25,
        leaders,
        noise: Noise { seed: 7, robot: 2, sample: 41 },
    }
}

/// What a run of samples leaves: the last command, memory and shown quantities.
#[derive(Debug)]
struct Run {
    command: Command,
    memory: Vec<f64>,
    shown: Vec<f64>,
}

fn run(law: &LawFile, samples: usize) -> Result<Run, Fault> {
    let leaders = leaders();
    let mut input = input(&leaders);
    let declaration = law.declaration();
    let parameters: Vec<f64> = declaration.parameters.iter().map(|parameter| parameter.default).collect();
    let mut memory = vec![0.0; declaration.memory.len()];
    let mut shown = vec![0.0; declaration.shown.len()];
    law.start(&input, &parameters, &mut memory)?;
    let mut command = Command::default();
    for _ in 0..samples {
        command = law.decide(&input, &parameters, &mut memory, &mut shown)?;
        input.noise.sample += 1;
    }
    Ok(Run { command, memory, shown })
}

/// The quantities that the statements of `text` show after a sample.
fn shown(text: &str) -> Vec<f64> {
    run(&compiled(&format!("{text}\ncommand = 0, 0")), 1).expect("a sample").shown
}

fn fault(text: &str) -> String {
    run(&compiled(text), 1).expect_err("a fault").to_string()
}

// Values.

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

// Statements.

#[test]
fn statements_do_what_they_say() {
    for (text, wanted) in [
        ("let total = 0\nrepeat 10 { total = total + 2 }", vec![20.0]),
        ("let total = 0\nrepeat 4 as i { total = total + i }", vec![10.0]),
        ("let t = 0\nrepeat 3 as i { repeat 2 as j { t = t + i * j } }", vec![18.0]),
        ("let a = 1\nlet b = a\na = 2", vec![2.0, 1.0]),
        ("let a = 1\nif a > 0 { a = 5 }", vec![5.0]),
        ("let a = 1\nif a < 0 { a = 5 } else { a = 7 }", vec![7.0]),
        ("let a = 1\nif a < 0 { a = 5 } else if a == 1 { let b = 3; a = b } else { a = 7 }", vec![3.0]),
        ("function f(x) { let y = x * x; y + 1 }\nlet a = f(3) * f(2)", vec![50.0]),
        ("function f(x, y) = x - y\nfunction g(x) = f(x, 1) + f(1, x)\nlet a = g(7)", vec![0.0]),
        ("function clamp(x, low, high) = min(max(x, low), high) + 1\nlet a = clamp(3, 0, 2)", vec![3.0]),
        ("parameter k = 2 in 0 .. 9\nfunction f(x) = k * x\nlet a = f(4)", vec![8.0]),
        ("function f(x) { let s = 0; repeat 5 { s = s + x }; s }\nlet a = f(2)", vec![10.0]),
        ("let a = 3 > 2\nlet b = a and not a", vec![1.0, 0.0]),
        // What is not a number is neither less nor more.
        (
            "let z = time - 1.5 [s]\nlet a = if z / z < 1 or z / z >= 1 { 1 } else if z / z <= 1 { 2 } else { 3 }",
            vec![0.0, 3.0],
        ),
        ("let a = (1 +\n 2) # one\n\n  * 3", vec![9.0]),
        ("let a = 1\n  + 2\n  - 3\nlet b = 4", vec![0.0, 4.0]),
        ("let a = if true {\n let c = 2\n\n c\n}\nelse {\n 3\n}", vec![2.0]),
        ("let a = 1; let b = 2;;let c = 3;", vec![1.0, 2.0, 3.0]),
        ("let a = (\n 1,\n 2\n)", vec![1.0, 2.0]),
        ("let ψ = 1\nlet k₁ = ψ\nlet Δx_max = 2", vec![1.0, 1.0, 2.0]),
        ("\u{feff}# Title\r\nlet a = 1\r\nlet b = a +\r\n  1\r\n", vec![1.0, 2.0]),
        ("let a = 30 [deg]\nlet b = 2 [km] / 4 [m]\nlet c = -90 [deg/s]", vec![PI / 6.0, 500.0, -PI / 2.0]),
    ] {
        let found = shown(text);
        assert!(
            found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-15) && found.len() == wanted.len(),
            "{text}: {found:?}"
        );
    }
}

#[test]
fn memory_is_set_or_integrated() {
    let law = compiled(
        "parameter k = 3 [m] in 0 .. 9\nmemory a = leader.distance + k\nmemory b = a * 2\nmemory v = (1, leader.bearing)\n\
         memory c = 4\na = a + 1 [m]\nb' = leader.distance / 1 [s]\nv' = (b / 1 [m s], 0)\ncommand = a / 1 [s^2], 0",
    );
    let declaration = law.declaration();
    let names: Vec<&str> = declaration.memory.iter().map(|memory| memory.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "v.x", "v.y", "c"]);
    let units: Vec<String> = declaration.memory.iter().map(|memory| memory.unit.to_string()).collect();
    assert_eq!(units, ["m", "m", "", "rad", ""]);
    assert!(!declaration.continuous);
    assert_eq!(run(&law, 0).expect("a start").memory, [5.0, 10.0, 1.0, 0.5, 4.0]);
    // What is set is read as set; derivatives go by what the memory was at the sample.
    let once = run(&law, 1).expect("a sample");
    assert_eq!(
        (once.command.acceleration, once.memory),
        (6.0, vec![6.0, 10.0 + 0.01 * 2.0, 1.0 + 0.01 * 10.0, 0.5, 4.0])
    );
    let twice = run(&law, 2).expect("samples");
    assert_eq!(twice.memory[..2], [7.0, 10.0 + 0.01 * 2.0 + 0.01 * 2.0]);
}

#[test]
fn derivatives_are_those_of_continuous_time() {
    let law = compiled(
        "memory a = 1 [m]\nmemory b = (0 [1/s], 2)\nlet x = a / 1 [s]\na' = -x\nb' = (3 [1/s^2], x / 1 [m])\ncommand = x / 1 [s], 0",
    );
    assert!(law.declaration().continuous);
    let leaders = leaders();
    let mut rates = [9.0; 3];
    let command = law.derive(&input(&leaders), &[], &[5.0, 6.0, 7.0], &mut rates).expect("derivatives");
    assert_eq!((command.acceleration, rates), (5.0, [-5.0, 3.0, 5.0]));
    assert!(compiled("memory a = 1\ncommand = 0, 0").declaration().continuous);
    assert!(!compiled("let a = noise(1)\ncommand = 0, 0").declaration().continuous);
}

#[test]
fn what_a_derivative_reads_is_what_it_was_there() {
    let law = compiled("memory s = 0\nlet a = 1\ns' = a / 1 [s]\na = 5\ncommand = 0, 0");
    assert_eq!(run(&law, 1).expect("a sample").memory, [0.01]);
}

#[test]
fn noise_goes_by_its_number_and_the_sample() {
    let text = "let a = noise(0)\nlet sum = 0\nrepeat 3 as i { sum = sum + noise(i) }\nfunction f(i) = noise(i)\nlet b = f(0)\ncommand = 0, 0";
    let law = compiled(text);
    let noise = Noise { seed: 7, robot: 2, sample: 42 };
    let sum = noise.normal(1) + noise.normal(2) + noise.normal(3);
    assert_eq!(run(&law, 2).expect("samples").shown, [noise.normal(0), sum, noise.normal(0)]);
}

#[test]
fn a_declaration_says_what_the_text_says() {
    let law = compiled(
        "# Mine\nknows rates\nparameter k1 = 5 [rad/s] in 0.1 .. 20 \"a gain\"\n\
         parameter epsilon = 1 [ms] \"small\" symbol \"e\" log in 0.1 .. 100\nparameter a = -45 [deg] in -90 .. 90 [deg]\n\
         let e = wanted.output - leader.output\nlet ok = e.x > 0\ncommand = 0, 0",
    );
    let declaration = law.declaration();
    assert_eq!(
        (declaration.title.as_str(), declaration.knows, declaration.leaders),
        ("Mine", Knowledge::Rates, 1)
    );
    let [k1, epsilon, a] = &declaration.parameters[..] else { panic!("{declaration:?}") };
    assert_eq!(
        (k1.symbol.as_str(), k1.unit.to_string().as_str(), k1.help.as_str()),
        ("k₁", "rad/s", "a gain")
    );
    assert_eq!((k1.default, k1.range, k1.scale), (5.0, [0.1, 20.0], Scale::Linear));
    assert_eq!((epsilon.behind().as_str(), epsilon.as_told(2.0)), (" ms", 0.002));
    assert_eq!((a.behind().as_str(), a.as_told(a.default)), (" deg", -PI / 4.0));
    assert_eq!(
        (epsilon.symbol.as_str(), epsilon.unit, epsilon.help.as_str()),
        ("e", Unit::new(0, 1), "small")
    );
    assert_eq!((epsilon.default, epsilon.range, epsilon.scale), (1.0, [0.1, 100.0], Scale::Logarithmic));
    assert_eq!((a.unit.to_string().as_str(), a.default, a.range), ("rad", -45.0, [-90.0, 90.0]));
    let shown: Vec<String> =
        declaration.shown.iter().map(|shown| format!("{} [{}]", shown.name, shown.unit)).collect();
    assert_eq!(shown, ["e.x [m]", "e.y [rad]", "ok []"]);
    assert!(!declaration.reads_rates());
    assert_eq!(law.text().lines().count(), 8);
}

#[test]
fn a_zero_fits_any_unit_where_it_stands() {
    for text in [
        "let a = leader.distance + 0",
        "let a = 0 - leader.distance",
        "let a = max(0, leader.distance)",
        "let a = clamp(leader.distance, 0, 1 [m])",
        "let a = if leader.distance > 0 { leader.distance } else { 0 }",
        "let a = if leader.distance == -0 { 0 } else { (leader.distance) }",
        "let a = leader.output + (0, 0)",
        "let a = 1 [m]\na = 0",
        "memory m = 1 [m]\nm' = 0",
        "let a = atan2(0, leader.distance)",
    ] {
        assert_eq!(mistakes_of(text), [""; 0], "{text}");
    }
}

// Mistakes.

#[test]
fn units_that_do_not_fit_are_named() {
    for (text, mistake) in [
        (
            "let a = wanted.distance - leader.bearing",
            "1:9-1:41 `wanted.distance` is in m, `leader.bearing` is an angle (rad): they cannot be subtracted",
        ),
        (
            "let a = leader.distance + 1",
            "1:9-1:28 `leader.distance` is in m, `1` is a number: they cannot be added; with a unit it is `1 [m]`",
        ),
        (
            "let a = 1 [m] + 2 [m] * 3 [m]",
            "1:9-1:30 `1 [m]` is in m, `2 [m] * 3 [m]` is in m²: they cannot be added",
        ),
        (
            "let a = 1 + own.speed < 2",
            "1:9-1:22 `1` is a number, `own.speed` is in m/s: they cannot be added; with a unit it is `1 [m/s]`",
        ),
        (
            "let a = own.speed < 2 [1/s]",
            "1:9-1:28 `own.speed` is in m/s, `2 [1/s]` is in 1/s: they cannot be compared",
        ),
        (
            "let a = min(own.speed, time)",
            "1:13-1:28 `own.speed` is in m/s, `time` is in s: they cannot be compared",
        ),
        ("let a = sin(leader.distance)", "1:13-1:28 `sin` takes a number, `leader.distance` is in m"),
        ("let a = wrap(time)", "1:14-1:18 `wrap` takes a number, `time` is in s"),
        ("let a = 2 ^ time", "1:13-1:17 an exponent is a number, `time` is in s"),
        (
            "parameter n = 2 in 1 .. 3\nlet a = time ^ n",
            "2:9-2:17 `time` is in s: its exponent has to be written out as a number",
        ),
        ("let a = time ^ 0.1", "1:9-1:19 the powers of this unit are too large, or have no place in a unit"),
        ("let a = time ^ 101", "1:9-1:19 the powers of this unit are too large, or have no place in a unit"),
        (
            "let a = (time ^ 99) * time * time",
            "1:9-1:34 the powers of this unit are too large, or have no place in a unit",
        ),
        (
            "let a = if time > 0 { 1 [m] } else { 1 }",
            "1:9-1:41 the first branch is in m, the other is a number: they need the same unit",
        ),
        (
            "let total = 0\ntotal = total + time",
            "2:9-2:21 `total` is a number, `time` is in s: they cannot be added",
        ),
        (
            "let total = 0\ntotal = time",
            "2:9-2:13 `total` is a number, `time` is in s; if `total` starts at a plain number, give that a unit: `0 [s]`",
        ),
        ("let a = 1 [m]\na = (1 [m], 2)", "2:5-2:15 `a` is in m, `(1 [m], 2)` is a vector in (m, -)"),
        ("memory s = 1 [m]\ns' = 1 [m]", "2:6-2:11 `s'` is in m/s, `1 [m]` is in m"),
        (
            "memory s = 0\ns' = leader.distance",
            "2:6-2:21 `s'` is in 1/s, `leader.distance` is in m; with this derivative, `s` starts at a number in m·s, such as `0 [m·s]`",
        ),
        (
            "memory s = 0\ns' = leader.output",
            "2:6-2:19 `s` is a number, so `leader.output` cannot be its derivative: it is a vector in (m, rad)",
        ),
        (
            "let a = leader.output + 1",
            "1:9-1:26 `leader.output` is a vector in (m, rad), `1` is a number: they cannot be added; for both components write `(1, 1)`",
        ),
        (
            "let a = leader.output + wanted.rates",
            "1:9-1:37 `leader.output` is a vector in (m, rad), `wanted.rates` is a vector in (m/s, rad/s): they cannot be added",
        ),
        ("let a = 1 / leader.output", "1:9-1:26 a number cannot be divided by a vector"),
        (
            "let a = leader.output < leader.output",
            "1:9-1:38 vectors cannot be compared: compare `.x` and `.y`, or their `length(…)`",
        ),
        (
            "let a = length(leader.output)",
            "1:16-1:29 `length` takes a vector in one unit, `leader.output` is a vector in (m, rad)",
        ),
        ("let a = length(time)", "1:16-1:20 `length` takes a vector, `time` is in s"),
        ("let a = rotate((1, 2), time)", "1:24-1:28 `rotate` takes an angle, `time` is in s"),
        (
            "let a = dot(leader.output, (1, 2))",
            "1:9-1:35 the products of the components differ: the first is in m, the other is an angle (rad)",
        ),
        (
            "let a = (leader.output, 1)",
            "1:10-1:23 `leader.output` is a vector in (m, rad): this should be a number",
        ),
        ("let a = true + 1", "1:9-1:13 `true` is a condition: this should be a number"),
        ("let a = 2 * (1 > 0)", "1:13-1:20 `(1 > 0)` is a condition: this should be a number"),
        (
            "let a = if 1 { 2 } else { 3 }",
            "1:12-1:13 `1` is a number: this should be a condition, such as `x > 0`",
        ),
        ("let a = 1 and true", "1:9-1:10 `1` is a number: this should be a condition, such as `x > 0`"),
        (
            "let a = noise(0.5)",
            "1:15-1:18 `noise` takes a whole number or the counter of a loop, `noise(1)`, not `0.5`",
        ),
        (
            "let a = noise(time)",
            "1:15-1:19 `noise` takes a whole number or the counter of a loop, `noise(1)`, not `time`",
        ),
        (
            "function f(x) = x + 1 [m]\nlet a = f(1 [m])\nlet b = f(1 [s])",
            "1:17-1:26 `x` is in s, `1 [m]` is in m: they cannot be added (in `f` as it is called in line 3)",
        ),
        ("memory s = true", "1:12-1:16 `true` is a condition: memory holds numbers, such as 0 and 1"),
        ("let a = leader.distance.x", "1:9-1:26 `leader.distance` is in m: only a vector has `.x`"),
        (
            "let a = leader.output.z",
            "1:9-1:24 `leader.output` is a vector in (m, rad): there is no `.z`, a vector has `.x` and `.y`",
        ),
    ] {
        assert_eq!(mistakes_of(text), [mistake], "{text}");
    }
}

#[test]
fn commands_are_checked() {
    for (text, mistake) in [
        (
            "command = own.speed, 0",
            "1:11-1:20 the command asks for an acceleration in m/s², `own.speed` is in m/s",
        ),
        ("command = 0, 1 [m]", "1:14-1:19 the command asks for a turn rate in rad/s, `1 [m]` is in m"),
        ("command = (0, 1)", "1:11-1:17 the command asks for a turn rate in rad/s, `(0, 1)`.y is a number"),
        ("command = 0", "1:11-1:12 the command has two parts: `command = acceleration, turn_rate`"),
        ("command = true, 0", "1:11-1:15 `true` is a condition: this should be a number"),
        ("let a = 1", "1:10-1:10 a law ends with what it asks for: `command = acceleration, turn_rate`"),
        ("", "1:1-1:1 a law ends with what it asks for: `command = acceleration, turn_rate`"),
        ("command = 0, 0\nlet a = 1", "2:1-2:4 nothing comes behind `command`, which is the last line"),
        ("command = 0, 0\ncommand = 0, 0", "2:1-2:8 nothing comes behind `command`, which is the last line"),
        ("if true { command = 0, 0 }\ncommand = 0, 0", "1:11-1:18 `command` stands outside of all braces"),
    ] {
        assert_eq!(mistakes(text), [mistake], "{text}");
    }
    assert_eq!(mistakes("command = (1 [m/s^2], 1 [rad/s])"), [""; 0]);
}

#[test]
fn unknown_names_are_followed_by_those_that_may_be_meant() {
    for (text, mistake) in [
        (
            "let a = leader.distanse",
            "1:9-1:24 there is no `leader.distanse`; did you mean `leader.distance`?",
        ),
        (
            "let a = leader.turnrate",
            "1:9-1:24 there is no `leader.turnrate`; did you mean `leader.turn_rate`?",
        ),
        ("let a = leder.distance", "1:9-1:23 nothing is called `leder`; did you mean `leader.distance`?"),
        ("let a = waned.baering", "1:9-1:22 nothing is called `waned`; did you mean `wanted.bearing`?"),
        (
            "leaders 2\nlet a = leder2.bearing",
            "2:9-2:23 nothing is called `leder2`; did you mean `leader2.bearing`?",
        ),
        ("let a = qqq.x", "1:9-1:12 nothing is called `qqq`"),
        ("let gain = 5\nlet a = gian * 2", "2:9-2:13 nothing is called `gian`; did you mean `gain`?"),
        ("let a = zzz", "1:9-1:12 nothing is called `zzz`"),
        (
            "let a = leader",
            "1:9-1:15 `leader` alone is no number: write what of it, such as `leader.distance`",
        ),
        ("let a = sin", "1:9-1:12 `sin` is a function: write `sin(…)`"),
        ("let a = sqr(2)", "1:9-1:12 there is no function `sqr`: a square is written `x ^ 2`"),
        ("let a = log(2)", "1:9-1:12 there is no function `log`: the natural logarithm is `ln(x)`"),
        ("let a = coss(2)", "1:9-1:13 there is no function `coss`; did you mean `cos`?"),
        ("let a = cosh(2)", "1:9-1:13 there is no function `cosh`: write `(exp(x) + exp(-x)) / 2`"),
        ("let e = (1, 2)\nlet a = e(1)", "2:9-2:10 `e` is a vector: its components are `e.x` and `e.y`"),
        ("let k = 2\nlet a = k(1 + 2)", "2:9-2:10 `k` is no function: to multiply, write `k * (…)`"),
        ("let a = now()", "1:9-1:12 there is no function `now`"),
        ("let a = sin(1, 2)", "1:9-1:18 `sin` takes one argument, here are 2"),
        ("let a = min(1)", "1:9-1:15 `min` takes 2 arguments, here are 1"),
        ("let a = b\nlet b = 1", "1:9-1:10 `b` is defined further down, in line 2"),
        (
            "let b = 1\nfunction f(x) = x + b\nlet a = f(1)",
            "2:21-2:22 a function does not see `b`: hand it over as an argument (in `f` as it is called in line 3)",
        ),
        (
            "memory m = b\nlet b = 1",
            "1:12-1:13 `b` is computed at every sample: a start may use inputs, parameters and functions",
        ),
        (
            "memory m = n\nmemory n = 1",
            "1:12-1:13 `n` is declared further down: a start may use the memory above it",
        ),
        ("let a = leader2.distance", "1:9-1:25 this law has one leader: for `leader2`, write `leaders 2`"),
        (
            "leaders 2\nlet a = leader.distance",
            "2:9-2:24 this law has 2 leaders: write which, `leader1.distance`",
        ),
        (
            "leaders 2\nlet a = wanted3.distance",
            "2:9-2:25 this law has 2 leaders: for `wanted3`, write `leaders 3`",
        ),
        (
            "leaders 2\nlet a = leader5.distance",
            "2:9-2:25 there is no `leader5`: leaders count from 1 to 4 at most",
        ),
        (
            "leaders 2\nlet a = leader1.distanc",
            "2:9-2:24 there is no `leader1.distanc`; did you mean `leader1.distance`?",
        ),
        (
            "let a = leader.speed",
            "1:9-1:21 only a law that knows the motion of its leader can read `leader.speed`: add the line `knows motion`",
        ),
        (
            "knows rates\nlet a = frame.turn_rate",
            "2:9-2:24 only a law that knows the motion of its leader can read `frame.turn_rate`: write `knows motion` in place of `knows rates`",
        ),
        ("let a = own2.speed", "1:9-1:13 `own2` has no number: write `own.speed`"),
        ("tota = 1", "1:1-1:5 `tota` is not defined here: write `let tota = …`"),
        (
            "let total = 1\ntotl = 1",
            "2:1-2:5 `totl` is not defined here: write `let totl = …`; did you mean `total`?",
        ),
    ] {
        assert_eq!(mistakes_of(text), [mistake], "{text}");
    }
}

#[test]
fn what_may_not_be_set_is_said() {
    for (text, mistake) in [
        ("parameter k = 1 in 0 .. 2\nk = 2", "2:1-2:2 `k` is a parameter: a law cannot set it"),
        ("repeat 3 as i { i = 2 }", "1:17-1:18 `i` counts the rounds: it cannot be set"),
        (
            "function f(x) { x = 2; x }\nlet a = f(1)",
            "1:17-1:18 `x` is an argument: name a new value by `let` (in `f` as it is called in line 2)",
        ),
        (
            "let a = 1\nlet b = if true { a = 2; 1 } else { 2 }",
            "2:19-2:20 `a` is defined outside of this value, which may not change it: use `if` as a statement",
        ),
        (
            "memory m = 1\nlet b = if true { m = 2; 1 } else { 2 }",
            "2:19-2:20 `m` is memory: a value or a function may not set it",
        ),
        (
            "memory m = 1\nm = 2\nm' = 1 [1/s]",
            "3:1-3:2 `m` is set and has a derivative: it can only have one of the two",
        ),
        (
            "memory m = 1\nm' = 1 [1/s]\nif true { m = 2 }",
            "3:11-3:12 `m` is set and has a derivative: it can only have one of the two",
        ),
        ("memory m = 1\nm' = 1 [1/s]\nm' = 2 [1/s]", "3:1-3:2 `m'` is there twice"),
        (
            "memory m = 1\nif true { m' = 1 [1/s] }",
            "2:11-2:12 `m'` stands outside of all braces: write `m' = if … { … } else { … }`",
        ),
        ("let m = 1\nm' = 1", "2:1-2:2 only memory has a derivative: write `memory m = …`"),
        (
            "let a = 1\nlet a = 2",
            "2:5-2:6 `a` is defined already, in line 1; to change it, write `a = …` without `let`",
        ),
        (
            "let a = 1\nif true { let a = 2 }",
            "2:15-2:16 `a` is defined already, in line 1; to change it, write `a = …` without `let`",
        ),
        (
            "parameter a = 1 in 0 .. 2\nlet a = 2",
            "2:5-2:6 `a` is a parameter, in line 1: choose another name",
        ),
        ("parameter a = 1 in 0 .. 2\nmemory a = 2", "2:8-2:9 `a` is defined already, in line 1"),
        ("function f(x) = x\nfunction f(y) = y", "2:10-2:11 `f` is defined already, in line 1"),
        ("let time = 1", "1:5-1:9 `time` is what the law is told: choose another name"),
        ("let leader = 1", "1:5-1:11 `leader` is what the law is told: choose another name"),
        ("let if = 1", "1:5-1:7 `if` is a word of the language: choose another name"),
        ("let e = (1, 2)\ne.x = 3", "2:1-2:2 `x` of `e` cannot be set alone: set both, `e = (…, …)`"),
        ("let a = 1\na += 1", "2:1-2:2 write `a = a + …`"),
    ] {
        assert_eq!(mistakes_of(text), [mistake], "{text}");
    }
}

#[test]
fn what_cannot_be_read_is_said() {
    for (text, mistake) in [
        ("let b = 2 *", "2:1-2:8 here should stand a value, not `command`"),
        ("let b = ", "2:1-2:8 here should stand a value, not `command`"),
        ("let b = 2 3", "1:11-1:12 the statement should end here, with the line or `;`, not go on with `3`"),
        ("let b = 2 // two", "1:12-1:13 here should stand a value, not `/`; comments begin with `#`"),
        ("parameter k = 5 in [1, 9]", "1:20-1:26 a range is written `0.1 .. 20`"),
        ("let b 2", "1:7-1:8 here should stand `=`, not `2`"),
        ("let 2 = 2", "1:5-1:6 here should stand a name, not `2`"),
        ("let b = (1 + 2", "1:15-1:15 here should stand `)`, not the end of the line"),
        ("let b = (1, 2, 3)", "1:14-1:15 a vector has two components"),
        (
            "let b = 2k",
            "1:9-1:11 a number and a name need a sign between them, such as `2 * k`; a unit stands in brackets, `2 [k]`",
        ),
        (
            "let b = 1 [k\u{1}]",
            "1:11-1:15 there is no unit `k`; there are m, s, rad, deg, °, km, cm, mm, h, min, ms, and `-` for a number",
        ),
        ("let b = [\u{1}]", "1:9-1:12 a unit stands behind a number: `1 [m]`"),
        (
            "let b = 1 [\u{1}]",
            "1:11-1:14 there is no unit `\u{fffd}`; there are m, s, rad, deg, °, km, cm, mm, h, min, ms, and `-` for a number",
        ),
        (
            "let bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb = 1",
            "1:5-1:66 this name is too long: 60 characters are enough",
        ),
        ("let b = 1e999", "1:9-1:14 this number is too large"),
        (
            "let b = 1 [kg]",
            "1:11-1:15 there is no unit `kg`; there are m, s, rad, deg, °, km, cm, mm, h, min, ms, and `-` for a number",
        ),
        ("let b = 1 [m", "1:11-1:12 the `]` behind the unit is missing"),
        ("let b = [m]", "1:9-1:12 a unit stands behind a number: `1 [m]`"),
        ("let b = time [m]", "1:14-1:17 `[m]` does not belong here: a unit stands behind a number"),
        ("let b = 1 $ 2", "1:11-1:12 `$` has no meaning here"),
        ("let b = 2 ** 3", "1:11-1:13 write `^`"),
        ("let b = true && false", "1:14-1:16 write `and`"),
        ("let b = true || false", "1:14-1:16 write `or`"),
        ("let b = !true", "1:9-1:10 write `not`"),
        ("let b = 1 < 2 < 3", "1:15-1:16 join two comparisons by `and`, with `2` in both"),
        ("let b = if 1 = 2 { 1 } else { 2 }", "1:14-1:15 to compare, write `==`"),
        ("let b = if true { 1 }", "1:9-1:22 an `if` that is a value needs an `else { … }`"),
        (
            "let b = if true { let c = 1 } else { 2 }",
            "1:17-1:30 this block needs a value: its last line should be one",
        ),
        (
            "let b = if true { 1\n2 } else { 2 }",
            "1:19-1:20 this value is not used: only the last line of a block is its value",
        ),
        ("if true { 1 }", "1:11-1:12 this value is not used: set something, `x = …`"),
        ("2 + 2", "1:1-1:6 this value is not used: name it, `let x = …`"),
        ("time", "1:1-1:5 this value is not used: name it, `let x = …`"),
        ("if true { let a = 1", "1:9-1:10 the `}` for this is missing"),
        ("}", "1:1-1:2 this closes nothing"),
        ("while true { }", "1:1-1:6 loops are counted: `repeat 10 as i { … }`"),
        ("for i in 10 { }", "1:1-1:4 loops are counted: `repeat 10 as i { … }`"),
        ("return 5", "1:1-1:7 the value of a function is its last line, without a word before it"),
        (
            "repeat 0 { }",
            "1:8-1:9 here should stand how often to repeat, a number from 1 to 10000 that is written out, not `0`",
        ),
        (
            "parameter n = 3 in 1 .. 5\nrepeat n { }",
            "2:8-2:9 here should stand how often to repeat, a number from 1 to 10000 that is written out, not `n`",
        ),
        ("leaders 5", "1:9-1:10 here should stand how many leaders there are, 1 to 4, not `5`"),
        ("leaders 1\nleaders 1", "2:1-2:8 the number of leaders is said twice"),
        ("knows rates\nknows motion", "2:1-2:6 what the law knows is said twice"),
        ("knows everything", "1:7-1:17 here should stand `rates` or `motion`, not `everything`"),
        ("parameter k = 5", "1:11-1:12 a parameter has a range for its slider: `in 0.1 .. 20`"),
        ("parameter k = 5 in 6 .. 9", "1:15-1:16 5 is not in the range 6 .. 9"),
        ("parameter k = 5 in 9 .. 1", "1:20-1:26 the range should go from the smaller to the larger value"),
        ("parameter k = 5 in 0 .. 9 log", "1:20-1:26 a range with `log` begins above 0"),
        ("parameter k = x in 0 .. 9", "1:15-1:16 here should stand a number, not `x`"),
        (
            "parameter k = 5 [m] in 0 .. 9 [s]",
            "1:24-1:34 the range is in the unit of the parameter: leave its unit out",
        ),
        ("parameter k = 5 in 0 .. 9 \"open", "1:27-1:32 the second `\"` is missing"),
        ("parameter k = 5 in 0 .. 9 symbol k", "1:34-1:35 here should stand the symbol in quotes, not `k`"),
        ("function f(x, x) = x", "1:15-1:16 `x` is there twice"),
        ("function f(x) x", "1:15-1:16 here should stand `=` or `{`, not `x`"),
        (
            "function f(x) = f(x)\nlet a = f(1)",
            "1:17-1:21 `f` calls itself: a law has to end (in `f` as it is called in line 2)",
        ),
        (
            "function f(x) = g(x)\nfunction g(x) = f(x)\nlet a = f(1)",
            "2:17-2:21 `f` calls itself: a law has to end (in `f` as it is called in line 3)",
        ),
        (
            "let a = b' + 1",
            "1:10-1:11 a derivative stands on the left of `=`; name its value by `let` to use it twice",
        ),
        ("let a = { 1 }", "1:9-1:10 braces stand behind `if`, `else`, `repeat` and `function f(x)`"),
        ("if true { memory m = 1 }", "1:11-1:17 `memory` stands outside of all braces"),
        ("% comment", "1:1-1:2 `%` has no meaning here: comments begin with `#`"),
    ] {
        let found = mistakes_of(text);
        assert_eq!(found.first().map(String::as_str), Some(mistake), "{text}: {found:#?}");
    }
}

#[test]
fn several_mistakes_are_reported_at_once_and_in_order() {
    let text = "let a = leader.distanc\nlet b = a + 1\nlet c = time + own.speed\nlet d = 2 *\nlet e = d + sin(1 [m])\n\
                function f(x) = x + 1 [m]\nlet g = f(2)\ncommand = time, 0";
    let places: Vec<String> =
        mistakes(text).iter().map(|line| line.split('-').next().unwrap_or("").to_owned()).collect();
    // What follows from a mistake, as in lines 2 and 5, is not one.
    assert_eq!(places, ["1:9", "3:9", "5:1", "6:17", "8:11"]);
    let many = "let a = b\n".repeat(100);
    assert_eq!(mistakes(&many).len(), 20);
}

// Totality.

#[test]
fn what_is_too_large_is_one_mistake() {
    let nested = |count: usize| format!("let a = {}1{}", "(".repeat(count), ")".repeat(count));
    assert_eq!(mistakes_of(&nested(60)), [""; 0]);
    assert_eq!(mistakes_of(&nested(100)), ["1:73-1:74 this is nested too deeply: there may be 64 levels"]);
    assert_eq!(mistakes_of(&nested(20_000)), ["1:73-1:74 this is nested too deeply: there may be 64 levels"]);
    assert_eq!(mistakes_of(&format!("let a = {}1", "-".repeat(50_000))).len(), 1);
    assert_eq!(mistakes_of(&format!("let a = 2{}", "^2".repeat(20_000))).len(), 1);
    assert_eq!(
        mistakes_of(&format!("let a = {}1 {}", "if true { ".repeat(500), "} else { 1 }".repeat(500))).len(),
        1
    );
    assert_eq!(mistakes_of(&"repeat 2 { ".repeat(5000)).len(), 1);
    // A long sum is not deep.
    assert_eq!(mistakes_of(&format!("let a = time{}", " + time".repeat(9000))), [""; 0]);
    let large = "1:1-1:1 this law is too large: it may have 20000 instructions, functions written out, and hold 4096 numbers";
    let sines = format!("let a = time / 1 [s]{}", " + sin(time / 2 [s])".repeat(4900));
    assert_eq!(mistakes_of(&sines), [""; 0]);
    let sines = format!("let a = time / 1 [s]{}", " + sin(cos(time / 2 [s]))".repeat(4990));
    assert_eq!(mistakes_of(&sines).len(), 1, "{:?}", mistakes_of(&sines));
    let lets =
        |count: usize| -> Vec<String> { (0..count).map(|k| format!("let a{k} = time * time\n")).collect() };
    assert_eq!(mistakes_of(&lets(4000).concat()), [""; 0]);
    assert_eq!(mistakes_of(&lets(4200).concat()), [large]);
    assert_eq!(
        mistakes_of("let a = 0 [s]\nrepeat 1000 { repeat 1000 { a = a + time } }"),
        [
            "2:1-2:12 this law takes too long: a sample may take 200000 instructions, and this could take 2002002; \
             the loop in line 2 is most of it"
        ]
    );
    assert_eq!(mistakes_of("let a = 0 [s]\nrepeat 10000 { repeat 8 { a = a + time } }"), [""; 0]);
    assert_eq!(
        mistakes(&"#".repeat(100_001)),
        ["1:1-1:1 this text is too long for a law: 100000 bytes are enough"]
    );
}

/// Doubling functions write out 2^30 calls, with or without instructions.
#[test]
fn functions_that_double_are_refused_in_time() {
    for last in ["x * x", "1"] {
        let mut text = format!("function f0(x) = {last}\n");
        for k in 1..=30 {
            let before = k - 1;
            text = format!("{text}function f{k}(x) = f{before}(x) + f{before}(x)\n");
        }
        let found = mistakes_of(&format!("{text}let a = f30(time)"));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("too large"), "{found:?}");
        assert!(found[0].starts_with("32:9-32:18 "), "{found:?}");
        assert!(found[0].ends_with("; the call of `f30` in line 32 is most of it"), "{found:?}");
    }
}

#[test]
fn the_cost_is_counted_by_the_dearer_branch() {
    let count = |text: &str| compiled(&format!("{text}\ncommand = 0, 0")).instructions();
    assert_eq!(count("let a = time * time"), 1);
    assert_eq!(count("let a = 0 [s]\nrepeat 10 { a = a + time }"), 2 + 10 * 2);
    let both = count("let a = time\nif a > 0 { a = sin(1 * cos(2 * a / 1 [s])) * 1 [s] } else { a = 2 * a }");
    let dear = count("let a = time\nif a > 0 { a = sin(1 * cos(2 * a / 1 [s])) * 1 [s] }");
    assert_eq!(both, dear + 1);
}

// Faults.

#[test]
fn faults_are_found_where_they_arise() {
    let command = "\ncommand = a * 1 [m/s^2], 0";
    for (text, message) in [
        (
            "let z = leader.distance - 2 [m]\nlet b = 1 [m] / z\nlet a = 2 * b",
            "2:9: `1 [m] / z` is infinite: 1 divided by 0, in `b`",
        ),
        (
            "let z = leader.distance - 2 [m]\nlet a = z / z",
            "2:9: `z / z` is not a number: 0 divided by 0, in `a`",
        ),
        (
            "let a = sqrt(own.acceleration / 1 [m/s^2])",
            "1:9: `sqrt(own.acceleration / 1 [m/s^2])` is not a number: the square root of -0.5, in `a`",
        ),
        (
            "let a = ln(own.acceleration / 1 [m/s^2])",
            "1:9: `ln(own.acceleration / 1 [m/s^2])` is not a number: the logarithm of -0.5, in `a`",
        ),
        (
            "let a = acos(leader.distance / 1 [m])",
            "1:9: `acos(leader.distance / 1 [m])` is not a number: the arc cosine of 2, in `a`",
        ),
        (
            "let b = exp(1000 * time / 1 [s])\nlet a = b",
            "1:9: `exp(1000 * time / 1 [s])` is infinite: the exponential of 1500, in `b`",
        ),
        // An infinite number that does no harm is not what is to blame.
        (
            "let z = leader.distance - 2 [m]\nlet c = atan(1 [m] / z)\nlet a = c / (z / 1 [m])",
            "3:9: `c / (z / 1 [m])` is infinite: 1.5707963267948966 divided by 0, in `a`",
        ),
        ("let a = 1\nrepeat 9 { a = a * 1e40 }", "2:16: `a * 1e40` is infinite: beyond all numbers, in `a`"),
        (
            "function f(x) = 1 / x\nlet a = f(leader.distance / 1 [m] - 2)",
            "1:17: `1 / x` is infinite: 1 divided by 0, in `a`",
        ),
        (
            "memory m = 0\nm = 1 / (time / 1 [s] - 1.5)\nlet a = 0",
            "2:5: `1 / (time / 1 [s] - 1.5)` is infinite: 1 divided by 0, in `m`",
        ),
        (
            "memory m = 1\nm' = m / (time - 1.5 [s])\nlet a = 0",
            "2:6: `m / (time - 1.5 [s])` is infinite: 1 divided by 0, in the derivative of `m`",
        ),
        ("memory m = 1.79e308\nm' = 1.7e308 [1/s]\nlet a = 0", "1:8: `m` grows beyond all numbers"),
        (
            "memory m = 1 / (time / 1 [s] - 1.5)\nlet a = 0",
            "1:12: `1 / (time / 1 [s] - 1.5)` is infinite: 1 divided by 0, in the start of `m`",
        ),
    ] {
        assert_eq!(fault(&format!("{text}{command}")), message, "{text}");
    }
    assert_eq!(
        fault("command = 1 [m^2/s^2] / (leader.distance - 2 [m]), 0"),
        "1:11: `1 [m^2/s^2] / (leader.distance - 2 [m])` is infinite: 1 divided by 0, in the command"
    );
}

#[test]
fn what_a_law_is_told_may_be_at_fault() {
    let law = compiled(
        "parameter k = 1 [1/s^2] in 0 .. 2\nmemory m = 0\ncommand = k * leader.distance + m * 0 [m/s^2], 0",
    );
    let mut leaders = leaders();
    let decide = |leaders: &[LeaderInput], k: f64, m: f64| {
        let mut memory = [m];
        let decided = law.decide(&input(leaders), &[k], &mut memory, &mut []);
        assert!(decided.is_ok() || memory[0].to_bits() == m.to_bits());
        decided.map_err(|fault| fault.to_string())
    };
    assert!(decide(&leaders, 1.0, 0.0).is_ok());
    assert_eq!(decide(&leaders, f64::INFINITY, 0.0), Err("1:11: the parameter `k` is infinite".to_owned()));
    assert_eq!(decide(&leaders, 1.0, f64::NAN), Err("2:8: `m` is not a number".to_owned()));
    leaders[0].relative.distance = f64::NAN;
    assert_eq!(
        decide(&leaders, 1.0, 0.0),
        Err("3:15: what the law is told is not a number: `leader.distance`".to_owned())
    );
    let start = compiled("memory m = leader.distance\ncommand = 0, 0");
    let fault = start.start(&input(&leaders), &[], &mut [0.0]).map_err(|fault| fault.to_string());
    assert_eq!(fault, Err("1:12: what the law is told is not a number: `leader.distance`".to_owned()));
}

// The page.

#[test]
fn the_page_of_the_language_is_true() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/law-files.md");
    let page = std::fs::read_to_string(path).expect("a page");
    let mut table = String::new();
    for (_, name, unit, help) in crate::INPUTS {
        table = format!("{table}| `{name}` | {unit} | {help} |\n");
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    let mut table = String::new();
    for builtin in super::builtin::BUILTINS {
        table = format!("{table}| `{}` | {} |\n", builtin.name, builtin.help);
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    let mut table = String::new();
    let mut counts = vec![];
    for law in crate::SHIPPED_LAWS {
        let compiled = compiled(law.text);
        let name = law.name;
        table = format!("{table}| [`{name}`](../laws/{name}.law) | {} |\n", compiled.declaration().title);
        counts.push(compiled.instructions());
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    counts.sort_unstable();
    let [least, .., most, predictive] = counts[..] else { panic!("{counts:?}") };
    let words = page.replace('\n', " ");
    let count = format!("the shipped laws take {least} to {most}, `predictive` {predictive}.");
    assert!(words.contains(&count), "the page should say: {count}");
    let laws: Vec<&str> =
        page.split("```law\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!laws.is_empty());
    for law in laws {
        compiled(law);
    }
    let wrong = mistakes_of("\n\nlet e = wanted.distance - leader.bearing\nlet d = leader.distanse");
    let shown = wrong.iter().map(|mistake| {
        let (place, rest) = mistake.split_once('-').expect("a stretch");
        format!("{place}: {}", rest.split_once(' ').expect("a message").1)
    });
    let at_fault = fault(
        "\n\n\n\nlet e = (leader.distance / 4, 0)\nlet speed = own.speed - 0.75 [m/s]\nlet b = e.x / speed\ncommand = b * 1 [m/s^3], 0",
    );
    for line in shown.chain([at_fault]) {
        assert!(page.lines().any(|there| there == line), "the page should show: {line}");
    }
}

// Any text.

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
