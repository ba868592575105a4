//! Prints the harnesses, or runs one on the bytes of a case:
//!   toposlam-symbolic
//!   toposlam-symbolic NAME BYTE...

use std::{env, process::ExitCode};

fn main() -> ExitCode {
    let harnesses = toposlam_symbolic::all();
    let mut words = env::args().skip(1);
    let Some(name) = words.next() else {
        for harness in harnesses {
            println!("{}\t{}\t{:?}", harness.name, harness.input, harness.covers);
        }
        return ExitCode::SUCCESS;
    };
    let number = harnesses.iter().position(|harness| harness.name == name);
    let bytes: Result<Vec<u8>, _> = words.map(|word| word.parse()).collect();
    let (Some(number), Ok(bytes)) = (number, bytes) else {
        eprintln!("usage: toposlam-symbolic [NAME BYTE...]");
        return ExitCode::from(2);
    };
    toposlam_proofs::input::set(bytes);
    println!("{}", toposlam_symbolic::run(number));
    ExitCode::SUCCESS
}
