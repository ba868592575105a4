//! Operations on images of zero and non-zero pixels, and smoothing.

use image::{GrayImage, ImageBuffer, Luma, Rgb};

pub(super) type Colours = ImageBuffer<Rgb<f32>, Vec<f32>>;

/// All pixels that are within a radius, in pixels, of a non-zero one.
pub(super) fn dilate(image: &GrayImage, radius: i32) -> GrayImage {
    spread(image, radius, |pixel| pixel > 0)
}

/// The pixels that no zero pixel is within a radius of.
fn erode(image: &GrayImage, radius: i32) -> GrayImage {
    let mut eroded = spread(image, radius, |pixel| pixel == 0);
    for pixel in eroded.pixels_mut() {
        pixel.0[0] = 255 - pixel.0[0];
    }
    eroded
}

/// Without gaps that are narrower than twice the radius.
pub(super) fn close(image: &GrayImage, radius: i32) -> GrayImage {
    erode(&dilate(image, radius), radius)
}

/// Without pieces that are narrower than twice the radius.
pub(super) fn open(image: &GrayImage, radius: i32) -> GrayImage {
    dilate(&erode(image, radius), radius)
}

/// 255 where a pixel of a kind is within a radius, else 0.
fn spread(image: &GrayImage, radius: i32, of_kind: impl Fn(u8) -> bool) -> GrayImage {
    let (width, height) = image.dimensions();
    let mut out = GrayImage::new(width, height);
    let offsets: Vec<_> = (-radius..=radius)
        .flat_map(|down| (-radius..=radius).map(move |right| (right, down)))
        .filter(|(right, down)| right * right + down * down <= radius * radius)
        .collect();
    for (u, v, _) in image.enumerate_pixels().filter(|(_, _, pixel)| of_kind(pixel.0[0])) {
        for &(right, down) in &offsets {
            let at = u.checked_add_signed(right).zip(v.checked_add_signed(down));
            if let Some(pixel) = at.and_then(|(u, v)| out.get_pixel_mut_checked(u, v)) {
                *pixel = Luma([255]);
            }
        }
    }
    out
}

/// The number of the piece of each non-zero pixel, counted from 1 in reading order, and 0 elsewhere.
/// Pixels that share a side are of one piece.
pub(super) fn pieces(image: &GrayImage) -> ImageBuffer<Luma<u32>, Vec<u32>> {
    let (width, height) = image.dimensions();
    let mut pieces = ImageBuffer::<Luma<u32>, Vec<u32>>::new(width, height);
    let mut number = 0;
    let mut waiting = Vec::new();
    for (u, v, _) in image.enumerate_pixels() {
        let starts = image.get_pixel(u, v)[0] > 0 && pieces.get_pixel(u, v)[0] == 0;
        number += u32::from(starts);
        waiting.extend(starts.then_some((u, v)));
        while let Some((u, v)) = waiting.pop() {
            let inside = image.get_pixel_checked(u, v).is_some_and(|pixel| pixel[0] > 0);
            if inside && pieces.get_pixel(u, v)[0] == 0 {
                pieces.put_pixel(u, v, Luma([number]));
                let (left, up) = (u.wrapping_sub(1), v.wrapping_sub(1));
                waiting.extend([(left, v), (u + 1, v), (u, up), (u, v + 1)]);
            }
        }
    }
    pieces
}

/// The image smoothed by a Gaussian. The pixels at the border are repeated outside of it.
pub(super) fn smooth(image: &Colours, sigma: f32) -> Colours {
    let radius = (2.0 * sigma).ceil() as i32;
    let bell = |off: i32| (-(off as f32).powi(2) / (2.0 * sigma.powi(2))).exp();
    let sum: f32 = (-radius..=radius).map(bell).sum();
    let weights: Vec<_> = (-radius..=radius).map(|off| (off, bell(off) / sum)).collect();
    let (width, height) = image.dimensions();
    let pass = |image: &Colours, [right, down]: [i32; 2]| {
        Colours::from_fn(width, height, |u, v| {
            let mut sum = [0.0; 3];
            for &(off, weight) in &weights {
                let at = |place: u32, step: i32, side: u32| {
                    place.saturating_add_signed(off * step).min(side - 1)
                };
                let pixel = image.get_pixel(at(u, right, width), at(v, down, height));
                for (sum, channel) in sum.iter_mut().zip(pixel.0) {
                    *sum += channel * weight;
                }
            }
            Rgb(sum)
        })
    };
    pass(&pass(image, [1, 0]), [0, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An image drawn with `#` for the pixels that are not zero.
    fn drawn(rows: &[&str]) -> GrayImage {
        let pixels: Vec<u8> =
            rows.iter().flat_map(|row| row.bytes().map(|b| u8::from(b == b'#') * 255)).collect();
        GrayImage::from_raw(rows[0].len() as u32, rows.len() as u32, pixels).unwrap_or_default()
    }

    #[test]
    fn a_pixel_grows_to_a_disc_and_back() {
        let pixel = drawn(&[".....", ".....", "..#..", ".....", "....."]);
        let disc = drawn(&["..#..", ".###.", "#####", ".###.", "..#.."]);
        assert_eq!(dilate(&pixel, 2), disc);
        assert_eq!(close(&pixel, 2), pixel);
        assert_eq!(open(&disc, 2), disc);
        assert_eq!(open(&pixel, 1), drawn(&["....."; 5]));
    }

    #[test]
    fn pieces_are_numbered_in_reading_order() {
        let pieces = pieces(&drawn(&["#.#", "#.#", ".##"]));
        assert_eq!(pieces.into_raw(), [1, 0, 2, 1, 0, 2, 0, 2, 2]);
    }

    #[test]
    fn smoothing_keeps_an_even_image_and_the_sum_of_a_spot() {
        let even = Colours::from_pixel(5, 4, Rgb([1.0, 2.0, 3.0]));
        let smoothed = smooth(&even, 1.0);
        assert!(smoothed.iter().zip(even.iter()).all(|(a, b)| (a - b).abs() < 1e-5));
        let mut spot = Colours::new(9, 9);
        spot.put_pixel(4, 4, Rgb([1.0, 0.0, 0.0]));
        let smoothed = smooth(&spot, 1.0);
        assert!((smoothed.iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!(smoothed.get_pixel(4, 4)[0] > smoothed.get_pixel(5, 4)[0]);
    }
}
