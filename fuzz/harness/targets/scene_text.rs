//! Calls `fuzz::scene_text` with what libFuzzer makes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::scene_text(data));
