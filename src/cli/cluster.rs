//! The options of a command that several machines can share (docs/cluster.md), and one process of them.

#[cfg(feature = "cluster")]
mod session;

use std::{
    io::{self, Write},
    path::PathBuf,
};

use toposlam_model::{
    ambiguity::{AmbiguitySearch, Findings, KeptPairs, Unfinished},
    check::{FinishedUnits, SharedPrefixCheck, Tally},
    enumerate::Watch,
    mapping::MappingAlgorithm,
};

use super::CliError;

/// The processes that share the work.
#[derive(clap::Args, Debug)]
#[command(next_help_heading = "Several machines")]
pub(super) struct ClusterOptions {
    /// Share the work with processes on other machines: a file with the address of each process,
    /// host:port, one a line. All run the same command but for --process (docs/cluster.md). Needs a
    /// build with --features cluster
    #[arg(long, value_name = "FILE", requires = "process")]
    hosts: Option<PathBuf>,

    /// With --hosts: the number of this process; 0 is the first line of the file. Process 0 prints the
    /// result and writes all files
    #[arg(long, value_name = "I", requires = "hosts")]
    process: Option<usize>,
}

/// A setting that all processes must have in common: its name and its value.
pub(super) type SharedSetting = (&'static str, String);

/// A process of a cluster. A program that was built without the feature `cluster` is none.
pub(super) trait ClusterSession {
    /// Whether this is process 0, which prints the result and writes files.
    fn is_first(&self) -> bool;

    fn check(
        &mut self,
        algorithm: MappingAlgorithm,
        sweep: &SharedPrefixCheck,
        units: &dyn FinishedUnits,
        watch: &dyn Watch,
    ) -> Result<Tally, CliError>;

    /// Searches with a marker. The other processes get the smallest pair only.
    fn search(
        &mut self,
        search: &AmbiguitySearch<'static>,
        kept: KeptPairs,
        watch: &dyn Watch,
    ) -> Result<Result<Findings, Unfinished>, CliError>;

    /// Reports how busy the threads were: a remark for each process, and with `--json` a line for all.
    fn report(&mut self, out: &mut dyn Write, json: bool, work: &str) -> Result<(), CliError>;

    /// Ends the connections, when all work is done.
    fn close(self: Box<Self>);
}

impl ClusterOptions {
    /// Connects to the other processes, if there are others. `lost` is added to the message if the connection to
    /// one is lost.
    ///
    /// # Errors
    /// Returns an error if the file of hosts is wrong, if another process does other work, or if one is
    /// missing.
    #[cfg(feature = "cluster")]
    pub(super) fn connect(
        &self,
        settings: &[SharedSetting],
        lost: &'static str,
    ) -> Result<Option<Box<dyn ClusterSession>>, CliError> {
        let (Some(hosts), Some(process)) = (&self.hosts, self.process) else { return Ok(None) };
        Ok(Some(Box::new(session::connect(hosts, process, settings, lost)?)))
    }

    /// There are no other processes.
    ///
    /// # Errors
    /// Returns an error if some are asked for.
    #[cfg(not(feature = "cluster"))]
    pub(super) fn connect(
        &self,
        _: &[SharedSetting],
        _: &'static str,
    ) -> Result<Option<Box<dyn ClusterSession>>, CliError> {
        let cause = "this program was built for one machine; to add clusters, run \
                     cargo build --release --features cluster";
        if self.hosts.is_some() { Err(CliError::at("--hosts", cause)) } else { Ok(None) }
    }
}

/// The report of a process: only process 0 prints it.
pub(super) struct SharedOutput<'o> {
    out: &'o mut dyn Write,
    is_printed: bool,
}

impl<'o> SharedOutput<'o> {
    pub(super) fn new(out: &'o mut dyn Write, is_printed: bool) -> Self {
        Self { out, is_printed }
    }
}

impl Write for SharedOutput<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.is_printed { self.out.write(bytes) } else { Ok(bytes.len()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
