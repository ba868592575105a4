//! Sensing: the scene of a frame. Section 3.

use thiserror::Error;
use toposlam_model::driving::scene::Scene;
use toposlam_vision::{
    image_file::ImageFileError,
    laser::scene::ScanPlaceSensor,
    sensing::{Sensor, WrongSize},
};

use super::Frame;

pub trait FrameSensor {
    /// The scene.
    ///
    /// # Errors
    /// Returns an error if the frame cannot be sensed.
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError>;

    /// The laser scanner's part, which must look around where it sees too little.
    fn scanner(&mut self) -> Option<&mut ScanPlaceSensor> {
        None
    }

    /// The headings to which the robot turns to look around before the frame is sensed, one after the other, relative
    /// to the frame's; empty if it need not. The last one is 0.
    fn headings_to_look_around(&mut self, frame: &Frame) -> Vec<f64> {
        let scanner = self.scanner().zip(frame.scan.as_ref());
        scanner.map_or_else(Vec::new, |(scanner, scan)| {
            ScanPlaceSensor::headings_to_look_around(scanner, scan, &frame.odometry)
        })
    }

    /// The robot begins to look around where it took this frame.
    fn begin_to_look_around(&mut self, frame: &Frame) {
        if let Some(scanner) = self.scanner() {
            ScanPlaceSensor::begin_to_look_around(scanner, &frame.odometry);
        }
    }

    fn remember(&mut self, frame: &Frame) {
        if let Some((scanner, scan)) = self.scanner().zip(frame.scan.as_ref()) {
            ScanPlaceSensor::remember(scanner, scan, &frame.odometry);
        }
    }
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

    fn scanner(&mut self) -> Option<&mut ScanPlaceSensor> {
        Some(self)
    }
}

#[derive(Clone, Debug)]
pub enum RobotSensor {
    Camera(Box<Sensor>),
    Laser(Box<ScanPlaceSensor>),
}

impl FrameSensor for RobotSensor {
    fn scene(&mut self, frame: &Frame) -> Result<Scene, SensingError> {
        match self {
            Self::Camera(sensor) => sensor.scene(frame),
            Self::Laser(sensor) => sensor.scene(frame),
        }
    }

    fn scanner(&mut self) -> Option<&mut ScanPlaceSensor> {
        match self {
            Self::Camera(_) => None,
            Self::Laser(sensor) => Some(sensor),
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

    fn scanner(&mut self) -> Option<&mut ScanPlaceSensor> {
        self.as_mut()?.scanner()
    }
}
