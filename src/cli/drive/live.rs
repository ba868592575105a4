//! A run of a live robot: its inputs, its story and its files.

use std::io::Write;

use toposlam_model::mapping::{FACING, MappingError};
use toposlam_robot::{
    any_explorer::{AnyExplorer, RobotSensor},
    explorer::ExplorerError,
    live::{LiveSensor, RobotTopics},
    robot::Robot,
    run_settings::{LaserVertices, RunSettings},
};
use toposlam_vision::{
    camera::Camera, colour::ColourModel, laser::params::LaserParams, sensing::Sensor,
};

use super::{CliError, DriveArguments, Outcome, TOPICS};
use crate::cli::{
    input,
    progress::{always_stop_gracefully, must_stop},
    robot_sensor::{SensorChoice, needs_camera},
    run_capture::RunCapture,
    run_report::{RobotReport, RobotRun, RunReport},
};

impl DriveArguments {
    pub(in crate::cli) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ros.check_build()?;
        self.options.check_places(false)?;
        let settings = self.options.settings(None)?;
        let sensors = self.sensors()?;
        let laser = self.laser_params()?;
        if self.corridors && !settings.earlier.is_empty() {
            return Err(CliError::at(
                "--resume",
                "a run in --corridors does not go on from others",
            ));
        }
        let settings = RunSettings { laser: laser.as_ref().map(LaserVertices::from), ..settings };
        let (sensor, live, frame_kind) = match (&sensors, laser) {
            (Some((camera, colours)), _) => {
                let sensor = Box::new(Sensor::new(camera, colours));
                (RobotSensor::Camera(sensor), LiveSensor::Camera, "images")
            }
            (None, laser) => (laser.unwrap_or_default().into(), LiveSensor::Laser, "scans"),
        };
        always_stop_gracefully();
        let topics = RobotTopics {
            images: self.topic("images"),
            scans: self.topic("scans"),
            marker: self.topic("marker"),
            odometry: self.topic("odometry"),
            wheels: self.topic("wheels"),
        };
        let place = self.ros.place()?;
        let Some((robot, mut published)) =
            self.ros.connect(&topics, live, self.sim_time, self.patience, must_stop)?
        else {
            return Ok(Outcome::Incomplete);
        };
        let command = self.given.command(&["toposlam", "drive"]);
        let mut log = self.options.recorder(command, &settings, None, 0, sensors.as_ref())?;
        let story_out: Option<&mut dyn Write> =
            if self.options.json { None } else { Some(&mut *out) };
        let head = format!("A robot {place}.");
        let mut capture = RunCapture::new(head, story_out, frame_kind, None)?;
        let observer = (&mut log, (&mut capture, &mut *published));
        let mut explorer = AnyExplorer::new(robot, sensor, observer);
        let (mapping, mapped) = explorer.map(&settings);
        let (moves, (robot, _)) = (explorer.moves(), explorer.into_parts());
        let logged = self.options.close(log);
        let (seconds, frames) = (robot.odometry().time, robot.frames());
        // The robot is dropped last: the node of these topics belongs to it.
        drop(published);
        drop(robot);
        let walk = capture.finish()?;
        logged?;
        let run = RobotRun {
            method: settings.method,
            mapping: &mapping,
            mapped: mapped.as_ref().ok(),
            error: mapped.as_ref().err(),
            moves,
            seconds,
            frames,
            frame_kind,
        };
        let [vertices, edges] = run.known();
        let ending = match run.error {
            None => "mapped",
            Some(MappingError::World(ExplorerError::Stopped { .. })) => "stopped",
            Some(MappingError::World(ExplorerError::Budget { .. })) => "out-of-budget",
            Some(_) => "gave-up",
        };
        let seconds = (seconds * 1e3).round() / 1e3;
        let whole = mapping.map().complete().filter(|_| run.error.is_none());
        let whole = whole.filter(|_| run.blocked().is_empty());
        let certificate = whole.map(|graph| run.certificate(graph, FACING, true));
        let report = RobotReport::Live { ending, vertices, edges, seconds };
        let report = RunReport::new(&run, certificate, report);
        if self.options.json {
            report.print_json(out)?;
        } else {
            report.print(out, &run, &[run.ending("complete", "complete")])?;
        }
        let map = run.map("map", "The map of an unknown world, made by a live robot");
        self.options.write_map(map.as_ref(), &walk)?;
        Ok(run.outcome(self.options.allows_blocked()))
    }

    /// The camera and the colours of the building; `None` with a laser scanner.
    fn sensors(&self) -> Result<Option<(Camera, ColourModel)>, CliError> {
        let needed = |option: &str| CliError::at(option, "a robot with a camera needs it");
        let (unused, other) = match (self.sensor, &self.calibration, &self.colours) {
            (SensorChoice::Laser, None, None) => (&["images"][..], "camera"),
            (SensorChoice::Laser, Some(_), _) => return Err(needs_camera("--calibration")),
            (SensorChoice::Laser, None, Some(_)) => return Err(needs_camera("--colours")),
            (_, None, _) => return Err(needed("--calibration")),
            (_, _, None) => return Err(needed("--colours")),
            (_, Some(_), Some(_)) => (&["scans", "marker"][..], "laser"),
        };
        if let Some((what, _)) = self.topic.iter().find(|(what, _)| unused.contains(what)) {
            let cause = format!("{what} has an effect only with --sensor {other}");
            return Err(CliError::at("--topic", cause));
        }
        let (Some(camera), Some(colours)) = (&self.calibration, &self.colours) else {
            return Ok(None);
        };
        Ok(Some((input::read_camera(camera)?, input::read_colours(colours)?)))
    }

    /// How scans are sensed; `None` by a camera.
    fn laser_params(&self) -> Result<Option<LaserParams>, CliError> {
        if self.sensor != SensorChoice::Laser {
            let given = self.corridors.then_some("--corridors").or(self.laser.given());
            let needed = |option| Err(CliError::at(option, "add --sensor laser"));
            return given.map_or(Ok(None), needed);
        }
        let hallways = (!self.corridors).then_some(LaserVertices::OF_HALLWAYS);
        let params = self.laser.params(hallways)?;
        let cause = match (self.corridors, params.corner.corners) {
            (true, true) => {
                "corner.corners is true, but a robot in corridors takes no bend for a vertex; set it to false"
            }
            (false, false) => {
                "corner.corners is false, but a robot in hallways takes corners for vertices; set it to true, \
                 or add --corridors"
            }
            _ => return Ok(Some(params)),
        };
        Err(CliError::at("--laser-params", cause))
    }

    /// The name of a topic.
    fn topic(&self, what: &str) -> String {
        let given = self.topic.iter().rev().find(|(given, _)| *given == what);
        let usual = TOPICS.iter().find(|(known, ..)| *known == what).map(|(_, usual, _)| *usual);
        given.map_or(usual.unwrap_or_default(), |(_, topic)| topic).to_owned()
    }
}
