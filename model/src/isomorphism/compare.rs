//! Compares two embedded graphs: they are isomorphic, mirror images, or there is a first difference.

use std::fmt;

use super::{Bijection, Canonical, canonical};
use crate::{
    counts::{counted, grouped, vertices},
    embedded_graph::{Dart, EmbeddedGraph},
};

/// A difference that shows that two embedded graphs are not isomorphic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    Edges(usize, usize),
    Vertices(usize, usize),
    /// Different numbers of vertices of some degree; the highest such degree.
    Degrees {
        degree: u32,
        vertices: (usize, usize),
    },
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
            Self::Edges(one, other) => {
                write!(out, "{} against {}", counted(*one, "edge"), grouped(*other as u128))
            }
            Self::Vertices(one, other) => {
                write!(out, "{} against {}", vertices(*one), grouped(*other as u128))
            }
            Self::Degrees { degree, vertices: (one, other) } => {
                let (one, other) = (vertices(*one), grouped(*other as u128));
                write!(out, "{one} of degree {degree} against {other}")
            }
            Self::Genus(one, other) => write!(out, "genus {one} against {other}"),
            Self::Orders => write!(out, "the orders around the vertices differ"),
        }
    }
}

/// The isomorphism of one embedded graph onto another, or the first difference.
///
/// # Errors
/// Returns the first [`Difference`] if they are not isomorphic.
// paper: fig1.different
pub fn isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Result<Bijection, Difference> {
    let different = || Difference::between(one, other);
    match by_rare_darts(one, other) {
        RareDartMatch::Same(bijection) => Ok(bijection),
        RareDartMatch::Different => Err(different()),
        RareDartMatch::TooManyCandidates => {
            bijection(&canonical(one), &canonical(other)).ok_or_else(different)
        }
    }
}

/// The result of a comparison by rare darts.
enum RareDartMatch {
    Same(Bijection),
    Different,
    TooManyCandidates,
}

/// The most candidates that are tried one by one, each in linear time.
const CANDIDATES: usize = 16;

/// Darts whose surroundings look alike have the same colour; an isomorphism keeps colours, so a dart
/// of the rarest one can only go to the few others of it.
fn by_rare_darts(one: &EmbeddedGraph, other: &EmbeddedGraph) -> RareDartMatch {
    let (of_one, of_other) = (colours(one), colours(other));
    let sorted = |colours: &[u64]| {
        let mut sorted = colours.to_vec();
        sorted.sort_unstable();
        sorted
    };
    let all = sorted(&of_one);
    if all != sorted(&of_other) {
        return RareDartMatch::Different;
    }
    let rarest = all.chunk_by(|a, b| a == b).min_by_key(|alike| alike.len());
    let Some(alike) = rarest.filter(|alike| alike.len() <= CANDIDATES) else {
        return RareDartMatch::TooManyCandidates;
    };
    let Some(from) = one.darts().find(|dart| of_one[dart.at()] == alike[0]) else {
        return RareDartMatch::Different;
    };
    other
        .darts()
        .filter(|dart| of_other[dart.at()] == alike[0])
        .map(|to| Bijection::of_starts((one, from), (other, to)))
        .find(|bijection| bijection.verify(one, other))
        .map_or(RareDartMatch::Different, RareDartMatch::Same)
}

/// A number for each dart that depends only on its surroundings, a few steps deep.
fn colours(graph: &EmbeddedGraph) -> Vec<u64> {
    let mut colours: Vec<u64> =
        graph.darts().map(|dart| u64::from(graph.degree(graph.vertex(dart)))).collect();
    for _ in 0..8 {
        let mixed = |dart| {
            let parts = [dart, graph.clockwise(dart), graph.opposite(dart)];
            parts.iter().fold(0_u64, |mix, part| {
                (mix ^ colours[part.at()]).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29)
            })
        };
        colours = graph.darts().map(mixed).collect();
    }
    colours
}

/// The isomorphism of one embedded graph onto the [mirror image](EmbeddedGraph::mirror_image) of
/// the other; `None` if they are not mirror images.
pub fn mirror_isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Option<Bijection> {
    isomorphism(one, &other.mirror_image()).ok()
}

/// Dart by dart along the least starts, if these have the same code.
fn bijection(one: &Canonical, other: &Canonical) -> Option<Bijection> {
    (one.code == other.code).then(|| {
        let mut image = vec![Dart(0); one.order.len()];
        for (&from, &to) in one.order.iter().zip(&other.order) {
            image[from.at()] = to;
        }
        Bijection::claimed(image)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle_with_a_tail(edges: usize) -> EmbeddedGraph {
        let name = |edge: usize| format!("e{}", edge % edges);
        let around = |vertex: usize| (format!("v{vertex}"), vec![name(vertex), name(vertex + 1)]);
        let mut lists: Vec<_> = (0..edges).map(around).collect();
        lists[0].1.push("tail".to_owned());
        lists.push(("end".to_owned(), vec!["tail".to_owned()]));
        EmbeddedGraph::from_edge_lists(&lists).unwrap()
    }

    /// A rare dart leaves few candidates; where every dart looks like many others, the canonical
    /// forms are compared.
    #[test]
    fn worlds_with_a_rare_dart_are_compared_by_it() {
        let graph = cycle_with_a_tail(30);
        assert!(matches!(by_rare_darts(&graph, &graph), RareDartMatch::Same(_)));
        assert!(matches!(by_rare_darts(&graph, &cycle_with_a_tail(31)), RareDartMatch::Different));
        let lists = [("u", vec!["a", "b", "c"]), ("v", vec!["a", "b", "c"])];
        let theta = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        assert!(matches!(by_rare_darts(&theta, &theta), RareDartMatch::Same(_)));
        let name = |edge: usize| (edge % 30).to_string();
        let around = |vertex: usize| (name(vertex), vec![name(vertex), name(vertex + 1)]);
        let lists: Vec<_> = (0..30).map(around).collect();
        let cycle = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        assert!(matches!(by_rare_darts(&cycle, &cycle), RareDartMatch::TooManyCandidates));
        assert!(isomorphism(&cycle, &cycle).unwrap().verify(&cycle, &cycle));
    }
}
