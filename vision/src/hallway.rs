//! Hallways: two parallel walls on opposite sides of the robot, and floor ahead and behind. Section 3,
//! Figure 7.

use std::ops::RangeInclusive;

use toposlam_model::driving::scene::{HallwayStatus, HallwayView, Unclear, undirected};

use crate::{
    agreement::{DOOR_WIDTH, OutlineAgreement},
    bearing::{BEARINGS, bearing, direction},
    boundary::Boundary,
    geometry::angle,
    outline::{Outline, Square},
    wall::{Axis, WallFrame, WallSegment},
};

/// Half the width of a hallway, from the least to the greatest. Geometry: in less the robot cannot turn, and the walls
/// of a wider one are too far away to be seen.
pub(crate) const HALF_WIDTH: RangeInclusive<f64> = 0.45..=1.2;
/// The walls must be closed this far ahead and behind, less half the width. Views: nearer to a turning point they are
/// open at a side.
const CLOSED: f64 = 1.4;
/// The least length of wall that must be closed, ahead and behind. Geometry: somewhat more than the robot's length.
const MIN_CLOSED: f64 = 0.5;
/// Segments whose offsets differ by less are one wall. Views.
const SAME_WALL: f64 = 0.10;
/// The most walls to consider on each side. Views.
const MAX_WALLS: usize = 3;
/// The floor must be seen to go on this far ahead, plus half the width. Views.
const FLOOR_AHEAD: f64 = 0.75;
/// If it is not, a wall at a side must go on this far ahead, plus half the width. Views.
const WALL_AHEAD: f64 = 0.65;
/// The least length of a major cluster. Views.
const MAJOR_LENGTH: f64 = 0.25;
/// A major cluster begins at most this far from the robot, along the hallway. Views.
const MAJOR_DISTANCE: f64 = 0.9;
/// The least trust in a hallway. Views.
const MIN_TRUST: f64 = 0.68;
/// With this trust no junction is searched for. Views: a door of the floor's colour looks like an opening.
const SURE_TRUST: f64 = 0.85;
/// The least part of its walls that must be seen. Views.
const MIN_COVER: f64 = 0.20;
/// The floor ahead is searched for on this many bearings to either side. Geometry: 12 degrees.
const SECTOR: usize = 24;
/// Other clusters nearer than this, along the hallway, count neither as ahead nor as behind. Views.
const ABREAST: f64 = 0.3;
/// A segment farther from the wall planes than this belongs to another cluster. Views.
const OFF_WALL: f64 = 0.15;
/// The sizes of the major clusters differ if one is less than this part of the other. Views.
const SIZE_RATIO: f64 = 0.5;

#[derive(Clone, Debug, PartialEq)]
pub struct FittedHallway {
    pub frame: WallFrame,
    pub axis: Axis,
    /// Its centre line and half its width, between the edges that are seen.
    pub square: Square,
    pub status: HallwayStatus,
    pub agreement: OutlineAgreement,
}

/// The hallway that the robot is in, if any.
// paper: sense.hallway.two-clusters, sense.hallway.major
pub fn hallway(
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
) -> Option<FittedHallway> {
    let pairs = [Axis::X, Axis::Y].into_iter().flat_map(|axis| {
        let [lefts, rights] = [1.0, -1.0].map(|side| majors(axis, side, walls));
        lefts.into_iter().flat_map(move |left| {
            rights.clone().into_iter().map(move |right| (axis, [left, right]))
        })
    });
    pairs
        .filter_map(|(axis, offsets)| between(axis, offsets, walls, boundary, frame))
        .max_by(|one, other| one.agreement.balance().total_cmp(&other.agreement.balance()))
}

