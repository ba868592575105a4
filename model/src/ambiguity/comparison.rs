//! Are two placed worlds distinguishable?

use std::{cell::OnceCell, collections::HashSet};

use super::{
    partition::coarsest,
    space::{Space, States},
    witness::{Relation, Walk},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Marker,
    world::{Action, GraphWorld, State},
};

/// A robot in a placed world.
pub type PlacedRobot<'a> = GraphWorld<'a, &'a dyn Marker>;

/// Two placed worlds, held against each other. Their states, as [`state_count`](super::state_count)
/// counts them, are numbered together in a `u32`, and take memory accordingly.
pub struct Comparison<'a> {
    marker: &'a dyn Marker,
    worlds: [PlacedRobot<'a>; 2],
    states: [States; 2],
    /// The class of each state of the first and then of the second world, computed when needed.
    class: OnceCell<Vec<u32>>,
}

impl<'a> Comparison<'a> {
    /// Compares two graphs. The facing darts place the marker in each.
    #[must_use]
    pub fn new(
        marker: &'a dyn Marker,
        (one, facing): (&'a EmbeddedGraph, Dart),
        (other, other_facing): (&'a EmbeddedGraph, Dart),
    ) -> Self {
        let states = [States::of(one, marker, facing), States::of(other, marker, other_facing)];
        let worlds = [
            GraphWorld::with_marker(one, marker, facing),
            GraphWorld::with_marker(other, marker, other_facing),
        ];
        Self { marker, worlds, states, class: OnceCell::new() }
    }

    /// The coarsest partition of the states of both worlds.
    fn class(&self) -> &[u32] {
        self.class.get_or_init(|| {
            let space =
                |at: usize| Space::of(self.worlds[at].graph(), self.marker, &self.states[at]);
            let [one, other] = [space(0), space(1)];
            let beyond = one.labels.len() as u32;
            let both = |(one, other): (Vec<u32>, Vec<u32>)| -> Vec<u32> {
                one.into_iter().chain(other.into_iter().map(|to| to + beyond)).collect()
            };
            let labels = [one.labels, other.labels].concat();
            let maps: Vec<_> = one.maps.into_iter().zip(other.maps).map(both).collect();
            coarsest(&labels, &maps)
        })
    }

    /// The two worlds with their markers where they were placed, and in each a robot that has come in
    /// by such a dart, which is one of the graph's.
    #[must_use]
    pub fn starts(&self, poses: [Dart; 2]) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        let begun =
            |world: &PlacedRobot<'a>, pose| world.clone().at(State { pose, ..world.state() });
        [begun(one, poses[0]), begun(other, poses[1])]
    }

    /// Whether no walk from these starts distinguishes the worlds.
    // paper: marker.undirected-insufficient, marker.none-cycles
    #[must_use]
    pub fn indistinguishable(&self, poses: [Dart; 2]) -> bool {
        let [one, other] = self.starts(poses);
        let here = self.states[0].number(one.state()) as usize;
        let there = self.states[0].len() + self.states[1].number(other.state()) as usize;
        self.class()[here] == self.class()[there]
    }

    /// The first start in the second world that is indistinguishable from this pose in the first. The
    /// robot in the second world may begin in any pose that places the marker alike. Returns `None` if
    /// each of these starts has a walk that distinguishes it.
    #[must_use]
    pub fn start_like(&self, pose: Dart) -> Option<Dart> {
        let world = &self.worlds[1];
        let starts = self.marker.starts(world.graph(), world.pose());
        starts.into_iter().find(|&other| self.indistinguishable([pose, other]))
    }

    /// Why they cannot: all pairs of states that they can be in, breadth-first; `None` if they
    /// can. There are at most as many pairs as states of the one times states of the other.
    #[must_use]
    pub fn relation(&self, poses: [Dart; 2]) -> Option<Relation> {
        if self.class.get().is_some() && !self.indistinguishable(poses) {
            return None;
        }
        let mut pairs = Pairs::new(self, poses);
        match pairs.reach(self.few_pairs()) {
            Look::Difference(_) => return None,
            Look::NoMore => {}
            Look::Enough if !self.indistinguishable(poses) => return None,
            Look::Enough => {
                pairs.reach(usize::MAX);
            }
        }
        Some(Relation(pairs.found.into_iter().map(|found| found.pair).collect()))
    }

    /// How they can: the shortest walk, and of these the least; `None` where they cannot.
    #[must_use]
    pub fn walk(&self, poses: [Dart; 2]) -> Option<Walk> {
        if self.class.get().is_some() && self.indistinguishable(poses) {
            return None;
        }
        let mut pairs = Pairs::new(self, poses);
        let look = match pairs.reach(self.few_pairs()) {
            Look::Enough if !self.indistinguishable(poses) => pairs.reach(usize::MAX),
            look => look,
        };
        match look {
            Look::Difference(walk) => Some(walk),
            Look::NoMore | Look::Enough => None,
        }
    }

    /// So many pairs are looked at before the partition is made, which costs no less.
    fn few_pairs(&self) -> usize {
        4 * (self.states[0].len() + self.states[1].len())
    }
}

/// How a look for a difference ended.
enum Look {
    /// With one.
    Difference(Walk),
    /// There are no more pairs.
    NoMore,
    /// As many pairs as were wanted have been found.
    Enough,
}

/// Pairs of states that robots that do the same can reach, breadth-first; those of a length in the
/// order of the least walks that lead to them.
struct Pairs<'c, 'a> {
    worlds: [PlacedRobot<'a>; 2],
    states: &'c [States; 2],
    found: Vec<Found>,
    /// The place of the pair to look further from.
    next: usize,
    /// The numbers of the states of each pair found.
    known: HashSet<[u32; 2]>,
}

/// A pair of states, and from which earlier one by which action it was reached.
struct Found {
    pair: (State, State),
    from: Option<(usize, Action)>,
}

impl<'c, 'a> Pairs<'c, 'a> {
    fn new(comparison: &'c Comparison<'a>, poses: [Dart; 2]) -> Self {
        let worlds = comparison.starts(poses);
        let pair = (worlds[0].state(), worlds[1].state());
        let states = &comparison.states;
        let mut pairs = Self { worlds, states, found: Vec::new(), next: 0, known: HashSet::new() };
        pairs.find(pair, None);
        pairs
    }

