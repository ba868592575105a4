#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| toposlam_conform::fuzz::cdr_message(bytes));
