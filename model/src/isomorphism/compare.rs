//! Compares two embedded graphs: they are isomorphic, mirror images, or there is a first difference.

use thiserror::Error;

use super::{Bijection, code, code::Numbering};
use crate::{
    counts::{self, counted, grouped},
    embedded_graph::EmbeddedGraph,
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
/// Darts whose surroundings look alike have the same colour; an isomorphism keeps colours, so a dart
/// of the rarest one can only go to the few others of it.
///
/// # Errors
/// Returns the first [`Difference`] if they are not isomorphic.
// paper: fig1.different
pub fn isomorphism(one: &EmbeddedGraph, other: &EmbeddedGraph) -> Result<Bijection, Difference> {
    let differ = || Difference::between(one, other);
    let (of_one, of_other) = (colours(one), colours(other));
    let [sorted, of_other_sorted] = [&of_one, &of_other].map(|colours| {
        let mut sorted = colours.clone();
        sorted.sort_unstable();
        sorted
    });
    if sorted != of_other_sorted {
        return Err(differ());
    }
    let rarest = sorted.chunk_by(|a, b| a == b).min_by_key(|alike| alike.len());
    let is_rarest = |colour: &u64| rarest.is_some_and(|alike| alike[0] == *colour);
    let from = one.darts().find(|dart| is_rarest(&of_one[dart.at()])).ok_or_else(differ)?;
    let code = code(one, from);
    let mut numbering = Numbering::new(other);
    let mut alike = other.darts().filter(|dart| is_rarest(&of_other[dart.at()]));
    let to = alike.find(|&to| numbering.words(other, to).eq(code.words().iter().copied()));
    Ok(Bijection::of_starts((one, from), (other, to.ok_or_else(differ)?)))
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

    /// A rare dart leaves few candidates. In a cycle every dart looks like all others.
    #[test]
    fn worlds_with_and_without_a_rare_dart_are_compared() {
        let [pan, larger_pan] = [30, 31].map(cycle_with_a_tail);
        assert!(isomorphism(&pan, &larger_pan).is_err());
        for graph in [pan, EmbeddedGraph::cycle(30)] {
            assert!(isomorphism(&graph, &graph).unwrap().verify(&graph, &graph));
        }
    }
}
