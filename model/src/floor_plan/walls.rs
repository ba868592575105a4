//! The walls of a floor plan: the border of the union of its floors. Section 2.4.

use super::{FloorPlan, Rectangle, TOLERANCE};

/// A straight wall along an axis, with floor on one side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingWall {
    /// The axis along which it runs: 0 for x, 1 for y.
    pub along: usize,
    /// Its coordinate on the other axis, in metres.
    pub plane: f64,
    /// The side of the floor: 1 for greater coordinates, -1 for smaller ones.
    pub floor_side: f64,
    /// Its ends along its axis, in metres.
    pub span: [f64; 2],
    /// For each end, whether it is an outer corner, around which the floor continues.
    pub juts: [bool; 2],
}

impl BuildingWall {
    pub fn length(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    pub fn foot(&self, along: f64) -> [f64; 2] {
        if self.along == 0 { [along, self.plane] } else { [self.plane, along] }
    }

    /// Whether it stands between two places, in metres.
    pub fn is_between(&self, one: [f64; 2], other: [f64; 2]) -> bool {
        let across = 1 - self.along;
        let [before, behind] = [one, other].map(|place| place[across] - self.plane);
        if before * behind >= 0.0 {
            return false;
        }
        let share = before / (before - behind);
        let at = one[self.along] + share * (other[self.along] - one[self.along]);
        self.span[0] <= at && at <= self.span[1]
    }
}

/// The walls around the floor of a plan: first those along x, sorted by plane and beginning.
pub fn walls(plan: &FloorPlan) -> Vec<BuildingWall> {
    let floors: Vec<Rectangle> = plan.floor().collect();
    let mut walls: Vec<BuildingWall> =
        (0..2).flat_map(|along| walls_along(&floors, along)).collect();
    for wall in &mut walls {
        wall.juts = [0, 1].map(|end| juts(wall, end, &floors));
    }
    walls
}

/// The walls along one axis. Rectangles end on certain lines. A stretch of such a line between two
/// corners is a wall if it has floor on exactly one side.
fn walls_along(floors: &[Rectangle], along: usize) -> Vec<BuildingWall> {
    let across = 1 - along;
    let ends = |axis: usize, floor: &Rectangle| [floor.least[axis], floor.greatest[axis]];
    let planes = distinct(floors.iter().flat_map(|floor| ends(across, floor)).collect());
    let mut walls: Vec<BuildingWall> = Vec::new();
    for plane in planes {
        let touching: Vec<&Rectangle> = floors
            .iter()
            .filter(|floor| {
                let [least, greatest] = ends(across, floor);
                least - TOLERANCE <= plane && plane <= greatest + TOLERANCE
            })
            .collect();
        let cuts = distinct(touching.iter().flat_map(|floor| ends(along, floor)).collect());
        for cut in cuts.windows(2) {
            let middle = f64::midpoint(cut[0], cut[1]);
            let floor_at = |across_at: f64| {
                touching.iter().any(|floor| {
                    let ([from, to], [least, greatest]) = (ends(along, floor), ends(across, floor));
                    from <= middle && middle <= to && least <= across_at && across_at <= greatest
                })
            };
            let sides = [-1.0, 1.0].map(|side: f64| floor_at(plane + side * 2.0 * TOLERANCE));
            let floor_side = match sides {
                [false, true] => 1.0,
                [true, false] => -1.0,
                _ => continue,
            };
            match walls.last_mut() {
                Some(wall)
                    if wall.plane.total_cmp(&plane).is_eq()
                        && wall.floor_side.total_cmp(&floor_side).is_eq()
                        && (wall.span[1] - cut[0]).abs() <= TOLERANCE =>
                {
                    wall.span[1] = cut[1];
                }
                _ => walls.push(BuildingWall {
                    along,
                    plane,
                    floor_side,
                    span: [cut[0], cut[1]],
                    juts: [false; 2],
                }),
            }
        }
    }
    walls
}

/// Whether there is floor just beyond an end of a wall and just behind its plane.
fn juts(wall: &BuildingWall, end: usize, floors: &[Rectangle]) -> bool {
    let outwards = if end == 0 { -1.0 } else { 1.0 };
    let mut beyond = wall.foot(wall.span[end] + outwards * 2.0 * TOLERANCE);
    beyond[1 - wall.along] -= wall.floor_side * 2.0 * TOLERANCE;
    floors.iter().any(|floor| floor.holds(beyond))
}

fn distinct(mut coordinates: Vec<f64>) -> Vec<f64> {
    coordinates.sort_by(f64::total_cmp);
    coordinates.dedup_by(|one, other| (*one - *other).abs() <= TOLERANCE);
    coordinates
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_graph::world;

    fn plan(name: &str) -> FloorPlan {
        world(name).plan.unwrap()
    }

    const PLANS: [&str; 4] = ["shape-6", "shape-8", "building-12", "building-25"];

    /// The area of a plan's floor. The rectangles at a junction share a square.
    fn area(plan: &FloorPlan) -> f64 {
        let size = |floor: Rectangle| {
            (floor.greatest[0] - floor.least[0]) * (floor.greatest[1] - floor.least[1])
        };
        let shared = 2 * plan.hallways().len() - plan.junctions().len();
        plan.floor().map(size).sum::<f64>() - shared as f64 * plan.hallway_width().powi(2)
    }

    #[test]
    fn walls_enclose_the_area_of_the_floor() {
        for plan in PLANS.map(plan) {
            for along in 0..2 {
                // By Gauss, the area is the sum of plane times length, signed by the side of the
                // floor.
                let enclosed: f64 = walls(&plan)
                    .iter()
                    .filter(|wall| wall.along == along)
                    .map(|wall| -wall.floor_side * wall.plane * wall.length())
                    .sum();
                assert!((enclosed - area(&plan)).abs() < 1e-9, "{enclosed}");
            }
        }
    }

    #[test]
    fn a_wall_has_floor_on_one_side_only() {
        for plan in PLANS.map(plan) {
            let floors: Vec<_> = plan.floor().collect();
            for wall in walls(&plan) {
                for share in [0.001, 0.3, 0.5, 0.999] {
                    let foot = wall.foot(wall.span[0] + share * wall.length());
                    for side in [1.0, -1.0] {
                        let mut place = foot;
                        place[1 - wall.along] += side * wall.floor_side * 1e-4;
                        let floor = floors.iter().any(|floor| floor.holds(place));
                        assert_eq!(floor, side > 0.0, "{wall:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_digit_8_has_four_walls_around_it_and_four_in_each_loop() {
        let walls = walls(&plan("shape-8"));
        assert_eq!(walls.len(), 12);
        // The outer walls have inner corners only, the walls of the loops have outer corners only.
        let juts = walls.iter().filter(|wall| wall.juts == [true; 2]).count();
        let fits = walls.iter().filter(|wall| wall.juts == [false; 2]).count();
        assert_eq!((juts, fits), (8, 4));
    }
}
