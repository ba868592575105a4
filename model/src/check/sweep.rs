//! Runs an algorithm on every start of many worlds.

use std::{fmt, ops::ControlFlow, str::FromStr};

use thiserror::Error;

use super::{Algorithm, FailedStart, Flaw, RunState, Tally, first_false_step, judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration, EnumerationPart, SizeError, Watch, in_parts},
    isomorphism::{Candidate, canonical},
    world::GraphWorld,
};

/// One of several disjoint shares of a check that together are the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    index: usize,
    /// Of how many.
    of: usize,
}

/// Not a shard.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is no shard; write i/n with i from 1 to n, as in 2/4")]
pub struct ShardError(String);

impl Shard {
    /// The whole.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// What belongs to the shard, of the parts of an enumeration.
    fn select(self, parts: Vec<EnumerationPart>) -> Vec<EnumerationPart> {
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
    /// A check of one share of the worlds.
    ///
    /// # Errors
    /// Where the worlds cannot be enumerated.
    pub fn new(class: Class, edges: usize, shard: Shard) -> Result<Self, SizeError> {
        Ok(Self { worlds: Enumeration::new(Each::World, class, edges)?, shard })
    }

    /// The class of worlds.
    #[must_use]
    pub fn class(&self) -> Class {
        self.worlds.class()
    }

    /// Makes the check. The result does not depend on the number of threads (which is that of
    /// rayon's pool, or 1 without the feature `rayon`).
    pub fn run(&self, algorithm: &impl Algorithm, watch: &impl Watch) -> Tally {
        let parts = self.shard.select(self.worlds.parts());
        tally_parts(&parts, watch, |part, tally| {
            let mut checker = Checker::new(algorithm, watch);
            part.for_each(&mut |found| {
                checker.check_starts(found.graph, found.automorphisms as usize, tally)
            })
        })
    }
}

/// Runs the algorithm on every start of some worlds. As with a [`Sweep`], the result does not depend
/// on the number of threads.
pub fn check_worlds(
    graphs: &[EmbeddedGraph],
    algorithm: &impl Algorithm,
    watch: &impl Watch,
) -> Tally {
    let parts: Vec<_> = graphs.chunks(64).collect();
    tally_parts(&parts, watch, |part, tally| {
        let mut checker = Checker::new(algorithm, watch);
        part.iter().try_for_each(|graph| {
            checker.check_starts(graph, canonical(graph).automorphisms, tally)
        })
    })
}

fn go_on(watch: &impl Watch) -> ControlFlow<()> {
    if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Checks the parts of a whole, and adds up the tallies.
fn tally_parts<P: Sync>(
    parts: &[P],
    watch: &impl Watch,
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

/// What is used again from run to run.
struct Checker<'a, A: Algorithm, W> {
    algorithm: &'a A,
    watch: &'a W,
    state: A::State,
    candidate: Candidate,
}

impl<'a, A: Algorithm, W: Watch> Checker<'a, A, W> {
    fn new(algorithm: &'a A, watch: &'a W) -> Self {
        Self { algorithm, watch, state: RunState::new(0), candidate: Candidate::default() }
    }

    fn check_starts(
        &mut self,
        graph: &EmbeddedGraph,
        automorphisms: usize,
        tally: &mut Tally,
    ) -> ControlFlow<()> {
        tally.worlds += 1;
        let mut check = |facing| {
            self.check_start(graph, facing, tally);
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

    fn check_start(&mut self, graph: &EmbeddedGraph, facing: Dart, tally: &mut Tally) {
        tally.starts += 1;
        match self.run(graph, facing) {
            Ok(moves) => tally.count_run(graph, facing, moves),
            Err(flaw) => {
                if tally.failure.is_none() {
                    tally.failure = Some(self.failure(graph, facing, flaw));
                }
                return;
            }
        }
        match self.algorithm.other_runs(graph, facing, self.watch) {
            Ok(None) => {}
            Ok(Some(ways)) => tally.count_every_way(&ways),
            Err(flaw) => {
                // The run is not that of the default choices, whose story could be told.
                let (graph, moves) = (graph.clone(), None);
                let failure = FailedStart { graph, facing, flaw, moves, false_step: None };
                tally.failure.get_or_insert(failure);
                return;
            }
        }
        tally.mapped += 1;
    }

    fn run(&mut self, graph: &EmbeddedGraph, facing: Dart) -> Result<u64, Flaw> {
        // No true map has more darts than the world.
        self.state.set_bound(graph.dart_count());
        self.state.clear();
        let mut world = GraphWorld::with_marker(graph, A::Marker::default(), facing);
        self.algorithm.run(&mut world, &mut self.state, &mut ())?;
        judge(self.algorithm, &self.state, facing, &world, &mut self.candidate)?;
        Ok(self.state.journey().moves())
    }

    fn failure(&mut self, graph: &EmbeddedGraph, facing: Dart, flaw: Flaw) -> FailedStart {
        let moves = Some(self.state.journey().moves());
        let graph = graph.clone();
        // With room for what is wrongly added.
        self.state.set_bound(2 * graph.dart_count());
        let false_step = first_false_step(self.algorithm, &graph, facing, &mut self.state);
        FailedStart { graph, facing, flaw, moves, false_step }
    }
}
