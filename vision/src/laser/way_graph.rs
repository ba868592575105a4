//! The graph of the skeleton: meet points and ends, and the ways between them; and which ways are arms of
//! junctions.

use std::collections::BTreeMap;

use nalgebra::Point2;

use super::{
    arm_view::{ArmView, wall_behind},
    clearances::Clearances,
    ends::{End, WayEnd},
    grid::Grid,
    params::ArmParams,
    skeleton::Skeleton,
    viewpoint::Viewpoint,
};
use crate::{
    geometry::{direction, distance},
    least_squares::median,
};

/// A meet point, or the end of a way. Lengths are in metres on the local map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WayNode {
    pub point: Point2<f64>,
    /// The distance to the nearest wall.
    pub clearance: f64,
    /// `None` at a meet point.
    pub end: Option<End>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    pub nodes: [usize; 2],
    /// Its middle line from the first node to the second, with the distance to the nearest wall.
    pub line: Vec<(Point2<f64>, f64)>,
    pub length: f64,
    /// Whether it is certain that the way is an arm, if it leads to an end: the robot was there, or it is seen far
    /// enough. Otherwise what is seen of it only suggests that it goes on.
    pub is_certain: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct WayGraph {
    pub nodes: Vec<WayNode>,
    pub ways: Vec<Way>,
}

/// Which ways from a meet point to an end count as arms of the junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CountedArms {
    /// Those that the robot drove.
    Driven,
    /// Also those that are seen well enough.
    Seen,
    /// Also those that are in doubt.
    SeenOrInDoubt,
    /// All that are not seen to end.
    NotEnded,
}

/// Whether a way from a meet point to an end is an arm, by what is known of it: the most comes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum ArmStatus {
    /// It is none: it is seen to end.
    Ended,
    /// Too little of it is seen for an arm.
    Unseen,
    /// It may be one: it is as wide as a corridor, and neither driven nor seen to end.
    InDoubt,
    /// It is one: it is seen far enough, or the robot drove it as far as it is known.
    Seen,
    /// It is one: the robot drove it for as long as makes an arm.
    Driven,
}

impl CountedArms {
    fn least(self) -> ArmStatus {
        match self {
            Self::Driven => ArmStatus::Driven,
            Self::Seen => ArmStatus::Seen,
            Self::SeenOrInDoubt => ArmStatus::InDoubt,
            Self::NotEnded => ArmStatus::Unseen,
        }
    }
}

/// What the arms of a graph are judged by.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArmJudge<'a> {
    pub map: &'a Clearances,
    pub viewpoints: &'a [Viewpoint],
    /// Where the robot was.
    pub driven: &'a [Point2<f64>],
    pub params: &'a ArmParams,
}

impl ArmJudge<'_> {
    /// The length of a middle line that the robot drove, in metres.
    fn driven(&self, line: &[(Point2<f64>, f64)]) -> f64 {
        let is_driven = |&(point, clearance): &(Point2<f64>, f64)| {
            let near = clearance.max(self.params.robot_near);
            self.driven.iter().any(|&robot| distance(point, robot) < near)
        };
        let pieces = line.windows(2).filter(|two| is_driven(&two[1]));
        pieces.map(|two| distance(two[0].0, two[1].0)).sum()
    }
}

/// The length of a line of neighbouring cells, without its steps.
fn length(line: &[(Point2<f64>, f64)]) -> f64 {
    let sparse: Vec<_> = line.iter().step_by(4).chain(line.last()).collect();
    sparse.windows(2).map(|two| distance(two[0].0, two[1].0)).sum()
}

