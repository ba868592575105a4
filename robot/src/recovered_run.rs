//! A whole run of a robot that recovers from faults, and the judgement of its map.
//!
//! A hallway with an obstacle is two dead ends. So the map of a robot that could not pass is right if it is
//! isomorphic to the floor plan with that hallway cut, as far as the robot can come. An obstacle at a junction
//! cuts all its hallways.

use thiserror::Error;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    isomorphism::Bijection,
    mapping::{FACING, FoldingExploration, RecoveredMap, RecoveryConfig, map_with_recovery},
};

use crate::{
    explorer::RobotExplorer,
    ground_truth_monitor::GroundTruthMonitor,
    pose::Pose,
    record::{FrameSensor, RunObserver},
    robot::Robot as _,
    run::RunOutcome,
    simulator::SimulatedRobot,
    superscout::{CLEARANCE, RADIUS},
    truth::angle,
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
            let place = match robot.truth() {
                Some(pose) if is_at_obstacle => TruePlace::BeforeObstacle(pose),
                _ => TruePlace::Junction(monitor.truly_reached()),
            };
            let judged = match exploration.map().complete() {
                Some(map) => judge(plan, facing, (map, found.pose), place, robot.obstacle()),
                None => Err(WrongAnswer::Map),
            };
            let outcome = match judged {
                Ok(_) => RunOutcome::Right,
                Err(wrong) => RunOutcome::Wrong(wrong.to_string()),
            };
            (outcome, Some(found), judged == Ok(Passage::Blocked))
        }
    };
    let (seconds, pictures) = (robot.time(), robot.pictures());
    RecoveredRun { outcome, map, moves, is_cut, seconds, pictures }
}

/// The least and the greatest coordinates of an obstacle, in metres.
type Obstacle = [[f64; 2]; 2];

/// Of which building a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Passage {
    /// Of the plan.
    Free,
    /// Of the plan with the hallways at the obstacle cut.
    Blocked,
}

/// What is wrong with the answer of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Error)]
enum WrongAnswer {
    #[error("the robot is not where its map says")]
    Pose,
    #[error("the map is not isomorphic to the building")]
    Map,
}

/// Where a robot truly stands.
#[derive(Clone, Copy, Debug)]
enum TruePlace {
    /// At a junction, with this entry dart if it is known.
    Junction(Option<Dart>),
    /// In a hallway, before an obstacle.
    BeforeObstacle(Pose),
}

/// Of which building a map is, if the map and the robot's pose in it are right.
fn judge(
    plan: &FloorPlan,
    facing: Dart,
    (map, pose): (&EmbeddedGraph, Dart),
    place: TruePlace,
    obstacle: Option<Obstacle>,
) -> Result<Passage, WrongAnswer> {
    let compare = |world: &EmbeddedGraph, facing, reached: Option<Dart>| {
        let bijection = Bijection::of_starts((map, FACING), (world, facing));
        if !bijection.verify(map, world) {
            return Err(WrongAnswer::Map);
        }
        let is_there = reached.is_none_or(|reached| bijection.image(pose) == Some(reached));
        if is_there { Ok(()) } else { Err(WrongAnswer::Pose) }
    };
    let reached = match place {
        TruePlace::Junction(reached) => reached,
        TruePlace::BeforeObstacle(_) => None,
    };
    let free = compare(plan.graph(), facing, reached).map(|()| Passage::Free);
    let Some(obstacle) = obstacle else { return free };
    let cut = |edges: &[Dart]| {
        let (cut, numbers) = plan.graph().cut(edges, facing).ok_or(WrongAnswer::Map)?;
        let number = |dart: Dart| numbers[dart.at()];
        let reached = match place {
            TruePlace::Junction(reached) => reached.and_then(number),
            TruePlace::BeforeObstacle(pose) => {
                let hallway = hallway_behind(plan, edges, pose, obstacle);
                hallway.and_then(number).map(|dart| cut.opposite(dart))
            }
        };
        let facing = number(facing).ok_or(WrongAnswer::Map)?;
        compare(&cut, facing, reached).map(|()| Passage::Blocked)
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
    cuts.iter().fold(free, |best, edges| {
        best.or_else(|wrong| cut(edges).map_err(|other| wrong.min(other)))
    })
}

/// The dart by which a robot that stands before an obstacle left the last junction: of the hallways that are cut, the one
/// in which the robot is.
fn hallway_behind(
    plan: &FloorPlan,
    edges: &[Dart],
    pose: Pose,
    [least, greatest]: Obstacle,
) -> Option<Dart> {
    let graph = plan.graph();
    let centre = [0, 1].map(|axis| f64::midpoint(least[axis], greatest[axis]));
    let both_ways = edges.iter().flat_map(|&dart| [dart, graph.opposite(dart)]);
    let aside_and_before = |dart: Dart| {
        let angle = angle(plan.direction(dart));
        let [x, y] = plan.junction(graph.vertex(dart)).position;
        let along = |[to_x, to_y]: [f64; 2]| {
            let (dx, dy) = (to_x - x, to_y - y);
            [dx * angle.cos() + dy * angle.sin(), dy * angle.cos() - dx * angle.sin()]
        };
        let ([robot, aside], [obstacle, _]) = (along(pose.position), along(centre));
        (robot <= obstacle).then_some((aside.abs(), robot))
    };
    let in_hallway = both_ways.filter_map(|dart| Some((dart, aside_and_before(dart)?)));
    let nearest = in_hallway.min_by(|(_, one), (_, other)| {
        one.0.total_cmp(&other.0).then(one.1.abs().total_cmp(&other.1.abs()))
    });
    nearest.map(|(dart, _)| dart)
}

/// A dart of each hallway whose middle line comes nearer to an obstacle than a margin, in metres.
fn blocked(plan: &FloorPlan, [least, greatest]: Obstacle, margin: f64) -> Vec<Dart> {
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
    use super::*;
    use crate::evaluation::{
        RobotEquipment, plans,
        run_sampler::{Faults, JudgedRun, RobotMapping, RunSampler},
    };

    fn runs(faults: Faults, count: u64) -> Vec<JudgedRun> {
        let plans = plans().unwrap();
        let runs = RunSampler::new(plans, 4, faults, 1, 1.0, RobotMapping::WithRecovery);
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
