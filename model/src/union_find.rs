//! Disjoint sets of small numbers.

/// The numbers `0 .. n` in disjoint sets, at first each in its own.
#[derive(Clone, Debug)]
pub(crate) struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    pub(crate) fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The number that stands for the set of this one.
    pub(crate) fn find(&mut self, mut number: u32) -> u32 {
        // Path halving.
        while self.parent[number as usize] != number {
            let parent = self.parent[number as usize];
            let next = self.parent[parent as usize];
            self.parent[number as usize] = next;
            number = next;
        }
        number
    }

    /// Makes the sets of two numbers one.
    pub(crate) fn union(&mut self, one: u32, other: u32) {
        let (one, other) = (self.find(one), self.find(other));
        self.parent[one.max(other) as usize] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_joined_in_any_order_have_the_same_representative() {
        let mut sets = UnionFind::new(7);
        for (one, other) in [(5, 6), (0, 1), (6, 1), (3, 4), (1, 5)] {
            sets.union(one, other);
        }
        let found: Vec<_> = (0..7).map(|number| sets.find(number)).collect();
        assert_eq!(found, [0, 0, 2, 3, 3, 0, 0]);
    }
}
