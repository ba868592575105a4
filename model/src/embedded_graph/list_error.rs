//! The errors of lists of names that are not an embedded graph.

use thiserror::Error;

use super::GraphError;
use crate::similar::SimilarName;

/// Why lists of names are not an embedded graph.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ListError {
    /// A vertex has two lists.
    #[error("vertex `{vertex}` has two lists")]
    VertexTwice {
        /// The vertex.
        vertex: String,
    },
    /// A neighbour list names something that has no list.
    #[error("vertex `{vertex}` lists the neighbour `{neighbour}`, which is not a vertex{similar}")]
    UnknownNeighbour {
        /// The vertex with the list.
        vertex: String,
        /// The name that is not a vertex.
        neighbour: String,
        /// A vertex with a similar name.
        similar: SimilarName,
    },
    /// A vertex lists a neighbour that does not list it back.
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}`, which does not list `{vertex}` back"
    )]
    OneSided {
        /// The vertex with the list.
        vertex: String,
        /// The neighbour.
        neighbour: String,
    },
    /// A neighbour list names the same neighbour twice.
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}` twice; \
         parallel edges need edge names, in [doors]"
    )]
    RepeatedNeighbour {
        /// The vertex with the list.
        vertex: String,
        /// The neighbour.
        neighbour: String,
    },
    /// A neighbour list names its own vertex.
    #[error("vertex `{vertex}` lists itself; loops need edge names, in [doors]")]
    OwnNeighbour {
        /// The vertex.
        vertex: String,
    },
    /// An edge name does not occur exactly twice.
    #[error("edge `{edge}` occurs {times} time{} ({places}); an edge has two ends", if *.times == 1 { "" } else { "s" })]
    NotTwoEnds {
        /// The edge.
        edge: String,
        /// The number of times that it occurs.
        times: usize,
        /// The first few vertices with lists that contain it.
        places: String,
    },
    /// The graph is not connected.
    #[error("the world is not connected: vertex `{vertex}` cannot be reached from `{from}`")]
    NotConnected {
        /// The first vertex that cannot be reached.
        vertex: String,
        /// The first vertex of all.
        from: String,
    },
    /// No edge, or too many.
    #[error(transparent)]
    GraphError(#[from] GraphError),
}
