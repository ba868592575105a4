//! Walls and obstacles around a simulated robot, and the ranges of its sonars. Section 2.5.

use std::{collections::BTreeSet, f64::consts::FRAC_1_SQRT_2};

use toposlam_model::{
    driving::pose::Pose,
    floor_plan::{BuildingWall, FloorPlan, Rectangle, walls},
};
use toposlam_robot::superscout::{RADIUS, sonar_direction};

use crate::render::Squares;

/// Range of the sonars from the robot's centre, in metres.
const RANGE: f64 = 1.5;
/// The distance between the points of the grid on which ways are looked for, in metres.
const GRID: f64 = 0.05;
const NEIGHBOURS: [[i32; 2]; 8] =
    [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];

#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    /// The walls within a sonar's range of each place, as rectangles without depth.
    walls: Squares<Rectangle>,
    pub(super) obstacles: Vec<Rectangle>,
}

impl Surroundings {
    pub(super) fn new(plan: &FloorPlan) -> Self {
        let walls: Vec<_> = walls(plan).iter().map(rectangle).collect();
        let floors: Vec<_> = plan.floor().collect();
        let walls = Squares::new(&floors, 0.5, walls, |wall| wall.widened(RANGE));
        Self { walls, obstacles: Vec::new() }
    }

    /// The walls near a place, and all obstacles.
    fn near(&self, [x, y]: [f64; 2]) -> impl Iterator<Item = Rectangle> {
        self.walls.at([x as f32, y as f32]).chain(&self.obstacles).copied()
    }

    pub(super) fn has_room(&self, place: [f64; 2]) -> bool {
        self.is_free(place, RADIUS)
    }

    /// Whether nothing is nearer to a place than this, in metres.
    fn is_free(&self, place: [f64; 2], radius: f64) -> bool {
        self.near(place).all(|thing| {
            let off = |axis: usize| {
                place[axis] - place[axis].clamp(thing.least[axis], thing.greatest[axis])
            };
            off(0) * off(0) + off(1) * off(1) >= radius * radius
        })
    }

    /// Whether there may be a way for the robot's body from one place to another. If not, there is none: each way
    /// of the body is also a way of a body that is smaller by half the diagonal of a square, over the nearest
    /// points of the grid.
    pub(super) fn may_lead(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        let point = |[x, y]: [i32; 2]| [to[0] + GRID * f64::from(x), to[1] + GRID * f64::from(y)];
        let is_free = |at: &[i32; 2]| self.is_free(point(*at), RADIUS - GRID * FRAC_1_SQRT_2);
        let begin = [0, 1].map(|axis| ((from[axis] - to[axis]) / GRID).round() as i32);
        let mut found = BTreeSet::from([begin]);
        let mut open = Vec::from_iter(is_free(&begin).then_some(begin));
        while let Some(at) = open.pop() {
            if at == [0, 0] {
                return true;
            }
            for [x, y] in NEIGHBOURS {
                let next = [at[0] + x, at[1] + y];
                if found.insert(next) && is_free(&next) {
                    open.push(next);
                }
            }
        }
        false
    }

    /// The distance from the robot's body that a sonar measures, in metres.
    pub(super) fn sonar(&self, pose: Pose, sonar: usize) -> f64 {
        let (sine, cosine) = (pose.heading + sonar_direction(sonar)).sin_cos();
        let steepness = [cosine, sine].map(|part| if part == 0.0 { 1e300 } else { 1.0 / part });
        let mut nearest = f64::INFINITY;
        for thing in self.near(pose.position) {
            let range = first_on(&thing, pose.position, steepness);
            if range <= RANGE && range < nearest {
                nearest = range;
            }
        }
        nearest - RADIUS
    }
}

fn rectangle(wall: &BuildingWall) -> Rectangle {
    let [least, greatest] = wall.span.map(|at| wall.foot(at));
    Rectangle { least, greatest }
}

