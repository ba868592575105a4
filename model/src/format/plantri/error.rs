//! What can be wrong with plantri's codes, and where.

use thiserror::Error;

use crate::{
    counts::{self, counted},
    embedded_graph::GraphError,
};

/// Why bytes are not one of plantri's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("byte {offset}, world {world}: {cause}")]
pub struct PlantriError {
    /// The offset in the file; the first byte is 0.
    pub offset: usize,
    /// The number of the world in the file; the first is 1.
    pub world: usize,
    /// What is wrong.
    #[source]
    pub cause: PlantriErrorKind,
}

/// What is wrong at a byte. Vertices are counted from 1 and edges from 0, as in the codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlantriErrorKind {
    /// There are no bytes.
    #[error("there is no world")]
    Empty,
    /// The header is not one of plantri's.
    #[error("unknown header; known are planar_code, planar_code le, planar_code be and edge_code")]
    UnknownHeader,
    /// The file ends too early.
    #[error("the file ends in the middle of a world")]
    Truncated,
    /// A neighbour is not a vertex.
    #[error("vertex {vertex} lists the neighbour {neighbour}; the world has {}", counts::vertices(*.vertices))]
    UnknownNeighbour {
        /// The vertex with the list.
        vertex: usize,
        /// The number that is not a vertex.
        neighbour: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// A neighbour does not list the vertex back.
    #[error("vertex {vertex} lists the neighbour {neighbour}, which does not list {vertex} back")]
    OneSided {
        /// The vertex with the list.
        vertex: usize,
        /// The neighbour.
        neighbour: usize,
    },
    /// A parallel edge or a loop in `planar_code`.
    #[error(
        "vertex {vertex} lists {neighbour} again or itself; \
         planar_code cannot have parallel edges and loops, edge_code can"
    )]
    NotSimple {
        /// The vertex with the list.
        vertex: usize,
        /// The neighbour.
        neighbour: usize,
    },
    /// A vertex has an empty list.
    #[error("vertex {vertex} has no edge")]
    NoEdge {
        /// The vertex.
        vertex: usize,
    },
    /// The byte with the sizes is not valid.
    #[error("a length of {length_bytes} bytes and edges of {edge_bytes} bytes are not possible")]
    Sizes {
        /// The bytes of the length.
        length_bytes: u8,
        /// The bytes of each edge.
        edge_bytes: u8,
    },
    /// The body ends within an edge.
    #[error("the body ends in the middle of an edge")]
    HalfEdgeNumber,
    /// An edge's number is too high.
    #[error("vertex {vertex} lists edge {edge}; the world has {}, counted from 0", counted(*.edges, "edge"))]
    UnknownEdge {
        /// The vertex with the list.
        vertex: usize,
        /// The number that is not an edge.
        edge: u64,
        /// The number of edges.
        edges: usize,
    },
    /// There is an odd number of edge ends.
    #[error("the lists have {ends} edge ends; every edge has two")]
    OddEnds {
        /// Their number.
        ends: usize,
    },
    /// An edge is listed too often.
    #[error("edge {edge} is listed for the third time; every edge has two ends")]
    ThirdEnd {
        /// The edge.
        edge: u64,
    },
    /// The graph is not connected.
    #[error("the world is not connected: vertex {vertex} cannot be reached from 1")]
    NotConnected {
        /// The first vertex that cannot be reached.
        vertex: usize,
    },
    /// The graph has no edge or too many.
    #[error(transparent)]
    GraphError(#[from] GraphError),
}

/// Why an embedded graph cannot be written in a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlantriWriteError {
    /// A loop or a parallel edge.
    #[error(
        "world {world} has loops or parallel edges, which planar_code cannot have; use edge_code"
    )]
    NotSimple {
        /// The number of the world; the first is 1.
        world: usize,
    },
    /// More vertices than two bytes can number.
    #[error("world {world} has {vertices} vertices; planar_code goes up to 65535")]
    TooManyVertices {
        /// The number of the world; the first is 1.
        world: usize,
        /// The number of its vertices.
        vertices: usize,
    },
}
