//! Runs an explorer that is another program on every start of many worlds, in several processes at once.
//!
//! The starts are cut into batches, in their order. Each batch has a process of its own, so that the result
//! does not depend on the number of processes, even if a program remembers its earlier runs.

use std::{
    collections::BTreeMap,
    ops::ControlFlow,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender, SyncSender},
    },
    thread,
};

use toposlam_model::{
    aid::AidKind,
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::Watch,
    folding::certificate_length,
    isomorphism::{Candidate, canonical},
};

use super::{Work, explorer_tally::ExplorerTally};
use crate::cli::{
    CliError,
    explorer::{ExplorerCommand, ExplorerFault, ExplorerLimits, ExplorerProcess, ExplorerStart},
    mapping_marker::is_directional,
    progress::{Progress, must_stop},
};

/// A batch is complete with the first world that gives it this many starts.
const BATCH: usize = 256;

/// What is run, and within which limits.
#[derive(Clone, Copy)]
pub(super) struct ExplorerSweep<'a> {
    pub(super) command: &'a ExplorerCommand,
    pub(super) limits: ExplorerLimits,
    pub(super) marker: AidKind,
    /// The number of starts that are not mapped and kept.
    pub(super) most_kept: usize,
}

/// Worlds with the facing darts of their starts.
struct Batch {
    number: usize,
    worlds: Vec<(EmbeddedGraph, Vec<Dart>)>,
    is_last: bool,
}

struct BatchRun {
    /// Each but the last ends with a run that ended its process.
    tallies: Vec<ExplorerTally>,
    has_more: bool,
}

type BatchResult = Result<(usize, BatchRun), CliError>;

/// Sends the batches until the receiver is dropped.
fn send_batches(work: &Work, batches: &SyncSender<Batch>) {
    let mut number = 0;
    let mut worlds = Vec::new();
    let mut starts = 0;
    let all = work.for_each_world(&mut |graph, facing| {
        if starts >= BATCH {
            starts = 0;
            let batch = Batch { number, worlds: std::mem::take(&mut worlds), is_last: false };
            number += 1;
            if batches.send(batch).is_err() {
                return ControlFlow::Break(());
            }
        }
        let facing = facing.map_or_else(|| distinct_starts(graph), |facing| vec![facing]);
        starts += facing.len();
        worlds.push((graph.clone(), facing));
        ControlFlow::Continue(())
    });
    if all.is_continue() && !worlds.is_empty() {
        // If the check stops, there is no receiver.
        let _ = batches.send(Batch { number, worlds, is_last: true });
    }
}

/// Of the darts that an automorphism takes to each other, which are the same start, the first.
fn distinct_starts(graph: &EmbeddedGraph) -> Vec<Dart> {
    let orbit = canonical(graph).orbit;
    graph.darts().filter(|dart| orbit[dart.at()] == *dart).collect()
}

impl ExplorerSweep<'_> {
    /// Runs the explorer on every start.
    ///
    /// # Errors
    /// Returns an error if a process cannot be started.
    pub(super) fn run(&self, work: &Work, progress: &Progress) -> Result<ExplorerTally, CliError> {
        let processes = rayon::current_num_threads();
        let enough = AtomicBool::new(false);
        thread::scope(|scope| {
            let (batches, to_run) = mpsc::sync_channel(2 * processes);
            let (results, to_merge) = mpsc::channel();
            scope.spawn(move || send_batches(work, &batches));
            let to_run = Arc::new(Mutex::new(to_run));
            for _ in 0..processes {
                let (to_run, results, enough) = (Arc::clone(&to_run), results.clone(), &enough);
                scope.spawn(move || self.work(&to_run, &results, enough, progress));
            }
            // When the last worker ends, the other ends of the channels are dropped.
            drop((to_run, results));
            let merged = self.merge(&to_merge, &enough);
            enough.store(true, Ordering::Relaxed);
            merged
        })
    }

    fn work(
        &self,
        batches: &Mutex<Receiver<Batch>>,
        results: &Sender<BatchResult>,
        enough: &AtomicBool,
        progress: &Progress,
    ) {
        while !enough.load(Ordering::Relaxed) {
            let next = batches.lock().unwrap_or_else(PoisonError::into_inner).recv();
            let Ok(batch) = next else { break };
            let result = self.run_batch(&batch, enough);
            let tallies = result.iter().flat_map(|run| &run.tallies);
            progress.part_done(tallies.map(|tally| tally.counts.starts).sum());
            if results.send(result.map(|run| (batch.number, run))).is_err() {
                break;
            }
        }
    }

    fn run_batch(&self, batch: &Batch, enough: &AtomicBool) -> Result<BatchRun, CliError> {
        let mut left: usize = batch.worlds.iter().map(|(_, facing)| facing.len()).sum();
        let ended = |tallies, left| BatchRun { tallies, has_more: left > 0 || !batch.is_last };
        let mut tallies = Vec::new();
        let empty = || ExplorerTally::keeping(self.most_kept);
        let mut tally = empty();
        let mut process: Option<ExplorerProcess> = None;
        let mut candidate = Candidate::default();
        let directional = is_directional(self.marker);
        let explorer = &self.command.text;
        for (graph, facing) in &batch.worlds {
            tally.counts.worlds += 1;
            for &facing in facing {
                if must_stop() {
                    tally.counts.interrupted = true;
                }
                if tally.counts.interrupted || enough.load(Ordering::Relaxed) {
                    tallies.push(tally);
                    return Ok(ended(tallies, left));
                }
                left -= 1;
                let certificate = directional.then(|| certificate_length(graph, facing) as u64);
                let start = ExplorerStart { graph, facing, marker: self.marker, certificate };
                let mut running = match process.take() {
                    Some(process) => process,
                    None => self.command.start()?,
                };
                let Some(run) = start.run(&mut running, self.limits, &mut candidate) else {
                    tally.counts.interrupted = true;
                    continue;
                };
                if !run.result.as_ref().is_err_and(ExplorerFault::ends_process) {
                    process = Some(running);
                    tally.count(explorer, &start, run, String::new());
                    continue;
                }
                tally.count(explorer, &start, run, running.end());
                tallies.push(std::mem::replace(&mut tally, empty()));
                if tallies.len() as u64 == self.limits.restarts {
                    return Ok(ended(tallies, left));
                }
            }
        }
        if let Some(process) = process {
            process.finish();
        }
        tallies.push(tally);
        Ok(ended(tallies, left))
    }

    /// Merges the results in the order of the starts, up to the run that ends the last process.
    fn merge(
        &self,
        results: &Receiver<BatchResult>,
        enough: &AtomicBool,
    ) -> Result<ExplorerTally, CliError> {
        let mut total = ExplorerTally::keeping(self.most_kept);
        let mut waiting = BTreeMap::new();
        let mut next = 0;
        for result in results {
            let (number, run) = result?;
            waiting.insert(number, run);
            while let Some(BatchRun { tallies, has_more }) = waiting.remove(&next) {
                next += 1;
                let mut tallies = tallies.into_iter();
                while let Some(tally) = tallies.next() {
                    total.merge(tally);
                    if total.processes_ended == self.limits.restarts {
                        enough.store(true, Ordering::Relaxed);
                        total.stopped = has_more || tallies.any(|later| later.counts.starts > 0);
                        return Ok(total);
                    }
                }
            }
        }
        // After Ctrl-C, a batch may be missing.
        let unmerged = waiting.into_values().flat_map(|run| run.tallies);
        unmerged.for_each(|tally| total.merge(tally));
        total.counts.interrupted |= must_stop();
        Ok(total)
    }
}
