//! Embedded graphs: the worlds that a robot explores. Section 2.1, "The world model".
//!
//! An embedded graph is an undirected connected graph with a clockwise order of the edge ends
//! around each vertex (a *rotation system*, a *combinatorial map*). Loops and parallel edges are
//! allowed.

mod construct;
mod cut;
mod fault;
mod grow;
mod petgraph_traits;
mod relabel;
mod smooth;

pub use fault::{GraphError, ListError, clockwise_fault, opposite_fault, size_fault};
pub use petgraph_traits::{EdgeView, PetgraphError, VisitedVertices};

use std::hash::{Hash, Hasher};

use crate::clone_in_place::clone_in_place;

/// One end of an edge, numbered `0 .. 2m` in a graph with `m` edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Dart(pub u32);

/// Stands for no dart, where an `Option` would take more memory.
pub(crate) const NO_DART: Dart = Dart(u32::MAX);

/// A vertex, numbered `0 .. n`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Vertex(pub u32);

impl Dart {
    pub fn at(self) -> usize {
        self.0 as usize
    }
}

impl Vertex {
    pub fn at(self) -> usize {
        self.0 as usize
    }
}

/// The most edges that an embedded graph may have: a dart's number, and one past it, fit in a `u32`.
pub const MAX_EDGES: usize = (u32::MAX / 4) as usize;

/// A connected embedded graph with at least one edge.
///
/// The darts of a vertex stand side by side in clockwise order, and the vertices one after the
/// other: `clockwise` is "the next number at the same vertex", and a door is an addition. Every
/// constructor numbers the darts in this way.
///
/// Two graphs are equal if they are isomorphic and have the same numbers.
// paper: world.graph, world.embedding
#[derive(Debug)]
pub struct EmbeddedGraph {
    darts_of: Vec<Darts>,
    darts: Vec<DartPlace>,
}

clone_in_place!(EmbeddedGraph { darts_of, darts });

// The vertices of the darts follow from `darts_of`.
impl PartialEq for EmbeddedGraph {
    fn eq(&self, other: &Self) -> bool {
        self.darts_of == other.darts_of
            && self.opposites().zip(other.opposites()).all(|(one, other)| one == other)
    }
}

impl Eq for EmbeddedGraph {}

impl Hash for EmbeddedGraph {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.darts_of.hash(state);
        self.opposites().for_each(|dart| dart.hash(state));
    }
}

/// All that is known of a dart, side by side, so that a motion needs one look-up.
#[derive(Clone, Copy, Debug)]
struct DartPlace {
    opposite: Dart,
    vertex: Vertex,
    /// The darts of its vertex, once more.
    around: Darts,
}

/// The darts of a vertex: consecutive numbers in clockwise order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Darts {
    first: u32,
    /// One past the last.
    end: u32,
}

impl Darts {
    #[inline]
    fn count(self) -> u32 {
        self.end - self.first
    }
}

impl EmbeddedGraph {
    pub fn vertex_count(&self) -> usize {
        self.darts_of.len()
    }

    pub fn edge_count(&self) -> usize {
        self.darts.len() / 2
    }

    pub fn dart_count(&self) -> usize {
        self.darts.len()
    }

    pub fn vertices(
        &self,
    ) -> impl ExactSizeIterator<Item = Vertex> + DoubleEndedIterator + Clone + use<> {
        (0..self.darts_of.len() as u32).map(Vertex)
    }

    pub fn darts(&self) -> impl ExactSizeIterator<Item = Dart> + Clone + use<> {
        (0..self.darts.len() as u32).map(Dart)
    }

