//! An explorer that is another program, in any language: `--explorer PROGRAM` of `check` and `explore`. It speaks JSON
//! lines: docs/protocol.md.

mod fault;
mod process;
mod protocol;
mod reported_run;
mod run;

use std::time::Duration;

use super::CliError;

pub(super) use fault::ExplorerFault;
pub(super) use process::{ExplorerCommand, ExplorerProcess};
pub(super) use reported_run::ReportedRun;
pub(super) use run::{EndedRun, ExplorerStart};

#[derive(clap::Args)]
#[command(next_help_heading = "Your own explorer")]
pub(super) struct ExplorerOptions {
    /// Run this program instead of an algorithm: a command, as in "python3 mine.py". It reads percepts and writes
    /// doors and a map, as JSON lines (docs/protocol.md)
    #[arg(long, value_name = "COMMAND")]
    pub(super) explorer: Option<ExplorerCommand>,

    /// The most seconds for each answer of the explorer, moves with pick-ups and drops in a run, or runs that
    /// end their process before the rest of a size is skipped (repeatable) [default: 10s, 100000moves,
    /// 10restarts]
    #[arg(long, value_name = "LIMIT", value_parser = limit, requires = "explorer")]
    limit: Vec<ExplorerLimit>,
}

/// A limit on an explorer, in place of a default one.
#[derive(Clone, Copy, Debug)]
enum ExplorerLimit {
    Timeout(Duration),
    Moves(u64),
    Restarts(u64),
}

/// All limits on an explorer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExplorerLimits {
    pub(super) timeout: Duration,
    pub(super) moves: u64,
    pub(super) restarts: u64,
}

impl ExplorerOptions {
    /// Checks that no limit is given that one run does not have.
    ///
    /// # Errors
    /// Returns an error if restarts are limited.
    pub(super) fn check_one_run(&self) -> Result<(), CliError> {
        if self.limit.iter().any(|limit| matches!(limit, ExplorerLimit::Restarts(_))) {
            return Err(CliError::at("--limit", "one run has no restarts"));
        }
        Ok(())
    }

    pub(super) fn limits(&self) -> ExplorerLimits {
        let timeout = Duration::from_secs(10);
        let mut limits = ExplorerLimits { timeout, moves: 100_000, restarts: 10 };
        for limit in &self.limit {
            match *limit {
                ExplorerLimit::Timeout(timeout) => limits.timeout = timeout,
                ExplorerLimit::Moves(moves) => limits.moves = moves,
                ExplorerLimit::Restarts(restarts) => limits.restarts = restarts,
            }
        }
        limits
    }
}

/// Parses a limit: a number and its unit.
fn limit(text: &str) -> Result<ExplorerLimit, String> {
    const MOST: f64 = 86_400.0;
    let unit = text.trim_start_matches(|letter: char| "0123456789.".contains(letter));
    let number = text.strip_suffix(unit).unwrap_or_default();
    let whole = || number.parse().ok().filter(|&number: &u64| number > 0);
    let seconds = || number.parse().ok().filter(|&number: &f64| number > 0.0 && number <= MOST);
    let limit = match unit {
        "s" => seconds().map(Duration::from_secs_f64).map(ExplorerLimit::Timeout),
        "moves" => whole().map(ExplorerLimit::Moves),
        "restarts" => whole().map(ExplorerLimit::Restarts),
        _ => None,
    };
    let units = format!("s (up to {MOST}), moves or restarts");
    limit.ok_or_else(|| format!("write a number above 0 with its unit: {units}"))
}
