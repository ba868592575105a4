//! Cameras that are not as their calibration says.

use std::f64::consts::TAU;

use rayon::prelude::*;
use toposlam_vision::camera::Camera;

use crate::simulator::{Rig, RigErrors};

/// Whether the camera is as its calibration says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// It is.
    Right,
    /// Its middle is 5 pixels (of an image 1280 wide) off, it is 2 cm too high or too low, and leans
    /// by one degree.
    Wrong,
}

/// So many cameras that are not as their calibration says.
const WRONG_RIGS: usize = 6;
/// How far the middle of the mirror is off, as a part of the image's width.
const CENTRE_OFF: f64 = 5.0 / 1280.0;
/// How much too high or too low it is, in metres.
const HEIGHT_OFF: f64 = 0.02;
/// How far it leans, in degrees.
const TILT: f64 = 1.0;

/// Rigs with a camera that is not as its calibration says, each in another way.
pub(super) fn wrong_rigs(camera: &Camera) -> Vec<Rig> {
    let errors = (0..WRONG_RIGS).into_par_iter().map(|number| errors(camera.image, number));
    errors.map(|errors| Rig::with_errors(camera, &errors)).collect()
}

/// The error of a camera: all of them as large as they are to be, in directions all around.
fn errors([width, _]: [u32; 2], number: usize) -> RigErrors {
    let around = |turns: f64| (TAU * (number as f64 * turns + 0.11)).sin_cos();
    let (v, u) = around(1.0 / WRONG_RIGS as f64);
    let centre = CENTRE_OFF * f64::from(width);
    RigErrors {
        tilt: TILT.to_radians(),
        // The golden section: no leaning is together with the same centre twice.
        towards: TAU * number as f64 * 0.618_034,
        centre: [centre * u, centre * v],
        height: if number.is_multiple_of(2) { HEIGHT_OFF } else { -HEIGHT_OFF },
    }
}
