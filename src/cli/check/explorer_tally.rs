//! The counts of a check of an explorer that is another program.

use std::collections::BTreeMap;

use toposlam_model::{
    aid::AidKind,
    check::{KeptStart, Tally, WorstStart},
    format::named_world::NamedWorld,
};

use super::line::{FailedRun, FailureLine, SizeLine};
use crate::cli::explorer::{EndedRun, ExplorerStart, ReportedRun};

/// The first start of its kind is kept.
impl KeptStart for FailureLine {}

#[derive(Default)]
pub(super) struct ExplorerTally {
    /// The counts. Certificates are those of the starts that were mapped correctly. Of the others, those on which a
    /// limit was reached are unknown.
    pub(super) counts: Tally<Option<WorstStart>, Option<FailureLine>>,
    /// The first start on which a limit was reached.
    limit: Option<FailureLine>,
    /// The starts that were not mapped, in their order, as far as they are [kept](Self::keeping).
    pub(super) unmapped: Vec<NamedWorld>,
    /// The number of starts that are not mapped and kept.
    most_kept: usize,
    /// The number of starts for each name of a fault.
    causes: BTreeMap<String, u64>,
    pub(super) processes_ended: u64,
    /// Whether the rest of the starts was left out because too many runs ended their process.
    pub(super) stopped: bool,
}

impl ExplorerTally {
    /// Keeps the first starts that are not mapped, up to this number.
    pub(super) fn keeping(most_kept: usize) -> Self {
        Self { most_kept, ..Self::default() }
    }

    /// Counts a run. `stderr` is the end of the standard error of a process that was ended.
    pub(super) fn count(
        &mut self,
        explorer: &str,
        start: &ExplorerStart,
        run: EndedRun,
        stderr: String,
    ) {
        let ExplorerStart { graph, facing, certificate, .. } = *start;
        let moves = run.moves;
        let counts = &mut self.counts;
        counts.starts += 1;
        let Err(fault) = &run.result else {
            counts.mapped += 1;
            counts.count_certificate(certificate);
            let worst = WorstStart { graph: graph.clone(), facing, moves };
            counts.count_run((moves, graph.vertex_count()), certificate, Some(worst));
            return;
        };
        *self.causes.entry(fault.name().to_owned()).or_default() += 1;
        self.processes_ended += u64::from(fault.ends_process());
        counts.unknown += u64::from(fault.is_limit());
        let name = fault.name().to_owned();
        let about = format!("The explorer {explorer} does not map it: {name}");
        if self.unmapped.len() < self.most_kept {
            self.unmapped.push(NamedWorld::discovered("failed", &about, graph, facing));
        }
        let first = if fault.is_limit() { &mut self.limit } else { &mut counts.failure };
        if first.is_none() {
            let run = FailedRun::Explorer(ReportedRun::new(run, stderr));
            *first = Some(FailureLine::new(name, Some(moves), &about, (graph, facing), run));
        }
    }

    pub(super) fn merge(&mut self, later: Self) {
        self.counts.merge(later.counts);
        self.processes_ended += later.processes_ended;
        self.stopped |= later.stopped;
        let room = self.most_kept.saturating_sub(self.unmapped.len());
        self.unmapped.extend(later.unmapped.into_iter().take(room));
        for (cause, count) in later.causes {
            *self.causes.entry(cause).or_default() += count;
        }
        self.limit = self.limit.take().or(later.limit);
    }

    /// The line of the counts, in which a guess has the other world.
    pub(super) fn line(&self, line: SizeLine, explorer: &str, marker: AidKind) -> SizeLine {
        let failure = self.counts.failure.clone();
        let line = SizeLine {
            explorer: Some(explorer.to_owned()),
            unknown: Some(self.counts.unknown),
            causes: Some(self.causes.clone()),
            stopped: Some(self.stopped),
            failure: failure.map(|failure| failure.explained(marker)),
            limit: self.limit.clone(),
            ..line
        };
        line.with_counts(&self.counts)
    }
}
