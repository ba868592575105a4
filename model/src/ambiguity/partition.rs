//! The coarsest partition of states into indistinguishable ones: Hopcroft's algorithm.
//!
//! J. Hopcroft, "An n log n algorithm for minimizing states in a finite automaton" (1971), with the
//! refinable partitions of A. Valmari and P. Lehtinen (2008).

use crate::enumerate::{Interrupted, Watch};

/// The class of each state in the coarsest partition in which states of one class have the same
/// label, and each of the maps takes them to states of one class. Classes are numbered from 0. It is an error if the
/// watch stops.
pub(super) fn coarsest<L: Ord>(
    labels: &[L],
    maps: &[Vec<u32>],
    watch: &dyn Watch,
) -> Result<Vec<u32>, Interrupted> {
    let mut partition = Partition::by_label(labels);
    let preimages: Vec<_> = maps.iter().map(|map| Preimages::from_map(map)).collect();
    let mut splitters: Vec<u32> = (0..partition.first.len() as u32).collect();
    let mut queued = vec![true; splitters.len()];
    let mut splitter = Vec::new();
    while let Some(class) = splitters.pop() {
        watch.check_stop()?;
        queued[class as usize] = false;
        splitter.clear();
        splitter.extend_from_slice(partition.states_of(class));
        for preimages in &preimages {
            for &state in &splitter {
                for &before in preimages.of_state(state) {
                    partition.mark(before);
                }
            }
            while let Some((class, new)) = partition.split_touched() {
                queued.push(false);
                // Of the two halves, the smaller one is enough where the whole is done with.
                let smaller = if partition.len(class) < partition.len(new) { class } else { new };
                let next = if queued[class as usize] { new } else { smaller };
                queued[next as usize] = true;
                splitters.push(next);
            }
        }
    }
    Ok(partition.class)
}

/// The states that a map takes to each state, side by side.
struct Preimages {
    states: Vec<u32>,
    end: Vec<u32>,
}

impl Preimages {
    fn from_map(map: &[u32]) -> Self {
        let mut end = vec![0; map.len()];
        for &to in map {
            end[to as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut end {
            sum += *end;
            *end = sum;
        }
        let mut next = end.clone();
        let mut states = vec![0; map.len()];
        for (from, &to) in map.iter().enumerate() {
            next[to as usize] -= 1;
            states[next[to as usize] as usize] = from as u32;
        }
        Self { states, end }
    }

    fn of_state(&self, state: u32) -> &[u32] {
        let state = state as usize;
        let first = if state == 0 { 0 } else { self.end[state - 1] };
        &self.states[first as usize..self.end[state] as usize]
    }
}

/// A partition whose classes can be split by marking some of their states.
struct Partition {
    /// The states, those of a class side by side, its marked ones first.
    states: Vec<u32>,
    place: Vec<u32>,
    class: Vec<u32>,
    /// The first place of each class, and one past its last.
    first: Vec<u32>,
    end: Vec<u32>,
    marked: Vec<u32>,
    touched: Vec<u32>,
}

impl Partition {
    fn by_label<L: Ord>(labels: &[L]) -> Self {
        let mut states: Vec<u32> = (0..labels.len() as u32).collect();
        states.sort_by_key(|&state| &labels[state as usize]);
        let mut partition = Self {
            place: vec![0; states.len()],
            class: vec![0; states.len()],
            first: Vec::new(),
            end: Vec::new(),
            marked: Vec::new(),
            touched: Vec::new(),
            states,
        };
        let mut last = None;
        for place in 0..partition.states.len() {
            let state = partition.states[place] as usize;
            if last.replace(&labels[state]) != Some(&labels[state]) {
                partition.first.push(place as u32);
                partition.end.push(place as u32);
                partition.marked.push(0);
            }
            let class = partition.first.len() - 1;
            partition.place[state] = place as u32;
            partition.class[state] = class as u32;
            partition.end[class] += 1;
        }
        partition
    }

    fn states_of(&self, class: u32) -> &[u32] {
        let class = class as usize;
        &self.states[self.first[class] as usize..self.end[class] as usize]
    }

    fn len(&self, class: u32) -> u32 {
        self.end[class as usize] - self.first[class as usize]
    }

    fn mark(&mut self, state: u32) {
        let class = self.class[state as usize] as usize;
        if self.marked[class] == 0 {
            self.touched.push(class as u32);
        }
        let to = self.first[class] + self.marked[class];
        let from = self.place[state as usize];
        let other = self.states[to as usize];
        self.states.swap(from as usize, to as usize);
        self.place[state as usize] = to;
        self.place[other as usize] = from;
        self.marked[class] += 1;
    }

    /// Splits the marked states off one class that has both marked and unmarked ones, and returns
    /// it and the new class; `None` when no class is left to split. No state is marked then.
    fn split_touched(&mut self) -> Option<(u32, u32)> {
        while let Some(class) = self.touched.pop() {
            let marked = std::mem::take(&mut self.marked[class as usize]);
            if marked == self.len(class) {
                continue;
            }
            let new = self.first.len() as u32;
            let first = self.first[class as usize];
            self.first.push(first);
            self.end.push(first + marked);
            self.marked.push(0);
            self.first[class as usize] = first + marked;
            for place in first..first + marked {
                self.class[self.states[place as usize] as usize] = new;
            }
            return Some((class, new));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Moore's way: split until nothing changes, every class against every other.
    fn by_rounds(labels: &[u8], maps: &[Vec<u32>]) -> Vec<usize> {
        let number = |keys: Vec<Vec<usize>>| -> Vec<usize> {
            let find = |key| keys.iter().position(|other| other == key).unwrap();
            keys.iter().map(find).collect()
        };
        let mut class = number(labels.iter().map(|&label| vec![label.into()]).collect());
        for _ in labels {
            let key = |state: usize| {
                let after = maps.iter().map(|map| class[map[state] as usize]);
                std::iter::once(class[state]).chain(after).collect()
            };
            class = number((0..labels.len()).map(key).collect());
        }
        class
    }

    fn machine() -> impl Strategy<Value = (Vec<u8>, Vec<Vec<u32>>)> {
        (1..24_usize).prop_flat_map(|states| {
            let map = proptest::collection::vec(0..states as u32, states);
            let labels = proptest::collection::vec(0..2_u8, states);
            (labels, proptest::collection::vec(map, 1..4))
        })
    }

    proptest! {
        #[test]
        fn it_is_the_partition_that_rounds_of_splitting_end_with((labels, maps) in machine()) {
            let (fast, slow) = (coarsest(&labels, &maps, &()).unwrap(), by_rounds(&labels, &maps));
            for one in 0..labels.len() {
                for other in 0..labels.len() {
                    prop_assert_eq!(fast[one] == fast[other], slow[one] == slow[other]);
                }
            }
            prop_assert!(fast.iter().all(|&class| (class as usize) < labels.len()));
        }
    }
}
