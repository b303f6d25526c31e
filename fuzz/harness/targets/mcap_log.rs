//! Calls `fuzz::mcap_log` with what libFuzzer makes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::mcap_log(data));
