//! The ground truth for one image: what the floor plan has around a pose.
//!
//! Up to [`JUNCTION_WITHIN`] from a turning point the robot is at the junction. From [`HALLWAY_FROM`] on it
//! is in the hallway. Between them both answers are right, if it is the right junction. Distances are along
//! the hallway. Positions and angles are relative to the robot, as in a scene.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use nalgebra::{Isometry2, Point2, Vector2};
use toposlam_model::{
    driving::{
        pose::Pose,
        scene::{MarkerView, undirected, wrapped},
        visit::JunctionShape,
    },
    embedded_graph::{Dart, Vertex},
    floor_plan::{Direction, FloorPlan, Hallway, JunctionKind},
    percept::Door,
};
use toposlam_vision::geometry::{distance, nearest, unit};

/// Up to this distance from a turning point the robot is at the junction, in metres.
pub const JUNCTION_WITHIN: f64 = 0.5;
/// From this distance on the robot is in the hallway, in metres.
pub const HALLWAY_FROM: f64 = 1.5;

/// The ground truth at a pose.
#[derive(Clone, Debug, PartialEq)]
pub enum Truth {
    /// In a hallway, far from any junction.
    Hallway(HallwayTruth),
    /// In a hallway, near these junctions.
    Between(HallwayTruth, Vec<JunctionTruth>),
    Junction(JunctionTruth),
}

/// The robot's pose in a hallway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HallwayTruth {
    /// The hallway's direction, in (-pi/2, pi/2].
    pub heading: f64,
    /// The distance from the robot's centre to the wall on its left, in metres.
    pub left: f64,
    pub right: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct JunctionTruth {
    pub vertex: Vertex,
    pub kind: JunctionKind,
    /// What it looks like from the door behind the robot; `None` where there is none.
    pub shape: Option<JunctionShape>,
    /// The directions of the doors, clockwise from the one behind the robot if there is one.
    pub doors: Vec<f64>,
    pub turning_point: [f64; 2],
}

impl Truth {
    /// The ground truth at a pose; `None` off the floor.
    pub fn at(plan: &FloorPlan, pose: Pose) -> Option<Self> {
        let on_floor = plan.hallways().iter().zip(plan.floor());
        let stretches = on_floor.filter(|(_, floor)| floor.holds(pose.position));
        let stretches = stretches.map(|(&hallway, _)| Stretch::new(plan, hallway, pose.position));
        let stretch = nearest(stretches, Stretch::off)?;
        let near = |within: f64| {
            let ends = stretch.ends().into_iter().filter(move |&(_, distance)| distance <= within);
            ends.map(|(vertex, _)| JunctionTruth::from_plan(plan, vertex, pose))
        };
        if let Some(junction) = near(JUNCTION_WITHIN).next() {
            return Some(Self::Junction(junction));
        }
        let hallway = stretch.truth(plan, pose);
        let junctions: Vec<_> = near(HALLWAY_FROM.next_down()).collect();
        Some(if junctions.is_empty() {
            Self::Hallway(hallway)
        } else {
            Self::Between(hallway, junctions)
        })
    }

    /// The junctions at or near which the robot is.
    pub fn junctions(&self) -> &[JunctionTruth] {
        match self {
            Self::Hallway(_) => &[],
            Self::Between(_, junctions) => junctions,
            Self::Junction(junction) => std::slice::from_ref(junction),
        }
    }

    /// The robot's angle to its hallway in radians, and its distance from the middle in metres, both without sign.
    pub fn off_middle(&self) -> Option<[f64; 2]> {
        match self {
            Self::Hallway(hallway) | Self::Between(hallway, _) => {
                Some([hallway.heading.abs(), (hallway.left - hallway.right).abs() / 2.0])
            }
            Self::Junction(junction) => {
                let entry = junction.doors.first().filter(|_| junction.shape.is_some())?;
                let aside = unit(*entry).perp(&Vector2::from(junction.turning_point)).abs();
                Some([PI - entry.abs(), aside])
            }
        }
    }
}

struct Stretch {
    hallway: Hallway,
    direction: Direction,
    /// Along the hallway from its first junction, in metres.
    along: f64,
    /// To the left of its middle, looking along its direction.
    aside: f64,
    length: f64,
}

