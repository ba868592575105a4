//! How a verb ends: exit codes 0 to 3, and the message of a failure.

use std::{fmt::Display, io, path::Path, process::ExitCode};

use toposlam_model::enumerate::Interrupted;

use super::{report_output, terminal};

/// The result of a verb that did its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Everything holds, or the work is done: exit code 0.
    Holds,
    /// Something is violated: exit code 1.
    Violated,
    /// The work is not finished, and everything so far holds: exit code 3.
    Incomplete,
}

impl Outcome {
    /// The field `verdict` of `--json`.
    pub fn verdict(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Violated => "violated",
            Self::Incomplete => "not-known",
        }
    }
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
pub enum CliError {
    /// Bad usage or bad input, exit code 2. The message names the place and the cause.
    Input(String),
    /// Bad input that was reported when it was found, exit code 2.
    Reported,
    /// The work was stopped before it had a result, exit code 3.
    Interrupted,
    /// The work ended before it had a result, exit code 3. The message has the cause.
    Unfinished(String),
}

impl CliError {
    /// A failure at a place: an argument, or a place in a file.
    pub fn at(place: impl Display, cause: impl Display) -> Self {
        Self::Input(format!("{place}: {cause}"))
    }

    pub fn in_file(path: &Path, cause: impl Display) -> Self {
        Self::at(path.display(), cause)
    }

    /// Why one of several inputs could not be used, without its path.
    pub fn cause_in(&self, path: &Path) -> String {
        match self {
            Self::Input(message) => {
                let place = format!("{}: ", path.display());
                message.strip_prefix(&place).unwrap_or(message).to_owned()
            }
            Self::Reported => String::new(),
            Self::Interrupted => Interrupted.to_string(),
            Self::Unfinished(cause) => cause.clone(),
        }
    }

    /// Prints the message and returns the exit code.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Input(message) => {
                terminal::error(message);
                ExitCode::from(2)
            }
            Self::Reported => ExitCode::from(2),
            Self::Interrupted => {
                if !report_output::is_useless() {
                    terminal::print_message(&format!("{Interrupted}\n"));
                }
                Outcome::Incomplete.into()
            }
            Self::Unfinished(cause) => {
                terminal::print_message(&format!("not finished: {cause}\n"));
                Outcome::Incomplete.into()
            }
        }
    }
}

/// The worse of two results. Bad input is worse than a violation, that is worse than work that is not
/// finished, and that is worse than a result that holds: exit codes 2, 1, 3, 0.
fn worse(
    one: Result<Outcome, CliError>,
    other: Result<Outcome, CliError>,
) -> Result<Outcome, CliError> {
    let rank = |result: &Result<Outcome, CliError>| match result {
        Err(CliError::Input(_) | CliError::Reported) => 3,
        Ok(Outcome::Violated) => 2,
        Ok(Outcome::Incomplete) | Err(CliError::Interrupted | CliError::Unfinished(_)) => 1,
        Ok(Outcome::Holds) => 0,
    };
    if rank(&other) > rank(&one) { other } else { one }
}

/// The result of a verb that handles each of its inputs, also if another one is bad.
pub struct SeveralInputs(Result<Outcome, CliError>);

impl Default for SeveralInputs {
    fn default() -> Self {
        Self(Ok(Outcome::Holds))
    }
}

impl SeveralInputs {
    /// Adds the result of one input, and prints its failure. Returns the value, if there is one.
    pub fn add<T>(&mut self, result: Result<(T, Outcome), CliError>) -> Option<T> {
        let (value, result) = match result {
            Ok((value, outcome)) => (Some(value), Ok(outcome)),
            Err(failure @ CliError::Input(_)) => {
                failure.report();
                (None, Err(CliError::Reported))
            }
            Err(failure) => (None, Err(failure)),
        };
        let so_far = std::mem::replace(&mut self.0, Ok(Outcome::Holds));
        self.0 = worse(so_far, result);
        value
    }

    /// The worst result of all inputs.
    pub fn worst(self) -> Result<Outcome, CliError> {
        self.0
    }
}

impl From<io::Error> for CliError {
    fn from(error: io::Error) -> Self {
        Self::at("standard output", error)
    }
}

impl From<Interrupted> for CliError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Result<Outcome, CliError>; 6] {
        [
            Ok(Outcome::Holds),
            Err(CliError::Interrupted),
            Ok(Outcome::Incomplete),
            Ok(Outcome::Violated),
            Err(CliError::Reported),
            Err(CliError::Input("x".to_owned())),
        ]
    }

    fn code(result: Result<Outcome, CliError>) -> ExitCode {
        result.map_or_else(|failure| failure.report(), ExitCode::from)
    }

    /// The exit codes from the best to the worst.
    const ORDER: [u8; 6] = [0, 3, 3, 1, 2, 2];

    #[test]
    fn of_two_exit_codes_2_comes_before_1_before_3_before_0() {
        for one in 0..6 {
            for other in 0..6 {
                let worse = worse(
                    all().into_iter().nth(one).unwrap(),
                    all().into_iter().nth(other).unwrap(),
                );
                assert_eq!(code(worse), ExitCode::from(ORDER[one.max(other)]), "{one} {other}");
            }
        }
    }

    #[test]
    fn a_bad_input_does_not_hide_the_others() {
        let mut inputs = SeveralInputs::default();
        assert_eq!(inputs.add(Ok((1, Outcome::Violated))), Some(1));
        assert_eq!(inputs.add::<u8>(Err(CliError::Input("x".to_owned()))), None);
        assert_eq!(inputs.add(Ok((3, Outcome::Holds))), Some(3));
        assert!(matches!(inputs.worst(), Err(CliError::Reported)));
    }
}
