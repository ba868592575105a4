//! The model of a fisheye lens, as OpenCV's fisheye, camodocal and Kalibr calibrate it.
//!
//! J. Kannala, S. Brandt: A generic camera model and calibration method for conventional, wide-angle, and
//! fish-eye lenses. PAMI 2006, equation 6. A point at the angle theta from the optical axis is seen at
//! r = theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9 from the middle of a plane, in the
//! direction of the point, and mapped to pixels by a matrix. The axis points straight down, or is tilted
//! towards ahead.

use nalgebra::{Point2, Point3, Rotation3, Unit, Vector2, Vector3};

use super::{
    ViewingRay,
    mei::{self, MATRIX},
    optics_file::{OpticsFileError, within},
    pixel_matrix::PixelMatrix,
    root::{first_change, polynomial, root},
    yaml::Values,
};
use crate::geometry;

#[derive(Clone, Debug, PartialEq)]
pub struct KannalaBrandt {
    /// The file with the calibration, as the calibration file names it.
    pub file: String,
    /// The height of the viewpoint above the floor, in metres.
    pub viewpoint_height: f64,
    /// The angle of the optical axis from straight down, in radians, towards ahead.
    pub tilt: f64,
    /// The direction of ahead in the image, in radians counter-clockwise from u.
    ahead: f64,
    /// Width and height of the images in pixels, if the file gives them.
    pub(super) image: Option<[u32; 2]>,
    /// Of odd powers of the angle, from the third on.
    coefficients: [f64; 4],
    matrix: PixelMatrix,
    /// The angle up to which points are seen farther and farther out.
    reach: f64,
}

/// The keys of the numbers of camodocal: the coefficients, and the variable numbers of the matrix.
const CAMODOCAL: [&str; 8] = [
    "projection_parameters.k2",
    "projection_parameters.k3",
    "projection_parameters.k4",
    "projection_parameters.k5",
    "projection_parameters.mu",
    "projection_parameters.mv",
    "projection_parameters.u0",
    "projection_parameters.v0",
];

impl KannalaBrandt {
    /// Reads the YAML or XML of OpenCV's fisheye (K, D), or the YAML of camodocal (`model_type:
    /// KANNALA_BRANDT`) or Kalibr (`pinhole` with `equidistant`).
    ///
    /// Reading takes at most 512 bytes of memory for each byte of the file, and 65536 besides.
    ///
    /// # Errors
    /// Returns an error if the file is not as it should be. No bytes make it panic.
    pub fn read(
        file: &str,
        bytes: &[u8],
        viewpoint_height: f64,
        [tilt, ahead]: [f64; 2],
    ) -> Result<Self, OpticsFileError> {
        let text = std::str::from_utf8(bytes).map_err(|_| OpticsFileError::NotText)?;
        let known = mei::known_keys(&CAMODOCAL);
        let found = mei::values(text, &known)?;
        let (coefficients, matrix) = numbers(&found)?;
        for coefficient in coefficients {
            within("a coefficient of the distortion", coefficient, [-1e3, 1e3])?;
        }
        // Points behind the lens are seen up to half a turn away. The radius grows up to here:
        let [k1, k2, k3, k4] = coefficients;
        let growth = [1.0, 0.0, 3.0 * k1, 0.0, 5.0 * k2, 0.0, 7.0 * k3, 0.0, 9.0 * k4];
        let half_turn = std::f64::consts::PI;
        let reach = first_change(&growth, [0.0, half_turn]).unwrap_or(half_turn);
        if reach < 1e-3 {
            return Err(OpticsFileError::NoView);
        }
        Ok(Self {
            file: file.to_owned(),
            viewpoint_height,
            tilt,
            ahead,
            image: mei::image(&found)?,
            coefficients,
            matrix: PixelMatrix::new(matrix)?,
            reach,
        })
    }

    pub(super) fn scaled(&self, factor: f64, image: [u32; 2]) -> Self {
        Self { image: Some(image), matrix: self.matrix.scaled(factor), ..self.clone() }
    }

    pub(super) fn ray(&self, pixel: Point2<f64>) -> Option<ViewingRay> {
        let [x, y] = self.matrix.plane(pixel).into();
        let at = Vector2::new(x, -y);
        let radius = at.norm();
        if radius.is_nan() || radius > self.radius(self.reach).0 {
            return None;
        }
        let lack = |angle: f64| {
            let (found, slope) = self.radius(angle);
            (found - radius, slope)
        };
        let (sine, cosine) = root(lack, [0.0, self.reach], radius).sin_cos();
        let out = if radius > 0.0 { sine / radius * at } else { Vector2::zeros() };
        Some(ViewingRay {
            origin: Point3::new(0.0, 0.0, self.viewpoint_height),
            direction: self.turn() * Vector3::new(out.x, out.y, -cosine),
        })
    }

    /// The pixel that shows a point of the floor, in the image's axes.
    pub(super) fn pixel(&self, ground: Point2<f64>) -> Option<Point2<f64>> {
        self.pixel_along(Vector3::new(ground.x, ground.y, -self.viewpoint_height))
    }

    /// The pixel that looks straight down; that of the optical axis if none does.
    pub(super) fn middle(&self) -> Point2<f64> {
        self.pixel_along(-Vector3::z()).unwrap_or(self.matrix.centre)
    }

    fn pixel_along(&self, direction: Vector3<f64>) -> Option<Point2<f64>> {
        let direction = self.turn().inverse() * direction;
        let across = direction.xy().norm();
        let angle = across.atan2(-direction.z);
        if angle.is_nan() || angle > self.reach {
            return None;
        }
        let scale = if across > 0.0 { self.radius(angle).0 / across } else { 0.0 };
        Some(self.matrix.pixel(Vector2::new(scale * direction.x, -scale * direction.y)))
    }

    /// The distance from the middle of the plane at an angle from the axis, and its slope.
    fn radius(&self, angle: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.coefficients;
        polynomial(&[0.0, 1.0, 0.0, k1, 0.0, k2, 0.0, k3, 0.0, k4], angle)
    }

    /// From the axes of the lens to those of the image with the axis straight down.
    fn turn(&self) -> Rotation3<f64> {
        let [x, y] = geometry::unit(self.ahead).into();
        Rotation3::from_axis_angle(&Unit::new_unchecked(Vector3::new(y, -x, 0.0)), self.tilt)
    }
}

/// The coefficients, and the variable numbers of the matrix.
fn numbers(found: &Values<'_>) -> Result<([f64; 4], [f64; 5]), OpticsFileError> {
    if found.has("model_type") {
        mei::expect_model(found, "model_type", "KANNALA_BRANDT")?;
        let [k1, k2, k3, k4, focal_u, focal_v, u, v] = found.each(CAMODOCAL)?;
        return Ok(([k1, k2, k3, k4], [focal_u, 0.0, u, focal_v, v]));
    }
    if found.has("cam0.camera_model") {
        mei::expect_model(found, "cam0.camera_model", "pinhole")?;
        mei::expect_model(found, "cam0.distortion_model", "equidistant")?;
        let [focal_u, focal_v, u, v] = found.numbers("cam0.intrinsics")?;
        let coefficients = found.numbers("cam0.distortion_coeffs")?;
        return Ok((coefficients, [focal_u, 0.0, u, focal_v, v]));
    }
    let [matrix, distortion] = MATRIX.map(|keys| found.first_of(&keys));
    let matrix = PixelMatrix::numbers(found.numbers(matrix)?);
    Ok((found.numbers(distortion)?, matrix))
}
