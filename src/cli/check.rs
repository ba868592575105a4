//! `toposlam check`: an algorithm runs on every start of every world up to a size.

mod add;
mod estimate;
mod explorer_sweep;
mod explorer_tally;
mod failed_starts;
mod journal;
mod line;
mod map_proofs;
mod report;

use std::{
    collections::BTreeMap,
    io::Write,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::Instant,
};

use toposlam_model::{
    aid::AidKind,
    check::{Check, FinishedUnits, Shard, SharedPrefixCheck, Tally, WorstStart},
    embedded_graph::{Dart, EmbeddedGraph},
    enumerate::{Class, Each, Enumeration, Watch},
    format::named_world::NamedWorld,
    mapping::MappingAlgorithm,
};

use super::{
    CliError, Outcome, RunChoices,
    ci_report::{CiCase, CiOptions},
    cluster::{ClusterOptions, ClusterSession, SharedOutput},
    edge_range::EdgeRange,
    exit_codes::help_end,
    explorer::{ExplorerCommand, ExplorerOptions},
    input,
    mapping_marker::{
        algorithm_for, check_seen, check_worlds, is_directional, marker_kind, needs_simple,
        not_sufficient,
    },
    method_options::algorithms,
    output,
    progress::Progress,
    run_choices,
    text::counted,
    thread_option::ThreadOption,
    version::version,
    write_world_or_picture,
};
use crate::picture::WorldPicture;
use estimate::EstimateOptions;
use explorer_sweep::ExplorerSweep;
use explorer_tally::ExplorerTally;
use failed_starts::FailedStarts;
use journal::{CheckJournal, JournalHeader};
use line::{FailedRun, FailureLine, SizeLine};
use map_proofs::MapProofs;
use report::CheckReport;

/// Run Algorithm 1 on every start of every world up to a size, and check every map
///
/// For each start, a bijection proves that the map is isomorphic to the world, the robot is where it
/// believes it is, and the number of moves is at most m n + 2 m^2 (n - 1), for m edges and n vertices.
///
/// With --aid KIND, the explorer of another marking aid is checked instead, with its own bound: of markers that the robot
/// carries, a string, or other robots. Undirected markers, and robots without a front, need worlds without loops and
/// parallel edges.
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
  toposlam check --aid movable                a marker that the robot carries
  toposlam check --aid string --edges 6       a string as long as it takes
  toposlam check --algorithm folding          the folding explorer
  toposlam check --explorer ./mine --edges 5  your own program
  toposlam check --explorer ./mine --failed run.html
                                              the run on the first failed start
  toposlam check --explorer ./mine --failed failed --failed-first
                                              those that failed before, then all
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
#[expect(clippy::struct_excessive_bools, reason = "they are options")]
#[command(mut_arg("explorer", |explorer| explorer.conflicts_with_all(NOT_FOR_EXPLORERS)))]
#[command(mut_arg("hosts", |hosts| hosts.conflicts_with_all(NOT_SHARED)))]
#[command(mut_arg("process", |process| process.conflicts_with_all(NOT_SHARED)))]
pub(super) struct CheckArguments {
    /// Number of edges, as in 6, or a range, as in 1..=6
    #[arg(long, default_value = "1..=6", value_name = "SIZES", allow_hyphen_values = true)]
    edges: EdgeRange,

    /// Class of worlds: multigraph, simple, corridor or planar [default: multigraph, or simple with
    /// an aid that needs it]
    #[arg(long)]
    class: Option<Class>,

