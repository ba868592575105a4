//! Clusters of boundary points: pieces of wall. Section 3, Figure 6(d).

use std::f64::consts::TAU;

use nalgebra::{Point2, distance};

use crate::{bearing::BEARINGS, boundary::Boundary};

/// The largest gap between two successive points at the robot. Views.
const GAP: f64 = 0.10;
/// What each metre from the robot to the farther point adds to the gap. Geometry: pixels of the image cover more floor
/// there.
const GAP_PER_METRE: f64 = 0.08;
/// The most bearings that a strut of the camera hides. Geometry: 8 degrees.
const HIDDEN_BEARINGS: usize = 16;
/// Clusters of fewer points are noise. Views.
const MIN_POINTS: usize = 6;
/// Clusters of less extent are noise. Views.
const MIN_EXTENT: f64 = 0.12;

/// Boundary points that follow each other, counter-clockwise as seen from the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cluster {
    pub points: Vec<Point2<f64>>,
}

/// The pieces of wall, without those that are noise.
// paper: sense.cluster, sense.small-clusters
pub fn clusters(boundary: &Boundary) -> Vec<Cluster> {
    let mut chains: Vec<Chain> = Vec::new();
    // The indices of those that may go on.
    let mut open: Vec<usize> = Vec::new();
    for point in boundary.points() {
        open.retain(|&chain| point.0 <= chains[chain].last.0 + HIDDEN_BEARINGS);
        let away = |chain: usize| distance(&chains[chain].last.1, &point.1);
        let nearest = open
            .iter()
            .copied()
            .filter(|&chain| follows(chains[chain].last, point))
            .min_by(|&one, &other| away(one).total_cmp(&away(other)));
        if let Some(chain) = nearest {
            chains[chain].last = point;
            chains[chain].cluster.points.push(point.1);
        } else {
            open.push(chains.len());
            chains.push(Chain::new(point));
        }
    }
    let mut clusters = joined_around(chains);
    clusters.retain(|cluster| cluster.points.len() >= MIN_POINTS && cluster.extent() >= MIN_EXTENT);
    clusters
}

/// A growing cluster: its first and its last point, with their bearings.
struct Chain {
    first: (usize, Point2<f64>),
    last: (usize, Point2<f64>),
    cluster: Cluster,
}

impl Chain {
    fn new(point: (usize, Point2<f64>)) -> Self {
        Self { first: point, last: point, cluster: Cluster { points: vec![point.1] } }
    }
}

/// The clusters; those that go on across the bearing straight ahead are joined.
fn joined_around(mut chains: Vec<Chain>) -> Vec<Cluster> {
    let mut at = 0;
    while at < chains.len() {
        let goes_on = |other: &Chain| {
            other.last.0 + HIDDEN_BEARINGS >= BEARINGS && follows(other.last, chains[at].first)
        };
        let before = (at + 1..chains.len()).find(|&other| goes_on(&chains[other]));
        if let Some(before) = before {
            let mut front = chains.swap_remove(before).cluster;
            front.points.append(&mut chains[at].cluster.points);
            chains[at].cluster = front;
        }
        at += 1;
    }
    chains.into_iter().map(|chain| chain.cluster).collect()
}

/// Whether the second point continues the cluster of the first.
fn follows((bearing, one): (usize, Point2<f64>), (next, other): (usize, Point2<f64>)) -> bool {
    let hidden = (next + BEARINGS - bearing) % BEARINGS;
    let farther = one.coords.norm().max(other.coords.norm());
    // The wall may go on behind a strut.
    let bridged = if hidden > 1 { farther * hidden as f64 * TAU / BEARINGS as f64 } else { 0.0 };
    (1..=HIDDEN_BEARINGS).contains(&hidden)
        && distance(&one, &other) <= GAP + GAP_PER_METRE * farther + bridged
}

impl Cluster {
    pub fn extent(&self) -> f64 {
        let side = |axis: usize| {
            let along = self.points.iter().map(|point| point[axis]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        side(0).max(side(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::Sight;

    fn clusters(boundary: &Boundary) -> Vec<Cluster> {
        super::clusters(boundary)
    }

    fn boundary(range: impl Fn(f64) -> Option<f64>) -> Boundary {
        let sights =
            (0..BEARINGS).map(|bearing| Sight::at(range(TAU * bearing as f64 / BEARINGS as f64)));
        Boundary { sights: sights.collect() }
    }

    #[test]
    fn a_round_wall_is_one_cluster() {
        let clusters = clusters(&boundary(|_| Some(1.0)));
        assert_eq!(clusters.len(), 1);
        assert_eq!(clusters[0].points.len(), BEARINGS);
    }

    // paper: sense.cluster
    #[test]
    fn walls_at_both_sides_are_two_clusters() {
        let sides =
            boundary(|bearing| Some(0.8 / bearing.sin().abs()).filter(|&range| range < 2.5));
        assert_eq!(clusters(&sides).len(), 2);
    }

    #[test]
    fn a_strut_does_not_split_a_cluster() {
        let strut = boundary(|bearing| Some(1.0).filter(|_| !(1.0..1.1).contains(&bearing)));
        assert_eq!(clusters(&strut).len(), 1);
    }

    // paper: sense.small-clusters
    #[test]
    fn a_speck_is_not_a_cluster() {
        let speck = boundary(|bearing| Some(1.0).filter(|_| (1.0..1.03).contains(&bearing)));
        assert_eq!(clusters(&speck), []);
        assert_eq!(clusters(&boundary(|_| None)), []);
    }
}
