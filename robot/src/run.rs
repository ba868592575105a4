//! A whole run: a simulated robot maps its building, and the result is checked against the specification.
//! Section 6.

use thiserror::Error;
use toposlam_model::{
    check::{Algorithm1, Flaw, Folding, judge},
    embedded_graph::Dart,
    floor_plan::FloorPlan,
    isomorphism::Candidate,
    mapping::{DirectionalAlgorithm, MappingError, MappingRun},
    world::{GraphWorld, State},
};

use crate::{
    explorer::{ExplorerError, RobotExplorer},
    ground_truth_monitor::{GroundTruthMonitor, TruthDivergence},
    record::{FrameSensor, RunObserver},
    recording::Recording,
    simulator::SimulatedRobot,
};

/// A whole run, and its checks.
#[derive(Debug)]
pub struct Run<'p> {
    /// The robot's map and its pose in it.
    pub mapping: MappingRun,
    /// Why it ended early, if it did.
    pub error: Option<MappingError<ExplorerError>>,
    /// What is wrong with the map or the pose of a complete run.
    pub flaw: Option<Flaw>,
    /// Every arrival, checked.
    pub monitor: GroundTruthMonitor<'p>,
    /// The number of moves that the algorithm makes in the plan's embedded graph.
    pub explore_moves: u64,
    /// The simulated time, in seconds.
    pub seconds: f64,
    /// The number of pictures that the robot asked for.
    pub pictures: u64,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunOutcome {
    /// The map and the pose are right, and each move is as specified.
    #[error("the map is right")]
    Right,
    /// The robot gave up, for this reason.
    #[error("the robot gave up: {0}")]
    GaveUp(MappingError<ExplorerError>),
    /// The map or the pose is wrong, and the robot did not notice.
    #[error("{0}")]
    Wrong(String),
}

impl Run<'_> {
    /// The first arrival that is not as expected.
    #[must_use]
    pub fn divergence(&self) -> Option<TruthDivergence> {
        self.monitor.divergence()
    }

    /// Whether the map is isomorphic to the plan, with the starts matched.
    #[must_use]
    pub fn isomorphic(&self) -> bool {
        self.error.is_none()
            && matches!(self.flaw, None | Some(Flaw::WrongPose { .. } | Flaw::TooManyMoves { .. }))
    }

    /// Whether the robot is where it believes it is.
    #[must_use]
    pub fn pose_true(&self) -> bool {
        self.isomorphic() && !matches!(self.flaw, Some(Flaw::WrongPose { .. }))
    }

    /// How it ended.
    #[must_use]
    pub fn outcome(&self) -> RunOutcome {
        match (&self.error, &self.flaw, self.divergence()) {
            (Some(error), ..) => RunOutcome::GaveUp(error.clone()),
            (None, Some(flaw), Some(divergence)) => {
                RunOutcome::Wrong(format!("{flaw}; {divergence}"))
            }
            (None, Some(flaw), None) => RunOutcome::Wrong(flaw.to_string()),
            (None, None, Some(divergence)) => RunOutcome::Wrong(divergence.to_string()),
            (None, None, None) if self.mapping.moves() != self.explore_moves => {
                let (moves, explore) = (self.mapping.moves(), self.explore_moves);
                RunOutcome::Wrong(format!("it took {moves} moves instead of {explore}"))
            }
            (None, None, None) => RunOutcome::Right,
        }
    }
}

/// A simulated robot that stands at a dart's junction maps its building.
// paper: exp.simulated
pub fn run(
    plan: &FloorPlan,
    facing: Dart,
    robot: SimulatedRobot,
    sensor: impl FrameSensor,
    observer: impl RunObserver,
    algorithm: DirectionalAlgorithm,
    dart_bound: usize,
) -> Run<'_> {
    let monitor = GroundTruthMonitor::new(plan, facing);
    let mut explorer = RobotExplorer::new(robot, sensor, (monitor, observer));
    let mut mapping = MappingRun::new(algorithm, dart_bound);
    let error = explorer.map(&mut mapping).err();
    let (robot, (monitor, _)) = explorer.into_parts();
    let flaw = match error {
        Some(_) => None,
        None => flaw(plan, facing, &mapping, monitor.reached()),
    };
    let explore_moves = explored(plan, facing, algorithm, dart_bound);
    let (seconds, pictures) = (robot.time(), robot.pictures());
    Run { mapping, error, flaw, monitor, explore_moves, seconds, pictures }
}

/// What is wrong with the map or the pose.
fn flaw(
    plan: &FloorPlan,
    facing: Dart,
    mapping: &MappingRun,
    reached: Option<Dart>,
) -> Option<Flaw> {
    let world = GraphWorld::new(plan.graph(), facing);
    let placed = world.state().placed;
    // A robot at no junction is not at its pose in the map.
    let nowhere = Dart(u32::MAX);
    let world = world.at(State { pose: reached.unwrap_or(nowhere), placed });
    let mut candidate = Candidate::default();
    match mapping {
        MappingRun::Algorithm1(state) => judge(&Algorithm1, state, facing, &world, &mut candidate),
        MappingRun::Folding(state) => judge(&Folding, state, facing, &world, &mut candidate),
    }
    .err()
}