impl Stretch {
    fn new(plan: &FloorPlan, hallway: Hallway, position: [f64; 2]) -> Self {
        let [from, to] = [hallway.from, hallway.to].map(|vertex| plan.junction(vertex).position);
        let direction = Direction::between(from, to).unwrap_or(Direction::North);
        let onwards = Vector2::from(direction.vector());
        let from_first = Point2::from(position) - Point2::from(from);
        Self {
            hallway,
            direction,
            along: onwards.dot(&from_first),
            aside: onwards.perp(&from_first),
            length: distance(from, to),
        }
    }

    /// The distance of the position from the line between the turning points, along an axis.
    fn off(&self) -> f64 {
        let beyond = (-self.along).max(self.along - self.length);
        self.aside.abs().max(beyond)
    }

    /// The junctions at its ends, with the distances of their turning points along an axis.
    fn ends(&self) -> [(Vertex, f64); 2] {
        let Hallway { from, to } = self.hallway;
        [(from, self.along), (to, self.length - self.along)]
            .map(|(vertex, distance)| (vertex, distance.abs().max(self.aside.abs())))
    }

    fn truth(&self, plan: &FloorPlan, pose: Pose) -> HallwayTruth {
        let onwards = wrapped(angle(self.direction) - pose.heading);
        let heading = undirected(onwards);
        let half = plan.hallway_width() / 2.0;
        let along = (onwards - heading).cos().signum();
        HallwayTruth { heading, left: half - along * self.aside, right: half + along * self.aside }
    }
}

impl JunctionTruth {
    pub fn from_plan(plan: &FloorPlan, vertex: Vertex, pose: Pose) -> Self {
        let junction = plan.junction(vertex);
        let mut darts: Vec<_> = plan.graph().darts_of(vertex).collect();
        let relative_angle = |&dart: &Dart| wrapped(angle(plan.direction(dart)) - pose.heading);
        let is_behind = |dart: &Dart| wrapped(relative_angle(dart) - PI).abs() <= FRAC_PI_4;
        let behind = darts.iter().position(is_behind);
        darts.rotate_left(behind.unwrap_or(0));
        let plan_from_robot = Isometry2::new(pose.position.into(), pose.heading);
        Self {
            vertex,
            kind: junction.kind,
            shape: behind.map(|_| plan.shape(darts[0])),
            doors: darts.iter().map(relative_angle).collect(),
            turning_point: plan_from_robot
                .inverse_transform_point(&junction.position.into())
                .into(),
        }
    }

    /// The distance to the turning point along the entry centre line, positive ahead; `None` if there is
    /// no door behind the robot.
    pub fn distance(&self) -> Option<f64> {
        let inwards = unit(self.doors.first()? + PI);
        self.shape.map(|_| inwards.dot(&Vector2::from(self.turning_point)))
    }
}

/// A marker on the floor of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LyingMarker {
    /// The junction where it lies.
    pub vertex: Vertex,
    pub centre_in_plan: Point2<f64>,
    /// That of its longer side.
    pub direction: Direction,
}

impl LyingMarker {
    /// On the turning point of a dart's vertex, along the dart.
    pub fn along(plan: &FloorPlan, dart: Dart) -> Self {
        let vertex = plan.graph().vertex(dart);
        let centre_in_plan = plan.junction(vertex).position.into();
        Self { vertex, centre_in_plan, direction: plan.direction(dart) }
    }

    /// Where a robot with this pose puts it down: below itself, along the axis of the plan that is nearest to its heading.
    /// `None` if the robot is at no junction.
    pub fn below(plan: &FloorPlan, pose: Pose) -> Option<Self> {
        let (vertex, direction) = (junction_at(plan, pose)?, nearest_direction(pose.heading));
        Some(Self { vertex, centre_in_plan: pose.position.into(), direction })
    }

    /// The same marker, farther in its direction, in metres.
    #[must_use]
    pub fn moved(self, metres: f64) -> Self {
        let way = metres * Vector2::from(self.direction.vector());
        Self { centre_in_plan: self.centre_in_plan + way, ..self }
    }

