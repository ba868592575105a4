//! The unified model with a unit sphere, as OpenCV's omnidir, camodocal and Kalibr calibrate it, and the
//! files that they write: YAML, and OpenCV's XML.
//!
//! C. Mei, P. Rives: Single view point omnidirectional camera calibration from planar grids. ICRA 2007.
//! A point is projected onto the unit sphere around the viewpoint, then from xi above the sphere's middle
//! onto a plane at distance one, distorted there (k1, k2, p1, p2), and mapped to pixels by a matrix. The
//! model's z axis points straight down, to the middle of the image.

use nalgebra::{Matrix2, Point2, Point3, Vector2, Vector3};

use super::{
    ViewingRay,
    optics_file::{OpticsFileError, shown, side_of_image, within},
    pixel_matrix::PixelMatrix,
    root::{first_change, polynomial, root},
    xml, yaml,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Mei {
    /// The file with the calibration, as the calibration file names it.
    pub file: String,
    /// The height of the viewpoint above the floor, in metres.
    pub viewpoint_height: f64,
    /// Width and height of the images in pixels, if the file gives them.
    pub(super) image: Option<[u32; 2]>,
    xi: f64,
    radial: [f64; 2],
    tangential: [f64; 2],
    pub(super) matrix: PixelMatrix,
    /// The distance from the middle of the plane up to which the distortion can be inverted.
    reach: f64,
}

/// The keys of the numbers of camodocal: xi, the distortion, and the variable numbers of the matrix.
const CAMODOCAL: [&str; 9] = [
    "mirror_parameters.xi",
    "distortion_parameters.k1",
    "distortion_parameters.k2",
    "distortion_parameters.p1",
    "distortion_parameters.p2",
    "projection_parameters.gamma1",
    "projection_parameters.u0",
    "projection_parameters.gamma2",
    "projection_parameters.v0",
];
/// That of OpenCV's omnidir, by any of its names.
const XI: [&str; 4] = ["xi", "xi.data", "Xi", "Xi.data"];
/// Those of OpenCV's matrix and distortion, by any of their names, as a matrix or a plain list.
pub(super) const MATRIX: [[&str; 4]; 2] = [
    ["camera_matrix.data", "K.data", "camera_matrix", "K"],
    ["distortion_coefficients.data", "D.data", "distortion_coefficients", "D"],
];
/// Those of Kalibr's first camera.
const KALIBR: [&str; 5] = [
    "cam0.camera_model",
    "cam0.distortion_model",
    "cam0.intrinsics",
    "cam0.distortion_coeffs",
    "cam0.resolution",
];
/// The other keys.
const SHARED: [&str; 3] = ["image_width", "image_height", "model_type"];

impl Mei {
    /// Reads the YAML or XML of OpenCV's omnidir (K, xi, D: also `camera_matrix`, `distortion_coefficients`),
    /// or the YAML of camodocal (`model_type: MEI`) or Kalibr (`camera_model: omni` with `radtan`).
    ///
    /// Reading takes at most 512 bytes of memory for each byte of the file, and 65536 besides.
    ///
    /// # Errors
    /// Returns an error if the file is not as it should be. No bytes make it panic.
    pub fn read(file: &str, bytes: &[u8], viewpoint_height: f64) -> Result<Self, OpticsFileError> {
        let text = std::str::from_utf8(bytes).map_err(|_| OpticsFileError::NotText)?;
        let known = known_keys(&[&CAMODOCAL[..], &XI].concat());
        let found = values(text, &known)?;
        let image = image(&found)?;
        let (xi, [k1, k2, p1, p2], matrix) =
            if found.has("model_type") || found.has("mirror_parameters.xi") {
                camodocal(&found)?
            } else if found.has("cam0.camera_model") {
                kalibr(&found)?
            } else {
                omnidir(&found)?
            };
        Self {
            file: file.to_owned(),
            viewpoint_height,
            image,
            xi: within("xi", xi, [0.0, 100.0])?,
            radial: [within("k1", k1, [-1e3, 1e3])?, within("k2", k2, [-1e3, 1e3])?],
            tangential: [within("p1", p1, [-1.0, 1.0])?, within("p2", p2, [-1.0, 1.0])?],
            matrix: PixelMatrix::new(matrix)?,
            reach: 0.0,
        }
        .reaching()
    }

    fn reaching(mut self) -> Result<Self, OpticsFileError> {
        // The plane shows nothing farther out; 100 is half a degree below level if xi is 0.
        let end = if self.xi > 1.0 { 1.0 / (self.xi * self.xi - 1.0).sqrt() } else { 100.0_f64 };
        // The distortion's derivative is symmetric. In a disc in which both of its eigenvalues are
        // positive, no two points are distorted to the same one. Radially and across they are at least:
        let ([k1, k2], [p1, p2]) = (self.radial, self.tangential);
        let tangential = -6.0 * Vector2::new(p1, p2).norm();
        let across = [1.0 - Self::LEAST_SLOPE, tangential, k1, 0.0, k2];
        let along = [1.0 - Self::LEAST_SLOPE, tangential, 3.0 * k1, 0.0, 5.0 * k2];
        let first = |slope: &[f64]| first_change(slope, [0.0, end]).unwrap_or(end);
        self.reach = first(&across).min(first(&along));
        if self.reach < 1e-3 { Err(OpticsFileError::NoView) } else { Ok(self) }
    }

    /// The least scale of the distortion for a small piece of the plane.
    const LEAST_SLOPE: f64 = 0.02;

    pub(super) fn scaled(&self, factor: f64, image: [u32; 2]) -> Self {
        Self { image: Some(image), matrix: self.matrix.scaled(factor), ..self.clone() }
    }

    pub(super) fn ray(&self, pixel: Point2<f64>) -> Option<ViewingRay> {
        let at = self.undistorted(self.matrix.plane(pixel))?;
        let square = at.norm_squared();
        let under_root = 1.0 + (1.0 - self.xi * self.xi) * square;
        if under_root.is_nan() || under_root < 0.0 {
            return None;
        }
        let scale = (self.xi + under_root.sqrt()) / (1.0 + square);
        Some(ViewingRay {
            origin: Point3::new(0.0, 0.0, self.viewpoint_height),
            direction: Vector3::new(scale * at.x, -scale * at.y, self.xi - scale),
        })
    }

    pub(super) fn pixel(&self, ground: Point2<f64>) -> Option<Point2<f64>> {
        let down = self.viewpoint_height;
        let far = Vector2::new(ground.coords.norm(), down).norm();
        let at = Vector2::new(ground.x, -ground.y) / (down + self.xi * far);
        let radius = at.norm();
        if radius.is_nan() || radius > self.reach {
            return None;
        }
        let (at, _) = self.distorted(at);
        Some(self.matrix.pixel(at))
    }

    fn distorted(&self, at: Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
        let [x, y] = at.into();
        let ([k1, k2], [p1, p2]) = (self.radial, self.tangential);
        let square = x * x + y * y;
        let scale = 1.0 + square * (k1 + square * k2);
        let slope = 2.0 * (k1 + 2.0 * k2 * square);
        let across = slope * x * y + 2.0 * p1 * x + 2.0 * p2 * y;
        (
            Vector2::new(
                x * scale + 2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
                y * scale + 2.0 * p2 * x * y + p1 * (square + 2.0 * y * y),
            ),
            Matrix2::new(
                scale + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x,
                across,
                across,
                scale + slope * y * y + 2.0 * p2 * x + 6.0 * p1 * y,
            ),
        )
    }

    fn undistorted(&self, distorted: Vector2<f64>) -> Option<Vector2<f64>> {
        let near = 1e-13 * (1.0 + distorted.norm());
        let lack = |at: Vector2<f64>| {
            let (found, slope) = self.distorted(at);
            (at, distorted - found, slope)
        };
        let (mut at, mut rest, mut slope) = lack(self.undistorted_radially(distorted)?);
        for _ in 0..50 {
            if rest.norm() <= near {
                return Some(at);
            }
            let step = slope.try_inverse()? * rest;
            // Newton's step, shortened if it does not get nearer.
            (at, rest, slope) = (0..30).find_map(|halves| {
                let share = 0.5_f64.powi(halves);
                let next = lack(at + share * step);
                let inside = next.0.norm() <= self.reach;
                (inside && next.1.norm() < rest.norm()).then_some(next)
            })?;
        }
        None
    }

    /// The same without tangential distortion, inside the reach. `None` if a point outside of the reach
    /// is distorted to here.
    fn undistorted_radially(&self, distorted: Vector2<f64>) -> Option<Vector2<f64>> {
        let far = distorted.norm();
        if far == 0.0 {
            return Some(distorted);
        }
        let ([k1, k2], [p1, p2]) = (self.radial, self.tangential);
        let lack = |radius: f64| {
            let (value, slope) = polynomial(&[0.0, 1.0, 0.0, k1, 0.0, k2], radius);
            (value - far, slope)
        };
        let shifted = 3.0 * Vector2::new(p1, p2).norm() * self.reach * self.reach;
        let end = lack(self.reach).0;
        let radius = if end > 0.0 {
            root(lack, [0.0, self.reach], far)
        } else if end >= -shifted {
            self.reach
        } else {
            return None;
        };
        Some(distorted * radius / far)
    }
}

/// xi, the four numbers of the distortion, and the variable numbers of the matrix.
type Numbers = (f64, [f64; 4], [f64; 5]);

fn camodocal(found: &yaml::Values<'_>) -> Result<Numbers, OpticsFileError> {
    expect_model(found, "model_type", "MEI")?;
    let [xi, k1, k2, p1, p2, gamma1, u0, gamma2, v0] = found.each(CAMODOCAL)?;
    Ok((xi, [k1, k2, p1, p2], [gamma1, 0.0, u0, gamma2, v0]))
}

/// Kalibr's `omni` is this model, and its `radtan` this distortion.
fn kalibr(found: &yaml::Values<'_>) -> Result<Numbers, OpticsFileError> {
    expect_model(found, "cam0.camera_model", "omni")?;
    expect_model(found, "cam0.distortion_model", "radtan")?;
    let [xi, gamma1, gamma2, u0, v0] = found.numbers("cam0.intrinsics")?;
    let distortion = found.numbers("cam0.distortion_coeffs")?;
    Ok((xi, distortion, [gamma1, 0.0, u0, gamma2, v0]))
}

/// The keys that all models have, and these.
pub(super) fn known_keys(own: &[&'static str]) -> Vec<&'static str> {
    [&SHARED[..], &KALIBR, MATRIX.as_flattened(), own].concat()
}

/// The values of known keys in YAML or XML.
pub(super) fn values<'k>(
    text: &str,
    known: &'k [&'static str],
) -> Result<yaml::Values<'k>, OpticsFileError> {
    let is_xml = text.trim_start().starts_with('<');
    if is_xml { xml::values(text, known) } else { yaml::values(text, known) }
}

