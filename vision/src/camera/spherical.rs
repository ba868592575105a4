//! The spherical mirror above a camera that looks up, in closed form.
//!
//! Everything is in a plane through the axis. A ray leaves the pinhole at an angle alpha from the
//! axis and meets the sphere at an angle theta, seen from the sphere's centre, from its lowest point.
//! It is reflected at psi = alpha + 2 theta from straight down. With R the sphere's radius, d the distance
//! from the pinhole up to its centre and H the height of its centre above the floor:
//!
//! * sin(alpha + theta) = (d / R) sin(alpha), the law of sines; in the code, the same without angles: the
//!   ray's intersection with a circle;
//! * the floor is met at R sin(theta) + (H - R cos(theta)) tan(psi) from the axis;
//! * sin(psi) and cos(psi) are as d sin(2 theta) - R sin(theta) to d cos(2 theta) - R cos(theta).

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::{ViewingRay, root::root, scaled_place};

/// A pinhole camera under a spherical mirror, both on a vertical axis.
// paper: hardware.camera
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalMirror {
    /// The point at which the axis meets the image, in pixels.
    pub centre: Point2<f64>,
    /// Focal length, in pixels.
    pub focal: f64,
    /// Radius of the sphere, in metres.
    pub mirror_radius: f64,
    /// The height of the sphere's centre above the pinhole, in metres; more than the radius.
    pub mirror_distance: f64,
    /// The height of the pinhole above the floor, in metres.
    pub camera_height: f64,
}

impl SphericalMirror {
    /// The radius of the mirror's rim in the image, in pixels.
    pub fn rim(&self) -> f64 {
        self.focal * (self.mirror_radius / self.mirror_distance).asin().tan()
    }

    /// The focal length for which the rim has this radius in pixels.
    pub fn focal_of_rim(rim: f64, mirror_radius: f64, mirror_distance: f64) -> f64 {
        rim / (mirror_radius / mirror_distance).asin().tan()
    }

    /// The radius of the horizon in the image, in pixels. It is always inside of the rim.
    pub fn horizon(&self) -> f64 {
        self.radius_at(self.horizon_sine())
    }

    /// The distance from the axis of the floor that is seen this many pixels from the centre, in metres;
    /// `None` from the horizon on.
    pub fn range(&self, radius: f64) -> Option<f64> {
        let pixel = self.centre + Vector2::new(radius, 0.0);
        self.ray(pixel)?.floor().map(|ground| ground.x)
    }

    /// The distance from the centre, in pixels, at which the floor at this distance from the axis is
    /// seen.
    pub fn radius(&self, range: f64) -> Option<f64> {
        range.is_finite().then(|| self.radius_at(self.sine_of(range.abs())))
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self { centre: scaled_place(self.centre, factor), focal: factor * self.focal, ..*self }
    }

    pub(super) fn ray(&self, pixel: Point2<f64>) -> Option<ViewingRay> {
        let off = Vector2::new(pixel.x - self.centre.x, self.centre.y - pixel.y);
        let (radius, distance) = (self.mirror_radius, self.mirror_distance);
        // In coordinates from the pinhole (away from the axis, up): the ray, and its intersection with
        // the sphere.
        let from_centre = off.norm();
        let focal_ray = Vector2::new(from_centre, self.focal).norm();
        let along = distance * self.focal / focal_ray;
        let half_chord = along * along - (distance * distance - radius * radius);
        if half_chord.is_nan() || half_chord < 0.0 {
            return None;
        }
        let share = (along - half_chord.sqrt()) / focal_ray;
        let [at, up] = [share * from_centre, share * self.focal];
        // The reflected ray has the angle alpha + 2 theta.
        let (sine, cosine) = (at / radius, (distance - up) / radius);
        let (twice_sine, twice_cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
        let scale = 1.0 / (share * focal_ray);
        let out = scale * (at * twice_cosine + up * twice_sine);
        let down = scale * (up * twice_cosine - at * twice_sine);
        // The middle of the image looks along the axis, so it has no azimuth.
        let level = if from_centre > 0.0 { 1.0 / from_centre } else { 0.0 };
        let [right, top] = (level * off).into();
        Some(ViewingRay {
            origin: Point3::new(at * right, at * top, self.camera_height + up),
            direction: Vector3::new(out * right, out * top, -down),
        })
    }

    pub(super) fn pixel(&self, ground: Point2<f64>) -> Option<Point2<f64>> {
        let range = ground.coords.norm();
        if range == 0.0 {
            return Some(self.centre);
        }
        let scale = self.radius(range)? / range;
        Some(self.centre + scale * Vector2::new(ground.x, -ground.y))
    }

    fn height(&self) -> f64 {
        self.camera_height + self.mirror_distance
    }

    /// The distance from the centre, in pixels, at an angle theta given by its sine.
    fn radius_at(&self, sine: f64) -> f64 {
        let up = self.mirror_distance - self.mirror_radius * (1.0 - sine * sine).sqrt();
        self.focal * self.mirror_radius * sine / up
    }

    /// The sine of the angle theta at which psi is a right angle: d cos(2 theta) = R cos(theta).
    fn horizon_sine(&self) -> f64 {
        let (radius, distance) = (self.mirror_radius, self.mirror_distance);
        let root = (radius * radius + 8.0 * distance * distance).sqrt();
        let cosine = (radius + root) / (4.0 * distance);
        (1.0 - cosine * cosine).sqrt()
    }

    /// The sine of the angle theta at which the floor at this distance from the axis is seen.
    ///
    /// The distance grows with theta, to infinity at the horizon. So theta is the only root of the
    /// difference from the given distance, times cos(psi), between straight down and the horizon.
    fn sine_of(&self, range: f64) -> f64 {
        let (radius, distance) = (self.mirror_radius, self.mirror_distance);
        let lack = |sine: f64| {
            let cosine = (1.0 - sine * sine).sqrt();
            let (twice_sine, twice_cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
            let at = radius * sine - range;
            let height = self.height() - radius * cosine;
            let out = distance * twice_sine - radius * sine;
            let down = distance * twice_cosine - radius * cosine;
            let by_angle = radius * cosine * down
                + at * (radius * sine - 2.0 * distance * twice_sine)
                + radius * sine * out
                + height * (2.0 * distance * twice_cosine - radius * cosine);
            (at * down + height * out, by_angle / cosine)
        };
        // A first guess: a single viewpoint, and a mirror that is flat like its lowest point.
        let viewpoint = self.height() - 0.5 * radius;
        let half_tangent = range / (viewpoint + Vector2::new(viewpoint, range).norm());
        let half_sine = half_tangent / Vector2::new(1.0, half_tangent).norm();
        let guess = 2.0 * half_sine / (2.0 + radius / (distance - radius));
        root(lack, [0.0, self.horizon_sine()], guess)
    }
}
