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
//! ```
//!
//! For a camera that OCamCalib, OpenCV's omnidir or camodocal has calibrated, the calibration names
//! their file:
//!
//! ```toml
//! [camera]
//! kind = "ocamcalib"           # or "mei", for OpenCV's omnidir and camodocal
//! file = "calib_results.txt"   # beside this file
//! viewpoint_height = 1.02      # metres above the floor
//! ahead = 90.0
//! seen_from = "below"
//! image = [1280, 960]          # only needed if the file does not give it
//! ```

mod error;
mod read;
mod write;

pub use super::optics_file::SIDES;
pub use error::{CalibrationError, CalibrationErrorKind};
pub use read::{Files, read};
pub use write::to_toml;
