//! Cameras that differ from their calibration.

use std::f64::consts::TAU;

use rayon::prelude::*;
use toposlam_vision::camera::Camera;

use crate::{Rig, RigErrors};

/// Whether the camera agrees with its calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// It agrees.
    Right,
    /// The mirror's centre is 5 pixels off (in an image 1280 wide), the camera is 2 cm too high or
    /// too low, and its axis leans by one degree.
    Wrong,
}

/// The number of rigs that differ from their calibration.
const WRONG_RIGS: usize = 6;
/// Offset of the mirror's centre, as a share of the image's width.
const CENTRE_OFF: f64 = 5.0 / 1280.0;
/// Error of the camera's height, in metres.
const HEIGHT_OFF: f64 = 0.02;
/// Tilt of the axis, in degrees.
const TILT: f64 = 1.0;

/// Rigs whose cameras differ from the calibration, each in another direction.
pub(super) fn wrong_rigs(camera: &Camera) -> Vec<Rig> {
    let errors = (0..WRONG_RIGS).into_par_iter().map(|number| errors(camera.image, number));
    errors.map(|errors| Rig::with_errors(camera, &errors)).collect()
}

/// The errors of a rig. All have the same size; their directions differ.
fn errors([width, _]: [u32; 2], number: usize) -> RigErrors {
    let around = |turns: f64| (TAU * (number as f64 * turns + 0.11)).sin_cos();
    let (v, u) = around(1.0 / WRONG_RIGS as f64);
    let centre = CENTRE_OFF * f64::from(width);
    RigErrors {
        tilt: TILT.to_radians(),
        // The golden section keeps directions of tilt and centre from repeating together.
        towards: TAU * number as f64 * 0.618_034,
        centre: [centre * u, centre * v],
        height: if number.is_multiple_of(2) { HEIGHT_OFF } else { -HEIGHT_OFF },
    }
}
