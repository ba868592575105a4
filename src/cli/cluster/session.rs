//! A process of a cluster.

use std::{io::Write, path::Path};

use serde::Serialize;
use toposlam_cluster::{ClusterError, ClusterProcess, ConnectError, Hosts, ThreadUse};
use toposlam_model::{
    ambiguity::{AmbiguitySearch, Findings, KeptPairs, Unfinished},
    check::{FinishedUnits, SharedPrefixCheck, Tally},
    enumerate::Watch,
    mapping::MappingAlgorithm,
};

use super::{LostEnd, SharedSetting};
use crate::cli::{
    CliError, input,
    json::print_line,
    output,
    progress::Progress,
    terminal,
    text::{counted, grouped},
    version::version,
};

/// A process of a cluster.
pub(in crate::cli) struct ClusterSession {
    cluster: ClusterProcess,
    /// What each thread of each process did in the last work; only process 0 knows it.
    threads: Vec<ThreadUse>,
}

/// The line of `--json` about the threads.
#[derive(Serialize)]
struct ThreadsLine<'t> {
    work: &'t str,
    threads: &'t [ThreadUse],
}

/// The failure of the command if a process of the cluster fails.
fn failure(error: ClusterError) -> CliError {
    match error {
        ClusterError::Interrupted | ClusterError::Connect(ConnectError::Interrupted) => {
            CliError::Interrupted
        }
        ClusterError::Connect(missing @ ConnectError::Missing { .. }) => {
            CliError::Unfinished(missing.to_string())
        }
        ClusterError::Connect(error) => CliError::at("--hosts", error),
        ClusterError::Ended(_) => CliError::Unfinished(error.to_string()),
    }
}

impl ClusterSession {
    pub(super) fn connect(
        path: &Path,
        process: usize,
        settings: &[SharedSetting],
        end: LostEnd,
    ) -> Result<Self, CliError> {
        let text = input::read(path)?;
        let hosts = Hosts::parse(&String::from_utf8_lossy(&text))
            .map_err(|error| CliError::in_file(path, error))?;
        if process >= hosts.count() {
            let last = hosts.count() - 1;
            let cause = format!("write a number from 0 to {last}: {} has no more", path.display());
            return Err(CliError::at("--process", cause));
        }
        let owned = |(name, value): &SharedSetting| ((*name).to_owned(), value.clone());
        let mut settings: Vec<_> = settings.iter().map(owned).collect();
        settings.insert(0, ("the version".to_owned(), version().to_owned()));
        let progress = Progress::new("connecting", "processes")?.hidden();
        let waiting = |names: &[String]| remark!("waiting for {}", names.join(", "));
        let lost = move |name: &str| {
            let journal = match end {
                LostEnd::Journal => "; with the same --journal, it goes on from there",
                LostEnd::Nothing => "",
            };
            terminal::print_message(&format!(
                "the connection to {name} is lost: the work is not finished{journal}\n"
            ));
            output::exit_between_files(3);
        };
        let cluster =
            ClusterProcess::connect(&hosts, process, &settings, &progress, &waiting, lost)
                .map_err(failure)?;
        Ok(Self { cluster, threads: Vec::new() })
    }

    /// Whether this is process 0, which prints the result and writes files.
    pub(in crate::cli) fn is_first(&self) -> bool {
        self.cluster.is_first()
    }

    /// Checks an algorithm.
    pub(in crate::cli) fn check(
        &mut self,
        algorithm: MappingAlgorithm,
        sweep: &SharedPrefixCheck,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Result<Tally, CliError> {
        let found = self.cluster.check(algorithm, sweep, units, watch).map_err(failure)?;
        self.threads = found.threads;
        Ok(found.check)
    }

    /// Searches with a marker. The other processes get the smallest pair only.
    pub(in crate::cli) fn search(
        &mut self,
        search: &AmbiguitySearch<'static>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<Result<Findings, Unfinished>, CliError> {
        match self.cluster.search(search, kept, watch) {
            Ok(found) => {
                self.threads = found.threads;
                Ok(found.findings)
            }
            Err(ClusterError::Interrupted) => Ok(Err(Unfinished::Interrupted)),
            Err(error) => Err(failure(error)),
        }
    }

    /// Reports how busy the threads were: a remark for each process, and with `--json` a line for all.
    pub(in crate::cli) fn report(
        &mut self,
        out: &mut dyn Write,
        json: bool,
        work: &str,
    ) -> Result<(), CliError> {
        let threads = std::mem::take(&mut self.threads);
        for of_process in threads.chunk_by(|one, other| one.process == other.process) {
            let idle = || of_process.iter().map(|thread| thread.idle_seconds);
            let (least, most) = (idle().fold(f64::INFINITY, f64::min), idle().fold(0.0, f64::max));
            let tasks: u64 = of_process.iter().map(|thread| thread.tasks).sum();
            let first = of_process[0];
            remark!(
                "{work}, process {}: {} tasks; idle {least:.2} to {most:.2} s of {:.2} s ({})",
                first.process,
                grouped(tasks.into()),
                first.busy_seconds + first.idle_seconds,
                counted(of_process.len(), "thread"),
            );
        }
        if json && !threads.is_empty() {
            print_line(out, "threads", &ThreadsLine { work, threads: &threads })?;
        }
        Ok(())
    }

    /// Ends the connections, when all work is done.
    pub(in crate::cli) fn close(self) {
        self.cluster.close();
    }
}
