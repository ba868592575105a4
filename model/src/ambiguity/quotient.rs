//! The quotient of a placed world: its states up to indistinguishability.

use smallvec::SmallVec;

use super::{
    partition::coarsest,
    space::{PlacedRobot, Space, StateLabel, States},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{StartCode, code},
};

/// A placed world with indistinguishable states identified.
///
/// It is not an embedded graph: a crossing may stay in the same class, and the degree is only a label.
/// Any two of its classes are distinguishable, so its only automorphism is the identity.
pub(super) struct Quotient {
    labels: Vec<StateLabel>,
    maps: Vec<Vec<u32>>,
    /// The number of maps of each class.
    arities: Vec<usize>,
    /// The class of each state of the placed world.
    class: Vec<u32>,
}

/// The code of a class of a quotient. A search from that class numbers the classes. The code lists the label of
/// each class, and the numbers of the classes to which the maps lead. Two states, of any worlds, have the same code
/// exactly when they are indistinguishable.
pub(super) type QuotientCode = Vec<(StateLabel, SmallVec<[u32; 4]>)>;

impl Quotient {
    /// The quotient of the world of a start, and its states.
    pub(super) fn new(start: &PlacedRobot<'_>) -> (Self, States) {
        let space = Space::new(start);
        // Nothing stops it.
        let class = coarsest(&space.labels, &space.maps, &()).unwrap_or_default();
        let count = class.iter().max().map_or(0, |&last| last as usize + 1);
        let mut representative = vec![0; count];
        for (state, &class) in class.iter().enumerate() {
            representative[class as usize] = state;
        }
        let labels = representative.iter().map(|&state| space.labels[state]).collect();
        let arities = representative.iter().map(|&state| space.arities[state]).collect();
        let classes_after = |map: &Vec<u32>| {
            representative.iter().map(|&state| class[map[state] as usize]).collect()
        };
        let maps = space.maps.iter().map(classes_after).collect();
        (Self { labels, maps, arities, class }, space.states)
    }

    pub(super) fn classes(&self) -> &[u32] {
        &self.class
    }

    /// Whether no two states are indistinguishable.
    pub(super) fn is_discrete(&self) -> bool {
        self.labels.len() == self.class.len()
    }

    /// The code of the class of a state, given by the state's number.
    pub(super) fn code(&self, state: u32) -> QuotientCode {
        const UNMET: u32 = u32::MAX;
        let mut number = vec![UNMET; self.labels.len()];
        let root = self.class[state as usize];
        let mut met = vec![root];
        number[root as usize] = 0;
        let mut code = Vec::with_capacity(self.labels.len());
        let mut next = 0;
        while let Some(&class) = met.get(next) {
            next += 1;
            let mut leads_to = SmallVec::new();
            for map in &self.maps[..self.arities[class as usize]] {
                let after = map[class as usize];
                if number[after as usize] == UNMET {
                    number[after as usize] = met.len() as u32;
                    met.push(after);
                }
                leads_to.push(number[after as usize]);
            }
            code.push((self.labels[class as usize], leads_to));
        }
        code
    }
}

