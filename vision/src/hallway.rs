//! Hallways: two parallel walls on opposite sides of the robot, and floor ahead and behind. Section 3,
//! Figure 7.

use toposlam_model::driving::scene::{HallwayStatus, HallwayView, Unclear, undirected};

use crate::{
    agreement::OutlineAgreement,
    boundary::{BEARINGS, Boundary, bearing, direction},
    geometry::angle,
    outline::{Outline, Square},
    params::{HallwayParams, OutlineParams, SensingParams},
    wall::{Axis, WallFrame, WallSegment},
};

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
// paper: sense.hallway.two-clusters
// paper: sense.hallway.major
pub fn hallway(
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
    params: &SensingParams,
) -> Option<FittedHallway> {
    let pairs = [Axis::X, Axis::Y].into_iter().flat_map(|axis| {
        let [lefts, rights] = [1.0, -1.0].map(|side| majors(axis, side, walls, &params.hallway));
        lefts.into_iter().flat_map(move |left| {
            rights.clone().into_iter().map(move |right| (axis, [left, right]))
        })
    });
    pairs
        .filter_map(|(axis, offsets)| between(axis, offsets, walls, boundary, frame, params))
        .max_by(|one, other| one.balance(params).total_cmp(&other.balance(params)))
}

/// The hallway between walls with these offsets, on the left and on the right.
fn between(
    axis: Axis,
    [left, right]: [f64; 2],
    walls: &[WallSegment],
    boundary: &Boundary,
    frame: &WallFrame,
    params: &SensingParams,
) -> Option<FittedHallway> {
    let mut square =
        Square { middle: axis.point(0.0, f64::midpoint(left, right)), half: (left - right) / 2.0 };
    if !params.hallway.has_width(square.half) {
        return None;
    }
    let reach = (params.hallway.closed - square.half).max(params.hallway.min_closed);
    let mut frame = *frame;
    for _ in 0..2 {
        let outline = Outline::hallway(axis, square, -reach - 0.3, reach + 0.3);
        (square, frame) = outline.fitted(square, boundary, &frame, &params.outline);
        square.middle[axis.split().0] = 0.0;
    }
    let outline = Outline::hallway(axis, square, -reach, reach);
    let agreement = outline.agreement(boundary, &frame, 1, &params.outline);
    let goes_on = goes_on(axis, 1.0, square, walls, boundary, &frame, params)
        && goes_on(axis, -1.0, square, walls, boundary, &frame, params);
    let likely = agreement.holds(params.hallway.min_trust, &params.outline)
        && agreement.cover(&params.outline) >= params.hallway.min_cover;
    let found = (likely && goes_on).then(|| FittedHallway {
        frame,
        axis,
        square,
        status: status(axis, frame.ahead(axis), square, walls, &params.hallway),
        agreement,
    });
    found.filter(FittedHallway::has_robot)
}

/// The offsets of the nearest walls on one side of the robot. The first is that of the major cluster,
/// unless it is the reflection of a lamp.
// paper: sense.opposite
// paper: sense.parallel
fn majors(axis: Axis, side: f64, walls: &[WallSegment], params: &HallwayParams) -> Vec<f64> {
    let beside = walls.iter().filter(|wall| {
        wall.along == axis
            && side * wall.offset > 0.0
            && wall.length() >= params.major_length
            && wall.from < params.major_distance
            && wall.to > -params.major_distance
    });
    let mut offsets: Vec<f64> = beside.map(|wall| wall.offset).collect();
    offsets.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
    offsets.dedup_by(|next, kept| (*next - *kept).abs() < params.same_wall);
    offsets.truncate(params.max_walls);
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
    params: &SensingParams,
) -> bool {
    let HallwayParams { sector, floor_ahead, wall_ahead, off_wall, .. } = params.hallway;
    let (along, across) = axis.split();
    let whither = frame.robot_from_walls() * axis.point(sign, 0.0);
    let least = square.half + floor_ahead;
    let first = bearing(angle(whither.coords)) + BEARINGS - sector;
    let ahead = sign * frame.ahead(axis) > 0.0;
    let (mut far, mut near) = (0, 0);
    for bearing in (first..=first + 2 * sector).map(|bearing| bearing % BEARINGS) {
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
        let least = square.half + wall_ahead;
        let far = if sign > 0.0 { wall.to > least } else { wall.from < -least };
        wall.along == axis && off < off_wall && far
    };
    // Behind the robot it may be dark; the robot came from there.
    let enough = !ahead || far > sector / 3 || walls.iter().any(reaches);
    let closed = near > sector / 2 && near > far;
    enough && !closed && !is_closed(axis, sign * least, square, walls, params.outline.door_width)
}

/// Whether nearer walls close half of the hallway or more; doors in them count as wall.
fn is_closed(
    axis: Axis,
    least: f64,
    square: Square,
    walls: &[WallSegment],
    door_width: f64,
) -> bool {
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
            Some(last) if from - last < door_width * 2.0 * square.half => last,
            _ => from,
        };
        closed += (to - from).max(0.0);
        last = Some(last.map_or(to, |last| last.max(to)));
    }
    closed > square.half
}

