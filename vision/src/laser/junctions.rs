//! The junctions of the way graph, its corners and its dead ends.

use nalgebra::{Point2, Vector2};

use super::{
    ends::WayEnd,
    params::{ArmParams, CornerParams, LaserParams},
    way_graph::{Way, WayGraph, WayNode},
};
use crate::{
    geometry::{direction, distance},
    place::{Certainty, PlaceArm, SeenPlace},
};

impl SeenPlace {
    /// A place with its arms in clockwise order.
    fn new(centre: Point2<f64>, clearance: f64, mut arms: Vec<PlaceArm>) -> Self {
        arms.sort_by(|one, other| other.direction.total_cmp(&one.direction));
        Self { centre, clearance, arms }
    }
}

impl WayGraph {
    /// The junctions, and the corners and dead ends if they are vertices.
    pub(super) fn places(&self, params: &LaserParams) -> Vec<SeenPlace> {
        let mut junctions = self.meets(&params.arm);
        if params.corner.corners {
            junctions.extend(self.dead_ends(&params.arm, &params.corner));
            junctions.extend(self.ways.iter().flat_map(|way| way.corners(&params.corner)));
        }
        junctions
    }

    /// Meet points, of which those in one place are one.
    fn meets(&self, params: &ArmParams) -> Vec<SeenPlace> {
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
        let is_leader = |&node: &usize| degrees[node] >= 3 && group[node] == node;
        for leader in (0..self.nodes.len()).filter(is_leader) {
            let members = self.nodes.iter().zip(&group).filter(|&(_, &group)| group == leader);
            let members: Vec<&WayNode> = members.map(|(node, _)| node).collect();
            let sum: Vector2<f64> = members.iter().map(|node| node.point.coords).sum();
            let centre = Point2::from(sum / members.len() as f64);
            let clearance = members.iter().map(|node| node.clearance).fold(0.0, f64::max);
            let gate = clearance + params.direction;
            let mut arms = Vec::new();
            for way in &self.ways {
                let inner = group[way.nodes[0]] == group[way.nodes[1]]
                    && way.length < params.merge * clearance;
                // A way around a block may begin and end at one junction.
                for (node, line) in way.nodes.into_iter().zip(way.lines()) {
                    if group[node] != leader || inner {
                        continue;
                    }
                    let certainty =
                        if way.is_certain { Certainty::Certain } else { Certainty::Possible };
                    let direction = direction_beyond(&line, centre, gate);
                    arms.extend(direction.map(|direction| PlaceArm { direction, certainty }));
                }
            }
            junctions.push(SeenPlace::new(centre, clearance, arms));
        }
        junctions
    }

    /// The ends of long ways that were seen to end.
    fn dead_ends(&self, arm: &ArmParams, params: &CornerParams) -> Vec<SeenPlace> {
        let dead_end = |(number, node): (usize, &WayNode)| {
            let [way] = self.at(number)[..] else { return None };
            let way = self.ways[way].clone().from_node(number);
            if node.end?.kind != WayEnd::Closed || way.length < params.min_way {
                return None;
            }
            let gate = node.clearance + arm.direction;
            let arm = PlaceArm::certain(direction_beyond(&way.line, node.point, gate)?);
            Some(SeenPlace::new(node.point, node.clearance, vec![arm]))
        };
        self.nodes.iter().enumerate().filter_map(dead_end).collect()
    }
}

/// The direction from a point to where a line from there is this far away.
fn direction_beyond(line: &[(Point2<f64>, f64)], from: Point2<f64>, gate: f64) -> Option<f64> {
    let beyond = line.iter().find(|(point, _)| distance(*point, from) >= gate);
    beyond.or(line.last()).map(|&(point, _)| direction(from, point))
}

impl Way {
    /// The places where the middle line bends most, if it is by enough for a corner.
    fn corners(&self, params: &CornerParams) -> Vec<SeenPlace> {
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
            let turn = CornerParams::bend(arms);
            (turn >= params.min_turn).then_some((turn, arms))
        };
        let mut corners = Vec::new();
        let mut sharpest: Option<(f64, SeenPlace)> = None;
        for (at, &&(centre, clearance)) in line.iter().enumerate() {
            let Some((turn, arms)) = bend(at) else {
                corners.extend(sharpest.take().map(|(_, corner)| corner));
                continue;
            };
            if sharpest.as_ref().is_none_or(|(most, _)| turn > *most) {
                let arms = arms.map(PlaceArm::certain).to_vec();
                sharpest = Some((turn, SeenPlace::new(centre, clearance, arms)));
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
        let junctions = graph.places(&LaserParams::default());
        let [junction] = &junctions[..] else { panic!("{junctions:?}") };
        let degrees: Vec<i32> =
            junction.directions().map(|arm| arm.to_degrees().round() as i32).collect();
        assert_eq!(degrees, [180, 90, 0]);
    }
}
