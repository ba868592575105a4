//! How a robot goes on along the ways of its local map, and where they meet near it. Points and directions are those of the
//! map.

use nalgebra::{Point2, Vector2};
use toposlam_model::driving::scene::wrapped;

use super::{
    ends::{End, WayEnd},
    grid::Cell,
    local_map::LocalMap,
    way_graph::{Way, WayNode},
};
use crate::{
    geometry::{direction, distance, unit},
    place::{Certainty, PlaceArm, SeenPlace},
};

/// The way of a robot: it begins near it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WayAhead {
    /// Its middle line.
    pub line: Vec<Point2<f64>>,
    /// What is at the end of the line.
    pub end: LineEnd,
}

/// What is at the end of the known way of a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LineEnd {
    /// A wall, so many metres farther.
    Wall(f64),
    /// The way goes on, or nothing was seen there yet.
    #[default]
    Unknown,
}

impl LineEnd {
    /// What is at the end of a way. One that was not seen to end on all sides may go on.
    fn of(node: &WayNode) -> Self {
        match node.end {
            Some(End { kind: WayEnd::Closed, .. }) => Self::Wall(node.clearance),
            Some(End { kind: WayEnd::Open | WayEnd::Unclear, .. }) | None => Self::Unknown,
        }
    }
}

/// Which way a robot takes.
#[derive(Clone, Copy, Debug)]
pub struct WayChoice {
    /// The direction in which it drives.
    pub towards: f64,
    /// The way leads at most this far to the side of it, in radians.
    pub aside: f64,
    /// The direction of a way is measured over this length, in metres.
    pub measured: f64,
}

/// Which ways meet in one opening.
#[derive(Clone, Copy, Debug)]
pub struct OpeningLimits {
    /// They meet this near to the robot, in metres.
    pub near: f64,
    /// And this near to each other, beyond the clearance of their meeting point.
    pub together: f64,
}

/// A way is followed for this length, in metres.
const FOLLOWED: f64 = 5.0;
/// A robot this far from a way can go to it, in metres: it may stand in a lobby.
const BESIDE: f64 = 3.0;
/// What a way costs that begins one metre away, in radians.
const BESIDE_COST: f64 = 0.3;
/// The direction of a way that leaves a meet point is measured over this length, in metres.
const LEAVING: f64 = 1.5;
/// A way that is seen to end nearer than this is a niche, in metres, ...
const NICHE: f64 = 3.0;
/// ... and is taken only if the others bend by this much more, in radians.
const NICHE_COST: f64 = 1.2;

/// A way does not go on by a sharper bend, in radians.
const MOST_BEND: f64 = 2.4;

