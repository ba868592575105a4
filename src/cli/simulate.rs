//! `toposlam simulate PLAN`: a simulated SuperScout maps a floor plan. Sections 5 and 6.

mod feasible;

use std::{io::Write, path::PathBuf, sync::Arc, time::Instant};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use toposlam_logs::{record::StoppedBy, world_hash};
use toposlam_model::{
    aid::{self, AidKind, markers::MOVABLE, team::PAIR},
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::Directional,
};
use toposlam_robot::{
    any_explorer::RobotSensor,
    budget::RunBudget,
    recording::Recording,
    run_settings::{LaserVertices, RunSettings},
};
use toposlam_simulator::{
    FAULTS, FOR_EVER, LearnedSensors, LearningError, RobotFault, SimulatedRobot, SimulationConfig,
    corridor_starts_of,
    run::{Run, RunOutcome, offline, run},
};
use toposlam_vision::{camera::Camera, colour::ColourModel};

use super::{
    CliError, Outcome,
    appearance::{Appearance, ImageSize, camera_with},
    exit_codes::help_end,
    input, noise, output,
    progress::{Progress, StopSignal},
    robot_sensor::{ScannerOption, SensorChoice, needs_camera},
    ros_options::RosOptions,
    run_capture::RunCapture,
    run_options::{GivenOptions, RunOptions},
    run_report::{RobotReport, RobotRun, RunReport},
    text::{capital, grouped, quoted},
};
use crate::{page, picture, story};

/// Let a simulated SuperScout map a floor plan by its camera or its laser scanner
///
/// The robot stands at the start, with its back to the facing hallway, and puts its marker down along
/// it. If the plan's own start is not an L, where a marker can lie, the run starts at the nearest L.
/// Sensing turns each rendered image into a scene, Algorithm 2 drives by the scenes, and the folding
/// explorer makes the map; `--algorithm algorithm1` uses Algorithm 1, which needs more moves. Each move, each
/// percept and the map are checked against the floor plan's embedded graph.
///
/// With --recover the robot goes on after a contradiction, and if it gets lost. A hallway that it cannot pass
/// is a dead end: it maps everything else, and reports the doors that are blocked.
///
/// With --sensor laser, laser scans take the place of the images, and a separate detector reports the marker.
/// With --sensor both, the robot drives by its camera, and the log has the scans, too.
#[derive(clap::Args)]
#[command(
    after_help = after_help(),
    group = clap::ArgGroup::new("served").args(["ros", "ros2"]),
    mut_arg("ros", |ros| ros.conflicts_with_all(NOT_DRIVEN)),
    mut_arg("ros2", |ros2| ros2.conflicts_with_all(NOT_DRIVEN)),
)]
pub(super) struct SimulateArguments {
    #[command(flatten)]
    given: GivenOptions,
    /// The floor plan
    #[arg(id = "PLAN")]
    plan: PathBuf,
    /// The robot's marking aid: directional; movable, which it picks up, carries and drops with its gripper; or team-2, another
    /// robot, which it sends
    #[arg(long, visible_alias = "marker", default_value = "directional", value_name = "KIND", value_parser = robot_aids(), hide_possible_values = true)]
    aid: AidKind,
    /// Where the robot starts, and the door behind it [default: the plan's own start, or the nearest L]
    #[arg(long, value_name = "VERTEX:FACING")]
    start: Option<String>,
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
    #[command(flatten)]
    scanner: ScannerOption,
    /// Render no images: simulate scenes with the measured accuracy of sensing
    #[arg(long, conflicts_with_all = OF_IMAGES)]
    by_scene: bool,
    /// Noise of wheels and odometry, as a multiple of the default
    #[arg(long, default_value_t = 1.0, value_name = "TIMES", value_parser = noise, allow_hyphen_values = true)]
    noise: f64,
    /// Inject a fault when the robot takes this image (repeatable)
    #[arg(long, value_name = "NAME@IMAGE[:COUNT]")]
    fault: Vec<RobotFault>,
    /// Write a picture of the run, .svg: the plan, the path, and the junctions as the robot saw them
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page that shows the run step by step, .html
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    options: RunOptions,
    #[command(flatten)]
    ros: RosOptions,
    /// With --ros2 or --ros: the robot stands in a corridor, on its way to a junction with three doors, where its marker
    /// lies, as drive --corridors needs it
    #[arg(
        long,
        help_heading = "ROS",
        requires = "served",
        conflicts_with_all = NOT_DRIVEN
    )]
    corridors: bool,
    /// With --ros2 or --ros: how fast simulated time passes, as a multiple of real time
    #[arg(
        long,
        value_name = "TIMES",
        default_value_t = 1.0,
        value_parser = speed,
        help_heading = "ROS",
        requires = "served",
        conflicts_with_all = NOT_DRIVEN
    )]
    speed: f64,
}

