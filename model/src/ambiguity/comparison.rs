//! Are two placed worlds distinguishable?

use std::{cell::OnceCell, collections::HashSet};

use super::{
    partition::coarsest_watched,
    space::{PlacedRobot, Space, States},
    state_classes::StateClasses,
    witness::{Relation, Walk},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Interrupted, Watch},
    marker::Marker,
    world::{Action, GraphWorld, State},
};

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
        let states = [
            States::from_start(one, marker, facing),
            States::from_start(other, marker, other_facing),
        ];
        let worlds = [
            GraphWorld::with_marker(one, marker, facing),
            GraphWorld::with_marker(other, marker, other_facing),
        ];
        Self { marker, worlds, states, class: OnceCell::new() }
    }

    /// Computes the coarsest partition of the states of both worlds, once. Then each question about
    /// indistinguishable starts is answered at once.
    ///
    /// # Errors
    /// Returns an error if the watch stops.
    pub fn partition(&self, watch: &dyn Watch) -> Result<(), Interrupted> {
        self.class(watch).map(|_| ())
    }

    /// The coarsest partition of the states of both worlds.
    fn class(&self, watch: &dyn Watch) -> Result<&[u32], Interrupted> {
        if let Some(class) = self.class.get() {
            return Ok(class);
        }
        let space =
            |at: usize| Space::from_states(self.worlds[at].graph(), self.marker, &self.states[at]);
        let [one, other] = [space(0), space(1)];
        let beyond = one.labels.len() as u32;
        let both = |(one, other): (Vec<u32>, Vec<u32>)| -> Vec<u32> {
            one.into_iter().chain(other.into_iter().map(|to| to + beyond)).collect()
        };
        let labels = [one.labels, other.labels].concat();
        let maps: Vec<_> = one.maps.into_iter().zip(other.maps).map(both).collect();
        let class = coarsest_watched(&labels, &maps, watch)?;
        Ok(self.class.get_or_init(|| class))
    }

    /// Whether the starts are in one class.
    fn in_one_class(&self, poses: [Dart; 2], watch: &dyn Watch) -> Result<bool, Interrupted> {
        let [one, other] = self.starts(poses);
        let here = self.states[0].number(one.state()) as usize;
        let there = self.states[0].len() + self.states[1].number(other.state()) as usize;
        let class = self.class(watch)?;
        Ok(class[here] == class[there])
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
        // Nothing stops it.
        self.in_one_class(poses, &()).unwrap_or_default()
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
        match self.bisimulation(poses, usize::MAX, &()) {
            Ok(Some(Bisimulation::Relation(relation))) => Some(relation),
            _ => None,
        }
    }

    /// Why they cannot: the [`relation`](Self::relation) if it has at most `most_pairs` pairs, otherwise the
    /// classes of states; `None` if they can.
    ///
    /// # Errors
    /// Returns an error if the watch stops.
    pub fn bisimulation(
        &self,
        poses: [Dart; 2],
        most_pairs: usize,
        watch: &dyn Watch,
    ) -> Result<Option<Bisimulation>, Interrupted> {
        if self.class.get().is_some() && !self.in_one_class(poses, watch)? {
            return Ok(None);
        }
        let mut pairs = Pairs::new(self, poses);
        let mut look = pairs.reach(self.few_pairs().min(most_pairs), watch)?;
        if matches!(look, Look::Enough) && self.in_one_class(poses, watch)? {
            look = pairs.reach(most_pairs, watch)?;
            if matches!(look, Look::Enough) {
                let class = self.class(watch)?.to_vec();
                let classes = StateClasses::new(self.states.clone(), class);
                return Ok(Some(Bisimulation::Classes(classes)));
            }
        }
        Ok(match look {
            Look::Difference(_) | Look::Enough => None,
            Look::NoMore => Some(Bisimulation::Relation(pairs.into_relation())),
        })
    }

    /// How they can: the shortest walk, and of these the least; `None` where they cannot.
    #[must_use]
    pub fn walk(&self, poses: [Dart; 2]) -> Option<Walk> {
        // Nothing stops it.
        self.walk_watched(poses, &()).unwrap_or_default()
    }

    /// Does the same as [`walk`](Self::walk).
    ///
    /// # Errors
    /// Returns an error if the watch stops.
    pub fn walk_watched(
        &self,
        poses: [Dart; 2],
        watch: &dyn Watch,
    ) -> Result<Option<Walk>, Interrupted> {
        if self.class.get().is_some() && self.in_one_class(poses, watch)? {
            return Ok(None);
        }
        let mut pairs = Pairs::new(self, poses);
        let mut look = pairs.reach(self.few_pairs(), watch)?;
        if matches!(look, Look::Enough) && !self.in_one_class(poses, watch)? {
            look = pairs.reach(usize::MAX, watch)?;
        }
        Ok(match look {
            Look::Difference(walk) => Some(walk),
            Look::NoMore | Look::Enough => None,
        })
    }

    /// So many pairs are looked at before the partition is made, which costs no less.
    fn few_pairs(&self) -> usize {
        4 * (self.states[0].len() + self.states[1].len())
    }
}

/// Why no walk distinguishes two worlds.
#[derive(Clone, Debug)]
pub enum Bisimulation {
    /// All pairs of states that the robots can be in.
    Relation(Relation),
    /// The classes of the states of both worlds.
    Classes(StateClasses),
}

