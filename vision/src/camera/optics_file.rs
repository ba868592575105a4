//! What can be wrong with a file that another calibration tool wrote.

use thiserror::Error;

/// The least and the greatest number of pixels on a side of an image.
pub const SIDES: [u32; 2] = [16, 16384];

#[derive(Clone, Debug, PartialEq, Error)]
pub enum OpticsFileError {
    #[error("this is not UTF-8 text")]
    NotText,
    #[error("line {line}: {message}")]
    Syntax { line: usize, message: String },
    #[error("line {line}: expected a number, found `{found}`")]
    NotANumber { line: usize, found: String },
    #[error("line {line}: expected {expected} numbers, {what}, found {found}")]
    LineCount { line: usize, what: &'static str, found: usize, expected: usize },
    #[error("line {line}: expected {count} coefficients of {what}, found {found}")]
    FalseCount { line: usize, what: &'static str, found: usize, count: f64 },
    #[error("the file ends before {0}")]
    EndsBefore(&'static str),
    #[error("line {line}: nothing should follow the size of the image")]
    GoesOn { line: usize },
    #[error("the key `{0}` is missing")]
    MissingKey(&'static str),
    #[error("line {line}: the key `{key}` is repeated")]
    Twice { line: usize, key: String },
    #[error("`{key}` has {found} numbers; it must have {expected}")]
    Count { key: &'static str, found: usize, expected: usize },
    #[error("`{key}` is `{found}`, not `{expected}`")]
    OtherModel { key: &'static str, found: String, expected: &'static str },
    #[error("{what} is {value}; it must be a whole number")]
    NotWhole { what: &'static str, value: f64 },
    #[error("{what} is {value}; it must be between {low} and {high}")]
    OutOfRange { what: &'static str, value: f64, low: f64, high: f64 },
    #[error("with these numbers no floor is seen around the middle of the image")]
    NoView,
}

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

#[expect(clippy::cast_sign_loss, reason = "a side is positive")]
pub(super) fn side_of_image(what: &'static str, side: f64) -> Result<u32, OpticsFileError> {
    if side.fract() == 0.0 {
        within(what, side, SIDES.map(f64::from)).map(|side| side as u32)
    } else {
        Err(OpticsFileError::NotWhole { what, value: side })
    }
}

/// The number that a word of a line is.
pub(super) fn finite(word: &str, line: usize) -> Result<f64, OpticsFileError> {
    let number = word.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| OpticsFileError::NotANumber { line, found: shown(word) })
}

pub(super) fn shown(word: &str) -> String {
    let beginning: String = word.chars().take(40).collect();
    let escaped = beginning.escape_debug().to_string();
    if beginning.len() < word.len() { format!("{escaped}...") } else { escaped }
}
