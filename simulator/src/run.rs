//! A whole run: a simulated robot maps its building, and the result is checked against the specification.
//! Section 6.

use std::fmt::Display;

use thiserror::Error;
use toposlam_logs::record::RunObserver;
use toposlam_model::{
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    isomorphism::Candidate,
    mapping::{Flaw, MapWalk, MappedWorld, MappingAlgorithm, MappingError, MappingMethod},
    world::GraphWorld,
};
use toposlam_robot::{
    any_explorer::{AnyExplorer, RobotSensor},
    explorer::ExplorerError,
    recording::Recording,
    robot::Robot as _,
    run_settings::RunSettings,
};

use crate::{
    SimulatedRobot,
    ground_truth_monitor::{GroundTruthMonitor, TruthDivergence},
    obstacle_judge::{TruePlace, judge_with_obstacle},
    sample_verdict::SampleVerdict,
};

pub use crate::obstacle_judge::WayToMarker;

/// A whole run, and its checks.
#[derive(Debug)]
pub struct Run<'p> {
    pub method: MappingMethod,
    /// The state of the algorithm: its map, and the robot's pose in it.
    pub mapping: MapWalk,
    /// What the complete map took; `None` if the run ended early.
    pub mapped: Option<MappedWorld>,
    pub error: Option<MappingError<ExplorerError>>,
    /// What is wrong with the map or the pose of a complete run.
    pub flaw: Option<Flaw>,
    /// The moves, with those of recoveries and audits.
    pub moves: u64,
    pub monitor: GroundTruthMonitor<'p>,
    /// Whether at the end the robot can come to its marker.
    pub way_to_marker: WayToMarker,
    /// The number of moves that the algorithm makes in the plan's embedded graph.
    pub explore_moves: u64,
    /// The simulated time, in seconds.
    pub seconds: f64,
    /// The number of images or scans that the robot asked for.
    pub frames: u64,
}

/// How a run, or a part of one, ended.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RobotOutcome<E> {
    /// The map and the pose are right, and each move is as specified. The map of a robot that recovers may lack
    /// hallways that are blocked.
    #[error("the map is right")]
    Right,
    #[error("the robot gave up: {0}")]
    GaveUp(E),
    /// The map or the pose is wrong, and the robot did not detect it.
    #[error("{0}")]
    Wrong(String),
}

pub type RunOutcome = RobotOutcome<MappingError<ExplorerError>>;

impl<E: Display> RobotOutcome<E> {
    pub fn verdict(&self) -> SampleVerdict {
        match self {
            Self::Right => SampleVerdict::Right,
            Self::GaveUp(_) => SampleVerdict::Undecided,
            Self::Wrong(_) => SampleVerdict::Wrong,
        }
    }

    pub fn gave_up(&self) -> bool {
        matches!(self, Self::GaveUp(_))
    }

    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Right => None,
            Self::GaveUp(error) => Some(error.to_string()),
            Self::Wrong(reason) => Some(reason.clone()),
        }
    }
}

impl Run<'_> {
    pub fn divergence(&self) -> Option<TruthDivergence> {
        self.monitor.divergence()
    }

    /// Whether the map is isomorphic to the plan, with the starts matched.
    pub fn isomorphic(&self) -> bool {
        self.error.is_none()
            && matches!(self.flaw, None | Some(Flaw::WrongPose { .. } | Flaw::TooManyMoves { .. }))
    }

    pub fn pose_true(&self) -> bool {
        self.isomorphic() && !matches!(self.flaw, Some(Flaw::WrongPose { .. }))
    }

    pub fn outcome(&self) -> RunOutcome {
        // A robot that recovers may have made mistakes on its way.
        let divergence = self.divergence().filter(|_| !self.method.recovers());
        let audit_moves = self.mapped.as_ref().map_or(0, |mapped| mapped.audit_moves);
        let (moves, expected) = (self.moves, self.explore_moves + audit_moves);
        match (&self.error, &self.flaw, divergence) {
            (Some(error), ..) => RunOutcome::GaveUp(error.clone()),
            (None, Some(flaw), Some(divergence)) => {
                RunOutcome::Wrong(format!("{flaw}; {divergence}"))
            }
            (None, Some(flaw), None) => RunOutcome::Wrong(flaw.to_string()),
            (None, None, Some(divergence)) => RunOutcome::Wrong(divergence.to_string()),
            (None, None, None) if !self.method.recovers() && moves != expected => {
                RunOutcome::Wrong(format!("it took {moves} moves instead of {expected}"))
            }
            (None, None, None) => RunOutcome::Right,
        }
    }
}

