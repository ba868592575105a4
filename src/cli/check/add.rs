//! `toposlam check --add FILE...`: adds up the shards of a check.
//!
//! Each shard of each size must be there exactly once, and all must be of the same version, class and algorithm.
//! A shard stops after a size with a wrong map. If later sizes of it are missing, the result ends there, too.

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Deserialize;
use toposlam_model::{check::Shard, mapping::MappingAlgorithm};

use super::{CheckArguments, CheckReport, CiCase, CliError, Outcome, SizeLine, counted, input};

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
        ("algorithm", text(&line.algorithm)),
        ("choices", choices),
    ]
}

impl CheckArguments {
    /// Prints the result of the whole check whose shards are in some files.
    pub(super) fn add_shards(&self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        let mut shards = Vec::new();
        for file in &self.shards {
            read_shards(file, &mut shards)?;
        }
        let Some(FoundShard { place, line, .. }) = shards.first() else {
            let files: Vec<_> = self.shards.iter().map(|file| file.display().to_string()).collect();
            return Err(CliError::at(files.join(", "), "there is no line of a shard"));
        };
        let title = line.algorithm.as_deref().unwrap_or_default();
        let is_this = |known: &MappingAlgorithm| {
            known.info().title == title && known.aid().name() == line.marker
        };
        let algorithm = MappingAlgorithm::all().find(is_this).ok_or_else(|| {
            let cause = format!("no algorithm is `{title}` with marker `{}`", line.marker);
            CliError::at(place, cause)
        })?;
        let (complete, left_out) = by_size(shards)?;
        let mut report = CheckReport::new(out, self.json, Some(algorithm.info().order));
        let mut cases = Vec::new();
        for line in complete {
            cases.push(line.ci_case());
            report.size(line)?;
        }
        let outcome = report.verdict(None)?;
        if let Some(first) = left_out.first() {
            let from = counted(first.edges, "edge");
            remark!(
                "shards are missing from {from} on, after a wrong map; those sizes are left out"
            );
        }
        CiCase::add_not_checked(&mut cases, left_out.iter().map(SizeLine::name), None);
        self.ci.write("check", &cases, self.shards.first().map(PathBuf::as_path))?;
        Ok(outcome)
    }
}

/// Adds up the shards of each size. Returns the sizes with all shards, and those after a wrong map whose shards are
/// missing.
///
/// # Errors
/// Returns an error if shards are missing, duplicated or different, or if a sum is too large.
fn by_size(mut shards: Vec<FoundShard>) -> Result<(Vec<SizeLine>, Vec<SizeLine>), CliError> {
    let mut problems = Vec::new();
    for FoundShard { place, line, .. } in &shards {
        for ((name, is), (_, first)) in subject(line).into_iter().zip(subject(&shards[0].line)) {
            if is != first {
                problems.push(format!("{place}: {name} is {is}, not {first}"));
            }
        }
    }
    let mut found: BTreeMap<usize, Vec<FoundShard>> = BTreeMap::new();
    shards.sort_by_key(|found| found.shard.index());
    for shard in shards {
        found.entry(shard.line.edges).or_default().push(shard);
    }
    let (mut complete, mut left_out) = (Vec::new(), Vec::new());
    let mut total = SizeLine::default();
    let mut is_violated = false;
    for (edges, shards) in found {
        let missing = missing_shards(edges, &shards, &mut problems);
        // A shard whose map was wrong has checked no larger size.
        let is_left_out = !left_out.is_empty() || is_violated && !missing.is_empty();
        if !is_left_out {
            problems.extend(missing);
        }
        is_violated |= shards.iter().any(|found| found.line.failed > 0);
        let mut sum: Option<SizeLine> = None;
        for FoundShard { place, mut line, .. } in shards {
            (line.shard, line.version) = (None, None);
            let at = |overflow| CliError::at(&place, overflow);
            total.add(line.clone()).map_err(at)?;
            match &mut sum {
                Some(sum) => sum.add(line).map_err(at)?,
                None => sum = Some(line),
            }
        }
        if is_left_out { &mut left_out } else { &mut complete }.extend(sum);
    }
    if problems.len() > MOST_PROBLEMS {
        problems.truncate(MOST_PROBLEMS);
        problems.push("...".to_owned());
    }
    if problems.is_empty() {
        Ok((complete, left_out))
    } else {
        Err(CliError::Input(problems.join("\n")))
    }
}

/// The most problems that are listed. A wrong number of shards can be huge.
const MOST_PROBLEMS: usize = 100;

fn read_shards(path: &Path, shards: &mut Vec<FoundShard>) -> Result<(), CliError> {
    let bytes = input::read(path)?;
    for (number, text) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
        if text.trim_ascii().is_empty() {
            continue;
        }
        let place = format!("{}: line {number}", path.display());
        let at = |cause: String| CliError::at(&place, cause);
        let LineHead { schema, kind } = serde_json::from_slice(text)
            .map_err(|error| at(format!("this is not a line of `check --json`: {error}")))?;
        if (schema, kind.as_str()) != (1, "size") {
            return Err(at(format!("this is a line `{kind}` of schema {schema}, not `size` of 1")));
        }
        let line: SizeLine = serde_json::from_slice(text).map_err(|error| at(error.to_string()))?;
        let Some(shard) = &line.shard else {
            return Err(at("this is the result of a whole check, not of a shard".to_owned()));
        };
        let shard = shard.parse().map_err(|error| at(format!("{error}")))?;
        if let Some(contradiction) = line.contradiction() {
            return Err(at(contradiction));
        }
        shards.push(FoundShard { place, shard, line });
    }
    Ok(())
}

/// The shards of one size without a whole result. Those that should not be there are problems.
fn missing_shards(edges: usize, found: &[FoundShard], problems: &mut Vec<String>) -> Vec<String> {
    let mut missing = Vec::new();
    let (of, size) = (found[0].shard.total(), counted(edges, "edge"));
    let mut by_index: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for FoundShard { place, shard, line } in found {
        if shard.total() == of {
            by_index.entry(shard.index()).or_default().push(place);
        } else {
            problems.push(format!("{place}: {size}: {shard} is not one of {of} shards"));
        }
        if line.interrupted {
            missing.push(format!("{place}: shard {shard} was interrupted"));
        }
    }
    for (index, twice) in by_index.iter().filter(|(_, places)| places.len() > 1) {
        let twice = twice.join(", ");
        problems.push(format!("{size}: shard {index}/{of} occurs twice: {twice}"));
    }
    let absent = (1..=of).filter(|index| !by_index.contains_key(index));
    let absent = absent.map(|index| format!("{size}: shard {index}/{of} is missing"));
    missing.extend(absent.take(MOST_PROBLEMS + 1));
    missing
}