/// The hallway between walls with these offsets, on the left and on the right.
fn between(
    axis: Axis,
    [left, right]: [f64; 2],
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
) -> Option<FittedHallway> {
    let mut square =
        Square { middle: axis.point(0.0, f64::midpoint(left, right)), half: (left - right) / 2.0 };
    if !HALF_WIDTH.contains(&square.half) {
        return None;
    }
    let reach = (CLOSED - square.half).max(MIN_CLOSED);
    let mut frame = *frame;
    for _ in 0..2 {
        let outline = Outline::hallway(axis, square, -reach - 0.3, reach + 0.3);
        (square, frame) = outline.fitted(square, boundary, &frame);
        square.middle[axis.split().0] = 0.0;
    }
    let outline = Outline::hallway(axis, square, -reach, reach);
    let agreement = outline.agreement(boundary, &frame, 1);
    let goes_on =
        [1.0, -1.0].iter().all(|&sign| goes_on(axis, sign, square, walls, boundary, &frame));
    let likely = agreement.holds(MIN_TRUST) && agreement.cover() >= MIN_COVER;
    let found = (likely && goes_on).then(|| FittedHallway {
        frame,
        axis,
        square,
        status: status(axis, frame.ahead(axis), square, walls),
        agreement,
    });
    found.filter(FittedHallway::has_robot)
}

/// The offsets of the nearest walls on one side of the robot. The first is that of the major cluster,
/// unless it is the reflection of a lamp.
// paper: sense.opposite, sense.parallel
fn majors(axis: Axis, side: f64, walls: &[WallSegment]) -> Vec<f64> {
    let beside = walls.iter().filter(|wall| {
        wall.along == axis
            && side * wall.offset > 0.0
            && wall.length() >= MAJOR_LENGTH
            && wall.from < MAJOR_DISTANCE
            && wall.to > -MAJOR_DISTANCE
    });
    let mut offsets: Vec<f64> = beside.map(|wall| wall.offset).collect();
    offsets.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
    offsets.dedup_by(|next, kept| (*next - *kept).abs() < SAME_WALL);
    offsets.truncate(MAX_WALLS);
    offsets
}

/// Whether the floor goes on, ahead or behind, so that no turning point is near.
fn goes_on(
    axis: Axis,
    sign: f64,
    square: Square,
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
) -> bool {
    let (along, across) = axis.split();
    let whither = frame.robot_from_walls() * axis.point(sign, 0.0);
    let least = square.half + FLOOR_AHEAD;
    let first = bearing(angle(whither.coords)) + BEARINGS - SECTOR;
    let ahead = sign * frame.ahead(axis) > 0.0;
    let (mut far, mut near) = (0, 0);
    for bearing in (first..=first + 2 * SECTOR).map(|bearing| bearing % BEARINGS) {
        let sight = boundary.sights[bearing];
        let forwards = sign * (frame.walls_from_robot() * direction(bearing))[along];
        match sight.sure() {
            Some(wall) if wall * forwards < least => near += 1,
            None if sight.floor * forwards < least => {}
            _ => far += 1,
        }
    }
    let reaches = |wall: &WallSegment| {
        let off = ((wall.offset - square.middle[across]).abs() - square.half).abs();
        let least = square.half + WALL_AHEAD;
        let far = if sign > 0.0 { wall.to > least } else { wall.from < -least };
        wall.along == axis && off < OFF_WALL && far
    };
    // Behind the robot it may be dark; the robot came from there.
    let enough = !ahead || far > SECTOR / 3 || walls.iter().any(reaches);
    let closed = near > SECTOR / 2 && near > far;
    enough && !closed && !is_closed(axis, sign * least, square, walls)
}

/// Whether nearer walls close half of the hallway or more; doors in them count as wall.
fn is_closed(axis: Axis, least: f64, square: Square, walls: &[WallSegment]) -> bool {
    let centre = square.middle[axis.split().1];
    let across = walls.iter().filter(|wall| {
        wall.along != axis && wall.offset * least > 0.0 && wall.offset.abs() < least.abs()
    });
    let mut pieces: Vec<[f64; 2]> = across
        .map(|wall| [wall.from.max(centre - square.half), wall.to.min(centre + square.half)])
        .filter(|[from, to]| from < to)
        .collect();
    pieces.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut closed = 0.0;
    let mut last: Option<f64> = None;
    for [from, to] in pieces {
        let from = match last {
            Some(last) if from - last < DOOR_WIDTH * 2.0 * square.half => last,
            _ => from,
        };
        closed += (to - from).max(0.0);
        last = Some(last.map_or(to, |last| last.max(to)));
    }
    closed > square.half
}