/// A simulated robot that stands at a dart's junction maps its building.
// paper: exp.simulated
pub fn run<'p>(
    plan: &'p FloorPlan,
    facing: Dart,
    robot: SimulatedRobot,
    sensor: RobotSensor,
    observer: impl RunObserver,
    settings: &RunSettings,
) -> Run<'p> {
    let &RunSettings { method, dart_bound, .. } = settings;
    let monitor = GroundTruthMonitor::new(plan, method.algorithm().aid(), facing).by(&sensor);
    let mut explorer = AnyExplorer::new(robot, sensor, (monitor, observer));
    let (mapping, mapped) = explorer.map(settings);
    let (moves, is_at_obstacle) = (explorer.moves(), explorer.is_at_obstacle());
    let (robot, (monitor, _)) = explorer.into_parts();
    let (mapped, error) = match mapped {
        Ok(mapped) => (Some(mapped), None),
        Err(error) => (None, Some(error)),
    };
    let place = match robot.truth() {
        Some(pose) if is_at_obstacle => TruePlace::BeforeObstacle(pose),
        _ => TruePlace::Junction(monitor.truly_reached()),
    };
    let way_to_marker = WayToMarker::from_place(plan, facing, place, &robot);
    let flaw = mapped.as_ref().and_then(|mapped| {
        if method.recovers() {
            let map = mapping.map().complete();
            let judge =
                |map| judge_with_obstacle(plan, facing, (map, mapped.pose), place, robot.obstacle);
            map.map_or(Err(Flaw::WrongMap), judge).err()
        } else {
            // A robot at no junction is not at its pose in the map.
            let truly = monitor.reached().unwrap_or(Dart(u32::MAX));
            let (run, mut candidate) = ((&mapping, mapped.pose), Candidate::default());
            method.algorithm().judge(run, (plan.graph(), facing), truly, &mut candidate).err()
        }
    });
    let explore_moves = explored(plan, facing, method.algorithm(), dart_bound);
    let (seconds, frames) = (robot.base.time(), robot.frames());
    Run {
        method,
        mapping,
        mapped,
        error,
        flaw,
        moves,
        monitor,
        way_to_marker,
        explore_moves,
        seconds,
        frames,
    }
}

/// The number of moves that an algorithm makes in the plan's embedded graph.
pub fn explored(
    plan: &FloorPlan,
    facing: Dart,
    algorithm: MappingAlgorithm,
    dart_bound: usize,
) -> u64 {
    let mut world = GraphWorld::with_aid(plan.graph(), algorithm.aid(), facing);
    // An error here is also an error of the robot's run.
    algorithm.map_world(&mut world, dart_bound, &mut ()).0.moves()
}

/// The off-line version: the mapping algorithm on a recording, without a robot that moves.
// paper: exp.off-line
pub fn offline(
    recording: &Recording,
    sensor: RobotSensor,
    observer: impl RunObserver,
    settings: &RunSettings,
) -> Result<MapWalk, MappingError<ExplorerError>> {
    let mut explorer = AnyExplorer::new(recording.robot(), sensor, observer);
    let (mapping, mapped) = explorer.map(settings);
    mapped.map(|_| mapping)
}

#[cfg(test)]
mod tests {
    use toposlam_model::{
        aid::{AidAction, markers::MOVABLE, team::PAIR},
        mapping::RecoveryConfig,
        percept::Door,
    };
    use toposlam_robot::{robot::RobotError, run_settings::LaserVertices};

    use super::*;
    use crate::{
        FaultKind, RobotEquipment, RobotFault, ScannerParams, SimulationConfig,
        evaluation::{
            run_sampler::{JudgedRun, RunSampler},
            sampling::sample,
        },
        plan_named, plans, starts_of,
    };

    const DARTS: usize = 200;

