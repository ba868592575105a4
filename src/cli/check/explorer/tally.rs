//! The counts of a check of an explorer that is another program.

use std::collections::BTreeMap;

use toposlam_model::{
    check::{KeptStart, Tally, WorstStart},
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

/// The first start of its kind is kept.
impl KeptStart for UnmappedStart {
    fn replaces(&self, _: &Self) -> bool {
        false
    }
}

/// The result for some starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ExplorerTally {
    /// The counts. Certificates are those of the starts that were mapped correctly. Of the others, those on which a
    /// limit was reached are unknown.
    pub(super) counts: Tally<WorstStart, UnmappedStart>,
    /// The first start on which a limit was reached.
    pub(super) limit: Option<UnmappedStart>,
    /// The number of starts for each name of a fault.
    pub(super) causes: BTreeMap<&'static str, u64>,
    /// Runs that ended their process.
    pub(super) processes_ended: u64,
    /// Whether the rest of the starts was left out because too many runs ended their process.
    pub(super) stopped: bool,
}

impl ExplorerTally {
    /// Moves for each move of a certificate; `None` without certificates.
    pub(super) fn ratio(&self) -> Option<f64> {
        let Tally { moves_total, certificate_total, .. } = self.counts;
        (certificate_total > 0).then(|| moves_total as f64 / certificate_total as f64)
    }

    /// The outcome, and its name.
    pub(super) fn verdict(&self) -> (Outcome, &'static str) {
        let counts = &self.counts;
        match () {
            () if counts.failed() > 0 => (Outcome::Violated, "violated"),
            () if counts.interrupted => (Outcome::Incomplete, "incomplete, interrupted"),
            () if counts.starts == 0 => {
                (Outcome::Incomplete, "incomplete: there is nothing to check")
            }
            () if counts.unknown > 0 || self.stopped => (Outcome::Incomplete, "incomplete"),
            () => (Outcome::Holds, "holds"),
        }
    }

    /// Counts a run. `stderr` is the end of the standard error of a process that was ended.
    pub(super) fn count(&mut self, start: &ExplorerStart, run: EndedRun, stderr: String) {
        let ExplorerStart { graph, facing, certificate, .. } = *start;
        let EndedRun { moves, actions, result } = run;
        let counts = &mut self.counts;
        counts.starts += 1;
        let graph = graph.clone();
        let Err(fault) = result else {
            counts.mapped += 1;
            counts.count_certificate(certificate);
            let vertices = graph.vertex_count();
            let worst = WorstStart { graph, facing, moves };
            counts.count_run((moves, vertices), certificate, Some(worst));
            return;
        };
        *self.causes.entry(fault.name()).or_default() += 1;
        self.processes_ended += u64::from(fault.ends_process());
        let is_limit = fault.is_limit();
        let unmapped = UnmappedStart { graph, facing, fault, moves, actions, stderr };
        if is_limit {
            counts.unknown += 1;
            self.limit.get_or_insert(unmapped);
        } else {
            counts.count_failure(unmapped);
        }
    }

    /// Adds the result of later starts.
    pub(super) fn merge(&mut self, later: Self) {
        self.counts.merge(later.counts);
        self.processes_ended += later.processes_ended;
        self.stopped |= later.stopped;
        for (cause, count) in later.causes {
            *self.causes.entry(cause).or_default() += count;
        }
        self.limit = self.limit.take().or(later.limit);
    }
}
