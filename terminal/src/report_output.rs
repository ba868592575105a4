//! Standard output, whose reader may stop early.

use std::{
    io::{self, Write},
    sync::atomic::{AtomicBool, Ordering},
};

use super::files::files;

/// Whether the reader closed standard output.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Writes a report until its reader stops. Then it drops the rest, so that the files that were asked for
/// are still written and the exit code is that of the work.
pub struct ReportOutput<W> {
    out: W,
    closed: &'static AtomicBool,
}

impl<W: Write> ReportOutput<W> {
    /// The report goes to standard output.
    pub fn new(out: W) -> Self {
        Self { out, closed: &CLOSED }
    }

    fn until_closed<T>(
        &mut self,
        rest: T,
        write: impl FnOnce(&mut W) -> io::Result<T>,
    ) -> io::Result<T> {
        if self.closed.load(Ordering::Relaxed) {
            return Ok(rest);
        }
        match write(&mut self.out) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.closed.store(true, Ordering::Relaxed);
                Ok(rest)
            }
            result => result,
        }
    }
}

impl<W: Write> Write for ReportOutput<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.until_closed(bytes.len(), |out| out.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.until_closed((), W::flush)
    }
}

/// Whether work for the report is useless: its reader stopped, and no file is to be written.
pub fn is_useless() -> bool {
    CLOSED.load(Ordering::Relaxed) && !files().has_open_outputs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pipe whose reader stops after some writes.
    struct Pipe(usize);

    impl Write for Pipe {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::BrokenPipe)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    struct Full;

    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Err(io::ErrorKind::StorageFull.into())
        }
    }

    #[test]
    fn a_report_without_a_reader_is_dropped_and_other_errors_are_not() {
        static PIPE: AtomicBool = AtomicBool::new(false);
        static DISK: AtomicBool = AtomicBool::new(false);
        let mut report = ReportOutput { out: Pipe(2), closed: &PIPE };
        for closed in [false, false, true, true] {
            report.write_all(b"line\n").unwrap();
            assert_eq!(PIPE.load(Ordering::Relaxed), closed);
        }
        report.flush().unwrap();
        let mut report = ReportOutput { out: Full, closed: &DISK };
        assert!(report.write_all(b"line\n").is_err() && report.flush().is_err());
        assert!(!DISK.load(Ordering::Relaxed));
    }
}
