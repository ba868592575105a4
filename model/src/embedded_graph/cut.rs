//! A graph without some passages: edges replaced by two dead ends each.

use super::{Dart, EmbeddedGraph};

impl EmbeddedGraph {
    /// The graph in which the edges of some darts are cut into two dead ends each, as far as a robot can come
    /// from a dart, and the number there of each dart that it can come to.
    pub fn cut(&self, edges: &[Dart], start: Dart) -> Option<(Self, Vec<Option<Dart>>)> {
        let count = self.dart_count() as u32;
        let is_cut = |dart: Dart| edges.contains(&dart) || edges.contains(&self.opposite(dart));
        let ends: Vec<Dart> = self.darts().filter(|&dart| is_cut(dart)).collect();
        // The darts of the dead ends are the last ones.
        let opposite = |dart: u32| match dart.checked_sub(count) {
            Some(end) => ends[end as usize].0,
            None => match ends.binary_search(&Dart(dart)) {
                Ok(end) => count + end as u32,
                Err(_) => self.opposite(Dart(dart)).0,
            },
        };
        let clockwise = |dart: u32| if dart < count { self.clockwise(Dart(dart)).0 } else { dart };
        let mut found = vec![None; count as usize + ends.len()];
        let mut darts = vec![start.0];
        found[start.at()] = Some(0);
        let mut next = 0;
        while let Some(&dart) = darts.get(next) {
            next += 1;
            for dart in [opposite(dart), clockwise(dart)] {
                if found[dart as usize].is_none() {
                    found[dart as usize] = Some(darts.len() as u32);
                    darts.push(dart);
                }
            }
        }
        let renumbered = |dart: u32| found[dart as usize].unwrap_or_default();
        let opposites: Vec<u32> = darts.iter().map(|&dart| renumbered(opposite(dart))).collect();
        let clockwises: Vec<u32> = darts.iter().map(|&dart| renumbered(clockwise(dart))).collect();
        let (graph, number) = Self::from_permutations(&opposites, &clockwises).ok()?;
        let numbers = found[..count as usize].iter().map(|found| Some(number[(*found)? as usize]));
        Some((graph, numbers.collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_ring_is_a_chain_and_a_cut_chain_is_its_near_part() {
        let ring = EmbeddedGraph::from_neighbour_lists(&[
            ("a", vec!["c", "b"]),
            ("b", vec!["a", "c"]),
            ("c", vec!["b", "a"]),
        ]);
        let ring = ring.unwrap();
        let (chain, numbers) = ring.cut(&[Dart(0)], Dart(2)).unwrap();
        assert_eq!((chain.vertex_count(), chain.edge_count()), (5, 4));
        assert!(numbers.iter().all(Option::is_some));
        let end = numbers[0].unwrap();
        assert_eq!(chain.degree_around(chain.opposite(end)), 1);
        let (near, numbers) = chain.cut(&[end], end).unwrap();
        assert_eq!((near.vertex_count(), near.edge_count()), (5, 4));
        assert!(numbers.iter().filter(|number| number.is_none()).count() == 1);
    }
}
