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

mod error;
mod read;
mod write;

use std::path::Path;

pub use error::{PlantriError, PlantriErrorKind, PlantriWriteError};
pub use read::{Worlds, read, read_headerless};
pub use write::write;

/// One of plantri's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlantriCode {
    Planar,
    /// Lists of edges; all graphs.
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

#[cfg(test)]
mod tests;
