//! The graph of the skeleton: meet points, ends, and the ways between them. Pruned to the arms that count.

use super::{
    grid::{Grid, neighbours8},
    params::LaserParams,
    skeleton::{ArmEnd, Skeleton},
};

/// A node: a meet point, or an end.
#[derive(Clone, Debug)]
pub struct Node {
    /// Where it is, in the frame of odometry, in metres.
    pub point: [f64; 2],
    /// The distance to the nearest obstacle, in metres.
    pub clearance: f64,
    /// `None` at a meet point.
    pub end: Option<ArmEnd>,
    pub info: (usize,f64,f64), pub geo: f64,
}

/// A way between two nodes.
#[derive(Clone, Debug)]
pub struct Way {
    /// Its nodes.
    pub nodes: [usize; 2],
    /// The points from the first node to the second.
    pub points: Vec<[f64; 2]>,
    /// Its length, in metres.
    pub length: f64,
    pub clearances: Vec<f64>,
}

/// The graph.
#[derive(Clone, Debug, Default)]
pub struct WayGraph {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// The ways.
    pub ways: Vec<Way>,
}

fn distance([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (x - u).hypot(y - v)
}

/// The length of a line of points, a little smoothed, because a line of cells is longer.
fn length(points: &[[f64; 2]]) -> f64 {
    let sparse: Vec<_> = points.iter().step_by(4).chain(points.last()).collect();
    sparse.windows(2).map(|pair| distance(*pair[0], *pair[1])).sum()
}

impl WayGraph {
    /// The graph of a skeleton.
    pub fn of(skeleton: &Skeleton, grid: &Grid) -> Self {
        let side = grid.side;
        let cells: Vec<usize> =
            (0..skeleton.cells.len()).filter(|&at| skeleton.cells[at]).collect();
        let linked = |at: usize| {
            let around = neighbours8(at, side);
            let on = around.map(|near| skeleton.cells[near]);
            let mut linked = Vec::with_capacity(4);
            for number in 0..8 {
                // A diagonal neighbour beside a direct one is linked through it.
                let beside = on[(number + 1) % 8] || on[(number + 7) % 8];
                if on[number] && (number % 2 == 1 || !beside) {
                    linked.push(around[number]);
                }
            }
            linked
        };
        let mut node_of = std::collections::BTreeMap::new();
        let mut graph = Self::default();
        let node = |at: usize| Node {
            point: grid.point(at),
            clearance: f64::from(skeleton.clearance[at]).sqrt() * grid.cell,
            end: skeleton.ends.iter().find(|&&(end, _)| end == at).map(|&(_, end)| end),
            info: skeleton.ends.iter().position(|&(end,_)| end==at).map(|i| skeleton.info[i]).unwrap_or_default(), geo: f64::from(skeleton.geo[at])/5.0*grid.cell,
        };
        for &at in &cells {
            if linked(at).len() != 2 {
                node_of.insert(at, graph.nodes.len());
                graph.nodes.push(node(at));
            }
        }
        for (&start, &from) in &node_of {
            for first in linked(start) {
                let (mut before, mut at) = (start, first);
                let mut points = vec![grid.point(start)];
                while !node_of.contains_key(&at) {
                    points.push(grid.point(at));
                    let Some(next) = linked(at).into_iter().find(|&next| next != before) else {
                        break;
                    };
                    (before, at) = (at, next);
                }
                points.push(grid.point(at));
                let Some(&to) = node_of.get(&at) else { continue };
                // Each way is found from both ends.
                if (start, first) <= (at, before) {
                    let length = length(&points);
                    let clearances = points.iter().map(|&p| grid.index(p).map_or(0.0, |at| f64::from(skeleton.clearance[at]).sqrt() * grid.cell)).collect(); graph.ways.push(Way { nodes: [from, to], points, length, clearances });
                }
            }
        }
        graph
    }

    /// The indices of the ways at a node; a loop is there twice.
    pub fn at(&self, node: usize) -> Vec<usize> {
        let ends = |(index, way): (usize, &Way)| way.nodes.map(|end| (end, index));
        let all = self.ways.iter().enumerate().flat_map(ends);
        all.filter(|&(end, _)| end == node).map(|(_, index)| index).collect()
    }

    /// Removes the arms that do not count, the shortest first.
    pub fn prune(&mut self, robot: [f64; 2], params: &LaserParams) {
        loop {
            let short = self.ways.iter().enumerate().filter_map(|(index, way)| {
                let [one, other] = way.nodes;
                let (leaf, meet) = match (self.at(one).len(), self.at(other).len()) {
                    (1, 3..) => (one, other),
                    (3.., 1) => (other, one),
                    _ => return None,
                };
                let (leaf, meet) = (&self.nodes[leaf], &self.nodes[meet]);
                // The robot does not doubt the arm in which it is.
                let inside = distance(robot, meet.point) > meet.clearance + 0.5 && way.points.iter().any(|&point| distance(point, robot) < 0.8);
                if inside { return None; }
                let far = way.length + leaf.info.2 - leaf.geo;
                let short = match leaf.end {
                    Some(ArmEnd::Open) => way.length < meet.clearance + params.min_open_arm || far < params.min_far || far < params.min_arm && {
                        let mut along: Vec<f64> = way.points.iter().zip(&way.clearances).filter(|(p, _)| distance(**p, meet.point) > meet.clearance && distance(**p, leaf.point) > 0.3).map(|(_, &c)| c).collect();
                        along.sort_by(f64::total_cmp);
                        let half = along.get(along.len() / 2).copied().unwrap_or(leaf.clearance);
                        let widest = along.last().copied().unwrap_or(leaf.clearance);
                        let opening = (params.min_width + params.cell * leaf.info.0 as f64 / 2.0) / (2.0 * half);
                        widest > params.max_corridor / 2.0 || half < params.min_corridor / 2.0 || opening < params.min_opening || opening > params.max_opening
                    },
                    _ => way.length < params.min_arm - leaf.clearance,
                };
                short.then_some((index, way.length))
            });
            let Some((index, _)) = short.min_by(|one, other| one.1.total_cmp(&other.1)) else {
                break;
            };
            let meets = self.ways.swap_remove(index).nodes;
            for meet in meets {
                self.join(meet);
            }
        }
    }

    /// Makes one way of the two at a node.
    fn join(&mut self, node: usize) {
        let ways = self.at(node);
        let [one, other] = ways[..] else { return };
        if one == other {
            return;
        }
        let mut first = self.ways[one].clone();
        let mut second = self.ways[other].clone();
        if first.nodes[0] == node {
            first.nodes.reverse();
            first.points.reverse();
            first.clearances.reverse();
        }
        if second.nodes[1] == node {
            second.nodes.reverse();
            second.points.reverse();
            second.clearances.reverse();
        }
        first.points.extend_from_slice(&second.points[1..]);
        first.clearances.extend_from_slice(&second.clearances[1..]);
        first.nodes[1] = second.nodes[1];
        first.length += second.length;
        self.ways[one] = first;
        self.ways.swap_remove(other);
    }
}
