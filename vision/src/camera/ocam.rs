//! The polynomial model of OCamCalib, and its file `calib_results.txt`.
//!
//! D. Scaramuzza, A. Martinelli, R. Siegwart: A toolbox for easily calibrating omnidirectional cameras.
//! IROS 2006. A pixel, minus the centre and without the affine distortion, is a point (x, y) of a plane,
//! x along the image's columns and y along its rows. It looks along (x, y, f(rho)), where f is the
//! polynomial and rho the length of (x, y). The middle looks straight down here, so f(0) is downward,
//! whatever its sign: calibration with a plane pattern does not determine the sign.
//!
//! The file, as OCamCalib writes it, has five lines of numbers between comments (`#`): the polynomial
//! (the number of coefficients, then the coefficients, the constant first), a polynomial that is roughly
//! its inverse, the centre's row and column, the affine c, d and e, and the image's height and width. In
//! the file rows and columns count from 0 (in the toolbox itself, from 1).

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::{
    ViewingRay,
    optics_file::{OpticsFileError, finite, side_of_image, within},
    root::{first_change, polynomial, root},
    scaled_place,
};

#[derive(Clone, Debug, PartialEq)]
pub struct OCam {
    /// The file with the calibration, as the calibration file names it.
    pub file: String,
    /// The height of the viewpoint above the floor, in metres.
    pub viewpoint_height: f64,
    pub(super) image: [u32; 2],
    /// The polynomial: how far down a point of the plane looks, by its distance from the middle.
    /// Positive in the middle.
    down: Vec<f64>,
    /// Roughly its inverse: the distance from the middle by the angle above level.
    inverse: Vec<f64>,
    pub(super) centre: Point2<f64>,
    /// c, d and e: rows and columns are `[[c, d], [e, 1]]` times (x, y).
    affine: [f64; 3],
    /// The distance from the middle up to which points look farther and farther out.
    reach: f64,
    /// The distance from the middle up to which points look at the floor.
    horizon: f64,
}

impl OCam {
    /// Reads `calib_results.txt`.
    ///
    /// Reading takes at most 32 bytes of memory for each byte of the file, and 4096 besides.
    ///
    /// # Errors
    /// Returns an error if the file is not as it should be. No bytes make it panic.
    pub fn read(file: &str, bytes: &[u8], viewpoint_height: f64) -> Result<Self, OpticsFileError> {
        let text = std::str::from_utf8(bytes).map_err(|_| OpticsFileError::NotText)?;
        let mut lines = Lines::new(text);
        let direct = lines.counted("the polynomial")?;
        let inverse = lines.counted("the inverse polynomial")?;
        let [row, column] = lines.numbers("the centre's row and column")?;
        let affine = lines.numbers("the affine c, d and e")?;
        let size = lines.numbers("the height and the width of the image")?;
        lines.end()?;
        let [height, width] = size.map(|side| side_of_image("the side of the image", side));
        let (height, width) = (height?, width?);
        let row = within("the centre's row", row, [0.0, f64::from(height) - 1.0])?;
        let column = within("the centre's column", column, [0.0, f64::from(width) - 1.0])?;
        within("the affine c", affine[0], [0.5, 2.0])?;
        within("the affine d", affine[1], [-0.5, 0.5])?;
        within("the affine e", affine[2], [-0.5, 0.5])?;
        Self {
            file: file.to_owned(),
            viewpoint_height,
            image: [width, height],
            down: direct,
            inverse,
            centre: Point2::new(column, row),
            affine,
            reach: 0.0,
            horizon: 0.0,
        }
        .reaching()
    }

    fn reaching(mut self) -> Result<Self, OpticsFileError> {
        let constant = self.down.first().copied().unwrap_or_default();
        within("the size of the first coefficient", constant.abs(), [1.0, 1e6])?;
        if constant < 0.0 {
            self.down.iter_mut().for_each(|coefficient| *coefficient = -*coefficient);
        }
        let [width, height] = self.image.map(f64::from);
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        let edge = corners.map(|corner| self.plane(corner.into()).norm());
        let edge = edge.into_iter().fold(0.0, f64::max);
        within("the polynomial at the edge", polynomial(&self.down, edge).0, [-1e9, 1e9])?;
        // The angle from straight down grows with rho for as long as f - rho f' is positive.
        let growth = |(coefficient, power): (&f64, u32)| coefficient * (1.0 - f64::from(power));
        let growing: Vec<f64> = self.down.iter().zip(0_u32..).map(growth).collect();
        self.reach = first_change(&growing, [0.0, edge]).unwrap_or(edge);
        self.horizon = first_change(&self.down, [0.0, self.reach]).unwrap_or(self.reach);
        if self.horizon < 1.0 { Err(OpticsFileError::NoView) } else { Ok(self) }
    }

