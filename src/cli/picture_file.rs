//! Pictures of pixels, as files: PNG and JPEG.

use std::{
    ffi::OsStr,
    io::{BufReader, Cursor},
    path::Path,
};

use image::{ImageDecoder, ImageFormat, ImageReader, RgbImage, codecs::jpeg::JpegEncoder};
use toposlam_vision::sensing::WrongSize;

use super::{Failure, input, output};

/// The picture of a PNG or JPEG file that must be of this size; one of another size is refused before
/// it takes any memory.
pub(super) fn read(path: &Path, expected: [u32; 2]) -> Result<RgbImage, Failure> {
    read_if(path, |found| {
        if found == expected {
            Ok(())
        } else {
            Err(Failure::in_file(path, WrongSize { found, expected }))
        }
    })
}

/// The picture of a PNG or JPEG file whose size, width and height, is not refused.
pub(super) fn read_if(
    path: &Path,
    fits: impl FnOnce([u32; 2]) -> Result<(), Failure>,
) -> Result<RgbImage, Failure> {
    let bytes = input::read(path)?;
    let refused = |cause: &dyn std::fmt::Display| {
        Failure::in_file(path, format!("this cannot be read as an image: {cause}"))
    };
    let reader = ImageReader::new(BufReader::new(Cursor::new(&bytes)))
        .with_guessed_format()
        .map_err(|error| refused(&error))?;
    let format = reader.format();
    if !matches!(format, Some(ImageFormat::Png | ImageFormat::Jpeg)) {
        let cause = "this is not an image; it must be PNG or JPEG";
        return Err(Failure::in_file(path, cause));
    }
    let decoder = reader.into_decoder().map_err(|error| refused(&error))?;
    fits(decoder.dimensions().into())?;
    // The decoder would make up what is missing.
    if format == Some(ImageFormat::Jpeg) && !is_whole_jpeg(&bytes) {
        return Err(refused(&"the file is truncated"));
    }
    let image = image::DynamicImage::from_decoder(decoder).map_err(|error| refused(&error))?;
    Ok(image.into_rgb8())
}

/// Whether a JPEG file goes on to the end of its image. (ITU T.81, B.1 and B.2.)
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let marker = bytes.get(at + 1).copied();
        match (byte, marker) {
            (0xff, Some(0xd9)) => return true,
            // Segments without a length, stuffed bytes and fill bytes.
            (0xff, Some(0x00 | 0x01 | 0xd0..=0xd8)) => at += 2,
            (0xff, Some(0xff)) => at += 1,
            (0xff, Some(_)) => {
                let Some(&[high, low]) = bytes.get(at + 2..at + 4) else { return false };
                at += 2 + usize::from(u16::from_be_bytes([high, low]));
            }
            // The coded image, between segments.
            _ => at += 1,
        }
    }
    false
}

/// Writes a picture as the ending of its name says: `.jpg` and `.jpeg`, or else PNG.
pub(super) fn write(path: &Path, picture: &RgbImage) -> Result<(), Failure> {
    output::write_whole(path, &encoded(path, picture)?)
}

/// A picture as [`write`] writes it.
pub(super) fn encoded(path: &Path, picture: &RgbImage) -> Result<Vec<u8>, Failure> {
    let mut bytes = Cursor::new(Vec::new());
    let ending = path.extension().and_then(OsStr::to_str);
    let written = if matches!(ending, Some("jpg" | "jpeg")) {
        picture.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, 95))
    } else {
        picture.write_to(&mut bytes, ImageFormat::Png)
    };
    written.map_err(|error| Failure::in_file(path, error))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jpeg_is_whole_with_all_of_its_bytes_only() {
        let picture = RgbImage::from_fn(32, 24, |u, v| image::Rgb([u as u8 * 7, v as u8 * 9, 99]));
        let bytes = encoded(Path::new("picture.jpg"), &picture).unwrap();
        assert!(is_whole_jpeg(&bytes));
        for length in 0..bytes.len() {
            assert!(!is_whole_jpeg(&bytes[..length]), "{length} of {}", bytes.len());
        }
        // The end of a preview is not that of the picture.
        let mut with_preview = vec![0xff, 0xd8, 0xff, 0xe1];
        with_preview.extend((2 + bytes.len() as u16).to_be_bytes());
        with_preview.extend(&bytes);
        assert!(!is_whole_jpeg(&with_preview));
        with_preview.extend(&bytes[2..]);
        assert!(is_whole_jpeg(&with_preview));
    }
}