/// Width and height of the images, if the file gives them.
pub(super) fn image(found: &yaml::Values<'_>) -> Result<Option<[u32; 2]>, OpticsFileError> {
    const KEYS: [&str; 2] = ["image_width", "image_height"];
    let sides = if KEYS.iter().any(|key| found.has(key)) {
        [found.number(KEYS[0])?, found.number(KEYS[1])?]
    } else if found.has("cam0.resolution") {
        found.numbers("cam0.resolution")?
    } else {
        return Ok(None);
    };
    let [width, height] = [0, 1].map(|axis| side_of_image(KEYS[axis], sides[axis]));
    Ok(Some([width?, height?]))
}

pub(super) fn expect_model(
    found: &yaml::Values<'_>,
    key: &'static str,
    expected: &'static str,
) -> Result<(), OpticsFileError> {
    match found.text(key).filter(|&model| model != expected) {
        None => Ok(()),
        Some(model) => Err(OpticsFileError::OtherModel { key, found: shown(model), expected }),
    }
}

fn omnidir(found: &yaml::Values<'_>) -> Result<Numbers, OpticsFileError> {
    let [matrix, distortion] = MATRIX.map(|keys| found.first_of(&keys));
    let matrix = found.numbers(matrix)?;
    let [xi] = found.numbers(found.first_of(&XI))?;
    let distortion = found.numbers(distortion)?;
    Ok((xi, distortion, PixelMatrix::numbers(matrix)))
}
