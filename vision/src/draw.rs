//! Lines, circles and polygons on an image. What lies outside of the image is left out.

use image::{Rgb, RgbImage};
use nalgebra::Point2;

/// The pixels around each pixel of a thick line.
pub(crate) const PEN: [[f32; 2]; 5] =
    [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];

/// A picture of a plane, and the pixel of each point of the plane.
pub(crate) struct Canvas<P> {
    pub(crate) picture: RgbImage,
    pub(crate) pixel: P,
}

impl<P: Fn(Point2<f64>) -> [f32; 2]> Canvas<P> {
    pub(crate) fn line(&mut self, from: Point2<f64>, to: Point2<f64>, colour: Rgb<u8>) {
        line(&mut self.picture, (self.pixel)(from), (self.pixel)(to), colour);
    }

    pub(crate) fn thick(&mut self, from: Point2<f64>, to: Point2<f64>, colour: Rgb<u8>) {
        let ends = [from, to].map(&self.pixel);
        for [right, down] in PEN {
            let [from, to] = ends.map(|[u, v]| [u + right, v + down]);
            line(&mut self.picture, from, to, colour);
        }
    }

    pub(crate) fn dot(&mut self, point: Point2<f64>, radius: i32, colour: Rgb<u8>) {
        disc(&mut self.picture, (self.pixel)(point).map(|at| at as i32), radius, colour);
    }

    /// A circle, two pixels wide.
    pub(crate) fn ring(&mut self, point: Point2<f64>, radius: i32, colour: Rgb<u8>) {
        let middle = (self.pixel)(point).map(|at| at as i32);
        for radius in [radius - 1, radius] {
            ring(&mut self.picture, middle, radius, colour);
        }
    }
}

fn put(image: &mut RgbImage, u: i32, v: i32, colour: Rgb<u8>) {
    if let (Ok(u), Ok(v)) = (u.try_into(), v.try_into())
        && let Some(pixel) = image.get_pixel_mut_checked(u, v)
    {
        *pixel = colour;
    }
}

pub(crate) fn line(image: &mut RgbImage, from: [f32; 2], to: [f32; 2], colour: Rgb<u8>) {
    let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
    let turned = |[u, v]: [f32; 2]| if steep { [v, u] } else { [u, v] };
    let (mut from, mut to) = (turned(from), turned(to));
    if from[0] > to[0] {
        std::mem::swap(&mut from, &mut to);
    }
    let [along, across] = [to[0] - from[0], (to[1] - from[1]).abs()];
    let step = if from[1] < to[1] { 1 } else { -1 };
    let (mut error, mut v) = (along / 2.0, from[1] as i32);
    for u in from[0] as i32..=to[0] as i32 {
        if steep {
            put(image, v, u, colour);
        } else {
            put(image, u, v, colour);
        }
        error -= across;
        if error < 0.0 {
            v += step;
            error += along;
        }
    }
}

/// The places of an eighth of a circle around the origin, from the axis to the diagonal.
fn eighth(radius: i32) -> impl Iterator<Item = (i32, i32)> {
    let (mut x, mut y, mut off) = (0, radius, 1 - radius);
    std::iter::from_fn(move || {
        let place = (x, y);
        x += 1;
        if off < 0 {
            off += 2 * x + 1;
        } else {
            y -= 1;
            off += 2 * (x - y) + 1;
        }
        (place.0 <= place.1).then_some(place)
    })
}

pub(crate) fn ring(image: &mut RgbImage, [u, v]: [i32; 2], radius: i32, colour: Rgb<u8>) {
    for (x, y) in eighth(radius) {
        for (right, down) in
            [(x, y), (y, x), (-y, x), (-x, y), (-x, -y), (-y, -x), (y, -x), (x, -y)]
        {
            put(image, u + right, v + down, colour);
        }
    }
}

pub(crate) fn disc(image: &mut RgbImage, [u, v]: [i32; 2], radius: i32, colour: Rgb<u8>) {
    for (x, y) in eighth(radius) {
        for (half, down) in [(x, y), (y, x), (x, -y), (y, -x)] {
            (u - half..=u + half).for_each(|u| put(image, u, v + down, colour));
        }
    }
}

pub(crate) fn convex_polygon(image: &mut RgbImage, corners: &[[i32; 2]], colour: Rgb<u8>) {
    let rows = corners.iter().map(|corner| corner[1]);
    let (Some(first), Some(last)) = (rows.clone().min(), rows.max()) else { return };
    let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
    let height = i32::try_from(image.height()).unwrap_or(i32::MAX);
    for v in first.max(0)..=last.min(height - 1) {
        let crossings = sides().filter_map(|(from, to)| {
            let [from, to] = if from[1] <= to[1] { [from, to] } else { [to, from] };
            let share = (v - from[1]) as f32 / (to[1] - from[1]) as f32;
            ((from[1]..to[1]).contains(&v))
                .then(|| (from[0] as f32 + share * (to[0] - from[0]) as f32).round() as i32)
        });
        if let (Some(left), Some(right)) = (crossings.clone().min(), crossings.max()) {
            (left..=right).for_each(|u| put(image, u, v, colour));
        }
    }
    for (from, to) in sides() {
        line(image, from.map(|part| part as f32), to.map(|part| part as f32), colour);
    }
}
