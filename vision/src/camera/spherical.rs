//! The spherical mirror above a camera that looks up, in closed form.
//!
//! All of it happens in a plane through the axis. A ray leaves the pinhole at an angle alpha from the
//! axis and meets the sphere at an angle theta, seen from the sphere's centre, from its lowest point.
//! It goes on at psi = alpha + 2 theta from straight down. With R the sphere's radius, d the distance
//! from the pinhole up to its centre and H the height of its centre above the floor:
//!
//! * sin(alpha + theta) = (d / R) sin(alpha), the law of sines;
//! * the floor is met at R sin(theta) + (H - R cos(theta)) tan(psi) from the axis;
//! * sin(psi) and cos(psi) are as d sin(2 theta) - R sin(theta) to d cos(2 theta) - R cos(theta).

use super::{Ray, root::root, scaled_place};

/// A pinhole camera under a spherical mirror, both on a vertical axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalMirror {
    /// Where the axis meets the image, in pixels.
    pub centre: [f64; 2],
    /// Focal length, in pixels.
    pub focal: f64,
    /// Radius of the sphere, in metres.
    pub mirror_radius: f64,
    /// From the pinhole up to the sphere's centre, in metres; more than the radius.
    pub mirror_distance: f64,
    /// From the floor up to the pinhole, in metres.
    pub camera_height: f64,
}

impl SphericalMirror {
    /// How far from the centre the mirror ends in the image, in pixels.
    #[must_use]
    pub fn rim(&self) -> f64 {
        self.focal * (self.mirror_radius / self.mirror_distance).asin().tan()
    }

    /// How far from the centre the horizon is in the image, in pixels: always inside of the rim.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.radius_at(self.horizon_angle())
    }

    /// How far from the axis the floor is that is seen so many pixels from the centre, in metres;
    /// `None` from the horizon on.
    #[must_use]
    pub fn range(&self, radius: f64) -> Option<f64> {
        let [u, v] = self.centre;
        self.ray([u + radius, v])?.floor().map(|[range, _]| range)
    }

    /// How many pixels from the centre the floor is seen that is so far from the axis.
    #[must_use]
    pub fn radius(&self, range: f64) -> Option<f64> {
        range.is_finite().then(|| self.radius_at(self.angle_of(range.abs())))
    }

    /// The same, with every pixel larger.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self { centre: scaled_place(self.centre, factor), focal: factor * self.focal, ..*self }
    }

    /// The ray of a pixel, in the image's axes.
    pub(super) fn ray(&self, pixel: [f64; 2]) -> Option<Ray> {
        let [right, top] = [pixel[0] - self.centre[0], self.centre[1] - pixel[1]];
        let radius = right.hypot(top);
        let alpha = radius.atan2(self.focal);
        let sine = self.mirror_distance / self.mirror_radius * alpha.sin();
        if sine.is_nan() || sine > 1.0 {
            return None;
        }
        let theta = sine.asin() - alpha;
        let (across, below) = theta.sin_cos();
        let (out, down) = (alpha + 2.0 * theta).sin_cos();
        // The middle of the image looks along the axis, in no direction.
        let [right, top] = if radius > 0.0 { [right / radius, top / radius] } else { [0.0; 2] };
        let at = self.mirror_radius * across;
        let height = self.height() - self.mirror_radius * below;
        Some(Ray {
            origin: [at * right, at * top, height],
            direction: [out * right, out * top, -down],
        })
    }

    /// The pixel that shows a point of the floor, in the image's axes.
    pub(super) fn pixel(&self, [right, top]: [f64; 2]) -> Option<[f64; 2]> {
        let range = right.hypot(top);
        if range == 0.0 {
            return Some(self.centre);
        }
        let scale = self.radius(range)? / range;
        Some([self.centre[0] + scale * right, self.centre[1] - scale * top])
    }

    /// How high above the floor the sphere's centre is.
    fn height(&self) -> f64 {
        self.camera_height + self.mirror_distance
    }

    /// The pixels from the centre at an angle theta.
    fn radius_at(&self, theta: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        let up = self.mirror_distance - self.mirror_radius * cosine;
        self.focal * self.mirror_radius * sine / up
    }

    /// The angle theta at which psi is a right angle: d cos(2 theta) = R cos(theta).
    fn horizon_angle(&self) -> f64 {
        let (radius, distance) = (self.mirror_radius, self.mirror_distance);
        let root = (radius * radius + 8.0 * distance * distance).sqrt();
        ((radius + root) / (4.0 * distance)).acos()
    }

    /// The angle theta at which the floor is seen that is so far from the axis.
    ///
    /// The range grows with theta, without end at the horizon. So theta is the one root of what the
    /// range lacks, times cos(psi), between straight down and the horizon.
    fn angle_of(&self, range: f64) -> f64 {
        let (radius, distance) = (self.mirror_radius, self.mirror_distance);
        let lack = |theta: f64| {
            let (sine, cosine) = theta.sin_cos();
            let (twice_sine, twice_cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
            let at = radius * sine - range;
            let height = self.height() - radius * cosine;
            let out = distance * twice_sine - radius * sine;
            let down = distance * twice_cosine - radius * cosine;
            let slope = radius * cosine * down
                + at * (radius * sine - 2.0 * distance * twice_sine)
                + radius * sine * out
                + height * (2.0 * distance * twice_cosine - radius * cosine);
            (at * down + height * out, slope)
        };
        let horizon = self.horizon_angle();
        // As if the mirror were small, and its slope everywhere that of its lowest point.
        let guess = (range / self.height()).atan() / (2.0 + radius / (distance - radius));
        root(lack, [0.0, horizon], guess)
    }
}
