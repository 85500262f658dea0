#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| pydslrep_fuzz::run("settings", data));
