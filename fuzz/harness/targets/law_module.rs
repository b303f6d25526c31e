//! Calls `fuzz::law_module` with what libFuzzer makes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::law_module(data));
