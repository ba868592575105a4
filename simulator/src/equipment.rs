//! The sensors of the robots that are measured.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_logs::record::RobotSensor;

use super::LearnedSensors;
use crate::{Effects, ScannerParams, SimulatedRobot, SimulationConfig};

/// The sensors of a simulated robot.
#[derive(Debug)]
pub enum RobotEquipment {
    Scenes,
    /// A camera whose images are rendered, in buildings of several looks.
    Images(LearnedSensors),
    /// A laser scanner, and a detector of the marker.
    Laser(ScannerParams),
}

impl RobotEquipment {
    pub(super) fn robot(
        &self,
        config: &SimulationConfig,
        number: u64,
    ) -> (SimulatedRobot, Option<RobotSensor>) {
        match self {
            Self::Scenes => (config.by_scene(), None),
            Self::Images(sensors) => {
                let look = sensors.look(number);
                let mut chance = Xoshiro256PlusPlus::seed_from_u64(config.seed);
                let robot = config.with_images(sensors.rig(), look, &Effects::drawn(&mut chance));
                (robot, Some(RobotSensor::Camera(Box::new(sensors.sensor(look)))))
            }
            Self::Laser(params) => {
                let sensor = RobotSensor::Laser(Box::default());
                (config.by_laser(params), Some(sensor))
            }
        }
    }
}
