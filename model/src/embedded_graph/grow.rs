//! An embedded graph in the making: vertices with free darts, joined one edge at a time.
//!
//! For the modules of this crate that build graphs step by step. They never expose an unfinished one.

use super::{Dart, DartPlace, Darts, EmbeddedGraph, NO_DART, Vertex};

impl EmbeddedGraph {
    pub(crate) fn unfinished() -> Self {
        Self { darts_of: Vec::new(), darts: Vec::new() }
    }

    pub(crate) fn clear(&mut self) {
        self.darts_of.clear();
        self.darts.clear();
    }

    pub(crate) fn reserve(&mut self, vertices: usize, darts: usize) {
        self.darts_of.reserve_exact(vertices);
        self.darts.reserve_exact(darts);
    }

    /// Adds a vertex with the given number of free darts.
    pub(crate) fn add_vertex(&mut self, degree: u32) -> Vertex {
        let vertex = Vertex(self.darts_of.len() as u32);
        let first = self.darts.len() as u32;
        let around = Darts { first, end: first + degree };
        self.darts_of.push(around);
        self.darts.resize(around.end as usize, DartPlace { opposite: NO_DART, vertex, around });
        vertex
    }

    pub(crate) fn join(&mut self, one: Dart, other: Dart) {
        self.darts[one.at()].opposite = other;
        self.darts[other.at()].opposite = one;
    }

    pub(crate) fn unjoin(&mut self, one: Dart, other: Dart) {
        self.darts[one.at()].opposite = NO_DART;
        self.darts[other.at()].opposite = NO_DART;
    }

    /// Undoes the latest [`add_vertex`](Self::add_vertex). Its darts are free.
    pub(crate) fn remove_vertex(&mut self) {
        if let Some(Darts { first, .. }) = self.darts_of.pop() {
            self.darts.truncate(first as usize);
        }
    }

    /// Adds an edge behind the last vertex, which is a dead end. Its other end is a dead end, too.
    pub(crate) fn lengthen_dead_end(&mut self) {
        let end = Dart(self.darts.len() as u32 - 1);
        let before = self.opposite(end);
        self.unjoin(before, end);
        self.remove_vertex();
        for degree in [2, 1] {
            let _: Vertex = self.add_vertex(degree);
        }
        self.join(before, end);
        self.join(Dart(end.0 + 1), Dart(end.0 + 2));
    }

    /// The dart's opposite; `None` while it is free.
    #[inline]
    pub(crate) fn joined(&self, dart: Dart) -> Option<Dart> {
        let other = self.darts[dart.at()].opposite;
        (other != NO_DART).then_some(other)
    }

    #[inline]
    pub(crate) fn first_dart(&self, vertex: Vertex) -> Dart {
        Dart(self.darts_of[vertex.at()].first)
    }
}
