//! The floor from straight above. Section 3, Figure 6(c).
//!
//! The pixel of the image that shows a point of the floor never changes, so tables that are computed once from the
//! calibration unwrap an image. Far from the robot one pixel of the image shows many pixels of the view, and most pixels of
//! the image show none. So each pixel of the image that shows floor is classified once, and what looks at the view finds
//! its class there.

use std::sync::Arc;

use image::RgbImage;
use nalgebra::Point2;

use crate::{
    bearing::{STEP, ground_on_bearings},
    camera::Camera,
    colour::{LitTable, PixelClass},
};

/// The floor around the robot, seen from straight above: the robot in the middle, ahead up, left to the
/// left. Its pixels are in rows from ahead to behind, each from left to right.
// paper: sense.orthographic
#[derive(Clone, Debug)]
pub struct GroundView {
    unwrapping: Arc<Unwrapping>,
    /// The class of each pixel of the image that shows floor, and last that of what no pixel shows.
    pub(crate) classes: Vec<PixelClass>,
}

/// Which pixel of a camera's images shows each pixel of the ground view.
#[derive(Debug)]
struct Unwrapping {
    /// The pixels of the image that show floor, ascending. Their *number* is their index here; that of what no pixel shows
    /// is one more.
    pixels: Vec<u32>,
    /// For each pixel of the ground view, the number of the image's pixel.
    shown_by: Vec<u32>,
    /// The same for the steps along each bearing.
    on_bearings: Vec<u32>,
    /// The pixels of the ground view in the order of their numbers, and where those of each number begin.
    shown: Vec<u32>,
    begins: Vec<u32>,
}

impl GroundView {
    pub const SIDE: usize = 800;
    /// Metres per pixel.
    pub const SCALE: f64 = STEP;
    /// Metres from the robot to the middle of each side.
    pub const REACH: f64 = Self::SCALE * Self::SIDE as f64 / 2.0;
    /// The pixels from the robot to the middle of the first row's pixels, and of the first column's.
    const MIDDLE: f64 = (Self::SIDE as f64 - 1.0) / 2.0;

    /// The view of a camera before its first image.
    pub fn unseen(camera: &Camera) -> Self {
        let pixels =
            (0..Self::SIDE * Self::SIDE).map(|index| camera.seen_pixel(Self::ground(index)));
        Self::through(Unwrapping::new(&pixels.collect::<Vec<_>>()))
    }

    /// An unseen view whose pixels a test draws: `classes` has one for each.
    #[cfg(test)]
    pub(crate) fn drawn() -> Self {
        let pixels = (0..Self::SIDE * Self::SIDE).map(|index| Some(index as u32));
        Self::through(Unwrapping::new(&pixels.collect::<Vec<_>>()))
    }

    fn through(unwrapping: Unwrapping) -> Self {
        let classes = vec![PixelClass::Unseen; unwrapping.pixels.len() + 1];
        Self { unwrapping: Arc::new(unwrapping), classes }
    }

    /// Shows nothing.
    pub fn clear(&mut self) {
        self.classes.fill(PixelClass::Unseen);
    }

    /// Shows an image of the camera's size.
    pub fn show(&mut self, image: &RgbImage, colours: &LitTable<'_>) {
        let (pixels, _) = image.as_raw().as_chunks::<3>();
        for (class, &pixel) in self.classes.iter_mut().zip(&self.unwrapping.pixels) {
            *class = colours.class(pixels.get(pixel as usize).copied().unwrap_or_default());
        }
    }

    /// The class of a pixel; `None` outside of the view.
    pub fn class(&self, index: usize) -> Option<PixelClass> {
        self.unwrapping.shown_by.get(index).map(|&number| self.shown(number))
    }

    /// The classes of all pixels.
    pub fn classes(&self) -> impl Iterator<Item = PixelClass> + '_ {
        self.unwrapping.shown_by.iter().map(|&number| self.shown(number))
    }

    /// The numbers of the image's pixels on bearings, as [`ground_on_bearings`] has them.
    pub(crate) fn on_bearings(&self) -> &[u32] {
        &self.unwrapping.on_bearings
    }

    /// The class of one of the image's pixels, by its number.
    pub(crate) fn shown(&self, number: u32) -> PixelClass {
        self.classes[number as usize]
    }

    /// The pixels of a class, ascending.
    pub fn pixels_of(&self, class: PixelClass) -> Vec<usize> {
        let Unwrapping { shown, begins, .. } = &*self.unwrapping;
        let numbers = (0..self.classes.len()).filter(|&number| self.classes[number] == class);
        let shown =
            numbers.flat_map(|number| &shown[begins[number] as usize..begins[number + 1] as usize]);
        let mut pixels: Vec<usize> = shown.map(|&pixel| pixel as usize).collect();
        pixels.sort_unstable();
        pixels
    }

    /// The point of the floor in the middle of a pixel.
    pub fn ground(index: usize) -> Point2<f64> {
        let (row, column) = (index / Self::SIDE, index % Self::SIDE);
        Point2::new(row, column).map(|at| (Self::MIDDLE - at as f64) * Self::SCALE)
    }

    /// The pixel that contains a point of the floor; `None` outside of the view.
    pub fn index(point: Point2<f64>) -> Option<usize> {
        let [row, column] = point.map(|at| (Self::MIDDLE - at / Self::SCALE).round()).into();
        let inside = 0.0..Self::SIDE as f64;
        (inside.contains(&row) && inside.contains(&column))
            .then(|| row as usize * Self::SIDE + column as usize)
    }
}

