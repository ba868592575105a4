//! Embedded graphs as graphs of the crate [`petgraph`].
//!
//! A node is a [`Vertex`]. An edge is an edge: [`IntoEdges`] yields it once for each of its ends, a loop twice, in
//! clockwise order, and [`IntoEdgeReferences`] yields it once. It is identified by the lower of its two darts. So
//! petgraph's algorithms run on an embedded graph:
//!
//! ```
//! use petgraph::algo::{connected_components, dijkstra};
//! use toposlam_model::embedded_graph::{EmbeddedGraph, Vertex};
//!
//! // A triangle with a tail.
//! let graph = EmbeddedGraph::from_neighbour_lists(&[
//!     ("end", vec!["a"]),
//!     ("a", vec!["end", "b", "c"]),
//!     ("b", vec!["a", "c"]),
//!     ("c", vec!["b", "a"]),
//! ])?;
//! assert_eq!(connected_components(&graph), 1);
//! let moves = dijkstra(&graph, Vertex(0), None, |_| 1);
//! assert_eq!(moves[&Vertex(3)], 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A [`Graph`](petgraph::Graph) keeps the clockwise order of the edges in the weights of its nodes:
//! [`EmbeddedGraph::to_petgraph`].

use petgraph::{
    Undirected,
    graph::{EdgeIndex, NodeIndex, UnGraph},
    visit::{
        Data, EdgeCount, EdgeRef, GraphBase, GraphProp, IntoEdgeReferences, IntoEdges,
        IntoNeighbors, IntoNodeIdentifiers, IntoNodeReferences, NodeCompactIndexable, NodeCount,
        NodeIndexable, VisitMap, Visitable,
    },
};
use thiserror::Error;

use super::{Dart, EmbeddedGraph, ListError, Vertex};

/// An edge, seen from one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EdgeView {
    pub dart: Dart,
    source: Vertex,
    target: Vertex,
    id: Dart,
}

impl EdgeRef for EdgeView {
    type NodeId = Vertex;
    type EdgeId = Dart;
    type Weight = ();

    fn source(&self) -> Vertex {
        self.source
    }

    fn target(&self) -> Vertex {
        self.target
    }

    fn weight(&self) -> &() {
        &()
    }

    fn id(&self) -> Dart {
        self.id
    }
}

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

impl Data for EmbeddedGraph {
    type NodeWeight = ();
    type EdgeWeight = ();
}

impl GraphProp for EmbeddedGraph {
    type EdgeType = Undirected;
}

impl NodeCount for EmbeddedGraph {
    fn node_count(&self) -> usize {
        self.vertex_count()
    }
}

impl EdgeCount for EmbeddedGraph {
    fn edge_count(&self) -> usize {
        Self::edge_count(self)
    }
}

impl NodeIndexable for EmbeddedGraph {
    fn node_bound(&self) -> usize {
        self.vertex_count()
    }

    fn to_index(&self, vertex: Vertex) -> usize {
        vertex.at()
    }

    fn from_index(&self, index: usize) -> Vertex {
        Vertex(index as u32)
    }
}

impl NodeCompactIndexable for EmbeddedGraph {}

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

/// An iterator with a name, as the traits of petgraph need it.
type Boxed<'g, T> = Box<dyn Iterator<Item = T> + 'g>;

impl<'g> IntoNodeIdentifiers for &'g EmbeddedGraph {
    type NodeIdentifiers = Boxed<'g, Vertex>;

    fn node_identifiers(self) -> Self::NodeIdentifiers {
        Box::new(self.vertices())
    }
}

impl<'g> IntoNodeReferences for &'g EmbeddedGraph {
    type NodeRef = (Vertex, &'g ());
    type NodeReferences = Boxed<'g, (Vertex, &'g ())>;

    fn node_references(self) -> Self::NodeReferences {
        Box::new(self.vertices().map(|vertex| (vertex, &())))
    }
}

impl<'g> IntoNeighbors for &'g EmbeddedGraph {
    type Neighbors = Boxed<'g, Vertex>;

    fn neighbors(self, vertex: Vertex) -> Self::Neighbors {
        Box::new(self.darts_of(vertex).map(|dart| self.vertex(self.opposite(dart))))
    }
}

impl<'g> IntoEdgeReferences for &'g EmbeddedGraph {
    type EdgeRef = EdgeView;
    type EdgeReferences = Boxed<'g, EdgeView>;

    fn edge_references(self) -> Self::EdgeReferences {
        Box::new(EmbeddedGraph::edges(self).map(|(dart, _)| self.edge_view(dart)))
    }
}

impl<'g> IntoEdges for &'g EmbeddedGraph {
    type Edges = Boxed<'g, EdgeView>;

    fn edges(self, vertex: Vertex) -> Self::Edges {
        Box::new(self.darts_of(vertex).map(|dart| self.edge_view(dart)))
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
    fn edge_view(&self, dart: Dart) -> EdgeView {
        let far = self.opposite(dart);
        let (source, target) = (self.vertex(dart), self.vertex(far));
        EdgeView { dart, source, target, id: dart.min(far) }
    }

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
    use petgraph::{
        algo::{connected_components, min_spanning_tree},
        data::Element,
        visit::{Bfs, Walker},
    };
    use proptest::prelude::*;

    use super::*;
    use crate::any_graph::{Class, any_graph};

    proptest! {
        #[test]
        fn an_edge_is_yielded_once_for_each_of_its_ends(
            graph in any_graph(Class::Multigraph, 30),
        ) {
            prop_assert_eq!(graph.edge_references().count(), graph.edge_count());
            let ends = graph.vertices().flat_map(|vertex| IntoEdges::edges(&graph, vertex));
            let mut times = vec![0; graph.dart_count()];
            for edge in ends {
                times[edge.id().at()] += 1;
                prop_assert_eq!(edge.source(), graph.vertex(edge.dart));
                prop_assert_eq!(edge.target(), graph.vertex(graph.opposite(edge.dart)));
            }
            for (one, other) in graph.edges() {
                prop_assert_eq!((times[one.at()], times[other.at()]), (2, 0));
            }
        }

        #[test]
        fn an_embedded_graph_is_connected_and_has_a_spanning_tree(
            graph in any_graph(Class::Multigraph, 30),
        ) {
            prop_assert_eq!(connected_components(&graph), 1);
            prop_assert_eq!(Bfs::new(&graph, Vertex(0)).iter(&graph).count(), graph.vertex_count());
            let tree = min_spanning_tree(&graph).filter(|part| matches!(part, Element::Edge { .. }));
            prop_assert_eq!(tree.count(), graph.vertex_count() - 1);
        }

        #[test]
        fn the_rotation_is_kept(graph in any_graph(Class::Multigraph, 30)) {
            prop_assert_eq!(EmbeddedGraph::from_petgraph(&graph.to_petgraph()), Ok(graph));
        }
    }

    #[test]
    fn a_wrong_order_of_edges_is_an_error() {
        let edge = EmbeddedGraph::from_edge_lists(&[("u", vec!["a"]), ("v", vec!["a"])]).unwrap();
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
