//! The graph of the skeleton: meet points and ends, and the ways between them; and which ways are arms of
//! junctions.

use std::collections::BTreeMap;

use nalgebra::Point2;

use super::{
    arm_view::ArmView,
    clearances::Clearances,
    ends::{End, WayEnd},
    grid::{Cell, Grid},
    params::ArmParams,
    skeleton::Skeleton,
    viewpoint::{Look, Viewpoint},
};
use crate::{geometry::distance, least_squares::median};

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
    /// Those that are seen well enough.
    Seen,
    /// Also those that are in doubt.
    SeenOrInDoubt,
}

/// Whether a way from a meet point to an end is an arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ArmStatus {
    /// It is an arm: it is seen far enough, or the robot is there.
    Certain,
    /// It may be one: the scanner did not look into it, or it is seen to end but for a stretch of its border.
    InDoubt,
    /// It is an alcove, or too little of it is seen.
    None,
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

/// A stretch of border to the unknown at which this number of scans looked is a surface. One ray alone may fail.
const LOOKS: usize = 2;

/// The border to the unknown near the end of a way, without the stretches at which scans looked: there must be surfaces
/// of glass, or black ones, or walls along which the rays go.
#[derive(Clone, Copy, Debug, Default)]
struct UnseenBorder {
    /// The length of what no scan could see, because it lies around a corner, in metres.
    hidden: f64,
    /// The length of what lay beyond the field of view of the scans, in metres.
    aside: f64,
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

    fn unseen_border(&self, end: Point2<f64>) -> UnseenBorder {
        let (grid, params) = (&self.map.grid, self.params);
        let is_border = |&at: &usize| self.map.is_unknown_border(at);
        let mut unseen = UnseenBorder::default();
        for at in grid.cells_near(end, params.border_near).filter(is_border) {
            let direct = grid.neighbours(at).into_iter().skip(1).step_by(2);
            let unknown = direct.filter(|&next| grid.cells[next] == Cell::Unknown);
            let looks: Vec<Look> = unknown.map(|next| self.look(grid.point(next))).collect();
            if looks.contains(&Look::At) {
                continue;
            }
            let is_hidden = looks.contains(&Look::Hidden);
            *(if is_hidden { &mut unseen.hidden } else { &mut unseen.aside }) += grid.cell;
        }
        unseen
    }