    /// Takes in a pair, if it is a new one.
    fn find(&mut self, pair: (State, State), from: Option<(usize, Action)>) -> bool {
        let [one, other] = self.states;
        let new = self.known.insert([one.number(pair.0), other.number(pair.1)]);
        if new {
            self.found.push(Found { pair, from });
        }
        new
    }

    /// Finds pairs until one of them shows a difference, or there are no more, or as many as these.
    fn reach(&mut self, most: usize) -> Look {
        while let Some(&Found { pair, .. }) = self.found.get(self.next) {
            let [one, other] = self.at(pair);
            if self.next == 0 && one.sensed() != other.sensed() {
                return self.difference_at(0);
            }
            if self.found.len() > most {
                return Look::Enough;
            }
            for action in one.actions() {
                let (mut one, mut other) = (one.clone(), other.clone());
                // Robots that perceive the same can do the same.
                let acted = one.act(action).and_then(|()| other.act(action));
                let from = Some((self.next, action));
                let is_new = acted.is_ok() && self.find((one.state(), other.state()), from);
                if is_new && one.sensed() != other.sensed() {
                    return self.difference_at(self.found.len() - 1);
                }
            }
            self.next += 1;
        }
        Look::NoMore
    }

    fn at(&self, (here, there): (State, State)) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        [one.clone().at(here), other.clone().at(there)]
    }

    /// How the pair at a place was reached, and what is perceived there.
    fn difference_at(&self, place: usize) -> Look {
        let mut actions = Vec::new();
        let mut at = place;
        while let Some((from, action)) = self.found[at].from {
            actions.push(action);
            at = from;
        }
        actions.reverse();
        let percepts = self.at(self.found[place].pair).map(|robot| robot.sensed());
        Look::Difference(Walk { actions, percepts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::marker::named;

    fn cycle(edges: usize) -> EmbeddedGraph {
        let name = |edge: usize| (edge % edges).to_string();
        let around = |vertex: usize| (name(vertex), vec![name(vertex), name(vertex + 1)]);
        EmbeddedGraph::from_edge_lists(&(0..edges).map(around).collect::<Vec<_>>()).unwrap()
    }

    /// A cycle of junctions, to each of which both ends of a long way are joined; these are of one
    /// length, but for that at the last junction.
    fn cycle_of_ways(junctions: usize, length: usize, last: usize) -> EmbeddedGraph {
        let mut lists = Vec::new();
        for junction in 0..junctions {
            let next = (junction + 1) % junctions;
            let length = if next == 0 { last } else { length };
            let on_the_way = |place: usize| format!("way-{junction}-{place}");
            let on_the_cycle = |junction: usize| format!("cycle-{junction}");
            let ways = [on_the_cycle(junction), on_the_cycle(next)];
            let both_ends = [on_the_way(0), on_the_way(length - 1)];
            lists.push((format!("junction-{junction}"), [ways, both_ends].concat()));
            for place in 1..length {
                lists.push((on_the_way(place), vec![on_the_way(place - 1), on_the_way(place)]));
            }
        }
        EmbeddedGraph::from_edge_lists(&lists).unwrap()
    }

    /// Without a marker no walk tells cycles apart. If their lengths `n` and `m` are coprime, two robots
    /// reach all `2 n m` pairs of poses that agree on the sense.
    #[test]
    fn the_partition_is_made_only_where_there_are_many_pairs() {
        let none = named("none").unwrap();
        for (shorter, longer, is_made) in [(3, 4, false), (8, 9, true)] {
            let (one, other) = (cycle(shorter), cycle(longer));
            let comparison = || Comparison::new(none, (&one, Dart(0)), (&other, Dart(0)));
            let pairs = 2 * shorter * longer;
            let states = 2 * (shorter + longer);
            assert_eq!(pairs > 4 * states, is_made);
            assert!(pairs > 4 + states);
            let asked = comparison();
            assert_eq!(asked.relation([Dart(0); 2]).unwrap().0.len(), pairs);
            assert_eq!(asked.class.get().is_some(), is_made);
            let asked = comparison();
            assert_eq!(asked.walk([Dart(0); 2]), None);
            assert_eq!(asked.class.get().is_some(), is_made);
        }
    }

    /// Robots in cycles of 9 and of 10 junctions come into a great many pairs of poses before one of
    /// them comes to the end of the one way that is longer.
    #[test]
    fn a_difference_is_found_that_many_pairs_come_before() {
        let length = 400;
        let one = cycle_of_ways(9, length, length);
        let other = cycle_of_ways(10, length, length + 1);
        let none = named("none").unwrap();
        let comparison = || Comparison::new(none, (&one, Dart(0)), (&other, Dart(0)));
        let poses = [Dart(0); 2];
        let asked = comparison();
        let walk = asked.walk(poses).unwrap();
        assert!(asked.class.get().is_some());
        let [here, there] = asked.starts(poses);
        assert!(walk.verify(&here, &there));
        // Also once the partition is made, and for the relation.
        assert_eq!(asked.walk(poses), Some(walk));
        assert_eq!(asked.relation(poses), None);
        assert_eq!(comparison().relation(poses), None);
    }
}
