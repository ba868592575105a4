//! `toposlam check`: an algorithm runs on every start of every world up to a size.

mod add;
mod estimate;
mod explorer;
mod journal;
mod line;
mod report;

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
    time::Instant,
};

use toposlam_model::{
    check::{Check, FinishedUnits, Shard, SharedPrefixCheck, Tally, WorstStart},
    embedded_graph::EmbeddedGraph,
    enumerate::{Class, Watch},
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
    marker::{self, Marker},
};

use super::{
    ChoicesOption, CliError, Outcome, RunChoices,
    ci_report::{CiCase, CiOptions},
    cluster::{ClusterOptions, ClusterSession, LostEnd, SharedOutput},
    edge_range::EdgeRange,
    exit_codes::help_end,
    input,
    mapping_marker::{AlgorithmOption, MappingMarker, movable_not_sufficient},
    output,
    progress::Progress,
    text::counted,
    use_threads,
    version::version,
};
use estimate::EstimateOptions;
use explorer::ExplorerOptions;
use journal::{CheckJournal, JournalHeader};
use line::SizeResult;
use line::{AlgorithmInfo, SizeLine};
use report::CheckReport;

/// Run Algorithm 1 on every start of every world up to a size, and check every map
///
/// For each start, a bijection proves that the map is isomorphic to the world, the robot is where it
/// believes it is, and the number of moves is at most m n + 2 m^2 (n - 1), for m edges and n vertices.
///
/// With --marker movable, the algorithm for one movable marker is checked instead, on worlds without
/// loops and parallel edges. Its bound is 3 n (n - 1) / 2 + (m - n + 1) (6 n - 7) moves.
///
/// With --explorer, a program of yours is checked instead, in any language.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam check                              every world with up to 6 edges
  toposlam check --edges 8 --class planar     one size of one class
  toposlam check --edges 7 --shard 1/2 --json > one.jsonl
  toposlam check --edges 7 --shard 2/2 --json > two.jsonl
  toposlam check --add one.jsonl two.jsonl    the whole from its shares
  toposlam check --edges 1..=4 --choices all  every open choice
  toposlam check --from worlds/petersen.toml  the worlds in a file
  toposlam check --marker movable             a marker that the robot carries
  toposlam check --algorithm folding          the folding explorer
  toposlam check --explorer ./mine --edges 5  your own program
  toposlam check --edges 10 --estimate        what a check will take
  toposlam check --edges 9 --journal nine     a check that can be killed
  toposlam check --edges 10 --hosts hosts.txt --process 0
                                              the first of some machines

Ctrl-C stops the check and prints the results so far.",
    &[
        (0, "every map is right, or the estimate is printed"),
        (1, "a map is wrong"),
        (2, "bad usage or input, also a shard that is missing or occurs twice"),
        (3, "not everything was checked: a limit was reached, there is nothing to check, Ctrl-C, or \
             the connection to another process is lost; no probe of an estimate found a start"),
    ],
))]
#[command(mut_arg("hosts", |hosts| hosts.conflicts_with_all(NOT_SHARED)))]
#[command(mut_arg("process", |process| process.conflicts_with_all(NOT_SHARED)))]
pub(super) struct CheckArguments {
    /// Number of edges, as in 6, or a range, as in 1..=6
    #[arg(long, default_value = "1..=6", value_name = "SIZES", allow_hyphen_values = true)]
    edges: EdgeRange,

    /// Class of worlds: multigraph, simple, corridor or planar [default: multigraph, or simple with
    /// --marker movable]
    #[arg(long)]
    class: Option<Class>,