    /// A run of a robot that has scenes without images.
    fn by_scene(config: &SimulationConfig, method: impl Into<MappingMethod>) -> Run<'_> {
        let settings = RunSettings::new(method, DARTS);
        run(&config.plan, config.marker, config.by_scene(), RobotSensor::Scenes, (), &settings)
    }

    // paper: validation.traverse
    // paper: validation.motion
    // paper: exp.simulated
    // paper: alg2.3
    #[test]
    fn each_plan_is_mapped_with_the_moves_of_the_specification() {
        for (name, plan) in plans().unwrap() {
            for (seed, facing) in starts_of(&plan).into_iter().enumerate().step_by(3) {
                for algorithm in MappingAlgorithm::with_fixed_marker() {
                    let config = SimulationConfig::at_start(plan.clone(), facing, seed as u64);
                    let run = by_scene(&config, algorithm);
                    let what = format!("{name} from {facing:?} by {algorithm}");
                    assert_eq!(run.outcome(), RunOutcome::Right, "{what}");
                    assert!(run.isomorphic() && run.pose_true());
                    let arrivals = run.monitor.arrivals().len() as u64;
                    assert_eq!(arrivals, run.explore_moves + 1, "{what}");
                }
            }
        }
    }

    fn with_movable_marker(name: &str, start: usize, seed: u64) -> SimulationConfig {
        let plan = plan_named(name).unwrap();
        let facing = starts_of(&plan)[start];
        SimulationConfig::at_start(plan, facing, seed)
    }

    /// The moves are those of the specification, so the robot picks its marker up and drops it where the specification does.
    #[test]
    fn a_plan_is_mapped_with_a_marker_that_the_robot_carries() {
        let movable = MappingAlgorithm::MovableMarkers(MOVABLE);
        for (name, starts) in [("shape-8", 3), ("building-12", 1)] {
            for start in 0..starts {
                let config = with_movable_marker(name, start, 7 + start as u64);
                let run = by_scene(&config, movable);
                assert_eq!(run.outcome(), RunOutcome::Right, "{name} from start {start}");
                assert!(run.isomorphic() && run.pose_true());
            }
        }
        let config = with_movable_marker("shape-8", 0, 3);
        let settings = RunSettings::new(movable, DARTS);
        let sensor = RobotSensor::from(LaserVertices::OF_HALLWAYS.params());
        let robot = config.by_laser(&ScannerParams::default());
        let run = run(&config.plan, config.marker, robot, sensor, (), &settings);
        assert_eq!(run.outcome(), RunOutcome::Right, "by laser");
    }

    /// Each robot drives by itself; the moves are those of both.
    #[test]
    fn a_plan_is_mapped_by_a_robot_that_sends_another_one() {
        let team = MappingAlgorithm::Team(PAIR);
        for (name, starts) in [("shape-8", 3), ("building-12", 1)] {
            for start in 0..starts {
                let config = with_movable_marker(name, start, 7 + start as u64).with_team();
                let robot =
                    config.by_scene().with_other(config.other().by_scene(), RobotSensor::Scenes);
                let settings = RunSettings::new(team, DARTS);
                let run =
                    run(&config.plan, config.marker, robot, RobotSensor::Scenes, (), &settings);
                assert_eq!(run.outcome(), RunOutcome::Right, "{name} from start {start}");
                assert!(run.isomorphic() && run.pose_true());
            }
        }
        let config = with_movable_marker("shape-8", 0, 3).with_team();
        let params = ScannerParams::default();
        let sensor = RobotSensor::from(LaserVertices::OF_HALLWAYS.params());
        let other = config.other().by_laser(&params);
        let robot = config.by_laser(&params).with_other(other, sensor.clone());
        let settings = RunSettings::new(team, DARTS);
        let run = run(&config.plan, config.marker, robot, sensor, (), &settings);
        assert_eq!(run.outcome(), RunOutcome::Right, "by laser");
    }

    #[test]
    fn a_gripper_holds_one_marker_and_reaches_only_the_junction_of_the_robot() {
        let config = with_movable_marker("shape-8", 0, 3);
        let mut robot = config.by_scene();
        let pick_up = |robot: &mut SimulatedRobot| robot.handle(AidAction::PickUp);
        let drop = |robot: &mut SimulatedRobot| robot.handle(AidAction::Drop);
        assert_eq!(drop(&mut robot), Err(RobotError::Gripper { holds: false }));
        assert_eq!(pick_up(&mut robot), Ok(()));
        assert_eq!(pick_up(&mut robot), Err(RobotError::Gripper { holds: true }));
        let at_start = robot.base.pose;
        // In the middle of a hallway.
        robot.base.pose.position[0] += 1.3;
        robot.base.pose.position[1] += 1.3;
        assert_eq!(drop(&mut robot), Err(RobotError::NotAtJunction));
        robot.base.pose = at_start;
        assert_eq!(drop(&mut robot), Ok(()));
        robot.base.pose.position[0] += 1.3;
        assert_eq!(pick_up(&mut robot), Err(RobotError::NothingGripped));
        let send = AidAction::Send { robot: 2, door: Door(0) };
        let cannot = RobotError::CannotHandle { action: send };
        assert_eq!(robot.handle(send), Err(cannot));
    }

    fn in_shape_6(seed: u64) -> SimulationConfig {
        let plan = plan_named("shape-6").unwrap();
        let facing = starts_of(&plan)[0];
        SimulationConfig::at_start(plan, facing, seed)
    }

    // paper: exp.off-line
    #[test]
    fn a_recording_gives_the_same_map_off_line() {
        let config = in_shape_6(5);
        for algorithm in MappingAlgorithm::with_fixed_marker() {
            let mut recording = Recording::default();
            let settings = RunSettings::new(algorithm, DARTS);
            let (plan, marker, robot) = (&config.plan, config.marker, config.by_scene());
            let run = run(plan, marker, robot, RobotSensor::Scenes, &mut recording, &settings);
            assert_eq!(recording.frames.len() as u64, run.frames);
            let mut repeated = Recording::default();
            let again = offline(&recording, RobotSensor::Scenes, &mut repeated, &settings).unwrap();
            assert_eq!(again.map(), run.mapping.map());
            assert_eq!(again.moves(), run.mapping.moves());
            assert!(repeated == recording, "other commands");
        }
    }

    #[test]
    fn a_lost_robot_reports_the_reason() {
        let right = RunOutcome::Right.to_string();
        for (fault, why) in [
            ("lights-out@20", "7 images in a row do not show where the robot is"),
            ("blocked@20", "3 commands in a row were not carried out"),
            ("dropped@20:100", "the camera gives no image"),
            ("dropped@20", &*right),
            ("late@20", &*right),
            ("ignored@20", &*right),
            ("corrupt@20", &*right),
        ] {
            let config = SimulationConfig { faults: vec![fault.parse().unwrap()], ..in_shape_6(5) };
            let outcome = by_scene(&config, MappingAlgorithm::Algorithm1).outcome();
            let text = outcome.to_string();
            assert!(text.contains(why), "{fault}: {text}");
            let gave_up = text.starts_with("the robot gave up: on move ");
            assert!(gave_up || outcome == RunOutcome::Right, "{fault}: {text}");
        }
    }

    fn recovering() -> MappingMethod {
        MappingMethod::Recovering(RecoveryConfig::default())
    }

    fn runs(faults: u32, count: u64) -> Vec<JudgedRun> {
        let runs = RunSampler::new(plans().unwrap(), 4, faults, 1, 1.0, recovering());
        sample(0..count, &(), |number| runs.run(number, &RobotEquipment::Scenes, &()))
    }

    #[test]
    fn without_faults_a_robot_makes_the_same_moves_and_audits_its_map() {
        for run in runs(0, 16) {
            assert_eq!(run.ending, RunOutcome::Right);
            let mapped = run.mapped.unwrap();
            assert_eq!((mapped.recoveries, mapped.blocked.len()), (0, 0));
            assert_eq!(run.moves[0], run.moves[1] + mapped.audit_moves);
        }
    }

    #[test]
    fn after_one_or_two_faults_no_map_is_wrong_and_most_are_right() {
        for (count, most_given_up) in [(1, 5), (2, 8)] {
            let runs = runs(count, 54);
            let mut gave_up = 0;
            for run in &runs {
                assert_ne!(run.ending.verdict(), SampleVerdict::Wrong, "{run:?}");
                if run.ending != RunOutcome::Right {
                    gave_up += 1;
                    assert_ne!(run.way_to_marker, WayToMarker::Free, "{run:?}");
                }
            }
            assert!(gave_up <= most_given_up, "{gave_up} of {}", runs.len());
            assert!(runs.iter().any(|run| !run.blocked().is_empty()));
        }
    }

    /// Wherever the obstacle stands, in a hallway or before a junction, and also if the lights go out there.
    #[test]
    fn a_robot_that_gives_up_before_an_obstacle_has_no_other_way() {
        let (mut right, mut gave_up) = (0, 0);
        for frame in 2..=100 {
            let mut config = in_shape_6(frame);
            config.faults = vec![RobotFault::at(FaultKind::Blocked, frame)];
            if frame.is_multiple_of(2) {
                config.faults.push(RobotFault::at(FaultKind::LightsOut, frame + 3));
            }
            let run = by_scene(&config, recovering());
            match run.outcome() {
                RunOutcome::Right => right += 1,
                RunOutcome::GaveUp(error) => {
                    gave_up += 1;
                    let way = run.way_to_marker;
                    assert_ne!(way, WayToMarker::Free, "blocked at frame {frame}: {error}");
                }
                RunOutcome::Wrong(why) => panic!("blocked at frame {frame}: {why}"),
            }
        }
        assert!(right > 2 * gave_up, "{right} right, {gave_up} given up");
    }
}
