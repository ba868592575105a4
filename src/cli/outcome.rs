//! How a verb ends: exit codes 0 to 3, and the message of a failure.

use std::{fmt::Display, io, path::Path, process::ExitCode};

/// The result of a verb that did its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Everything holds, or the work is done: exit code 0.
    Holds,
    /// Something is violated: exit code 1.
    Violated,
    /// The work is not finished, and everything so far holds: exit code 3.
    Incomplete,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Holds => Self::SUCCESS,
            Outcome::Violated => Self::from(1),
            Outcome::Incomplete => Self::from(3),
        }
    }
}

/// Why a verb could not do its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Bad usage or bad input, exit code 2. The message names the place and the cause.
    Input(String),
    /// The reader closed standard output: no message, exit code 3. A check whose report was not read to
    /// the end does not hold.
    ReaderGone,
}

impl Failure {
    /// A failure at a place: an argument, or a place in a file.
    pub(crate) fn at(place: impl Display, cause: impl Display) -> Self {
        Self::Input(format!("{place}: {cause}"))
    }

    /// A failure in a file.
    pub(crate) fn in_file(path: &Path, cause: impl Display) -> Self {
        Self::at(path.display(), cause)
    }

    /// Prints the message and returns the exit code.
    pub(crate) fn report(&self) -> ExitCode {
        match self {
            Self::Input(message) => {
                eprintln!("error: {message}");
                ExitCode::from(2)
            }
            Self::ReaderGone => Outcome::Incomplete.into(),
        }
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ReaderGone,
            _ => Self::at("standard output", error),
        }
    }
}
