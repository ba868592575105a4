//! How a verb ends: exit codes 0 to 3, and the one message of a failure.

use std::{fmt::Display, io, path::Path, process::ExitCode};

/// What a verb that did its work found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It holds, or it is done: exit code 0.
    Holds,
    /// It is violated: exit code 1.
    Violated,
    /// It could not be finished, and what was done holds: exit code 3.
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

/// Why a verb could not do its work: bad usage or bad input, exit code 2, unless said otherwise.
#[derive(Debug)]
pub(crate) enum Failure {
    /// One message that names place and cause.
    Input(String),
    /// Standard output was closed by its reader: nothing to say, and nobody to say it to. Exit
    /// code 3, for a check that nobody heard out does not hold.
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

    /// Prints the message and answers the exit code.
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