impl WayGraph {
    pub fn new(skeleton: &Skeleton, map: &Clearances) -> Self {
        let grid = &map.grid;
        let clearance = |at: usize| f64::from(map.wall[at]).sqrt() * grid.cell;
        let on_line = |at: usize| (grid.point(at), clearance(at));
        let mut nodes = Vec::new();
        let mut node_at = BTreeMap::new();
        for at in (0..skeleton.cells.len()).filter(|&at| skeleton.cells[at]) {
            if skeleton.links(at, grid).count() != 2 {
                node_at.insert(at, nodes.len());
                let end = skeleton.ends.iter().find(|end| end.cell == at).copied();
                nodes.push(WayNode { point: grid.point(at), clearance: clearance(at), end });
            }
        }
        let mut ways = Vec::new();
        for (&start, &from) in &node_at {
            for first in skeleton.links(start, grid) {
                let (mut before, mut at) = (start, first);
                let mut line = vec![on_line(start), on_line(first)];
                while !node_at.contains_key(&at) {
                    let mut links = skeleton.links(at, grid);
                    let Some(next) = links.find(|&next| next != before) else { break };
                    line.push(on_line(next));
                    (before, at) = (at, next);
                }
                // Each way is found from both of its ends.
                if let Some(&to) = node_at.get(&at)
                    && (start, first) <= (at, before)
                {
                    let length = length(&line);
                    ways.push(Way { nodes: [from, to], line, length, is_certain: true });
                }
            }
        }
        Self { nodes, ways }
    }

    /// The indices of the ways at a node; a loop is there twice.
    pub fn at(&self, node: usize) -> Vec<usize> {
        let ends = |(index, way): (usize, &Way)| way.nodes.map(|end| (end, index));
        let all = self.ways.iter().enumerate().flat_map(ends);
        all.filter(|&(end, _)| end == node).map(|(_, index)| index).collect()
    }

