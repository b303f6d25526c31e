//! Calls `fuzz::csv_table` with what libFuzzer makes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::csv_table(data));
