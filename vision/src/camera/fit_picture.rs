//! A calibration drawn over an image.

use image::{Rgb, RgbImage};
use nalgebra::{Point2, Vector2};

use super::{Camera, OpticsModel, rim::Rim};
use crate::{draw, geometry::unit};

const GREEN: Rgb<u8> = Rgb([0, 230, 80]);
const YELLOW: Rgb<u8> = Rgb([255, 230, 0]);
/// The floor at one, two and three metres.
const BLUE: Rgb<u8> = Rgb([70, 150, 255]);
const WHITE: Rgb<u8> = Rgb([255, 255, 255]);

/// An image with a calibration drawn over it: the centre and ahead in white, the rim and the horizon in
/// green, the points of the rim in yellow, the floor at one, two and three metres in blue. What the
/// camera's mask and polygons hide is reddish.
pub fn fit_picture(image: &RgbImage, camera: &Camera, rim: &Rim) -> RgbImage {
    let mut picture = image.clone();
    for (u, v, pixel) in picture.enumerate_pixels_mut() {
        let place = Point2::new(u, v).map(f64::from);
        let is_hidden = camera.mask.as_ref().is_some_and(|mask| !mask.sees([u, v]))
            || camera.hidden.polygons.iter().any(|polygon| polygon.contains(place));
        if is_hidden {
            let [red, green, blue] = pixel.0;
            pixel.0 = [red / 2 + 100, green / 2, blue / 2];
        }
    }
    for range in [1.0, 2.0, 3.0] {
        let at = |angle: f64| camera.ground_to_pixel(Point2::from(range * unit(angle)));
        closed(&mut picture, at, BLUE);
    }
    let round = |radius: f64| move |angle: f64| Some(rim.centre + radius * unit(angle));
    if let OpticsModel::SphericalMirror(mirror) = &camera.optics {
        closed(&mut picture, round(mirror.horizon()), GREEN);
    }
    closed(&mut picture, round(rim.radius), GREEN);
    // On both sides of the rim, so that the rim itself stays visible.
    for place in rim.places.iter().step_by(6) {
        let out = (place - rim.centre) / rim.radius;
        let tick = |far: f64| place + far * out;
        segment(&mut picture, tick(3.0), tick(9.0), YELLOW);
    }
    let middle = camera.middle();
    for arm in [Vector2::new(12.0, 0.0), Vector2::new(0.0, 12.0)] {
        segment(&mut picture, middle - arm, middle + arm, WHITE);
    }
    if let Some(ahead) = camera.ground_to_pixel([1.0, 0.0]) {
        segment(&mut picture, middle, ahead, WHITE);
    }
    picture
}

fn closed(picture: &mut RgbImage, at: impl Fn(f64) -> Option<Point2<f64>>, colour: Rgb<u8>) {
    const STEPS: u32 = 720;
    let angle = |step: u32| f64::from(step) * std::f64::consts::TAU / f64::from(STEPS);
    for step in 0..STEPS {
        if let (Some(from), Some(to)) = (at(angle(step)), at(angle(step + 1))) {
            segment(picture, from, to, colour);
        }
    }
}

fn segment(picture: &mut RgbImage, from: Point2<f64>, to: Point2<f64>, colour: Rgb<u8>) {
    let [from, to] = [from, to].map(|end| end.map(|part| part as f32).into());
    draw::line(picture, from, to, colour);
}
