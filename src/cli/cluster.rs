//! The options of a command that several machines can share (docs/cluster.md), and one process of them.

use std::{io::Write, path::PathBuf};

use super::CliError;

#[cfg(not(feature = "cluster"))]
mod absent;
#[cfg(feature = "cluster")]
mod session;

#[cfg(not(feature = "cluster"))]
pub(super) use absent::NoCluster as ClusterSession;
#[cfg(feature = "cluster")]
pub(super) use session::ClusterSession;

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

impl ClusterOptions {
    /// Connects to the other processes, if there are others.
    ///
    /// # Errors
    /// Returns an error if the file of hosts is wrong, if another process does other work, or if one is
    /// missing.
    pub(super) fn connect(
        &self,
        settings: &[SharedSetting],
        end: LostEnd,
    ) -> Result<Option<ClusterSession>, CliError> {
        match (&self.hosts, self.process) {
            (Some(hosts), Some(process)) => {
                ClusterSession::connect(hosts, process, settings, end).map(Some)
            }
            _ => Ok(None),
        }
    }
}

/// What is left when the connection to another process is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LostEnd {
    /// Nothing.
    Nothing,
    /// A journal has the finished units.
    Journal,
}

/// The report of a process: only process 0 prints it.
pub(super) struct SharedOutput<'o> {
    out: &'o mut dyn Write,
    is_printed: bool,
}

impl<'o> SharedOutput<'o> {
    pub(super) fn new(out: &'o mut dyn Write, cluster: Option<&ClusterSession>) -> Self {
        Self { out, is_printed: cluster.is_none_or(ClusterSession::is_first) }
    }
}

impl Write for SharedOutput<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.is_printed { self.out.write(bytes) } else { Ok(bytes.len()) }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}
