//! `toposlam simulate PLAN`: a simulated SuperScout maps a floor plan. Sections 5 and 6.

mod feasible;
mod laser;
mod log;
#[cfg(feature = "ros1")]
mod node;
mod result;
mod run_capture;

use std::{
    fs::File,
    io::{self, IsTerminal, Write},
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};

use result::SimulationResult;
use run_capture::{KeptImages, RunCapture};
use toposlam_logs::{
    record::{RobotSensor, StoppedBy},
    recorder::Recorder,
    world_hash,
};
use toposlam_model::{
    embedded_graph::Dart, floor_plan::FloorPlan, format::named_world::NamedWorld,
};
use toposlam_robot::{
    false_percepts::FalsePercepts, recording::Recording, run_settings::RunSettings,
};
use toposlam_simulator::{
    Effects, FAULTS, FOR_EVER, IMAGE_TIME, LearnedSensors, LearningError, RobotFault,
    SimulatedRobot, SimulationConfig,
    run::{offline, run},
};
use toposlam_vision::camera::Camera;

use super::{
    CliError, Outcome,
    appearance::{Appearance, ImageSize, camera_with},
    exit_codes::help_end,
    input, noise, output,
    progress::{Progress, StopSignal},
    robot_sensor::SensorChoice,
    run_options::RunOptions,
    text::capital,
};
use crate::{
    page, picture,
    run_page_data::RunPageData,
    story::{PrintedStory, Story, StoryDetail},
};

/// Let a simulated SuperScout map a floor plan by its camera or its laser scanner
///
/// The robot stands at the start, with its back to the facing hallway, and puts its marker down along
/// it. If the plan's own start is not an L, where a marker can lie, the run starts at the nearest L.
/// Sensing turns each rendered image into a scene, Algorithm 2 drives by the scenes, and the folding
/// explorer makes the map, or with --algorithm algorithm1 Algorithm 1, which needs more moves. Each move, each percept and the map are checked against the floor
/// plan's embedded graph.
///
/// With --recover the robot goes on after a contradiction, and if it gets lost. A hallway that it cannot pass
/// is a dead end: it maps everything else, and reports the doors that are blocked.
///
/// With --sensor laser, laser scans take the place of the images, and a separate detector reports the marker.
/// With --sensor both, the robot drives by its camera, and the log has the scans, too.
#[derive(clap::Args)]
#[command(after_help = after_help())]
pub(super) struct SimulateArguments {
    /// The floor plan
    plan: PathBuf,
    /// Where the robot starts, and the door behind it [default: the plan's own start, or the nearest L]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,
    #[command(flatten)]
    options: RunOptions,
    /// Random seed
    #[arg(long, default_value_t = 0, value_name = "N")]
    seed: u64,
    /// The camera [default: a spherical mirror]
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Width and height of the images [default: 640x480, or those of the calibration]
    #[arg(long, value_name = "SIZE")]
    size: Option<ImageSize>,
    /// The colours of the building [default: learned from rendered images of other views]
    #[arg(long, value_name = "FILE")]
    colours: Option<PathBuf>,
    #[command(flatten)]
    appearance: Appearance,
    /// Sensors of the robot: camera, laser or both
    #[arg(
        long,
        value_enum,
        value_name = "SENSOR",
        default_value = "camera",
        hide_possible_values = true
    )]
    sensor: SensorChoice,
    /// Parameters of the laser scanner and of what makes its scans harder to read, .toml
    #[arg(long, value_name = "FILE")]
    scanner: Option<PathBuf>,
    /// Render no images: simulate scenes with the measured accuracy of sensing
    #[arg(long, conflicts_with_all = OF_IMAGES)]
    by_scene: bool,
    /// Noise of wheels and odometry, as a multiple of the default
    #[arg(long, default_value_t = 1.0, value_name = "TIMES", value_parser = noise, allow_hyphen_values = true)]
    noise: f64,
    /// Time to take an image, in seconds
    #[arg(long, default_value_t = IMAGE_TIME, value_name = "SECONDS", value_parser = seconds)]
    image_time: f64,
    /// Inject a fault when the robot takes this image (repeatable)
    #[arg(long, value_name = "NAME@IMAGE[:COUNT]")]
    fault: Vec<RobotFault>,
    /// Write a log of the run, .mcap
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Write a picture of the run, .svg: the plan, the path, and the junctions as the robot saw them
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page that shows the run step by step, .html
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Write the annotated images to this folder
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,
    /// Write the map: .toml, .json, .dot, or plantri's .ec or .pc
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Do not explore: serve the robot through ROS 1 topics at this master
    #[arg(long, value_name = "URI", conflicts_with_all = NOT_DRIVEN)]
    ros: Option<String>,
    /// With --ros: how fast simulated time passes, as a multiple of real time [default: 1]
    #[arg(long, value_name = "TIMES", value_parser = speed)]
    speed: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Options of rendered images, which --by-scene does not make.
