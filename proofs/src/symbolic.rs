//! The driver for Kani: all cases within a bound at once.

use crate::choose::Choose;

/// Each choice is a symbol that stands for all possibilities.
#[derive(Clone, Copy, Debug, Default)]
pub struct Symbolic;

impl Choose for Symbolic {
    fn below(&mut self, n: u8) -> u8 {
        assert!(n > 0, "there is something to choose from");
        // The only choice there is stays a constant, and so do the bounds of loops made of it.
        if n == 1 {
            return 0;
        }
        let choice: u8 = kani::any();
        kani::assume(choice < n);
        choice
    }

    fn assume(&mut self, condition: bool) -> bool {
        kani::assume(condition);
        true
    }
}
