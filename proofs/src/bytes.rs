//! The driver for property tests and fuzzers: a case for each string of bytes.

use crate::choose::Choose;

/// Chooses by any bytes: each byte decides one choice, and after the last byte every choice is the first
/// possible one. Fewer and lower bytes make simpler cases.
#[derive(Clone, Debug)]
pub struct Bytes {
    bytes: Vec<u8>,
    choices: Vec<u8>,
}

impl Bytes {
    /// Chooses by these bytes.
    #[must_use]
    pub fn new(bytes: Vec<u8>) -> Self {
        Self { bytes, choices: Vec::new() }
    }

    /// The choices made so far, from which a [`CaseReplay`](crate::CaseReplay) makes the case again.
    pub fn choices(&self) -> &[u8] {
        &self.choices
    }
}

impl Choose for Bytes {
    fn below(&mut self, n: u8) -> u8 {
        assert!(n > 0, "there is something to choose from");
        let byte = self.bytes.get(self.choices.len()).copied();
        let choice = byte.unwrap_or_default() % n;
        self.choices.push(choice);
        choice
    }
}
