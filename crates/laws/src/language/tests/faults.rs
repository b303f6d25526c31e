//! What is said of numbers that go wrong in a sample.

use super::{compiled, fault, input, leaders};
use crate::{CustomLaw, LeaderInput};

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
