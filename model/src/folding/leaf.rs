//! Leaves of a folded trail: places that the robot has only looked at. What follows if one is a known place
//! is seen without a union.

use super::FoldedTrail;
use crate::{embedded_graph::Dart, percept::Sighting};

impl FoldedTrail {
    /// Whether a dart is the only one at its vertex that is not open, and the vertex has neither a marker nor
    /// [numbers](Self::set_numbers).
    pub(crate) fn is_leaf(&self, dart: Dart) -> bool {
        let leaf = self.root_of(dart);
        self.number(leaf).is_none()
            && self.sighting(leaf) == Sighting::Nothing
            && self.darts_around(leaf).all(|dart| (dart == leaf) != self.classes.is_open(dart.0))
    }

    /// Whether a [leaf](Self::is_leaf) can be united with a dart, and no other identification follows: the dart
    /// is open, at a vertex of the same degree without a marker, and what was sensed of both agrees.
    #[inline]
    pub(crate) fn takes_leaf(&self, dart: Dart, leaf: Dart) -> bool {
        self.opposite(dart).is_none()
            && self.degree(dart) == self.degree(leaf)
            && self.sighting(dart) == Sighting::Nothing
            && self.senses_agree(dart, leaf)
    }

    /// Visits the darts that a union of a leaf with a dart that [takes it](Self::takes_leaf) would close, with
    /// the [numbers](Self::number) of their opposites after it.
    #[inline]
    pub(crate) fn for_each_closed_by_leaf(
        &self,
        leaf: Dart,
        dart: Dart,
        mut visit: impl FnMut(Dart, Option<u32>),
    ) {
        let [leaf, dart] = [leaf, dart].map(|dart| self.root_of(dart));
        // The leaf itself gets the number of the dart.
        let number = |far| if far == leaf { self.number(dart) } else { self.number(far) };
        if let Some(far) = self.opposite(leaf) {
            visit(dart, number(far));
        }
        let (mut at_leaf, mut at_dart) = (leaf, dart);
        for _ in 1..self.degree(leaf) {
            [at_leaf, at_dart] =
                [at_leaf, at_dart].map(|root| Dart(self.classes.next_around(root.0)));
            if !self.classes.is_open(at_dart.0)
                && let Some(far) = self.opposite(at_dart)
            {
                visit(at_leaf, number(far));
            }
        }
    }
}
