//! The junctions of the way graph, its corners and its dead ends.

use std::f64::consts::PI;

use nalgebra::{Point2, Vector2};
use toposlam_model::driving::scene::wrapped;

use super::{
    ends::WayEnd,
    params::{ArmParams, CornerParams, LaserParams},
    way_graph::{Way, WayGraph, WayNode},
};
use crate::geometry::{direction, distance};

/// A place where ways meet: a junction with at least three arms, a corner with two, or a dead end with one.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserJunction {
    /// Its centre, in metres on the local map.
    pub centre: Point2<f64>,
    /// The distance from the centre to the nearest wall, in metres.
    pub clearance: f64,
    /// The direction of each arm on the local map, in radians, clockwise.
    pub arms: Vec<f64>,
    /// The directions of those that are not certain to be arms.
    pub uncertain: Vec<f64>,
}

impl WayGraph {
    /// The junctions, and the corners and dead ends if they are vertices.
    #[must_use]
    pub fn junctions(&self, params: &LaserParams) -> Vec<LaserJunction> {
        let mut junctions = self.meets(&params.arm);
        if params.corner.corners {
            junctions.extend(self.dead_ends(&params.arm, &params.corner));
            junctions.extend(self.ways.iter().flat_map(|way| way.corners(&params.corner)));
        }
        junctions
    }

    /// Meet points, of which those in one place are one.
    fn meets(&self, params: &ArmParams) -> Vec<LaserJunction> {
        let degrees = self.degrees();
        // Each meet point is in the group of the first that is joined to it by short ways.
        let mut group: Vec<usize> = (0..self.nodes.len()).collect();
        for way in &self.ways {
            let [one, other] = way.nodes;
            let clearance = self.nodes[one].clearance.max(self.nodes[other].clearance);
            if degrees[one].min(degrees[other]) >= 3 && way.length < params.merge * clearance {
                let (kept, joined) = (group[one].min(group[other]), group[one].max(group[other]));
                for group in &mut group {
                    if *group == joined {
                        *group = kept;
                    }
                }
            }
        }
        let mut junctions = Vec::new();
        for leader in (0..self.nodes.len()).filter(|&node| degrees[node] >= 3) {
            let members: Vec<_> =
                (0..self.nodes.len()).filter(|&node| group[node] == leader).collect();
            if members.is_empty() {
                continue;
            }
            let all = members.iter().map(|&node| self.nodes[node].point.coords);
            let centre = Point2::from(all.sum::<Vector2<f64>>() / members.len() as f64);
            let clearances = members.iter().map(|&node| self.nodes[node].clearance);
            let clearance = clearances.fold(0.0, f64::max);
            let gate = clearance + params.direction;
            let (mut arms, mut uncertain) = (Vec::new(), Vec::new());
            for way in &self.ways {
                let inner = group[way.nodes[0]] == group[way.nodes[1]]
                    && way.length < params.merge * clearance;
                // A way around a block may begin and end at one junction.
                for (node, line) in way.nodes.into_iter().zip(way.lines()) {
                    if group[node] != leader || inner {
                        continue;
                    }
                    let beyond = line.iter().find(|(point, _)| distance(*point, centre) >= gate);
                    if let Some(&(point, _)) = beyond.or(line.last()) {
                        arms.push(direction(centre, point));
                        uncertain.extend((!way.is_certain).then(|| direction(centre, point)));
                    }
                }
            }
            arms.sort_by(|one, other| other.total_cmp(one));
            junctions.push(LaserJunction { centre, clearance, arms, uncertain });
        }
        junctions
    }
    /// The ends of long ways that were seen to end.
    fn dead_ends<'a>(
        &'a self,
        arm: &'a ArmParams,
        params: &'a CornerParams,
    ) -> impl Iterator<Item = LaserJunction> + 'a {
        (0..self.nodes.len()).filter_map(move |node| {
            let WayNode { point, clearance, end } = self.nodes[node];
            let [way] = self.at(node)[..] else { return None };
            let way = self.ways[way].clone().from_node(node);
            if end?.end != WayEnd::Closed || way.length < params.min_way {
                return None;
            }
            let gate = clearance + arm.direction;
            let beyond = way.line.iter().find(|(at, _)| distance(*at, point) >= gate);
            let &(towards, _) = beyond.or(way.line.last())?;
            Some(LaserJunction {
                centre: point,
                clearance,
                arms: vec![direction(point, towards)],
                uncertain: Vec::new(),
            })
        })
    }
}

impl Way {
    /// The places where the middle line bends most, if it is by enough for a corner.
    fn corners(&self, params: &CornerParams) -> Vec<LaserJunction> {
        // The steps of cells are no bends.
        let line: Vec<_> = self.line.iter().step_by(4).chain(self.line.last()).collect();
        let mut lengths = vec![0.0];
        for two in line.windows(2) {
            let length: f64 = lengths.last().copied().unwrap_or_default();
            lengths.push(length + distance(two[0].0, two[1].0));
        }
        let bend = |at: usize| {
            let before = (0..at).rev().find(|&i| lengths[at] - lengths[i] >= params.arm)?;
            let after = (at..line.len()).find(|&i| lengths[i] - lengths[at] >= params.arm)?;
            let arms = [before, after].map(|arm| direction(line[at].0, line[arm].0));
            let turn = PI - wrapped(arms[0] - arms[1]).abs();
            (turn >= params.min_turn).then_some((turn, arms))
        };
        let mut corners = Vec::new();
        let mut sharpest: Option<(f64, LaserJunction)> = None;
        for (at, &&(centre, clearance)) in line.iter().enumerate() {
            let Some((turn, mut arms)) = bend(at) else {
                corners.extend(sharpest.take().map(|(_, corner)| corner));
                continue;
            };
            if sharpest.as_ref().is_none_or(|(most, _)| turn > *most) {
                arms.sort_by(|one, other| other.total_cmp(one));
                let (arms, uncertain) = (arms.to_vec(), Vec::new());
                let corner = LaserJunction { centre, clearance, arms, uncertain };
                sharpest = Some((turn, corner));
            }
        }
        corners.extend(sharpest.map(|(_, corner)| corner));
        corners
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corridor_around_a_block_has_two_arms_at_the_junction_where_it_begins_and_ends() {
        let node = |point: [f64; 2]| WayNode { point: point.into(), clearance: 1.0, end: None };
        let line = |points: &[[f64; 2]]| points.iter().map(|&point| (point.into(), 1.0)).collect();
        let way = |nodes, points: &[[f64; 2]]| Way {
            nodes,
            line: line(points),
            length: 40.0,
            is_certain: true,
        };
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
        let straight = [[0.0, 0.0], [-10.0, 0.0]];
        let graph = WayGraph {
            nodes: vec![node([0.0; 2]), node([-10.0, 0.0])],
            ways: vec![way([0, 0], &corners), way([0, 1], &straight)],
        };
        let junctions = graph.junctions(&LaserParams::default());
        let [LaserJunction { arms, .. }] = &junctions[..] else { panic!("{junctions:?}") };
        let degrees: Vec<i32> = arms.iter().map(|arm| arm.to_degrees().round() as i32).collect();
        assert_eq!(degrees, [180, 90, 0]);
    }
}