    /// The same camera with an image that is scaled by a factor: the plane's coordinates and f are
    /// scaled, too.
    pub(super) fn scaled(&self, factor: f64, image: [u32; 2]) -> Self {
        let mut scaled = self.clone();
        scaled.image = image;
        scaled.centre = scaled_place(self.centre, factor);
        for (coefficient, power) in scaled.down.iter_mut().zip(0..) {
            *coefficient *= factor.powi(1 - power);
        }
        scaled.inverse.iter_mut().for_each(|coefficient| *coefficient *= factor);
        scaled.reach *= factor;
        scaled.horizon *= factor;
        scaled
    }

    /// The point of the model's plane at a pixel: to the right, and to the top.
    fn plane(&self, pixel: Point2<f64>) -> Vector2<f64> {
        let ([c, d, e], [column, row]) = (self.affine, (pixel - self.centre).into());
        let scale = 1.0 / (c - d * e);
        Vector2::new(scale * (c * column - e * row), -scale * (row - d * column))
    }

    pub(super) fn ray(&self, pixel: Point2<f64>) -> Option<ViewingRay> {
        let across = self.plane(pixel);
        let rho = across.norm();
        if rho.is_nan() || rho > self.reach {
            return None;
        }
        let down = polynomial(&self.down, rho).0;
        let length = Vector2::new(rho, down).norm();
        Some(ViewingRay {
            origin: Point3::new(0.0, 0.0, self.viewpoint_height),
            direction: Vector3::new(across.x, across.y, -down) / length,
        })
    }

    /// The pixel that shows a point of the floor, in the image's axes.
    ///
    /// The search starts with the file's own inverse, which is only an approximation.
    pub(super) fn pixel(&self, ground: Point2<f64>) -> Option<Point2<f64>> {
        let range = ground.coords.norm();
        let lack = |rho: f64| {
            let (down, slope) = polynomial(&self.down, rho);
            (rho * self.viewpoint_height - range * down, self.viewpoint_height - range * slope)
        };
        // Only at a finite distance, and in the range in which the polynomial is valid.
        if !range.is_finite() || lack(self.horizon).0 < 0.0 {
            return None;
        }
        let scale = if range > 0.0 {
            let guess = polynomial(&self.inverse, -self.viewpoint_height.atan2(range)).0;
            root(lack, [0.0, self.horizon], guess) / range
        } else {
            0.0
        };
        let ([c, d, e], [x, y]) = (self.affine, [-scale * ground.y, scale * ground.x]);
        Some(Point2::new(self.centre.x + e * x + y, self.centre.y + c * x + d * y))
    }
}

/// The lines of a file that are not empty, each with its number.
struct Lines<'a> {
    lines: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
}

impl<'a> Lines<'a> {
    fn new(text: &'a str) -> Self {
        let lines = (1..).zip(text.lines().map(str::trim));
        Self { lines: Box::new(lines.filter(|(_, line)| !line.is_empty())) }
    }

    fn next(&mut self, what: &'static str) -> Result<(usize, Vec<f64>), OpticsFileError> {
        let mut lines = self.lines.by_ref().skip_while(|(_, line)| line.starts_with('#'));
        let (line, text) = lines.next().ok_or(OpticsFileError::EndsBefore(what))?;
        let numbers = text.split_whitespace().map(|word| finite(word, line));
        Ok((line, numbers.collect::<Result<_, _>>()?))
    }

    /// The numbers of the next line, which must be `N`.
    fn numbers<const N: usize>(&mut self, what: &'static str) -> Result<[f64; N], OpticsFileError> {
        let (line, numbers) = self.next(what)?;
        numbers.try_into().map_err(|numbers: Vec<f64>| OpticsFileError::LineCount {
            line,
            what,
            found: numbers.len(),
            expected: N,
        })
    }

    /// The numbers of the next line after the first, which is their count.
    fn counted(&mut self, what: &'static str) -> Result<Vec<f64>, OpticsFileError> {
        let (line, mut numbers) = self.next(what)?;
        let count = numbers.remove(0);
        within("the number of coefficients", count, [1.0, 64.0])?;
        if (count - numbers.len() as f64).abs() > 0.0 {
            return Err(OpticsFileError::FalseCount { line, what, found: numbers.len(), count });
        }
        Ok(numbers)
    }

    /// Other programs add sections, each after a comment.
    fn end(&mut self) -> Result<(), OpticsFileError> {
        let next = self.lines.next().filter(|(_, text)| !text.starts_with('#'));
        next.map_or(Ok(()), |(line, _)| Err(OpticsFileError::GoesOn { line }))
    }
}