/// Whether the hallway along an axis is clear, on the way ahead.
// paper: sense.clear.two
// paper: sense.clear.behind
// paper: sense.unclear.ahead
// paper: sense.unclear.sizes
// paper: sense.unclear.behind
pub(crate) fn status(
    axis: Axis,
    ahead: f64,
    square: Square,
    walls: &[WallSegment],
    params: &HallwayParams,
) -> HallwayStatus {
    let (_, across) = axis.split();
    let off =
        |wall: &WallSegment, side: f64| wall.offset - square.middle[across] - side * square.half;
    let side = |side: f64| {
        walls
            .iter()
            .filter(move |wall| wall.along == axis && off(wall, side).abs() < params.off_wall)
    };
    let (left, right) = (side(1.0), side(-1.0));
    let forwards = |wall: &WallSegment| {
        let parts = if wall.along == axis { [wall.from, wall.to] } else { [wall.offset; 2] };
        ahead * f64::midpoint(parts[0], parts[1])
    };
    let is_major = |wall: &WallSegment| {
        wall.along == axis && off(wall, 1.0).abs().min(off(wall, -1.0).abs()) < params.off_wall
    };
    if walls.iter().any(|wall| !is_major(wall) && forwards(wall) > params.abreast) {
        return HallwayStatus::Unclear(Unclear::ClustersAhead);
    }
    let foremost = |wall: &WallSegment| (ahead * wall.from).max(ahead * wall.to);
    let ends = [left.clone(), right.clone()]
        .map(|side| side.map(foremost).fold(f64::NEG_INFINITY, f64::max));
    if ends.iter().any(|&end| end < 0.0) {
        return HallwayStatus::Unclear(Unclear::ClusterBehind);
    }
    let sizes = [left, right].map(|side| side.map(WallSegment::length).sum::<f64>());
    if sizes[0].min(sizes[1]) < params.size_ratio * sizes[0].max(sizes[1]) {
        return HallwayStatus::Unclear(Unclear::SizesDiffer);
    }
    HallwayStatus::Clear
}

impl FittedHallway {
    pub(crate) fn has_robot(&self) -> bool {
        self.square.middle[self.axis.split().1].abs() < self.square.half
    }

    /// Whether no part of its walls looks open, so that there is no need to search for a junction.
    pub fn is_sure(&self, params: &SensingParams) -> bool {
        self.agreement.holds(params.hallway.sure_trust, &params.outline)
    }

    fn balance(&self, params: &SensingParams) -> f64 {
        self.agreement.balance(&params.outline)
    }

    /// The hallway in a scene. `margin` is the distance from the edges that are seen to the wall
    /// planes.
    // paper: sense.distances
    pub fn view(&self, margin: f64, params: &OutlineParams) -> HallwayView {
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
            confidence: self.agreement.confidence(params),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use nalgebra::Point2;

    use super::*;
    use crate::{
        cluster::clusters,
        drawn_place::{self, DrawnPlace},
        line::lines,
    };

    const DOOR_WIDTH: f64 = 0.75;
    const SQUARE: Square = Square { middle: Point2::new(0.0, 0.0), half: 0.8 };

    fn seen(place: &DrawnPlace) -> Option<FittedHallway> {
        let boundary = drawn_place::bearings().look(&place.seen_from([0.0, 0.0], 0.0));
        let params = SensingParams::default();
        let lines = lines(&clusters(&boundary, &params.cluster), &params.line);
        let frame = WallFrame::of(&lines, &params.wall)?;
        hallway(&frame.walls(&lines, &params.wall), &boundary, &frame, &params)
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
        status(Axis::X, 1.0, SQUARE, &walls, &HallwayParams::default())
    }

    // paper: sense.clear.two
    // paper: sense.hallway.major
    #[test]
    fn two_walls_are_clear_even_if_they_are_broken() {
        assert_eq!(clear_or_not(&[], [-2.0, 2.0], [-2.0, 2.0]), HallwayStatus::Clear);
        let broken = [wall(Axis::X, 0.82, 1.0, 2.0), wall(Axis::X, -0.78, 1.0, 2.0)];
        assert_eq!(clear_or_not(&broken, [-2.0, 0.7], [-2.0, 0.8]), HallwayStatus::Clear);
    }

    // paper: sense.clear.behind
    // paper: sense.unclear.ahead
    #[test]
    fn another_cluster_counts_ahead_and_not_behind() {
        let across = |at| clear_or_not(&[wall(Axis::Y, at, -0.8, 0.8)], [-2.0, 2.0], [-2.0, 2.0]);
        assert_eq!(across(1.9), HallwayStatus::Unclear(Unclear::ClustersAhead));
        assert_eq!(across(-1.9), HallwayStatus::Clear);
    }

    // paper: sense.unclear.sizes
    // paper: sense.unclear.behind
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
        assert!(is_closed(Axis::X, 1.5, SQUARE, &[left, right], DOOR_WIDTH));
        assert!(!is_closed(Axis::X, 1.5, SQUARE, &[left], DOOR_WIDTH), "0.3 m of 1.6");
        assert!(!is_closed(Axis::X, 1.0, SQUARE, &[left, right], DOOR_WIDTH), "it is farther away");
        assert!(!is_closed(Axis::X, -1.5, SQUARE, &[left, right], DOOR_WIDTH), "it is ahead");
        let edges = [wall(Axis::Y, 1.2, 0.7, 0.8), wall(Axis::Y, 1.2, -0.8, -0.7)];
        assert!(
            !is_closed(Axis::X, 1.5, SQUARE, &edges, DOOR_WIDTH),
            "no door is 1.4 of 1.6 m wide"
        );
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
            let view = hallway.view(0.0, &OutlineParams::default());
            assert!((view.heading - heading).abs() < 1e-5, "{view:?}");
            assert!((view.left - left).abs() < 1e-9, "{view:?}");
        }
    }
}
