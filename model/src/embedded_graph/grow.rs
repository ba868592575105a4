//! An embedded graph in the making: vertices with free darts, joined one edge at a time.
//!
//! For the rooms that build graphs step by step and take care that nobody sees an unfinished one.

use super::{Dart, EmbeddedGraph, Vertex};

/// Stands as the opposite of a free dart.
const FREE: Dart = Dart(u32::MAX);

impl EmbeddedGraph {
    /// No vertex at all, yet.
    pub(crate) fn unfinished() -> Self {
        Self {
            first: vec![0],
            vertex: Vec::new(),
            opposite: Vec::new(),
        }
    }

    /// Back to no vertex at all; keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.first.truncate(1);
        self.vertex.clear();
        self.opposite.clear();
    }

    /// Adds a vertex with the given number of free darts.
    pub(crate) fn add_vertex(&mut self, degree: u32) -> Vertex {
        let vertex = Vertex(self.first.len() as u32 - 1);
        let end = self.opposite.len() + degree as usize;
        self.vertex.resize(end, vertex);
        self.opposite.resize(end, FREE);
        self.first.push(end as u32);
        vertex
    }

    /// Makes two free darts the ends of one edge.
    pub(crate) fn join(&mut self, one: Dart, other: Dart) {
        self.opposite[one.at()] = other;
        self.opposite[other.at()] = one;
    }

    /// Whether the dart has no opposite yet.
    #[inline]
    pub(crate) fn is_free(&self, dart: Dart) -> bool {
        self.opposite[dart.at()] == FREE
    }

    /// The first dart of a vertex.
    #[inline]
    pub(crate) fn first_dart(&self, vertex: Vertex) -> Dart {
        Dart(self.first[vertex.at()])
    }
}
