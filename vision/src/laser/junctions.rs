//! The junctions of the way graph.

use super::{
    params::ArmParams,
    way_graph::{WayGraph, distance},
};

/// A junction with at least three arms.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserJunction {
    /// Its centre, in metres in the frame of odometry.
    pub centre: [f64; 2],
    /// The distance from the centre to the nearest wall, in metres.
    pub clearance: f64,
    /// The direction of each arm in the frame of odometry, in radians, clockwise.
    pub arms: Vec<f64>,
}

impl WayGraph {
    /// The junctions: meet points, of which those in one place are one.
    #[must_use]
    pub fn junctions(&self, params: &ArmParams) -> Vec<LaserJunction> {
        let degrees: Vec<usize> = (0..self.nodes.len()).map(|node| self.at(node).len()).collect();
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
            let centre = [0, 1].map(|axis| {
                let all = members.iter().map(|&node| self.nodes[node].point[axis]);
                all.sum::<f64>() / members.len() as f64
            });
            let clearances = members.iter().map(|&node| self.nodes[node].clearance);
            let clearance = clearances.fold(0.0, f64::max);
            let gate = clearance + params.direction;
            let mut arms = Vec::new();
            for way in &self.ways {
                let inner = group[way.nodes[0]] == group[way.nodes[1]]
                    && way.length < params.merge * clearance;
                for node in way.nodes.into_iter().filter(|&node| group[node] == leader && !inner) {
                    let way = way.clone().from_node(node);
                    let beyond =
                        way.line.iter().find(|(point, _)| distance(*point, centre) >= gate);
                    if let Some(&(point, _)) = beyond.or(way.line.last()) {
                        arms.push((point[1] - centre[1]).atan2(point[0] - centre[0]));
                    }
                }
            }
            arms.sort_by(|one, other| other.total_cmp(one));
            junctions.push(LaserJunction { centre, clearance, arms });
        }
        junctions
    }
}
