//! The same embedded graph with other numbers.

use super::{Dart, EmbeddedGraph, NO_DART};

impl EmbeddedGraph {
    /// The same embedded graph with its vertices in the given order and the first dart of each as
    /// given, and the new number of each dart. `None` unless `firsts` names exactly one dart of
    /// every vertex.
    pub fn relabelled(&self, firsts: &[Dart]) -> Option<(Self, Vec<Dart>)> {
        let mut order = Vec::with_capacity(self.dart_count());
        let mut taken = vec![false; self.vertex_count()];
        for &first in firsts {
            let vertex = self.darts.get(first.at())?.vertex;
            if std::mem::replace(&mut taken[vertex.at()], true) {
                return None;
            }
            let around = std::iter::successors(Some(first), |&dart| Some(self.clockwise(dart)));
            order.extend(around.take(self.degree(vertex) as usize));
        }
        let is_whole = order.len() == self.dart_count();
        is_whole.then(|| self.rearranged(&order, |dart| self.opposite(dart)))
    }

    /// The same embedded graph with its darts in the given order, as in [`rearranged`](Self::rearranged).
    pub(crate) fn renumbered(&self, order: &[Dart]) -> Self {
        self.rearranged(order, |dart| self.opposite(dart)).0
    }

    /// The embedded graph of some vertices with the given opposites, and the new number of each dart. The order
    /// has all darts of each vertex side by side, clockwise. Darts that are not in it have the number [`NO_DART`].
    pub(super) fn rearranged(
        &self,
        order: &[Dart],
        opposite: impl Fn(Dart) -> Dart,
    ) -> (Self, Vec<Dart>) {
        let mut number = vec![NO_DART; self.dart_count()];
        let mut degrees = Vec::with_capacity(self.vertex_count());
        let mut last = None;
        for (place, &dart) in order.iter().enumerate() {
            number[dart.at()] = Dart(place as u32);
            let vertex = self.vertex(dart);
            if last.replace(vertex) != Some(vertex) {
                degrees.push(self.degree(vertex));
            }
        }
        let opposites = order.iter().map(|&dart| number[opposite(dart).at()]).collect();
        (Self::from_degrees(&degrees, opposites), number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_graph::by_edges;

    /// That the copy is isomorphic is a test of `isomorphism`.
    #[test]
    fn an_order_names_one_dart_of_every_vertex() {
        let graph = by_edges("u: a b a | v: b c | w: c");
        let (_, number) = graph.relabelled(&[Dart(5), Dart(4), Dart(1)]).unwrap();
        assert_eq!(number[5], Dart(0));
        for unfit in [&[Dart(5), Dart(4)][..], &[Dart(5), Dart(4), Dart(3)], &[Dart(6); 3]] {
            assert_eq!(graph.relabelled(unfit), None);
        }
    }
}
