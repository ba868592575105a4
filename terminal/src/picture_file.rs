//! Image files: PNG and JPEG.

use std::{ffi::OsStr, fmt::Display, io::Cursor, path::Path};

use image::{ImageFormat, RgbImage, codecs::jpeg::JpegEncoder};
use toposlam_vision::{annotate::StageLegend, image_file::ImageFile, sensing::WrongSize};

use super::{CliError, input, output};
use toposlam_draw::picture::with_legend;

/// Reads an image of an expected size. The size is checked before the image is decoded.
pub fn read(path: &Path, expected: [u32; 2]) -> Result<RgbImage, CliError> {
    read_if(
        path,
        |found| {
            if found == expected { Ok(()) } else { Err(WrongSize { found, expected }) }
        },
    )
}

/// Reads an image if its size, width and height, fits. The size is checked before the image is decoded.
pub fn read_if<E: Display>(
    path: &Path,
    fits: impl FnOnce([u32; 2]) -> Result<(), E>,
) -> Result<RgbImage, CliError> {
    let bytes = input::read(path)?;
    let refused = |error| CliError::in_file(path, error);
    let file = ImageFile::open(&bytes).map_err(refused)?;
    fits(file.size()).map_err(|error| CliError::in_file(path, error))?;
    file.image().map_err(refused)
}

/// Writes an image as JPEG (`.jpg`, `.jpeg`) or else as PNG.
pub fn write(path: &Path, picture: &RgbImage) -> Result<(), CliError> {
    output::write_whole(path, &encoded(path, picture)?)
}

/// Writes the picture of a step of sensing, with its legend and its scale below it.
pub fn write_stage(path: &Path, legend: &StageLegend, picture: &RgbImage) -> Result<(), CliError> {
    let whole = with_legend(picture, legend);
    write(path, &whole.map_err(|error| CliError::in_file(path, error))?)
}

/// The bytes that [`write()`] writes.
pub fn encoded(path: &Path, picture: &RgbImage) -> Result<Vec<u8>, CliError> {
    let mut bytes = Cursor::new(Vec::new());
    let ending = path.extension().and_then(OsStr::to_str);
    let written = if matches!(ending, Some("jpg" | "jpeg")) {
        picture.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, 95))
    } else {
        picture.write_to(&mut bytes, ImageFormat::Png)
    };
    written.map_err(|error| CliError::in_file(path, error))?;
    Ok(bytes.into_inner())
}
