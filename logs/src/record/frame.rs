//! What the sensors of a robot give at one moment.

use std::{
    fmt,
    sync::{Arc, OnceLock},
};

use image::RgbImage;
use toposlam_model::driving::{
    odometry::Odometry,
    scene::{MarkerView, Scene},
};
use toposlam_vision::{
    image_file::{ImageFile, ImageFileError},
    laser::scan::Scan,
};

/// What the sensors gave at one moment. A clone is cheap, and shares the decoded pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The number of the capture, or of the log message, counted from 1.
    pub id: u64,
    /// When it was taken, in seconds since the robot was switched on or the log began.
    pub taken: f64,
    pub odometry: Odometry,
    pub image: Option<CameraImage>,
    pub scan: Option<Arc<Scan>>,
    /// The marker, if a detector of its own has seen it: a scanner does not.
    pub marker: Option<MarkerView>,
    /// The scene, once the frame has been sensed. A simulation without images supplies it.
    pub scene: Option<Scene>,
}

impl Frame {
    /// Whether the sensors gave the same data: the same image or scan, or without both the same capture.
    pub fn same_data(&self, other: &Self) -> bool {
        if (&self.image, &self.scan) != (&other.image, &other.scan) {
            return false;
        }
        self.image.is_some() || self.scan.is_some() || self.id == other.id
    }

    /// The same frame without decoded pixels. They are decoded again when they are needed.
    #[must_use]
    pub fn without_pixels(&self) -> Self {
        let image = self.image.as_ref().map(CameraImage::without_pixels);
        Self { image, ..self.clone() }
    }
}

/// A camera image: an encoded file, or raw pixels. It is decoded at most once.
#[derive(Clone)]
pub struct CameraImage {
    file: Option<Arc<[u8]>>,
    pixels: Arc<OnceLock<Result<RgbImage, ImageFileError>>>,
}

impl CameraImage {
    /// An encoded image file, JPEG or PNG; it may be damaged.
    pub fn encoded(file: impl Into<Arc<[u8]>>) -> Self {
        Self { file: Some(file.into()), pixels: Arc::default() }
    }

    pub fn raw(pixels: RgbImage) -> Self {
        Self { file: None, pixels: Arc::new(Ok(pixels).into()) }
    }

    pub fn file(&self) -> Option<&[u8]> {
        self.file.as_deref()
    }

    /// The pixels.
    ///
    /// # Errors
    /// Returns an error if the file is not an image.
    pub fn pixels(&self) -> Result<&RgbImage, ImageFileError> {
        self.pixels.get_or_init(|| self.decoded()).as_ref().map_err(Clone::clone)
    }

    fn decoded(&self) -> Result<RgbImage, ImageFileError> {
        #[cfg(test)]
        DECODED.set(DECODED.get() + 1);
        ImageFile::open(self.file().unwrap_or_default())?.image()
    }

    fn without_pixels(&self) -> Self {
        match &self.file {
            Some(file) => Self::encoded(file.clone()),
            None => self.clone(),
        }
    }
}

impl PartialEq for CameraImage {
    fn eq(&self, other: &Self) -> bool {
        match (&self.file, &other.file) {
            (None, None) => self.pixels.get() == other.pixels.get(),
            (one, two) => one == two,
        }
    }
}

impl fmt::Debug for CameraImage {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let bytes = self.file().map(<[u8]>::len);
        out.debug_struct("CameraImage").field("bytes", &bytes).finish_non_exhaustive()
    }
}

#[cfg(test)]
thread_local! {
    /// The number of images that this thread has decoded.
    static DECODED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_the_decoded_pixels() {
        let mut file = std::io::Cursor::new(Vec::new());
        RgbImage::new(4, 3).write_to(&mut file, image::ImageFormat::Png).unwrap();
        let image = CameraImage::encoded(file.into_inner());
        let before = DECODED.get();
        assert_eq!(image.clone().pixels().unwrap().dimensions(), (4, 3));
        image.pixels().unwrap();
        assert_eq!(DECODED.get() - before, 1);
        image.without_pixels().pixels().unwrap();
        assert_eq!(DECODED.get() - before, 2);
    }

    #[test]
    fn a_damaged_file_is_an_error_each_time() {
        let image = CameraImage::encoded(*b"no image");
        let before = DECODED.get();
        assert_eq!(image.pixels(), Err(ImageFileError::NotAnImage));
        assert_eq!(image.pixels(), Err(ImageFileError::NotAnImage));
        assert_eq!(DECODED.get() - before, 1);
    }
}
