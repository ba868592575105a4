//! Are two placed worlds distinguishable?

use std::cell::OnceCell;

use hashbrown::{HashMap, HashSet};

use super::{
    partition::coarsest,
    space::{PlacedRobot, Space, States},
    state_classes::StateClasses,
    witness::{Relation, Walk},
};
use crate::{
    aid::{Action, Aid, AnyAid, Places, State},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Interrupted, Watch},
    world::GraphWorld,
};

/// Two placed worlds that are compared. Their states are numbered together in a `u32`, and take memory
/// accordingly.
pub struct Comparison<'a> {
    worlds: [PlacedRobot<'a>; 2],
    /// The states of both, and the class of each state of the first and then of the second world; computed when needed.
    partition: OnceCell<([States; 2], Vec<u32>)>,
}

impl<'a> Comparison<'a> {
    /// Compares two graphs. The facing darts place the aid in each.
    pub fn new(
        aid: impl Into<AnyAid<'a>>,
        (one, facing): (&'a EmbeddedGraph, Dart),
        (other, other_facing): (&'a EmbeddedGraph, Dart),
    ) -> Self {
        let aid = aid.into();
        Self::between([
            GraphWorld::with_aid(one, aid, facing),
            GraphWorld::with_aid(other, aid, other_facing),
        ])
    }

    /// Compares two worlds in which the same kind of aid shows what belongs to the world, such as a
    /// [compass](crate::aid::compass::Compass).
    pub fn between(worlds: [PlacedRobot<'a>; 2]) -> Self {
        Self { worlds, partition: OnceCell::new() }
    }

    /// Computes the coarsest partition of the states of both worlds, once. Then each question about
    /// indistinguishable starts is answered at once.
    ///
    /// # Errors
    /// Returns an error if the watch stops.
    pub fn partition(&self, watch: &dyn Watch) -> Result<(), Interrupted> {
        self.classes(watch).map(|_| ())
    }

    fn classes(&self, watch: &dyn Watch) -> Result<&([States; 2], Vec<u32>), Interrupted> {
        if let Some(classes) = self.partition.get() {
            return Ok(classes);
        }
        let [mut one, other] = self.worlds.each_ref().map(Space::new);
        let beyond = one.labels.len() as u32;
        let all = beyond + other.labels.len() as u32;
        let count = one.maps.len().max(other.maps.len());
        one.maps.resize_with(count, || (0..beyond).collect());
        for (map, of_other) in one.maps.iter_mut().zip(&other.maps) {
            map.extend(of_other.iter().map(|to| to + beyond));
        }
        for map in &mut one.maps {
            map.extend(map.len() as u32..all);
        }
        let labels = [one.labels, other.labels].concat();
        let class = coarsest(&labels, &one.maps, watch)?;
        Ok(self.partition.get_or_init(|| ([one.states, other.states], class)))
    }

    fn in_one_class(&self, poses: [Dart; 2], watch: &dyn Watch) -> Result<bool, Interrupted> {
        let [one, other] = self.starts(poses);
        let (states, class) = self.classes(watch)?;
        let here = states[0].number(&one.state()).map(|here| here as usize);
        let there = states[1].number(&other.state()).map(|there| states[0].len() + there as usize);
        let class = |state: Option<usize>| state.and_then(|state| class.get(state));
        Ok(class(here).is_some() && class(here) == class(there))
    }

    /// The two worlds with their markers where they were placed, and in each a robot that has come in
    /// by such a dart, which is one of the graph's.
    pub fn starts(&self, poses: [Dart; 2]) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        let begun = |world: &PlacedRobot<'a>, pose| {
            let start = State { pose, ..world.state() };
            world.clone().at(start)
        };
        [begun(one, poses[0]), begun(other, poses[1])]
    }

    /// Whether no walk from these starts distinguishes the worlds.
    // paper: marker.undirected-insufficient, marker.none-cycles
    pub fn indistinguishable(&self, poses: [Dart; 2]) -> bool {
        // Nothing stops it.
        self.in_one_class(poses, &()).unwrap_or_default()
    }

    /// The first start in the second world that is indistinguishable from this pose in the first. The
    /// robot in the second world may begin in any pose that places the marker alike. Returns `None` if
    /// each of these starts has a walk that distinguishes it.
    pub fn start_like(&self, pose: Dart) -> Option<Dart> {
        let world = &self.worlds[1];
        let starts = world.aid().starts(world.graph(), world.pose());
        starts.into_iter().find(|&other| self.indistinguishable([pose, other]))
    }

    /// Why they cannot: all pairs of states that they can be in, breadth-first; `None` if they
    /// can. There are at most as many pairs as states of the one times states of the other.
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
        if self.partition.get().is_some() && !self.in_one_class(poses, watch)? {
            return Ok(None);
        }
        let mut pairs = Pairs::new(self.starts(poses));
        let mut look = pairs.reach(self.few_pairs().min(most_pairs), watch)?;
        if matches!(look, Look::Enough) && self.in_one_class(poses, watch)? {
            look = pairs.reach(most_pairs, watch)?;
            if matches!(look, Look::Enough) {
                let (states, class) = self.classes(watch)?.clone();
                let classes = StateClasses::new(states, class);
                return Ok(Some(Bisimulation::Classes(classes)));
            }
        }
        Ok(match look {
            Look::Difference(_) | Look::Enough => None,
            Look::NoMore => Some(Bisimulation::Relation(pairs.into_relation())),
        })
    }

