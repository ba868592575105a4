//! The counts of a check, or of a part of one.

use std::cmp::Reverse;

use serde::{Deserialize, Serialize};

use super::{ChoicesLimit, EveryWay, FalseStep, first_false_step};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    isomorphism::{StartCode, canonical},
    mapping::{CostOrder, Explorer, Flaw},
};

/// A start by its place in the [enumeration](crate::enumerate::Enumeration): its world as discovered from its
/// least start, and the first dart of that which faces as the start does. Starts are ordered as the
/// enumeration finds them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct EnumeratedStart {
    /// The [code](crate::isomorphism::StartCode) of the least start.
    code: Vec<u32>,
    facing: u32,
}

impl EnumeratedStart {
    pub fn new(graph: &EmbeddedGraph, facing: Dart) -> Self {
        let least = canonical(graph);
        let orbit = least.orbit[facing.at()];
        let mut numbered = (0..).zip(&least.order);
        let facing = numbered.find(|(_, dart)| least.orbit[dart.at()] == orbit);
        Self { code: least.code.words().to_vec(), facing: facing.map_or(0, |(number, _)| number) }
    }

    /// The start; `None` if the code is not that of a start.
    pub fn start(&self) -> Option<(EmbeddedGraph, Dart)> {
        let graph = StartCode::start_of(&self.code)?;
        let facing = Dart(self.facing);
        (facing.at() < graph.dart_count()).then_some((graph, facing))
    }
}

/// The start that took the most moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorstStart {
    pub graph: EmbeddedGraph,
    pub facing: Dart,
    pub moves: u64,
}

/// A start on which the algorithm failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailedStart {
    pub graph: EmbeddedGraph,
    pub facing: Dart,
    pub flaw: Flaw,
    /// The moves made, if it is the run with the default choices.
    pub moves: Option<u64>,
    /// The first wrong addition to the map, if any.
    pub false_step: Option<FalseStep>,
}

impl FailedStart {
    /// The start of a flaw. If that is one of the run with the default choices, the run is made again for its first
    /// wrong addition.
    pub(super) fn new<E: Explorer>(
        new: impl Fn() -> E,
        (graph, facing): (&EmbeddedGraph, Dart),
        flaw: Flaw,
        moves: Option<u64>,
    ) -> Self {
        let false_step = moves.and_then(|_| first_false_step(new(), graph, facing));
        Self { graph: graph.clone(), facing, flaw, moves, false_step }
    }
}

/// A start that a [`Tally`] keeps: of all such starts, one.
pub trait KeptStart {
    /// Whether it is kept in place of another one, which was counted before it. By default the first is kept.
    fn replaces(&self, _other: &Self) -> bool {
        false
    }
}

/// Of equals the first is kept.
impl KeptStart for WorstStart {
    fn replaces(&self, other: &Self) -> bool {
        self.moves > other.moves
    }
}

impl KeptStart for FailedStart {}

/// The most moves; of equals the start that the enumeration finds first, in whatever order they are counted.
impl KeptStart for (u64, EnumeratedStart) {
    fn replaces(&self, other: &Self) -> bool {
        (Reverse(self.0), &self.1) < (Reverse(other.0), &other.1)
    }
}

/// The start that the enumeration finds first, in whatever order they are counted.
impl KeptStart for EnumeratedStart {
    fn replaces(&self, other: &Self) -> bool {
        self < other
    }
}

fn keep<S: KeptStart>(kept: &mut Option<S>, other: Option<S>) {
    if let Some(other) = other
        && kept.as_ref().is_none_or(|kept| other.replaces(kept))
    {
        *kept = Some(other);
    }
}

/// The counts of a check, or of a part of one: how many starts were mapped correctly, and in how many moves.
///
/// `W` and `F` name the start that took the most moves and the first one that failed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tally<W = Option<WorstStart>, F = Option<FailedStart>> {
    /// Embedded graphs up to isomorphism.
    pub worlds: u64,
    pub starts: u64,
    pub mapped: u64,
    /// Starts on which a limit was reached before the run ended.
    pub unknown: u64,
    /// The total of moves of all runs with the default choices that ended with a right map.
    pub moves_total: u64,
    /// If runs share prefixes: the moves that were made for all of them together.
    pub moves_made: u64,
    /// The total of the [certificates](crate::folding::certificate_length) of the starts; 0 if the
    /// marker is not directional.
    pub certificate_total: u64,
    /// The longest certificate of a start; 0 if the marker is not directional.
    pub certificate_max: u64,
    /// Starts that were mapped correctly in fewer moves than their certificate has. The algorithm guessed:
    /// there is another world in which it makes the same walk.
    pub below_certificate: u64,
    /// The first start that took the most moves with the default choices; none in a part of a check if another part
    /// is known to have a run with more.
    pub worst: W,
    /// The moves and the vertices of the run with the most moves per vertex.
    #[serde(alias = "dearest")]
    pub most_moves_per_vertex: Option<(u64, u64)>,
    /// The first start on which the algorithm failed.
    pub failure: F,
    /// With all choices: distinct states at line 4, summed over the starts.
    pub states: u64,
    /// With all choices: runs, summed over the starts.
    pub runs: u128,
    /// With all choices: the fewest and the most moves of any run.
    pub extremes: Option<(u64, u64)>,
    /// With all choices: starts with more states than the budget.
    pub over_budget: u64,
    /// With all choices: starts whose states took too much memory.
    pub over_memory: u64,
    pub interrupted: bool,
}