    pub(super) fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.nodes.len()];
        for node in self.ways.iter().flat_map(|way| way.nodes) {
            degrees[node] += 1;
        }
        degrees
    }

    /// The graph with those arms only that count, and whether any of the others is in doubt. The shortest is
    /// removed first, because others become longer by it.
    #[must_use]
    pub(super) fn pruned(mut self, judge: &ArmJudge<'_>, counted: CountedArms) -> (Self, bool) {
        let mut degrees = self.degrees();
        while (0..self.ways.len()).any(|way| self.remove_detour(way, judge, &mut degrees)) {}
        let mut ways: Vec<usize> = (0..self.ways.len()).collect();
        // Whether arms count, by their meet point and their end. Most are the same in the next round.
        let mut known = BTreeMap::new();
        let mut any_in_doubt = false;
        loop {
            ways.truncate(self.ways.len());
            ways.iter_mut().enumerate().for_each(|(index, way)| *way = index);
            ways.sort_by(|&one, &other| self.ways[one].length.total_cmp(&self.ways[other].length));
            let shortest = ways.iter().find(|&&way| {
                let Some(arm) = self.arm(way, &degrees) else { return false };
                let status = *known.entry(arm).or_insert_with(|| self.arm_status(way, arm, judge));
                any_in_doubt |= status == ArmStatus::InDoubt;
                status < counted.least()
            });
            let Some(&shortest) = shortest else {
                if self.prune_loop(judge, &mut degrees) {
                    continue;
                }
                for way in 0..self.ways.len() {
                    let status = self.arm(way, &degrees).and_then(|arm| known.get(&arm));
                    self.ways[way].is_certain =
                        status.is_none_or(|&status| status >= ArmStatus::Seen);
                }
                return (self, any_in_doubt);
            };
            self.remove(shortest, judge, &mut degrees);
        }
    }

    /// Removes a way. Two ways that are left at one of its nodes become one.
    fn remove(&mut self, way: usize, judge: &ArmJudge<'_>, degrees: &mut [usize]) {
        for node in self.ways.swap_remove(way).nodes {
            degrees[node] -= 1;
            if degrees[node] == 2
                && let Some(joined) = self.join_at(node)
            {
                degrees[node] = 0;
                self.remove_detour(joined, judge, degrees);
            }
        }
    }

    /// If this way and another one lead around an obstacle in the middle of a corridor, removes the one that the robot drove
    /// less, or the longer one. Returns whether there was one.
    fn remove_detour(&mut self, way: usize, judge: &ArmJudge<'_>, degrees: &mut [usize]) -> bool {
        let Way { nodes: [from, to], length, .. } = self.ways[way];
        let is_around = |&other: &usize| {
            let Way { nodes, length: back, .. } = self.ways[other];
            other != way
                && from != to
                && (nodes == [from, to] || nodes == [to, from])
                && length + back < judge.params.around_obstacle
        };
        let Some(other) = (0..self.ways.len()).find(is_around) else { return false };
        let [one, two] = [way, other].map(|way| judge.driven(&self.ways[way].line));
        let by_length = || self.ways[other].length.total_cmp(&length);
        let detour = if one.total_cmp(&two).then_with(by_length).is_gt() { other } else { way };
        self.remove(detour, judge, degrees);
        true
    }

    /// Removes a way around an obstacle at the end of an alcove, which is no arm either: one that begins and ends at one
    /// meet point, and that is seen to go nowhere. The meet point becomes an end. Returns whether there was one.
    fn prune_loop(&mut self, judge: &ArmJudge<'_>, degrees: &mut [usize]) -> bool {
        let is_alcove = |way: &Way| {
            way.nodes[0] == way.nodes[1]
                && degrees[way.nodes[0]] == 3
                && way.length / 2.0 < judge.params.min_arm
                && judge.driven(&way.line) == 0.0
        };
        let Some(way) = self.ways.iter().position(is_alcove) else { return false };
        let Way { nodes: [node, _], length, .. } = self.ways.swap_remove(way);
        degrees[node] = 1;
        let cell = judge.map.grid.index(self.nodes[node].point).unwrap_or_default();
        self.nodes[node].end =
            Some(End { cell, kind: WayEnd::Closed, gap: 0.0, beyond: length / 2.0 });
        true
    }

    fn arm(&self, way: usize, degrees: &[usize]) -> Option<[usize; 2]> {
        let [one, other] = self.ways[way].nodes;
        match (degrees[one], degrees[other]) {
            (3.., 1) => Some([one, other]),
            (1, 3..) => Some([other, one]),
            _ => None,
        }
    }

    /// Whether a way from a meet point to an end is an arm, and no alcove.
    fn arm_status(&self, way: usize, [meet, leaf]: [usize; 2], judge: &ArmJudge<'_>) -> ArmStatus {
        let ArmJudge { map, viewpoints, params, .. } = *judge;
        let way = self.ways[way].clone().from_node(meet);
        let (leaf, meet) = (&self.nodes[leaf], &self.nodes[meet]);
        let Some(end) = leaf.end else { return ArmStatus::Seen };
        let known = way.length + end.beyond;
        let is_closed = end.kind == WayEnd::Closed;
        if known < meet.clearance + params.min_behind {
            return if is_closed { ArmStatus::Ended } else { ArmStatus::Unseen };
        }
        let behind = way.line.iter().position(|(point, _)| {
            distance(*point, meet.point) >= meet.clearance + params.min_behind
        });
        let behind = behind.map_or(&[][..], |behind| &way.line[behind..]);
        let (driven, length) = (judge.driven(behind), length(behind));
        if driven + meet.clearance + params.min_behind >= params.min_arm {
            return ArmStatus::Driven;
        }
        // The robot drove it as far as it is known.
        if !is_closed && driven >= params.min_possible.max(params.driven_part * length) {
            return ArmStatus::Seen;
        }
        let is_between = |(point, _): &&(Point2<f64>, f64)| {
            distance(*point, meet.point) > meet.clearance
                && distance(*point, leaf.point) > 2.0 * params.min_behind / 3.0
        };
        let widths = way.line.iter().filter(is_between).map(|&(_, clearance)| 2.0 * clearance);
        let width = median(widths).unwrap_or(2.0 * leaf.clearance);
        let ArmView { is_far, length: seen, facing_wall, walled: [less, more] } =
            ArmView::new(&way.line, (meet.point, meet.clearance), map, params.sight);
        let has_walls = less >= params.far_walls || more >= params.far_wall;
        if is_far && has_walls {
            return ArmStatus::Seen;
        }
        let is_long = known + if is_closed { leaf.clearance } else { 0.0 } >= params.min_arm;
        // A hall is wider, and so is what one sees through glass.
        if is_far && (width <= params.max_width || less >= params.far_walls)
            || is_long && width <= params.max_width
        {
            return ArmStatus::InDoubt;
        }
        if is_closed {
            return if is_long { ArmStatus::Unseen } else { ArmStatus::Ended };
        }
        // A wall faces the junction, and it is not seen that the way bends there: it has a side that no scan shows.
        let faces_wall = facing_wall >= params.facing_wall * width;
        if faces_wall && less < params.bend_wall {
            return ArmStatus::Unseen;
        }
        // As wide as a corridor; through the door of a room one sees more than its width.
        let leads_on = (params.min_width..=params.max_width).contains(&width)
            && (params.min_gap..=params.max_gap).contains(&(end.gap / width));
        // The door of a room is narrower, and behind it one sees more than its width.
        let is_door = width < params.min_width && end.gap > params.room_gap * width;
        // The edge of the field of view cuts the arm, or its mouth, where what is seen is no niche.
        let is_mouth = || {
            let behind = meet.clearance + params.min_behind;
            way.length < meet.clearance + params.mouth
                && end.gap >= width.max(params.min_width)
                && wall_behind(meet.point, direction(meet.point, leaf.point), behind, map)
                    < params.niche_wall
        };
        let may_be_cut = !is_door
            && 2.0 * leaf.clearance >= params.unseen_width
            && (end.gap >= params.unseen_gap * width || is_mouth());
        // One wall of a corridor, which leads away beside free space.
        let has_one_wall = !faces_wall
            && more >= params.one_wall
            && known.max(seen) >= meet.clearance + params.min_possible;
        let may_lead_on = width <= params.max_width && (has_one_wall || may_be_cut);
        let is_unseen = || {
            let turn = |viewpoint: &Viewpoint| viewpoint.turn_to(leaf.point, map);
            viewpoints.iter().filter_map(turn).any(|turn| turn >= params.unseen_turn)
        };
        if leads_on && known >= params.min_possible || may_lead_on && is_unseen() {
            ArmStatus::InDoubt
        } else {
            ArmStatus::Unseen
        }
    }

    /// Makes one way of two that end at a node, unless they are both ends of a loop. Returns its index.
    fn join_at(&mut self, node: usize) -> Option<usize> {
        let [one, other] = self.at(node)[..] else { return None };
        if one == other {
            return None;
        }
        let [first, second] = [one, other].map(|way| self.ways[way].clone().from_node(node));
        let mut joined = first.reversed();
        joined.line.extend(second.line.into_iter().skip(1));
        joined.nodes[1] = second.nodes[1];
        joined.length += second.length;
        self.ways[one] = joined;
        self.ways.swap_remove(other);
        Some(one)
    }
}

