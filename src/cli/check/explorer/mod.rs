//! `toposlam check --explorer PROGRAM`: checks an explorer that is another program, in any language. It
//! speaks JSON lines: docs/protocol.md.

mod fault;
mod process;
mod protocol;
mod run;
mod sweep;
mod tally;

use std::time::Duration;

pub(super) use process::ExplorerCommand;
pub(super) use sweep::ExplorerSweep;

#[derive(clap::Args)]
#[command(next_help_heading = "Your own explorer")]
pub(super) struct ExplorerOptions {
    /// Check this program instead of an algorithm: a command, as in "python3 mine.py". It reads percepts
    /// and writes doors and a map, as JSON lines (docs/protocol.md); --threads processes run at once
    #[arg(
        long,
        value_name = "COMMAND",
        conflicts_with_all = ["algorithm", "choices", "shard", "estimate", "journal"]
    )]
    pub(super) explorer: Option<ExplorerCommand>,

    /// The most seconds for each answer of the explorer
    #[arg(long, default_value = "10", value_name = "SECONDS", value_parser = seconds, requires = "explorer")]
    timeout: Duration,

    /// The most moves, pick-ups and drops in a run of the explorer
    #[arg(
        long,
        default_value_t = 100_000,
        value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..),
        requires = "explorer"
    )]
    max_moves: u64,

    /// Skip the rest of a size after N runs that ended their process
    #[arg(
        long,
        default_value_t = 10,
        value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..),
        requires = "explorer"
    )]
    restarts: u64,
}

fn seconds(text: &str) -> Result<Duration, String> {
    const MOST: f64 = 86_400.0;
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds <= MOST => Ok(Duration::from_secs_f64(seconds)),
        _ => Err(format!("write a number of seconds above 0, up to {MOST}")),
    }
}
