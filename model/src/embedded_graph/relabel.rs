//! The same embedded graph with other numbers.

use super::{Dart, EmbeddedGraph};

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
        (order.len() == self.dart_count()).then(|| {
            let mut number = vec![Dart(u32::MAX); order.len()];
            for (place, dart) in order.iter().enumerate() {
                number[dart.at()] = Dart(place as u32);
            }
            (self.renumbered(&order), number)
        })
    }

    /// The same embedded graph with its darts in the given order, in which the darts of each vertex
    /// stand side by side, clockwise.
    pub(crate) fn renumbered(&self, order: &[Dart]) -> Self {
        let mut number = vec![Dart(u32::MAX); order.len()];
        let mut degrees = Vec::with_capacity(self.vertex_count());
        let mut last = None;
        for (place, &dart) in order.iter().enumerate() {
            number[dart.at()] = Dart(place as u32);
            let vertex = self.vertex(dart);
            if last.replace(vertex) != Some(vertex) {
                degrees.push(self.degree(vertex));
            }
        }
        let opposite = order.iter().map(|&dart| number[self.opposite(dart).at()]).collect();
        Self::from_degrees(&degrees, opposite)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relabelling_keeps_the_orders() {
        let lists = [("u", vec!["a", "b", "a"]), ("v", vec!["b", "c"]), ("w", vec!["c"])];
        let graph = EmbeddedGraph::from_edge_lists(&lists).unwrap();
        let (relabelled, number) = graph.relabelled(&[Dart(5), Dart(4), Dart(1)]).unwrap();
        for dart in graph.darts() {
            let image = number[dart.at()];
            assert_eq!(relabelled.opposite(image), number[graph.opposite(dart).at()]);
            assert_eq!(relabelled.clockwise(image), number[graph.clockwise(dart).at()]);
        }
        assert_eq!(number[5], Dart(0));
        for unfit in [&[Dart(5), Dart(4)][..], &[Dart(5), Dart(4), Dart(3)], &[Dart(6); 3]] {
            assert_eq!(graph.relabelled(unfit), None);
        }
    }
}
