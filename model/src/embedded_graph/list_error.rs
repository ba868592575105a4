//! The errors of lists of names that are not an embedded graph.

use thiserror::Error;

use super::GraphError;
use crate::similar::SimilarName;

/// Why lists of names are not an embedded graph.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ListError {
    #[error("vertex `{vertex}` has two lists")]
    VertexTwice { vertex: String },
    #[error("vertex `{vertex}` lists the neighbour `{neighbour}`, which is not a vertex{similar}")]
    UnknownNeighbour { vertex: String, neighbour: String, similar: SimilarName },
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}`, which does not list `{vertex}` back"
    )]
    OneSided { vertex: String, neighbour: String },
    #[error(
        "vertex `{vertex}` lists the neighbour `{neighbour}` twice; \
         parallel edges need edge names, in [doors]"
    )]
    RepeatedNeighbour { vertex: String, neighbour: String },
    #[error("vertex `{vertex}` lists itself; loops need edge names, in [doors]")]
    OwnNeighbour { vertex: String },
    #[error("edge `{edge}` occurs {times} time{} ({places}); an edge has two ends", if *.times == 1 { "" } else { "s" })]
    NotTwoEnds { edge: String, times: usize, places: String },
    #[error("the world is not connected: vertex `{vertex}` cannot be reached from `{from}`")]
    NotConnected { vertex: String, from: String },
    #[error(transparent)]
    GraphError(#[from] GraphError),
}