/// Options of rendered images, which neither --by-scene nor --sensor laser makes.
const OF_IMAGES: [&str; 5] = ["calibration", "size", "colours", "look", "effect"];

/// Options that need a run; --ros and --ros2 serve the robot instead. All are named: clap drops the requirement of an option
/// that conflicts.
const NOT_DRIVEN: [&str; 14] = [
    "aid",
    "algorithm",
    "audit",
    "recover",
    "blocked",
    "resume",
    "budget",
    "by_scene",
    "log",
    "svg",
    "html",
    "map",
    "proof",
    "json",
];

/// A simulation that is ready to run.
struct Simulation {
    world: NamedWorld,
    plan: Arc<FloorPlan>,
    facing: Dart,
    settings: RunSettings,
    robot: SimulatedRobot,
    sensor: RobotSensor,
    /// With a camera that takes images.
    sensors: Option<(Camera, ColourModel)>,
    frame_kind: &'static str,
}

/// A robot with the sensors of the run.
type Equipped<'s> = Box<dyn Fn(&SimulationConfig) -> SimulatedRobot + 's>;

impl SimulateArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ros.check_build()?;
        let begun = Instant::now();
        let simulation = self.prepare()?;
        #[cfg(any(feature = "ros1", feature = "ros2"))]
        if self.ros.is_given() {
            return serve(simulation.robot, &self.ros, self.speed, out);
        }
        self.simulate(simulation, begun, out)
    }

    /// Checks the options, reads the inputs and learns the colours.
    fn prepare(&self) -> Result<Simulation, CliError> {
        let scanner = self.sensor.scanner(self.scanner.given.as_deref())?;
        if self.sensor == SensorChoice::Laser {
            let mut of_images = ["by-scene"].into_iter().chain(OF_IMAGES);
            if let Some(option) = of_images.find(|option| self.given.has(option)) {
                return Err(needs_camera(&format!("--{option}")));
            }
        }
        output::check_place(&self.svg, &["svg"])?;
        output::check_place(&self.html, &["html", "htm"])?;
        // The map of a floor plan is simple.
        self.options.check_places(true)?;
        let world = input::read_world(&self.plan)?;
        let plan = Arc::new(input::floor_plan(&self.plan, &world)?.clone());
        let facing = if self.corridors {
            self.corridor_start_in(&world, &plan)?
        } else {
            let facing = self.start_in(&world, &plan)?;
            feasible::check(&self.plan, &world, &plan, facing)?;
            facing
        };
        if let Some(scanner) = &scanner {
            let is_enough = scanner.check_range(plan.hallway_width());
            is_enough.map_err(|error| CliError::at("--scanner", error))?;
        }
        let settings = self.options.settings(Some(&world_hash(&world.graph, facing)))?;
        let settings = self.with_aid(settings)?;
        let vertices = LaserVertices::OF_HALLWAYS;
        let laser = scanner.as_ref().map(|_| vertices);
        let settings = RunSettings { laser, ..settings };
        let config = SimulationConfig {
            noise: self.noise,
            keeps_track: self.options.log.is_some(),
            faults: self.fault.clone(),
            ..if self.corridors {
                SimulationConfig::in_corridor(plan.clone(), facing, self.seed)
            } else {
                SimulationConfig::at_start(plan.clone(), facing, self.seed)
            }
        };
        let config = if self.has_team() { config.with_team() } else { config };
        let (equipped, sensor, sensors, frame_kind): (Equipped, _, _, _) =
            match (&scanner, self.by_scene) {
                (Some(scanner), _) if self.sensor == SensorChoice::Laser => {
                    let sensor = RobotSensor::from(vertices.params());
                    let equipped = |config: &SimulationConfig| config.by_laser(scanner);
                    (Box::new(equipped), sensor, None, "scans")
                }
                (_, true) => {
                    (Box::new(SimulationConfig::by_scene), RobotSensor::Scenes, None, "scenes")
                }
                (_, false) => {
                    let look = self.appearance.look;
                    let effects = self.appearance.effects(self.seed)?;
                    let camera = camera_with(&effects, &self.camera()?)?;
                    let sensors = self.sensors(&camera)?;
                    feasible::check_marker(&plan, facing, &sensors, look)?;
                    let rig = sensors.rig().clone();
                    let equipped =
                        move |config: &SimulationConfig| config.with_images(&rig, look, &effects);
                    let sensor = RobotSensor::Camera(Box::new(sensors.sensor(look)));
                    let sensors = Some((camera, sensors.colours(look).clone()));
                    (Box::new(equipped), sensor, sensors, "images")
                }
            };
        let robot = equipped(&config);
        let robot = match &scanner {
            Some(scanner) if self.sensor == SensorChoice::Both => {
                robot.with_scanner(config.scanner(scanner))
            }
            _ => robot,
        };
        let robot = if self.has_team() {
            robot.with_other(equipped(&config.other()), sensor.clone())
        } else {
            robot
        };
        Ok(Simulation { world, plan, facing, settings, robot, sensor, sensors, frame_kind })
    }

    fn has_team(&self) -> bool {
        matches!(self.aid, AidKind::Team(_))
    }

    /// The settings of a robot with its marking aid.
    fn with_aid(&self, settings: RunSettings) -> Result<RunSettings, CliError> {
        if !self.aid.moves() {
            return Ok(settings);
        }
        let fixed = ["algorithm", "audit", "recover", "resume"];
        if let Some(option) = fixed.into_iter().find(|option| self.given.has(option)) {
            let cause = format!("this needs --aid {}", AidKind::from(Directional).name());
            return Err(CliError::at(format!("--{option}"), cause));
        }
        if settings.budget != RunBudget::default() {
            let cause = "the robot cannot return to a marker that moves; only darts are counted";
            return Err(CliError::at("--budget", cause));
        }
        let mut algorithms = MappingAlgorithm::all();
        let algorithm = algorithms.find(|algorithm| algorithm.aid() == self.aid);
        Ok(RunSettings { method: algorithm.unwrap_or_default().into(), ..settings })
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

    /// The corridor in which the run starts, and its junction.
    fn corridor_start_in(&self, world: &NamedWorld, plan: &FloorPlan) -> Result<Dart, CliError> {
        let facing = input::start_of(world, self.start.as_deref())?;
        let starts = corridor_starts_of(plan);
        if starts.contains(&facing) {
            return Ok(facing);
        }
        let wrong = |cause: String| Err(CliError::in_file(&self.plan, cause));
        match starts.first() {
            Some(&start) if self.start.is_none() => Ok(start),
            Some(&start) => {
                let start = quoted(&world.start_text(start));
                wrong(format!("{} has not three doors, as {start} has", world.at_text(facing)))
            }
            None => wrong("it has no junction with three doors".to_owned()),
        }
    }

    fn camera(&self) -> Result<Camera, CliError> {
        Ok(match (&self.calibration, self.size) {
            (Some(path), None) => input::read_camera(path)?,
            (Some(path), Some(size)) => input::read_camera(path)?.sized(size.pixels()),
            (None, size) => Camera::superscout().sized(size.unwrap_or(ImageSize::Small).pixels()),
        })
    }

    fn sensors(&self, camera: &Camera) -> Result<LearnedSensors, CliError> {
        let look = self.appearance.look;
        if let Some(path) = &self.colours {
            return Ok(LearnedSensors::with_colours(camera, look, input::read_colours(path)?));
        }
        let progress = Progress::new("learning colours", "looks")?;
        let sensors = LearnedSensors::new(camera, &[look], &progress);
        progress.finish();
        sensors.map_err(|error| match error {
            LearningError::Interrupted(stopped) => stopped.into(),
            error => CliError::at("--look", error),
        })
    }

    /// Runs the simulation, prints its result and writes its files.
    fn simulate(
        &self,
        simulation: Simulation,
        begun: Instant,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let Simulation { world, plan, facing, settings, robot, sensor, sensors, frame_kind } =
            simulation;
        let command = self.given.command(&["toposlam", "simulate", &self.plan.to_string_lossy()]);
        let in_world = Some((&world, facing));
        let mut log =
            self.options.recorder(command, &settings, in_world, self.seed, sensors.as_ref())?;
        let story_out: Option<&mut dyn Write> =
            if self.options.json { None } else { Some(&mut *out) };
        let camera = sensors.filter(|_| self.html.is_some()).map(|(camera, _)| camera);
        let head = story::head(&world, facing);
        let mut capture = RunCapture::new(head, story_out, frame_kind, camera)?;
        let mut recording = Recording::default();
        let observer = (&mut log, (&mut recording, &mut capture));
        let run = run(&plan, facing, robot, sensor.clone(), observer, &settings);
        let logged = self.options.close(log);
        let mut page_data = capture.page_data(&world, &plan, facing, &run);
        let walk = capture.finish()?;
        logged?;
        let computed = Instant::now();
        // A run that ended early ends early again.
        let _ = offline(&recording, sensor, StoppedBy(&StopSignal), &settings);
        let compute_seconds = computed.elapsed().as_secs_f64();
        let missed: Vec<_> = self.fault.iter().filter(|fault| fault.frame > run.frames).collect();
        let ended = RobotRun {
            method: run.method,
            mapping: &run.mapping,
            mapped: run.mapped.as_ref(),
            error: run.error.as_ref(),
            moves: run.moves,
            seconds: run.seconds,
            frames: run.frames,
            frame_kind,
        };
        let report = self.report(&world, facing, &run, &ended, &missed, compute_seconds);
        let mut ending = vec![in_words(&run, &ended)];
        page_data.ending = capital(&ending[0]);
        if self.options.json {
            report.print_json(out)?;
        } else {
            ending
                .extend(run.divergence().filter(|_| run.error.is_some()).map(|it| it.to_string()));
            ending.extend(missed.iter().map(|fault| {
                let frames = grouped(run.frames.into());
                format!(
                    "the fault {fault} did not happen: the run ended after {frames} {frame_kind}"
                )
            }));
            report.print(out, &ended, &ending)?;
            remark!("{:.1} s", begun.elapsed().as_secs_f64());
        }
        let about = format!("The map of {}, made by a simulated robot", world.name);
        let map = ended.map(&format!("{}-map", world.name), &about);
        self.options.write_map(map.as_ref(), &walk)?;
        if let Some(path) = &self.svg {
            output::write_whole(path, picture::run_svg(&page_data).as_bytes())?;
        }
        if let Some(path) = &self.html {
            output::write_whole(path, page::run_page(&page_data).as_bytes())?;
        }
        Ok(match (run.outcome(), ended.outcome(self.options.allows_blocked())) {
            (RunOutcome::Wrong(_), _) => Outcome::Violated,
            (RunOutcome::Right, Outcome::Holds) if !missed.is_empty() => Outcome::Incomplete,
            (_, outcome) => outcome,
        })
    }

    fn report(
        &self,
        world: &NamedWorld,
        facing: Dart,
        run: &Run,
        ended: &RobotRun,
        missed: &[&RobotFault],
        compute_seconds: f64,
    ) -> RunReport {
        let divergence = run.divergence();
        let is_right = run.outcome() == RunOutcome::Right;
        // It is that of a robot with the directional marker.
        let certificate =
            (!self.aid.moves()).then(|| ended.certificate(&world.graph, facing, is_right));
        let robot = RobotReport::Simulated {
            plan: world.name.clone(),
            start: world.start_text(facing),
            seed: self.seed,
            algorithm: run.method.algorithm().name(),
            edges: world.graph.edge_count(),
            explore_moves: run.explore_moves,
            isomorphic: run.isomorphic(),
            pose_true: run.pose_true(),
            conforms: divergence.is_none(),
            divergence: divergence.as_ref().map(ToString::to_string),
            divergence_move: divergence.as_ref().map(|divergence| divergence.moves),
            faults_missed: missed.iter().map(ToString::to_string).collect(),
            // The control loop counts in quarters of a second, an image in tenths.
            simulated_seconds: (run.seconds * 1e3).round() / 1e3,
            compute_seconds,
        };
        RunReport::new(ended, certificate, robot)
    }
}