const OF_IMAGES: [&str; 7] =
    ["calibration", "size", "colours", "frames", "look", "effects", "effect"];

/// Options that need a run; --ros serves the robot instead.
const NOT_DRIVEN: [&str; 14] = [
    "algorithm",
    "audit",
    "recover",
    "max_moves",
    "max_minutes",
    "battery_per_metre",
    "by_scene",
    "log",
    "svg",
    "html",
    "frames",
    "map",
    "json",
    "max_darts",
];

/// A simulation that is ready to run.
struct Simulation {
    world: NamedWorld,
    plan: Arc<FloorPlan>,
    facing: Dart,
    setting: SimulationConfig,
    settings: RunSettings,
    /// Before colours were learned.
    begun: Instant,
}

impl SimulateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        #[cfg(not(feature = "ros1"))]
        if self.ros.is_some() {
            return Err(super::without_ros());
        }
        if self.speed.is_some() && self.ros.is_none() {
            return Err(CliError::at("--speed", "this needs --ros"));
        }
        self.options.method()?;
        let scanner = self.scanner_params()?;
        self.check_places()?;
        let begun = Instant::now();
        let world = input::read_world(&self.plan)?;
        let plan = Arc::new(input::floor_plan(&self.plan, &world)?.clone());
        let facing = self.start_in(&world, &plan)?;
        feasible::check(&self.plan, &world, &plan, facing)?;
        let settings = self.options.settings(Some(&world_hash(&world.graph, facing)))?;
        let setting = SimulationConfig {
            noise: self.noise,
            image_time: self.image_time,
            keeps_track: self.log.is_some(),
            faults: self.fault.clone(),
            ..SimulationConfig::at_start(plan.clone(), facing, self.seed)
        };
        let simulation = Simulation { world, plan, facing, setting, settings, begun };
        if let (SensorChoice::Laser, Some(scanner)) = (self.sensor, &scanner) {
            let robot = simulation.setting.by_laser(scanner);
            #[cfg(feature = "ros1")]
            if let Some(master) = &self.ros {
                return node::run(robot, master, self.speed.unwrap_or(1.0), out);
            }
            let sensor = RobotSensor::Laser(Box::default());
            let log = self.recorder(&simulation, None)?;
            return self.simulate(&simulation, robot, Some(sensor), KeptImages::None, log, out);
        }
        let equipped = |robot: SimulatedRobot| match &scanner {
            Some(scanner) => robot.with_scanner(simulation.setting.scanner(scanner)),
            None => robot,
        };
        if self.by_scene {
            let robot = equipped(simulation.setting.by_scene());
            let log = self.recorder(&simulation, None)?;
            return self.simulate(&simulation, robot, None, KeptImages::None, log, out);
        }
        let effects = self.appearance.effects(self.seed)?;
        let camera = camera_with(&effects, &self.camera()?)?;
        let eyes = self.eyes(&camera)?;
        feasible::check_marker(&simulation.plan, facing, &eyes, self.appearance.look)?;
        let robot = equipped(simulation.robot(&eyes, &self.appearance, &effects));
        #[cfg(feature = "ros1")]
        if let Some(master) = &self.ros {
            return node::run(robot, master, self.speed.unwrap_or(1.0), out);
        }
        let sensor = RobotSensor::Camera(Box::new(eyes.sensor(self.appearance.look)));
        let log =
            self.recorder(&simulation, Some((&camera, eyes.colours(self.appearance.look))))?;
        let images = match (&self.frames, &self.html) {
            (Some(folder), _) => KeptImages::Files { camera, folder: folder.clone() },
            (None, Some(_)) => KeptImages::Small { camera },
            (None, None) => KeptImages::None,
        };
        self.simulate(&simulation, robot, Some(sensor), images, log, out)
    }

    /// Where the run starts. If the plan's own start is not an L, at the L that is nearest to it.
    fn start_in(&self, world: &NamedWorld, plan: &FloorPlan) -> Result<Dart, CliError> {
        let facing = input::start_of(world, self.start.as_deref())?;
        let nearest = feasible::nearest_start(plan, facing).filter(|_| self.start.is_none());
        let Some(nearest) = nearest else { return Ok(facing) };
        remark!(
            "the run starts at {}: the start of the plan, {}, is not an L, where a marker can lie",
            world.start_text(nearest),
            world.at_text(facing),
        );
        Ok(nearest)
    }

    fn check_places(&self) -> Result<(), CliError> {
        let places: [(&Option<PathBuf>, &[&str]); 3] =
            [(&self.log, &["mcap"]), (&self.svg, &["svg"]), (&self.html, &["html", "htm"])];
        for (path, endings) in places {
            if let Some(path) = path {
                output::check_place(path, endings)?;
            }
        }
        if let Some(map) = &self.map {
            // The map of a floor plan is simple.
            output::check_world_place(map, true)?;
        }
        match &self.frames {
            Some(folder) => output::make_folder(folder),
            None => Ok(()),
        }
    }

    fn camera(&self) -> Result<Camera, CliError> {
        Ok(match (&self.calibration, self.size) {
            (Some(path), None) => input::read_camera(path)?,
            (Some(path), Some(size)) => input::read_camera(path)?.sized(size.pixels()),
            (None, size) => Camera::superscout().sized(size.unwrap_or(ImageSize::Small).pixels()),
        })
    }

    fn eyes(&self, camera: &Camera) -> Result<LearnedSensors, CliError> {
        let look = self.appearance.look;
        if let Some(path) = &self.colours {
            return Ok(LearnedSensors::with_colours(camera, look, input::read_colours(path)?));
        }
        let progress = Progress::new("learning colours", "looks")?;
        let eyes = LearnedSensors::new(camera, &[look], &progress);
        progress.finish();
        eyes.map_err(|error| match error {
            LearningError::Interrupted(stopped) => stopped.into(),
            error => CliError::at("--look", error),
        })
    }

    /// What the robot takes before each command.
    fn frame_kind(&self) -> &'static str {
        match self.sensor {
            SensorChoice::Laser => "scans",
            _ if self.by_scene => "scenes",
            _ => "images",
        }
    }

    /// Runs the simulation, prints its result and writes its files.
    fn simulate(
        &self,
        simulation: &Simulation,
        robot: SimulatedRobot,
        sensor: Option<RobotSensor>,
        images: KeptImages,
        mut log: Option<Recorder<File>>,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let Simulation { world, plan, facing, settings, .. } = simulation;
        let facing = *facing;
        let progress = Progress::endless("exploring", self.frame_kind())?;
        // On a terminal the story shows how far the run is.
        let hidden = !self.json && io::stdout().is_terminal();
        let progress = if hidden { progress.hidden() } else { progress };
        let terminal: Option<&mut dyn Write> = if self.json { None } else { Some(&mut *out) };
        let detail = StoryDetail { every_hypothesis: false, doors: false };
        let story = PrintedStory::new(Story::new(world, facing, detail), terminal);
        let mut capture = RunCapture::new(story, progress, images);
        let mut recording = Recording::default();
        let observer = (&mut log, (&mut recording, &mut capture));
        let run = run(plan, facing, robot, sensor.clone(), observer, settings);
        let logged = log.map_or(Ok(()), Recorder::finish);
        let mut run_data = capture.finish(&world.name, plan, facing, &run)?;
        logged.map_err(|error| self.unwritten(&error))?;
        let computed = Instant::now();
        let stop = StoppedBy(&StopSignal);
        let replayed = offline(&recording, sensor, stop, settings);
        let compute_seconds = computed.elapsed().as_secs_f64();
        let result = SimulationResult {
            world,
            facing,
            seed: self.seed,
            allows_blocked: self.options.allows_blocked(),
            percepts: match self.sensor {
                SensorChoice::Laser => FalsePercepts::BY_LASER,
                _ if self.by_scene => FalsePercepts::BY_SCENE,
                _ => FalsePercepts::BY_IMAGE,
            },
            frame_kind: self.frame_kind(),
            run: &run,
            missed: self.fault.iter().filter(|fault| fault.frame > run.frames).collect(),
            replayed: replayed.ok(),
            compute_seconds,
            wall_seconds: simulation.begun.elapsed().as_secs_f64(),
        };
        if self.json {
            result.print_json(out)?;
        } else {
            result.print(out)?;
        }
        run_data.ending = capital(&result.in_words());
        self.write_files(&run_data, &result)?;
        Ok(result.outcome())
    }

    fn write_files(
        &self,
        run_data: &RunPageData,
        result: &SimulationResult,
    ) -> Result<(), CliError> {
        if let Some(path) = &self.map {
            match result.map() {
                Some(map) => output::write_world(path, &map)?,
                None => remark!("the map is not written: the run ended early"),
            }
        }
        let write = |path: &Path, text: String| output::write_whole(path, text.as_bytes());
        if let Some(path) = &self.svg {
            write(path, picture::run_svg(run_data))?;
        }
        if let Some(path) = &self.html {
            write(path, page::run_page(run_data))?;
        }
        Ok(())
    }
}