/// The code of a placed world, equal exactly for isomorphic ones: that of the least start whose facing dart is among
/// these. They all place the marker alike, and there is at least one.
pub(super) fn placed_code(
    graph: &EmbeddedGraph,
    alike: impl IntoIterator<Item = Dart>,
) -> StartCode {
    let codes = alike.into_iter().map(|facing| code(graph, facing));
    codes.min().unwrap_or_else(|| code(graph, Dart(0)))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::{
        aid::compass::{Compass, Directions},
        enumerate::{Class, Each, Enumeration},
        floor_plan::Direction,
        isomorphism::discovery_order,
        marker::Marker,
        world::GraphWorld,
    };

    /// The same for isomorphic worlds with directions.
    type DirectedCode = (StartCode, Vec<Direction>);

    /// All worlds with directions that are wanted, of 1 to so many edges: the edges and the least code of the quotient.
    fn with_compass(
        class: Class,
        most_edges: usize,
        is_wanted: impl Fn(&EmbeddedGraph, &Directions) -> bool,
    ) -> BTreeMap<DirectedCode, (usize, QuotientCode)> {
        let mut found = BTreeMap::new();
        for edges in 1..=most_edges {
            for graph in Enumeration::new(Each::World, class, edges).unwrap().graphs() {
                for directions in Directions::every(&graph) {
                    if !is_wanted(&graph, &directions) {
                        continue;
                    }
                    let directed = |dart| {
                        let order = discovery_order(&graph, dart).into_iter();
                        let shown = order.filter_map(|dart| directions.of(dart)).collect();
                        (code(&graph, dart), shown)
                    };
                    let least: DirectedCode = graph.darts().map(directed).min().unwrap();
                    let compass = Compass(&directions);
                    let aid = (&compass as &dyn Marker).into();
                    let (quotient, _) = Quotient::new(&GraphWorld::with_aid(&graph, aid, Dart(0)));
                    let seen = graph.darts().map(|dart| quotient.code(dart.0)).min().unwrap();
                    found.insert(least, (edges, seen));
                }
            }
        }
        found
    }

    /// For each number of edges, the worlds and those that are indistinguishable from another one; and the edges of the
    /// smallest pair, as `tests/oracle/compass.py` prints them.
    fn counts(
        worlds: &BTreeMap<DirectedCode, (usize, QuotientCode)>,
    ) -> (Vec<[usize; 2]>, Vec<usize>) {
        let mut alike: BTreeMap<&QuotientCode, Vec<usize>> = BTreeMap::new();
        for (edges, seen) in worlds.values() {
            alike.entry(seen).or_default().push(*edges);
        }
        let most = worlds.values().map(|(edges, _)| *edges).max().unwrap_or_default();
        let mut sizes = vec![[0; 2]; most];
        let mut smallest: Option<Vec<usize>> = None;
        for mut group in alike.into_values() {
            group.sort_unstable();
            for &edges in &group {
                sizes[edges - 1][0] += 1;
                sizes[edges - 1][1] += usize::from(group.len() > 1);
            }
            if let [one, other, ..] = group[..] {
                let pair = vec![other, one];
                smallest = Some(smallest.map_or(pair.clone(), |least| least.min(pair)));
            }
        }
        (sizes, smallest.unwrap_or_default())
    }

    /// The theorem of docs/aids.md: a compass, without any marker, identifies each world that can be drawn in the plane among
    /// these. The numbers of worlds are those of `tests/oracle/compass.py`.
    #[test]
    fn a_compass_distinguishes_all_worlds_that_are_drawn_in_the_plane() {
        let is_plane = |graph: &EmbeddedGraph, directions: &Directions| {
            let is_plane = directions.is_drawn_in_plane(graph);
            assert!(!is_plane || graph.genus() == 0);
            is_plane
        };
        let (sizes, pair) = counts(&with_compass(Class::Multigraph, 4, is_plane));
        assert_eq!(sizes, [[2, 0], [6, 0], [22, 0], [92, 0]]);
        assert!(pair.is_empty());
        let (sizes, pair) = counts(&with_compass(Class::Planar, 6, is_plane));
        assert_eq!(sizes[..5], [[2, 0], [6, 0], [22, 0], [92, 0], [420, 0]]);
        assert!(sizes[5][0] > 1000 && sizes[5][1] == 0, "{sizes:?}");
        assert!(pair.is_empty());
    }

    /// Elsewhere it does not: rings that run east all the way look alike.
    #[test]
    fn a_compass_does_not_distinguish_worlds_on_other_surfaces() {
        let (sizes, pair) = counts(&with_compass(Class::Multigraph, 4, |_, _| true));
        assert_eq!(sizes, [[4, 2], [15, 9], [60, 2], [300, 11]]);
        assert_eq!(pair, [2, 1]);
        let (_, pair) = counts(&with_compass(Class::Simple, 5, |_, _| true));
        assert_eq!(pair, [4, 3]);
    }
}
