//! Laws as WebAssembly modules: those made from C, Rust and Zig against the same laws as law files, and modules that are wrong,
//! that break off, or that would go on for ever.

use laws::{CustomLaw, Fault, INPUTS, Input, LEADERS_MAX, LawFile, LeaderInput, Noise, WasmLaw, shipped};
use std::path::Path;
use vocabulary::{Command, MotionInput, Relative, SetPoint, math};

const C: &[u8] = include_bytes!("modules/output_feedback.wasm");
const RUST: &[u8] = include_bytes!("modules/integral.wasm");
const ZIG: &[u8] = include_bytes!("modules/pursuit.wasm");
const COUNTER: &str = include_str!("modules/counter.wat");

/// What a leader is in sample `k`: every number another.
fn seen(k: usize) -> LeaderInput {
    let t = k as f64 * 0.1;
    LeaderInput {
        relative: Relative {
            distance: 2.0 + 0.3 * math::sin(0.7 * t),
            bearing: -2.3 + 0.2 * math::cos(0.5 * t),
            view_angle: -2.2 + 0.4 * math::sin(0.3 * t),
        },
        rates: [0.1 * math::cos(t), 0.2 * math::sin(t)],
        wanted: SetPoint { value: [2.0, 3.0], rate: [0.01, 0.02], acceleration: [0.03, 0.04] },
        motion: MotionInput { speed: 1.0, acceleration: 0.05, turn_rate: 0.06, turn_acceleration: 0.07 },
        frame: [0.08, 0.09],
        heading: 0.11,
    }
}

fn input(leaders: &[LeaderInput], k: usize) -> Input<'_> {
    Input {
        time: k as f64 * 0.1,
        period: 0.1,
        own_speed: 1.2,
        own_acceleration: 0.3,
        own_turn_rate: -0.4,
        leaders,
        noise: Noise { seed: 3, robot: 2, sample: k as u64 },
    }
}

fn defaults(law: &dyn CustomLaw) -> Vec<f64> {
    law.declaration().parameters.iter().map(|own| own.default).collect()
}

/// What two laws decide in a hundred samples, with the memory of the first one applied in between.
fn assert_same(module: &[u8], text: &str) {
    let module = WasmLaw::new(module).expect("a module");
    let text = LawFile::compile(text).expect("a law");
    assert_eq!(defaults(&module), defaults(&text));
    let (one, other) = (module.declaration(), text.declaration());
    let ranges = |own: &laws::Declaration| -> Vec<_> {
        own.parameters
            .iter()
            .map(|own| (own.name.clone(), own.unit, own.range, own.scale, own.help.clone()))
            .collect()
    };
    assert_eq!((one.leaders, one.knows, ranges(one)), (other.leaders, other.knows, ranges(other)));
    let parameters = defaults(&module);
    let mut memories = [vec![0.0; one.memory.len()], vec![0.0; other.memory.len()]];
    let mut shown = [vec![0.0; one.shown.len()], vec![0.0; other.shown.len()]];
    let mut applied = Command { acceleration: 0.0, turn_rate: 0.0 };
    for k in 0..100 {
        let leaders = [seen(k)];
        let told = Input {
            own_acceleration: applied.acceleration,
            own_turn_rate: applied.turn_rate,
            ..input(&leaders, k)
        };
        if k == 0 {
            module.start(&told, &parameters, &mut memories[0]).expect("a start");
            text.start(&told, &parameters, &mut memories[1]).expect("a start");
        }
        let a = module.decide(&told, &parameters, &mut memories[0], &mut shown[0]).expect("a command");
        let b = text.decide(&told, &parameters, &mut memories[1], &mut shown[1]).expect("a command");
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs().max(1.0);
        assert!(near(a.acceleration, b.acceleration) && near(a.turn_rate, b.turn_rate), "{k}: {a:?} {b:?}");
        assert!(memories[0].iter().zip(&memories[1]).all(|(a, b)| near(*a, *b)), "{k}: {memories:?}");
        applied = a;
    }
}

#[test]
fn laws_from_c_rust_and_zig_decide_what_law_files_decide() {
    assert_same(C, shipped("output-feedback").expect("shipped").text);
    assert_same(RUST, shipped("integral").expect("shipped").text);
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/law-files.md"));
    let page = page.expect("a page");
    let block = page.split("```law\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a law");
    assert_same(ZIG, block);
}

