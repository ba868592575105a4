//! The judgement of the map of a robot that returns at obstacles.
//!
//! A hallway with an obstacle is two dead ends. So the map of a robot that could not pass is right if it is
//! isomorphic to the floor plan with that hallway cut, as far as the robot can come. An obstacle at a junction
//! cuts all its hallways.

use nalgebra::{Point2, Vector2};
use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::FloorPlan,
    isomorphism::Bijection,
    mapping::{FACING, Flaw},
};
use toposlam_robot::superscout::{CLEARANCE, RADIUS};

/// The least and the greatest coordinates of an obstacle, in metres.
type Obstacle = [[f64; 2]; 2];

/// The robot's centre keeps this distance from what is ahead, in metres.
const KEPT: f64 = RADIUS + CLEARANCE;

/// Where a robot truly stands.
#[derive(Clone, Copy, Debug)]
pub(crate) enum TruePlace {
    /// At a junction, with this entry dart if it is known.
    Junction(Option<Dart>),
    /// In a hallway, before an obstacle.
    BeforeObstacle(Pose),
}

/// Whether a map and the robot's pose in it are right, if hallways at the obstacle may be cut.
pub(crate) fn judge_with_obstacle(
    plan: &FloorPlan,
    facing: Dart,
    (map, pose): (&EmbeddedGraph, Dart),
    place: TruePlace,
    obstacle: Option<Obstacle>,
) -> Result<(), Flaw> {
    let compare = |world: &EmbeddedGraph, facing, reached: Option<Dart>| {
        let bijection = Bijection::of_starts((map, FACING), (world, facing));
        if !bijection.verify(map, world) {
            return Err(Flaw::WrongMap);
        }
        match (bijection.image(pose), reached) {
            (None, _) => Err(Flaw::NoSuchDart { dart: pose.0 }),
            (Some(image), Some(truly)) if image != truly => {
                Err(Flaw::WrongPose { believed: pose, image, truly })
            }
            _ => Ok(()),
        }
    };
    let reached = match place {
        TruePlace::Junction(reached) => reached,
        TruePlace::BeforeObstacle(_) => None,
    };
    let free = compare(plan.graph(), facing, reached);
    let Some(obstacle) = obstacle else { return free };
    let if_cut = |edges: &[Dart]| {
        let (cut, numbers) = plan.graph().cut(edges, facing);
        let number = |dart: Dart| numbers[dart.at()];
        let reached = match place {
            TruePlace::Junction(reached) => reached.and_then(number),
            TruePlace::BeforeObstacle(pose) => {
                let hallway = hallway_behind(plan, edges, pose, obstacle);
                hallway.and_then(number).map(|dart| cut.opposite(dart))
            }
        };
        compare(&cut, number(facing).ok_or(Flaw::WrongMap)?, reached)
    };
    // The robot stops before an obstacle, and does not drive exactly along the middle. So it may pass beside
    // the obstacle or not.
    let surely = blocked(plan, obstacle, 0.0);
    let perhaps = blocked(plan, obstacle, KEPT).into_iter().filter(|dart| !surely.contains(dart));
    let mut cuts = vec![surely.clone()];
    for dart in perhaps {
        let more: Vec<_> = cuts.iter().map(|edges| [&edges[..], &[dart]].concat()).collect();
        cuts.extend(more);
    }
    // If the map is right and the pose is not, that is what is wrong.
    cuts.iter().fold(free, |best, edges| match (best, if_cut(edges)) {
        (Ok(()), _) | (_, Ok(())) => Ok(()),
        (Err(Flaw::WrongMap), other) => other,
        (best, _) => best,
    })
}

/// Whether a robot can still come to its marker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WayToMarker {
    /// No obstacle is in its way.
    Free,
    /// Each way leads through a hallway whose middle an obstacle leaves less room than the robot keeps. It drives along
    /// the middle.
    Narrow,
    /// There is no way for a robot of its size.
    None,
}

impl WayToMarker {
    /// The way of a robot from where it truly stands. `may_reach`: whether there may be a way for its body to a
    /// place.
    pub(crate) fn from_place(
        plan: &FloorPlan,
        facing: Dart,
        place: TruePlace,
        obstacle: Option<Obstacle>,
        may_reach: impl FnOnce([f64; 2]) -> bool,
    ) -> Self {
        let Some(obstacle) = obstacle else { return Self::Free };
        if !may_reach(plan.junction(plan.graph().vertex(facing)).position) {
            Self::None
        } else if is_cut_off(plan, facing, place, obstacle) {
            Self::Narrow
        } else {
            Self::Free
        }
    }
}

/// Whether no way leads from the robot to the marker but through hallways whose middle line comes nearer to an obstacle
/// than the robot does.
fn is_cut_off(plan: &FloorPlan, facing: Dart, place: TruePlace, obstacle: Obstacle) -> bool {
    let edges = blocked(plan, obstacle, KEPT);
    let robot = match place {
        TruePlace::Junction(reached) => reached,
        TruePlace::BeforeObstacle(pose) => hallway_behind(plan, &edges, pose, obstacle),
    };
    let (_, numbers) = plan.graph().cut(&edges, facing);
    robot.is_some_and(|robot| numbers[robot.at()].is_none())
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
        let onwards = Vector2::from(plan.direction(dart).vector());
        let junction = Point2::from(plan.junction(graph.vertex(dart)).position);
        let [to_robot, to_obstacle] =
            [pose.position, centre].map(|place| Point2::from(place) - junction);
        let (robot, aside) = (onwards.dot(&to_robot), onwards.perp(&to_robot));
        let obstacle = onwards.dot(&to_obstacle);
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
    use crate::plans;

    /// An obstacle of 30 cm in the middle of a hallway.
    fn obstacle_in(plan: &FloorPlan, dart: Dart) -> Obstacle {
        let graph = plan.graph();
        let ends = [dart, graph.opposite(dart)].map(|dart| plan.junction(graph.vertex(dart)));
        let middle =
            [0, 1].map(|axis| f64::midpoint(ends[0].position[axis], ends[1].position[axis]));
        [middle.map(|place| place - 0.15), middle.map(|place| place + 0.15)]
    }

    #[test]
    fn a_robot_is_cut_off_beyond_a_bridge_and_nowhere_else() {
        let mut bridges = 0;
        for (name, plan) in plans().unwrap() {
            let graph = plan.graph();
            for (dart, opposite) in graph.edges() {
                let obstacle = obstacle_in(&plan, dart);
                let is_bridge = graph.cut(&[dart], dart).1[opposite.at()].is_none();
                bridges += usize::from(is_bridge);
                for [marker, robot] in [[dart, opposite], [opposite, dart]] {
                    for (robot, expected) in [(robot, is_bridge), (marker, false)] {
                        let place = TruePlace::Junction(Some(robot));
                        let found = is_cut_off(&plan, marker, place, obstacle);
                        assert_eq!(found, expected, "{name} {dart:?}");
                    }
                }
            }
        }
        assert!(bridges > 10, "{bridges}");
    }
}