    /// All edges, each as its two darts, the lower number first, in the order of the first.
    pub fn edges(&self) -> impl Iterator<Item = (Dart, Dart)> + '_ {
        self.darts().map(|dart| (dart, self.opposite(dart))).filter(|(dart, other)| dart < other)
    }

    /// For each dart, the number of its edge among [`edges`](Self::edges).
    pub(crate) fn edge_numbers(&self) -> Vec<u32> {
        let mut numbers = vec![0; self.dart_count()];
        for (number, (one, other)) in (0..).zip(self.edges()) {
            (numbers[one.at()], numbers[other.at()]) = (number, number);
        }
        numbers
    }

    /// The opposites of the darts of a vertex, in clockwise order.
    pub(crate) fn opposites_of(&self, vertex: Vertex) -> impl ExactSizeIterator<Item = Dart> + '_ {
        let Darts { first, end } = self.darts_of[vertex.at()];
        self.darts[first as usize..end as usize].iter().map(|place| place.opposite)
    }

    fn opposites(&self) -> impl ExactSizeIterator<Item = Dart> + '_ {
        self.darts.iter().map(|place| place.opposite)
    }

    #[inline]
    pub fn opposite(&self, dart: Dart) -> Dart {
        self.darts[dart.at()].opposite
    }

    #[inline]
    pub fn vertex(&self, dart: Dart) -> Vertex {
        self.darts[dart.at()].vertex
    }

    #[inline]
    pub fn degree(&self, vertex: Vertex) -> u32 {
        self.darts_of[vertex.at()].count()
    }

    /// The dart's place in the clockwise order of its vertex, counted from the vertex's first dart.
    #[inline]
    pub fn index(&self, dart: Dart) -> u32 {
        dart.0 - self.darts[dart.at()].around.first
    }

    /// The dart that stands `index` places clockwise from the vertex's first; the inverse of
    /// [`index`](Self::index). `None` if the vertex has fewer darts.
    pub fn dart(&self, vertex: Vertex, index: u32) -> Option<Dart> {
        let darts = self.darts_of[vertex.at()];
        (index < darts.count()).then(|| Dart(darts.first + index))
    }

    /// The darts of a vertex in clockwise order from its first.
    pub fn darts_of(
        &self,
        vertex: Vertex,
    ) -> impl ExactSizeIterator<Item = Dart> + DoubleEndedIterator + Clone + use<> {
        let Darts { first, end } = self.darts_of[vertex.at()];
        (first..end).map(Dart)
    }

    #[inline]
    pub fn clockwise(&self, dart: Dart) -> Dart {
        let darts = self.darts[dart.at()].around;
        if dart.0 + 1 == darts.end { Dart(darts.first) } else { Dart(dart.0 + 1) }
    }

    #[inline]
    pub fn counterclockwise(&self, dart: Dart) -> Dart {
        let darts = self.darts[dart.at()].around;
        if dart.0 == darts.first { Dart(darts.end - 1) } else { Dart(dart.0 - 1) }
    }

    #[inline]
    pub fn degree_around(&self, dart: Dart) -> u32 {
        self.darts[dart.at()].around.count()
    }

    /// The number of faces: the orbits of "cross the edge, then turn clockwise".
    pub fn face_count(&self) -> usize {
        let mut seen = vec![false; self.dart_count()];
        let mut faces = 0;
        for first in self.darts() {
            let mut dart = first;
            if !seen[dart.at()] {
                faces += 1;
            }
            while !std::mem::replace(&mut seen[dart.at()], true) {
                dart = self.clockwise(self.opposite(dart));
            }
        }
        faces
    }

    /// The genus of the surface on which the graph lies: 0 in the plane, 1 on the torus, ...
    /// (Euler: `n - m + faces = 2 - 2 genus`).
    pub fn genus(&self) -> usize {
        (2 + self.edge_count() - self.vertex_count() - self.face_count()) / 2
    }

    /// Whether the graph has neither a loop nor two edges between the same vertices.
    pub fn is_simple(&self) -> bool {
        // Both ends of a loop meet its own vertex.
        let mut last_met_from = vec![None; self.vertex_count()];
        self.vertices().all(|vertex| {
            self.darts_of(vertex).all(|dart| {
                let neighbour = self.vertex(self.opposite(dart));
                last_met_from[neighbour.at()].replace(vertex) != Some(vertex)
            })
        })
    }

    /// The mirror image: the same graph with every order reversed. The first dart of each vertex
    /// stays first, so that the dart with index `i` becomes the one with index `-i`.
    #[must_use]
    pub fn mirror_image(&self) -> Self {
        let image = |dart: Dart| {
            let darts = self.darts[dart.at()].around;
            if dart.0 == darts.first { dart } else { Dart(darts.end - self.index(dart)) }
        };
        let mut mirrored = self.clone();
        for (place, dart) in mirrored.darts.iter_mut().zip(self.darts()) {
            place.opposite = image(self.opposite(image(dart)));
        }
        mirrored
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_graph::{by_edges, by_neighbours};

    /// The two-vertex graph with three parallel edges, in the plane (`crossed` = false) and on the
    /// torus.
    fn theta(crossed: bool) -> EmbeddedGraph {
        by_edges(if crossed { "u: a b c | v: a b c" } else { "u: a b c | v: c b a" })
    }

    // paper: world.graph, world.embedding
    #[test]
    fn three_parallel_edges_lie_in_the_plane_or_on_the_torus() {
        assert_eq!((theta(false).face_count(), theta(false).genus()), (3, 0));
        assert_eq!((theta(true).face_count(), theta(true).genus()), (1, 1));
        assert!(!theta(true).is_simple() && !EmbeddedGraph::cycle(1).is_simple());
        assert!(EmbeddedGraph::chain(1).is_simple());
    }

    #[test]
    fn clockwise_and_counterclockwise_undo_each_other() {
        let graph = theta(true);
        for dart in graph.darts() {
            assert_eq!(graph.counterclockwise(graph.clockwise(dart)), dart);
            assert_eq!(graph.dart(graph.vertex(dart), graph.index(dart)), Some(dart));
        }
        assert_eq!(graph.dart(Vertex(0), 3), None);
    }

    #[test]
    fn the_mirror_image_of_the_mirror_image_is_the_graph() {
        let graph = by_neighbours("x: a b c d | a: x b | b: x a | c: x | d: x");
        let mirror = graph.mirror_image();
        assert_ne!(mirror, graph);
        assert_eq!(mirror.mirror_image(), graph);
        for dart in graph.darts() {
            assert_eq!(mirror.vertex(mirror.opposite(dart)), graph.vertex(mirror.opposite(dart)));
        }
        assert_eq!(mirror.genus(), graph.genus());
    }
}
