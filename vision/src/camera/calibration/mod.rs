//! Calibration files: the parameters of a camera.
//!
//! ```toml
//! [camera]
//! kind = "spherical-mirror"
//! image = [1280, 960]          # pixels
//! centre = [640.0, 480.0]      # of the mirror in the image, u to the right, v down
//! focal = 1272.8               # pixels
//! mirror_radius = 0.05         # metres
//! mirror_distance = 0.15       # sphere's centre above the pinhole
//! camera_height = 0.90         # pinhole above the floor
//! rim = 450.0                  # pixels; optional, checked against the others
//! ahead = 90.0                 # degrees in the image, counter-clockwise from u
//! seen_from = "below"
//! mask = "mask.png"            # optional: white where the floor can be seen
//! hidden_radius = 0.32         # optional, metres: without a mask, the body hides the floor nearer than this
//! hide = [[[300, 400], [420, 400], [360, 480]]]  # optional: polygons that hide the floor, in pixels
//! ```
//!
//! For a camera that OCamCalib, OpenCV's omnidir, camodocal or Kalibr has calibrated, the calibration
//! names their file:
//!
//! ```toml
//! [camera]
//! kind = "ocamcalib"           # "mei": OpenCV's omnidir, camodocal, Kalibr's omni; "kannala-brandt": OpenCV's
//!                              # fisheye, camodocal, Kalibr's pinhole with equidistant
//! file = "calib_results.txt"   # beside this file
//! viewpoint_height = 1.02      # metres above the floor
//! ahead = 90.0
//! seen_from = "below"
//! image = [1280, 960]          # only needed if the file does not give it
//! tilt = 60.0                  # optional, only "kannala-brandt": degrees of the axis from straight down to ahead
//! ```

mod read;
mod write;

use std::io;

use thiserror::Error;
use toposlam_model::format::document::{DocumentErrorKind, FileError};

pub use super::optics_file::SIDES;
use crate::camera::{MaskError, OpticsFileError};
pub use read::{Files, read};
pub use write::to_toml;

pub type CalibrationError = FileError<CalibrationErrorKind>;

#[derive(Debug, Error)]
pub enum CalibrationErrorKind {
    #[error(transparent)]
    Document(#[from] DocumentErrorKind),
    #[error(
        "{rim} pixels do not agree with focal, mirror_radius and mirror_distance, which give a rim of \
         {expected:.1}; they must agree within 2 %"
    )]
    Rim { rim: f64, expected: f64 },
    #[error(
        "focal, mirror_radius and mirror_distance give a rim of {rim:.2} pixels; it must be between \
         {low} and {high}"
    )]
    RimOutOfRange { rim: f64, low: f64, high: f64 },
    #[error(
        "this is the file of another calibration program; name it in a calibration: [camera], kind = \
         \"{kind}\", file = \"...\", viewpoint_height = METRES, ahead = DEGREES, seen_from = \"below\" \
         or \"above\""
    )]
    OtherProgram { kind: &'static str },
    #[error("{file}: cannot be read: {error}")]
    Unreadable { file: String, error: io::Error },
    #[error("{file}: {error}")]
    Optics { file: String, error: OpticsFileError },
    #[error(
        "{} by {} pixels do not agree with the file, which is for images of {} by {}",
        .given[0], .given[1], .found[0], .found[1]
    )]
    OtherImage { given: [u32; 2], found: [u32; 2] },
    #[error("the file does not give the size of the images; the key `image` must")]
    NoImage,
    #[error("{file}: {error}")]
    Mask { file: String, error: MaskError },
    #[error("a polygon has at least {least} corners, this one has {0}", least = crate::camera::Polygon::FEWEST)]
    FewCorners(usize),
}
