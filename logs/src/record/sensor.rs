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

    /// The headings to which the robot turns to look around before the frame is sensed, one after the other, relative
    /// to the frame's; empty if it need not. The last one is 0.
    fn headings_to_look_around(&self, _frame: &Frame) -> Vec<f64> {
        Vec::new()
    }

    /// The robot begins to look around where it took this frame.
    fn begin_to_look_around(&mut self, _frame: &Frame) {}

    /// Remembers a frame that was taken while the robot looks around.
    fn remember(&mut self, _frame: &Frame) {}
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

    fn headings_to_look_around(&self, frame: &Frame) -> Vec<f64> {
        frame.scan.as_ref().map_or_else(Vec::new, |scan| {
            ScanPlaceSensor::headings_to_look_around(self, scan, &frame.odometry)
        })
    }

    fn begin_to_look_around(&mut self, frame: &Frame) {
        ScanPlaceSensor::begin_to_look_around(self, &frame.odometry);
    }

    fn remember(&mut self, frame: &Frame) {
        if let Some(scan) = &frame.scan {
            ScanPlaceSensor::remember(self, scan, &frame.odometry);
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

    fn headings_to_look_around(&self, frame: &Frame) -> Vec<f64> {
        match self {
            Self::Camera(_) => Vec::new(),
            Self::Laser(sensor) => FrameSensor::headings_to_look_around(&**sensor, frame),
        }
    }

    fn begin_to_look_around(&mut self, frame: &Frame) {
        if let Self::Laser(sensor) = self {
            FrameSensor::begin_to_look_around(&mut **sensor, frame);
        }
    }

    fn remember(&mut self, frame: &Frame) {
        if let Self::Laser(sensor) = self {
            FrameSensor::remember(&mut **sensor, frame);
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

    fn headings_to_look_around(&self, frame: &Frame) -> Vec<f64> {
        self.as_ref().map_or_else(Vec::new, |sensor| sensor.headings_to_look_around(frame))
    }

    fn begin_to_look_around(&mut self, frame: &Frame) {
        if let Some(sensor) = self {
            sensor.begin_to_look_around(frame);
        }
    }

    fn remember(&mut self, frame: &Frame) {
        if let Some(sensor) = self {
            sensor.remember(frame);
        }
    }
}