/// The counts of a part of a check whose starts are enumerated. They do not depend on the order in which starts are
/// counted and parts are merged.
pub type PartTally = Tally<Option<(u64, EnumeratedStart)>, Option<EnumeratedStart>>;

impl<F> Tally<Option<WorstStart>, F> {
    /// The most moves of a run with the default choices; 0 if there is none.
    pub fn moves_max(&self) -> u64 {
        self.worst.as_ref().map_or(0, |worst| worst.moves)
    }
}

impl<W, F> Tally<W, F> {
    /// With all choices: starts with runs that were not tried.
    pub fn gave_up(&self) -> u64 {
        self.over_budget + self.over_memory
    }

    pub fn failed(&self) -> u64 {
        self.starts - self.mapped - self.unknown
    }

    /// The largest ratio of moves to the order of the cost, for worlds with `edges` edges.
    pub fn largest_ratio(&self, edges: usize, order: CostOrder) -> f64 {
        let (moves, vertices) = self.most_moves_per_vertex.unwrap_or((0, 1));
        moves as f64 / order.value(edges as f64, vertices as f64)
    }

    pub(super) fn count_every_way(&mut self, ways: &EveryWay) {
        self.states += ways.states;
        self.runs = self.runs.saturating_add(ways.runs);
        match ways.limit {
            None => {}
            Some(ChoicesLimit::States(_)) => self.over_budget += 1,
            Some(ChoicesLimit::Memory) => self.over_memory += 1,
            Some(ChoicesLimit::Interrupted) => self.interrupted = true,
        }
        self.count_extremes(ways.costs.min().zip(ways.costs.max()));
    }

    fn count_extremes(&mut self, extremes: Option<(u64, u64)>) {
        self.extremes = match (self.extremes, extremes) {
            (Some((least, most)), Some((less, more))) => Some((least.min(less), most.max(more))),
            (one, other) => one.or(other),
        };
    }

    /// Of equal ratios that with the fewest vertices.
    fn count_moves_per_vertex(&mut self, (moves, vertices): (u64, u64)) {
        let is_more = |(most, of): (u64, u64)| {
            (moves * of, Reverse(vertices)) > (most * vertices, Reverse(of))
        };
        if self.most_moves_per_vertex.is_none_or(is_more) {
            self.most_moves_per_vertex = Some((moves, vertices));
        }
    }

    pub(super) fn with_starts(
        self,
        worst: Option<WorstStart>,
        failure: Option<FailedStart>,
    ) -> Tally {
        let mut tally = Tally { worst, failure, ..Tally::default() };
        tally.add_counts(&self);
        tally
    }

    fn add_counts<V, G>(&mut self, later: &Tally<V, G>) {
        self.worlds += later.worlds;
        self.starts += later.starts;
        self.mapped += later.mapped;
        self.unknown += later.unknown;
        self.moves_total += later.moves_total;
        self.moves_made += later.moves_made;
        self.below_certificate += later.below_certificate;
        self.certificate_total += later.certificate_total;
        self.certificate_max = self.certificate_max.max(later.certificate_max);
        self.states += later.states;
        self.over_budget += later.over_budget;
        self.over_memory += later.over_memory;
        self.runs = self.runs.saturating_add(later.runs);
        self.interrupted |= later.interrupted;
        self.count_extremes(later.extremes);
        later.most_moves_per_vertex.into_iter().for_each(|most| self.count_moves_per_vertex(most));
    }
}

impl<W: KeptStart, F: KeptStart> Tally<Option<W>, Option<F>> {
    pub fn count_certificate(&mut self, certificate: Option<u64>) {
        let certificate = certificate.unwrap_or_default();
        self.certificate_total += certificate;
        self.certificate_max = self.certificate_max.max(certificate);
    }

    /// Counts a run in a world with `vertices` vertices that ended with a right map. `worst` is its start, if that may
    /// be the one with the most moves.
    pub fn count_run(
        &mut self,
        (moves, vertices): (u64, usize),
        certificate: Option<u64>,
        worst: Option<W>,
    ) {
        self.moves_total += moves;
        self.below_certificate += u64::from(certificate.is_some_and(|least| moves < least));
        self.count_moves_per_vertex((moves, vertices as u64));
        keep(&mut self.worst, worst);
    }

    pub fn count_failure(&mut self, failure: F) {
        keep(&mut self.failure, Some(failure));
    }

    pub(super) fn merged(mut self, later: Self) -> Self {
        self.merge(later);
        self
    }

    /// Adds the counts of another, later part of the same check.
    pub fn merge(&mut self, later: Self) {
        self.add_counts(&later);
        keep(&mut self.worst, later.worst);
        keep(&mut self.failure, later.failure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{ChoicesLimit, Costs, EveryWay};

    #[test]
    fn each_start_whose_runs_were_not_all_tried_is_counted_once() {
        let mut tally: Tally = Tally::default();
        for limit in [None, Some(ChoicesLimit::Memory), Some(ChoicesLimit::States(1))] {
            let costs = Costs::default();
            tally.count_every_way(&EveryWay { states: 1, within_rounds: 0, runs: 1, costs, limit });
        }
        assert_eq!((tally.over_memory, tally.over_budget, tally.gave_up()), (1, 1, 2));
        let twice = tally.clone().merged(tally);
        assert_eq!((twice.over_memory, twice.over_budget, twice.gave_up()), (2, 2, 4));
    }
}
