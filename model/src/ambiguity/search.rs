//! All worlds of a class that a marker does not distinguish, up to a number of edges.
//!
//! Placed worlds are indistinguishable exactly when their quotients are equal. So one pass over all
//! worlds and a sort by quotient find them, without comparing each pair.

use std::ops::ControlFlow;

use petgraph::unionfind::UnionFind;

use super::{
    AmbiguityCandidate, CandidateSorter, CandidatesInMemory, Findings, KeptPairs, SearchError,
    SizeFindings, Unfinished,
    grouping::Grouping,
    quotient::{Quotient, placed_code},
    space::States,
};
use crate::{
    aid::{Aid, AnyAid, State},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{
        Class, Each, EnumeratedGraph, Enumeration, EnumerationPart, SizeError, Watch, in_parts,
    },
    isomorphism::canonical,
    world::GraphWorld,
};

/// A search over all placed worlds of a class with 1 to some number of edges.
#[derive(Clone, Debug)]
pub struct AmbiguitySearch<'m> {
    /// The worlds of each size, from 1 edge.
    sizes: Vec<Enumeration>,
    aid: AnyAid<'m>,
}

/// A part of a search: some worlds of one size.
#[derive(Clone, Copy, Debug)]
pub struct SearchPart {
    edges: usize,
    part: EnumerationPart,
}

impl SearchPart {
    pub fn edges(&self) -> usize {
        self.edges
    }
}

/// The number of candidates that a part of the search collects before it gives them to the sorter.
const BATCH: usize = 1024;

struct Seen {
    placed_worlds: u64,
    /// Those that the sorter did not get yet.
    candidates: Vec<AmbiguityCandidate>,
    end: Result<(), SearchError>,
}

impl Default for Seen {
    fn default() -> Self {
        Self { placed_worlds: 0, candidates: Vec::new(), end: Ok(()) }
    }
}

impl<'m> AmbiguitySearch<'m> {
    /// A search over the worlds with 1 to `edges` edges.
    ///
    /// # Errors
    /// Returns an error if they cannot be enumerated.
    pub fn new(class: Class, edges: usize, aid: impl Into<AnyAid<'m>>) -> Result<Self, SizeError> {
        // A number of edges that is refused is refused before those below it.
        Enumeration::new(Each::World, class, edges)?;
        let sizes = (1..=edges).map(|edges| Enumeration::new(Each::World, class, edges));
        Ok(Self { sizes: sizes.collect::<Result<_, _>>()?, aid: aid.into() })
    }

    /// Makes the search. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// Returns an error if the watch interrupts the search, or a pair is not confirmed.
    pub fn run(&self, watch: &dyn Watch) -> Result<Findings, Unfinished> {
        let sorter = Box::new(CandidatesInMemory::default());
        self.run_sorted(sorter, KeptPairs::All, watch).map_err(|error| match error {
            SearchError::Unfinished(unfinished) => unfinished,
            SearchError::Sorter(_) => Unfinished::Unreadable,
        })
    }

    /// Makes the search with a sorter for its candidates. The result is that of [`run`](Self::run), as far as it is
    /// kept.
    ///
    /// # Errors
    /// Returns an error if the watch interrupts the search, the sorter fails, or a pair is not confirmed.
    pub fn run_sorted(
        &self,
        sorter: Box<dyn CandidateSorter + '_>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<Findings, SearchError> {
        let mut sizes = Vec::new();
        for (worlds, edges) in self.sizes.iter().zip(1..) {
            let placed_worlds = self.look_at(worlds, sorter.as_ref(), watch)?;
            sizes.push(SizeFindings { edges, placed_worlds, ambiguous: 0 });
        }
        let mut grouping = Grouping::new(self.aid, sizes, kept, watch);
        for candidate in sorter.sorted().map_err(SearchError::Sorter)? {
            grouping.add(candidate.map_err(SearchError::Sorter)?)?;
        }
        Ok(grouping.findings()?)
    }

    /// The parts of the search, those of small worlds first. Equal searches have equal parts on every machine.
    pub fn parts(&self) -> Vec<SearchPart> {
        let parts = |(worlds, edges): (&Enumeration, usize)| {
            worlds.parts().into_iter().map(move |part| SearchPart { edges, part })
        };
        self.sizes.iter().zip(1..).flat_map(parts).collect()
    }

    /// The number of placed worlds in a part, and those that may be ambiguous.
    pub fn look_at_part(&self, part: &SearchPart) -> (u64, Vec<AmbiguityCandidate>) {
        let mut seen = Seen::default();
        let _ = part.part.for_each(&mut |found| {
            self.search_graph(found, &mut seen);
            ControlFlow::Continue(())
        });
        (seen.placed_worlds, seen.candidates)
    }