    /// The marker as a robot at a pose sees it. Its door is known if there is a door behind the robot.
    pub fn seen_from(&self, plan: &FloorPlan, pose: Pose) -> MarkerView {
        let junction = JunctionTruth::from_plan(plan, self.vertex, pose);
        let points = wrapped(angle(self.direction) - pose.heading);
        let is_it = |&door: &f64| wrapped(door - points).abs() < FRAC_PI_4;
        let door = junction.doors.iter().position(is_it);
        let plan_from_robot = Isometry2::new(pose.position.into(), pose.heading);
        MarkerView {
            position: plan_from_robot.inverse_transform_point(&self.centre_in_plan).into(),
            axis: undirected(points),
            door: junction.shape.and(door).map(|door| Door(door as u32)),
        }
    }
}

/// The junction where a robot with this pose is; `None` if it is at none.
pub fn junction_at(plan: &FloorPlan, pose: Pose) -> Option<Vertex> {
    let off = |vertex: &Vertex| distance(plan.junction(*vertex).position, pose.position);
    nearest(plan.graph().vertices(), off).filter(|vertex| off(vertex) <= JUNCTION_WITHIN)
}

/// The junction within whose walls a robot with this pose is; `None` if it is within none.
pub fn junction_around(plan: &FloorPlan, pose: Pose) -> Option<Vertex> {
    let off = |vertex: &Vertex| {
        let at = plan.junction(*vertex).position;
        (at[0] - pose.position[0]).abs().max((at[1] - pose.position[1]).abs())
    };
    nearest(plan.graph().vertices(), off).filter(|vertex| off(vertex) <= plan.hallway_width() / 2.0)
}

/// The direction that is nearest to a heading.
pub fn nearest_direction(heading: f64) -> Direction {
    let (sine, cosine) = heading.sin_cos();
    match (cosine.abs() > sine.abs(), cosine > 0.0, sine > 0.0) {
        (true, true, _) => Direction::East,
        (true, false, _) => Direction::West,
        (false, _, true) => Direction::North,
        (false, _, false) => Direction::South,
    }
}

