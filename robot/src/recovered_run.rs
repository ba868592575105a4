//! A whole run of a robot that recovers from faults, and the judgement of its map.
//!
//! A hallway with an obstacle is two dead ends. So the map of a robot that could not pass is right if it is
//! isomorphic to the floor plan with that hallway cut, as far as the robot can come. An obstacle at a junction
//! cuts all its hallways.

use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    isomorphism::Bijection,
    mapping::{FACING, FoldingExploration, RecoveredMap, RecoveryConfig, map_with_recovery},
};

use crate::{
    explorer::RobotExplorer,
    ground_truth_monitor::GroundTruthMonitor,
    record::{FrameSensor, RunObserver},
    run::RunOutcome,
    simulator::SimulatedRobot,
    superscout::{CLEARANCE, RADIUS},
};

/// A run of a robot that recovers.
#[derive(Clone, Debug)]
pub struct RecoveredRun {
    /// How it ended.
    pub outcome: RunOutcome,
    /// What the map took; `None` if the robot gave up.
    pub map: Option<RecoveredMap>,
    /// The moves.
    pub moves: u64,
    /// Whether the map has a hallway that the robot could not pass.
    pub is_cut: bool,
    /// The simulated time, in seconds.
    pub seconds: f64,
    /// The number of pictures that the robot asked for.
    pub pictures: u64,
}

/// A simulated robot that stands at a dart's junction maps its building with the folding explorer, audits its map,
/// and recovers from faults.
pub fn run_with_recovery(
    plan: &FloorPlan,
    facing: Dart,
    robot: SimulatedRobot,
    sensor: impl FrameSensor,
    observer: impl RunObserver,
    dart_bound: usize,
) -> RecoveredRun {
    let monitor = GroundTruthMonitor::new(plan, facing);
    let mut explorer =
        RobotExplorer::new(robot, sensor, (monitor, observer)).returning_at_obstacles();
    let mut exploration = FoldingExploration::new(dart_bound);
    let config = RecoveryConfig::default();
    let mapped = map_with_recovery(&mut explorer, &mut exploration, config, &mut ());
    let moves = explorer.moves();
    let is_at_obstacle = explorer.is_at_obstacle();
    let (robot, (monitor, _)) = explorer.into_parts();
    let (outcome, map, is_cut) = match mapped {
        Err(error) => (RunOutcome::GaveUp(error), None, false),
        Ok(found) => {
            let reached = monitor.truly_reached().filter(|_| !is_at_obstacle);
            let graph = exploration.map().complete();
            let judged = graph.and_then(|graph| {
                judge(plan, facing, (graph, found.pose), reached, robot.obstacle())
            });
            let wrong = || RunOutcome::Wrong("the map or the pose is wrong".to_owned());
            let outcome = judged.map_or_else(wrong, |_| RunOutcome::Right);
            (outcome, Some(found), judged == Some(Passage::Blocked))
        }
    };
    let (seconds, pictures) = (robot.time(), robot.pictures());
    RecoveredRun { outcome, map, moves, is_cut, seconds, pictures }
}

/// Of which building a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Passage {
    /// Of the plan.
    Free,
    /// Of the plan with the hallways at the obstacle cut.
    Blocked,
}

/// Of which building a map is, if the map and the robot's pose in it are right. The true pose is compared if the
/// robot is at a junction.
fn judge(
    plan: &FloorPlan,
    facing: Dart,
    (map, pose): (&EmbeddedGraph, Dart),
    reached: Option<Dart>,
    obstacle: Option<[[f64; 2]; 2]>,
) -> Option<Passage> {
    let is_right = |world: &EmbeddedGraph, facing, reached: Option<Dart>| {
        let bijection = Bijection::of_starts((map, FACING), (world, facing));
        let is_there = reached.is_none_or(|reached| bijection.image(pose) == Some(reached));
        bijection.verify(map, world) && is_there
    };
    if is_right(plan.graph(), facing, reached) {
        return Some(Passage::Free);
    }
    let obstacle = obstacle?;
    let is_right_if_cut = |edges: &[Dart]| {
        let (cut, numbers) = plan.graph().cut(edges, facing)?;
        let number = |dart: Dart| numbers[dart.at()];
        Some(is_right(&cut, number(facing)?, reached.and_then(number)))
    };
    // The robot stops before an obstacle, and does not drive exactly along the middle. So it may pass beside
    // the obstacle or not.
    let surely = blocked(plan, obstacle, 0.0);
    let perhaps = blocked(plan, obstacle, RADIUS + CLEARANCE)
        .into_iter()
        .filter(|dart| !surely.contains(dart));
    let mut cuts = vec![surely.clone()];
    for dart in perhaps {
        let more: Vec<_> = cuts.iter().map(|edges| [&edges[..], &[dart]].concat()).collect();
        cuts.extend(more);
    }
    let is_cut = cuts.iter().any(|edges| is_right_if_cut(edges) == Some(true));
    is_cut.then_some(Passage::Blocked)
}

/// A dart of each hallway whose middle line comes nearer to an obstacle than a margin, in metres.
fn blocked(plan: &FloorPlan, [least, greatest]: [[f64; 2]; 2], margin: f64) -> Vec<Dart> {
    let graph = plan.graph();
    let position = |dart: Dart| plan.junction(graph.vertex(dart)).position;
    // Hallways run along the axes.
    let is_blocked = |&dart: &Dart| {
        let [from, to] = [position(dart), position(graph.opposite(dart))];
        (0..2).all(|axis| {
            from[axis].min(to[axis]) <= greatest[axis] + margin
                && from[axis].max(to[axis]) >= least[axis] - margin
        })
    };
    let edges = graph.edges().map(|(dart, _)| dart);
    edges.filter(is_blocked).collect()
}

#[cfg(test)]
mod tests {
    use toposlam_model::mapping::DirectionalAlgorithm;

    use super::*;
    use crate::evaluation::{
        RobotEquipment, plans,
        run_sampler::{Faults, JudgedRun, Recovery, RunSampler},
    };

    fn runs(faults: Faults, count: u64) -> Vec<JudgedRun> {
        let algorithm = DirectionalAlgorithm::Folding;
        let runs = RunSampler::new(plans().unwrap(), 4, faults, 1, 1.0, algorithm, Recovery::Full);
        runs.judged(0..count, &RobotEquipment::Scenes, &())
    }

    #[test]
    fn without_faults_a_robot_makes_the_same_moves_and_audits_its_map() {
        for run in runs(Faults::None, 16) {
            assert_eq!(run.ending, RunOutcome::Right);
            let recovered = run.recovered.unwrap();
            assert_eq!((recovered.recoveries, recovered.is_cut), (0, false));
            assert_eq!(run.moves[0], run.moves[1] + recovered.audit_moves);
        }
    }

    #[test]
    fn after_one_or_two_faults_no_map_is_wrong_and_most_are_right() {
        for (count, most_given_up) in [(1, 5), (2, 8)] {
            let runs = runs(Faults::Each(count), 54);
            let is_wrong = |run: &&JudgedRun| matches!(run.ending, RunOutcome::Wrong(_));
            let wrong = runs.iter().find(is_wrong);
            assert!(wrong.is_none(), "{wrong:?}");
            let gave_up = runs.iter().filter(|run| run.ending != RunOutcome::Right).count();
            assert!(gave_up <= most_given_up, "{gave_up} of {}", runs.len());
            assert!(runs.iter().any(|run| run.recovered.is_some_and(|run| run.is_cut)));
        }
    }
}
