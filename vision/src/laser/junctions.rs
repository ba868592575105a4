//! Junctions of the way graph: meet points that are near to each other are one.

use super::{graph::WayGraph, params::LaserParams, skeleton::ArmEnd};

/// A junction, or the end of a corridor.
#[derive(Clone, Debug)]
pub struct LaserJunction {
    /// Its centre in the frame of odometry, in metres.
    pub centre: [f64; 2],
    /// The distance from the centre to the nearest obstacle, in metres.
    pub clearance: f64,
    /// The direction of each arm in the frame of odometry, in radians, clockwise.
    pub arms: Vec<f64>,
}

/// The junctions with at least three arms, and the ends of corridors that were seen to end.
pub fn junctions(graph: &WayGraph, params: &LaserParams) -> Vec<LaserJunction> {
    let degree: Vec<usize> = (0..graph.nodes.len()).map(|node| graph.at(node).len()).collect();
    let mut group: Vec<usize> = (0..graph.nodes.len()).collect();
    let mut inner = vec![false; graph.ways.len()];
    for (index, way) in graph.ways.iter().enumerate() {
        let [one, other] = way.nodes;
        if degree[one] < 3 || degree[other] < 3 {
            continue;
        }
        let clearance = graph.nodes[one].clearance.max(graph.nodes[other].clearance);
        if way.length < params.merge * clearance {
            inner[index] = true;
            let (low, high) =
                (group[one].min(group[other]), group[one].max(group[other]));
            for known in &mut group {
                if *known == high {
                    *known = low;
                }
            }
        }
    }
    let mut found = Vec::new();
    for leader in 0..graph.nodes.len() {
        let members: Vec<usize> =
            (0..graph.nodes.len()).filter(|&node| group[node] == leader).collect();
        if members.is_empty() || members.iter().all(|&node| degree[node] == 0) {
            continue;
        }
        let meet = members.iter().any(|&node| degree[node] >= 3);
        if !meet && graph.nodes[leader].end != Some(ArmEnd::Closed) {
            continue;
        }
        let centre = [0, 1].map(|axis| {
            members.iter().map(|&node| graph.nodes[node].point[axis]).sum::<f64>()
                / members.len() as f64
        });
        let clearance = members.iter().map(|&node| graph.nodes[node].clearance).fold(0.0, f64::max);
        let mut arms = Vec::new();
        for (index, way) in graph.ways.iter().enumerate() {
            for (end, &node) in way.nodes.iter().enumerate() {
                if group[node] != leader || inner[index] {
                    continue;
                }
                let gate = clearance + params.arm_direction;
                let off = |point: &&[f64; 2]| {
                    (point[0] - centre[0]).hypot(point[1] - centre[1]) >= gate
                };
                let point = if end == 0 {
                    way.points.iter().find(off).or(way.points.last())
                } else {
                    way.points.iter().rev().find(off).or(way.points.first())
                };
                let Some(point) = point else { continue };
                arms.push((point[1] - centre[1]).atan2(point[0] - centre[0]));
            }
        }
        arms.sort_by(|one, other| other.total_cmp(one));
        found.push(LaserJunction { centre, clearance, arms });
    }
    found
}
