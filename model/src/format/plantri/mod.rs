//! plantri's binary codes for embedded graphs, `planar_code` and `edge_code`. Section 2.1.
//!
//! plantri (Brinkmann and McKay), nauty and graphtools (Van Cleemput) write and read them. Both codes
//! list the darts of each vertex clockwise, so they can represent graphs of any genus.
//!
//! **planar_code**, after the header `>>planar_code<<`: for each graph the number of vertices, and
//! for each vertex its neighbours, counted from 1, and a 0. Numbers have one byte; if the first is
//! 0, the same follows with numbers of two bytes. The headers `>>planar_code le<<` and
//! `>>planar_code be<<` give their order. With the bare header graphtools takes the lesser byte first
//! and nauty the greater one, so the reader takes the order in which the graph makes sense. Lists of
//! neighbours do not determine parallel edges or the ends of loops, so these are rejected; `edge_code`
//! does.
//!
//! **edge_code**, after the header `>>edge_code<<`: for each graph the length of its body in bytes,
//! and the body, in which each vertex lists its edges, counted from 0, with a byte 255 between
//! the lists. The length has one byte, and so has each edge; or it begins with a 0 and a byte 16 k + l,
//! and then the length has k bytes and each edge l bytes, the greatest byte first. No edge's first byte
//! is 255.

mod read;
mod write;

use std::path::Path;

use thiserror::Error;

pub use read::{Worlds, read, read_headerless};
pub use write::write;

use crate::{
    counts::{self, counted},
    embedded_graph::GraphError,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlantriCode {
    Planar,
    Edge,
}

impl PlantriCode {
    /// The code of a file, by its header or else by the ending of its name. `None` for a file of another
    /// kind.
    pub fn of_file(path: &Path, bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b">>edge_code") {
            return Some(Self::Edge);
        }
        if bytes.starts_with(b">>planar_code") {
            return Some(Self::Planar);
        }
        match path.extension()?.to_str()? {
            "ec" | "edge_code" => Some(Self::Edge),
            "pc" | "plc" | "planar_code" => Some(Self::Planar),
            _ => None,
        }
    }
}

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

#[cfg(test)]
mod tests;
