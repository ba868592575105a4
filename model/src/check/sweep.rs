//! Runs an algorithm on every start of many worlds.

use std::{fmt, ops::ControlFlow, str::FromStr};

use thiserror::Error;

use super::{
    Algorithm, AlgorithmExplorer, Explorer, FailedStart, FalseStep, RunState, Tally,
    first_false_step, judge_start, tally::CheckedStart,
};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::{Class, Each, Enumeration, SizeError, Watch, in_parts},
    folding::MarkerTree,
    isomorphism::{Candidate, canonical},
    marker::{Directional, Marker},
};

/// One of `n` disjoint parts of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    index: usize,
    /// The number of shards.
    of: usize,
}

/// The error for a text that is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a shard; write i/n with i from 1 to n, for example 2/4")]
pub struct ShardError(String);

impl Shard {
    /// The whole check.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// Its number, from 1.
    #[must_use]
    pub fn index(self) -> usize {
        self.index
    }

    /// The number of shards.
    #[must_use]
    pub fn of(self) -> usize {
        self.of
    }

    /// The parts of the whole that belong to the shard.
    pub(super) fn select<P>(self, parts: Vec<P>) -> Vec<P> {
        parts.into_iter().skip(self.index - 1).step_by(self.of).collect()
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let shard = text.split_once('/').and_then(|(index, of)| {
            let number = |text: &str| {
                let digits = text.bytes().all(|byte| byte.is_ascii_digit());
                digits.then(|| text.parse().ok()).flatten()
            };
            Some(Self { index: number(index)?, of: number(of)? })
        });
        shard
            .filter(|shard| (1..=shard.of).contains(&shard.index))
            .ok_or_else(|| ShardError(text.to_owned()))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{}/{}", self.index, self.of)
    }
}

/// A check of every start of every world of a class with a number of edges.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    worlds: Enumeration,
    shard: Shard,
}

impl Sweep {
    /// A check of one shard of the worlds.
    ///
    /// # Errors
    /// Returns an error if the worlds cannot be enumerated.
    pub fn new(class: Class, edges: usize, shard: Shard) -> Result<Self, SizeError> {
        Ok(Self { worlds: Enumeration::new(Each::World, class, edges)?, shard })
    }

    /// The class of worlds.
    #[must_use]
    pub fn class(&self) -> Class {
        self.worlds.class()
    }

    /// Checks an algorithm. The result does not depend on the number of threads (that of rayon's
    /// pool, or 1 without the feature `rayon`).
    pub fn run(&self, algorithm: &impl Algorithm, watch: &dyn Watch) -> Tally {
        self.tally(watch, || AlgorithmChecker::new(algorithm, watch))
    }

    /// Checks explorers, each on one part of the worlds. The result does not depend on the number of
    /// threads, unless an explorer depends on what it explored before.
    pub fn run_explorers<E: Explorer>(
        &self,
        new: impl Fn() -> E + Sync,
        watch: &dyn Watch,
    ) -> Tally {
        self.tally(watch, || ExplorerChecker { explorer: new(), candidate: Candidate::default() })
    }

    fn tally<C: StartChecker>(&self, watch: &dyn Watch, new: impl Fn() -> C + Sync) -> Tally {
        let parts = self.shard.select(self.worlds.parts());
        tally_parts(&parts, watch, |part, tally| {
            let mut part_checker = PartChecker::new(new(), watch);
            part.for_each(&mut |found| {
                part_checker.check_starts(found.graph, found.automorphisms as usize, tally)
            })
        })
    }
}

/// Runs the algorithm on every start of some worlds. As with a [`Sweep`], the result does not depend
/// on the number of threads.
pub fn check_worlds(
    graphs: &[EmbeddedGraph],
    algorithm: &impl Algorithm,
    watch: &dyn Watch,
) -> Tally {
    check_parts(graphs, watch, || AlgorithmChecker::new(algorithm, watch))
}

/// Runs explorers on every start of some worlds, each on one part of them.
pub fn check_worlds_with<E: Explorer>(
    graphs: &[EmbeddedGraph],
    new: impl Fn() -> E + Sync,
    watch: &dyn Watch,
) -> Tally {
    check_parts(graphs, watch, || ExplorerChecker {
        explorer: new(),
        candidate: Candidate::default(),
    })
}

fn check_parts<C: StartChecker>(
    graphs: &[EmbeddedGraph],
    watch: &dyn Watch,
    new: impl Fn() -> C + Sync,
) -> Tally {
    let parts: Vec<_> = graphs.chunks(64).collect();
    tally_parts(&parts, watch, |part, tally| {
        let mut part_checker = PartChecker::new(new(), watch);
        part.iter().try_for_each(|graph| {
            part_checker.check_starts(graph, canonical(graph).automorphisms, tally)
        })
    })
}