impl Way {
    /// The way in the direction that begins at this node of it.
    #[must_use]
    pub fn from_node(self, node: usize) -> Self {
        if self.nodes[0] == node { self } else { self.reversed() }
    }

    /// Its middle line from its first node, and the same from its second.
    pub(super) fn lines(&self) -> [Vec<(Point2<f64>, f64)>; 2] {
        let back = self.line.iter().rev().copied().collect();
        [self.line.clone(), back]
    }

    fn reversed(mut self) -> Self {
        self.nodes.reverse();
        self.line.reverse();
        self
    }
}

impl Skeleton {
    /// The cells to which a cell of the skeleton is linked. A diagonal neighbour beside a direct one is
    /// linked through it.
    fn links(&self, at: usize, grid: &Grid) -> impl Iterator<Item = usize> + use<> {
        let around = grid.neighbours(at);
        let on = around.map(|near| self.cells[near]);
        let is_link = move |&number: &usize| {
            let beside = on[(number + 1) % 8] || on[(number + 7) % 8];
            on[number] && (number % 2 == 1 || !beside)
        };
        (0..8).filter(is_link).map(move |number| around[number])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laser::{grid::Cell, params::LaserParams};

    /// A map with walls everywhere but in free rectangles: their first and last columns and rows.
    fn map(columns: usize, rows: usize, free: &[[[usize; 2]; 2]]) -> Grid {
        let is_free = |column: usize, row: usize| {
            free.iter().any(|[[left, right], [low, high]]| {
                (left..=right).contains(&&column) && (low..=high).contains(&&row)
            })
        };
        let cell = |at: usize| {
            let (column, row) = (at % columns, at / columns);
            match (is_free(column, row), column == 0 || column == columns - 1) {
                // The corridor goes on unseen.
                (_, true) => Cell::Unknown,
                (true, false) => Cell::Free,
                (false, false) => Cell::Occupied,
            }
        };
        let cells = (0..columns * rows).map(cell).collect();
        Grid { columns, cell: 0.15, origin: [0.0; 2].into(), cells }
    }

    /// The number of arms of each junction on a map, for a robot in the corridor that drove along these points.
    fn degrees(driven: &[Point2<f64>], counted: CountedArms, grid: &Grid) -> Vec<usize> {
        let robot = Point2::new(10.0, 2.4);
        let params = LaserParams::default();
        let map = Clearances::new(grid.clone());
        let skeleton = Skeleton::new(&map, robot, &params).unwrap();
        let judge = ArmJudge { map: &map, viewpoints: &[], driven, params: &params.arm };
        let ways = WayGraph::new(&skeleton, &map);
        let (graph, _) = ways.pruned(&judge, counted);
        graph.places(&params).iter().map(|place| place.arms.len()).collect()
    }

    #[test]
    fn a_way_around_a_pillar_in_an_alcove_is_no_arm_and_one_around_a_block_is() {
        // A corridor of 40 m, and an alcove of so many cells behind it, around an obstacle in its middle.
        let around = |side: usize, way: usize| {
            let (left, low) = (130 - side / 2, 34);
            let (right, high) = (left + side, low + side);
            map(
                266,
                high + 3,
                &[
                    [[1, 264], [10, 22]],
                    [[124, 136], [23, low]],
                    [[left, right], [low, low + way]],
                    [[left, right], [high - way, high]],
                    [[left, left + way], [low, high]],
                    [[right - way, right], [low, high]],
                ],
            )
        };
        // The pillar is 1.05 m wide, the block 9.15 m.
        assert!(degrees(&[], CountedArms::Seen, &around(26, 9)).is_empty());
        let block = degrees(&[], CountedArms::Seen, &around(86, 12));
        assert_eq!(block.iter().filter(|&&arms| arms == 3).count(), 2);
    }

    /// A corridor, and a way of so many cells from it whose end is unknown.
    fn with_way(rows: usize) -> Grid {
        let high = 23 + rows;
        let mut grid = map(266, high + 2, &[[[1, 264], [10, 22]], [[125, 135], [23, high]]]);
        for column in 125..=135 {
            grid.cells[high * grid.columns + column] = Cell::Unknown;
        }
        grid
    }

    #[test]
    fn a_way_that_is_not_seen_to_end_is_an_arm_if_it_was_driven_or_is_seen_far_and_else_may_be_one()
    {
        let arms = |rows: usize, driven: &[Point2<f64>]| {
            [CountedArms::Seen, CountedArms::SeenOrInDoubt]
                .map(|counted| degrees(driven, counted, &with_way(rows)))
        };
        let none = Vec::<usize>::new();
        assert_eq!(arms(70, &[]), [vec![3], vec![3]], "10.5 m are seen");
        assert_eq!(arms(40, &[]), [none.clone(), vec![3]], "6 m are seen");
        assert_eq!(arms(12, &[]), [none.clone(), none.clone()], "a niche");
        let along: Vec<_> =
            (0..10).map(|metre| Point2::new(19.6, 2.4 + f64::from(metre))).collect();
        assert_eq!(arms(40, &along), [vec![3], vec![3]], "all of it was driven");
        assert_eq!(arms(40, &along[..3]), [none.clone(), vec![3]], "the robot looked into it");
        // As beside glass, no wall is seen along the way.
        let mut glass = with_way(70);
        for row in 23..93 {
            for column in [124, 136] {
                glass.cells[row * glass.columns + column] = Cell::Unknown;
            }
        }
        assert_eq!(degrees(&[], CountedArms::Seen, &glass), none, "far, but between no walls");
        assert_eq!(degrees(&along, CountedArms::SeenOrInDoubt, &closed_way(40)), none, "a room");
    }

    /// A corridor, and a way of so many cells from it that ends.
    fn closed_way(rows: usize) -> Grid {
        let mut closed = with_way(rows);
        for column in 125..=135 {
            closed.cells[(23 + rows) * closed.columns + column] = Cell::Occupied;
        }
        closed
    }

    /// A way of 8 m of which no scan shows the wall on the left; its end is a wall if `is_faced`.
    fn half_seen_way(is_faced: bool) -> Grid {
        let mut grid = if is_faced { closed_way(53) } else { with_way(53) };
        for row in 24..76 {
            grid.cells[row * grid.columns + 124] = Cell::Unknown;
        }
        grid
    }

    #[test]
    fn a_way_up_to_a_wall_is_no_arm_though_one_of_its_sides_is_not_seen() {
        let possible = |grid: &Grid| degrees(&[], CountedArms::SeenOrInDoubt, grid);
        assert_eq!(possible(&half_seen_way(false)), [3], "its end is not seen");
        assert_eq!(possible(&half_seen_way(true)), Vec::<usize>::new());
        assert_eq!(degrees(&[], CountedArms::NotEnded, &half_seen_way(true)), [3], "it may bend");
        // Between walls it is seen to open to the left.
        let mut bend = closed_way(53);
        for row in 63..76 {
            bend.cells[row * bend.columns + 124] = Cell::Unknown;
        }
        assert_eq!(possible(&bend), [3]);
    }

    #[test]
    fn of_two_ways_around_an_obstacle_the_one_that_was_driven_is_left_or_else_the_shorter_one() {
        let node = |point: [f64; 2]| WayNode { point: point.into(), clearance: 1.0, end: None };
        let way = |nodes, points: &[[f64; 2]], length| Way {
            nodes,
            line: points.iter().map(|&point| (point.into(), 1.0)).collect(),
            length,
            is_certain: true,
        };
        let (short, long) = ([12.0, 1.0], [12.0, -2.0]);
        let (left, right) = ([10.0, 0.0], [14.0, 0.0]);
        let params = LaserParams::default();
        let map = Clearances::new(map(3, 3, &[]));
        let kept = |driven: &[Point2<f64>], is_long_first: bool| {
            let mut around = vec![way([0, 1], &[left, short, right], 4.2)];
            around.insert(usize::from(!is_long_first), way([1, 0], &[right, long, left], 5.6));
            around.push(way([2, 0], &[[0.0, 0.0], left], 10.0));
            around.push(way([1, 3], &[right, [24.0, 0.0]], 10.0));
            let nodes = [left, right, [0.0, 0.0], [24.0, 0.0]].map(node).to_vec();
            let mut graph = WayGraph { nodes, ways: around };
            let judge = ArmJudge { map: &map, viewpoints: &[], driven, params: &params.arm };
            assert!(graph.remove_detour(0, &judge, &mut graph.degrees()));
            let [way] = &graph.ways[..] else { panic!("{graph:?}") };
            [short, long].map(|point| way.line.iter().any(|at| at.0 == Point2::from(point)))
        };
        for is_long_first in [false, true] {
            assert_eq!(kept(&[], is_long_first), [true, false]);
            assert_eq!(kept(&[short.into()], is_long_first), [true, false]);
            assert_eq!(kept(&[long.into()], is_long_first), [false, true]);
        }
    }

    #[test]
    fn what_no_scan_shows_behind_a_person_in_an_arm_makes_no_junction() {
        let mut grid = map(266, 120, &[[[1, 264], [10, 22]], [[123, 137], [23, 118]]]);
        for row in 36..48 {
            for column in 129..=131 {
                grid.cells[row * grid.columns + column] = Cell::Unknown;
            }
        }
        for column in 123..=137 {
            grid.cells[118 * grid.columns + column] = Cell::Unknown;
        }
        let along: Vec<_> =
            (0..14).map(|metre| Point2::new(18.9, 2.4 + f64::from(metre))).collect();
        for driven in [&[][..], &along] {
            assert_eq!(degrees(driven, CountedArms::SeenOrInDoubt, &grid), [3], "{driven:?}");
        }
    }

    #[test]
    fn what_was_driven_is_an_arm_and_what_is_seen_to_end_is_none() {
        let facts = |driven: &[Point2<f64>], grid: &Grid| {
            [CountedArms::Driven, CountedArms::NotEnded]
                .map(|counted| degrees(driven, counted, grid))
        };
        let none = Vec::<usize>::new();
        let mut driven: Vec<_> =
            (1..80).map(|half| Point2::new(f64::from(half) / 2.0, 2.4)).collect();
        for rows in [12, 40, 70] {
            assert_eq!(facts(&driven, &with_way(rows)), [none.clone(), vec![3]], "{rows}");
        }
        for rows in [3, 4, 5, 6, 8, 40] {
            let ended = facts(&driven, &closed_way(rows));
            assert_eq!(ended, [none.clone(), none.clone()], "a niche, a room: {rows}");
        }
        driven.extend((0..12).map(|metre| Point2::new(19.6, 2.4 + f64::from(metre))));
        assert_eq!(facts(&driven, &with_way(70)), [vec![3], vec![3]], "10 m of it were driven");
        assert_eq!(facts(&driven, &with_way(40))[0], none, "no more than 6 m are known");
    }
}