impl Unwrapping {
    /// From the pixel of the image that shows each pixel of the ground view, if there is one.
    fn new(shown_by: &[Option<u32>]) -> Self {
        let mut pixels: Vec<u32> = shown_by.iter().flatten().copied().collect();
        pixels.sort_unstable();
        pixels.dedup();
        let number = |pixel: &Option<u32>| {
            let number = pixel.and_then(|pixel| pixels.binary_search(&pixel).ok());
            number.unwrap_or(pixels.len()) as u32
        };
        let shown_by: Vec<u32> = shown_by.iter().map(number).collect();
        let on_bearings = ground_on_bearings()
            .map(|point| shown_by[GroundView::index(point).unwrap_or_default()])
            .collect();
        let mut shown: Vec<u32> = (0..shown_by.len() as u32).collect();
        shown.sort_by_key(|&pixel| shown_by[pixel as usize]);
        let before = |number: u32| shown.partition_point(|&at| shown_by[at as usize] < number);
        let begins = (0..pixels.len() as u32 + 2).map(|number| before(number) as u32).collect();
        Self { pixels, shown_by, on_bearings, shown, begins }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{ColourTable, Gain};

    // paper: sense.orthographic
    #[test]
    fn a_pixel_is_where_its_middle_is() {
        for index in [0, 1, 799, 800, 320_400, 639_999] {
            assert_eq!(GroundView::index(GroundView::ground(index)), Some(index));
        }
        let [x, y] = GroundView::ground(0).into();
        assert!(x > 2.99 && y > 2.99, "the first pixel is far ahead to the left: {x}, {y}");
        assert_eq!(GroundView::index(Point2::new(GroundView::REACH + 0.01, 0.0)), None);
    }

    /// The straightforward way: a lookup for each pixel of the view.
    #[test]
    fn the_classes_are_those_of_the_pixels_of_the_image_that_show_them() {
        // Any colours, and any class for each.
        let mixed = |number: usize| (number.wrapping_mul(0x9e37_79b9) >> 13) as u8;
        let class = |number| PixelClass::ALL[mixed(number) as usize % PixelClass::ALL.len()];
        let table = ColourTable { classes: (0..1 << 18).map(class).collect() };
        for (size, gain) in [([640, 480], 1.0), ([1280, 960], 1.3), ([320, 240], 0.4)] {
            let camera = Camera::superscout().sized(size);
            let lit = table.lit(Gain([gain, 1.0, 0.9 * gain]));
            let colours = (0..3 * (size[0] * size[1]) as usize).map(mixed);
            let image = RgbImage::from_raw(size[0], size[1], colours.collect()).unwrap();
            let mut view = GroundView::unseen(&camera);
            view.show(&image, &lit);
            let expected = |index: usize| match camera.seen_pixel(GroundView::ground(index)) {
                None => PixelClass::Unseen,
                Some(pixel) => lit.class(image.get_pixel(pixel % size[0], pixel / size[0]).0),
            };
            let expected: Vec<_> = (0..GroundView::SIDE * GroundView::SIDE).map(expected).collect();
            assert!(view.classes().eq(expected.iter().copied()));
            let on_bearings = view.on_bearings().iter().map(|&number| view.shown(number));
            assert!(
                on_bearings.eq(ground_on_bearings()
                    .map(|point| expected[GroundView::index(point).unwrap_or_default()]))
            );
            for class in PixelClass::ALL {
                let of_it = expected.iter().enumerate().filter(|(_, at)| **at == class);
                assert!(view.pixels_of(class).into_iter().eq(of_it.map(|(index, _)| index)));
            }
            assert_eq!(view.class(expected.len() - 1), expected.last().copied());
            assert_eq!(view.class(expected.len()), None);
        }
    }
}
