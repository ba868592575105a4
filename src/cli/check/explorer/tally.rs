//! The counts of a check of an explorer that is another program.

use std::collections::BTreeMap;

use toposlam_model::{
    check::WorstStart,
    embedded_graph::{Dart, EmbeddedGraph},
    world::Action,
};

use super::{
    fault::ExplorerFault,
    run::{EndedRun, ExplorerStart},
};
use crate::cli::Outcome;

/// A start that was not mapped correctly.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UnmappedStart {
    pub(super) graph: EmbeddedGraph,
    pub(super) facing: Dart,
    pub(super) fault: ExplorerFault,
    pub(super) moves: u64,
    /// The last actions.
    pub(super) actions: Vec<Action>,
    /// The end of the standard error, if the process was ended.
    pub(super) stderr: String,
}

/// The result for some starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ExplorerTally {
    /// Embedded graphs up to isomorphism.
    pub(super) worlds: u64,
    pub(super) starts: u64,
    /// Starts mapped correctly.
    pub(super) mapped: u64,
    /// Starts on which a limit was reached.
    pub(super) unknown: u64,
    /// The moves of the runs that mapped their starts right.
    pub(super) moves_total: u64,
    /// The lengths of the certificates of the starts mapped correctly; 0 if the marker is not directional.
    pub(super) certificate_total: u64,
    pub(super) certificate_max: u64,
    /// The first start that took the most moves, of those mapped correctly.
    pub(super) worst: Option<WorstStart>,
    /// The first start on which the explorer failed.
    pub(super) failure: Option<UnmappedStart>,
    /// The first start on which a limit was reached.
    pub(super) limit: Option<UnmappedStart>,
    /// The number of starts for each name of a fault.
    pub(super) causes: BTreeMap<&'static str, u64>,
    /// Runs that ended their process.
    pub(super) processes_ended: u64,
    /// Whether the rest of the starts was left out because too many runs ended their process.
    pub(super) stopped: bool,
    pub(super) interrupted: bool,
}

impl ExplorerTally {
    /// Starts on which the explorer failed.
    pub(super) fn failed(&self) -> u64 {
        self.starts - self.mapped - self.unknown
    }

    /// The most moves of a run that mapped its start right; 0 if there is none.
    pub(super) fn moves_max(&self) -> u64 {
        self.worst.as_ref().map_or(0, |worst| worst.moves)
    }

    /// Moves for each move of a certificate; `None` without certificates.
    pub(super) fn ratio(&self) -> Option<f64> {
        let known = self.certificate_total > 0;
        known.then(|| self.moves_total as f64 / self.certificate_total as f64)
    }

    /// The outcome, and its name.
    pub(super) fn verdict(&self) -> (Outcome, &'static str) {
        match () {
            () if self.failed() > 0 => (Outcome::Violated, "violated"),
            () if self.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
            () if self.starts == 0 => {
                (Outcome::Incomplete, "incomplete: there is nothing to check")
            }
            () if self.unknown > 0 || self.stopped => (Outcome::Incomplete, "incomplete"),
            () => (Outcome::Holds, "holds"),
        }
    }

    /// Counts a run. `stderr` is the end of the standard error of a process that was ended.
    pub(super) fn count(&mut self, start: &ExplorerStart, run: EndedRun, stderr: String) {
        let ExplorerStart { graph, facing, certificate, .. } = *start;
        let EndedRun { moves, actions, result } = run;
        self.starts += 1;
        let Err(fault) = result else {
            self.mapped += 1;
            self.moves_total += moves;
            self.certificate_total += certificate.unwrap_or_default();
            self.certificate_max = self.certificate_max.max(certificate.unwrap_or_default());
            if self.worst.as_ref().is_none_or(|worst| moves > worst.moves) {
                self.worst = Some(WorstStart { graph: graph.clone(), facing, moves });
            }
            return;
        };
        *self.causes.entry(fault.name()).or_default() += 1;
        self.processes_ended += u64::from(fault.ends_process());
        let limit = fault.is_limit();
        self.unknown += u64::from(limit);
        let first = if limit { &mut self.limit } else { &mut self.failure };
        first.get_or_insert_with(|| UnmappedStart {
            graph: graph.clone(),
            facing,
            fault,
            moves,
            actions,
            stderr,
        });
    }

    /// Adds the result of later starts.
    pub(super) fn merge(&mut self, mut later: Self) {
        self.worlds += later.worlds;
        self.starts += later.starts;
        self.mapped += later.mapped;
        self.unknown += later.unknown;
        self.moves_total += later.moves_total;
        self.certificate_total += later.certificate_total;
        self.certificate_max = self.certificate_max.max(later.certificate_max);
        self.processes_ended += later.processes_ended;
        self.stopped |= later.stopped;
        self.interrupted |= later.interrupted;
        for (cause, count) in std::mem::take(&mut later.causes) {
            *self.causes.entry(cause).or_default() += count;
        }
        if later.moves_max() > self.moves_max() || self.worst.is_none() {
            self.worst = later.worst;
        }
        self.failure = self.failure.take().or(later.failure);
        self.limit = self.limit.take().or(later.limit);
    }
}