/// Whether the hallway along an axis is clear, on the way ahead.
// paper: sense.clear.two, sense.clear.behind, sense.unclear.ahead, sense.unclear.sizes
// paper: sense.unclear.behind
pub(crate) fn status(
    axis: Axis,
    ahead: f64,
    square: Square,
    walls: &[WallSegment],
) -> HallwayStatus {
    let (_, across) = axis.split();
    let off =
        |wall: &WallSegment, side: f64| wall.offset - square.middle[across] - side * square.half;
    let side = |side: f64| {
        walls.iter().filter(move |wall| wall.along == axis && off(wall, side).abs() < OFF_WALL)
    };
    let (left, right) = (side(1.0), side(-1.0));
    let forwards = |wall: &WallSegment| {
        let parts = if wall.along == axis { [wall.from, wall.to] } else { [wall.offset; 2] };
        ahead * f64::midpoint(parts[0], parts[1])
    };
    let is_major = |wall: &WallSegment| {
        wall.along == axis && off(wall, 1.0).abs().min(off(wall, -1.0).abs()) < OFF_WALL
    };
    if walls.iter().any(|wall| !is_major(wall) && forwards(wall) > ABREAST) {
        return HallwayStatus::Unclear(Unclear::ClustersAhead);
    }
    let foremost = |wall: &WallSegment| (ahead * wall.from).max(ahead * wall.to);
    let ends = [left.clone(), right.clone()]
        .map(|side| side.map(foremost).fold(f64::NEG_INFINITY, f64::max));
    if ends.iter().any(|&end| end < 0.0) {
        return HallwayStatus::Unclear(Unclear::ClusterBehind);
    }
    let sizes = [left, right].map(|side| side.map(WallSegment::length).sum::<f64>());
    if sizes[0].min(sizes[1]) < SIZE_RATIO * sizes[0].max(sizes[1]) {
        return HallwayStatus::Unclear(Unclear::SizesDiffer);
    }
    HallwayStatus::Clear
}

impl FittedHallway {
    pub(crate) fn has_robot(&self) -> bool {
        self.square.middle[self.axis.split().1].abs() < self.square.half
    }

    /// Whether no part of its walls looks open, so that there is no need to search for a junction.
    pub fn is_sure(&self) -> bool {
        self.agreement.holds(SURE_TRUST)
    }

