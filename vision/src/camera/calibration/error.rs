//! What can be wrong with a calibration, and where.

use std::io;

use thiserror::Error;
use toposlam_model::format::document::{
    DocumentError, DocumentErrorKind, DocumentValue, TextPosition,
};

use crate::camera::{MaskError, OpticsFileError};

/// Why bytes are not a calibration.
#[derive(Debug, Error)]
#[error("{position}{kind}")]
pub struct CalibrationError {
    /// Where in the file.
    pub position: TextPosition,
    /// What is wrong there.
    #[source]
    pub kind: CalibrationErrorKind,
}

/// What is wrong at a place of a calibration file.
#[derive(Debug, Error)]
pub enum CalibrationErrorKind {
    /// A key or a value is not as it should be.
    #[error(transparent)]
    Document(DocumentErrorKind),
    /// A rim that is not that of the mirror.
    #[error(
        "{rim} pixels do not agree with focal, mirror_radius and mirror_distance, which give a rim of \
         {expected:.1}; they must agree within 2 %"
    )]
    Rim {
        /// The rim in the file.
        rim: f64,
        /// The rim by the other numbers.
        expected: f64,
    },
    /// A mirror that would be seen as a dot, or as larger than any image.
    #[error(
        "focal, mirror_radius and mirror_distance give a rim of {rim:.2} pixels; it must be between \
         {low} and {high}"
    )]
    RimOutOfRange {
        /// The rim, in pixels.
        rim: f64,
        /// Its least value.
        low: f64,
        /// Its greatest value.
        high: f64,
    },
    /// A file cannot be read.
    #[error("{file}: cannot be read: {error}")]
    Unreadable {
        /// The name of the file.
        file: String,
        /// What is wrong.
        error: io::Error,
    },
    /// The file of another tool is not as it should be.
    #[error("{file}: {error}")]
    Optics {
        /// The name of the file.
        file: String,
        /// What is wrong.
        error: OpticsFileError,
    },
    /// The file of another tool is for images of another size.
    #[error(
        "{} by {} pixels do not agree with the file, which is for images of {} by {}",
        .given[0], .given[1], .found[0], .found[1]
    )]
    OtherImage {
        /// Width and height in the calibration.
        given: [u32; 2],
        /// Width and height in the file.
        found: [u32; 2],
    },
    /// The size of the images is not known.
    #[error("the file does not give the size of the images; the key `image` must")]
    NoImage,
    /// The mask is not as it should be.
    #[error("{file}: {error}")]
    Mask {
        /// The name of the file.
        file: String,
        /// What is wrong.
        error: MaskError,
    },
}

impl CalibrationErrorKind {
    pub(super) fn at(self, value: DocumentValue<'_>) -> CalibrationError {
        CalibrationError { position: value.position(), kind: self }
    }
}

impl From<DocumentError> for CalibrationError {
    fn from(DocumentError { position, kind }: DocumentError) -> Self {
        Self { position, kind: CalibrationErrorKind::Document(kind) }
    }
}
