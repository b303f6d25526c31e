//! Calls `fuzz::storyboard` with what libFuzzer makes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::storyboard(data));