impl LocalMap {
    /// The way by which a robot at a point goes on; `None` if there is none in about its direction.
    pub fn way_ahead(&self, from: Point2<f64>, choice: &WayChoice) -> Option<WayAhead> {
        let ways = (0..self.ways.ways.len()).flat_map(|way| [(way, 0), (way, 1)]);
        let cost = |&(way, end): &(usize, usize)| {
            let line = self.directed(way, end);
            let off = |&index: &usize| distance(line[index], from);
            let near = (0..line.len()).min_by(|one, other| off(one).total_cmp(&off(other)))?;
            let beside = off(&near);
            if beside > BESIDE {
                return None;
            }
            let (line, node) = self.followed(way, end, near);
            let at = along(&line, choice.measured)?;
            let is_step = distance(line[0], at) > self.cell();
            let turn = wrapped(direction(from, at) - choice.towards).abs();
            let end = LineEnd::of(&self.ways.nodes[node]);
            (is_step && turn <= choice.aside)
                .then_some((turn + BESIDE_COST * beside, WayAhead { line, end }))
        };
        let ways = ways.filter_map(|way| cost(&way));
        ways.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, way)| way)
    }

    /// The way straight on from a point, up to a limit and so far before what is there, in metres.
    pub fn straight_ahead(
        &self,
        from: Point2<f64>,
        towards: f64,
        before: f64,
        limit: f64,
    ) -> WayAhead {
        let (length, cell) = self.clearances.sight(from, towards, limit + before);
        let line = vec![from, from + (length - before).clamp(0.0, limit) * unit(towards)];
        let end = match cell {
            Cell::Occupied => LineEnd::Wall(before),
            Cell::Free | Cell::Unknown => LineEnd::Unknown,
        };
        WayAhead { line, end }
    }

    /// Whether no wall is between two points.
    pub fn is_clear_between(&self, from: Point2<f64>, to: Point2<f64>) -> bool {
        let (length, cell) = self.clearances.sight(from, direction(from, to), distance(from, to));
        cell != Cell::Occupied || length >= distance(from, to)
    }

    /// Whether a robot of this radius can stand at a point.
    pub fn has_space_at(&self, point: Point2<f64>, radius: f64) -> bool {
        let grid = &self.clearances.grid;
        grid.index(point).is_some_and(|at| self.clearance(at) >= radius)
    }

    /// Where any ways meet near a robot, and the directions in which they leave. Their number is at least three.
    pub fn opening(&self, robot: Point2<f64>, limits: OpeningLimits) -> Option<SeenPlace> {
        let ways = &self.ways;
        let meets: Vec<usize> = self.meets().collect();
        let off = |&node: &usize| distance(ways.nodes[node].point, robot);
        let nearest = meets.iter().copied().min_by(|one, other| off(one).total_cmp(&off(other)))?;
        if off(&nearest) >= limits.near {
            return None;
        }
        let WayNode { point, clearance, .. } = ways.nodes[nearest];
        // Corridors that cross at an angle meet in several points.
        let is_of_group =
            |&node: &usize| distance(ways.nodes[node].point, point) < clearance + limits.together;
        let group: Vec<usize> = meets.into_iter().filter(is_of_group).collect();
        let points = || group.iter().map(|&node| ways.nodes[node].point);
        let sum = points().map(|point| point.coords).sum::<Vector2<f64>>();
        let centre = Point2::from(sum / group.len() as f64);
        let spread = points().map(|point| distance(point, centre)).fold(0.0, f64::max);
        let is_outside =
            |point: &Point2<f64>| distance(*point, centre) >= spread + clearance + limits.together;
        let mut arms: Vec<PlaceArm> = Vec::new();
        for way in &ways.ways {
            for node in way.nodes.into_iter().filter(|node| group.contains(node)) {
                let line = way.clone().from_node(node).line;
                let outside = line.iter().map(|(point, _)| *point).find(is_outside);
                let is_inner = way.nodes.iter().all(|node| group.contains(node));
                let end = line.last().map(|(point, _)| *point).filter(|_| !is_inner);
                arms.extend(outside.or(end).map(|point| PlaceArm {
                    direction: direction(centre, point),
                    certainty: Certainty::Possible,
                }));
            }
        }
        (arms.len() >= 3).then_some(SeenPlace { centre, clearance, arms })
    }

    /// Whether ways meet this near to a point, in metres.
    pub fn meets_near(&self, point: Point2<f64>, within: f64) -> bool {
        self.meets().any(|node| distance(self.ways.nodes[node].point, point) < within)
    }

    /// The nodes where at least three ways meet.
    fn meets(&self) -> impl Iterator<Item = usize> + '_ {
        let degrees = self.ways.degrees();
        (0..degrees.len()).filter(move |&node| degrees[node] >= 3)
    }

    fn cell(&self) -> f64 {
        self.clearances.grid.cell
    }

    fn clearance(&self, at: usize) -> f64 {
        f64::from(self.clearances.wall[at]).sqrt() * self.cell()
    }

    /// The middle line of a way from one of its ends to the other.
    fn directed(&self, way: usize, end: usize) -> Vec<Point2<f64>> {
        let line = self.ways.ways[way].line.iter().map(|(point, _)| *point);
        if end == 0 { line.collect() } else { line.rev().collect() }
    }

    /// The line of a way from one of its points on, and of those that go on from it as straight as possible; and the node at
    /// its end.
    fn followed(&self, way: usize, end: usize, from: usize) -> (Vec<Point2<f64>>, usize) {
        let graph = &self.ways;
        let mut line = self.directed(way, end).split_off(from);
        let (mut last, mut node) = (way, graph.ways[way].nodes[1 - end]);
        while length(&line) < FOLLOWED {
            let point = graph.nodes[node].point;
            let before = line.iter().rev().find(|before| distance(**before, point) > LEAVING / 2.0);
            let Some(&before) = before.or(line.first()) else { break };
            let ahead = direction(before, point);
            let bend = |&way: &usize| {
                let Way { nodes, length: known, .. } = &graph.ways[way];
                let begin = usize::from(nodes[0] != node);
                let out = along(&self.directed(way, begin), LEAVING).unwrap_or(point);
                let other = &graph.nodes[nodes[1 - begin]];
                let is_niche =
                    *known < NICHE && other.end.is_some_and(|end| end.kind == WayEnd::Closed);
                wrapped(direction(point, out) - ahead).abs()
                    + if is_niche { NICHE_COST } else { 0.0 }
            };
            let others = graph.at(node).into_iter().filter(|&other| other != last);
            let next = others.min_by(|one, other| bend(one).total_cmp(&bend(other)));
            let Some(next) = next.filter(|next| bend(next) < MOST_BEND + NICHE_COST) else { break };
            let begin = usize::from(graph.ways[next].nodes[0] != node);
            line.extend(self.directed(next, begin).into_iter().skip(1));
            (last, node) = (next, graph.ways[next].nodes[1 - begin]);
        }
        (line, node)
    }
}

