//! `toposlam merge`: adds up the shards of a check.

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Deserialize;
use toposlam_model::check::{MappingAlgorithm, Shard};

use super::{
    CliError, Outcome, RunChoices,
    check::{AlgorithmInfo, CheckReport, SizeLine},
    exit_codes::help_end,
    input,
};

/// Add up the results of the shards of a check
///
/// Reads the lines that `check --shard I/N --json` printed, and prints the result of the whole check. Each
/// shard of each size must be there exactly once, and all must be of the same version, class and algorithm.
/// Otherwise the error lists what is missing, double or different.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam check --edges 6 --shard 1/2 --json > one.jsonl
  toposlam check --edges 6 --shard 2/2 --json > two.jsonl
  toposlam merge one.jsonl two.jsonl",
    &[
        (0, "every map is right"),
        (1, "a map is wrong"),
        (2, "bad usage or input, also a shard that is missing or there twice"),
        (3, "there is nothing to check, or a limit was reached"),
    ],
))]
pub(super) struct MergeArguments {
    /// Files with the lines of shards
    #[arg(value_name = "FILES", required = true)]
    files: Vec<PathBuf>,

    /// Print one JSON object for each number of edges
    #[arg(long)]
    json: bool,
}

/// The beginning of a line.
#[derive(Deserialize)]
struct LineHead {
    schema: u32,
    kind: String,
}

/// A shard, and where its line is.
struct FoundShard {
    place: String,
    shard: Shard,
    line: SizeLine,
}

/// What all shards have in common, in words.
fn subject(line: &SizeLine) -> [(&'static str, String); 5] {
    let text = |value: &Option<String>| value.clone().unwrap_or_default();
    let choices = match line.max_states {
        None => "default".to_owned(),
        Some(budget) => format!("all with at most {budget} states"),
    };
    [
        ("version", text(&line.version)),
        ("class", text(&line.class)),
        ("marker", line.marker.clone()),
        ("algorithm", line.algorithm.clone()),
        ("choices", choices),
    ]
}

impl MergeArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut shards = Vec::new();
        for file in &self.files {
            read_shards(file, &mut shards)?;
        }
        let Some(first) = shards.first() else {
            return Err(CliError::at("FILES", "there is no line of a shard"));
        };
        let algorithm = algorithm_of(first)?;
        let choice = match first.line.max_states {
            None => RunChoices::Default,
            Some(budget) => RunChoices::All { budget },
        };
        let problems = problems(&shards);
        if !problems.is_empty() {
            return Err(CliError::Input(problems.join("\n")));
        }
        let mut sizes: BTreeMap<usize, SizeLine> = BTreeMap::new();
        shards.sort_by_key(|found| found.shard.index());
        for FoundShard { mut line, .. } in shards {
            (line.shard, line.version) = (None, None);
            match sizes.get_mut(&line.edges) {
                Some(sum) => sum.add(line),
                None => {
                    sizes.insert(line.edges, line);
                }
            }
        }
        let mut report = CheckReport::new(out, self.json, AlgorithmInfo::of(&algorithm), choice);
        for line in sizes.into_values() {
            report.size(line)?;
        }
        report.verdict(None)
    }
}

/// Reads the lines of a file.
fn read_shards(path: &Path, shards: &mut Vec<FoundShard>) -> Result<(), CliError> {
    let bytes = input::read(path)?;
    for (number, text) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        let place = format!("{}: line {number}", path.display());
        let at = |cause: String| CliError::at(&place, cause);
        let head: LineHead = serde_json::from_slice(text)
            .map_err(|error| at(format!("this is no line of `check --json`: {error}")))?;
        if (head.schema, head.kind.as_str()) != (1, "size") {
            let LineHead { schema, kind } = head;
            return Err(at(format!("this is a line `{kind}` of schema {schema}, not `size` of 1")));
        }
        let line: SizeLine = serde_json::from_slice(text).map_err(|error| at(error.to_string()))?;
        let Some(shard) = &line.shard else {
            return Err(at("this is the result of a whole check, not of a shard".to_owned()));
        };
        let shard = shard.parse().map_err(|error| at(format!("{error}")))?;
        shards.push(FoundShard { place, shard, line });
    }
    Ok(())
}

/// The algorithm of a shard.
fn algorithm_of(found: &FoundShard) -> Result<MappingAlgorithm, CliError> {
    let known =
        [MappingAlgorithm::Algorithm1, MappingAlgorithm::MovableMarker, MappingAlgorithm::Folding];
    let FoundShard { place, line, .. } = found;
    known
        .into_iter()
        .find(|known| known.name() == line.algorithm && known.marker().name() == line.marker)
        .ok_or_else(|| {
            let SizeLine { algorithm, marker, .. } = line;
            CliError::at(place, format!("no algorithm is `{algorithm}` with marker `{marker}`"))
        })
}

/// What is different, missing, double or interrupted.
fn problems(shards: &[FoundShard]) -> Vec<String> {
    let mut problems = Vec::new();
    let mut sizes: BTreeMap<usize, Vec<&FoundShard>> = BTreeMap::new();
    for found in shards {
        let FoundShard { place, line, .. } = found;
        for ((name, is), (_, first)) in subject(line).into_iter().zip(subject(&shards[0].line)) {
            if is != first {
                problems.push(format!("{place}: {name} is {is}, not {first}"));
            }
        }
        if line.interrupted {
            problems.push(format!("{place}: shard {} was interrupted", found.shard));
        }
        sizes.entry(line.edges).or_default().push(found);
    }
    for (edges, found) in sizes {
        let of = found[0].shard.of();
        for other in found.iter().filter(|other| other.shard.of() != of) {
            let FoundShard { place, shard, .. } = other;
            problems.push(format!("{place}: {edges} edges: {shard} is not one of {of} shards"));
        }
        let of_shard = |index| {
            found.iter().filter(move |found| (found.shard.index(), found.shard.of()) == (index, of))
        };
        for index in 1..=of {
            match of_shard(index).count() {
                0 => problems.push(format!("{edges} edges: shard {index}/{of} is missing")),
                1 => {}
                _ => {
                    let places: Vec<_> = of_shard(index).map(|found| &*found.place).collect();
                    let places = places.join(", ");
                    problems.push(format!("{edges} edges: shard {index}/{of} is double: {places}"));
                }
            }
            // A wrong number of shards can be huge.
            if problems.len() > 100 {
                problems.push("...".to_owned());
                return problems;
            }
        }
    }
    problems
}
