//! What can be wrong with a file that another calibration tool wrote.

use thiserror::Error;

/// The least and the greatest number of pixels on a side of an image.
pub const SIDES: [u32; 2] = [16, 16384];

/// Why a file is not a calibration.
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
        /// The message of the parser.
        message: String,
    },
    /// A word is not a number.
    #[error("line {line}: expected a number, found `{found}`")]
    NotANumber {
        /// Counted from 1.
        line: usize,
        /// The word.
        found: String,
    },
    /// A line has the wrong count of numbers.
    #[error("line {line}: expected {expected} numbers, {what}, found {found}")]
    LineCount {
        /// Counted from 1.
        line: usize,
        /// The meaning of the numbers.
        what: &'static str,
        /// Their count.
        found: usize,
        /// The count that is expected.
        expected: usize,
    },
    /// A line has another count of numbers than its first number.
    #[error("line {line}: expected {count} coefficients of {what}, found {found}")]
    FalseCount {
        /// Counted from 1.
        line: usize,
        /// What they belong to.
        what: &'static str,
        /// Their count.
        found: usize,
        /// The count that is expected.
        count: f64,
    },
    /// The file ends too early.
    #[error("the file ends before {0}")]
    EndsBefore(&'static str),
    /// The file does not end.
    #[error("line {line}: nothing should follow the size of the image")]
    GoesOn {
        /// Counted from 1.
        line: usize,
    },
    /// A key is missing.
    #[error("the key `{0}` is missing")]
    MissingKey(&'static str),
    /// A key is repeated.
    #[error("line {line}: the key `{key}` is repeated")]
    Twice {
        /// Counted from 1.
        line: usize,
        /// The key.
        key: String,
    },
    /// A key has the wrong count of numbers.
    #[error("`{key}` has {found} numbers; it must have {expected}")]
    Count {
        /// The key.
        key: &'static str,
        /// Their count.
        found: usize,
        /// The count that is expected.
        expected: usize,
    },
    /// The file is that of another model.
    #[error("`model_type` is `{0}`, not `MEI`")]
    OtherModel(String),
    /// A number is not whole.
    #[error("{what} is {value}; it must be a whole number")]
    NotWhole {
        /// The meaning of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A number is out of range.
    #[error("{what} is {value}; it must be between {low} and {high}")]
    OutOfRange {
        /// The meaning of the number.
        what: &'static str,
        /// The number.
        value: f64,
        /// Its least value.
        low: f64,
        /// Its greatest value.
        high: f64,
    },
    /// Pixels farther from the middle of the image do not look farther out.
    #[error("with these numbers no floor is seen around the middle of the image")]
    NoView,
}

/// A number in a range.
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

/// The beginning of a word in one line, for errors.
pub(super) fn shown(word: &str) -> String {
    let beginning: String = word.chars().take(40).collect();
    let escaped = beginning.escape_debug().to_string();
    if beginning.len() < word.len() { format!("{escaped}...") } else { escaped }
}
