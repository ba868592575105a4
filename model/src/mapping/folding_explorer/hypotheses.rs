//! What is known about hypotheses: which are refuted, and one that is alive for each pending place.

use crate::clone_in_place::clone_in_place;
use crate::embedded_graph::Dart;

/// What is known about the hypotheses that the place behind one dart of the map is entered by another.
#[derive(Debug, Default)]
pub(super) struct Hypotheses {
    /// One bit for each pair of darts of the map. A refuted hypothesis stays refuted, because a trail
    /// only grows.
    refuted: Vec<u64>,
    /// For each dart of the map, a hypothesis about its far end, and the number of moves after which it was alive.
    witness: Vec<Option<Witness>>,
}

clone_in_place!(Hypotheses { refuted, witness });

/// A hypothesis that was alive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Witness {
    pub(super) hypothesis: Dart,
    /// The moves made by then.
    pub(super) moves: usize,
}

/// A number for each pair, so that those of the first `n` darts are the first `n^2`.
fn index(edge: Dart, hypothesis: Dart) -> usize {
    let (edge, hypothesis) = (edge.at(), hypothesis.at());
    if edge < hypothesis { hypothesis * hypothesis + edge } else { edge * edge + edge + hypothesis }
}

impl Hypotheses {
    pub(super) fn clear(&mut self) {
        self.refuted.clear();
        self.witness.clear();
    }

    #[inline]
    pub(super) fn is_refuted(&self, edge: Dart, hypothesis: Dart) -> bool {
        let index = index(edge, hypothesis);
        self.refuted.get(index / 64).is_some_and(|bits| bits >> (index % 64) & 1 == 1)
    }

    pub(super) fn refute(&mut self, edge: Dart, hypothesis: Dart) {
        let index = index(edge, hypothesis);
        if self.refuted.len() <= index / 64 {
            self.refuted.resize(index / 64 + 1, 0);
        }
        self.refuted[index / 64] |= 1 << (index % 64);
    }

    pub(super) fn witness(&self, edge: Dart) -> Option<Witness> {
        *self.witness.get(edge.at())?
    }

    pub(super) fn set_witness(&mut self, edge: Dart, witness: Option<Witness>) {
        if self.witness.len() <= edge.at() {
            self.witness.resize(edge.at() + 1, None);
        }
        self.witness[edge.at()] = witness;
    }
}