impl Bisimulation {
    /// Whether this proves that the robots in the two worlds never perceive a difference.
    #[must_use]
    pub fn verify(&self, one: &PlacedRobot<'_>, other: &PlacedRobot<'_>) -> bool {
        match self {
            Self::Relation(relation) => relation.verify(one, other),
            Self::Classes(classes) => classes.verify(one, other),
        }
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

/// The number of pairs after which the watch is asked whether to stop.
const BETWEEN_QUESTIONS: usize = 256;

/// Pairs of states that robots that do the same can reach, breadth-first; those of a length in the
/// order of the least walks that lead to them.
struct Pairs<'c, 'a> {
    worlds: [PlacedRobot<'a>; 2],
    states: &'c [States; 2],
    found: Vec<ReachedPair>,
    /// The place of the pair to look further from.
    next: usize,
    /// The numbers of the states of each pair found.
    known: HashSet<[u32; 2]>,
}

/// A pair of states, with the earlier pair and the action by which it was reached.
struct ReachedPair {
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
            self.found.push(ReachedPair { pair, from });
        }
        new
    }

    fn into_relation(self) -> Relation {
        Relation(self.found.into_iter().map(|found| found.pair).collect())
    }

    /// Finds pairs until one of them shows a difference, or there are no more, or as many as these.
    fn reach(&mut self, most: usize, watch: &dyn Watch) -> Result<Look, Interrupted> {
        while let Some(&ReachedPair { pair, .. }) = self.found.get(self.next) {
            if self.next.is_multiple_of(BETWEEN_QUESTIONS) {
                watch.check_stop()?;
            }
            let [one, other] = self.at(pair);
            if self.next == 0 && one.sensed() != other.sensed() {
                return Ok(self.difference_at(0));
            }
            if self.found.len() > most {
                return Ok(Look::Enough);
            }
            for action in one.actions() {
                let (mut one, mut other) = (one.clone(), other.clone());
                // Robots that perceive the same can do the same.
                let acted = one.act(action).and_then(|()| other.act(action));
                let from = Some((self.next, action));
                let is_new = acted.is_ok() && self.find((one.state(), other.state()), from);
                if is_new && one.sensed() != other.sensed() {
                    return Ok(self.difference_at(self.found.len() - 1));
                }
            }
            self.next += 1;
        }
        Ok(Look::NoMore)
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
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;
    use crate::marker::named;

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

    /// Without a marker no walk distinguishes cycles. If their lengths `n` and `m` are coprime, two robots
    /// reach all `2 n m` pairs of poses that agree on the sense.
    #[test]
    fn the_partition_is_made_only_where_there_are_many_pairs() {
        let none = named("none").unwrap();
        for (shorter, longer, is_made) in [(3, 4, false), (8, 9, true)] {
            let (one, other) = (EmbeddedGraph::cycle(shorter), EmbeddedGraph::cycle(longer));
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

    /// Two robots in cycles of coprime lengths reach all pairs of poses that agree on the sense; all poses
    /// look alike.
    #[test]
    fn many_pairs_are_replaced_by_the_classes() {
        let none = named("none").unwrap();
        let (one, other) = (EmbeddedGraph::cycle(200), EmbeddedGraph::cycle(201));
        let comparison = Comparison::new(none, (&one, Dart(0)), (&other, Dart(0)));
        let starts = comparison.starts([Dart(0); 2]);
        let found = |most| comparison.bisimulation([Dart(0); 2], most, &()).unwrap().unwrap();
        let pairs = 2 * 200 * 201;
        match found(pairs) {
            Bisimulation::Relation(relation) => {
                assert_eq!(relation.0.len(), pairs);
                assert!(relation.verify(&starts[0], &starts[1]));
            }
            Bisimulation::Classes(_) => panic!("there are not more pairs"),
        }
        match found(pairs - 1) {
            Bisimulation::Relation(_) => panic!("there are more pairs"),
            Bisimulation::Classes(classes) => {
                assert_eq!(classes.count(), 1);
                assert_eq!(classes.classes()[0].each_ref().map(Vec::len), [400, 402]);
                assert!(classes.verify(&starts[0], &starts[1]));
            }
        }
    }

    /// Stops at a question of this number, from 1.
    struct QuestionLimit {
        at: u64,
        asked: AtomicU64,
    }

    impl QuestionLimit {
        fn new(at: u64) -> Self {
            Self { at, asked: AtomicU64::new(0) }
        }

        fn asked(&self) -> u64 {
            self.asked.load(Ordering::Relaxed)
        }
    }

    impl Watch for QuestionLimit {
        fn stop(&self) -> bool {
            self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.at
        }
    }

    type Search = fn(&Comparison, &dyn Watch) -> bool;

    #[test]
    fn each_search_ends_at_the_question_at_which_it_is_stopped() {
        let none = named("none").unwrap();
        let (one, other) = (EmbeddedGraph::cycle(40), EmbeddedGraph::cycle(41));
        let comparison = || Comparison::new(none, (&one, Dart(0)), (&other, Dart(0)));
        let searches: [Search; 3] = [
            |comparison, watch| comparison.partition(watch) == Err(Interrupted),
            |comparison, watch| comparison.walk_watched([Dart(0); 2], watch) == Err(Interrupted),
            |comparison, watch| comparison.bisimulation([Dart(0); 2], usize::MAX, watch).is_err(),
        ];
        for is_stopped in searches {
            let unlimited = QuestionLimit::new(u64::MAX);
            assert!(!is_stopped(&comparison(), &unlimited));
            assert!(unlimited.asked() > 0);
            for at in 1..=unlimited.asked() {
                let limited = QuestionLimit::new(at);
                assert!(is_stopped(&comparison(), &limited));
                assert_eq!(limited.asked(), at);
            }
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
