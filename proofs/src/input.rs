//! The driver for symbolic execution of the compiled harness: each choice is a byte of the input.
//!
//! `symbolic/run.py` executes the machine code. It replaces [`any_below`] and [`any_byte`], by their names, with
//! functions that return a symbol. Otherwise these read the bytes of one case, which makes the case again.

use std::{process, sync::Mutex};

use crate::choose::Choose;

/// The exit code if the bytes are not those of a case.
pub const NO_CASE: i32 = 4;

/// The bytes that are left, the next one last.
static INPUT: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Sets the input.
pub fn set(mut bytes: Vec<u8>) {
    bytes.reverse();
    if let Ok(mut input) = INPUT.lock() {
        *input = bytes;
    }
}

fn next() -> Option<u8> {
    INPUT.lock().ok().and_then(|mut input| input.pop())
}

/// The next byte of the input. If there is none, the process ends.
#[inline(never)]
pub fn any_byte() -> u8 {
    next().unwrap_or_else(|| process::exit(NO_CASE))
}

/// The next byte of the input, which is below `n`. If it is not, the process ends.
#[inline(never)]
pub fn any_below(n: u8) -> u8 {
    next().filter(|byte| *byte < n).unwrap_or_else(|| process::exit(NO_CASE))
}

/// Each choice is a byte of the input.
#[derive(Clone, Copy, Debug, Default)]
pub struct Input;

impl Choose for Input {
    fn below(&mut self, n: u8) -> u8 {
        assert!(n > 0, "there is something to choose from");
        if n == 1 { 0 } else { any_below(n) }
    }
}
