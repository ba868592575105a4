//! What is seen along an arm of a junction: how far, and beside which walls. A corridor that goes straight on is
//! seen far; through the door of a room one sees its far wall. Of a corridor that bends soon, or that was
//! seen from the side only, one sees straight walls.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Point2, Vector2};

use super::{clearances::Clearances, grid::Cell};
use crate::{
    geometry::{direction, distance, unit},
    least_squares::median,
};

/// Lines of sight begin this far behind the walls of the junction. Geometry: two cells of the local map.
const MOUTH: f64 = 0.3;
/// They are directed along the middle line of the arm, from there to this far behind the walls. Geometry: the width of
/// a corridor.
const AHEAD: f64 = 2.0;
/// The number of lines of sight to each side of this direction. Geometry: 16 degrees.
const FAN: i32 = 8;
/// The angle between two of them. Geometry: 2 degrees.
const STEP: f64 = 0.035;
/// How far to the left of the middle line they begin. Geometry: two cells.
const ASIDE: [f64; 3] = [-0.3, 0.0, 0.3];
/// Walls are looked for up to this far on a line of sight, ... Geometry: the least length of an arm.
const FAR: f64 = 10.0;
/// ... up to this far beside it, ... Geometry: more than the width of a corridor.
const BESIDE: f64 = 3.0;
/// ... and at points this far apart. Geometry: two cells.
const APART: f64 = 0.3;
/// A wall is straight where it is this near to its usual distance from the line, or from the meet point that it faces. Logs.
const STRAIGHT: f64 = 0.25;

/// Lines of sight end in one facing wall if the depths of their ends differ by less than this. Geometry: as much as those of a
/// wall as wide as a corridor that stands 16 degrees askew.
const THICK: f64 = 0.6;

/// Walls behind a mouth are looked for up to this far. Geometry: niches are less deep.
const BEHIND: f64 = 5.0;
/// A wall may face a meet point in these directions from that to the mouth, in radians. Geometry: what is seen of a niche
/// from the side lies askew.
const TURNS: [f64; 5] = [-0.52, -0.26, 0.0, 0.26, 0.52];
/// It is seen up to this far to each side, for each metre ahead. Geometry: 22 degrees.
const ASKEW: f64 = 0.4;

/// A narrower gap in a wall behind a mouth is a door. Geometry: less than the width of a corridor.
const DOOR: f64 = 1.2;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ArmView {
    /// Whether free space is seen far enough on one straight line.
    pub is_far: bool,
    /// The length of the longest straight line of free space, from the meet point on, in metres.
    pub length: f64,
    /// How wide the wall is that faces one at the far end of what is seen, in metres: 0 if free space goes on unseen there.
    pub facing_wall: f64,
    /// The parts of this line beside which there is a straight wall: on the side with less of it, and on the other one.
    pub walled: [f64; 2],
}

#[derive(Clone, Copy)]
struct Ray {
    from: Point2<f64>,
    angle: f64,
}

impl ArmView {
    /// The view along a way by its middle line, which begins at a meet point with this distance from the walls;
    /// it is far from a distance to the meet point on. All in metres.
    pub(super) fn new(
        line: &[(Point2<f64>, f64)],
        (meet, clearance): (Point2<f64>, f64),
        map: &Clearances,
        far: f64,
    ) -> Self {
        let behind = |least: f64| {
            let beyond =
                |(point, _): &&(Point2<f64>, f64)| distance(*point, meet) >= clearance + least;
            line.iter().find(beyond).or(line.last()).map(|&(point, _)| point)
        };
        let Some((mouth, towards)) = behind(MOUTH).zip(behind(AHEAD)) else {
            return Self { is_far: false, length: 0.0, facing_wall: 0.0, walled: [0.0; 2] };
        };
        let from = if distance(mouth, towards) > 0.5 { mouth } else { meet };
        let ahead = direction(from, towards);
        let left = unit(ahead + FRAC_PI_2);
        let starts = ASIDE.map(|aside| mouth + aside * left);
        let (mut longest, mut length) = (Ray { from: mouth, angle: ahead }, 0.0);
        let mut is_far = false;
        let mut ends = Vec::new();
        'fan: for number in (0..=FAN).flat_map(|number| [number, -number]) {
            let angle = ahead + STEP * f64::from(number);
            for from in starts {
                let ray = Ray { from, angle };
                let before = distance(from, meet);
                let (free, end) = map.sight(from, angle, far - before);
                let seen = ray.at(free) - mouth;
                ends.push((seen.dot(&unit(ahead)), seen.dot(&left), end));
                is_far = free + before >= far;
                if is_far || free > length {
                    (longest, length) = (ray, free);
                }
                if is_far {
                    break 'fan;
                }
            }
        }
        let mut walled = [1.0, -1.0].map(|side| longest.walled(length, side, map));
        walled.sort_by(f64::total_cmp);
        let length = length + distance(longest.from, meet);
        Self { is_far, length, facing_wall: facing_wall(&ends), walled }
    }
}

