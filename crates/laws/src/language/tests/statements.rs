//! What statements do, and what a text declares.

use super::{compiled, input, leaders, mistakes_of, run, shown};
use crate::{CustomLaw, Knowledge, Noise, Scale, Unit};
use std::f64::consts::PI;

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
