//! Runs an algorithm on every start of many worlds.

use std::{fmt, ops::ControlFlow, str::FromStr};

use thiserror::Error;

use super::{FailedStart, RunChoices, SearchMemory, Tally, WorstStart, judge_start};
use crate::{
    aid::Aid,
    embedded_graph::{Dart, EmbeddedGraph, Vertex},
    enumerate::{Class, Each, Enumeration, SizeError, Watch, in_parts},
    folding::MarkerTree,
    isomorphism::{Candidate, canonical},
    mapping::Explorer,
    marker::{Directional, Marker},
};

/// One of `n` disjoint parts of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    of: usize,
}

/// The error for a text that is not a shard.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` is not a shard; write i/n with i from 1 to n, for example 2/4")]
pub struct ShardError(String);

impl Shard {
    /// The whole check.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    pub fn index(self) -> usize {
        self.index
    }

    pub fn total(self) -> usize {
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
pub struct Check {
    worlds: Enumeration,
    shard: Shard,
}

impl Check {
    /// A check of one shard of the worlds.
    ///
    /// # Errors
    /// Returns an error if the worlds cannot be enumerated.
    pub fn new(class: Class, edges: usize, shard: Shard) -> Result<Self, SizeError> {
        Ok(Self { worlds: Enumeration::new(Each::World, class, edges)?, shard })
    }

    pub fn class(&self) -> Class {
        self.worlds.class()
    }

    /// Checks explorers, each on one part of the worlds. The result does not depend on the number of threads (that
    /// of rayon's pool, or 1 without the feature `rayon`), unless an explorer depends on what it explored before.
    pub fn run<E: Explorer>(
        &self,
        new: impl Fn() -> E + Sync,
        choices: RunChoices,
        watch: &dyn Watch,
    ) -> Tally {
        let parts = self.shard.select(self.worlds.parts());
        tally_parts(&parts, watch, |part, tally| {
            let mut checker = StartChecker::new(&new, choices, watch);
            part.for_each(&mut |found| {
                checker.check_starts(found.graph, found.automorphisms as usize, tally)
            })
        })
    }
}

/// Checks explorers on every start of some worlds, or on one that is given with a world, each explorer on one part of
/// them. As with a [`Check`], the result does not depend on the number of threads.
pub fn check_worlds<E: Explorer>(
    worlds: &[(EmbeddedGraph, Option<Dart>)],
    new: impl Fn() -> E + Sync,
    choices: RunChoices,
    watch: &dyn Watch,
) -> Tally {
    let parts: Vec<_> = worlds.chunks(64).collect();
    tally_parts(&parts, watch, |part, tally| {
        let mut checker = StartChecker::new(&new, choices, watch);
        part.iter().try_for_each(|(graph, start)| match start {
            None => checker.check_starts(graph, canonical(graph).automorphisms, tally),
            Some(facing) => {
                tally.worlds += 1;
                checker.check_these(graph, [*facing].into_iter(), tally)
            }
        })
    })
}

pub(super) fn check_stop(watch: &dyn Watch) -> ControlFlow<()> {
    if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

fn tally_parts<P: Sync>(
    parts: &[P],
    watch: &dyn Watch,
    check: impl Fn(&P, &mut Tally) -> ControlFlow<()> + Sync + Send,
) -> Tally {
    let check = |part: &P| {
        let mut tally = Tally::default();
        tally.interrupted = check_stop(watch).is_break() || check(part, &mut tally).is_break();
        tally
    };
    in_parts(parts, watch, Tally::default, check, |tally| tally.starts, Tally::merged)
}

/// Checks the starts of one part, one after the other. Memory is kept from start to start.
struct StartChecker<'a, E: Explorer, N> {
    new: &'a N,
    explorer: E,
    choices: RunChoices,
    watch: &'a dyn Watch,
    candidate: Candidate,
    memory: SearchMemory<E>,
    /// Measures certificates, if the marker has them.
    certificates: Option<MarkerTree>,
}

impl<'a, E: Explorer, N: Fn() -> E> StartChecker<'a, E, N> {
    fn new(new: &'a N, choices: RunChoices, watch: &'a dyn Watch) -> Self {
        let explorer = new();
        let directional = explorer.aid().name() == Marker::name(&Directional);
        let certificates = directional.then(MarkerTree::default);
        Self {
            new,
            explorer,
            choices,
            watch,
            candidate: Candidate::default(),
            memory: SearchMemory::default(),
            certificates,
        }
    }

    fn check_starts(
        &mut self,
        graph: &EmbeddedGraph,
        automorphisms: usize,
        tally: &mut Tally,
    ) -> ControlFlow<()> {
        tally.worlds += 1;
        if automorphisms == 1 {
            self.check_these(graph, graph.darts(), tally)
        } else {
            // Darts that an automorphism takes to each other are the same start.
            let orbit = canonical(graph).orbit;
            let starts = graph.darts().filter(|dart| orbit[dart.at()] == *dart);
            self.check_these(graph, starts, tally)
        }
    }

    fn check_these(
        &mut self,
        graph: &EmbeddedGraph,
        mut starts: impl Iterator<Item = Dart>,
        tally: &mut Tally,
    ) -> ControlFlow<()> {
        // The starts at one vertex follow one another, and have one certificate.
        let mut measured: Option<(Vertex, u64)> = None;
        starts.try_for_each(|facing| {
            let vertex = graph.vertex(facing);
            if let Some(tree) = &mut self.certificates
                && measured.is_none_or(|(at, _)| at != vertex)
            {
                measured = Some((vertex, tree.certificate(graph, vertex) as u64));
            }
            tally.starts += 1;
            self.check_start((graph, facing), measured.map(|(_, length)| length), tally);
            check_stop(self.watch)
        })
    }

    fn check_start(
        &mut self,
        (graph, facing): (&EmbeddedGraph, Dart),
        certificate: Option<u64>,
        tally: &mut Tally,
    ) {
        tally.count_certificate(certificate);
        let (moves, judged) = judge_start(&mut self.explorer, graph, facing, &mut self.candidate);
        let failure = match judged {
            Ok(()) => {
                let is_worst = tally.worst.as_ref().is_none_or(|worst| moves > worst.moves);
                let worst = is_worst.then(|| WorstStart { graph: graph.clone(), facing, moves });
                tally.count_run((moves, graph.vertex_count()), certificate, worst);
                match self.choices.others(self.new, (graph, facing), &mut self.memory, self.watch) {
                    Ok(ways) => {
                        if let Some(ways) = &ways {
                            tally.count_every_way(ways);
                        }
                        tally.mapped += 1;
                        return;
                    }
                    // It is not a run with the default choices, so it has no story.
                    Err(flaw) => (flaw, None),
                }
            }
            Err(flaw) => (flaw, Some(moves)),
        };
        if tally.failure.is_none() {
            let (flaw, moves) = failure;
            tally.failure = Some(FailedStart::new(self.new, (graph, facing), flaw, moves));
        }
    }
}