    /// The robot's marking aid: directional (Algorithm 1), or one that moves, as movable, string or team-2; any
    /// kind with --explorer
    #[arg(
        long,
        visible_alias = "aid",
        default_value = "directional",
        value_name = "KIND",
        value_parser = marker_kind
    )]
    marker: AidKind,

    /// The algorithm that maps with the directional marker: algorithm1 or folding
    #[arg(long, default_value = "algorithm1", hide_possible_values = true, value_parser = algorithms())]
    algorithm: MappingAlgorithm,

    /// Runs from each start: default, or all that the open choices of Algorithm 1 allow; with all=N, skip a
    /// start with more than N states, between rounds (line 4) and within (line 8), instead of 1000000
    #[arg(long, default_value = "default", value_parser = run_choices)]
    choices: RunChoices,

    /// Check one of N disjoint shares of the starts, as in 2/4; --add adds up the results of --json
    #[arg(long, default_value = "1/1", value_name = "I/N", allow_hyphen_values = true)]
    shard: Shard,

    /// Check the worlds in a file (world file, planar_code or edge_code) instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["edges", "class", "shard"])]
    from: Option<PathBuf>,

    /// Check one start of the world in the file
    #[arg(long, value_name = "VERTEX:FACING", requires = "from")]
    start: Option<String>,

    /// Write the start that took the most moves: .toml, .json, .dot, or plantri's .ec or .pc
    #[arg(long, value_name = "FILE")]
    worst: Option<PathBuf>,

    /// Write the first start that was not mapped: a world file, or a picture (.svg, .png). With
    /// --explorer also a page (.html) of the run, or with a name without ending a folder of the first 100
    /// of each size
    #[arg(long, value_name = "FILE")]
    failed: Option<PathBuf>,

    /// Check the starts in the folder of --failed first, and remove the files of those that are mapped. If
    /// one is still not mapped, no others are checked
    #[arg(long, requires = "failed", requires = "explorer", conflicts_with = "keep_going")]
    failed_first: bool,

    #[command(flatten)]
    pub(super) threads: ThreadOption,

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

    /// Write the proof of each map, one after the other, which a small verified checker confirms; --json has the SHA-256 of
    /// those of each size
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "choices", "shard", "journal", "hosts"])]
    proof: Option<PathBuf>,

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
const NOT_ADDED: [&str; 17] = [
    "edges",
    "class",
    "marker",
    "algorithm",
    "choices",
    "shard",
    "from",
    "start",
    "worst",
    "failed",
    "threads",
    "journal",
    "estimate",
    "proof",
    "keep_going",
    "explorer",
    "hosts",
];

/// Options of a check that explorers do not have.
const NOT_FOR_EXPLORERS: [&str; 6] =
    ["algorithm", "choices", "shard", "estimate", "journal", "proof"];

/// Options of a check that machines cannot share. Clap does not ask for `--hosts` where it cannot be given, so
/// `--process` excludes them, too.
const NOT_SHARED: [&str; 5] = ["shard", "from", "explorer", "estimate", "choices"];

/// What maps the worlds.
enum Mapper<'a> {
    Algorithm(MappingAlgorithm, RunChoices),
    Explorer(ExplorerSweep<'a>),
}

/// What is checked for one number of edges.
enum Work {
    /// Runs share their beginnings.
    Shared(Box<SharedPrefixCheck>),
    /// All choices.
    All(Check),
    Enumerated(Enumeration),
    /// With one start of each, or all.
    Listed(Vec<(EmbeddedGraph, Option<Dart>)>),
}

/// What the checks of some sizes found.
#[derive(Default)]
struct Checked {
    worst: Option<WorstStart>,
    /// The first start that was mapped wrongly, and the first on which a limit was reached.
    first_unmapped: [Option<FailureLine>; 2],
    /// Those on which an explorer failed or reached a limit.
    unmapped: Vec<NamedWorld>,
    cases: Vec<CiCase>,
    interrupted: bool,
    /// Whether starts are left out.
    is_cut: bool,
    has_unmapped: bool,
}

/// What the check of one size found.
struct CheckedSize {
    line: SizeLine,
    worst: Option<WorstStart>,
    unmapped: Vec<NamedWorld>,
}

