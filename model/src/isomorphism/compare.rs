//! Are two embedded graphs isomorphic, mirror images, or what is the first difference?

use std::fmt;

use super::{Bijection, Canonical, canonical};
use crate::embedded_graph::{Dart, EmbeddedGraph};

/// A difference that shows that two embedded graphs are not isomorphic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// Different numbers of edges.
    Edges(usize, usize),
    /// Different numbers of vertices.
    Vertices(usize, usize),
    /// Different numbers of vertices of some degree; the highest such degree.
    Degrees {
        /// The degree.
        degree: u32,
        /// How many vertices of the one and of the other have it.
        vertices: (usize, usize),
    },
    /// Different genus.
    Genus(usize, usize),
    /// All those numbers agree, but the orders around the vertices do not: no start of the one has
    /// the code of any start of the other.
    Orders,
}

impl Difference {
    /// The first difference that a reader would look for; [`Orders`](Self::Orders) if no number
    /// differs.
    fn between(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Self {
        let count = |graph: &EmbeddedGraph, degree: u32| {
            graph.vertices().filter(|&vertex| graph.degree(vertex) == degree).count()
        };
        let highest = one.vertices().map(|vertex| one.degree(vertex)).max();
        let highest = highest.max(other.vertices().map(|vertex| other.degree(vertex)).max());
        if one.edge_count() != other.edge_count() {
            return Self::Edges(one.edge_count(), other.edge_count());
        }
        if one.vertex_count() != other.vertex_count() {
            return Self::Vertices(one.vertex_count(), other.vertex_count());
        }
        for degree in (1..=highest.unwrap_or_default()).rev() {
            let vertices = (count(one, degree), count(other, degree));
            if vertices.0 != vertices.1 {
                return Self::Degrees { degree, vertices };
            }
        }
        if one.genus() != other.genus() {
            return Self::Genus(one.genus(), other.genus());
        }
        Self::Orders
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Edges(one, other) => write!(out, "{one} edges against {other}"),
            Self::Vertices(one, other) => write!(out, "{one} vertices against {other}"),
            Self::Degrees { degree, vertices: (one, other) } => {
                write!(out, "{one} vertices of degree {degree} against {other}")
            }
            Self::Genus(one, other) => write!(out, "genus {one} against {other}"),
            Self::Orders => write!(out, "the orders around the vertices differ"),
        }
    }
}

/// The isomorphism of one embedded graph onto another, or the first difference.
///
/// # Errors
/// The [`Difference`], where they are not isomorphic.
// paper: fig1.different
pub fn isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Result<Bijection, Difference> {
    let different = || Difference::between(one, other);
    if one.dart_count() != other.dart_count() || one.vertex_count() != other.vertex_count() {
        return Err(different());
    }
    bijection(&canonical(one), &canonical(other)).ok_or_else(different)
}

/// The isomorphism of one embedded graph onto the [mirror image](EmbeddedGraph::mirror_image) of
/// the other; `None` where they are not mirror images.
#[must_use]
pub fn mirror_isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Option<Bijection> {
    isomorphism(one, &other.mirror_image()).ok()
}

/// Dart by dart along the least starts, where these have the same code.
fn bijection(one: &Canonical, other: &Canonical) -> Option<Bijection> {
    (one.code == other.code).then(|| {
        let mut image = vec![Dart(0); one.order.len()];
        for (&from, &to) in one.order.iter().zip(&other.order) {
            image[from.at()] = to;
        }
        Bijection::claimed(image)
    })
}