pub(super) fn go_on(watch: &dyn Watch) -> ControlFlow<()> {
    if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Checks the parts of a whole, and adds up the tallies.
fn tally_parts<P: Sync>(
    parts: &[P],
    watch: &dyn Watch,
    check: impl Fn(&P, &mut Tally) -> ControlFlow<()> + Sync + Send,
) -> Tally {
    let check = |part: &P| {
        let mut tally = Tally::default();
        tally.interrupted = go_on(watch).is_break() || check(part, &mut tally).is_break();
        tally
    };
    let merge = |mut sum: Tally, later: Tally| {
        sum.merge(later);
        sum
    };
    in_parts(parts, watch, Tally::default, check, |tally| tally.starts, merge)
}

/// Checks one start after the other. Memory is kept from start to start.
trait StartChecker {
    /// The marker of the starts.
    fn marker(&self) -> impl Marker;

    fn check_start(&mut self, start: CheckedStart, tally: &mut Tally);
}

/// Checks the worlds of one part.
struct PartChecker<'w, C> {
    checker: C,
    watch: &'w dyn Watch,
    /// Measures certificates, if the marker has them.
    certificates: Option<MarkerTree>,
}

impl<'w, C: StartChecker> PartChecker<'w, C> {
    fn new(checker: C, watch: &'w dyn Watch) -> Self {
        let directional = checker.marker().name() == Directional.name();
        Self { checker, watch, certificates: directional.then(MarkerTree::default) }
    }

    /// Checks every start of a world.
    fn check_starts(
        &mut self,
        graph: &EmbeddedGraph,
        automorphisms: usize,
        tally: &mut Tally,
    ) -> ControlFlow<()> {
        tally.worlds += 1;
        // The starts at one vertex follow one another, and have one certificate.
        let mut measured: Option<(Vertex, u64)> = None;
        let mut check = |facing| {
            let vertex = graph.vertex(facing);
            if let Some(tree) = &mut self.certificates
                && measured.is_none_or(|(at, _)| at != vertex)
            {
                tree.grow(graph, vertex);
                measured = Some((vertex, tree.length(graph) as u64));
            }
            let certificate = measured.map(|(_, length)| length);
            let start = CheckedStart { graph, facing, certificate };
            tally.count_start(start);
            self.checker.check_start(start, tally);
            go_on(self.watch)
        };
        if automorphisms == 1 {
            graph.darts().try_for_each(check)
        } else {
            // Darts that an automorphism takes to each other are the same start.
            let orbit = canonical(graph).orbit;
            graph.darts().filter(|dart| orbit[dart.at()] == *dart).try_for_each(&mut check)
        }
    }
}

struct ExplorerChecker<E> {
    explorer: E,
    candidate: Candidate,
}

impl<E: Explorer> StartChecker for ExplorerChecker<E> {
    fn marker(&self) -> impl Marker {
        self.explorer.marker()
    }

    fn check_start(&mut self, start: CheckedStart, tally: &mut Tally) {
        let CheckedStart { graph, facing, .. } = start;
        let Self { explorer, candidate } = self;
        match judge_start(explorer, graph, facing, candidate) {
            (moves, Ok(())) => {
                tally.count_run(start, moves);
                tally.mapped += 1;
            }
            (moves, Err(flaw)) => {
                tally.failure.get_or_insert_with(|| FailedStart {
                    graph: graph.clone(),
                    facing,
                    flaw,
                    moves: Some(moves),
                    false_step: None,
                });
            }
        }
    }
}

struct AlgorithmChecker<'a, A: Algorithm> {
    algorithm: &'a A,
    watch: &'a dyn Watch,
    explorer: AlgorithmExplorer<'a, A>,
    candidate: Candidate,
}

impl<'a, A: Algorithm> AlgorithmChecker<'a, A> {
    fn new(algorithm: &'a A, watch: &'a dyn Watch) -> Self {
        let explorer = AlgorithmExplorer::new(algorithm);
        Self { algorithm, watch, explorer, candidate: Candidate::default() }
    }

    /// The first addition to the map that was wrong.
    fn false_step(&mut self, graph: &EmbeddedGraph, facing: Dart) -> Option<FalseStep> {
        let state = &mut self.explorer.state;
        // A wrong map can have more darts than the world.
        state.set_bound(2 * graph.dart_count());
        first_false_step(self.algorithm, graph, facing, state)
    }
}

impl<A: Algorithm> StartChecker for AlgorithmChecker<'_, A> {
    fn marker(&self) -> impl Marker {
        self.explorer.marker()
    }

    fn check_start(&mut self, start: CheckedStart, tally: &mut Tally) {
        let CheckedStart { graph, facing, .. } = start;
        match judge_start(&mut self.explorer, graph, facing, &mut self.candidate) {
            (moves, Ok(())) => tally.count_run(start, moves),
            (moves, Err(flaw)) => {
                if tally.failure.is_none() {
                    let (false_step, graph) = (self.false_step(graph, facing), graph.clone());
                    let moves = Some(moves);
                    tally.failure = Some(FailedStart { graph, facing, flaw, moves, false_step });
                }
                return;
            }
        }
        match self.algorithm.other_runs(graph, facing, self.watch) {
            Ok(None) => {}
            Ok(Some(ways)) => tally.count_every_way(&ways),
            Err(flaw) => {
                // It is not a run with the default choices, so it has no story.
                let (graph, moves) = (graph.clone(), None);
                let failure = FailedStart { graph, facing, flaw, moves, false_step: None };
                tally.failure.get_or_insert(failure);
                return;
            }
        }
        tally.mapped += 1;
    }
}
