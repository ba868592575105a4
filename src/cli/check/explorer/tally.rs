//! The counts of a check of an explorer that is another program.

use std::collections::BTreeMap;

use toposlam_model::{
    check::{KeptStart, Tally, WorstStart},
    world::Action,
};

use super::{
    fault::ExplorerFault,
    run::{EndedRun, ExplorerStart},
};
use crate::cli::{
    check::line::{FailedRun, FailureLine, SizeLine},
    text::capital,
};

/// The first start of its kind is kept.
impl KeptStart for FailureLine {}

#[derive(Default)]
pub(in crate::cli::check) struct ExplorerTally {
    /// The counts. Certificates are those of the starts that were mapped correctly. Of the others, those on which a
    /// limit was reached are unknown.
    pub(in crate::cli::check) counts: Tally<Option<WorstStart>, Option<FailureLine>>,
    /// The first start on which a limit was reached.
    limit: Option<FailureLine>,
    /// The number of starts for each name of a fault.
    causes: BTreeMap<String, u64>,
    pub(super) processes_ended: u64,
    /// Whether the rest of the starts was left out because too many runs ended their process.
    pub(super) stopped: bool,
}

impl ExplorerTally {
    /// Counts a run. `stderr` is the end of the standard error of a process that was ended.
    pub(super) fn count(
        &mut self,
        explorer: &str,
        start: &ExplorerStart,
        run: EndedRun,
        stderr: String,
    ) {
        let ExplorerStart { graph, facing, certificate, .. } = *start;
        let EndedRun { moves, actions, result } = run;
        let counts = &mut self.counts;
        counts.starts += 1;
        let Err(fault) = result else {
            counts.mapped += 1;
            counts.count_certificate(certificate);
            let worst = WorstStart { graph: graph.clone(), facing, moves };
            counts.count_run((moves, graph.vertex_count()), certificate, Some(worst));
            return;
        };
        *self.causes.entry(fault.name().to_owned()).or_default() += 1;
        self.processes_ended += u64::from(fault.ends_process());
        counts.unknown += u64::from(fault.is_limit());
        let first = if fault.is_limit() { &mut self.limit } else { &mut counts.failure };
        first.get_or_insert_with(|| unmapped(explorer, start, &fault, (moves, actions), stderr));
    }

    pub(super) fn merge(&mut self, later: Self) {
        self.counts.merge(later.counts);
        self.processes_ended += later.processes_ended;
        self.stopped |= later.stopped;
        for (cause, count) in later.causes {
            *self.causes.entry(cause).or_default() += count;
        }
        self.limit = self.limit.take().or(later.limit);
    }

    pub(in crate::cli::check) fn line(&self, line: SizeLine, explorer: &str) -> SizeLine {
        let line = SizeLine {
            explorer: Some(explorer.to_owned()),
            unknown: Some(self.counts.unknown),
            causes: Some(self.causes.clone()),
            stopped: Some(self.stopped),
            failure: self.counts.failure.clone(),
            limit: self.limit.clone(),
            ..line
        };
        line.with_counts(&self.counts)
    }
}

fn unmapped(
    explorer: &str,
    start: &ExplorerStart,
    fault: &ExplorerFault,
    (moves, actions): (u64, Vec<Action>),
    stderr: String,
) -> FailureLine {
    let about = format!("The explorer {explorer} does not map it: {}", fault.name());
    let run = FailedRun::Explorer {
        message: capital(&format!("the explorer {fault}")),
        last_actions: actions,
        stderr,
    };
    let start = (start.graph, start.facing);
    FailureLine::new(fault.name().to_owned(), Some(moves), &about, start, run)
}
