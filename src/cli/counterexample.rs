//! `toposlam counterexample`: the smallest worlds that a marker cannot distinguish.

mod atlas;
mod memory;
mod pairs;
mod report;

use std::{io::Write, path::PathBuf, time::Instant};

use clap::ValueEnum;
use toposlam_model::{
    aid::{AIDS, AidKind, FEW_STATES},
    ambiguity::{AmbiguitySearch, Findings, KeptPairs, SearchError, Unfinished},
    enumerate::Class,
};

use super::{
    CliError, Outcome, aid_kinds,
    ci_report::{CiCase, CiOptions},
    cluster::{ClusterOptions, ClusterSession, SharedOutput},
    exit_codes::help_end,
    output,
    progress::Progress,
    text::counted,
    thread_option::ThreadOption,
    verdict_proof::ProofOption,
};
use memory::MemoryLimit;
use pairs::WorldPairs;
use report::SearchReport;

/// Find the smallest worlds that a marker cannot distinguish, for each kind of marker
///
/// The search covers all worlds of the class up to a size, with the marker at every place. Two of them
/// are a pair if no walk distinguishes them. A verified bisimulation confirms every reported pair.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam counterexample                       every marker, simple worlds
  toposlam counterexample --marker undirected --html page.html
                                                one marker, and a page to walk
                                                the two worlds
  toposlam counterexample --class corridor --max-edges 9 --json
  toposlam counterexample --marker directional --expect none
                                                for CI: exit code 1 on a pair
  toposlam counterexample --marker undirected --memory 400MB
                                                sort on disk, in this memory

The smallest pair is the one whose larger world is smallest. A world is ambiguous if it is in a pair.",
    &[
        (0, "the search is done; with --expect none, there is no pair"),
        (1, "--expect none, and a pair was found"),
        (2, "bad usage or input"),
        (3, "interrupted, or the connection to another process is lost"),
    ],
))]
#[command(mut_args(|option| match option.get_id().as_str() {
    // Clap does not ask for `--expect` where it cannot be given.
    "report" => option.requires("expect").conflicts_with("atlas"),
    _ => option,
}))]
pub(super) struct CounterexampleArguments {
    /// Marking aid (repeatable) [default: the fixed markers and movable]
    #[arg(long = "marker", visible_alias = "aid", value_name = "KIND", value_parser = aid_kinds())]
    markers: Vec<AidKind>,

    /// Class of worlds: multigraph, simple, corridor or planar
    #[arg(long, default_value = "simple")]
    class: Class,

    /// Search the worlds with 1 to N edges [default: 6 for multigraph, 8 for simple and planar, 11 for
    /// corridor]
    #[arg(long, value_name = "N")]
    max_edges: Option<usize>,

    /// Report all pairs, not only the smallest
    #[arg(long)]
    all: bool,

    /// Take at most this memory, as in 2GB; what does not fit is sorted in temporary files, in $TMPDIR
    #[arg(long, value_name = "SIZE", conflicts_with_all = ["all", "hosts"])]
    memory: Option<MemoryLimit>,

    /// Write the worlds of the reported pairs into a folder, as world files
    #[arg(short, long, value_name = "DIR")]
    out_dir: Option<PathBuf>,

    /// Write a page on which a person walks the smallest pair; needs one --marker
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    #[command(flatten)]
    proof: ProofOption,

    /// Write the atlas instead: the smallest pair of every marker in every class, as world files,
    /// pictures and a table
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["markers", "class", "all", "out_dir", "html", "proof", "expect", "json", "hosts"],
    )]
    atlas: Option<PathBuf>,

    /// The expected result: none (no pair)
    #[arg(long, hide_possible_values = true)]
    expect: Option<Expectation>,

    /// With --expect none: search with the other markers also after a pair was found
    #[arg(long, requires = "expect")]
    keep_going: bool,

    #[command(flatten)]
    pub(super) threads: ThreadOption,

    /// Print one JSON object for each number of edges, and one for the smallest pair
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    cluster: ClusterOptions,

    #[command(flatten)]
    ci: CiOptions,
}

/// The expected result of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Expectation {
    /// No pair.
    None,
}