impl CheckArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ci.check_places()?;
        if self.add {
            return self.add_shards(out);
        }
        let folder = self.failed_folder()?;
        let mapper = if let Some(command) = &self.explorer.explorer {
            let most_kept = folder.as_ref().map_or(0, |_| failed_starts::MOST);
            let (limits, marker) = (self.explorer.limits(), self.marker);
            Mapper::Explorer(ExplorerSweep { command, limits, marker, most_kept })
        } else {
            let algorithm = algorithm_for(self.algorithm, self.marker)?;
            Mapper::Algorithm(algorithm, self.choices)
        };
        let work = match &self.from {
            Some(path) => self.listed(path)?,
            None => {
                self.edges.iter().map(|edges| self.enumerated(edges)).collect::<Result<_, _>>()?
            }
        };
        output::check_place(&self.proof, &["proof"])?;
        if self.proof.is_some() && !is_directional(self.marker) {
            return Err(CliError::at("--proof", "needs --marker directional"));
        }
        output::check_world_place(&self.worst, work.values().all(Work::is_simple))?;
        match mapper {
            Mapper::Algorithm(algorithm, _) if self.estimate.estimate.is_some() => {
                self.print_estimates(&work, algorithm, out)
            }
            mapper => self.check(&mapper, work, folder, out),
        }
    }

    /// The folder of `--failed`, if it is one.
    ///
    /// # Errors
    /// Returns an error if nothing can be written there, or if a start in it cannot be read.
    fn failed_folder(&self) -> Result<Option<FailedStarts>, CliError> {
        let Some(path) = &self.failed else { return Ok(None) };
        let has_explorer = self.explorer.explorer.is_some();
        if has_explorer && FailedStarts::is_folder(path) {
            return FailedStarts::open(path, self.failed_first).map(Some);
        }
        if self.failed_first {
            let cause = "a file has one start; the starts of a folder, as in --failed failed, can be checked first";
            return Err(CliError::at("--failed", cause));
        }
        output::check_place(path, &["toml", "json", "dot", "svg", "png", "html"])?;
        if path.extension().is_some_and(|ending| ending == "html") && !has_explorer {
            let cause = "a page shows the run of a program; it needs --explorer";
            return Err(CliError::at("--failed", cause));
        }
        Ok(None)
    }

    /// Checks each size until a map is wrong.
    fn check(
        &self,
        mapper: &Mapper,
        work: BTreeMap<usize, Work>,
        folder: Option<FailedStarts>,
        out: &mut dyn Write,
    ) -> Result<Outcome, CliError> {
        if let (Mapper::Explorer(sweep), Some(folder)) = (mapper, &folder)
            && let Some(outcome) = self.check_failed_first(sweep, folder, out)?
        {
            return Ok(outcome);
        }
        let mut cluster = self.join_cluster()?;
        let is_first = cluster.as_ref().is_none_or(|cluster| cluster.is_first());
        let out = &mut SharedOutput::new(out, is_first);
        let start = Instant::now();
        let order = match mapper {
            Mapper::Algorithm(algorithm, _) => Some(algorithm.info().order),
            Mapper::Explorer(_) => None,
        };
        let mut report = CheckReport::new(out, self.json, order);
        let mut sizes = work.into_iter().map(|(edges, work)| (self.line(edges), work));
        let mut checked = self.check_sizes(mapper, &mut sizes, &mut cluster, &mut report)?;
        let outcome = report.verdict(Some(start.elapsed()))?;
        if let Some(cluster) = cluster.filter(|_| !checked.interrupted) {
            cluster.close();
        }
        if !is_first {
            return Ok(outcome);
        }
        if checked.has_unmapped {
            let names: Vec<_> = sizes.map(|(line, _)| line.name()).collect();
            if !names.is_empty() {
                remark!("worlds with more edges are not checked; --keep-going checks them");
            }
            CiCase::add_not_checked(&mut checked.cases, names.into_iter(), self.from.as_deref());
        }
        self.write_outputs(checked, folder)?;
        Ok(outcome)
    }

    /// Checks the starts that were not mapped before. Returns the outcome if one of them still is not.
    fn check_failed_first(
        &self,
        sweep: &ExplorerSweep,
        folder: &FailedStarts,
        out: &mut dyn Write,
    ) -> Result<Option<Outcome>, CliError> {
        let mapper = Mapper::Explorer(ExplorerSweep { most_kept: usize::MAX, ..*sweep });
        let start = Instant::now();
        let mut rows = Vec::new();
        let mut report = CheckReport::new(&mut rows, self.json, None);
        let mut all = Checked::default();
        for (edges, work) in folder.work() {
            let from = Some(folder.name());
            let line = SizeLine { from, class: None, ..self.line(edges) };
            let mut size = std::iter::once((line, work));
            let checked = self.check_sizes(&mapper, &mut size, &mut None, &mut report)?;
            if !checked.is_cut {
                folder.keep_only(edges, &checked.unmapped)?;
            }
            all.cases.extend(checked.cases);
            all.has_unmapped |= checked.has_unmapped;
            if checked.interrupted {
                all.interrupted = true;
                break;
            }
        }
        if !all.has_unmapped && !all.interrupted {
            if folder.count() > 0 {
                let starts = counted(folder.count(), "start");
                remark!("{}: {starts} that failed before, now mapped", folder.name());
            }
            return Ok(None);
        }
        let outcome = report.verdict(Some(start.elapsed()))?;
        out.write_all(&rows)?;
        remark!("other starts are not checked: not all that failed before are mapped");
        let explorer = self.explorer.explorer.as_ref().and_then(ExplorerCommand::file);
        self.ci.write("check", &all.cases, explorer)?;
        Ok(Some(outcome))
    }

    fn check_sizes(
        &self,
        mapper: &Mapper,
        sizes: &mut dyn Iterator<Item = (SizeLine, Work)>,
        cluster: &mut Option<Box<dyn ClusterSession>>,
        report: &mut CheckReport,
    ) -> Result<Checked, CliError> {
        let mut checked = Checked::default();
        let mut proofs = self.proof.as_deref().map(MapProofs::create).transpose()?;
        for (line, work) in sizes {
            let edges = line.edges;
            let begun = Instant::now();
            let CheckedSize { mut line, worst, unmapped } =
                self.check_size(line, &work, mapper, cluster.as_mut())?;
            let proved = self.prove(&mut proofs, &line, mapper);
            line.proofs_sha256 = proved.as_ref().ok().cloned().flatten();
            checked.interrupted = line.interrupted;
            checked.is_cut |= line.interrupted || line.stopped == Some(true);
            checked.has_unmapped |= line.failed > 0 || line.unknown.unwrap_or_default() > 0;
            checked.unmapped.extend(unmapped);
            checked.cases.push(line.ci_case().begun(begun));
            for (first, found) in
                checked.first_unmapped.iter_mut().zip([&line.failure, &line.limit])
            {
                *first = first.take().or_else(|| found.clone());
            }
            report.size(line)?;
            proved?;
            if let Some(cluster) = cluster {
                report.threads(cluster, &counted(edges, "edge"))?;
            }
            let moves = |start: &Option<WorstStart>| start.as_ref().map(|start| start.moves);
            if moves(&worst) > moves(&checked.worst) {
                checked.worst = worst;
            }
            if checked.interrupted || (checked.has_unmapped && !self.keep_going) {
                break;
            }
        }
        proofs.map_or(Ok(()), MapProofs::close)?;
        Ok(checked)
    }

    /// Adds the proofs of a size whose starts are all mapped right, and returns their digest.
    fn prove(
        &self,
        proofs: &mut Option<MapProofs>,
        line: &SizeLine,
        mapper: &Mapper,
    ) -> Result<Option<String>, CliError> {
        let (Some(proofs), Mapper::Algorithm(algorithm, _)) = (proofs, mapper) else {
            return Ok(None);
        };
        if !line.holds {
            remark!("no proofs of {} are written", line.name());
            return Ok(None);
        }
        let progress = Progress::new(&counted(line.edges, "edge"), "proofs")?;
        let digest = proofs.add_size((self.class(), line.edges), *algorithm, &progress);
        progress.finish();
        digest.map(Some)
    }

    /// Writes the files that are asked for.
    fn write_outputs(
        &self,
        checked: Checked,
        folder: Option<FailedStarts>,
    ) -> Result<(), CliError> {
        let explorer = self.explorer.explorer.as_ref().and_then(ExplorerCommand::file);
        let failed = self.failed.as_deref().filter(|_| folder.is_none() && checked.has_unmapped);
        self.ci.write("check", &checked.cases, explorer.or(failed))?;
        if let Some(path) = &self.worst {
            write_worst(path, checked.worst)?;
        }
        let Some(path) = &self.failed else { return Ok(()) };
        if let Some(folder) = folder {
            return folder.write(&checked.unmapped);
        }
        if let Some(failure) = checked.first_unmapped.iter().flatten().next() {
            return self.write_failed(path, failure);
        }
        remark!("{} is not written: each start was mapped", path.display());
        Ok(())
    }

    /// Writes the start of a failure as a world file, or the run as a picture or a page.
    fn write_failed(&self, path: &Path, failure: &FailureLine) -> Result<(), CliError> {
        let Some(world) = failure.named_world() else { return Ok(()) };
        let is_file = |ending| ["toml", "json", "dot"].iter().any(|known| ending == *known);
        match &failure.run {
            FailedRun::Explorer(run) if !path.extension().is_some_and(is_file) => {
                run.write(path, &world, self.marker)
            }
            _ => write_world_or_picture(path, &world, &WorldPicture::from(&world)),
        }
    }

    /// Connects to the other processes, if there are others.
    fn join_cluster(&self) -> Result<Option<Box<dyn ClusterSession>>, CliError> {
        let algorithm = algorithm_for(self.algorithm, self.marker);
        let settings = [
            ("the command", "check".to_owned()),
            ("the class", self.class().name().to_owned()),
            ("the number of edges", format!("{:?}", self.edges.iter())),
            ("the marker", self.marker.name().to_owned()),
            ("the algorithm", algorithm.map_or("", |algorithm| algorithm.info().title).to_owned()),
            ("--keep-going", self.keep_going.to_string()),
        ];
        let journal = "; with the same --journal, it goes on from there";
        self.cluster.connect(&settings, if self.journal.is_some() { journal } else { "" })
    }

    /// Checks the starts with a number of edges.
    fn check_size(
        &self,
        line: SizeLine,
        work: &Work,
        mapper: &Mapper,
        cluster: Option<&mut Box<dyn ClusterSession>>,
    ) -> Result<CheckedSize, CliError> {
        let name = counted(line.edges, "edge");
        let (algorithm, choices) = match mapper {
            Mapper::Algorithm(algorithm, choices) => (*algorithm, *choices),
            Mapper::Explorer(sweep) => {
                let progress = Progress::endless(&name, "starts")?;
                let tally = sweep.run(work, &progress);
                progress.finish();
                let tally = tally?;
                let line = tally.line(line, &sweep.command.text, sweep.marker);
                let ExplorerTally { counts, unmapped, .. } = tally;
                return Ok(CheckedSize { line, worst: counts.worst, unmapped });
            }
        };
        let progress = Progress::new(&name, "starts")?;
        let (tally, moves_made) = match work {
            Work::Shared(sweep) => {
                let tally = self.check_shared(line.edges, sweep, algorithm, cluster, &progress)?;
                let moves_made = tally.moves_made;
                (tally, Some(moves_made))
            }
            Work::Listed(worlds) => (algorithm.check_worlds(worlds, choices, &progress), None),
            Work::All(sweep) => (algorithm.sweep(sweep, choices, &progress), None),
            // It is for explorers.
            Work::Enumerated(_) => (Tally::default(), None),
        };
        progress.finish();
        let line = line.of_algorithm((algorithm, choices), &tally, moves_made);
        Ok(CheckedSize { line, worst: tally.worst, unmapped: Vec::new() })
    }

    /// Checks starts whose runs share their beginnings, with a journal if one is asked for.
    fn check_shared(
        &self,
        edges: usize,
        sweep: &SharedPrefixCheck,
        algorithm: MappingAlgorithm,
        cluster: Option<&mut Box<dyn ClusterSession>>,
        progress: &Progress,
    ) -> Result<Tally, CliError> {
        let is_first = cluster.as_ref().is_none_or(|cluster| cluster.is_first());
        let journal = match self.journal.as_ref().filter(|_| is_first) {
            Some(folder) => {
                let header = JournalHeader {
                    journal: JournalHeader::FORMAT,
                    version: version().to_owned(),
                    class: self.class().name().to_owned(),
                    edges,
                    marker: algorithm.aid().name().to_owned(),
                    algorithm: algorithm.info().title.to_owned(),
                    shard: self.shard.to_string(),
                    // A count that stops early would be wrong.
                    units: algorithm.pieces(sweep, &()).unit_count(),
                };
                Some(CheckJournal::open(folder, &header)?)
            }
            None => None,
        };
        if let Some(before @ 1..) = journal.as_ref().map(CheckJournal::finished_before) {
            let (size, units) = (counted(edges, "edge"), counted(before, "unit"));
            remark!("{size}: {units} of the work finished before");
        }
        let watched = journal.as_ref().map(|journal| journal.watch(progress));
        let units: &dyn FinishedUnits = journal.as_ref().map_or(&(), |journal| journal);
        let watch: &dyn Watch = watched.as_ref().map_or(progress, |watched| watched);
        let tally = match cluster {
            Some(cluster) => cluster.check(algorithm, sweep, units, watch)?,
            None => algorithm.lazy_sweep(sweep, units, watch),
        };
        journal.map_or(Ok(()), CheckJournal::close)?;
        Ok(tally)
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
            let Work::Shared(sweep) = work else { continue };
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
        let usual = if needs_simple(self.marker) { Class::Simple } else { Class::Multigraph };
        self.class.unwrap_or(usual)
    }

    /// The line of a size without counts.
    fn line(&self, edges: usize) -> SizeLine {
        let marker = self.marker;
        SizeLine {
            edges,
            class: self.from.is_none().then(|| self.class().name().to_owned()),
            from: self.from.as_ref().map(|path| path.display().to_string()),
            marker: marker.name().to_owned(),
            certificate_total: is_directional(marker).then_some(0),
            shard: (self.shard != Shard::WHOLE).then(|| self.shard.to_string()),
            version: (self.shard != Shard::WHOLE).then(|| version().to_owned()),
            ..SizeLine::default()
        }
    }

    /// The worlds with a number of edges.
    fn enumerated(&self, edges: usize) -> Result<(usize, Work), CliError> {
        let class = self.class();
        let work = match self.choices {
            _ if self.explorer.explorer.is_some() => {
                Enumeration::new(Each::World, class, edges).map(Work::Enumerated)
            }
            _ if needs_simple(self.marker) && !class.is_simple() => {
                let cause = not_sufficient(self.marker, format!("class {class}"));
                return Err(CliError::at("--class", cause));
            }
            RunChoices::Default => SharedPrefixCheck::new(class, edges, self.shard)
                .map(|sweep| Work::Shared(Box::new(sweep))),
            RunChoices::All { .. } => Check::new(class, edges, self.shard).map(Work::All),
        };
        Ok((edges, work.map_err(|error| CliError::at("--edges", error))?))
    }

    /// The worlds of a file, by their number of edges.
    fn listed(&self, path: &Path) -> Result<BTreeMap<usize, Work>, CliError> {
        let (graphs, start) = match &self.start {
            None => (input::read_graphs(path)?, None),
            Some(start) => {
                let world = input::read_world(path)?;
                let start = input::start_of(&world, Some(start))?;
                (vec![world.graph], Some(start))
            }
        };
        if self.explorer.explorer.is_none() {
            check_worlds(self.marker, path, &graphs)?;
        } else {
            check_seen(self.marker, path, &graphs)?;
        }
        let mut sizes: BTreeMap<usize, Vec<_>> = BTreeMap::new();
        for graph in graphs {
            sizes.entry(graph.edge_count()).or_default().push((graph, start));
        }
        Ok(sizes.into_iter().map(|(edges, worlds)| (edges, Work::Listed(worlds))).collect())
    }
}

impl Work {
    /// Whether no world has a loop or parallel edges.
    fn is_simple(&self) -> bool {
        match self {
            Self::Shared(sweep) => sweep.class().is_simple(),
            Self::All(sweep) => sweep.class().is_simple(),
            Self::Enumerated(worlds) => worlds.class().is_simple(),
            Self::Listed(worlds) => worlds.iter().all(|(graph, _)| graph.is_simple()),
        }
    }

    /// Visits the worlds for an explorer, each with the only start that is checked, if not all are.
    fn for_each_world(
        &self,
        visit: &mut dyn FnMut(&EmbeddedGraph, Option<Dart>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match self {
            Self::Enumerated(worlds) => worlds.for_each(&mut |found| visit(found.graph, None)),
            Self::Listed(worlds) => {
                worlds.iter().try_for_each(|(graph, start)| visit(graph, *start))
            }
            // They are for algorithms.
            Self::Shared(_) | Self::All(_) => ControlFlow::Continue(()),
        }
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