    /// The robot's marker: directional (Algorithm 1) or movable; any kind with --explorer
    #[arg(
        long,
        default_value = "directional",
        value_name = "KIND",
        value_parser = marker_kind
    )]
    marker: &'static dyn Marker,

    /// The algorithm that maps with the directional marker: algorithm1 or folding
    #[arg(long, default_value = "algorithm1", hide_possible_values = true)]
    algorithm: AlgorithmOption,

    /// Runs from each start: default, or all that the open choices of Algorithm 1 allow
    #[arg(long, default_value = "default", hide_possible_values = true)]
    choices: ChoicesOption,

    /// With --choices all: skip a start that has more states, between rounds (line 4) and within
    /// (line 8) [default: 1000000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    max_states: Option<u64>,

    /// Check one of N disjoint shares of the starts, as in 2/4; --add adds up the results of --json
    #[arg(long, default_value = "1/1", value_name = "I/N", allow_hyphen_values = true)]
    shard: Shard,

    /// Check the worlds in a file (world file, planar_code or edge_code) instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["edges", "class", "shard"])]
    from: Option<PathBuf>,

    /// Write the start that took the most moves: .toml, .json, .dot, or plantri's .ec or .pc
    #[arg(long, value_name = "FILE")]
    worst: Option<PathBuf>,

    /// Number of threads, up to 1024 [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Print one JSON object for each number of edges
    #[arg(long)]
    json: bool,

    /// Record finished parts of the work in a folder. If a check is killed, the same command continues
    /// from there. With --hosts, process 0 records the parts of all
    #[arg(long, value_name = "DIR", conflicts_with_all = ["from", "choices"])]
    journal: Option<PathBuf>,

    /// Do not check: add up the results of the shards of a check, the files of --json; each shard must be
    /// there once
    #[arg(long, requires = "shards", conflicts_with_all = NOT_ADDED)]
    add: bool,

    /// With --add: files with the lines of shards
    #[arg(value_name = "FILE", requires = "add", conflicts_with_all = NOT_ADDED)]
    shards: Vec<PathBuf>,

    #[command(flatten)]
    estimate: EstimateOptions,

    /// Check larger worlds even after a wrong map, or after an explorer reached a limit
    #[arg(long)]
    keep_going: bool,

    #[command(flatten)]
    explorer: ExplorerOptions,

    #[command(flatten)]
    cluster: ClusterOptions,

    #[command(flatten)]
    ci: CiOptions,
}

/// Options of a check, which --add does not do.
const NOT_ADDED: [&str; 15] = [
    "edges",
    "class",
    "marker",
    "algorithm",
    "choices",
    "max_states",
    "shard",
    "from",
    "worst",
    "threads",
    "journal",
    "estimate",
    "keep_going",
    "explorer",
    "hosts",
];

/// Options of a check that machines cannot share. Clap does not ask for `--hosts` where it cannot be given, so
/// `--process` excludes them, too.
const NOT_SHARED: [&str; 5] = ["shard", "from", "explorer", "estimate", "choices"];

/// Parses the name of a kind of marker.
fn marker_kind(name: &str) -> Result<&'static dyn Marker, String> {
    // For a name that no marker has, the error lists the markers of the algorithms.
    marker::named(name).map_err(|_| name.parse::<MappingMarker>().err().unwrap_or_default())
}

/// What is checked for one number of edges.
enum Work {
    /// Runs share their beginnings.
    Lazy(Box<SharedPrefixCheck>),
    /// All choices.
    Check(Check),
    Worlds(Vec<EmbeddedGraph>),
}

