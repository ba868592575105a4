//! `toposlam check --explorer PROGRAM`: checks an explorer that is another program, in any language. It
//! speaks JSON lines: docs/protocol.md.

mod fault;
mod process;
mod protocol;
mod report;
mod run;
mod sweep;
mod tally;

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use toposlam_model::{
    check::{Tally, WorstStart},
    enumerate::{Each, Enumeration},
    format::named_world::NamedWorld,
};

use super::{CheckArguments, write_worst};
use crate::{
    cli::{CliError, Outcome, input, output, progress::Progress, text::counted},
    picture::{self, WorldPicture},
};
use process::ExplorerCommand;
use report::{ExplorerReport, ExplorerSize, failed_world};
use run::RunLimits;
use sweep::{ExplorerSweep, ExplorerWorlds};
use tally::{ExplorerTally, UnmappedStart};

/// The options of an explorer that is another program.
#[derive(clap::Args)]
#[command(next_help_heading = "Your own explorer")]
pub(super) struct ExplorerOptions {
    /// Check this program instead of an algorithm: a command, as in "python3 mine.py". It reads percepts
    /// and writes doors and a map, as JSON lines (docs/protocol.md); --threads processes run at once
    #[arg(
        long,
        value_name = "COMMAND",
        conflicts_with_all = ["algorithm", "choices", "max_states", "shard", "estimate", "journal"]
    )]
    explorer: Option<String>,

    /// The most seconds for each answer of the explorer
    #[arg(long, default_value_t = 10.0, value_name = "SECONDS", value_parser = seconds, requires = "explorer")]
    timeout: f64,

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

    /// Write the first start that the explorer did not map: a world file, or a picture (.svg, .png)
    #[arg(long, value_name = "FILE", requires = "explorer")]
    failed: Option<PathBuf>,
}

/// Parses a number of seconds.
fn seconds(text: &str) -> Result<f64, String> {
    const MOST: f64 = 86_400.0;
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds <= MOST => Ok(seconds),
        _ => Err(format!("write a number of seconds above 0, up to {MOST}")),
    }
}

impl ExplorerOptions {
    /// Whether an explorer is checked.
    pub(super) fn is_given(&self) -> bool {
        self.explorer.is_some()
    }
}

impl CheckArguments {
    /// Checks the explorer that is another program.
    pub(super) fn check_explorer(&self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let options = &self.explorer;
        let command = ExplorerCommand::from_text(options.explorer.as_deref().unwrap_or_default())?;
        let work = match &self.from {
            Some(path) => listed(path)?,
            None => self.enumerated()?,
        };
        self.check_explorer_places(work.values().all(ExplorerWorlds::is_simple))?;
        let sweep = ExplorerSweep {
            command: &command,
            marker: self.marker,
            limits: RunLimits {
                timeout: Duration::from_secs_f64(options.timeout),
                actions: options.max_moves,
            },
            restarts: options.restarts,
            processes: rayon::current_num_threads(),
        };
        let begun = Instant::now();
        let mut report = ExplorerReport::new(out, self.json, &command.text, self.marker);
        let (mut worst, mut unmapped) = (None, None);
        let mut cases = Vec::new();
        let mut sizes = work.into_iter();
        for (edges, worlds) in sizes.by_ref() {
            let progress = Progress::endless(&counted(edges, "edge"), "starts")?;
            let tally = sweep.run(&worlds, &progress);
            progress.finish();
            let tally = tally?;
            let (class, from) = (self.class(), self.from.as_deref());
            let size = ExplorerSize { edges, class, from, tally: &tally };
            report.size(&size)?;
            cases.push(size.ci_case());
            let ExplorerTally { counts, limit, .. } = tally;
            let Tally { worst: of_size, failure, interrupted, .. } = counts;
            let all_mapped = failure.is_none() && limit.is_none();
            super::keep_worse(&mut worst, of_size);
            keep_first(&mut unmapped, failure.or(limit));
            if interrupted || (!all_mapped && !self.keep_going) {
                break;
            }
        }
        let outcome = report.verdict(begun.elapsed())?;
        if unmapped.is_some() {
            let (class, from) = (self.class(), self.from.as_deref());
            let tally = ExplorerTally::default();
            let name = |(edges, _)| ExplorerSize { edges, class, from, tally: &tally }.name();
            self.add_not_checked(&mut cases, sizes.map(name));
        }
        self.ci.write("check", &cases)?;
        self.write_explorer_starts(&command.text, worst, unmapped)?;
        Ok(outcome)
    }

    /// The worlds for each number of edges.
    fn enumerated(&self) -> Result<BTreeMap<usize, ExplorerWorlds>, CliError> {
        let worlds = |edges| {
            let worlds = Enumeration::new(Each::World, self.class(), edges);
            let worlds = worlds.map_err(|error| CliError::at("--edges", error))?;
            Ok((edges, ExplorerWorlds::Enumerated(worlds)))
        };
        self.edges.iter().map(worlds).collect()
    }

    /// Checks that the output files can be written, before long work begins.
    fn check_explorer_places(&self, simple: bool) -> Result<(), CliError> {
        if let Some(worst) = &self.worst {
            output::check_world_place(worst, simple)?;
        }
        match &self.explorer.failed {
            Some(failed) => output::check_place(failed, &["toml", "json", "dot", "svg", "png"]),
            None => Ok(()),
        }
    }

    /// Writes the start that took the most moves, and the first that was not mapped.
    fn write_explorer_starts(
        &self,
        explorer: &str,
        worst: Option<WorstStart>,
        unmapped: Option<UnmappedStart>,
    ) -> Result<(), CliError> {
        if let Some(path) = &self.worst {
            write_worst(path, worst)?;
        }
        match (&self.explorer.failed, unmapped) {
            (None, _) => Ok(()),
            (Some(path), Some(start)) => write_failed(path, &failed_world(explorer, &start)),
            (Some(path), None) => {
                remark!("{} is not written: each start was mapped", path.display());
                Ok(())
            }
        }
    }
}

/// The worlds of a file, by their number of edges.
fn listed(path: &Path) -> Result<BTreeMap<usize, ExplorerWorlds>, CliError> {
    let mut sizes = BTreeMap::new();
    for graph in input::read_graphs(path)? {
        let graphs: &mut Vec<_> = sizes.entry(graph.edge_count()).or_default();
        graphs.push(graph);
    }
    Ok(sizes.into_iter().map(|(edges, graphs)| (edges, ExplorerWorlds::Listed(graphs))).collect())
}

/// Keeps the first start on which the explorer failed, or else on which a limit was reached.
fn keep_first(first: &mut Option<UnmappedStart>, later: Option<UnmappedStart>) {
    let is_failure = |start: &UnmappedStart| !start.fault.is_limit();
    let replaces = match (&*first, &later) {
        (None, _) => true,
        (Some(first), Some(later)) => !is_failure(first) && is_failure(later),
        (Some(_), None) => false,
    };
    if replaces {
        *first = later;
    }
}

/// Writes a start as a world file or as a picture.
fn write_failed(path: &Path, world: &NamedWorld) -> Result<(), CliError> {
    let drawn = || picture::svg(&WorldPicture::from(world));
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => output::write_whole(path, drawn().as_bytes()),
        Some("png") => {
            let image = picture::png(&drawn()).map_err(|error| CliError::in_file(path, error))?;
            output::write_whole(path, &image)
        }
        _ => output::write_world(path, world),
    }
}
