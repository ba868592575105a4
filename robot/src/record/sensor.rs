//! Sensing: the scene of a frame. Section 3.

use thiserror::Error;
use toposlam_model::driving::scene::Scene;
use toposlam_vision::{
    image_file::ImageFileError,
    laser::scene::ScanPlaceSensor,
    sensing::{Sensor, WrongSize},
};

use super::Frame;

/// Makes a scene of a frame.
pub trait FrameSensor {
    /// The scene.
    ///
    /// # Errors
    /// Returns an error if the frame cannot be sensed.
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError>;
}

/// Why a frame cannot be sensed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SensingError {
    /// Its image cannot be decoded.
    #[error(transparent)]
    Image(#[from] ImageFileError),
    /// Its image is not of the calibrated camera.
    #[error(transparent)]
    Size(#[from] WrongSize),
    /// It has an image, and no scene.
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

/// Senses the scan; a frame without one must have its scene. The marker is that of the frame.
impl FrameSensor for ScanPlaceSensor {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        match &frame.scan {
            Some(scan) => {
                Ok(Scene { place: self.sense(scan, &frame.odometry), marker: frame.marker })
            }
            None => NoSensor.scene(frame),
        }
    }
}

/// Senses with a camera or with a laser scanner.
#[derive(Clone, Debug)]
pub enum RobotSensor {
    /// A camera.
    Camera(Box<Sensor>),
    /// A laser scanner.
    Laser(Box<ScanPlaceSensor>),
}

impl FrameSensor for RobotSensor {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        match self {
            Self::Camera(sensor) => sensor.scene(frame),
            Self::Laser(sensor) => sensor.scene(frame),
        }
    }
}

/// Takes the scene that is already in the frame.
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
