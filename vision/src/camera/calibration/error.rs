//! What can be wrong with a calibration, and where.

use std::io;

use thiserror::Error;
use toposlam_model::format::place::Place;

use crate::camera::{MaskError, OpticsFileError};

/// Why bytes are not a calibration: one message that names place and cause.
#[derive(Debug, Error)]
#[error("{place}{cause}")]
pub struct CalibrationError {
    /// Where: a file that the calibration names stands behind its key.
    pub place: Place,
    /// What is wrong there.
    #[source]
    pub cause: Cause,
}

/// What is wrong at a place of a calibration file.
#[derive(Debug, Error)]
pub enum Cause {
    /// There is nothing but space.
    #[error("the file is empty")]
    Empty,
    /// The bytes are not UTF-8.
    #[error("this is not UTF-8 text")]
    NotText,
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(String),
    /// A key that has no meaning here.
    #[error("unknown key; here can stand: {known}")]
    UnknownKey {
        /// The keys that have one.
        known: String,
    },
    /// A key that must be here is not.
    #[error("the key `{key}` is missing")]
    MissingKey {
        /// The key.
        key: &'static str,
    },
    /// A value of the wrong kind.
    #[error("here should be {expected}, not {found}")]
    WrongKind {
        /// What should be here.
        expected: String,
        /// What is here.
        found: &'static str,
    },
    /// A number that no camera has.
    #[error("{value} is out of range; {what} lies between {low} and {high}")]
    OutOfRange {
        /// What was given.
        value: f64,
        /// What it says, with its unit.
        what: &'static str,
        /// The least that it can be.
        low: f64,
        /// The most that it can be.
        high: f64,
    },
    /// A rim that is not that of the mirror.
    #[error(
        "{rim} pixels do not go with focal, mirror_radius and mirror_distance, by which the rim is at \
         {expected:.1}; they must agree within 2 %"
    )]
    Rim {
        /// What was given.
        rim: f64,
        /// What it should be.
        expected: f64,
    },
    /// A mirror that would be seen as a dot, or as larger than any image.
    #[error(
        "by focal, mirror_radius and mirror_distance the rim is at {rim:.2} pixels; it lies between {low} \
         and {high}"
    )]
    RimOutOfRange {
        /// Where it is, in pixels.
        rim: f64,
        /// The least that it can be.
        low: f64,
        /// The most that it can be.
        high: f64,
    },
    /// A file that is named cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    /// The file of another tool cannot be understood.
    #[error(transparent)]
    Optics(#[from] OpticsFileError),
    /// The file of another tool is for images of another size.
    #[error(
        "{} by {} pixels do not go with the file, which is for images of {} by {}",
        .told[0], .told[1], .found[0], .found[1]
    )]
    OtherImage {
        /// Width and height as the calibration tells them.
        told: [u32; 2],
        /// Width and height as the file tells them.
        found: [u32; 2],
    },
    /// Nobody tells how large the images are.
    #[error("the file does not tell the size of the images; the key `image` must")]
    NoImage,
    /// The mask is none.
    #[error(transparent)]
    Mask(#[from] MaskError),
}

impl Cause {
    /// The error that has this cause at a key.
    pub(super) fn at(self, key: impl Into<String>) -> CalibrationError {
        CalibrationError { place: Place::Key(key.into()), cause: self }
    }

    /// The error that has this cause in the file as a whole.
    pub(super) fn in_file(self) -> CalibrationError {
        CalibrationError { place: Place::File, cause: self }
    }

    /// The error that has this cause in a file that a key names.
    pub(super) fn in_named(self, key: &str, file: &str) -> CalibrationError {
        let place = Place::Key(format!("camera.{key}: {}", file.escape_debug()));
        CalibrationError { place, cause: self }
    }

    /// The error that has this cause at a byte of the text.
    pub(super) fn at_byte(self, bytes: &[u8], byte: usize) -> CalibrationError {
        CalibrationError { place: Place::at_byte(bytes, byte), cause: self }
    }
}
