//! All worlds of a class that a marker does not distinguish, up to a number of edges.
//!
//! Placed worlds are indistinguishable exactly when their quotients are equal. So one pass over all
//! worlds and a grouping find them, without comparing each pair.

use std::ops::ControlFlow;

use super::{
    AmbiguousGroup, Comparison, Findings, PlacedWorld, SizeFindings, Unfinished,
    findings::rank,
    quotient::{Quotient, QuotientCode},
    space::{Space, States},
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{
        Class, Each, EnumeratedGraph, Enumeration, EnumerationPart, SizeError, Watch, in_parts,
    },
    isomorphism::{as_discovered, canonical, code},
    marker::Marker,
    union_find::UnionFind,
    world::State,
};

/// A search over all placed worlds of a class with 1 to some number of edges.
#[derive(Clone, Debug)]
pub struct AmbiguitySearch<'m> {
    /// The worlds of each size, from 1 edge.
    sizes: Vec<Enumeration>,
    marker: &'m dyn Marker,
}

/// The result of one part of the search.
#[derive(Default)]
struct Seen {
    placed_worlds: u64,
    /// The worlds that may be ambiguous, with the codes of their quotients.
    candidates: Vec<(QuotientCode, PlacedWorld)>,
    interrupted: bool,
}

impl<'m> AmbiguitySearch<'m> {
    /// A search over the worlds with 1 to `edges` edges.
    ///
    /// # Errors
    /// Returns an error if they cannot be enumerated.
    pub fn new(class: Class, edges: usize, marker: &'m dyn Marker) -> Result<Self, SizeError> {
        // A number of edges that is refused is refused before those below it.
        Enumeration::new(Each::World, class, edges)?;
        let sizes = (1..=edges).map(|edges| Enumeration::new(Each::World, class, edges));
        Ok(Self { sizes: sizes.collect::<Result<_, _>>()?, marker })
    }

    /// Makes the search. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// Returns an error if the watch interrupts the search, or a pair is not confirmed.
    pub fn run(&self, watch: &dyn Watch) -> Result<Findings, Unfinished> {
        let mut sizes = Vec::new();
        let mut candidates = Vec::new();
        for (worlds, edges) in self.sizes.iter().zip(1..) {
            let seen = self.look_at(worlds, watch);
            if seen.interrupted {
                return Err(Unfinished::Interrupted);
            }
            sizes.push(SizeFindings { edges, placed_worlds: seen.placed_worlds, ambiguous: 0 });
            candidates.extend(seen.candidates);
        }
        let groups = self.grouped(candidates, watch)?;
        for world in groups.iter().flat_map(|group| &group.worlds) {
            sizes[world.graph.edge_count() - 1].ambiguous += 1;
        }
        Ok(Findings { sizes, groups })
    }