impl CheckArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let choice = self.choices.with_budget(self.max_states)?;
        use_threads(self.threads)?;
        self.ci.check_places()?;
        if self.add {
            return self.add_shards(out);
        }
        if self.explorer.is_given() {
            return self.check_explorer(out);
        }
        let algorithm = self.algorithm.with(self.mapping_marker()?, choice)?;
        let work = match &self.from {
            Some(path) => self.worlds_by_size(path)?,
            None => self.sweeps()?,
        };
        if let Some(worst) = &self.worst {
            output::check_world_place(worst, work.values().all(Work::is_simple))?;
        }
        if self.estimate.estimate {
            return self.print_estimates(&work, algorithm, out);
        }
        let mut cluster = self.join_cluster(algorithm)?;
        let is_first = cluster.as_ref().is_none_or(ClusterSession::is_first);
        let out = &mut SharedOutput::new(out, cluster.as_ref());
        let start = Instant::now();
        let mut report = CheckReport::new(out, self.json, AlgorithmInfo::of(algorithm), choice);
        let mut worst: Option<WorstStart> = None;
        let mut cases = Vec::new();
        let mut sizes = work.into_iter();
        let mut is_done = true;
        for (edges, work) in sizes.by_ref() {
            let (tally, moves_made) =
                self.check(edges, &work, (algorithm, choice), cluster.as_mut())?;
            let line = report.line(&self.result(edges, &tally, moves_made));
            cases.push(line.ci_case());
            report.size(line)?;
            if let Some(cluster) = &mut cluster {
                report.threads(cluster, &counted(edges, "edge"))?;
            }
            let (failed, interrupted) = (tally.failed() > 0, tally.interrupted);
            keep_worse(&mut worst, tally.worst);
            is_done = !interrupted;
            if interrupted || (failed && !self.keep_going) {
                break;
            }
        }
        let outcome = report.verdict(Some(start.elapsed()))?;
        if let Some(cluster) = cluster.filter(|_| is_done) {
            cluster.close();
        }
        if !is_first {
            return Ok(outcome);
        }
        if outcome == Outcome::Violated {
            let (tally, subject) = (Tally::default(), AlgorithmInfo::of(algorithm));
            let name = |(edges, _)| {
                let result = self.result(edges, &tally, None);
                SizeLine::new(&result, subject, RunChoices::Default).name()
            };
            self.add_not_checked(&mut cases, sizes.map(name));
        }
        self.ci.write("check", &cases)?;
        if let Some(path) = &self.worst {
            write_worst(path, worst)?;
        }
        Ok(outcome)
    }

    /// Connects to the other processes, if there are others.
    fn join_cluster(
        &self,
        algorithm: MappingAlgorithm,
    ) -> Result<Option<ClusterSession>, CliError> {
        let sizes = self.edges.iter();
        let settings = [
            ("the command", "check".to_owned()),
            ("the class", self.class().name().to_owned()),
            ("the number of edges", format!("{sizes:?}")),
            ("the marker", algorithm.marker().name().to_owned()),
            ("the algorithm", algorithm.info().title.to_owned()),
            ("--keep-going", self.keep_going.to_string()),
        ];
        let end = if self.journal.is_some() { LostEnd::Journal } else { LostEnd::Nothing };
        self.cluster.connect(&settings, end)
    }

    /// Adds the sizes after the last one, by their names, for CI systems.
    fn add_not_checked(&self, cases: &mut Vec<CiCase>, names: impl Iterator<Item = String>) {
        let after = cases.last().map(|case| case.name.clone()).unwrap_or_default();
        let file = self.from.as_deref().map(Path::to_owned);
        let checked = cases.len();
        cases.extend(names.map(|name| CiCase::not_checked(name, &after, file.clone())));
        if cases.len() > checked {
            remark!("worlds with more edges are not checked; --keep-going checks them");
        }
    }

    fn result<'t>(
        &'t self,
        edges: usize,
        tally: &'t Tally,
        moves_made: Option<u64>,
    ) -> SizeResult<'t> {
        let (class, from, shard) = (self.class(), self.from.as_deref(), self.shard);
        SizeResult { edges, class, from, shard, tally, moves_made }
    }

    /// Checks the starts with a number of edges. Returns the moves that were made, if runs shared some.
    fn check(
        &self,
        edges: usize,
        work: &Work,
        (algorithm, choices): (MappingAlgorithm, RunChoices),
        cluster: Option<&mut ClusterSession>,
    ) -> Result<(Tally, Option<u64>), CliError> {
        let progress = Progress::new(&counted(edges, "edge"), "starts")?;
        let is_first = cluster.as_deref().is_none_or(ClusterSession::is_first);
        let journal = match (&self.journal, work) {
            (Some(folder), Work::Lazy(sweep)) if is_first => {
                let header = self.journal_header(edges, sweep, algorithm);
                Some(CheckJournal::open(folder, &header)?)
            }
            _ => None,
        };
        if let Some(before @ 1..) = journal.as_ref().map(CheckJournal::finished_before) {
            remark!(
                "{}: {} of the work finished before",
                counted(edges, "edge"),
                counted(before, "unit")
            );
        }
        let (units, watched): (&dyn FinishedUnits, _) = match &journal {
            Some(journal) => (journal, Some(journal.watch(&progress))),
            None => (&(), None),
        };
        let watch: &dyn Watch = watched.as_ref().map_or(&progress, |watched| watched);
        let checked = match (work, cluster) {
            (Work::Lazy(sweep), cluster) => {
                let tally = match cluster {
                    Some(cluster) => cluster.check(algorithm, sweep, units, watch)?,
                    None => algorithm.lazy_sweep(sweep, units, watch),
                };
                let moves_made = tally.moves_made;
                (tally, Some(moves_made))
            }
            (Work::Worlds(graphs), _) => (algorithm.check_worlds(graphs, choices, &progress), None),
            (Work::Check(sweep), _) => (algorithm.sweep(sweep, choices, &progress), None),
        };
        progress.finish();
        if let Some(journal) = journal {
            journal.close()?;
        }
        Ok(checked)
    }

    fn journal_header(
        &self,
        edges: usize,
        sweep: &SharedPrefixCheck,
        algorithm: MappingAlgorithm,
    ) -> JournalHeader {
        JournalHeader {
            journal: JournalHeader::FORMAT,
            version: version().to_owned(),
            class: self.class().name().to_owned(),
            edges,
            marker: algorithm.marker().name().to_owned(),
            algorithm: algorithm.info().title.to_owned(),
            shard: self.shard.to_string(),
            units: algorithm.unit_count(sweep),
        }
    }

    /// Prints what the checks will take.
    fn print_estimates(
        &self,
        work: &BTreeMap<usize, Work>,
        algorithm: MappingAlgorithm,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        let mut outcome = Outcome::Holds;
        for (&edges, work) in work {
            let Work::Lazy(sweep) = work else {
                return Err(needs_default_choices("--estimate"));
            };
            let progress = Progress::new(&counted(edges, "edge"), "starts")?;
            let printed =
                self.estimate.print((edges, sweep), algorithm, self.json, &progress, out)?;
            progress.finish();
            if printed == Outcome::Incomplete {
                outcome = Outcome::Incomplete;
            }
        }
        Ok(outcome)
    }

    fn class(&self) -> Class {
        let usual = if self.marker.is_movable() { Class::Simple } else { Class::Multigraph };
        self.class.unwrap_or(usual)
    }

    /// The marker of an algorithm.
    fn mapping_marker(&self) -> Result<MappingMarker, CliError> {
        self.marker.name().parse().map_err(|cause| CliError::at("--marker", cause))
    }

    /// A sweep for each number of edges.
    fn sweeps(&self) -> Result<BTreeMap<usize, Work>, CliError> {
        let class = self.class();
        if self.marker.is_movable() && !class.is_simple() {
            return Err(CliError::at("--class", movable_not_sufficient(format!("class {class}"))));
        }
        let sweep = |edges| {
            let work = match self.choices {
                ChoicesOption::Default => SharedPrefixCheck::new(class, edges, self.shard)
                    .map(|lazy| Work::Lazy(Box::new(lazy))),
                ChoicesOption::All => Check::new(class, edges, self.shard).map(Work::Check),
            };
            Ok((edges, work.map_err(|error| CliError::at("--edges", error))?))
        };
        self.edges.iter().map(sweep).collect()
    }

    /// The worlds of a file, by their number of edges.
    fn worlds_by_size(&self, path: &Path) -> Result<BTreeMap<usize, Work>, CliError> {
        let graphs = input::read_graphs(path)?;
        self.mapping_marker()?.check_worlds(path, &graphs)?;
        let mut sizes: BTreeMap<usize, Vec<EmbeddedGraph>> = BTreeMap::new();
        for graph in graphs {
            sizes.entry(graph.edge_count()).or_default().push(graph);
        }
        Ok(sizes.into_iter().map(|(edges, graphs)| (edges, Work::Worlds(graphs))).collect())
    }
}

impl Work {
    /// Whether no world has a loop or parallel edges.
    fn is_simple(&self) -> bool {
        match self {
            Self::Lazy(sweep) => sweep.class().is_simple(),
            Self::Check(sweep) => sweep.class().is_simple(),
            Self::Worlds(graphs) => graphs.iter().all(EmbeddedGraph::is_simple),
        }
    }
}

/// The error for work whose runs cannot share their beginnings.
fn needs_default_choices(option: &str) -> CliError {
    CliError::at(option, "this needs --choices default")
}

fn keep_worse(worst: &mut Option<WorstStart>, other: Option<WorstStart>) {
    let moves = |start: &Option<WorstStart>| start.as_ref().map(|start| start.moves);
    if moves(&other) > moves(worst) {
        *worst = other;
    }
}

fn write_worst(path: &Path, worst: Option<WorstStart>) -> Result<(), CliError> {
    let Some(WorstStart { graph, facing, moves }) = worst else {
        remark!("{} is not written: no start was mapped", path.display());
        return Ok(());
    };
    let about = format!("The start that took the most moves in a check: {moves}");
    output::write_world(path, &NamedWorld::discovered("worst", &about, &graph, facing))
}
