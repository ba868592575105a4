//! Trails of a robot with an undirected marker: all its sightings are at one vertex, and how that vertex was
//! entered each time is not known.

use super::FoldedTrail;
use crate::{embedded_graph::Dart, enumerate::Watch, percept::Sighting};

/// The folded trails in which one vertex has the marker.
#[derive(Clone, Debug, Default)]
pub struct MarkedTrails {
    /// One for each way in which the marked vertices can be one. No two of them are alike.
    pub trails: Vec<FoldedTrail>,
    /// Whether there may be more: the search reached its limit.
    pub may_be_more: bool,
}

const MOST: usize = 64;
const STEPS: u64 = 20_000;

impl FoldedTrail {
    /// The first dart of the first vertex with an undirected marker.
    pub(crate) fn marked_vertex(&self) -> Option<Dart> {
        self.marked_vertices().next()
    }

    fn marked_vertices(&self) -> impl Iterator<Item = Dart> + '_ {
        self.vertices().filter(|&first| matches!(self.sighting(first), Sighting::Lying(_)))
    }

    /// The trails in which all vertices with an undirected marker are one. Each world that explains the walk
    /// is a world that explains one of them. Without any, no world explains the walk.
    pub fn with_one_marked_vertex(&self, watch: &dyn Watch) -> MarkedTrails {
        let mut found = MarkedTrails::default();
        let mut open = vec![self.clone()];
        let mut steps = STEPS;
        while let Some(trail) = open.pop() {
            if found.trails.len() >= MOST || steps == 0 || watch.stop() {
                found.may_be_more = true;
                break;
            }
            let mut marked = trail.marked_vertices();
            let (first, second) = (marked.next(), marked.next());
            drop(marked);
            let (Some(first), Some(second)) = (first, second) else {
                found.trails.push(trail);
                continue;
            };
            if trail.degree(first) != trail.degree(second) {
                continue;
            }
            for dart in trail.darts_around(second) {
                steps = steps.saturating_sub(1);
                let mut united = trail.clone();
                if united.unite(first, dart).is_ok() {
                    open.push(united);
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        any_graph::{by_neighbours, walk},
        embedded_graph::EmbeddedGraph,
        folding::fold,
        marker::Undirected,
        percept::{Door, Percept},
        world::GraphWorld,
    };

    /// The folded trail of a walk with an undirected marker at the start.
    fn walked(graph: &EmbeddedGraph, start: Dart, doors: &[u32]) -> FoldedTrail {
        let world = GraphWorld::with_aid(graph, Undirected, start);
        let (percepts, doors) = walk(world, doors.iter().copied());
        fold(&percepts, &doors).unwrap()
    }

    /// A robot that comes back to the marker of a cycle has come in by the other door: by its own it would have
    /// left an edge with one end.
    #[test]
    fn once_around_a_cycle_determines_it() {
        let cycle = EmbeddedGraph::cycle(3);
        for (doors, trails, open) in [(&[1, 1][..], 1, 2), (&[1, 1, 1], 1, 0)] {
            let trail = walked(&cycle, Dart(0), doors);
            let found = trail.with_one_marked_vertex(&());
            assert_eq!((found.trails.len(), found.may_be_more), (trails, false));
            assert_eq!(found.trails[0].open_count(), open);
        }
    }

    /// In the wheel the robot comes back to its hub by any spoke. If by the one that it took first, the edge along
    /// the rim is a loop.
    #[test]
    fn the_marked_hub_of_a_wheel_may_be_entered_by_each_spoke() {
        let wheel = by_neighbours("x: a b c d | a: b x d | b: c x a | c: d x b | d: a x c");
        // From the hub to its first neighbour, along the rim, and back to the hub.
        let trail = walked(&wheel, Dart(0), &[0, 2, 2]);
        assert_eq!(trail.vertex_count(), 4);
        let found = trail.with_one_marked_vertex(&());
        let mut vertices: Vec<_> = found.trails.iter().map(FoldedTrail::vertex_count).collect();
        vertices.sort_unstable();
        assert_eq!(vertices, [2, 3, 3, 3]);
        assert!(found.trails.iter().all(|trail| trail.marked_vertex().is_some()));
    }

    #[test]
    fn marked_vertices_of_different_degrees_are_not_one() {
        let percept = |degree| Percept { degree, sighting: Sighting::Lying(1) };
        let trail = fold(&[percept(2), percept(3)], &[Door(1)]).unwrap();
        let found = trail.with_one_marked_vertex(&());
        assert!(found.trails.is_empty() && !found.may_be_more);
    }
}
