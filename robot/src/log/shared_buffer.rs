//! A file in memory, for the tests of those that write a log together.

use std::{
    cell::RefCell,
    io::{self, Write},
    rc::Rc,
};

/// What the clones of a recorder wrote.
#[derive(Clone, Default)]
pub(crate) struct SharedBuffer(pub(crate) Rc<RefCell<Vec<u8>>>);

impl Write for SharedBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