/// The number of moves that an algorithm makes in the plan's embedded graph.
#[must_use]
pub fn explored(
    plan: &FloorPlan,
    facing: Dart,
    algorithm: DirectionalAlgorithm,
    dart_bound: usize,
) -> u64 {
    let mut mapping = MappingRun::new(algorithm, dart_bound);
    // An error here is also an error of the robot's run.
    let _ = mapping.map_world(&mut GraphWorld::new(plan.graph(), facing), &mut ());
    mapping.moves()
}

/// The off-line version: the mapping algorithm on a recording, without a robot that moves.
///
/// # Errors
/// Returns an error if the recorded run ended early, if a command is not the recorded one, or if the
/// observer stops.
// paper: exp.off-line
pub fn offline(
    recording: &Recording,
    sensor: impl FrameSensor,
    observer: impl RunObserver,
    algorithm: DirectionalAlgorithm,
    dart_bound: usize,
) -> Result<MappingRun, MappingError<ExplorerError>> {
    let mut explorer = RobotExplorer::new(recording.robot(), sensor, observer);
    let mut mapping = MappingRun::new(algorithm, dart_bound);
    explorer.map(&mut mapping)?;
    Ok(mapping)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        evaluation::{plans, run_sampler::starts_of},
        record::NoSensor,
        simulator::{FaultKind, RobotFault, SimulationConfig},
    };

    const DARTS: usize = 200;

    // paper: validation.traverse
    // paper: validation.motion
    // paper: exp.simulated
    // paper: alg2.3
    #[test]
    fn each_plan_is_mapped_with_the_moves_of_the_specification() {
        for (name, plan) in plans().unwrap() {
            for (seed, facing) in starts_of(&plan).into_iter().enumerate().step_by(3) {
                for algorithm in DirectionalAlgorithm::ALL {
                    let robot =
                        SimulationConfig::at_start(plan.clone(), facing, seed as u64).by_scene();
                    let run = run(&plan, facing, robot, NoSensor, (), algorithm, DARTS);
                    let what = format!("{name} from {facing:?} by {algorithm}");
                    assert_eq!(run.outcome(), RunOutcome::Right, "{what}");
                    assert!(run.isomorphic() && run.pose_true());
                    let arrivals = run.monitor.arrivals().len() as u64;
                    assert_eq!(arrivals, run.explore_moves + 1, "{what}");
                }
            }
        }
    }

    // paper: exp.off-line
    #[test]
    fn a_recording_gives_the_same_map_off_line() {
        let (_, plan) = plans().unwrap().swap_remove(2);
        let facing = starts_of(&plan)[0];
        let config = SimulationConfig::at_start(plan.clone(), facing, 5);
        for algorithm in DirectionalAlgorithm::ALL {
            let mut recording = Recording::default();
            let robot = config.by_scene();
            let run = run(&plan, facing, robot, NoSensor, &mut recording, algorithm, DARTS);
            assert_eq!(recording.len() as u64, run.pictures);
            let again = offline(&recording, NoSensor, (), algorithm, DARTS).unwrap();
            assert_eq!(again.map(), run.mapping.map());
            assert_eq!(again.moves(), run.mapping.moves());
        }
    }

    #[test]
    fn a_lost_robot_reports_the_reason() {
        let (_, plan) = plans().unwrap().swap_remove(2);
        let facing = starts_of(&plan)[0];
        let mut setting = SimulationConfig::at_start(plan.clone(), facing, 5);
        let outcome = |setting: &SimulationConfig| {
            let robot = setting.by_scene();
            let algorithm = DirectionalAlgorithm::Algorithm1;
            run(&plan, facing, robot, NoSensor, (), algorithm, DARTS).outcome().to_string()
        };
        for (kind, why) in [
            (FaultKind::LightsOut, "7 pictures in a row do not show where the robot is"),
            (FaultKind::Blocked, "3 commands in a row were not carried out"),
        ] {
            setting.faults = vec![RobotFault::at(kind, 20)];
            let text = outcome(&setting);
            assert!(
                text.contains(why) && text.starts_with("the robot gave up: on move "),
                "{text}"
            );
        }
        setting.faults =
            vec![RobotFault { lasting: 100, ..RobotFault::at(FaultKind::Dropped, 20) }];
        assert!(outcome(&setting).contains("the camera gives no picture"));
        for kind in [FaultKind::Dropped, FaultKind::Late, FaultKind::Ignored, FaultKind::Corrupt] {
            setting.faults = vec![RobotFault::at(kind, 20)];
            assert_eq!(outcome(&setting), RunOutcome::Right.to_string(), "{}", kind.name());
        }
    }
}
