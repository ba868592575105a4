//! A graph without some passages: edges replaced by two dead ends each.

use petgraph::visit::VisitMap;

use super::{Dart, EmbeddedGraph, NO_DART};

impl EmbeddedGraph {
    /// The graph in which the edges of some darts are cut into two dead ends each, as far as a robot can come
    /// from a dart, and the number there of each dart that it can come to.
    #[must_use]
    pub fn cut(&self, edges: &[Dart], start: Dart) -> (Self, Vec<Option<Dart>>) {
        let is_cut = |dart: Dart| edges.contains(&dart) || edges.contains(&self.opposite(dart));
        let mut degrees: Vec<u32> = self.vertices().map(|vertex| self.degree(vertex)).collect();
        let mut opposite: Vec<Dart> = self.darts().map(|dart| self.opposite(dart)).collect();
        for dart in self.darts().filter(|&dart| is_cut(dart)) {
            opposite[dart.at()] = Dart(opposite.len() as u32);
            opposite.push(dart);
            degrees.push(1);
        }
        let whole = Self::from_degrees(&degrees, opposite);
        let reached = whole.reached(whole.vertex(start));
        let vertices = whole.vertices().filter(|vertex| reached.is_visited(vertex));
        let order: Vec<Dart> = vertices.flat_map(|vertex| whole.darts_of(vertex)).collect();
        let (graph, numbers) = whole.rearranged(&order, |dart| whole.opposite(dart));
        let numbers = numbers[..self.dart_count()].iter();
        (graph, numbers.map(|&number| (number != NO_DART).then_some(number)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_ring_is_a_chain_and_a_cut_chain_is_its_near_part() {
        let (chain, numbers) = EmbeddedGraph::cycle(3).cut(&[Dart(0)], Dart(2));
        assert_eq!((chain.vertex_count(), chain.edge_count()), (5, 4));
        assert!(numbers.iter().all(Option::is_some));
        let end = numbers[0].unwrap();
        assert_eq!(chain.degree_around(chain.opposite(end)), 1);
        let (near, numbers) = chain.cut(&[end], end);
        assert_eq!((near.vertex_count(), near.edge_count()), (5, 4));
        assert!(numbers.iter().filter(|number| number.is_none()).count() == 1);
    }
}
