//! What is said of texts that mean nothing.

use super::{mistakes, mistakes_of};

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