impl Simulation {
    fn robot(
        &self,
        eyes: &LearnedSensors,
        appearance: &Appearance,
        effects: &Effects,
    ) -> SimulatedRobot {
        self.setting.with_images(eyes.rig(), appearance.look, effects)
    }
}

/// Parses the time of an image.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| (0.0..=60.0).contains(seconds));
    seconds.ok_or_else(|| "expected a number of seconds from 0 to 60".to_owned())
}

/// Parses the speed of simulated time. At a higher speed a motion is over before the program sees it.
fn speed(text: &str) -> Result<f64, String> {
    let times = text.parse().ok().filter(|times: &f64| (0.1..=20.0).contains(times));
    times.ok_or_else(|| "expected a number from 0.1 to 20".to_owned())
}

/// The faults, the log and examples.
fn after_help() -> String {
    let faults = FAULTS.iter().map(|&(_, name, lasting, about)| match lasting {
        FOR_EVER => format!("  {name:<14}      {about}\n"),
        lasting => format!("  {name:<14} {lasting:>2}   {about}\n"),
    });
    let head = "Faults, and for how many images or commands each lasts by default, if it passes:\n"
        .to_owned();
    let notes = head
        + &faults.collect::<String>()
        + "\nThe log is an MCAP file of ROS 2 messages: /camera/image/compressed, \
/camera/annotated/compressed, /scan, /cmd_vel, /odom, /tf, and under /toposlam: run, scene, command, door, \
percept, hypothesis, map, end. If the program is killed, all but the last ten seconds can be read.

Examples:
  toposlam simulate worlds/shape-6.toml
  toposlam simulate worlds/shape-8.toml --html run.html --svg run.svg
  toposlam simulate worlds/shape-6.toml --log shape-6.mcap
  toposlam simulate worlds/shape-6.toml --seed 3 --json
  toposlam simulate worlds/building-12.toml --by-scene --algorithm algorithm1
  toposlam simulate worlds/shape-6.toml --sensor laser --log shape-6.mcap
  toposlam simulate worlds/shape-6.toml --fault blocked@40
  toposlam simulate worlds/shape-8.toml --by-scene --recover --fault carried@80
  toposlam simulate worlds/shape-8.toml --by-scene --recover --max-moves 15 \\
    --log part.mcap
  toposlam simulate worlds/shape-8.toml --by-scene --recover --resume part.mcap
  toposlam simulate worlds/shape-6.toml --ros http://127.0.0.1:11311 --speed 5
";
    help_end(
        &notes,
        &[
            (0, "the map is right"),
            (1, "the map is wrong, or the robot gave up"),
            (2, "bad usage or input"),
            (3, "ended by Ctrl-C or at --max-darts, a door is blocked, or a fault did not happen"),
        ],
    )
}
