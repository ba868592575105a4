//! Embedded graphs without their corners: vertices with two darts.

use super::{Dart, EmbeddedGraph};

impl EmbeddedGraph {
    /// The same graph without corners: of each vertex with two darts, the two edges are one. The vertices that
    /// stay have the same darts, in the same order; the faces, and so the genus, are the same. Of a cycle, in
    /// which all vertices are corners, the first one stays. And for each of its darts, the dart of this graph.
    pub fn smoothed(&self) -> (Self, Vec<Dart>) {
        let mut stays: Vec<bool> = self.vertices().map(|vertex| self.degree(vertex) != 2).collect();
        if !stays.contains(&true) {
            stays[0] = true;
        }
        let is_kept = |dart: Dart| stays[self.vertex(dart).at()];
        let darts: Vec<Dart> = self.darts().filter(|&dart| is_kept(dart)).collect();
        let opposite = |dart: Dart| {
            let mut far = self.opposite(dart);
            while !is_kept(far) {
                far = self.opposite(self.clockwise(far));
            }
            far
        };
        (self.rearranged(&darts, opposite).0, darts)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{
        any_graph::{Class, any_graph},
        isomorphism::{code, isomorphism},
    };

    #[test]
    fn a_cycle_becomes_a_loop_and_a_chain_an_edge() {
        for edges in 1..6_usize {
            let smooth = EmbeddedGraph::cycle(edges).smoothed().0;
            assert_eq!((smooth.vertex_count(), smooth.edge_count(), smooth.genus()), (1, 1, 0));
        }
        let (smooth, darts) = EmbeddedGraph::chain(2).smoothed();
        assert_eq!((smooth.vertex_count(), smooth.edge_count()), (2, 1));
        assert_eq!(darts, [Dart(0), Dart(3)]);
    }

    /// The graph with a corner on an edge.
    fn with_corner(graph: &EmbeddedGraph, edge: usize) -> EmbeddedGraph {
        let mut opposite: Vec<u32> = graph.darts().map(|dart| graph.opposite(dart).0).collect();
        let mut clockwise: Vec<u32> = graph.darts().map(|dart| graph.clockwise(dart).0).collect();
        let (one, other) = graph.edges().nth(edge % graph.edge_count()).unwrap();
        let first = opposite.len() as u32;
        (opposite[one.at()], opposite[other.at()]) = (first, first + 1);
        opposite.extend([one.0, other.0]);
        clockwise.extend([first + 1, first]);
        EmbeddedGraph::from_permutations(&opposite, &clockwise).unwrap().0
    }

    proptest! {
        #[test]
        fn corners_are_the_only_vertices_and_each_takes_one_edge_with_it(
            graph in any_graph(Class::Multigraph, 12),
        ) {
            let corners = graph.vertices().filter(|&vertex| graph.degree(vertex) == 2).count();
            let removed = if corners == graph.vertex_count() { corners - 1 } else { corners };
            let (smooth, darts) = graph.smoothed();
            prop_assert_eq!(smooth.vertex_count(), graph.vertex_count() - removed);
            prop_assert_eq!(smooth.edge_count(), graph.edge_count() - removed);
            prop_assert_eq!(smooth.genus(), graph.genus());
            prop_assert_eq!(&smooth.smoothed().0, &smooth, "it is smooth already");
            for dart in smooth.darts() {
                let degree = graph.degree_around(darts[dart.at()]);
                prop_assert_eq!(smooth.degree_around(dart), degree);
                let next = darts[smooth.clockwise(dart).at()];
                prop_assert_eq!(next, graph.clockwise(darts[dart.at()]));
                prop_assert_eq!(smooth.opposite(smooth.opposite(dart)), dart);
            }
        }

        #[test]
        fn corners_make_no_difference_to_the_smooth_graph(
            graph in any_graph(Class::Multigraph, 8),
            edges in prop::collection::vec(0..8_usize, 0..6),
        ) {
            let cornered = edges.iter().fold(graph.clone(), |graph, &edge| with_corner(&graph, edge));
            let [one, other] = [&graph, &cornered].map(|graph| graph.smoothed().0);
            prop_assert!(isomorphism(&one, &other).is_ok());
            // The first dart stays the first, if its vertex is no corner.
            if graph.degree_around(Dart(0)) != 2 {
                prop_assert_eq!(code(&one, Dart(0)), code(&other, Dart(0)));
            }
        }
    }
}