    /// Does the same as [`walk_watched`](Self::walk_watched). Nothing stops it.
    pub fn walk(&self, poses: [Dart; 2]) -> Option<Walk> {
        self.walk_watched(poses, &()).unwrap_or_default()
    }

    /// How they can: the shortest walk, and of these the least; `None` where they cannot.
    ///
    /// # Errors
    /// Returns an error if the watch stops.
    pub fn walk_watched(
        &self,
        poses: [Dart; 2],
        watch: &dyn Watch,
    ) -> Result<Option<Walk>, Interrupted> {
        if self.partition.get().is_some() && self.in_one_class(poses, watch)? {
            return Ok(None);
        }
        let mut pairs = Pairs::new(self.starts(poses));
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
        let states = |world: &PlacedRobot<'_>| {
            let graph = world.graph();
            let places = if world.aid().moves() { graph.vertex_count() + 1 } else { 1 };
            graph.dart_count().saturating_mul(places)
        };
        self.worlds.iter().map(states).sum::<usize>().saturating_mul(4)
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
    pub fn verify<'a>(&self, one: &PlacedRobot<'a>, other: &PlacedRobot<'a>) -> bool {
        match self {
            Self::Relation(relation) => relation.verify(one, other),
            Self::Classes(classes) => classes.verify(one, other),
        }
    }
}

/// How a look for a difference ended.
enum Look {
    Difference(Walk),
    NoMore,
    /// As many pairs as were wanted have been found.
    Enough,
}

/// The number of pairs after which the watch is asked whether to stop.
const BETWEEN_QUESTIONS: usize = 256;

/// Pairs of states that robots that do the same can reach, breadth-first; those of a length in the
/// order of the least walks that lead to them.
struct Pairs<'a> {
    worlds: [PlacedRobot<'a>; 2],
    /// The numbers of the states of each world that were met.
    numbers: [HashMap<State<Places>, u32>; 2],
    found: Vec<ReachedPair>,
    /// The place of the pair to look further from.
    next: usize,
    known: HashSet<[u32; 2]>,
}

/// A pair of states, with the earlier pair and the action by which it was reached.
struct ReachedPair {
    pair: (State<Places>, State<Places>),
    from: Option<(usize, Action)>,
}