fn in_words(run: &Run, ended: &RobotRun) -> String {
    match run.outcome() {
        RunOutcome::Wrong(why) => why,
        RunOutcome::Right if ended.blocked().is_empty() && !run.method.recovers() => {
            ended.ending("right", "") + ", all as specified"
        }
        _ => ended.ending("right", "right, and complete"),
    }
}

/// Serves the robot through topics until Ctrl-C: another program drives it.
#[cfg(any(feature = "ros1", feature = "ros2"))]
fn serve(
    robot: SimulatedRobot,
    ros: &RosOptions,
    speed: f64,
    out: &mut dyn Write,
) -> Result<Outcome, CliError> {
    use toposlam_robot::live::RobotTopics;
    use toposlam_simulator::live::{ServeSummary, serve};

    use super::progress::must_stop;

    let topics = RobotTopics::default();
    let served = ros.serve(&topics)?;
    let RobotTopics { wheels, odometry, images, scans, marker, .. } = &topics;
    writeln!(out, "A simulated robot {}. Ctrl-C ends it.", ros.place()?)?;
    writeln!(out, "  subscribes to  {wheels}")?;
    writeln!(out, "  publishes      {odometry}, /tf, {images}, {scans}, {marker}")?;
    out.flush()?;
    let summary = serve(robot, &*served, speed, must_stop);
    let ServeSummary { seconds, real_seconds, frames } =
        summary.map_err(|error| CliError::at("the topics", error))?;
    writeln!(
        out,
        "{seconds:.0} s of simulated time in {real_seconds:.0} s ({:.1} times real time), \
         {} images ({:.1} a second)",
        seconds / real_seconds,
        grouped(frames.into()),
        frames as f64 / real_seconds
    )?;
    Ok(Outcome::Holds)
}