    /// The hallway in a scene. `margin` is the distance from the edges that are seen to the wall
    /// planes.
    // paper: sense.distances
    pub fn view(&self, margin: f64) -> HallwayView {
        let heading = undirected(self.frame.angle() + self.axis.direction());
        let (_, across) = self.axis.split();
        // Left of x is y, and left of y is the opposite of x.
        let leftwards = match self.axis {
            Axis::X => 1.0,
            Axis::Y => -self.frame.ahead(Axis::Y),
        };
        let centre = leftwards * self.square.middle[across];
        let half = self.square.half + margin;
        HallwayView {
            heading,
            left: half + centre,
            right: half - centre,
            status: self.status,
            confidence: self.agreement.confidence(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use nalgebra::Point2;

    use super::*;
    use crate::drawn_place::{self, DrawnPlace};

    const SQUARE: Square = Square { middle: Point2::new(0.0, 0.0), half: 0.8 };

    fn seen(place: &DrawnPlace) -> Option<FittedHallway> {
        let boundary = place.boundary([0.0, 0.0], 0.0);
        let (frame, walls) = drawn_place::walls(&boundary)?;
        hallway(&walls, &boundary, &frame)
    }

    fn straight(width: f64) -> DrawnPlace {
        DrawnPlace::junction([true, false, true, false], width / 2.0 + drawn_place::TAPE)
    }

    fn wall(along: Axis, offset: f64, from: f64, to: f64) -> WallSegment {
        WallSegment { along, offset, from, to, cluster: 0 }
    }

    fn clear_or_not(more: &[WallSegment], left: [f64; 2], right: [f64; 2]) -> HallwayStatus {
        let major = |offset, [from, to]: [f64; 2]| wall(Axis::X, offset, from, to);
        let walls = [&[major(0.8, left), major(-0.8, right)], more].concat();
        status(Axis::X, 1.0, SQUARE, &walls)
    }

    // paper: sense.clear.two, sense.hallway.major
    #[test]
    fn two_walls_are_clear_even_if_they_are_broken() {
        assert_eq!(clear_or_not(&[], [-2.0, 2.0], [-2.0, 2.0]), HallwayStatus::Clear);
        let broken = [wall(Axis::X, 0.82, 1.0, 2.0), wall(Axis::X, -0.78, 1.0, 2.0)];
        assert_eq!(clear_or_not(&broken, [-2.0, 0.7], [-2.0, 0.8]), HallwayStatus::Clear);
    }

    // paper: sense.clear.behind, sense.unclear.ahead
    #[test]
    fn another_cluster_counts_ahead_and_not_behind() {
        let across = |at| clear_or_not(&[wall(Axis::Y, at, -0.8, 0.8)], [-2.0, 2.0], [-2.0, 2.0]);
        assert_eq!(across(1.9), HallwayStatus::Unclear(Unclear::ClustersAhead));
        assert_eq!(across(-1.9), HallwayStatus::Clear);
    }

    // paper: sense.unclear.sizes, sense.unclear.behind
    #[test]
    fn a_hallway_whose_major_cluster_is_short_or_behind_is_unclear() {
        let sizes = HallwayStatus::Unclear(Unclear::SizesDiffer);
        assert_eq!(clear_or_not(&[], [-2.0, 2.0], [-1.0, 0.9]), sizes);
        let behind = HallwayStatus::Unclear(Unclear::ClusterBehind);
        assert_eq!(clear_or_not(&[], [-2.0, 0.5], [-2.0, -0.1]), behind);
    }

    #[test]
    fn a_wall_across_with_a_door_in_it_closes_a_hallway_and_half_of_it_does_not() {
        let left = wall(Axis::Y, 1.2, 0.5, 0.8);
        let right = wall(Axis::Y, 1.2, -0.8, -0.5);
        assert!(is_closed(Axis::X, 1.5, SQUARE, &[left, right]));
        assert!(!is_closed(Axis::X, 1.5, SQUARE, &[left]), "0.3 m of 1.6");
        assert!(!is_closed(Axis::X, 1.0, SQUARE, &[left, right]), "it is farther away");
        assert!(!is_closed(Axis::X, -1.5, SQUARE, &[left, right]), "it is ahead");
        let edges = [wall(Axis::Y, 1.2, 0.7, 0.8), wall(Axis::Y, 1.2, -0.8, -0.7)];
        assert!(!is_closed(Axis::X, 1.5, SQUARE, &edges), "no door is 1.4 of 1.6 m wide");
    }

    #[test]
    fn a_place_narrower_or_wider_than_any_hallway_is_not_one() {
        for width in [1.0, 1.6, 2.3] {
            let found = seen(&straight(width)).unwrap();
            assert!((2.0 * found.square.half - width).abs() < 0.02, "{width}: {found:?}");
        }
        for width in [0.8, 2.5] {
            assert_eq!(seen(&straight(width)), None, "{width}");
        }
    }

    #[test]
    fn in_a_wide_hallway_too_the_walls_must_be_closed_ahead_and_behind() {
        let between_openings = |wall: f64| {
            let mut place = straight(2.2);
            place.floor.extend([[-9.0, -9.0, -wall, 9.0], [wall, -9.0, 9.0, 9.0]]);
            seen(&place)
        };
        assert!(between_openings(0.6).is_some());
        assert_eq!(between_openings(0.25), None);
    }

    #[test]
    fn the_heading_of_a_hallway_across_is_the_one_nearer_to_ahead() {
        for (turned, heading, left) in [(0.1, 0.1 - FRAC_PI_2, 1.0), (-0.1, FRAC_PI_2 - 0.1, 0.6)] {
            let hallway = FittedHallway {
                frame: WallFrame::along(turned),
                axis: Axis::Y,
                square: Square { middle: [0.2, 0.0].into(), half: 0.8 },
                status: HallwayStatus::Clear,
                agreement: OutlineAgreement { support: 1, ..OutlineAgreement::default() },
            };
            let view = hallway.view(0.0);
            assert!((view.heading - heading).abs() < 1e-5, "{view:?}");
            assert!((view.left - left).abs() < 1e-9, "{view:?}");
        }
    }
}