impl<'a> Pairs<'a> {
    fn new(worlds: [PlacedRobot<'a>; 2]) -> Self {
        let pair = (worlds[0].state(), worlds[1].state());
        let numbers = [HashMap::new(), HashMap::new()];
        let mut pairs = Self { worlds, numbers, found: Vec::new(), next: 0, known: HashSet::new() };
        pairs.find(pair, None);
        pairs
    }

    fn find(
        &mut self,
        pair: (State<Places>, State<Places>),
        from: Option<(usize, Action)>,
    ) -> bool {
        let [one, other] = &mut self.numbers;
        let moves = self.worlds[0].aid().moves();
        let number = |known: &mut HashMap<State<Places>, u32>, state: &State<Places>| {
            // The states of a robot with a fixed marker are its poses.
            if !moves {
                return state.pose.0;
            }
            if let Some(&number) = known.get(state) {
                return number;
            }
            let number = known.len() as u32;
            known.insert(state.clone(), number);
            number
        };
        let new = self.known.insert([number(one, &pair.0), number(other, &pair.1)]);
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
        while let Some(pair) = self.found.get(self.next).map(|found| found.pair.clone()) {
            if self.next.is_multiple_of(BETWEEN_QUESTIONS) {
                watch.check_stop()?;
            }
            let [mut one, mut other] = self.at(&pair);
            if self.next == 0 && one.sensed() != other.sensed() {
                return Ok(self.difference_at(0));
            }
            if self.found.len() > most {
                return Ok(Look::Enough);
            }
            for action in one.actions() {
                // Robots that perceive the same can do the same.
                let acted = one.act(action).and_then(|()| other.act(action));
                let from = Some((self.next, action));
                let states = (one.state(), other.state());
                let is_new = acted.is_ok() && self.find(states, from);
                if is_new && one.sensed() != other.sensed() {
                    return Ok(self.difference_at(self.found.len() - 1));
                }
                (one, other) = (one.at(pair.0.clone()), other.at(pair.1.clone()));
            }
            self.next += 1;
        }
        Ok(Look::NoMore)
    }

    fn at(&self, (here, there): &(State<Places>, State<Places>)) -> [PlacedRobot<'a>; 2] {
        let [one, other] = &self.worlds;
        [one.clone().at(here.clone()), other.clone().at(there.clone())]
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
        let percepts = self.at(&self.found[place].pair).map(|robot| robot.sensed());
        Look::Difference(Walk { actions, percepts })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{aid::named, any_graph::StopAt};

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

    fn cycles(lengths: [usize; 2]) -> [EmbeddedGraph; 2] {
        lengths.map(EmbeddedGraph::cycle)
    }

    /// Without a marker.
    fn comparison(graphs: &[EmbeddedGraph; 2]) -> Comparison<'_> {
        let [one, other] = graphs.each_ref().map(|graph| (graph, Dart(0)));
        Comparison::new(named("none").unwrap(), one, other)
    }

    /// Without a marker no walk distinguishes cycles. If their lengths `n` and `m` are coprime, two robots
    /// reach all `2 n m` pairs of poses that agree on the sense.
    #[test]
    fn the_partition_is_made_only_where_there_are_many_pairs() {
        for (shorter, longer, is_made) in [(3, 4, false), (8, 9, true)] {
            let graphs = cycles([shorter, longer]);
            let (pairs, states) = (2 * shorter * longer, 2 * (shorter + longer));
            assert_eq!(pairs > 4 * states, is_made);
            let asked = comparison(&graphs);
            assert_eq!(asked.relation([Dart(0); 2]).unwrap().0.len(), pairs);
            assert_eq!(asked.partition.get().is_some(), is_made);
            let asked = comparison(&graphs);
            assert_eq!(asked.walk([Dart(0); 2]), None);
            assert_eq!(asked.partition.get().is_some(), is_made);
        }
    }

    #[test]
    fn many_pairs_are_replaced_by_the_classes() {
        let graphs = cycles([200, 201]);
        let comparison = comparison(&graphs);
        let [one, other] = comparison.starts([Dart(0); 2]);
        let pairs = 2 * 200 * 201;
        for most in [pairs, pairs - 1] {
            let found = comparison.bisimulation([Dart(0); 2], most, &()).unwrap().unwrap();
            assert!(found.verify(&one, &other));
            match found {
                Bisimulation::Relation(relation) => assert_eq!(relation.0.len(), most),
                // All poses look alike.
                Bisimulation::Classes(classes) => {
                    assert_eq!((classes.count(), most), (1, pairs - 1));
                    assert_eq!(classes.classes()[0].each_ref().map(Vec::len), [400, 402]);
                }
            }
        }
    }

    type Search = fn(&Comparison, &dyn Watch) -> bool;

    #[test]
    fn each_search_ends_at_the_question_at_which_it_is_stopped() {
        let graphs = cycles([40, 41]);
        let comparison = || comparison(&graphs);
        let searches: [Search; 3] = [
            |comparison, watch| comparison.partition(watch) == Err(Interrupted),
            |comparison, watch| comparison.walk_watched([Dart(0); 2], watch) == Err(Interrupted),
            |comparison, watch| comparison.bisimulation([Dart(0); 2], usize::MAX, watch).is_err(),
        ];
        for is_stopped in searches {
            let questions = |at, ends| {
                let limit = StopAt::new(at);
                assert_eq!(is_stopped(&comparison(), &limit), ends);
                limit.asked()
            };
            let all = questions(u64::MAX, false);
            assert!(all > 0);
            for at in 1..=all {
                assert_eq!(questions(at, true), at);
            }
        }
    }

    /// Robots in cycles of 9 and of 10 junctions come into a great many pairs of poses before one of
    /// them comes to the end of the one way that is longer.
    #[test]
    fn a_difference_is_found_that_many_pairs_come_before() {
        let length = 400;
        let graphs = [cycle_of_ways(9, length, length), cycle_of_ways(10, length, length + 1)];
        let poses = [Dart(0); 2];
        let asked = comparison(&graphs);
        let walk = asked.walk(poses).unwrap();
        assert!(asked.partition.get().is_some());
        let [here, there] = asked.starts(poses);
        assert!(walk.verify(&here, &there));
        // Also once the partition is made, and for the relation.
        assert_eq!(asked.walk(poses), Some(walk));
        assert_eq!(asked.relation(poses), None);
        assert_eq!(comparison(&graphs).relation(poses), None);
    }
}
