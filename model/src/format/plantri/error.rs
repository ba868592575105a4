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
    #[source]
    pub cause: PlantriErrorKind,
}

/// What is wrong at a byte. Vertices are counted from 1 and edges from 0, as in the codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlantriErrorKind {
    #[error("there is no world")]
    Empty,
    #[error("unknown header; known are planar_code, planar_code le, planar_code be and edge_code")]
    UnknownHeader,
    #[error("the file ends in the middle of a world")]
    Truncated,
    #[error("vertex {vertex} lists the neighbour {neighbour}; the world has {}", counts::vertices(*.vertices))]
    UnknownNeighbour { vertex: usize, neighbour: usize, vertices: usize },
    #[error("vertex {vertex} lists the neighbour {neighbour}, which does not list {vertex} back")]
    OneSided { vertex: usize, neighbour: usize },
    #[error(
        "vertex {vertex} lists {neighbour} again or itself; \
         planar_code cannot have parallel edges and loops, edge_code can"
    )]
    NotSimple { vertex: usize, neighbour: usize },
    #[error("vertex {vertex} has no edge")]
    NoEdge { vertex: usize },
    #[error("a length of {length_bytes} bytes and edges of {edge_bytes} bytes are not possible")]
    Sizes { length_bytes: u8, edge_bytes: u8 },
    #[error("the body ends in the middle of an edge")]
    HalfEdgeNumber,
    #[error("vertex {vertex} lists edge {edge}; the world has {}, counted from 0", counted(*.edges, "edge"))]
    UnknownEdge { vertex: usize, edge: u64, edges: usize },
    #[error("the lists have {ends} edge ends; every edge has two")]
    OddEnds { ends: usize },
    #[error("edge {edge} is listed for the third time; every edge has two ends")]
    ThirdEnd { edge: u64 },
    #[error("the world is not connected: vertex {vertex} cannot be reached from 1")]
    NotConnected { vertex: usize },
    #[error(transparent)]
    GraphError(#[from] GraphError),
}

/// Why an embedded graph cannot be written in a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlantriWriteError {
    #[error(
        "world {world} has loops or parallel edges, which planar_code cannot have; use edge_code"
    )]
    NotSimple { world: usize },
    #[error("world {world} has {vertices} vertices; planar_code goes up to 65535")]
    TooManyVertices { world: usize, vertices: usize },
}
