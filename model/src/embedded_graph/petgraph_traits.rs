//! Embedded graphs for the crate [`petgraph`]: its searches run on them, and all of its algorithms on their
//! [conversions](EmbeddedGraph::to_petgraph).
//!
//! ```
//! use petgraph::{algo::dijkstra, graph::NodeIndex, visit::Bfs};
//! use toposlam_model::embedded_graph::{EmbeddedGraph, Vertex};
//!
//! // A triangle with a tail.
//! let graph = EmbeddedGraph::from_neighbour_lists(&[
//!     ("end", vec!["a"]),
//!     ("a", vec!["end", "b", "c"]),
//!     ("b", vec!["a", "c"]),
//!     ("c", vec!["b", "a"]),
//! ])?;
//! let mut search = Bfs::new(&graph, Vertex(0));
//! assert_eq!(search.next(&graph), Some(Vertex(0)));
//! let moves = dijkstra(&graph.to_petgraph(), NodeIndex::new(0), None, |_| 1);
//! assert_eq!(moves[&NodeIndex::new(3)], 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use petgraph::{
    graph::{EdgeIndex, NodeIndex, UnGraph},
    visit::{GraphBase, IntoNeighbors, VisitMap, Visitable},
};
use thiserror::Error;

use super::{Dart, EmbeddedGraph, ListError, Vertex};

#[derive(Clone, Debug, Default)]
pub struct VisitedVertices(Vec<bool>);

impl VisitMap<Vertex> for VisitedVertices {
    fn visit(&mut self, vertex: Vertex) -> bool {
        !std::mem::replace(&mut self.0[vertex.at()], true)
    }

    fn is_visited(&self, vertex: &Vertex) -> bool {
        self.0[vertex.at()]
    }

    fn unvisit(&mut self, vertex: Vertex) -> bool {
        std::mem::replace(&mut self.0[vertex.at()], false)
    }
}

impl GraphBase for EmbeddedGraph {
    type NodeId = Vertex;
    type EdgeId = Dart;
}

impl Visitable for EmbeddedGraph {
    type Map = VisitedVertices;

    fn visit_map(&self) -> VisitedVertices {
        VisitedVertices(vec![false; self.vertex_count()])
    }

    fn reset_map(&self, map: &mut VisitedVertices) {
        map.0.clear();
        map.0.resize(self.vertex_count(), false);
    }
}

impl<'g> IntoNeighbors for &'g EmbeddedGraph {
    type Neighbors = Box<dyn Iterator<Item = Vertex> + 'g>;

    fn neighbors(self, vertex: Vertex) -> Self::Neighbors {
        Box::new(self.darts_of(vertex).map(|dart| self.vertex(self.opposite(dart))))
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PetgraphError {
    #[error(transparent)]
    Lists(#[from] ListError),
    #[error("edge {edge} is in the order of node {node}, which it does not meet")]
    OtherNode { edge: usize, node: usize },
    #[error("edge {edge} is in the order of no node")]
    NoNode { edge: usize },
}

impl EmbeddedGraph {
    /// The graph of petgraph: nodes have the numbers of the vertices, edges those of [`edges`](Self::edges), and the
    /// weight of a node lists its edges in clockwise order from the first dart of the vertex, a loop twice.
    pub fn to_petgraph(&self) -> UnGraph<Vec<EdgeIndex>, ()> {
        let numbers = self.edge_numbers();
        let number = |dart: Dart| EdgeIndex::from(numbers[dart.at()]);
        let mut graph = UnGraph::with_capacity(self.vertex_count(), self.edge_count());
        for vertex in self.vertices() {
            graph.add_node(self.darts_of(vertex).map(number).collect());
        }
        for (one, other) in self.edges() {
            let [one, other] = [one, other].map(|dart| NodeIndex::new(self.vertex(dart).at()));
            graph.add_edge(one, other, ());
        }
        graph
    }

    /// The embedded graph of a graph of petgraph, whose nodes list their edges in clockwise order, a loop twice.
    /// Vertices have the numbers of the nodes.
    ///
    /// # Errors
    /// Returns an error if a list is wrong, if the graph has no edge or is not connected.
    pub fn from_petgraph<E>(graph: &UnGraph<Vec<EdgeIndex>, E>) -> Result<Self, PetgraphError> {
        let mut is_listed = vec![false; graph.edge_count()];
        for node in graph.node_indices() {
            for &edge in &graph[node] {
                let ends = graph.edge_endpoints(edge);
                if !ends.is_some_and(|(one, other)| node == one || node == other) {
                    let (edge, node) = (edge.index(), node.index());
                    return Err(PetgraphError::OtherNode { edge, node });
                }
                is_listed[edge.index()] = true;
            }
        }
        if let Some(edge) = is_listed.iter().position(|listed| !listed) {
            return Err(PetgraphError::NoNode { edge });
        }
        let list = |node: NodeIndex| {
            let edges = graph[node].iter().map(|edge| edge.index().to_string());
            (node.index().to_string(), edges.collect())
        };
        let lists: Vec<(String, Vec<String>)> = graph.node_indices().map(list).collect();
        Ok(Self::from_edge_lists(&lists)?)
    }
}

#[cfg(test)]
mod tests {
    use petgraph::visit::{Bfs, Walker};
    use proptest::prelude::*;

    use super::*;
    use crate::any_graph::{Class, any_graph};

    proptest! {
        #[test]
        fn an_embedded_graph_is_connected(graph in any_graph(Class::Multigraph, 30)) {
            prop_assert_eq!(Bfs::new(&graph, Vertex(0)).iter(&graph).count(), graph.vertex_count());
        }

        #[test]
        fn the_rotation_is_kept(graph in any_graph(Class::Multigraph, 30)) {
            prop_assert_eq!(EmbeddedGraph::from_petgraph(&graph.to_petgraph()), Ok(graph));
        }
    }

    #[test]
    fn a_wrong_order_of_edges_is_an_error() {
        let edge = EmbeddedGraph::chain(1);
        for (orders, message) in [
            (
                [vec![0], vec![0], vec![0]],
                "edge 0 is in the order of node 2, which it does not meet",
            ),
            (
                [vec![0], vec![7], vec![]],
                "edge 7 is in the order of node 1, which it does not meet",
            ),
            ([vec![], vec![], vec![]], "edge 0 is in the order of no node"),
            (
                [vec![0], vec![0, 0], vec![]],
                "edge `0` occurs 3 times (0, 1, 1); an edge has two ends",
            ),
        ] {
            let mut graph = edge.to_petgraph();
            graph.add_node(Vec::new());
            for (node, order) in graph.clone().node_indices().zip(orders) {
                graph[node] = order.into_iter().map(EdgeIndex::new).collect();
            }
            assert_eq!(EmbeddedGraph::from_petgraph(&graph).unwrap_err().to_string(), message);
        }
    }
}