/// Parses the name of a marking aid that the simulated robot has.
fn robot_aids() -> impl TypedValueParser<Value = AidKind> {
    let aids = [AidKind::from(Directional), MOVABLE.into(), AidKind::Team(PAIR)];
    let names = aids.map(|aid| PossibleValue::new(aid.name()).help(aid.about()));
    PossibleValuesParser::new(names).try_map(|name| aid::named(&name))
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
  toposlam simulate worlds/shape-8.toml --aid movable
  toposlam simulate worlds/shape-8.toml --aid team-2
  toposlam simulate worlds/shape-6.toml --sensor laser --log shape-6.mcap
  toposlam simulate worlds/shape-6.toml --sensor laser --scanner rplidar-a1
  toposlam simulate worlds/shape-6.toml --fault blocked@40
  toposlam simulate worlds/shape-8.toml --by-scene --recover --fault carried@80
  toposlam simulate worlds/shape-8.toml --by-scene --recover --budget 15moves \\
    --log part.mcap
  toposlam simulate worlds/shape-8.toml --by-scene --recover --resume part.mcap
  toposlam simulate worlds/shape-6.toml --ros2 --sensor laser --speed 5
";
    help_end(
        &notes,
        &[
            (0, "the map is right"),
            (1, "the map is wrong, or the robot gave up"),
            (2, "bad usage or input"),
            (
                3,
                "ended by Ctrl-C or at the darts of --budget, a door is blocked, or a fault did not happen",
            ),
        ],
    )
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        arguments: SimulateArguments,
    }

    #[test]
    fn the_command_repeats_the_run_without_the_options_for_its_outputs() {
        for (line, command) in [
            (
                "a.toml --log run.mcap --json --by-scene --noise 0.5",
                "a.toml --algorithm folding --by-scene --noise 0.5 --seed 0",
            ),
            (
                "a.toml --seed 7 --fault carried@40 --audit --fault dropped@3:9 --size 1280x960 \
                 --effect none --effect noise=0.25 --algorithm algorithm1 --budget 20darts",
                "a.toml --algorithm algorithm1 --audit=1 --budget 20darts --effect none \
                 --effect noise=0.25 --fault carried@40 --fault dropped@3:9 --seed 7 --size 1280x960",
            ),
            ("a.toml --aid movable", "a.toml --aid movable --seed 0"),
            (
                "a.toml --scanner it's.toml --sensor laser",
                r"a.toml --algorithm folding --scanner 'it'\''s.toml' --seed 0 --sensor laser",
            ),
        ] {
            let words = ["simulate"].into_iter().chain(line.split_whitespace());
            let given = Line::try_parse_from(words).unwrap().arguments.given;
            assert_eq!(given.command(&["a.toml"]), command, "{line}");
        }
    }
}
