//! `toposlam check`: Algorithm 1 on every start of every world up to a size.

mod progress;
mod report;
mod sizes;

use std::{collections::BTreeMap, io::Write, path::PathBuf, time::Instant};

use toposlam_model::{
    check::{Algorithm1, Choice, Shard, Sweep, Tally, WorstStart, check_world},
    enumerate::{Class, Each, Enumeration},
    format::named_world::NamedWorld,
};

use super::{Failure, Outcome, input, output};
use progress::Progress;
use report::Report;
use sizes::Sizes;

/// Run Algorithm 1 on every start of every world up to a size; is every map right?
///
/// Each map is proved right by a bijection between it and the world; the robot must be where it
/// believes to be; and the moves must stay within m n + 2 m^2 (n - 1).
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  toposlam check                                  every world with up to 6 edges
  toposlam check --edges 8 --class planar --json  one size of one class, for a program
  toposlam check --edges 7 --shard 1/4            a quarter of the work
  toposlam check --edges 1..=4 --choices all      every resolution of what Algorithm 1 leaves open
  toposlam check --from worlds/petersen.toml      every start of the worlds in a file

Exit codes: 0 every map is right, 1 one is wrong, 2 bad usage or input, 3 not all was checked.")]
pub(super) struct Arguments {
    /// Numbers of edges: one, as in 6, or several, as in 1..=6
    #[arg(long, default_value = "1..=6", value_name = "SIZES")]
    edges: Sizes,

    /// Class of worlds: multigraph, simple, corridor or planar
    #[arg(long, default_value = "multigraph")]
    class: Class,

    /// Marker with which the worlds are mapped: directional
    #[arg(long, default_value = "directional", value_parser = ["directional"])]
    marker: String,

    /// Runs of each start: default, or all that the open choices allow
    #[arg(long, default_value = "default", value_parser = ["default", "all"])]
    choices: String,

    /// Check one of n disjoint shares, as in 2/4
    #[arg(long, default_value = "1/1", value_name = "I/N")]
    shard: Shard,

    /// Check the worlds in a file (world file, planar_code, edge_code) instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["edges", "class", "shard"])]
    from: Option<PathBuf>,

    /// Write the start that took the most moves, as a world file
    #[arg(long, value_name = "FILE")]
    worst: Option<PathBuf>,

    /// Threads; the result does not depend on them [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MAX_THREADS))]
    threads: Option<u16>,

    /// Print one JSON object for each number of edges
    #[arg(long)]
    json: bool,
}

/// More threads than this help nobody, and starting them would take longer than the check.
const MAX_THREADS: i64 = 1024;

impl Arguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        if let Some(worst) = &self.worst {
            output::check_place(worst)?;
        }
        if let Some(threads) = self.threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into());
            pool.build_global().map_err(|error| Failure::at("--threads", error))?;
        }
        let sizes: Vec<_> = match self.from {
            Some(_) => Vec::new(),
            None => self.edges.iter().map(|edges| self.sweep(edges)).collect::<Result<_, _>>()?,
        };
        let begun = Instant::now();
        let mut report = Report::new(out, self.json, self.choice());
        let mut worst: Option<WorstStart> = None;
        match &self.from {
            Some(path) => {
                let class = path.display().to_string();
                for (edges, tally) in self.check_file(path)? {
                    report.size(edges, &class, None, &tally)?;
                    keep_worse(&mut worst, tally.worst);
                }
            }
            None => {
                for (edges, sweep) in self.edges.iter().zip(sizes) {
                    let progress = Progress::new(edges)?;
                    let tally = sweep.run(&Algorithm1, &progress);
                    progress.finish();
                    report.size(edges, self.class.name(), Some(self.shard), &tally)?;
                    keep_worse(&mut worst, tally.worst);
                    if tally.interrupted {
                        break;
                    }
                }
            }
        }
        let outcome = report.verdict(begun.elapsed())?;
        if let (Some(path), Some(worst)) = (&self.worst, worst) {
            let moves = worst.moves;
            let about = format!("The start that took the most moves, {moves}, in a check");
            let world = NamedWorld::discovered("worst", &about, &worst.graph, Some(worst.facing));
            output::write_world(path, &world)?;
        }
        Ok(outcome)
    }

    fn choice(&self) -> Choice {
        if self.choices == "all" { Choice::All } else { Choice::Default }
    }

    fn sweep(&self, edges: usize) -> Result<Sweep, Failure> {
        let enumeration = Enumeration::new(Each::World, self.class, edges)
            .map_err(|error| Failure::at("--edges", error))?;
        Ok(Sweep { enumeration, shard: self.shard, choice: self.choice() })
    }

    /// The worlds of a file, by their number of edges.
    fn check_file(&self, path: &std::path::Path) -> Result<BTreeMap<usize, Tally>, Failure> {
        let mut tallies: BTreeMap<usize, Tally> = BTreeMap::new();
        for graph in input::read_graphs(path)? {
            let tally = check_world(&graph, self.choice(), &Algorithm1);
            tallies.entry(graph.edge_count()).or_default().merge(tally);
        }
        Ok(tallies)
    }
}

fn keep_worse(worst: &mut Option<WorstStart>, other: Option<WorstStart>) {
    let moves = |start: &Option<WorstStart>| start.as_ref().map_or(0, |start| start.moves);
    if moves(&other) > moves(worst) {
        *worst = other;
    }
}
