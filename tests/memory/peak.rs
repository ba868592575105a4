//! The memory that readers take, for tests that it is no more than documented. The allocator of the whole program is
//! measured, so each of these tests is a program of its own, with one thread.

use std::{fmt::Display, hint::black_box};

use libtest_mimic::{Arguments, Trial};
use peak_alloc::PeakAlloc;

#[global_allocator]
pub(crate) static MEMORY: PeakAlloc = PeakAlloc;

/// Runs this test on the main thread, and ends the program.
pub(crate) fn run(name: &str, test: fn()) -> ! {
    let arguments = Arguments { test_threads: Some(1), ..Arguments::from_args() };
    let trial = Trial::test(name, move || {
        assert_measured();
        test();
        Ok(())
    });
    libtest_mimic::run(&arguments, vec![trial]).exit()
}

/// The most memory taken at any time while this runs.
pub(crate) fn peak(run: impl FnOnce()) -> usize {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    run();
    MEMORY.peak_usage().saturating_sub(before)
}

/// The allocator is measured, and nobody else takes memory.
fn assert_measured() {
    assert_eq!(peak(|| drop(black_box(Vec::<u8>::with_capacity(1 << 20)))), 1 << 20);
}

/// A reader, and what it documents: so many bytes of memory for each byte, and so many besides.
pub(crate) struct Documented {
    pub(crate) reader: &'static str,
    /// Reads everything, and says what is wrong.
    pub(crate) read: fn(&[u8]),
    pub(crate) multiple: usize,
    pub(crate) besides: usize,
}

/// Lets the compiler leave nothing out.
pub(crate) fn keep<T, E: Display>(result: Result<T, E>) {
    let _ = black_box(result.map_err(|error| black_box(error.to_string())));
}

impl Documented {
    pub(crate) const fn new(
        reader: &'static str,
        read: fn(&[u8]),
        [multiple, besides]: [usize; 2],
    ) -> Self {
        Self { reader, read, multiple, besides }
    }

    /// The memory for each byte that reading takes, which is no more than documented.
    pub(crate) fn holds(&self, bytes: &[u8]) -> usize {
        let taken = peak(|| (self.read)(bytes));
        let documented = self.multiple * bytes.len() + self.besides;
        assert!(
            taken <= documented,
            "{} takes {taken} bytes of memory to read {}; documented are {documented}: {}...",
            self.reader,
            bytes.len(),
            bytes[..bytes.len().min(80)].escape_ascii()
        );
        taken / bytes.len().max(1)
    }
}