    /// The findings among all candidates of some quotients, which may be in any order. No placed worlds are
    /// counted.
    ///
    /// # Errors
    /// Returns an error if the watch interrupts the search, or a pair is not confirmed.
    pub fn grouped(
        &self,
        mut candidates: Vec<AmbiguityCandidate>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<Findings, Unfinished> {
        candidates.sort_unstable();
        let size = |edges| SizeFindings { edges, placed_worlds: 0, ambiguous: 0 };
        let sizes = (1..=self.sizes.len()).map(size).collect();
        let mut grouping = Grouping::new(self.aid, sizes, kept, watch);
        for candidate in candidates {
            grouping.add(candidate)?;
        }
        grouping.findings()
    }

    /// Looks at the worlds of one size, and returns the number of placed worlds.
    fn look_at(
        &self,
        worlds: &Enumeration,
        sorter: &dyn CandidateSorter,
        watch: &dyn Watch,
    ) -> Result<u64, SearchError> {
        let look = |part: &EnumerationPart| {
            let mut seen = Seen::default();
            let give = |seen: &mut Seen| {
                let added = sorter.add(std::mem::take(&mut seen.candidates));
                added.map_err(|error| seen.end = Err(SearchError::Sorter(error)))
            };
            let ended = part.for_each(&mut |found| {
                self.search_graph(found, &mut seen);
                if seen.candidates.len() >= BATCH && give(&mut seen).is_err() {
                    return ControlFlow::Break(());
                }
                if watch.stop() {
                    seen.end = Err(Unfinished::Interrupted.into());
                    return ControlFlow::Break(());
                }
                ControlFlow::Continue(())
            });
            if ended.is_continue() {
                let _ = give(&mut seen);
            }
            seen
        };
        let merge = |one: Seen, later: Seen| Seen {
            placed_worlds: one.placed_worlds + later.placed_worlds,
            end: one.end.and(later.end),
            ..Seen::default()
        };
        let seen =
            in_parts(&worlds.parts(), watch, Seen::default, look, |seen| seen.placed_worlds, merge);
        seen.end.map(|()| seen.placed_worlds)
    }

    fn search_graph(&self, found: EnumeratedGraph, seen: &mut Seen) {
        let EnumeratedGraph { graph, automorphisms } = found;
        let mut refined: Option<(Quotient, States)> = None;
        for places in self.placings(graph, automorphisms) {
            seen.placed_worlds += 1;
            let facing = places[0];
            let start = GraphWorld::with_aid(graph, self.aid, facing);
            // An aid that moves comes to the same states wherever it is at first.
            let known =
                refined.take().filter(|(_, states)| states.number(&start.state()).is_some());
            let (quotient, states) = known.unwrap_or_else(|| Quotient::new(&start));
            // A world without two indistinguishable states shares its percepts only with its covers,
            // which have at least twice as many edges.
            if !quotient.is_discrete() || 2 * graph.edge_count() <= self.sizes.len() {
                let begun = |&pose| states.number(&State { pose, ..start.state() });
                let starts = self.aid.starts(graph, facing);
                let codes = starts.iter().filter_map(begun).map(|state| quotient.code(state));
                if let Some(least) = codes.min() {
                    let placed = placed_code(graph, places);
                    seen.candidates.push(AmbiguityCandidate::new(&least, &placed));
                }
            }
            refined = Some((quotient, states));
        }
    }

    /// For each placed world of a graph, the facing darts that place the marker so. Both the darts and
    /// the worlds are in the order of the darts' numbers.
    fn placings(&self, graph: &EmbeddedGraph, automorphisms: u32) -> Vec<Vec<Dart>> {
        let mut alike = UnionFind::<u32>::new(graph.dart_count());
        for dart in graph.darts() {
            alike.union(dart.0, self.aid.first_alike(graph, dart).0);
        }
        if automorphisms > 1 {
            for (dart, least) in graph.darts().zip(canonical(graph).orbit) {
                alike.union(dart.0, least.0);
            }
        }
        let mut places: Vec<Vec<Dart>> = Vec::new();
        let mut place_of = vec![None; graph.dart_count()];
        for dart in graph.darts() {
            let root = alike.find_mut(dart.0) as usize;
            let place = *place_of[root].get_or_insert_with(|| {
                places.push(Vec::new());
                places.len() - 1
            });
            places[place].push(dart);
        }
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{aid::named, ambiguity::PlacedWorld, isomorphism::code};

    /// A cover has at least twice as many edges.
    #[test]
    fn a_world_whose_states_can_be_told_apart_is_a_candidate_only_where_it_has_covers() {
        let search = AmbiguitySearch::new(Class::Simple, 5, named("undirected").unwrap()).unwrap();
        let counts = |edges: usize| {
            let sorter = Box::new(CandidatesInMemory::default());
            let worlds = &search.sizes[edges - 1];
            let placed_worlds = search.look_at(worlds, sorter.as_ref(), &()).unwrap();
            (placed_worlds, sorter.sorted().unwrap().count())
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
