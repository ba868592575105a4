//! Runs an algorithm on every start of many worlds.

use std::{fmt, ops::ControlFlow, str::FromStr};

use thiserror::Error;

use super::{Algorithm, Failure, Flaw, Tally, every_way, first_false_step, judge::judge};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Enumeration, Part},
    isomorphism::{Candidate, canonical},
    mapping::Exploration,
    world::GraphWorld,
};

/// Which runs of each start are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// That of the default choices.
    Default,
    /// That, and every other resolution of what the algorithm leaves open.
    All,
}

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
    fn select(self, parts: Vec<Part>) -> Vec<Part> {
        parts.into_iter().skip(self.index - 1).step_by(self.of).collect()
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let shard = text.split_once('/').and_then(|(index, of)| {
            Some(Self { index: index.parse().ok()?, of: of.parse().ok()? })
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

/// Watches a long check, from several threads at once.
pub trait Watch: Sync {
    /// The number of parts of the check.
    fn parts(&self, _count: usize) {}

    /// One of them is done.
    fn part_done(&self, _tally: &Tally) {}

    /// Whether to break off.
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody watches.
impl Watch for () {}

/// A check of every start of every world of a class with a number of edges.
#[derive(Clone, Copy, Debug)]
pub struct Sweep {
    /// The worlds.
    pub enumeration: Enumeration,
    /// The share of them to check.
    pub shard: Shard,
    /// Which runs to make.
    pub choice: Choice,
}

impl Sweep {
    /// Makes the check. The result does not depend on the number of threads (which is that of
    /// rayon's pool, or 1 without the feature `rayon`).
    pub fn run(&self, algorithm: &impl Algorithm, watch: &impl Watch) -> Tally {
        let parts = self.shard.select(self.enumeration.parts());
        watch.parts(parts.len());
        let check = |part: &Part| {
            let tally = self.check_part(part, algorithm, watch);
            watch.part_done(&tally);
            tally
        };
        let merge = |mut sum: Tally, later: Tally| {
            sum.merge(later);
            sum
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::prelude::*;
            // Neighbours are merged in their order, whoever checked them.
            parts.par_iter().with_max_len(1).map(check).reduce(Tally::default, merge)
        }
        #[cfg(not(feature = "rayon"))]
        {
            parts.iter().map(check).fold(Tally::default(), merge)
        }
    }

    fn check_part(&self, part: &Part, algorithm: &impl Algorithm, watch: &impl Watch) -> Tally {
        let mut checker = Checker::new(algorithm, self.choice);
        let mut tally = Tally::default();
        let end = part.for_each(&mut |found| {
            if watch.stop() {
                return ControlFlow::Break(());
            }
            checker.check_starts(found.graph, found.automorphisms as usize, &mut tally);
            ControlFlow::Continue(())
        });
        tally.interrupted = end.is_break();
        tally
    }
}

/// Runs the algorithm on every start of one world.
pub fn check_world(graph: &EmbeddedGraph, choice: Choice, algorithm: &impl Algorithm) -> Tally {
    let mut tally = Tally::default();
    let automorphisms = canonical(graph).automorphisms;
    Checker::new(algorithm, choice).check_starts(graph, automorphisms, &mut tally);
    tally
}

/// What is used again from run to run.
struct Checker<'a, A> {
    algorithm: &'a A,
    choice: Choice,
    exploration: Exploration,
    candidate: Candidate,
}

impl<'a, A: Algorithm> Checker<'a, A> {
    fn new(algorithm: &'a A, choice: Choice) -> Self {
        Self {
            algorithm,
            choice,
            exploration: Exploration::new(0),
            candidate: Candidate::default(),
        }
    }

    fn check_starts(&mut self, graph: &EmbeddedGraph, automorphisms: usize, tally: &mut Tally) {
        tally.worlds += 1;
        if automorphisms == 1 {
            for facing in graph.darts() {
                self.check_start(graph, facing, tally);
            }
        } else {
            // Darts that an automorphism takes to each other are the same start.
            let orbit = canonical(graph).orbit;
            for facing in graph.darts().filter(|dart| orbit[dart.at()] == *dart) {
                self.check_start(graph, facing, tally);
            }
        }
    }

    fn check_start(&mut self, graph: &EmbeddedGraph, facing: Dart, tally: &mut Tally) {
        tally.starts += 1;
        // No true map has more darts than the world.
        self.exploration.set_bound(graph.dart_count());
        let result = self.run(graph, facing).and_then(|moves| {
            tally.count_run(graph, facing, moves);
            if self.choice == Choice::All {
                tally.count_every_way(&every_way(graph, facing)?);
            }
            Ok(())
        });
        match result {
            Ok(()) => tally.mapped += 1,
            Err(flaw) if tally.failure.is_none() => {
                let moves = self.exploration.moves();
                let graph = graph.clone();
                let false_step =
                    first_false_step(self.algorithm, &graph, facing, &mut self.exploration);
                tally.failure = Some(Failure { graph, facing, flaw, moves, false_step });
            }
            Err(_) => {}
        }
    }

    fn run(&mut self, graph: &EmbeddedGraph, facing: Dart) -> Result<u64, Flaw> {
        let mut world = GraphWorld::new(graph, facing);
        self.algorithm.run(&mut world, &mut self.exploration, &mut ())?;
        judge(&self.exploration, facing, &world, &mut self.candidate)?;
        Ok(self.exploration.moves())
    }
}
