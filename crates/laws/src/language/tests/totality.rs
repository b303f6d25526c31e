//! Every law ends: what is too large is refused.

use super::{compiled, mistakes, mistakes_of};

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