/// A module with the exports of a law, of which `decide` does what is said; `more` stands behind them.
fn module(decide: &str, more: &str) -> String {
    format!(
        r#"(module
            (import "env" "noise" (func $noise (param i32) (result f64)))
            (memory (export "memory") 1)
            (data (i32.const 0) "{{\"memory\": [{{\"name\": \"m\"}}], \"shown\": [{{\"name\": \"s\"}}]}}\00")
            (func (export "declaration") (result i32) (i32.const 0))
            (func (export "region") (result i32) (i32.const 8192))
            (func $decide (export "decide") (param $told i32) (param $own i32) (param $memory i32) (param $shown i32)
                (param $command i32)
                (f64.store (local.get $shown) (f64.const 0))
                (f64.store (local.get $command) (f64.const 0))
                (f64.store (i32.add (local.get $command) (i32.const 8)) (f64.const 0))
                {decide})
            {more})"#
    )
}

fn read(text: &str) -> Result<WasmLaw, Vec<String>> {
    WasmLaw::new(&wat::parse_str(text).expect("a text of WebAssembly"))
}

fn decided(text: &str) -> Result<Command, Fault> {
    let law = read(text).expect("a law");
    let parameters = defaults(&law);
    let (mut memory, mut shown) = ([0.0], [0.0]);
    law.decide(&input(&[seen(0)], 0), &parameters, &mut memory, &mut shown)
}

/// Every number of the table of inputs stands at its place, for each leader.
#[test]
fn what_a_law_is_told_stands_in_the_order_of_the_table() {
    let leaders: Vec<LeaderInput> = (0..LEADERS_MAX).map(|k| seen(17 * k)).collect();
    let told = input(&leaders, 5);
    let text = module("", "")
        .replace("{\\\"memory\\\"", "{\\\"leaders\\\": 4, \\\"knows\\\": \\\"motion\\\", \\\"memory\\\"");
    let mut place = 0;
    for leader in 0..LEADERS_MAX {
        for (kind, name, ..) in INPUTS.iter().filter(|(kind, ..)| kind.is_per_leader() || leader == 0) {
            let echo = format!(
                "(f64.store (local.get $shown) (f64.load (i32.add (local.get $told) (i32.const {place}))))"
            );
            let law =
                read(&text.replace("(f64.store (local.get $shown) (f64.const 0))", &echo)).expect("a law");
            assert_eq!(law.declaration().leaders, LEADERS_MAX);
            let (mut memory, mut shown) = ([0.0], [0.0]);
            law.decide(&told, &[], &mut memory, &mut shown).expect("a command");
            assert_eq!(shown[0].to_bits(), told.value(leader, *kind).to_bits(), "{name} of leader {leader}");
            place += 8;
        }
    }
}

#[test]
fn only_the_declared_memory_lasts() {
    let law = read(COUNTER).expect("a law");
    let leaders = [seen(0)];
    let told = input(&leaders, 0);
    let (mut memory, mut shown) = ([0.0], [0.0]);
    law.start(&told, &[2.0], &mut memory).expect("a start");
    assert_eq!(memory, [10.0]);
    for n in 1..5 {
        let command = law.decide(&told, &[3.0], &mut memory, &mut shown).expect("a command");
        assert_eq!((memory, shown), ([10.0 + f64::from(n)], [2.0]), "globals and linear memory begin anew");
        assert_eq!(
            (command.acceleration, command.turn_rate),
            (3.0 * memory[0], leaders[0].relative.distance)
        );
    }
    let mut rates = [0.0];
    let command = law.derive(&told, &[0.5], &memory, &mut rates).expect("a command");
    assert!(law.declaration().continuous);
    assert_eq!((command.acceleration, rates, memory), (14.0, [0.5], [14.0]));
}

#[test]
fn noise_is_that_of_law_files() {
    let text = module("(f64.store (local.get $command) (call $noise (i32.const 7)))", "");
    let noise = input(&[], 0).noise;
    assert_eq!(decided(&text).expect("a command").acceleration.to_bits(), noise.normal(7).to_bits());
}

