//! Pictures of pixels, as files.

use std::{ffi::OsStr, io::Cursor, path::Path};

use image::{ImageFormat, RgbImage, codecs::jpeg::JpegEncoder};

use super::{Failure, output};

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