/// The width of the widest wall that faces a meet point within 30 degrees of a direction, at least so far away, in metres: that
/// of a niche. The walls of an arm lead to the meet point, and do not face it.
pub(super) fn wall_behind(meet: Point2<f64>, towards: f64, least: f64, map: &Clearances) -> f64 {
    let hit = |number: i32| {
        let angle = STEP * f64::from(number);
        let (range, cell) = map.sight(meet, towards + angle, BEHIND);
        (cell == Cell::Occupied).then_some((angle, range))
    };
    let hits: Vec<(f64, f64)> = (-3 * FAN..=3 * FAN).filter_map(hit).collect();
    let width = |turn: f64| {
        let ends = hits.iter().map(|&(angle, range)| range * unit(angle - turn));
        // The x axis leads ahead.
        let is_ahead = |end: &Vector2<f64>| end.x > least && end.y.abs() < ASKEW * end.x;
        let mut ends: Vec<Vector2<f64>> = ends.filter(is_ahead).collect();
        let usual = median(ends.iter().map(|end| end.x)).unwrap_or_default();
        ends.retain(|end| (end.x - usual).abs() < STRAIGHT);
        let walls = ends.chunk_by(|one, next| (next.y - one.y).abs() < DOOR);
        walls.map(|wall| extent(wall.iter().map(|end| end.y))).fold(0.0, f64::max)
    };
    TURNS.map(width).into_iter().fold(0.0, f64::max)
}

/// From the least of some numbers to the greatest.
fn extent(numbers: impl Iterator<Item = f64>) -> f64 {
    let (least, greatest) = numbers.fold((f64::MAX, f64::MIN), |(least, greatest), number| {
        (least.min(number), greatest.max(number))
    });
    (greatest - least).max(0.0)
}

/// The width of the wall in which lines of sight end, in metres, by how far ahead and how far to the left each one ends, and in
/// which cell; 0 if one of them ends farther ahead where nothing was seen.
fn facing_wall(ends: &[(f64, f64, Cell)]) -> f64 {
    let farthest = |kind: fn(Cell) -> bool| {
        ends.iter().filter(|end| kind(end.2)).map(|end| end.0).fold(0.0, f64::max)
    };
    let wall = farthest(|cell| cell == Cell::Occupied);
    if farthest(|cell| cell != Cell::Occupied) > wall {
        return 0.0;
    }
    let on_wall = ends.iter().filter(|end| end.2 == Cell::Occupied && end.0 > wall - THICK);
    extent(on_wall.map(|end| end.1))
}

impl Ray {
    fn at(&self, length: f64) -> Point2<f64> {
        self.from + length * unit(self.angle)
    }

    /// The part of a length of the ray beside which there is a straight wall, on the left (1) or on the
    /// right (-1).
    fn walled(&self, length: f64, side: f64, map: &Clearances) -> f64 {
        let points = ((length.min(FAR) / APART) as u32).max(1);
        let across = self.angle + side * FRAC_PI_2;
        let beside = |point: u32| {
            let from = self.at(APART * f64::from(point));
            let (off, cell) = map.sight(from, across, BESIDE);
            (cell == Cell::Occupied).then_some(off)
        };
        let walls: Vec<f64> = (0..points).filter_map(beside).collect();
        let Some(usual) = median(walls.iter().copied()) else { return 0.0 };
        let straight = walls.iter().filter(|&off| (off - usual).abs() < STRAIGHT);
        straight.count() as f64 / f64::from(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_faces_the_junction_as_far_as_the_farthest_lines_of_sight_end_in_it() {
        use Cell::{Occupied, Unknown};
        // A wall 8 m ahead, one beside the way, and the edge of what is seen.
        let mut ends = vec![(8.0, -0.5, Occupied), (7.6, 0.5, Occupied), (3.0, 1.5, Occupied)];
        assert!((facing_wall(&ends) - 1.0).abs() < 1e-9);
        ends.push((7.9, -1.0, Unknown));
        assert!((facing_wall(&ends) - 1.0).abs() < 1e-9);
        ends.push((8.1, -1.0, Unknown));
        assert_eq!(facing_wall(&ends), 0.0, "free space goes on beside it");
        assert_eq!(facing_wall(&[]), 0.0);
    }
}
