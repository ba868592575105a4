//! The counts of a check.

use std::cmp::Reverse;

use super::{ChoicesLimit, EveryWay, FalseStep};
use crate::{
    embedded_graph::{Dart, EmbeddedGraph},
    mapping::{CostOrder, Flaw},
};

/// A start that is checked.
#[derive(Clone, Copy)]
pub(super) struct CheckedStart<'g> {
    pub(super) graph: &'g EmbeddedGraph,
    pub(super) facing: Dart,
    /// The length of its [certificate](crate::folding::certificate_length), if the marker is directional.
    pub(super) certificate: Option<u64>,
}

/// The start that took the most moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorstStart {
    /// The world.
    pub graph: EmbeddedGraph,
    /// The facing dart.
    pub facing: Dart,
    /// The moves.
    pub moves: u64,
}

/// A start on which the algorithm failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FailedStart {
    /// The world.
    pub graph: EmbeddedGraph,
    /// The facing dart.
    pub facing: Dart,
    /// What is wrong.
    pub flaw: Flaw,
    /// The moves made, if it is the run with the default choices.
    pub moves: Option<u64>,
    /// The first wrong addition to the map, if any.
    pub false_step: Option<FalseStep>,
}

/// The result of a check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Embedded graphs up to isomorphism.
    pub worlds: u64,
    /// Starts run.
    pub starts: u64,
    /// Starts mapped correctly.
    pub mapped: u64,
    /// The total of moves of all runs with the default choices.
    pub moves_total: u64,
    /// The total of the [certificates](crate::folding::certificate_length) of the starts; 0 if the
    /// marker is not directional.
    pub certificate_total: u64,
    /// The longest certificate of a start; 0 if the marker is not directional.
    pub certificate_max: u64,
    /// Starts that were mapped correctly in fewer moves than their certificate has. The algorithm guessed:
    /// there is another world in which it makes the same walk.
    pub below_certificate: u64,
    /// The first start that took the most moves with the default choices.
    pub worst: Option<WorstStart>,
    /// The moves and the vertices of the run with the most moves per vertex.
    pub dearest: Option<(u64, u64)>,
    /// The first start on which the algorithm failed.
    pub failure: Option<FailedStart>,
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
    /// Whether the check was interrupted.
    pub interrupted: bool,
}

impl Tally {
    /// With all choices: starts with runs that were not tried.
    #[must_use]
    pub fn gave_up(&self) -> u64 {
        self.over_budget + self.over_memory
    }

    /// Starts on which the algorithm failed.
    #[must_use]
    pub fn failed(&self) -> u64 {
        self.starts - self.mapped
    }

    /// The most moves of a run with the default choices; 0 if there is none.
    #[must_use]
    pub fn moves_max(&self) -> u64 {
        self.worst.as_ref().map_or(0, |worst| worst.moves)
    }

    /// The largest ratio of moves to the order of the cost, for worlds with `edges` edges.
    #[must_use]
    pub fn largest_ratio(&self, edges: usize, order: CostOrder) -> f64 {
        let (moves, vertices) = self.dearest.unwrap_or((0, 1));
        moves as f64 / order.value(edges as f64, vertices as f64)
    }

    /// Counts a start, and its certificate.
    pub(super) fn count_start(&mut self, start: CheckedStart) {
        self.starts += 1;
        let certificate = start.certificate.unwrap_or_default();
        self.certificate_total += certificate;
        self.certificate_max = self.certificate_max.max(certificate);
    }

    /// Counts a run that ended.
    pub(super) fn count_run(&mut self, start: CheckedStart, moves: u64) {
        let CheckedStart { graph, facing, certificate } = start;
        self.moves_total += moves;
        self.below_certificate += u64::from(certificate.is_some_and(|least| moves < least));
        if self.worst.as_ref().is_none_or(|worst| moves > worst.moves) {
            self.worst = Some(WorstStart { graph: graph.clone(), facing, moves });
        }
        self.count_dearest((moves, graph.vertex_count() as u64));
    }

    /// Counts all runs of a start.
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
    fn count_dearest(&mut self, (moves, vertices): (u64, u64)) {
        let dearer = |(most, of): (u64, u64)| {
            (moves * of, Reverse(vertices)) > (most * vertices, Reverse(of))
        };
        if self.dearest.is_none_or(dearer) {
            self.dearest = Some((moves, vertices));
        }
    }

    /// Adds the result of a later part of the same check.
    pub fn merge(&mut self, later: Self) {
        self.worlds += later.worlds;
        self.starts += later.starts;
        self.mapped += later.mapped;
        self.moves_total += later.moves_total;
        self.below_certificate += later.below_certificate;
        self.certificate_total += later.certificate_total;
        self.certificate_max = self.certificate_max.max(later.certificate_max);
        self.states += later.states;
        self.over_budget += later.over_budget;
        self.over_memory += later.over_memory;
        self.runs = self.runs.saturating_add(later.runs);
        self.interrupted |= later.interrupted;
        self.count_extremes(later.extremes);
        if later.moves_max() > self.moves_max() || self.worst.is_none() {
            self.worst = later.worst;
        }
        if let Some(dearest) = later.dearest {
            self.count_dearest(dearest);
        }
        if self.failure.is_none() {
            self.failure = later.failure;
        }
    }
}