    fn look(&self, point: Point2<f64>) -> Look {
        let (mut at, mut aside) = (0, false);
        for viewpoint in self.viewpoints {
            match viewpoint.look(point, self.map) {
                Look::At => at += 1,
                Look::Aside => aside = true,
                Look::Hidden => {}
            }
            if at == LOOKS {
                return Look::At;
            }
        }
        if aside { Look::Aside } else { Look::Hidden }
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
        let mut ways: Vec<usize> = (0..self.ways.len()).collect();
        let mut degrees = self.degrees();
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
                let is_counted = counted == CountedArms::SeenOrInDoubt;
                status == ArmStatus::None || status == ArmStatus::InDoubt && !is_counted
            });
            let Some(&shortest) = shortest else {
                if self.prune_loop(judge, &mut degrees) {
                    continue;
                }
                for way in 0..self.ways.len() {
                    let status = self.arm(way, &degrees).and_then(|arm| known.get(&arm));
                    self.ways[way].is_certain =
                        status.is_none_or(|&status| status == ArmStatus::Certain);
                }
                return (self, any_in_doubt);
            };
            for node in self.ways.swap_remove(shortest).nodes {
                degrees[node] -= 1;
                if degrees[node] == 2 && self.join_at(node) {
                    degrees[node] = 0;
                }
            }
        }
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
        let Some(end) = leaf.end else { return ArmStatus::Certain };
        let known = way.length + end.beyond;
        if way.length < meet.clearance + params.min_behind {
            return ArmStatus::None;
        }
        let behind = way.line.iter().position(|(point, _)| {
            distance(*point, meet.point) >= meet.clearance + params.min_behind
        });
        let behind = way.line.get(behind.unwrap_or_default()..).unwrap_or_default();
        let (driven, length) = (judge.driven(behind), length(behind));
        // The robot drove it for as long as makes an arm, or as far as it is known and not seen to end.
        let is_driven = driven + meet.clearance + params.min_behind >= params.min_arm
            || end.kind != WayEnd::Closed
                && driven >= params.min_possible.max(params.driven_part * length);
        if is_driven {
            return ArmStatus::Certain;
        }
        let is_between = |(point, _): &&(Point2<f64>, f64)| {
            distance(*point, meet.point) > meet.clearance
                && distance(*point, leaf.point) > 2.0 * params.min_behind / 3.0
        };
        let widths = way.line.iter().filter(is_between).map(|&(_, clearance)| 2.0 * clearance);
        let width = median(widths.clone()).unwrap_or(2.0 * leaf.clearance);
        let widest = widths.fold(width, f64::max);
        let ArmView { is_far, depth, walled: [less, more] } =
            ArmView::new(&way.line, (meet.point, meet.clearance), map, params.sight);
        let has_walls = less >= params.far_walls || more >= params.far_wall;
        if is_far && has_walls {
            return ArmStatus::Certain;
        }
        let is_long = match end.kind {
            WayEnd::Closed => known + leaf.clearance >= params.min_arm,
            WayEnd::Open | WayEnd::Unclear => known >= params.min_arm,
        };
        // A hall is wider, and so is what one sees through glass.
        if is_far && (width <= params.max_width || less >= params.far_walls)
            || is_long && width <= params.max_width
        {
            return ArmStatus::InDoubt;
        }
        if end.kind == WayEnd::Closed {
            return ArmStatus::None;
        }
        let is_walled = more >= params.min_wall || less >= params.min_walls;
        let leads_on = width >= params.min_width
            && (params.min_gap..=params.max_gap).contains(&(end.gap / width));
        let is_arm = leads_on
            && depth >= params.min_sight
            && (is_walled || known >= params.long)
            && known >= params.min_known
            && widest <= params.max_width;
        let is_unseen = || {
            let turn = |viewpoint: &Viewpoint| viewpoint.turn_to(leaf.point, map);
            viewpoints.iter().filter_map(turn).any(|turn| turn >= params.unseen_turn)
        };
        if is_arm {
            let UnseenBorder { hidden, aside } = judge.unseen_border(leaf.point);
            // What is seen to end may go on around a corner.
            if hidden + aside >= params.border {
                return ArmStatus::InDoubt;
            }
        }
        // A way as wide as a corridor that is not seen to end.
        if leads_on && width <= params.max_width && known >= params.min_possible {
            return ArmStatus::InDoubt;
        }
        // The door of a room is narrower, and behind it one sees more than its width.
        let is_door = width < params.min_width && end.gap > params.room_gap * width;
        if width <= params.max_width
            && !is_door
            && 2.0 * leaf.clearance >= params.unseen_width
            && end.gap >= params.unseen_gap * width
            && is_unseen()
        {
            ArmStatus::InDoubt
        } else {
            ArmStatus::None
        }
    }

    /// Makes one way of two that end at a node, unless they are both ends of a loop. Returns whether it did.
    fn join_at(&mut self, node: usize) -> bool {
        let [one, other] = self.at(node)[..] else { return false };
        if one == other {
            return false;
        }
        let [first, second] = [one, other].map(|way| self.ways[way].clone().from_node(node));
        let mut joined = first.reversed();
        joined.line.extend(second.line.into_iter().skip(1));
        joined.nodes[1] = second.nodes[1];
        joined.length += second.length;
        self.ways[one] = joined;
        self.ways.swap_remove(other);
        true
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
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::driving::odometry::Odometry;

    use super::*;
    use crate::laser::{params::LaserParams, scan::Scan};

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

    /// The number of arms of each junction on a map, for a robot in the corridor.
    fn degrees(viewpoints: &[Viewpoint], counted: CountedArms, grid: &Grid) -> Vec<usize> {
        let robot = Point2::new(10.0, 2.4);
        let params = LaserParams::default();
        let map = Clearances::new(grid.clone());
        let skeleton = Skeleton::new(&map, robot, &params).unwrap();
        let judge = ArmJudge { map: &map, viewpoints, driven: &[robot], params: &params.arm };
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

    #[test]
    fn an_alcove_goes_on_around_a_corner_and_is_in_doubt_where_no_wall_was_seen() {
        // An alcove of 6.6 m. At its end 0.9 m of the wall on the right are unknown.
        let mut grid = map(266, 70, &[[[1, 264], [10, 22]], [[125, 135], [23, 66]]]);
        for row in 60..66 {
            grid.cells[row * grid.columns + 136] = Cell::Unknown;
        }
        // Two scans of half a circle at the alcove's mouth, by a robot with this heading.
        let scans = |heading| {
            let at = Odometry { position: [19.6, 3.5], heading };
            vec![Viewpoint::new(&Scan::each_degree(-90, 181, |_| 1.0), &at); LOOKS]
        };
        let seen = |viewpoints: &[Viewpoint]| {
            [CountedArms::Seen, CountedArms::SeenOrInDoubt]
                .map(|counted| degrees(viewpoints, counted, &grid))
        };
        assert_eq!(seen(&[]), [vec![], vec![3]], "no scan could see it");
        assert_eq!(seen(&scans(-FRAC_PI_2)), [vec![], vec![3]], "no scan looked there");
        assert_eq!(
            seen(&scans(FRAC_PI_2)),
            [vec![], vec![3]],
            "there is no wall that the scans saw"
        );
    }
}
