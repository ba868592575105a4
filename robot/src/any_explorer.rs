//! A robot that explores by any of its sensors: by scenes, as Algorithm 2 needs them, or by the scans of a laser scanner.

use toposlam_logs::record::RunObserver;
use toposlam_model::{
    driving::algorithm2::JunctionState,
    mapping::{MapWalk, MappedWorld, MappingError},
    percept::{Door, Percept},
    world::{AidHandler, World},
};
use toposlam_vision::{laser::params::LaserParams, sensing::Sensor};

use crate::{
    corridors::CorridorExplorer,
    explorer::{ExplorerError, RobotExplorer},
    robot::Robot,
    run_settings::RunSettings,
};

/// How a robot senses where it is.
#[derive(Clone, Debug, Default)]
pub enum RobotSensor {
    /// Its frames have scenes.
    #[default]
    Scenes,
    /// Its frames have images.
    Camera(Box<Sensor>),
    /// Its frames have scans.
    Laser(Box<LaserParams>),
}

impl From<LaserParams> for RobotSensor {
    fn from(params: LaserParams) -> Self {
        Self::Laser(Box::new(params))
    }
}

/// A robot that explores.
#[derive(Clone, Debug)]
pub enum AnyExplorer<R, O = ()> {
    ByScene(Box<RobotExplorer<R, Option<Sensor>, O>>),
    ByScan(Box<CorridorExplorer<R, O>>),
}

impl<R: Robot, O: RunObserver> AnyExplorer<R, O> {
    pub fn new(robot: R, sensor: RobotSensor, observer: O) -> Self {
        let by_scene = |robot, sensor, observer| {
            Self::ByScene(Box::new(RobotExplorer::new(robot, sensor, observer)))
        };
        match sensor {
            RobotSensor::Scenes => by_scene(robot, None, observer),
            RobotSensor::Camera(sensor) => by_scene(robot, Some(*sensor), observer),
            RobotSensor::Laser(params) => {
                Self::ByScan(Box::new(CorridorExplorer::new(robot, &params, observer)))
            }
        }
    }

    /// The same robot, if it is already known where it stands.
    #[must_use]
    pub fn at_junction(self, state: JunctionState) -> Self {
        match self {
            Self::ByScene(explorer) => Self::ByScene(Box::new(explorer.at_junction(state))),
            Self::ByScan(explorer) => Self::ByScan(Box::new(explorer.at_junction(&state))),
        }
    }

    /// The same robot, if another one sends it, so that it looks for no marker.
    #[must_use]
    pub fn sent(self) -> Self {
        match self {
            Self::ByScene(explorer) => Self::ByScene(Box::new(explorer.sent())),
            Self::ByScan(explorer) => Self::ByScan(Box::new(explorer.sent())),
        }
    }

    /// Maps the building. Returns the state of the algorithm, too.
    ///
    /// # Errors
    /// Returns an error if the run ended before the map was complete.
    pub fn map(
        &mut self,
        settings: &RunSettings,
    ) -> (MapWalk, Result<MappedWorld, MappingError<ExplorerError>>) {
        match self {
            Self::ByScene(explorer) => explorer.map(settings),
            Self::ByScan(explorer) => explorer.map(settings),
        }
    }

    /// The moves that ended at a vertex or before an obstacle, with those of recoveries and audits.
    pub fn moves(&self) -> u64 {
        match self {
            Self::ByScene(explorer) => explorer.moves(),
            Self::ByScan(explorer) => explorer.moves(),
        }
    }

    pub fn is_at_obstacle(&self) -> bool {
        match self {
            Self::ByScene(explorer) => explorer.is_at_obstacle(),
            Self::ByScan(explorer) => explorer.is_at_obstacle(),
        }
    }

    pub fn robot_mut(&mut self) -> &mut R {
        match self {
            Self::ByScene(explorer) => explorer.robot_mut(),
            Self::ByScan(explorer) => explorer.robot_mut(),
        }
    }

    pub fn into_parts(self) -> (R, O) {
        match self {
            Self::ByScene(explorer) => explorer.into_parts(),
            Self::ByScan(explorer) => explorer.into_parts(),
        }
    }
}

impl<R: Robot, O: RunObserver> World for AnyExplorer<R, O> {
    type Error = ExplorerError;

    fn percept(&mut self) -> Result<Percept, ExplorerError> {
        match self {
            Self::ByScene(explorer) => explorer.percept(),
            Self::ByScan(explorer) => explorer.percept(),
        }
    }

    fn traverse(&mut self, door: Door) -> Result<(), ExplorerError> {
        match self {
            Self::ByScene(explorer) => explorer.traverse(door),
            Self::ByScan(explorer) => explorer.traverse(door),
        }
    }

    fn handler(&mut self) -> Option<&mut dyn AidHandler<Error = ExplorerError>> {
        match self {
            Self::ByScene(explorer) => explorer.handler(),
            Self::ByScan(explorer) => explorer.handler(),
        }
    }
}
