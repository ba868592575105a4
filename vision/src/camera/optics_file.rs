//! What can be wrong with a file that another calibration tool wrote.

use thiserror::Error;

use super::calibration::SIDES;

/// Why a file tells no optics.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum OpticsFileError {
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is not YAML.
    #[error("line {line}: {message}")]
    Syntax {
        /// Counted from 1.
        line: usize,
        /// What the parser says.
        message: String,
    },
    /// Something else stands where a number should.
    #[error("line {line}: expected a number, found `{found}`")]
    NotANumber {
        /// Counted from 1.
        line: usize,
        /// What is here.
        found: String,
    },
    /// There are more or fewer numbers in a line than there should be.
    #[error("line {line}: expected {expected} numbers, {what}, found {found}")]
    LineCount {
        /// Counted from 1.
        line: usize,
        /// What they say.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// There are more or fewer numbers in a line than its first says.
    #[error("line {line}: expected {count} coefficients of {what}, found {found}")]
    FalseCount {
        /// Counted from 1.
        line: usize,
        /// What they are of.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        count: f64,
    },
    /// The file ends too early.
    #[error("the file ends before {0}")]
    EndsBefore(&'static str),
    /// The file goes on.
    #[error("line {line}: nothing should follow the size of the image")]
    GoesOn {
        /// Counted from 1.
        line: usize,
    },
    /// The file says nothing of something.
    #[error("the key `{0}` is missing")]
    MissingKey(&'static str),
    /// The file says something twice.
    #[error("line {line}: the key `{key}` stands twice")]
    Twice {
        /// Counted from 1.
        line: usize,
        /// The key.
        key: String,
    },
    /// There are more or fewer numbers than there should be.
    #[error("`{key}` has {found} numbers; it should have {expected}")]
    Count {
        /// The key.
        key: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// The file is that of another model.
    #[error("`model_type` is `{0}`, not `MEI`")]
    OtherModel(String),
    /// A fraction where a whole number should be.
    #[error("{what} is {value}; it should be whole")]
    NotWhole {
        /// What it says.
        what: &'static str,
        /// What was given.
        value: f64,
    },
    /// A number that no camera has.
    #[error("{what} is {value}; it should lie between {low} and {high}")]
    OutOfRange {
        /// What it says.
        what: &'static str,
        /// What was given.
        value: f64,
        /// The least that it can be.
        low: f64,
        /// The most that it can be.
        high: f64,
    },
    /// By these numbers, pixels farther from the middle of the image do not look farther out.
    #[error("by these numbers no floor is seen around the middle of the image")]
    NoView,
}

/// A number within bounds.
pub(super) fn within(
    what: &'static str,
    value: f64,
    [low, high]: [f64; 2],
) -> Result<f64, OpticsFileError> {
    if value >= low && value <= high {
        Ok(value)
    } else {
        Err(OpticsFileError::OutOfRange { what, value, low, high })
    }
}

/// A whole number of pixels.
#[expect(clippy::cast_sign_loss, reason = "a side is positive")]
pub(super) fn side_of_image(what: &'static str, side: f64) -> Result<u32, OpticsFileError> {
    if side.fract() == 0.0 {
        within(what, side, SIDES.map(f64::from)).map(|side| side as u32)
    } else {
        Err(OpticsFileError::NotWhole { what, value: side })
    }
}

/// A word of a file as an error shows it: its beginning, in one line.
pub(super) fn shown(word: &str) -> String {
    let beginning: String = word.chars().take(40).collect();
    let escaped = beginning.escape_debug().to_string();
    if beginning.len() < word.len() { format!("{escaped}...") } else { escaped }
}