    fn look_at(&self, worlds: &Enumeration, watch: &dyn Watch) -> Seen {
        let look = |part: &EnumerationPart| {
            let mut seen = Seen::default();
            let end = part.for_each(&mut |found| {
                self.search_graph(found, &mut seen);
                if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            seen.interrupted = end.is_break();
            seen
        };
        let merge = |mut seen: Seen, later: Seen| {
            seen.placed_worlds += later.placed_worlds;
            seen.candidates.extend(later.candidates);
            seen.interrupted |= later.interrupted;
            seen
        };
        in_parts(&worlds.parts(), watch, Seen::default, look, |seen| seen.placed_worlds, merge)
    }

    /// Searches all ways to place the marker in a graph.
    fn search_graph(&self, found: EnumeratedGraph, seen: &mut Seen) {
        let EnumeratedGraph { graph, automorphisms } = found;
        let mut refined: Option<(States, Quotient)> = None;
        for places in self.placings(graph, automorphisms) {
            seen.placed_worlds += 1;
            let facing = places[0];
            // The states of a world do not depend on where a movable marker lies at first.
            let known = refined.take().filter(|_| self.marker.is_movable());
            let (states, quotient) = known.unwrap_or_else(|| {
                let states = States::of(graph, self.marker, facing);
                let quotient = Quotient::of(&Space::of(graph, self.marker, &states));
                (states, quotient)
            });
            // A world without two indistinguishable states shares its percepts only with its covers,
            // which have at least twice as many edges.
            if !quotient.is_discrete() || 2 * graph.edge_count() <= self.sizes.len() {
                let placed_at = Some(self.marker.first_alike(graph, facing));
                let begun = |&pose| states.number(State { pose, placed: placed_at });
                let starts = self.marker.starts(graph, facing);
                let codes = starts.iter().map(begun).map(|state| quotient.code(state));
                if let Some(least) = codes.min() {
                    seen.candidates.push((least, placed(graph, &places)));
                }
            }
            refined = Some((states, quotient));
        }
    }

    /// For each placed world of a graph, the facing darts that place the marker so. Both the darts and
    /// the worlds are in the order of the darts' numbers.
    fn placings(&self, graph: &EmbeddedGraph, automorphisms: u32) -> Vec<Vec<Dart>> {
        let mut alike = UnionFind::new(graph.dart_count());
        for dart in graph.darts() {
            alike.union(dart.0, self.marker.first_alike(graph, dart).0);
        }
        if automorphisms > 1 {
            for (dart, least) in graph.darts().zip(canonical(graph).orbit) {
                alike.union(dart.0, least.0);
            }
        }
        let mut places: Vec<Vec<Dart>> = Vec::new();
        let mut place_of = vec![None; graph.dart_count()];
        for dart in graph.darts() {
            let root = alike.find(dart.0) as usize;
            let place = *place_of[root].get_or_insert_with(|| {
                places.push(Vec::new());
                places.len() - 1
            });
            places[place].push(dart);
        }
        places
    }

    /// The groups of candidates with the same code. Each world is confirmed by a relation with the
    /// first of its group.
    fn grouped(
        &self,
        mut candidates: Vec<(QuotientCode, PlacedWorld)>,
        watch: &dyn Watch,
    ) -> Result<Vec<AmbiguousGroup>, Unfinished> {
        candidates.sort_by(|(code, world), (other_code, other)| {
            code.cmp(other_code).then_with(|| world.rank().cmp(&other.rank()))
        });
        let alike = candidates.chunk_by(|(code, _), (other, _)| code == other);
        let alike: Vec<_> = alike.filter(|alike| alike.len() > 1).collect();
        let pairs: Vec<[&PlacedWorld; 2]> = alike
            .iter()
            .flat_map(|alike| alike.iter().map(|(_, world)| [&alike[0].1, world]))
            .collect();
        let confirm = |&pair: &[&PlacedWorld; 2]| {
            if watch.stop() {
                Err(Unfinished::Interrupted)
            } else if is_confirmed(self.marker, pair) {
                Ok(())
            } else {
                Err(Unfinished::Unconfirmed(Box::new(pair.map(PlacedWorld::clone))))
            }
        };
        in_parts(&pairs, &(), || Ok(()), confirm, |_| 1, Result::and)?;
        let group = |alike: &[(QuotientCode, PlacedWorld)]| AmbiguousGroup {
            worlds: alike.iter().map(|(_, world)| world.clone()).collect(),
        };
        let mut groups: Vec<_> = alike.into_iter().map(group).collect();
        groups.sort_by(|one, other| one.smallest().map(rank).cmp(&other.smallest().map(rank)));
        Ok(groups)
    }
}

/// Whether a verified relation shows that two placed worlds are indistinguishable.
fn is_confirmed(marker: &dyn Marker, [one, other]: [&PlacedWorld; 2]) -> bool {
    let start = PlacedWorld::FACING;
    let comparison = Comparison::new(marker, (&one.graph, start), (&other.graph, start));
    comparison.start_like(start).is_some_and(|pose| {
        let [here, there] = comparison.starts([start, pose]);
        let relation = comparison.relation([start, pose]);
        relation.is_some_and(|relation| relation.verify(&here, &there))
    })
}

/// The placed world of these facing darts, which all place the marker alike.
fn placed(graph: &EmbeddedGraph, places: &[Dart]) -> PlacedWorld {
    let least = places.iter().map(|&facing| (code(graph, facing), facing)).min();
    let (code, facing) = least.unwrap_or_else(|| (code(graph, Dart(0)), Dart(0)));
    PlacedWorld { graph: as_discovered(graph, facing), code }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::marker::named;

    #[test]
    fn worlds_that_a_walk_tells_apart_are_not_confirmed() {
        for marker in ["none", "undirected", "movable"].map(|name| named(name).unwrap()) {
            let findings =
                AmbiguitySearch::new(Class::Multigraph, 3, marker).unwrap().run(&()).unwrap();
            let groups: Vec<_> = findings.groups.iter().map(|group| &group.worlds).collect();
            for (one, other) in groups.iter().zip(groups.iter().skip(1)) {
                assert!(is_confirmed(marker, [&one[0], &one[1]]));
                assert!(!is_confirmed(marker, [&one[0], &other[0]]));
            }
            assert!(groups.len() > 1);
        }
    }

    #[test]
    fn a_group_that_is_not_confirmed_is_an_error() {
        let search = AmbiguitySearch::new(Class::Simple, 4, named("undirected").unwrap()).unwrap();
        let seen = search.look_at(&search.sizes[3], &());
        let chains = AmbiguitySearch::new(Class::Simple, 4, named("none").unwrap()).unwrap();
        let seen = [seen, chains.look_at(&chains.sizes[3], &())];
        let worlds: Vec<_> = seen.into_iter().flat_map(|seen| seen.candidates).collect();
        // As if all of these had the same quotient.
        let same = worlds.into_iter().map(|(_, world)| (QuotientCode::new(), world)).collect();
        assert!(matches!(search.grouped(same, &()), Err(Unfinished::Unconfirmed(_))));
    }

    /// A cover has at least twice as many edges.
    #[test]
    fn a_world_whose_states_can_be_told_apart_is_a_candidate_only_where_it_has_covers() {
        let search = AmbiguitySearch::new(Class::Simple, 5, named("undirected").unwrap()).unwrap();
        let counts = |edges: usize| {
            let seen = search.look_at(&search.sizes[edges - 1], &());
            (seen.placed_worlds, seen.candidates.len())
        };
        // A chain of two, marked at an end or in the middle, might have a cover with 4 edges.
        assert_eq!(counts(2), (2, 2));
        // With 3 edges there is a triangle, or a star marked in the middle, and two chains and a star
        // in which the robot always knows where it is.
        assert_eq!(counts(3), (5, 2));
    }

    /// Among the facing darts that place a marker alike, the one with the least code is reported.
    #[test]
    fn a_placed_world_is_represented_by_its_least_start() {
        for marker in ["none", "undirected", "two-identical"].map(|name| named(name).unwrap()) {
            let findings =
                AmbiguitySearch::new(Class::Multigraph, 4, marker).unwrap().run(&()).unwrap();
            for world in findings.groups.iter().flat_map(|group| &group.worlds) {
                let graph = &world.graph;
                let place = marker.first_alike(graph, PlacedWorld::FACING);
                let alike = graph.darts().filter(|&d| marker.first_alike(graph, d) == place);
                let least = alike.map(|facing| code(graph, facing)).min();
                assert_eq!(least.as_ref(), Some(&world.code), "{marker:?}");
                assert_eq!(code(graph, PlacedWorld::FACING), world.code);
            }
        }
    }
}
