//! The judgement of the map of a robot that returns at obstacles.
//!
//! A hallway with an obstacle is two dead ends. So the map of a robot that could not pass is right if it is
//! isomorphic to the floor plan with that hallway cut, as far as the robot can come. An obstacle at a junction
//! cuts all its hallways.

use nalgebra::{Point2, Vector2, center};
use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::{FloorPlan, Rectangle},
    isomorphism::Bijection,
    mapping::{FACING, Flaw},
};
use toposlam_robot::superscout::{CLEARANCE, RADIUS};

use crate::SimulatedRobot;

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
    obstacle: Option<Rectangle>,
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
    /// The way of a robot from where it truly stands.
    pub(crate) fn from_place(
        plan: &FloorPlan,
        facing: Dart,
        place: TruePlace,
        robot: &SimulatedRobot,
    ) -> Self {
        let Some(obstacle) = robot.obstacle else { return Self::Free };
        let marker = plan.junction(plan.graph().vertex(facing)).position;
        if !robot.base.surroundings.may_lead(robot.base.pose.position, marker) {
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
fn is_cut_off(plan: &FloorPlan, facing: Dart, place: TruePlace, obstacle: Rectangle) -> bool {
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
    obstacle: Rectangle,
) -> Option<Dart> {
    let graph = plan.graph();
    let centre: Point2<f64> = center(&obstacle.least.into(), &obstacle.greatest.into());
    let both_ways = edges.iter().flat_map(|&dart| [dart, graph.opposite(dart)]);
    let aside_and_before = |dart: Dart| {
        let onwards = Vector2::from(plan.direction(dart).vector());
        let junction = Point2::from(plan.junction(graph.vertex(dart)).position);
        let [to_robot, to_obstacle] =
            [Point2::from(pose.position), centre].map(|place| place - junction);
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
fn blocked(plan: &FloorPlan, obstacle: Rectangle, margin: f64) -> Vec<Dart> {
    let graph = plan.graph();
    let place = |dart: Dart| plan.junction(graph.vertex(dart)).position;
    let edges = graph.edges().filter(|&(dart, opposite)| {
        Rectangle::around(place(dart), place(opposite)).meets(&obstacle.widened(margin))
    });
    edges.map(|(dart, _)| dart).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plans;

    #[test]
    fn a_robot_is_cut_off_beyond_a_bridge_and_nowhere_else() {
        let mut bridges = 0;
        for (name, plan) in plans().unwrap() {
            let graph = plan.graph();
            for (dart, opposite) in graph.edges() {
                let ends = [dart, opposite].map(|dart| plan.junction(graph.vertex(dart)).position);
                let middle: Point2<f64> = center(&ends[0].into(), &ends[1].into());
                let obstacle = Rectangle::centred(middle.into(), [0.15; 2]);
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
