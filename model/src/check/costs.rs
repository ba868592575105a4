//! The runs of a start and their costs.

use smallvec::{SmallVec, smallvec};

/// All runs of Algorithm 1 on one start.
// paper: cost.shape-6, cost.shape-8
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EveryWay {
    /// Distinct states at line 4: the map, numbered by discovery, and the robot's vertex in it.
    pub states: u64,
    /// States at line 8: within a round, the hypotheses that are left.
    pub within_rounds: u64,
    /// Distinct sequences of choices. Stays at the largest `u128` if there are more.
    pub runs: u128,
    /// The numbers of moves that occur among the runs.
    pub costs: Costs,
    /// Why these are not all; `None` if they are.
    pub limit: Option<ChoicesLimit>,
}

/// A limit on the search for all runs of a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChoicesLimit {
    /// The budget of states, at line 4 and at line 8 together.
    States(u64),
    /// The memory for the states of one start: 1 GiB.
    Memory,
    Interrupted,
}

impl ChoicesLimit {
    /// Its name, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::States(_) => "max-states",
            Self::Memory => "memory",
            Self::Interrupted => "interrupted",
        }
    }
}

/// A set of small numbers, as bits.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Costs(SmallVec<[u64; 2]>);

/// A slice is copied at once, where the clone of a `SmallVec` takes its elements one by one.
impl Clone for Costs {
    #[inline]
    fn clone(&self) -> Self {
        Self(SmallVec::from_slice(&self.0))
    }
}

impl Costs {
    pub(super) fn nothing() -> Self {
        Self(smallvec![1])
    }

    /// Adds each number of another set, increased by `by`.
    pub(super) fn include(&mut self, other: &Self, by: u64) {
        let (words, shift) = ((by / 64) as usize, (by % 64) as u32);
        for (place, &word) in (words..).zip(&other.0) {
            self.set(place, word << shift);
            self.set(place + 1, word.checked_shr(64 - shift).unwrap_or(0));
        }
    }

    /// Sets the bits of a word. The last word is not 0.
    fn set(&mut self, place: usize, bits: u64) {
        if bits != 0 {
            if place >= self.0.len() {
                self.0.resize(place + 1, 0);
            }
            self.0[place] |= bits;
        }
    }

    pub(super) fn bytes(&self) -> usize {
        size_of::<u64>() * self.0.len()
    }

    pub fn iter(&self) -> impl DoubleEndedIterator<Item = u64> + '_ {
        (0..self.0.len() as u64 * 64).filter(|&cost| self.contains(cost))
    }

    /// Whether a run can take this number of moves.
    pub fn contains(&self, cost: u64) -> bool {
        self.0.get((cost / 64) as usize).is_some_and(|word| word >> (cost % 64) & 1 == 1)
    }

    pub fn min(&self) -> Option<u64> {
        self.iter().next()
    }

    pub fn max(&self) -> Option<u64> {
        self.iter().next_back()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_limit_has_its_name() {
        let limits = [ChoicesLimit::States(5), ChoicesLimit::Memory, ChoicesLimit::Interrupted];
        assert_eq!(limits.map(ChoicesLimit::name), ["max-states", "memory", "interrupted"]);
    }

    #[test]
    fn costs_are_shifted_across_words() {
        let mut costs = Costs::default();
        let mut some = Costs::default();
        for cost in [0, 1, 63, 64, 200] {
            some.include(&Costs::nothing(), cost);
        }
        for by in [0, 1, 64, 65] {
            costs.include(&some, by);
        }
        let expected = [0, 1, 2, 63, 64, 65, 66, 127, 128, 129, 200, 201, 264, 265];
        assert_eq!(costs.iter().collect::<Vec<_>>(), expected);
        for (cost, by) in [(63, 1), (63, 65), (40, 50)] {
            let (mut from, mut to) = (Costs::default(), Costs::default());
            from.include(&Costs::nothing(), cost);
            to.include(&from, by);
            assert_eq!(to.iter().collect::<Vec<_>>(), [cost + by]);
        }
        assert_eq!((costs.min(), costs.max()), (Some(0), Some(265)));
        assert_eq!(Costs::default().max(), None);
    }
}
