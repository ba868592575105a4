//! Pictures of pixels, as files: PNG and JPEG.

use std::{ffi::OsStr, io::Cursor, path::Path};

use image::{ImageFormat, RgbImage, codecs::jpeg::JpegEncoder};
use toposlam_vision::{image_file::ImageFile, sensing::WrongSize};

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
    let refused = |error| Failure::in_file(path, error);
    let file = ImageFile::open(&bytes).map_err(refused)?;
    fits(file.size())?;
    file.image().map_err(refused)
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