#[test]
fn what_breaks_off_says_why_and_the_law_goes_on_after_it() {
    let stores = |place: &str, number: &str| format!("(f64.store (local.get {place}) (f64.const {number}))");
    for (decide, more, words) in [
        ("(loop $again (br $again))", "", "out of fuel: it ran for more than 5000000 instructions"),
        ("unreachable", "", "`unreachable` was executed"),
        (
            "(loop $more (drop (memory.grow (i32.const 16))) (br $more))",
            "",
            "out of memory: it asked for more than 16 MiB",
        ),
        ("(drop (f64.load (i32.const -8)))", "", "it reached outside of its memory"),
        ("(call $deep)", "(func $deep (call $deep))", "its stack is full"),
        ("(drop (i32.div_s (i32.const 1) (i32.const 0)))", "", "divided a whole number by zero"),
        ("(drop (i32.trunc_f64_s (f64.const nan)))", "", "into a whole number"),
        ("(call_indirect (i32.const 0))", "(table 1 funcref)", "through a pointer that leads to none"),
        (&stores("$command", "nan"), "", "the acceleration is not a number"),
        (&stores("$memory", "inf"), "", "the memory `m` is infinite"),
        (&stores("$shown", "-inf"), "", "the shown `s` is infinite"),
    ] {
        let fault = decided(&module(decide, more)).expect_err(decide);
        assert!(fault.message.contains(words) && fault.place.is_none(), "{decide}: {fault}");
    }
    // A command that is not written is no command.
    let lazy =
        module("", "").replace("(f64.store (i32.add (local.get $command) (i32.const 8)) (f64.const 0))", "");
    assert_eq!(decided(&lazy).expect_err("no turn rate").message, "the turn rate is not a number");
    // The same law, after it has run out of fuel for one of its parameters.
    let text = COUNTER.replace("(f64.store (local.get $memory)", "(loop $again (br_if $again (f64.eq (f64.load (local.get $own)) (f64.const 9))))\n(f64.store (local.get $memory)");
    let law = read(&text).expect("a law");
    let (mut memory, mut shown) = ([0.0], [0.0]);
    for _ in 0..3 {
        let fuel = law.decide(&input(&[], 0), &[9.0], &mut memory, &mut shown).expect_err("no end");
        assert!(fuel.message.starts_with("out of fuel"), "{fuel}");
        memory = [1.0];
        law.decide(&input(&[], 0), &[1.0], &mut memory, &mut shown).expect("a command");
        assert_eq!(memory, [2.0]);
    }
}

#[test]
fn a_module_that_is_no_law_says_all_that_is_wrong_with_it() {
    let empty = "(module (import \"wasi_snapshot_preview1\" \"fd_write\" (func (param i32 i32 i32 i32) (result i32)))
        (import \"env\" \"atan3\" (func (param f64) (result f64))) (import \"env\" \"sin\" (func (param f32) (result f32)))
        (import \"env\" \"cos\" (global f64)) (func (export \"declaration\") (result i64) (i64.const 0)))";
    let good = module("", "");
    let derive = "(func (export \"derive\") (param i32 i32 i32 i32 i32))";
    let many: Vec<_> = (0..1000).map(|k| format!("{{\\\"name\\\": \\\"m{k}\\\"}},")).collect();
    let many = many.concat();
    // Text begins at address 0.
    let text_at = |address: &str| good.replacen("(i32.const 0))\n", &format!("(i32.const {address}))\n"), 1);
    let cases: [(String, &[&str]); 12] = [
        (
            empty.to_owned(),
            &[
                "it exports no `memory`",
                "it exports no function `decide`, (i32, i32, i32, i32, i32)",
                "it exports no function `region`, () -> i32",
                "it exports `declaration` as () -> i64: a law has () -> i32",
                "it imports `wasi_snapshot_preview1.fd_write`; a law computes alone: `env` has sin, cos",
                "it imports `env.atan3`; did you mean `atan`?",
                "it imports `env.sin` as (f32) -> f32, which is (f64) -> f64",
                "it imports `env.cos`, which is a function",
            ],
        ),
        (module("", derive), &["no noise in continuous time"]),
        (
            good.replace("(i32.const 8192)", "(i32.const 60000)"),
            &["`region` returns 60000: it must be", "1024 numbers"],
        ),
        (good.replace("(i32.const 8192)", "(i32.const 8191)"), &["a multiple of 8"]),
        (good.replace("(i32.const 8192)", "unreachable"), &["`region` failed: it broke off"]),
        (text_at("-1"), &["returns 4294967295: there is no text of at most 64000 bytes"]),
        (text_at("2"), &["its declaration is not JSON: expected value at line 1 column 1"]),
        (good.replace("\\\"s\\\"}", "\\\"m\\\"}"), &["`shown[0].name` `m` is taken"]),
        (good.replace("memory\\\": [", &format!("memory\\\": [{many}")), &["1027 numbers", "room for 1024"]),
        (good.replace("\"memory\") 1", "\"memory\") 300"), &["out of memory"]),
        (module("", "(table 10001 funcref)"), &["a table of more than 10000 entries"]),
        (module("", "(func $f (loop $l (br $l))) (start $f)"), &["out of fuel"]),
    ];
    for (text, words) in cases {
        let told = read(&text).expect_err(&text);
        for word in words {
            assert!(told.iter().any(|line| line.contains(word)), "{word}\n{told:#?}");
        }
    }
    let told = |bytes: &[u8]| WasmLaw::new(bytes).expect_err("no module").join("\n");
    assert!(told(b"\0asm").starts_with("it is not a module that can run here"));
    assert!(told(&C[..200]).starts_with("it is not a module that can run here"));
    assert!(told(&vec![0; 1_000_001]).contains("1 MB is the most"));
}
