//! What can be wrong with lists of names that claim to be an embedded graph.

use thiserror::Error;

use super::GraphError;

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
    #[error("vertex `{vertex}` lists the neighbour `{neighbour}`, which is no vertex")]
    UnknownNeighbour {
        /// Whose list it is.
        vertex: String,
        /// The name that is no vertex.
        neighbour: String,
    },
    /// A vertex lists a neighbour that does not list it back.
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}`, which does not list `{vertex}` back"
    )]
    OneSided {
        /// Whose list it is.
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
        /// Whose list it is.
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
    /// An edge name does not stand exactly twice.
    #[error("edge `{edge}` stands {times} times ({places}); an edge has two ends")]
    NotTwoEnds {
        /// The edge.
        edge: String,
        /// How often it stands.
        times: usize,
        /// The vertices in whose lists it stands, the first few.
        places: String,
    },
    /// The graph falls into pieces.
    #[error("the world is not connected: vertex `{vertex}` cannot be reached from `{from}`")]
    NotConnected {
        /// The first vertex out of reach.
        vertex: String,
        /// The first vertex of all.
        from: String,
    },
    /// No edge, or too many.
    #[error(transparent)]
    GraphError(#[from] GraphError),
}
