//! Can robots in two placed worlds tell that these are two?

use std::collections::HashSet;

use super::{
    partition::coarsest,
    space::Space,
    witness::{Relation, Walk, perceived},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Marker,
    world::{Action, GraphWorld, State},
};

/// A robot in a placed world.
pub type PlacedRobot<'a> = GraphWorld<'a, &'a dyn Marker>;

/// Two placed worlds, held against each other.
pub struct Comparison<'a> {
    worlds: [PlacedRobot<'a>; 2],
    spaces: [Space; 2],
    /// The class of each state of the first and then of the second world.
    class: Vec<u32>,
}

impl<'a> Comparison<'a> {
    /// Compares two graphs, in each of which such a marker was placed by the facing dart.
    #[must_use]
    pub fn new(
        marker: &'a dyn Marker,
        (one, facing): (&'a EmbeddedGraph, Dart),
        (other, other_facing): (&'a EmbeddedGraph, Dart),
    ) -> Self {
        let spaces = [Space::of(one, marker, facing), Space::of(other, marker, other_facing)];
        let labels: Vec<_> = spaces.iter().flat_map(|space| &space.labels).collect();
        let beyond = spaces[0].len() as u32;
        let [one_maps, other_maps] = [&spaces[0].maps, &spaces[1].maps];
        let both = |(one, other): (&Vec<u32>, &Vec<u32>)| {
            one.iter().copied().chain(other.iter().map(|to| to + beyond)).collect()
        };
        let maps: Vec<_> = one_maps.iter().zip(other_maps).map(both).collect();
        let class = coarsest(&labels, &maps);
        let worlds = [
            GraphWorld::with_marker(one, marker, facing),
            GraphWorld::with_marker(other, marker, other_facing),
        ];
        Self { worlds, spaces, class }
    }

    /// The two worlds, each with a robot at its start, whose marker lies where it was placed, and
    /// who has come in by such a dart.
    #[must_use]
    pub fn starts(&self, poses: [Dart; 2]) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        let begun =
            |world: &PlacedRobot<'a>, pose| world.clone().at(State { pose, ..world.state() });
        [begun(one, poses[0]), begun(other, poses[1])]
    }

    /// Whether robots that begin so can never tell the worlds apart.
    // paper: marker.undirected-insufficient, marker.none-cycles
    #[must_use]
    pub fn indistinguishable(&self, poses: [Dart; 2]) -> bool {
        let [one, other] = self.starts(poses);
        let here = self.spaces[0].number(one.state()) as usize;
        let there = self.spaces[0].len() + self.spaces[1].number(other.state()) as usize;
        self.class[here] == self.class[there]
    }

    /// Why they cannot: all pairs of states that they can be in, breadth-first; `None` where they
    /// can. There are at most as many pairs as states of the one times states of the other.
    #[must_use]
    pub fn relation(&self, poses: [Dart; 2]) -> Option<Relation> {
        self.indistinguishable(poses).then(|| {
            let mut pairs = Pairs::new(self, poses);
            pairs.look_for_a_difference();
            Relation(pairs.found.into_iter().map(|found| found.pair).collect())
        })
    }

    /// How they can: the shortest walk, and of these the least; `None` where they cannot.
    #[must_use]
    pub fn walk(&self, poses: [Dart; 2]) -> Option<Walk> {
        (!self.indistinguishable(poses))
            .then(|| Pairs::new(self, poses).look_for_a_difference())
            .flatten()
    }
}

/// Pairs of states that robots that do the same can reach, breadth-first; those of a length in the
/// order of the least walks that lead to them.
struct Pairs<'c, 'a> {
    worlds: [PlacedRobot<'a>; 2],
    spaces: &'c [Space; 2],
    found: Vec<Found>,
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
        let spaces = &comparison.spaces;
        let mut pairs = Self { worlds, spaces, found: Vec::new(), known: HashSet::new() };
        pairs.find(pair, None);
        pairs
    }

    /// Takes in a pair, if it is a new one.
    fn find(&mut self, pair: (State, State), from: Option<(usize, Action)>) -> bool {
        let [one, other] = self.spaces;
        let new = self.known.insert([one.number(pair.0), other.number(pair.1)]);
        if new {
            self.found.push(Found { pair, from });
        }
        new
    }

    /// Finds pairs until there are no more, or until one of them shows a difference.
    fn look_for_a_difference(&mut self) -> Option<Walk> {
        let mut next = 0;
        while let Some(&Found { pair, .. }) = self.found.get(next) {
            let [one, other] = self.at(pair);
            if next == 0 && perceived(&one) != perceived(&other) {
                return self.walk_to(0);
            }
            for action in one.actions() {
                let (mut one, mut other) = (one.clone(), other.clone());
                // Robots that perceive the same can do the same.
                let acted = one.act(action).and_then(|()| other.act(action));
                let is_new =
                    acted.is_ok() && self.find((one.state(), other.state()), Some((next, action)));
                if is_new && perceived(&one) != perceived(&other) {
                    return self.walk_to(self.found.len() - 1);
                }
            }
            next += 1;
        }
        None
    }

    fn at(&self, (here, there): (State, State)) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        [one.clone().at(here), other.clone().at(there)]
    }

    /// How the pair at a place was reached, and what is perceived there.
    fn walk_to(&self, place: usize) -> Option<Walk> {
        let [one, other] = self.at(self.found[place].pair);
        let mut actions = Vec::new();
        let mut at = place;
        while let Some((from, action)) = self.found[at].from {
            actions.push(action);
            at = from;
        }
        actions.reverse();
        Some(Walk { actions, percepts: [perceived(&one)?, perceived(&other)?] })
    }
}