impl CounterexampleArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        self.ci.check_places()?;
        if let Some(folder) = &self.atlas {
            return atlas::write(folder, self.max_edges, self.memory);
        }
        let edges = self.max_edges.unwrap_or_else(|| usual_size(self.class));
        // Each marker once, in the order of the list.
        let wanted = |aid: &AidKind| {
            let named = if self.markers.is_empty() { FEW_STATES } else { &self.markers };
            named.contains(aid)
        };
        let search = |marker| {
            let search = AmbiguitySearch::new(self.class, edges, marker);
            Ok((marker, search.map_err(|error| CliError::at("--max-edges", error))?))
        };
        let searches = AIDS.into_iter().filter(wanted).map(search);
        let searches: Vec<(AidKind, _)> = searches.collect::<Result<_, CliError>>()?;
        output::check_place(&self.html, &["html", "htm"])?;
        if self.html.is_some() && searches.len() != 1 {
            let cause = "a page shows one marker; choose it with --marker";
            return Err(CliError::at("--html", cause));
        }
        self.proof.check_place()?;
        let mut cluster = self.join_cluster(searches.iter().map(|(marker, _)| *marker), edges)?;
        let is_first = cluster.as_ref().is_none_or(|cluster| cluster.is_first());
        let folder = self.out_dir.as_ref().filter(|_| is_first);
        if let Some(folder) = folder {
            output::make_folder(folder)?;
        }
        let out = &mut SharedOutput::new(out, is_first);
        let has_page = self.html.is_some();
        let aids = searches.iter().map(|(aid, _)| *aid);
        let mut report = SearchReport::new(out, self.json, self.class, edges, aids, has_page);
        let mut outcome = Outcome::Holds;
        let mut cases = Vec::new();
        // A file with a world of a pair.
        let mut written = None;
        let mut proofs = String::new();
        let mut left = searches.iter();
        for (marker, search) in left.by_ref() {
            let begun = Instant::now();
            let progress = Progress::new(marker.name(), "placed worlds")?;
            let kept = if self.all { KeptPairs::All } else { KeptPairs::Smallest };
            let findings = match &mut cluster {
                None => run_search(search, self.memory, kept, &progress)?,
                Some(cluster) => cluster.search(search, kept, &progress)?,
            };
            progress.finish();
            let findings = match findings {
                Ok(findings) => findings,
                Err(unfinished) => {
                    cases.push(self.ci_case(*marker, edges, Err(&unfinished)).begun(begun));
                    if is_first {
                        self.ci.write("counterexample", &cases, None)?;
                    }
                    return pairs::report_unfinished(&unfinished);
                }
            };
            let found = WorldPairs::new(*marker, self.class, &findings, self.all);
            if let Some(folder) = folder {
                found.write(folder)?;
            }
            if let Some(path) = self.html.as_ref().filter(|_| is_first) {
                found.write_page(path, *marker)?;
            }
            proofs += &self.proofs(&found, *marker);
            let pairs = found.pairs().len();
            let file = folder.zip(found.worlds.first());
            let file = file.map(|(folder, world)| folder.join(format!("{}.toml", world.name)));
            let page = self.html.clone().filter(|_| pairs > 0);
            written = written.or(file).or(page);
            report.marker(*marker, &findings, found)?;
            if let Some(cluster) = &mut cluster {
                report.threads(cluster, *marker)?;
            }
            cases.push(self.ci_case(*marker, edges, Ok(pairs)).begun(begun));
            if self.expect == Some(Expectation::None) && pairs > 0 {
                outcome = Outcome::Violated;
                if !self.keep_going {
                    break;
                }
            }
        }
        let others: Vec<_> = left.map(|(marker, _)| self.case_name(*marker, edges)).collect();
        if !others.is_empty() {
            let count = counted(others.len(), "marker");
            remark!("{count} not searched; --keep-going searches with all markers");
        }
        CiCase::add_not_checked(&mut cases, others.into_iter(), None);
        report.end()?;
        if let Some(cluster) = cluster {
            cluster.close();
        }
        if is_first {
            self.write_proofs(&proofs)?;
            self.ci.write("counterexample", &cases, written.as_deref())?;
        }
        Ok(outcome)
    }

    /// The text of the proofs of some pairs, if it is wanted. If there is none, a remark says why.
    fn proofs(&self, found: &WorldPairs, marker: AidKind) -> String {
        let Some(path) = self.proof.path() else { return String::new() };
        found.proofs(marker).unwrap_or_else(|why| {
            remark!("{}: without the pairs of {}: {why}", path.display(), marker.name());
            String::new()
        })
    }

    fn write_proofs(&self, proofs: &str) -> Result<(), CliError> {
        if proofs.is_empty() {
            self.proof.remark(&"there is no pair with a proof");
            return Ok(());
        }
        self.proof.write_text(proofs)
    }

    /// Connects to the other processes, if there are others.
    fn join_cluster(
        &self,
        markers: impl Iterator<Item = AidKind>,
        edges: usize,
    ) -> Result<Option<Box<dyn ClusterSession>>, CliError> {
        let markers: Vec<_> = markers.map(AidKind::name).collect();
        let settings = [
            ("the command", "counterexample".to_owned()),
            ("the class", self.class.name().to_owned()),
            ("--max-edges", edges.to_string()),
            ("the markers", markers.join(" ")),
            ("--all", self.all.to_string()),
            ("--expect", format!("{:?}", self.expect)),
            ("--keep-going", self.keep_going.to_string()),
        ];
        self.cluster.connect(&settings, "")
    }

    /// The result for a marker, for CI systems.
    fn ci_case(&self, marker: AidKind, edges: usize, pairs: Result<usize, &Unfinished>) -> CiCase {
        let (outcome, message) = match pairs {
            Ok(0) => (Outcome::Holds, "no two worlds are indistinguishable".to_owned()),
            Ok(_) => (Outcome::Violated, "there are worlds that no walk distinguishes".to_owned()),
            Err(unfinished) => (Outcome::Incomplete, unfinished.to_string()),
        };
        CiCase { name: self.case_name(marker, edges), outcome, message, file: None, seconds: None }
    }

    fn case_name(&self, marker: AidKind, edges: usize) -> String {
        format!("{}, class {}, {}", marker.name(), self.class, up_to(edges))
    }
}

/// Searches on this machine, in a memory.
fn run_search(
    search: &AmbiguitySearch,
    memory: Option<MemoryLimit>,
    kept: KeptPairs,
    progress: &Progress,
) -> Result<Result<Findings, Unfinished>, CliError> {
    match search.run_sorted(memory::sorter(memory)?, kept, progress) {
        Ok(findings) => Ok(Ok(findings)),
        Err(SearchError::Sorter(cause)) => Err(CliError::at("--memory", cause)),
        Err(SearchError::Unfinished(unfinished)) => Ok(Err(unfinished)),
    }
}

/// The number of edges up to which a search takes a second or two.
fn usual_size(class: Class) -> usize {
    match class {
        Class::Multigraph => 6,
        Class::Simple | Class::Planar => 8,
        Class::Corridor => 11,
    }
}

/// The sizes that were searched, in words.
fn up_to(edges: usize) -> String {
    if edges == 1 { "1 edge".to_owned() } else { format!("1 to {edges} edges") }
}
