#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| toposlam_robot::fuzz::database_rows(bytes));
