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