/// A direction, in radians counter-clockwise from east.
pub fn angle(direction: Direction) -> f64 {
    match direction {
        Direction::North => FRAC_PI_2,
        Direction::East => 0.0,
        Direction::South => -FRAC_PI_2,
        Direction::West => PI,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{evaluation::judged_view::SceneClass, plan_named};

    /// In shape 6: end (4,8) - corner (0,8) - tee (0,4) - sw (0,0) - se (4,0) - ne (4,4) - tee.
    fn at(x: f64, y: f64, degrees: f64) -> Truth {
        let pose = Pose { position: [x, y], heading: degrees.to_radians() };
        Truth::at(&plan_named("shape-6").unwrap(), pose).unwrap()
    }

    fn junction_at(x: f64, y: f64, degrees: f64) -> JunctionTruth {
        let Truth::Junction(junction) = at(x, y, degrees) else { panic!("{x} {y}") };
        junction
    }

    #[track_caller]
    fn close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
        for (one, other) in found.iter().zip(expected) {
            assert!((one - other).abs() < 1e-9, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn off_the_floor_nothing_is_true() {
        let pose = Pose { position: [2.0, 2.0], heading: 0.0 };
        assert_eq!(Truth::at(&plan_named("shape-6").unwrap(), pose), None);
    }

    #[test]
    fn in_a_hallway_the_truth_has_the_distances_of_the_walls() {
        // In the hallway from the tee to the ne corner, 0.1 m north of its middle; to the west, and to the east.
        for (degrees, left, right) in [(190.0, 0.9, 0.7), (10.0, 0.7, 0.9)] {
            let Truth::Hallway(truth) = at(2.0, 4.1, degrees) else { panic!("in the middle") };
            close(&[truth.heading, truth.left, truth.right], &[-10_f64.to_radians(), left, right]);
        }
    }

    #[test]
    fn half_a_metre_and_a_metre_and_a_half_decide() {
        for (x, y, near) in [
            (0.5, 4.0, "junction"),
            (0.501, 4.0, "between"),
            (1.499, 4.0, "between"),
            (1.5, 4.0, "hallway"),
            (2.5, 4.3, "hallway"),
            (2.501, 4.3, "between"),
        ] {
            let found = match at(x, y, 0.0) {
                Truth::Hallway(_) => "hallway",
                Truth::Between(_, junctions) if junctions.len() == 1 => "between",
                Truth::Between(..) => "between several",
                Truth::Junction(_) => "junction",
            };
            assert_eq!(found, near, "{x} {y}");
        }
    }

    #[test]
    fn a_short_hallway_is_between_two_junctions() {
        let junctions = [("a".to_owned(), [0.0, 0.0]), ("b".to_owned(), [2.8, 0.0])];
        let plan = FloorPlan::new(1.4, &junctions, &[("a".to_owned(), "b".to_owned())]).unwrap();
        let truth = Truth::at(&plan, Pose { position: [1.4, 0.0], heading: 0.0 }).unwrap();
        let Truth::Between(_, junctions) = truth else { panic!("{truth:?}") };
        let distances: Vec<_> = junctions.iter().map(JunctionTruth::distance).collect();
        // The robot comes from a, whose only door is ahead.
        assert_eq!(distances, [None, Some(1.4)]);
    }

    #[test]
    fn doors_are_listed_clockwise_from_the_one_behind() {
        let (left, ahead, right, behind) = (FRAC_PI_2, 0.0, -FRAC_PI_2, PI);
        let cases = [
            (3.6, 8.0, 0.0, vec![behind], "dead-end"),
            (0.4, 8.0, 180.0, vec![behind, left], "l-left"),
            (0.0, 7.6, 90.0, vec![behind, right], "l-right"),
            (0.4, 4.0, 180.0, vec![behind, left, right], "t-by-stem"),
            (0.0, 3.6, 90.0, vec![behind, ahead, right], "t-stem-right"),
            (0.0, 4.4, 270.0, vec![behind, left, ahead], "t-stem-left"),
        ];
        for (x, y, heading, doors, name) in cases {
            let junction = junction_at(x, y, heading);
            let found: Vec<_> = junction.doors.iter().map(|door| wrapped(door + 1e-12)).collect();
            let expected: Vec<_> = doors.iter().map(|door| wrapped(door + 1e-12)).collect();
            close(&found, &expected);
            assert_eq!(SceneClass::Junction(junction.shape.unwrap()).to_string(), name);
            close(&[junction.distance().unwrap()], &[0.4]);
            close(&junction.turning_point, &[0.4, 0.0]);
        }
    }

    #[test]
    fn the_turning_point_is_behind_once_it_is_passed() {
        let junction = junction_at(-0.3, 4.1, 170.0);
        close(&[junction.distance().unwrap()], &[-0.3]);
        let turned = 10_f64.to_radians();
        // It is a little to the left, and the robot looks a little to the right.
        let (sine, cosine) = turned.sin_cos();
        let expected = [-0.3 * cosine - 0.1 * sine, -0.3 * sine + 0.1 * cosine];
        close(&junction.turning_point, &expected);
    }

    #[test]
    fn a_robot_that_has_turned_has_no_door_behind_it() {
        let junction = junction_at(0.3, 8.0, 0.0);
        assert_eq!((junction.shape, junction.distance()), (None, None));
        assert_eq!(junction.kind, JunctionKind::L);
    }

    #[test]
    fn a_marker_points_along_a_door() {
        let plan = plan_named("shape-6").unwrap();
        let corner = Vertex(1);
        // Doors of the corner, clockwise from north: east, south. The robot comes from the east.
        let pose = Pose { position: [0.5, 8.0], heading: PI };
        for (dart, door, axis) in [(0, 0, 0.0), (1, 1, FRAC_PI_2)] {
            let dart = plan.graph().dart(corner, dart).unwrap();
            let marker = LyingMarker::along(&plan, dart).seen_from(&plan, pose);
            assert_eq!(marker.door, Some(Door(door)));
            close(&[marker.axis.abs()], &[axis]);
            close(&marker.position, &[0.5, 0.0]);
        }
    }
}
