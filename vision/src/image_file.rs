//! Image files, PNG or JPEG, as cameras write them and logs contain them.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, RgbImage};
use thiserror::Error;

pub struct ImageFile<'bytes> {
    decoder: Box<dyn ImageDecoder + 'bytes>,
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ImageFileError {
    #[error("this is not an image; it must be PNG or JPEG")]
    NotAnImage,
    #[error("this cannot be read as an image: the file is truncated")]
    Truncated,
    #[error("the image has {} x {} pixels, which are too many", .size[0], .size[1])]
    TooLarge { size: [u32; 2] },
    #[error("this cannot be read as an image: {0}")]
    Undecodable(String),
}

/// The most memory that the pixels of a file may take: 80 million with three bytes each.
const MOST_BYTES: u64 = 240_000_000;

impl<'bytes> ImageFile<'bytes> {
    /// Reads the header of an image file. No bytes make it panic.
    ///
    /// This takes at most 16 bytes of memory for each byte of the file, and 1 MiB besides, whatever size
    /// the header gives.
    ///
    /// # Errors
    /// Returns an error if it is neither PNG nor JPEG, has no whole header, or is a truncated JPEG.
    pub fn open(bytes: &'bytes [u8]) -> Result<Self, ImageFileError> {
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let reader = reader.map_err(|error| undecodable(&error))?;
        match reader.format() {
            // The decoder would invent what is missing.
            Some(ImageFormat::Jpeg) if !is_whole_jpeg(bytes) => {
                return Err(ImageFileError::Truncated);
            }
            Some(ImageFormat::Png | ImageFormat::Jpeg) => {}
            _ => return Err(ImageFileError::NotAnImage),
        }
        let decoder = reader.into_decoder().map_err(|error| undecodable(&error))?;
        Ok(Self { decoder: Box::new(decoder) })
    }

    pub fn size(&self) -> [u32; 2] {
        self.decoder.dimensions().into()
    }

    /// The image. No bytes make it panic.
    ///
    /// This takes at most 16 bytes of memory for each pixel, besides what [`Self::open`] takes.
    ///
    /// # Errors
    /// Returns an error if it has too many pixels or cannot be decoded.
    pub fn image(self) -> Result<RgbImage, ImageFileError> {
        let size = self.size();
        if self.decoder.total_bytes() > MOST_BYTES {
            return Err(ImageFileError::TooLarge { size });
        }
        let image = DynamicImage::from_decoder(self.decoder);
        Ok(image.map_err(|error| undecodable(&error))?.into_rgb8())
    }
}

fn undecodable(error: &impl ToString) -> ImageFileError {
    ImageFileError::Undecodable(error.to_string().replace('\n', ", "))
}

/// Whether a JPEG file contains the end of its image. (ITU T.81, B.1 and B.2.)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jpeg_is_whole_with_all_of_its_bytes_only() {
        let image = RgbImage::from_fn(32, 24, |u, v| image::Rgb([u as u8 * 7, v as u8 * 9, 99]));
        let mut bytes = Vec::new();
        image.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Jpeg).unwrap();
        assert!(is_whole_jpeg(&bytes));
        for length in 0..bytes.len() {
            assert!(!is_whole_jpeg(&bytes[..length]), "{length} of {}", bytes.len());
        }
        // The end of a preview is not the end of the image.
        let mut with_preview = vec![0xff, 0xd8, 0xff, 0xe1];
        with_preview.extend((2 + bytes.len() as u16).to_be_bytes());
        with_preview.extend(&bytes);
        assert!(!is_whole_jpeg(&with_preview));
        with_preview.extend(&bytes[2..]);
        assert!(is_whole_jpeg(&with_preview));
    }
}
