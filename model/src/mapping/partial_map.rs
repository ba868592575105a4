//! The map S while it is built, with the unexplored edges U. Section 2.3, Algorithm 1.

use crate::{
    clone_in_place::clone_in_place,
    embedded_graph::{Dart, EmbeddedGraph, NO_DART, Vertex},
    percept::{Door, Percept, Sighting},
};

/// The known part of the world.
///
/// Vertices are numbered in the order of discovery; the darts of a vertex are numbered clockwise from the
/// dart by which it was first entered, and at the start vertex, number 0, from the facing dart. A
/// dart whose other end is not known is *unexplored*: together these are U.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct PartialMap {
    known: EmbeddedGraph,
    /// U, in the order of the numbers.
    unexplored: Vec<Dart>,
}

clone_in_place!(PartialMap { known, unexplored });

/// The facing dart, along which the marker points.
pub const FACING: Dart = Dart(0);

/// The start vertex, at which the marker lies.
pub(super) const START: Vertex = Vertex(0);

impl PartialMap {
    pub(super) fn new() -> Self {
        Self { known: EmbeddedGraph::unfinished(), unexplored: Vec::new() }
    }

    pub(super) fn clear(&mut self) {
        self.known.clear();
        self.unexplored.clear();
    }

    pub(super) fn add_vertex(&mut self, degree: u32) -> Vertex {
        let vertex = self.known.add_vertex(degree);
        self.unexplored.extend(self.known.darts_of(vertex));
        vertex
    }

    pub(super) fn join(&mut self, one: Dart, other: Dart) {
        debug_assert!([one, other].into_iter().all(|end| self.is_unexplored(end)));
        self.known.join(one, other);
        self.unexplored.retain(|&dart| dart != one && dart != other);
    }

    pub fn vertex_count(&self) -> usize {
        self.known.vertex_count()
    }

    /// The number of known darts, explored or not.
    pub fn dart_count(&self) -> usize {
        self.known.dart_count()
    }

    /// The number of unexplored darts: the size of U.
    pub fn unexplored_count(&self) -> u32 {
        self.unexplored.len() as u32
    }

    #[inline]
    pub fn unexplored_is_empty(&self) -> bool {
        self.unexplored.is_empty()
    }

    /// U: the unexplored darts, in the order of their numbers.
    pub fn unexplored(&self) -> impl DoubleEndedIterator<Item = Dart> + '_ {
        self.unexplored.iter().copied()
    }

    #[inline]
    pub(crate) fn is_unexplored(&self, dart: Dart) -> bool {
        dart.at() < self.dart_count() && self.known.joined(dart).is_none()
    }

    /// The unexplored darts of one vertex, in the order of their numbers.
    pub fn unexplored_at(&self, vertex: Vertex) -> impl DoubleEndedIterator<Item = Dart> + '_ {
        let darts = self.known.darts_of(vertex);
        darts.filter(|&dart| self.known.joined(dart).is_none())
    }

    #[inline]
    pub(super) fn unexplored_count_at(&self, vertex: Vertex) -> u32 {
        self.unexplored_at(vertex).count() as u32
    }

    #[inline]
    pub(crate) fn is_frontier(&self, vertex: Vertex) -> bool {
        self.unexplored_at(vertex).next().is_some()
    }

    /// The other end of an explored dart; `None` for an unexplored one.
    #[inline]
    pub fn opposite(&self, dart: Dart) -> Option<Dart> {
        self.known.joined(dart)
    }

    /// For each dart of a vertex its opposite, or [`NO_DART`].
    #[inline]
    pub(super) fn opposites_of(&self, vertex: Vertex) -> impl ExactSizeIterator<Item = Dart> + '_ {
        self.known.opposites_of(vertex)
    }

    /// The opposites of the explored darts of a vertex, in the order of these.
    #[inline]
    pub(super) fn known_opposites(&self, vertex: Vertex) -> impl Iterator<Item = Dart> + '_ {
        self.opposites_of(vertex).filter(|&far| far != NO_DART)
    }

    #[inline]
    pub fn vertex(&self, dart: Dart) -> Vertex {
        self.known.vertex(dart)
    }

    #[inline]
    pub fn degree(&self, vertex: Vertex) -> u32 {
        self.known.degree(vertex)
    }

    #[inline]
    pub(super) fn degree_around(&self, dart: Dart) -> u32 {
        self.known.degree_around(dart)
    }

    /// The dart's place clockwise from the one by which its vertex was first entered.
    #[inline]
    pub fn index(&self, dart: Dart) -> u32 {
        self.known.index(dart)
    }

    pub fn dart(&self, vertex: Vertex, index: u32) -> Option<Dart> {
        self.known.dart(vertex, index)
    }

    /// The darts of a vertex in the order of their indices.
    pub fn darts_of(
        &self,
        vertex: Vertex,
    ) -> impl ExactSizeIterator<Item = Dart> + DoubleEndedIterator + use<> {
        self.known.darts_of(vertex)
    }

    /// The door that leads to the dart `to` for a robot that came in by `pose`, at the same vertex.
    #[inline]
    pub fn door(&self, pose: Dart, to: Dart) -> Door {
        let degree = self.known.degree_around(pose);
        Door::between(self.index(pose), self.index(to), degree)
    }

    /// The percept expected of a robot that comes in by the dart `pose`, if the directional marker lies
    /// at the start vertex.
    #[inline]
    pub fn expected(&self, pose: Dart) -> Percept {
        let sighting = if self.vertex(pose) == START {
            Sighting::Pointing(self.door(pose, FACING))
        } else {
            Sighting::Nothing
        };
        Percept { degree: self.known.degree_around(pose), sighting }
    }

    /// The percept expected of a robot that comes in by the dart `pose`, at a vertex without a marker.
    #[inline]
    pub(crate) fn unmarked(&self, pose: Dart) -> Percept {
        Percept { degree: self.known.degree_around(pose), sighting: Sighting::Nothing }
    }

    /// The map as an embedded graph, once nothing is unexplored. Its facing dart is [`FACING`].
    pub fn complete(&self) -> Option<&EmbeddedGraph> {
        (self.unexplored_is_empty() && self.vertex_count() > 0).then_some(&self.known)
    }

    /// The first dart of a vertex: the one by which it was first entered.
    #[inline]
    pub(super) fn first_dart(&self, vertex: Vertex) -> Dart {
        self.known.first_dart(vertex)
    }

    /// All known vertices in the order of discovery.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = Vertex> + DoubleEndedIterator + use<> {
        self.known.vertices()
    }
}
