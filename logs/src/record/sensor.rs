//! Sensing: the scene of a frame. Section 3.

use thiserror::Error;
use toposlam_model::driving::scene::Scene;
use toposlam_vision::{
    image_file::ImageFileError,
    sensing::{Sensor, WrongSize},
};

use super::Frame;

pub trait FrameSensor {
    /// The scene.
    ///
    /// # Errors
    /// Returns an error if the frame cannot be sensed.
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError>;
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum SensingError {
    #[error(transparent)]
    Image(#[from] ImageFileError),
    #[error(transparent)]
    Size(#[from] WrongSize),
    #[error("sensing an image needs the camera's calibration and the colours of the building")]
    NoSensor,
}

/// Senses the image; a frame without one must have its scene.
impl FrameSensor for Sensor {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        match &frame.image {
            Some(image) => Ok(self.sense(image.pixels()?)?),
            None => NoSensor.scene(frame),
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub struct NoSensor;

impl FrameSensor for NoSensor {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        frame.scene.clone().ok_or(SensingError::NoSensor)
    }
}

impl<S: FrameSensor> FrameSensor for Option<S> {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        match self {
            Some(sensor) => sensor.scene(frame),
            None => NoSensor.scene(frame),
        }
    }
}