/// The length of a line of neighbouring cells, in metres.
fn length(line: &[Point2<f64>]) -> f64 {
    line.windows(2).map(|two| distance(two[0], two[1])).sum()
}

/// The point of a line after a length, in metres, or its end; `None` if it has no point.
pub fn along(line: &[Point2<f64>], length: f64) -> Option<Point2<f64>> {
    let mut left = length;
    for two in line.windows(2) {
        let piece = distance(two[0], two[1]);
        if piece >= left {
            let ahead = unit(direction(two[0], two[1]));
            return Some(two[0] + left * ahead);
        }
        left -= piece;
    }
    line.last().copied()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::laser::{
        clearances::Clearances,
        grid::{Cell, Grid},
        params::LaserParams,
        skeleton::Skeleton,
        way_graph::WayGraph,
    };

    /// A corridor from west to east, 40 m long and 2 m wide, whose middle is 2.5 m north; a way to the north that leaves it
    /// 20 m east, and a niche of 2 m that does 10 m east. Both corridors go on unseen.
    fn map(robot: Point2<f64>) -> LocalMap {
        const CELL: f64 = 0.125;
        let (columns, rows) = (322, 202);
        let is_within = |[x, y]: [f64; 2], [west, east]: [f64; 2], [south, north]: [f64; 2]| {
            (west..east).contains(&x) && (south..north).contains(&y)
        };
        let cell = |at: usize| {
            let (column, row) = (at % columns, at / columns);
            let point = [column, row].map(|at| (at as f64 + 0.5) * CELL);
            let is_free = is_within(point, [0.0, 40.25], [1.5, 3.5])
                || is_within(point, [19.0, 21.0], [3.5, 25.25])
                || is_within(point, [9.2, 10.8], [3.5, 5.5]);
            let is_border = column == 0 || column == columns - 1 || row == rows - 1;
            match (is_free, is_border) {
                (true, true) => Cell::Unknown,
                (true, false) => Cell::Free,
                (false, _) => Cell::Occupied,
            }
        };
        let cells = (0..columns * rows).map(cell).collect();
        let grid = Grid { columns, cell: CELL, origin: Point2::origin(), cells };
        let clearances = Clearances::new(grid);
        let skeleton = Skeleton::new(&clearances, robot, &LaserParams::default()).unwrap();
        let ways = WayGraph::new(&skeleton, &clearances);
        LocalMap { clearances, skeleton: Some(skeleton), graph: ways.clone(), ways }
    }

    /// Where a robot that drives in a direction is after 4 m.
    fn goes_to(from: Point2<f64>, towards: f64) -> Option<Point2<f64>> {
        let choice = WayChoice { towards, aside: 0.6, measured: 2.5 };
        along(&map(from).way_ahead(from, &choice)?.line, 4.0)
    }

    #[test]
    fn a_robot_goes_on_along_the_middle_of_its_corridor() {
        let from = Point2::new(14.0, 2.2);
        for (towards, to) in [(0.0, [18.0, 2.5]), (0.4, [18.0, 2.5]), (PI, [10.0, 2.5])] {
            let ahead = goes_to(from, towards).unwrap();
            assert!(distance(ahead, to) < 0.5, "{towards}: {ahead}");
        }
        assert_eq!(goes_to(from, FRAC_PI_2), None, "there is a wall");
    }

    #[test]
    fn a_robot_leaves_a_junction_by_the_way_in_its_direction_and_passes_a_niche() {
        let at = Point2::new(20.0, 2.5);
        for (towards, to) in [(FRAC_PI_2, [20.0, 6.5]), (0.0, [24.0, 2.5]), (PI, [16.0, 2.5])] {
            let ahead = goes_to(at, towards).unwrap();
            assert!(distance(ahead, to) < 0.5, "{towards}: {ahead}");
        }
        let beside_niche = goes_to(Point2::new(8.5, 2.5), 0.0).unwrap();
        assert!(distance(beside_niche, [12.5, 2.5]) < 0.5, "{beside_niche}");
    }

    #[test]
    fn ways_that_meet_near_the_robot_are_an_opening_with_their_directions() {
        let robot = Point2::new(19.5, 2.4);
        let map = map(robot);
        let limits = |near| OpeningLimits { near, together: 0.6 };
        let opening = map.opening(robot, limits(1.5)).unwrap();
        assert!(distance(opening.centre, [20.0, 2.6]) < 0.4, "{opening:?}");
        for arm in [0.0, FRAC_PI_2, PI] {
            let is_seen = |seen: f64| wrapped(seen - arm).abs() < 0.2;
            assert_eq!(opening.directions().filter(|seen| is_seen(*seen)).count(), 1, "{arm}");
        }
        assert_eq!(map.opening(Point2::new(30.0, 2.5), limits(1.5)), None);
        assert!(map.meets_near(robot, 1.5) && !map.meets_near([30.0, 2.5].into(), 1.5));
        assert!(
            map.has_space_at([30.0, 2.5].into(), 0.9) && !map.has_space_at([30.0, 3.3].into(), 0.9)
        );
    }

    #[test]
    fn a_wall_is_between_two_points_on_both_sides_of_a_corner() {
        let map = map(Point2::new(14.0, 2.5));
        let clear = |from: [f64; 2], to: [f64; 2]| map.is_clear_between(from.into(), to.into());
        assert!(clear([14.0, 2.5], [20.0, 2.5]) && clear([20.0, 2.5], [20.0, 20.0]));
        assert!(clear([18.5, 2.0], [20.0, 4.5]) && !clear([17.5, 3.0], [20.0, 6.5]));
        assert!(!clear([20.0, 20.0], [30.0, 2.5]));
        assert!(clear([30.0, 2.5], [60.0, 2.5]), "nothing is known there");
    }

    #[test]
    fn only_a_way_that_was_seen_to_end_on_all_sides_ends_at_a_wall() {
        let of = |kind: Option<WayEnd>| {
            let end = kind.map(|kind| End { cell: 0, kind, gap: 1.0, beyond: 0.0 });
            LineEnd::of(&WayNode { point: Point2::origin(), clearance: 0.9, end })
        };
        assert_eq!(of(Some(WayEnd::Closed)), LineEnd::Wall(0.9));
        for kind in [Some(WayEnd::Open), Some(WayEnd::Unclear), None] {
            assert_eq!(of(kind), LineEnd::Unknown, "{kind:?}");
        }
    }

    #[test]
    fn the_end_of_a_way_is_a_wall_if_one_is_seen_there() {
        let at = Point2::new(10.0, 2.5);
        let map = map(at);
        let ahead = |towards| map.straight_ahead(at, towards, 0.4, 5.0);
        let into_niche = ahead(FRAC_PI_2);
        assert_eq!(into_niche.end, LineEnd::Wall(0.4));
        assert!(distance(into_niche.line[1], [10.0, 5.1]) < 0.3, "{into_niche:?}");
        assert_eq!(ahead(PI).end, LineEnd::Unknown, "the corridor goes on");
        let choice = WayChoice { towards: FRAC_PI_2, aside: 0.6, measured: 1.5 };
        let way = map.way_ahead(at, &choice).map(|way| way.end);
        assert!(matches!(way, None | Some(LineEnd::Wall(_))), "{way:?}");
    }
}
