//! To and from petgraph's graphs, which have no order around a vertex.

use petgraph::{
    Undirected,
    graph::{EdgeIndex, Graph, IndexType, NodeIndex, UnGraph},
    visit::EdgeRef,
};
use thiserror::Error;

use super::{EmbeddedGraph, ListError};

/// Why a petgraph graph with an order around each node is not an embedded graph.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PetgraphError {
    /// The order has not one list for each node.
    #[error("{lists} lists were given for {nodes} nodes")]
    ListCount {
        /// The number of lists.
        lists: usize,
        /// The number of nodes.
        nodes: usize,
    },
    /// A list names an edge that does not touch its node, or not as often as it touches it.
    #[error("node {node} lists edge {edge} {listed} times, but {touches} of its ends are there")]
    NotIncident {
        /// The node's index.
        node: usize,
        /// The edge's index.
        edge: usize,
        /// How often the node's list names the edge.
        listed: usize,
        /// How many ends of the edge are at the node.
        touches: usize,
    },
    /// The graph itself is not a world: no edge, or not connected. Names are indices.
    #[error(transparent)]
    Graph(#[from] ListError),
}

impl EmbeddedGraph {
    /// An embedded graph from a petgraph graph and the clockwise order of the edges around each of
    /// its nodes; a loop stands twice in its node's list. Vertices are numbered as the nodes, darts
    /// in the order of the lists.
    ///
    /// # Errors
    /// Where the lists do not fit the graph, or the graph is not connected or has no edge.
    pub fn from_petgraph<N, E, Ix: IndexType>(
        graph: &Graph<N, E, Undirected, Ix>,
        clockwise: &[Vec<EdgeIndex<Ix>>],
    ) -> Result<Self, PetgraphError> {
        if clockwise.len() != graph.node_count() {
            return Err(PetgraphError::ListCount {
                lists: clockwise.len(),
                nodes: graph.node_count(),
            });
        }
        let mut lists = Vec::with_capacity(clockwise.len());
        for (node, edges) in clockwise.iter().enumerate() {
            let at = NodeIndex::new(node);
            let incident = graph.edges(at).map(|edge| edge.id());
            for edge in incident.chain(edges.iter().copied()) {
                let touches = graph
                    .edge_endpoints(edge)
                    .map_or(0, |(a, b)| usize::from(a == at) + usize::from(b == at));
                let listed = edges.iter().filter(|&&other| other == edge).count();
                if listed != touches {
                    let edge = edge.index();
                    return Err(PetgraphError::NotIncident { node, edge, listed, touches });
                }
            }
            let names = edges.iter().map(|edge| edge.index().to_string()).collect();
            lists.push((node.to_string(), names));
        }
        Ok(Self::from_edge_lists(&lists)?)
    }

    /// The abstract graph: nodes and edges weighted with their numbers here, the orders forgotten.
    /// Node `i` is vertex `i`; edges stand in the order of [`edges`](Self::edges).
    #[must_use]
    pub fn to_petgraph(&self) -> UnGraph<(), ()> {
        let mut graph = UnGraph::with_capacity(self.vertex_count(), self.edge_count());
        for _ in self.vertices() {
            graph.add_node(());
        }
        for (dart, other) in self.edges() {
            graph.add_edge(
                NodeIndex::new(self.vertex(dart).at()),
                NodeIndex::new(self.vertex(other).at()),
                (),
            );
        }
        graph
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_petgraph_graph_with_an_order_becomes_embedded_and_comes_back() {
        let mut graph = UnGraph::<(), ()>::new_undirected();
        let (u, v) = (graph.add_node(()), graph.add_node(()));
        let (a, b, c) =
            (graph.add_edge(u, v, ()), graph.add_edge(u, v, ()), graph.add_edge(u, u, ()));
        let embedded =
            EmbeddedGraph::from_petgraph(&graph, &[vec![a, c, b, c], vec![b, a]]).unwrap();
        assert_eq!((embedded.vertex_count(), embedded.edge_count()), (2, 3));
        let back = embedded.to_petgraph();
        assert_eq!(back.edge_count(), 3);
        assert_eq!(back.edges_connecting(NodeIndex::new(0), NodeIndex::new(1)).count(), 2);
        assert_eq!(back.edges_connecting(NodeIndex::new(0), NodeIndex::new(0)).count(), 1);
    }

    #[test]
    fn an_order_that_misses_an_edge_is_refused() {
        let mut graph = UnGraph::<(), ()>::new_undirected();
        let (u, v) = (graph.add_node(()), graph.add_node(()));
        let a = graph.add_edge(u, v, ());
        let message =
            |order: &[Vec<_>]| EmbeddedGraph::from_petgraph(&graph, order).unwrap_err().to_string();
        assert_eq!(message(&[vec![a]]), "1 lists were given for 2 nodes");
        assert_eq!(
            message(&[vec![a], vec![]]),
            "node 1 lists edge 0 0 times, but 1 of its ends are there"
        );
        assert_eq!(
            message(&[vec![a, a], vec![a]]),
            "node 0 lists edge 0 2 times, but 1 of its ends are there"
        );
    }
}
