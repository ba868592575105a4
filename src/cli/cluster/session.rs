//! A process of a cluster.

use std::{io::Write, path::Path};

use serde_json::json;
use toposlam_cluster::{ClusterError, ClusterProcess, ConnectError, Hosts, ThreadUse};
use toposlam_model::{
    ambiguity::{AmbiguitySearch, Findings, KeptPairs, Unfinished},
    check::{FinishedUnits, SharedPrefixCheck, Tally},
    enumerate::Watch,
    mapping::MappingAlgorithm,
};

use super::{ClusterSession, SharedSetting};
use crate::cli::{
    CliError, input,
    json::print_line,
    output,
    progress::Progress,
    terminal,
    text::{counted, grouped},
    version::version,
};

pub(super) struct ConnectedSession {
    cluster: ClusterProcess,
    /// What each thread of each process did in the last work; only process 0 knows it.
    threads: Vec<ThreadUse>,
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

pub(super) fn connect(
    path: &Path,
    process: usize,
    settings: &[SharedSetting],
    lost: &'static str,
) -> Result<ConnectedSession, CliError> {
    let text = input::read(path)?;
    let hosts = Hosts::parse(&String::from_utf8_lossy(&text))
        .map_err(|error| CliError::in_file(path, error))?;
    if process >= hosts.count() {
        let last = hosts.count() - 1;
        let cause = format!("write a number from 0 to {last}: {} has no more", path.display());
        return Err(CliError::at("--process", cause));
    }
    let version = [("the version", version().to_owned())];
    let settings = version.iter().chain(settings);
    let settings: Vec<_> =
        settings.map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    let progress = Progress::new("connecting", "processes")?.hidden();
    let waiting = |names: &[String]| remark!("waiting for {}", names.join(", "));
    let end = move |name: &str| {
        let message = format!("the connection to {name} is lost: the work is not finished{lost}\n");
        terminal::print_message(&message);
        output::exit_between_files(3);
    };
    let cluster = ClusterProcess::connect(&hosts, process, &settings, &progress, &waiting, end)
        .map_err(failure)?;
    Ok(ConnectedSession { cluster, threads: Vec::new() })
}

impl ClusterSession for ConnectedSession {
    fn is_first(&self) -> bool {
        self.cluster.is_first()
    }

    fn check(
        &mut self,
        algorithm: MappingAlgorithm,
        sweep: &SharedPrefixCheck,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Result<Tally, CliError> {
        let (tally, threads) =
            self.cluster.check(algorithm, sweep, units, watch).map_err(failure)?;
        self.threads = threads;
        Ok(tally)
    }

    fn search(
        &mut self,
        search: &AmbiguitySearch<'static>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<Result<Findings, Unfinished>, CliError> {
        match self.cluster.search(search, kept, watch) {
            Ok((findings, threads)) => {
                self.threads = threads;
                Ok(findings)
            }
            Err(ClusterError::Interrupted) => Ok(Err(Unfinished::Interrupted)),
            Err(error) => Err(failure(error)),
        }
    }

    fn report(&mut self, out: &mut dyn Write, json: bool, work: &str) -> Result<(), CliError> {
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
            print_line(out, "threads", &json!({ "work": work, "threads": threads }))?;
        }
        Ok(())
    }

    fn close(self: Box<Self>) {
        self.cluster.close();
    }
}
