//! A run of a live robot: its inputs, its story and its files.

use std::{
    fs::File,
    io::{self, IsTerminal, Write},
    rc::Rc,
    time::Duration,
};

use toposlam_logs::{
    messages,
    record::{Event, EventKind, RobotSensor, RunObserver},
    recorder::Recorder,
    world_hash,
    writer::LogWriteError,
};
use toposlam_model::{
    embedded_graph::Dart,
    enumerate::Watch,
    format::named_world::NamedWorld,
    mapping::{MapWalk, MappingEvent},
};
use toposlam_robot::{
    explorer::RobotExplorer,
    false_percepts::FalsePercepts,
    robot::{Robot, RobotError},
    ros1::{LiveRobot, LiveSensor, RobotTopics},
    run_settings::RunSettings,
};
use toposlam_vision::{
    camera::{Camera, calibration},
    colour::ColourModel,
    sensing::Sensor,
};

use super::{CliError, DriveArguments, Outcome, TOPICS, result::DriveResult};
use crate::{
    cli::{
        input, output,
        progress::Progress,
        robot_sensor::{SensorChoice, needs_camera},
        text::quoted,
        version,
    },
    story::{PrintedStory, Story, StoryDetail},
};

impl DriveArguments {
    pub(in crate::cli) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if let Some(log) = &self.log {
            output::check_place(log, &["mcap"])?;
        }
        if let Some(map) = &self.map {
            output::check_world_place(map, false)?;
        }
        let settings = self.options.settings(None)?;
        let eyes = self.eyes()?;
        let (sensor, live) = match &eyes {
            Some((camera, colours)) => {
                let sensor = Box::new(Sensor::new(camera, colours));
                (RobotSensor::Camera(sensor), LiveSensor::Camera)
            }
            None => (RobotSensor::Laser(Box::default()), LiveSensor::Laser),
        };
        let world = match &self.plan {
            Some(path) => {
                let world = input::read_world(path)?;
                let facing = input::start_of(&world, self.start.as_deref())?;
                Some((world, facing))
            }
            None => None,
        };
        let progress = Progress::endless("exploring", "images")?.always_graceful();
        // On a terminal the story shows how far the run is.
        let hidden = !self.json && io::stdout().is_terminal();
        let progress = Rc::new(if hidden { progress.hidden() } else { progress });
        let stop = progress.clone();
        let topics = RobotTopics {
            master: self.ros.clone(),
            images: self.topic("images"),
            scans: self.topic("scans"),
            marker: self.topic("marker"),
            odometry: self.topic("odometry"),
            wheels: self.topic("wheels"),
        };
        let patience = Duration::from_secs_f64(self.patience);
        let robot = match LiveRobot::connect(&topics, live, patience, move || stop.stop()) {
            Ok(robot) => robot,
            Err(RobotError::Stopped) => return Ok(Outcome::Incomplete),
            Err(error) => return Err(CliError::at("--ros", error)),
        };
        let log = self.recorder(&settings, world.as_ref(), eyes.as_ref())?;
        self.explore(&settings, robot, sensor, world.as_ref(), log, &progress, out)
    }

    /// The camera and the colours of the building; `None` with a laser scanner.
    fn eyes(&self) -> Result<Option<(Camera, ColourModel)>, CliError> {
        let needed = |option: &str| CliError::at(option, "a robot with a camera needs it");
        let files = (&self.calibration, &self.colours);
        match (self.sensor, files) {
            (SensorChoice::Laser, (None, None)) => {
                self.check_unused_topics(&["images"], "camera")?;
                Ok(None)
            }
            (SensorChoice::Laser, (Some(_), _)) => Err(needs_camera("--calibration")),
            (SensorChoice::Laser, (None, Some(_))) => Err(needs_camera("--colours")),
            (_, (None, _)) => Err(needed("--calibration")),
            (_, (_, None)) => Err(needed("--colours")),
            (_, (Some(camera), Some(colours))) => {
                self.check_unused_topics(&["scans", "marker"], "laser")?;
                Ok(Some((input::read_camera(camera)?, input::read_colours(colours)?)))
            }
        }
    }

    /// Returns an error if a topic is given that only the other sensor has.
    fn check_unused_topics(&self, unused: &[&str], sensor: &str) -> Result<(), CliError> {
        let given = self.topic.iter().find(|(what, _)| unused.contains(what));
        given.map_or(Ok(()), |(what, _)| {
            let cause = format!("{what} has an effect only with --sensor {sensor}");
            Err(CliError::at("--topic", cause))
        })
    }

    /// The name of a topic.
    fn topic(&self, what: &str) -> String {
        let given = self.topic.iter().rev().find(|(given, _)| *given == what);
        let usual = TOPICS.iter().find(|(known, ..)| *known == what).map(|(_, usual, _)| *usual);
        given.map_or(usual.unwrap_or_default(), |(_, topic)| topic).to_owned()
    }

    #[expect(clippy::too_many_arguments, reason = "these are the parts of one run")]
    fn explore(
        &self,
        settings: &RunSettings,
        robot: LiveRobot,
        sensor: RobotSensor,
        world: Option<&(NamedWorld, Dart)>,
        mut log: Option<Recorder<File>>,
        progress: &Rc<Progress>,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let terminal: Option<&mut dyn Write> = if self.json { None } else { Some(&mut *out) };
        let detail = StoryDetail { every_hypothesis: false, doors: false };
        let story = match world {
            Some((world, facing)) => Story::new(world, *facing, detail),
            None => Story::with_head(format!("A robot at {}.", self.ros), detail),
        };
        let mut narrator = Narrator { story: PrintedStory::new(story, terminal), progress };
        let mut explorer = RobotExplorer::new(robot, sensor, (&mut log, &mut narrator));
        let (mapping, mapped) = explorer.map(settings);
        let moves = explorer.moves();
        let (robot, _) = explorer.into_parts();
        let logged = log.map_or(Ok(()), Recorder::finish);
        let (seconds, frames) = (robot.odometry().time, robot.frames());
        // The robot stops before anything else.
        drop(robot);
        progress.clear();
        narrator.story.finish()?;
        logged.map_err(|error| self.unwritten(&error))?;
        let name = world.map_or("", |(world, _)| &world.name);
        let frame_kind = if self.sensor == SensorChoice::Laser { "scans" } else { "images" };
        let result = DriveResult {
            world: name,
            method: settings.method,
            mapping: &mapping,
            mapped: mapped.as_ref(),
            moves,
            allows_blocked: self.options.allows_blocked(),
            percepts: match self.sensor {
                SensorChoice::Laser => FalsePercepts::BY_LASER,
                _ => FalsePercepts::BY_IMAGE,
            },
            seconds,
            frame_kind,
            frames,
        };
        if self.json {
            result.print_json(out)?;
        } else {
            result.print(out)?;
        }
        if let Some(path) = &self.map {
            match result.map() {
                Some(map) => output::write_world(path, &map)?,
                None => remark!("the map is not written: the run ended early"),
            }
        }
        Ok(result.outcome())
    }

    /// Opens the log, if one is wanted. Unknown fields of its head are empty.
    fn recorder(
        &self,
        settings: &RunSettings,
        world: Option<&(NamedWorld, Dart)>,
        eyes: Option<&(Camera, ColourModel)>,
    ) -> Result<Option<Recorder<File>>, CliError> {
        let Some(path) = &self.log else { return Ok(None) };
        let known = world.map(|(world, facing)| {
            let hash = world_hash(&world.graph, *facing);
            (world.name.clone(), hash, world.start_text(*facing))
        });
        let (world, world_hash, start) = known.unwrap_or_default();
        let run = messages::Run {
            stamp: messages::Stamp::default(),
            version: version::version().to_owned(),
            world,
            world_hash,
            start,
            marker: "directional".to_owned(),
            seed: 0,
            calibration: eyes.map(|(camera, _)| calibration::to_toml(camera)).unwrap_or_default(),
            colours: eyes.map(|(_, colours)| colours.to_toml()).unwrap_or_default(),
            command: self.command()?,
            algorithm: settings.recorded().to_string(),
        };
        let camera = eyes.map(|(camera, _)| camera.clone());
        let recorder = Recorder::new(output::create_growing(path)?, &run, camera);
        recorder.map(Some).map_err(|error| self.unwritten(&error))
    }

    fn unwritten(&self, error: &LogWriteError) -> CliError {
        let path = self.log.clone().unwrap_or_default();
        CliError::in_file(&path, format!("cannot be written: {error}"))
    }

    /// The command of this run, without the options for its outputs.
    fn command(&self) -> Result<String, CliError> {
        let path = |path: &std::path::PathBuf| path.display().to_string();
        let options = [
            ("--ros", Some(self.ros.clone())),
            ("--sensor", (self.sensor == SensorChoice::Laser).then(|| "laser".to_owned())),
            ("--calibration", self.calibration.as_ref().map(path)),
            ("--colours", self.colours.as_ref().map(path)),
            ("--plan", self.plan.as_ref().map(path)),
            ("--start", self.start.clone()),
        ];
        let topics = self.topic.iter();
        let topics = topics.map(|(what, topic)| ("--topic", Some(format!("{what}={topic}"))));
        let options = options.into_iter().chain(topics);
        let options = options.filter_map(|(name, value)| Some([name.to_owned(), value?]));
        let words = ["toposlam".to_owned(), "drive".to_owned()];
        let words = words.into_iter().chain(self.options.words()?).chain(options.flatten());
        Ok(words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" "))
    }
}

/// Prints the story of the mapping algorithm and the progress.
struct Narrator<'o, 'p> {
    story: PrintedStory<&'o mut dyn Write>,
    progress: &'p Progress,
}

impl RunObserver for Narrator<'_, '_> {
    fn event(&mut self, event: &Event) {
        if matches!(event.kind, EventKind::Frame(_)) {
            self.progress.part_done(1);
        }
    }

    fn mapping(&mut self, journey: &MapWalk, event: MappingEvent) {
        self.story.add(journey, event);
    }

    fn stop(&self) -> bool {
        self.progress.stop()
    }
}
