//! SVG to PNG, with the built-in font only.

use image::{Rgb, RgbImage};
use resvg::{tiny_skia, usvg};
use thiserror::Error;

use super::outlines::with_outlines;

/// Pixels per unit of a small picture.
const PIXELS: f32 = 2.0;
/// The longest side of a usual image, in pixels; larger pictures get fewer pixels per unit.
const USUAL: f32 = 2000.0;
/// The longest side of any image, for pictures that would otherwise get less than a pixel per unit.
const LONGEST: f32 = 4000.0;

/// The reason why a picture could not be made.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The text is not SVG.
    #[error("the SVG cannot be read: {0}")]
    Svg(#[from] usvg::Error),
    /// The image has no size, or one that does not fit in memory.
    #[error("an image of {width} x {height} pixels cannot be made")]
    Size {
        /// In pixels.
        width: u32,
        /// In pixels.
        height: u32,
    },
    /// The pixels could not be written as PNG.
    #[error("the image cannot be written as PNG: {0}")]
    Png(String),
}

/// The SVG as a PNG image with two pixels per unit. If its longer side would exceed 2000 pixels, there are
/// fewer, down to one; if it would exceed 4000 pixels then, even fewer. Text is in DejaVu Sans, for any
/// fonts of the system.
///
/// # Errors
/// Returns an error if the text is not SVG, or the image would have no pixels.
pub fn png(svg: &str) -> Result<Vec<u8>, PictureError> {
    let image = rendered(svg, scale)?;
    image.encode_png().map_err(|error| PictureError::Png(error.to_string()))
}

/// The SVG with one pixel per unit. Its background is opaque.
pub(super) fn pixels(svg: &str) -> Result<RgbImage, PictureError> {
    let image = rendered(svg, |_| 1.0)?;
    let row = image.width() as usize;
    Ok(RgbImage::from_fn(image.width(), image.height(), |x, y| {
        let pixel = image.pixels().get(y as usize * row + x as usize);
        Rgb(pixel.map_or([0; 3], |pixel| [pixel.red(), pixel.green(), pixel.blue()]))
    }))
}

/// The SVG at a scale, which may depend on its longer side.
fn rendered(svg: &str, scale: impl Fn(f32) -> f32) -> Result<tiny_skia::Pixmap, PictureError> {
    let outlined = with_outlines(svg).map_err(usvg::Error::ParsingFailed)?;
    let tree = usvg::Tree::from_str(&outlined, &usvg::Options::default())?;
    let size = tree.size();
    let scale = scale(size.width().max(size.height()));
    let (width, height) = (rounded(size.width() * scale), rounded(size.height() * scale));
    let mut image =
        tiny_skia::Pixmap::new(width, height).ok_or(PictureError::Size { width, height })?;
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut image.as_mut());
    Ok(image)
}

/// Pixels per unit of a picture with this longer side.
fn scale(side: f32) -> f32 {
    PIXELS.min((USUAL / side).max((LONGEST / side).min(1.0)))
}

#[expect(clippy::cast_sign_loss, reason = "the sizes of an SVG are positive")]
fn rounded(length: f32) -> u32 {
    length.round() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dark_pixels(png: &[u8]) -> usize {
        let image = tiny_skia::Pixmap::decode_png(png).unwrap();
        image.pixels().iter().filter(|p| p.red() < 128).count()
    }

    fn with_text(text: &str) -> Vec<u8> {
        png(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80\" height=\"20\" \
             font-family=\"{}\"><rect width=\"80\" height=\"20\" fill=\"#ffffff\"/>\
             <text x=\"4\" y=\"15\" font-size=\"14\">{text}</text></svg>",
            super::super::text::FAMILY
        ))
        .unwrap()
    }

    #[test]
    fn text_appears_without_any_font_of_the_system() {
        assert_eq!(dark_pixels(&with_text("")), 0);
        for text in ["corner", "7", "\u{e9}", "\u{3b1}", "\u{416}", "\u{2192}"] {
            assert!(dark_pixels(&with_text(text)) > 20, "{text}");
        }
        assert_ne!(with_text("corner"), with_text("tee"));
    }

    #[test]
    fn large_pictures_get_fewer_pixels_in_a_unit() {
        for (side, pixels) in [(400.0, 800.0), (1400.0, 2000.0), (3000.0, 3000.0), (9e3, 4e3)] {
            assert!((scale(side) * side - pixels).abs() < 0.5, "{side}");
        }
    }

    #[test]
    fn what_is_no_svg_is_refused() {
        assert!(matches!(png("a world"), Err(PictureError::Svg(_))));
    }
}