/// The distance along a ray to a rectangle; infinite if they do not meet. `steepness` is the length
/// of the ray per metre along each axis.
#[inline]
fn first_on(thing: &Rectangle, from: [f64; 2], steepness: [f64; 2]) -> f64 {
    let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        let [near, far] = [thing.least[axis], thing.greatest[axis]]
            .map(|plane| (plane - from[axis]) * steepness[axis]);
        enters = enters.max(near.min(far));
        leaves = leaves.min(near.max(far));
    }
    if enters <= leaves { enters } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

    use super::*;
    use crate::plans;

    /// One hallway to the east, 2 m wide. The walls of its dead ends are at x = -1 and x = 7.
    fn hallway() -> Surroundings {
        let junctions = [("a".to_owned(), [0.0, 0.0]), ("b".to_owned(), [6.0, 0.0])];
        let plan = FloorPlan::new(2.0, &junctions, &[("a".to_owned(), "b".to_owned())]).unwrap();
        Surroundings::new(&plan)
    }

    // paper: hardware.sonar
    #[test]
    fn sonars_measure_from_the_robots_body_to_the_walls() {
        let hallway = hallway();
        let range = |sonar| hallway.sonar(Pose { position: [0.0, 0.2], heading: 0.0 }, sonar);
        let close = |sonar: usize, expected: f64| {
            assert!((range(sonar) - expected).abs() < 1e-6, "{sonar}: {}", range(sonar));
        };
        assert_eq!(range(0), f64::INFINITY, "seven metres ahead");
        close(4, 0.8 - RADIUS);
        close(12, 1.2 - RADIUS);
        close(8, 1.0 - RADIUS);
        close(2, 0.8 * SQRT_2 - RADIUS);
        let turned = hallway.sonar(Pose { position: [0.0, 0.2], heading: FRAC_PI_4 }, 0);
        assert!((turned - (0.8 * SQRT_2 - RADIUS)).abs() < 1e-6);
    }

    #[test]
    fn the_body_fits_up_to_its_radius() {
        let mut hallway = hallway();
        assert!(hallway.has_room([3.0, 0.999 - RADIUS]));
        assert!(!hallway.has_room([3.0, 1.001 - RADIUS]));
        hallway.obstacles.push(Rectangle { least: [3.5, -0.2], greatest: [3.7, 0.2] });
        assert!(!hallway.has_room([3.4, 0.0]) && hallway.has_room([3.2, 0.0]));
        let range = hallway.sonar(Pose { position: [3.6, -0.7], heading: FRAC_PI_2 }, 0);
        assert!((range - (0.5 - RADIUS)).abs() < 1e-6);
    }

    #[test]
    fn no_way_leads_past_an_obstacle_across_a_bridge_and_across_nothing_else() {
        let mut bridges = 0;
        for (name, plan) in plans().unwrap() {
            let graph = plan.graph();
            for (dart, opposite) in graph.edges() {
                let (_, numbers) = graph.cut(&[dart], dart);
                let is_bridge = numbers[opposite.at()].is_none();
                let ends = [dart, opposite].map(|dart| plan.junction(graph.vertex(dart)).position);
                let middle = [0, 1].map(|axis| f64::midpoint(ends[0][axis], ends[1][axis]));
                // As wide as the hallway, or with a passage that is wide enough for the robot's body or is not.
                for (passage, is_passable) in [(0.0, false), (0.3, false), (0.5, true)] {
                    let half = [0, 1].map(|axis| {
                        let is_along = ends[0][axis] != ends[1][axis];
                        if is_along { 0.15 } else { plan.hallway_width() / 2.0 - passage }
                    });
                    let mut surroundings = Surroundings::new(&plan);
                    assert!(surroundings.may_lead(ends[0], ends[1]), "{name}");
                    surroundings.obstacles.push(Rectangle::centred(middle, half));
                    let may_lead = surroundings.may_lead(ends[0], ends[1]);
                    assert_eq!(may_lead, is_passable || !is_bridge, "{name} {dart:?}");
                    // A robot in the obstacle cannot move.
                    assert!(!surroundings.may_lead(middle, ends[1]));
                }
                bridges += usize::from(is_bridge);
            }
        }
        assert!(bridges > 10, "{bridges}");
    }
}
