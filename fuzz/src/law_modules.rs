//! Laws as WebAssembly modules.

use crate::law_files::{drive, told_of_leader};
use crate::scenes::in_words;
use laws::{LEADERS_MAX, read_module};
use std::fmt::Write;

/// Any bytes are a law, or are refused in words; a module ends, whatever it does, within its bounds. Bytes that do not begin as
/// a module does are made into the instructions of one that is valid.
pub fn law_module(data: &[u8]) {
    let made;
    let bytes = if laws::is_module(data) {
        data
    } else {
        made = wat::parse_str(text(data)).expect("a text of WebAssembly");
        &made
    };
    let law = match read_module(bytes) {
        Ok(law) => law,
        Err(mistakes) => {
            assert!(!mistakes.is_empty() && mistakes.len() <= 20, "{} mistakes", mistakes.len());
            for told in mistakes {
                in_words(&told);
            }
            return;
        }
    };
    let parameters: Vec<f64> = law.declaration().parameters.iter().map(|own| own.default).collect();
    // Numbers of all kinds come up inside; a call that never ends takes a while.
    drive(&*law, &[told_of_leader(0.7); LEADERS_MAX], 0.7, &parameters);
}

/// A module that is valid, and does what the bytes say.
fn text(data: &[u8]) -> String {
    let mut text = String::from(
        r#"(module
(import "env" "noise" (func $noise (param i32) (result f64)))
(import "env" "pow" (func $pow (param f64 f64) (result f64)))
(import "env" "tan" (func $tan (param f64) (result f64)))
(memory (export "memory") 1)
(table $table 4 100000 funcref)
(elem (i32.const 0) $decide $region)
(global $global (mut f64) (f64.const 0))
(data $text (i32.const 0) "{\"memory\": [{\"name\": \"m\"}], \"shown\": [{\"name\": \"s\"}]}\00")
(data $passive "some bytes")
(type $law (func (param i32 i32 i32 i32 i32)))
(func (export "declaration") (result i32) (i32.const 0))
(func $region (export "region") (result i32) (i32.const 8192))
(func $decide (export "decide") (type $law) (local $a f64) (local $b f64) (local $n i32)
(f64.store (local.get 3) (f64.const 0))
(f64.store (local.get 4) (f64.const 0))
(f64.store offset=8 (local.get 4) (f64.const 0))
"#,
    );
    let mut open = vec![];
    for part in data.chunks(3).take(400) {
        let [what, x, y] = [0, 1, 2].map(|index| part.get(index).copied().unwrap_or(0));
        let (from, at) = (x % 5, i32::from(y) * 8);
        let line = match what % 24 {
            0 => format!("(local.set $a (f64.load offset={at} (local.get {from})))"),
            1 => format!("(f64.store offset={at} (local.get {from}) (local.get $a))"),
            2 => format!("(local.set $a (f64.const {}))", f64::from(x) - 2.0 * f64::from(y)),
            3 => "(local.set $a (f64.div (local.get $a) (local.get $b)))".to_owned(),
            4 => "(local.set $b (f64.mul (local.get $a) (local.get $b)))".to_owned(),
            5 => "(local.set $b (f64.sub (local.get $b) (local.get $a)))".to_owned(),
            6 => "(local.set $a (call $pow (local.get $a) (local.get $b)))".to_owned(),
            7 => "(local.set $b (call $tan (f64.sqrt (local.get $a))))".to_owned(),
            8 => "(local.set $a (call $noise (local.get $n)))".to_owned(),
            9 => format!("(local.set $n (i32.add (local.get $n) (i32.const {})))", i32::from(x) - 128),
            10 => "(local.set $n (i32.trunc_f64_s (local.get $a)))".to_owned(),
            11 => format!("(local.set $n (i32.div_s (i32.const {x}) (local.get $n)))"),
            12 => format!("(f64.store offset={at} (local.get $n) (local.get $b))"),
            13 => {
                open.push("(br 0))");
                "(loop".to_owned()
            }
            14 => {
                open.push("(br_if 0 (i32.rem_u (local.tee $n (i32.add (local.get $n) (i32.const 1))) (i32.const 999))))");
                "(loop".to_owned()
            }
            15 => {
                open.push("))");
                "(if (f64.lt (local.get $a) (local.get $b)) (then".to_owned()
            }
            16 => open.pop().unwrap_or_default().to_owned(),
            17 => format!("(local.set $n (memory.grow (i32.const {})))", u32::from(x) * u32::from(y)),
            18 => format!("(memory.fill (local.get $n) (i32.const {x}) (i32.const {}))", u32::from(y) << 16),
            19 => format!("(memory.copy (local.get $n) (i32.const {at}) (i32.const {}))", u32::from(x) << 12),
            20 => "(call $decide (local.get 0) (local.get 1) (local.get 2) (local.get 3) (local.get $n))"
                .to_owned(),
            21 => format!(
                "(call_indirect (type $law) (local.get 0) (local.get 1) (local.get 2) (local.get 3) (local.get 4) (i32.const {}))",
                x % 5
            ),
            22 => format!(
                "(local.set $n (table.grow $table (ref.null func) (i32.const {})))",
                u32::from(x) << 8
            ),
            _ => "(memory.init $passive (local.get $n) (i32.const 0) (i32.const 9)) (data.drop $passive)
(global.set $global (f64.add (global.get $global) (local.get $a)))"
                .to_owned(),
        };
        let _ = writeln!(text, "{line}");
    }
    while let Some(end) = open.pop() {
        text.push_str(end);
    }
    text + "))"
}
