//! Compares two embedded graphs: they are isomorphic, mirror images, or there is a first difference.

use thiserror::Error;

use super::{Bijection, Canonical, canonical};
use crate::{
    counts::{self, counted, grouped},
    embedded_graph::{Dart, EmbeddedGraph},
};

/// A difference that shows that two embedded graphs are not isomorphic.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Difference {
    #[error("{} against {}", counted(*.0, "edge"), grouped(*.1 as u128))]
    Edges(usize, usize),
    #[error("{} against {}", counts::vertices(*.0), grouped(*.1 as u128))]
    Vertices(usize, usize),
    /// Different numbers of vertices of some degree; the highest such degree.
    #[error("{} of degree {degree} against {}", counts::vertices(.vertices.0), grouped(.vertices.1 as u128))]
    Degrees { degree: u32, vertices: (usize, usize) },
    #[error("genus {0} against {1}")]
    Genus(usize, usize),
    /// All those numbers agree, but the orders around the vertices do not: no start of the one has
    /// the code of any start of the other.
    #[error("the orders around the vertices differ")]
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

/// The isomorphism of one embedded graph onto another, or the first difference.
///
/// # Errors
/// Returns the first [`Difference`] if they are not isomorphic.
// paper: fig1.different
pub fn isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Result<Bijection, Difference> {
    by_rare_darts(one, other)
        .unwrap_or_else(|TooManyCandidates| bijection(&canonical(one), &canonical(other)))
        .ok_or_else(|| Difference::between(one, other))
}

#[derive(Debug)]
struct TooManyCandidates;

/// The most candidates that are tried one by one, each in linear time.
const CANDIDATES: usize = 16;

/// Darts whose surroundings look alike have the same colour; an isomorphism keeps colours, so a dart
/// of the rarest one can only go to the few others of it.
fn by_rare_darts(
    one: &EmbeddedGraph,
    other: &EmbeddedGraph,
) -> Result<Option<Bijection>, TooManyCandidates> {
    let (of_one, of_other) = (colours(one), colours(other));
    let sorted = |colours: &[u64]| {
        let mut sorted = colours.to_vec();
        sorted.sort_unstable();
        sorted
    };
    let all = sorted(&of_one);
    if all != sorted(&of_other) {
        return Ok(None);
    }
    let rarest = all.chunk_by(|a, b| a == b).min_by_key(|alike| alike.len());
    let alike = rarest.filter(|alike| alike.len() <= CANDIDATES).ok_or(TooManyCandidates)?;
    let Some(from) = one.darts().find(|dart| of_one[dart.at()] == alike[0]) else {
        return Ok(None);
    };
    let candidates = other.darts().filter(|dart| of_other[dart.at()] == alike[0]);
    let mut bijections = candidates.map(|to| Bijection::of_starts((one, from), (other, to)));
    Ok(bijections.find(|bijection| bijection.verify(one, other)))
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
        assert!(by_rare_darts(&graph, &graph).unwrap().is_some());
        assert!(by_rare_darts(&graph, &cycle_with_a_tail(31)).unwrap().is_none());
        let lists = [("u", vec!["a", "b", "c"]), ("v", vec!["a", "b", "c"])];
        let theta = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        assert!(by_rare_darts(&theta, &theta).unwrap().is_some());
        let cycle = EmbeddedGraph::cycle(30);
        assert!(by_rare_darts(&cycle, &cycle).is_err());
        assert!(isomorphism(&cycle, &cycle).unwrap().verify(&cycle, &cycle));
    }
}
