//! `toposlam info LOG...`: the contents of logs. Sections 5 and 6.

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Serialize;
use toposlam_logs::{
    FileCompression, Format, SkippedLines,
    error::LogError,
    reader::Log,
    topic::{Encoding, Topic},
    topic_map::{RoleGuess, TopicMap, guess},
    verify::Verification,
};

use super::{
    CliError, Outcome,
    exit_codes::help_end,
    input,
    json::{TruncatedLine, print_line, print_unread},
    outcome::SeveralInputs,
    output,
    progress::Progress,
    text::{counted, duration_text, grouped, moment, print_hanging, print_rows},
};

/// Show the contents of logs: times, completeness and topics
///
/// A log is a ROS 1 bag (version 2.0), an MCAP file, a rosbag2 folder or .db3 file, a CARMEN log, or events
/// as JSON lines or CSV, from this program or any other. The command also lists the topics that could carry images, scans, odometry, motion,
/// percepts and doors. If several topics could, or none is recognised, a topics file selects the topic.
///
/// A log is listed from its index, if it has one. --verify reads all of it, and compares it with its
/// checksums and its index.
#[derive(clap::Args)]
#[command(after_help = help_end(
    "\
Examples:
  toposlam info run.mcap --write-topics topics.toml
  toposlam info run.mcap --verify

A log that cannot be read is reported, and the others are shown.",
    &[
        (0, "the logs are listed; with --verify, they are not damaged"),
        (1, "--verify found damage"),
        (2, "bad usage or input"),
        (3, "a log is truncated (its contents up to there are listed), or --verify was interrupted"),
    ],
))]
pub(super) struct InfoArguments {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Check that this topics file fits each log
    #[arg(long, value_name = "FILE", conflicts_with = "write_topics")]
    topics: Option<PathBuf>,
    /// Write a topics file with the topics that are unambiguous
    #[arg(long, value_name = "FILE")]
    write_topics: Option<PathBuf>,
    /// Read everything, and compare it with the checksums and the index of the log
    #[arg(long)]
    verify: bool,
    /// Print one JSON object for each log
    #[arg(long)]
    json: bool,
}

/// What `--json` prints for a log.
#[derive(Serialize)]
struct InfoLine<'l> {
    log: String,
    format: &'static str,
    compression: Option<&'static str>,
    bytes: u64,
    /// Nanoseconds.
    start: Option<u64>,
    end: Option<u64>,
    /// Seconds.
    duration: Option<f64>,
    messages: u64,
    truncated: Option<TruncatedLine>,
    /// Whether it has an index.
    indexed: bool,
    skipped: Option<&'l SkippedLines>,
    verification: Option<VerificationLine>,
    topics: Vec<TopicLine<'l>>,
    /// For each role, the topics that could carry it, or the one in the topics file.
    mapping: BTreeMap<&'static str, Vec<&'l str>>,
}

/// With `--verify`.
#[derive(Serialize)]
struct VerificationLine {
    chunks: u64,
    messages: u64,
    /// The number of bytes that a checksum covers.
    covered_bytes: u64,
    complete: bool,
    damage: Vec<DamageLine>,
    verdict: &'static str,
    holds: bool,
}

#[derive(Serialize)]
struct DamageLine {
    offset: u64,
    cause: String,
}

/// What `--json` prints for a log that is too damaged to be listed.
#[derive(Serialize)]
struct DamagedLine {
    log: String,
    verification: VerificationLine,
}

#[derive(Serialize)]
struct TopicLine<'l> {
    name: &'l str,
    r#type: &'l str,
    encoding: &'l str,
    messages: u64,
    /// Messages a second.
    rate: Option<f64>,
    undecodable: Option<String>,
}

impl InfoArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        if let Some(path) = &self.write_topics {
            output::check_place(path, &["toml"])?;
            if self.logs.len() > 1 {
                return Err(CliError::at("--write-topics", "this needs exactly one log"));
            }
        }
        let topics = match &self.topics {
            None => None,
            Some(path) => {
                let read = TopicMap::read(&input::read(path)?);
                Some((path, read.map_err(|error| CliError::in_file(path, error))?))
            }
        };
        let mut inputs = SeveralInputs::new();
        for path in &self.logs {
            let shown = self.show(out, path, topics.as_ref());
            if let (true, Err(error @ CliError::Input(_))) = (self.json, &shown) {
                print_unread(out, &path.display().to_string(), &error.cause_in(path))?;
            }
            let read = inputs.add(shown);
            if read == Some(ReadTo::Interruption) {
                break;
            }
        }
        inputs.worst()
    }

    /// Shows one log.
    fn show(
        &self,
        out: &mut dyn Write,
        path: &Path,
        topics: Option<&(&PathBuf, TopicMap)>,
    ) -> Result<(ReadTo, Outcome), CliError> {
        let log = match input::log_or_cause(path)? {
            Ok(log) => log,
            Err(error) if self.verify && error.cause.is_damage() => {
                self.print_damaged(out, path, error)?;
                return Ok((ReadTo::End, Outcome::Violated));
            }
            Err(error) => return Err(CliError::in_file(path, error)),
        };
        if let Some((topics_path, topics)) = topics {
            topics.bind(&log).map_err(|error| {
                CliError::in_file(topics_path, format!("{error} ({})", path.display()))
            })?;
        }
        let carriers = carriers(&log, topics.map(|(_, topics)| topics));
        if let Some(target) = &self.write_topics {
            write_topics(target, &log, &carriers)?;
        }
        let verification = if self.verify { Some(verify(path, &log)?) } else { None };
        if self.json {
            print_line(out, "log", &line(path, &log, verification.as_ref(), carriers))?;
        } else {
            print(out, path, &log, verification.as_ref(), &carriers)?;
        }
        let unread = verification.as_ref().is_some_and(|found| !found.complete);
        let outcome = outcome(Some(&log), verification.as_ref());
        Ok((if unread { ReadTo::Interruption } else { ReadTo::End }, outcome))
    }

    /// Prints the damage of a log that cannot be listed.
    fn print_damaged(
        &self,
        out: &mut dyn Write,
        path: &Path,
        error: LogError,
    ) -> Result<(), CliError> {
        let found = Verification { damage: vec![error], ..Verification::default() };
        if self.json {
            let (log, verification) = (path.display().to_string(), verification_line(None, &found));
            return print_line(out, "damaged-log", &DamagedLine { log, verification });
        }
        writeln!(out, "{}: damaged, and not read further", path.display())?;
        print_damage(out, &found)
    }
}

/// How far a log was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ReadTo {
    End,
    Interruption,
}

/// For each role, the names of the topics that carry it or could carry it.
fn carriers<'l>(log: &'l Log, topics: Option<&'l TopicMap>) -> Vec<(&'static str, Vec<&'l str>)> {
    if let Some(topics) = topics {
        let carriers = topics.carriers();
        return carriers.map(|(role, carrier)| (role.name(), vec![&*carrier.topic])).collect();
    }
    let name = |topic: usize| log.topics().get(topic).map(|topic| &*topic.name);
    let names = |guess: RoleGuess| {
        let topics = guess.topics.into_iter().filter_map(name);
        (guess.role.name(), topics.collect())
    };
    guess(log.topics()).into_iter().map(names).collect()
}

fn verify(path: &Path, log: &Log) -> Result<Verification, CliError> {
    let progress = Progress::new("reading", "chunks")?;
    let found = log.verify(&progress).map_err(|error| CliError::in_file(path, error));
    progress.finish();
    found
}

/// The result of a log: damage, or what was not read.
fn outcome(log: Option<&Log>, verification: Option<&Verification>) -> Outcome {
    let damaged = verification.is_some_and(|found| !found.damage.is_empty());
    let unread = verification.is_some_and(|found| !found.complete);
    match () {
        () if damaged => Outcome::Violated,
        () if unread || log.is_some_and(|log| log.truncation().is_some()) => Outcome::Incomplete,
        () => Outcome::Holds,
    }
}

fn verification_line(log: Option<&Log>, found: &Verification) -> VerificationLine {
    let outcome = outcome(log, Some(found));
    let damage = found
        .damage
        .iter()
        .map(|error| DamageLine { offset: error.offset, cause: error.cause.to_string() });
    VerificationLine {
        chunks: found.chunks,
        messages: found.messages,
        covered_bytes: found.covered,
        complete: found.complete,
        damage: damage.collect(),
        verdict: outcome.verdict(),
        holds: outcome == Outcome::Holds,
    }
}

fn print_damage(out: &mut dyn Write, found: &Verification) -> Result<(), CliError> {
    for error in &found.damage {
        print_hanging(out, "  ", &error.to_string())?;
    }
    Ok(())
}

/// Whether a log has an index. Lines have none: all of them are read.
fn has_index(log: &Log) -> bool {
    !matches!(log.format(), Format::Carmen | Format::Events) && log.is_indexed()
}

/// What is known of the contents of a log.
fn contents(log: &Log, verification: Option<&Verification>) -> String {
    let index = if has_index(log) { "an index" } else { "no index" };
    match verification {
        None => format!("has {index}, contents not verified"),
        Some(found) if !found.damage.is_empty() => format!("has {index}, contents damaged:"),
        Some(found) if !found.complete => format!("has {index}, verification interrupted"),
        Some(found) => {
            let [covered, size] = [found.covered, log.size()].map(|bytes| grouped(bytes.into()));
            let messages = counted(found.messages as usize, "message");
            let chunks = counted(found.chunks as usize, "chunk");
            format!(
                "has {index}, contents verified: {messages}, {chunks}, checksums of {covered} of \
                 {size} bytes"
            )
        }
    }
}

fn format(log: &Log) -> &'static str {
    match log.format() {
        Format::Bag => "bag",
        Format::Mcap => "mcap",
        Format::Carmen => "carmen",
        Format::Events => "events",
        Format::Database => "db3",
        Format::Folder => "rosbag2",
    }
}

/// The time from the first to the last message, in seconds.
fn duration(log: &Log) -> Option<f64> {
    Some(log.end()?.saturating_sub(log.start()?) as f64 / 1e9)
}

/// A number a second, with three digits or more.
fn rate_text(rate: f64) -> String {
    if rate < 100.0 { format!("{rate:.2}") } else { grouped(rate.round() as u128) }
}

/// The number of messages a second on a topic. A log that is shorter than a second has none.
fn rate(log: &Log, topic: &Topic) -> Option<f64> {
    let duration = duration(log).filter(|duration| *duration >= 1.0)?;
    Some(topic.messages as f64 / duration)
}

fn line<'l>(
    path: &Path,
    log: &'l Log,
    verification: Option<&Verification>,
    carriers: Vec<(&'static str, Vec<&'l str>)>,
) -> InfoLine<'l> {
    InfoLine {
        log: path.display().to_string(),
        format: format(log),
        compression: log.compression().map(FileCompression::name),
        bytes: log.size(),
        start: log.start(),
        end: log.end(),
        duration: duration(log),
        messages: log.messages_total(),
        truncated: log.truncation().map(TruncatedLine::from),
        indexed: has_index(log),
        skipped: log.skipped(),
        verification: verification.map(|found| verification_line(Some(log), found)),
        topics: log
            .topics()
            .iter()
            .map(|topic| TopicLine {
                name: &topic.name,
                r#type: &topic.type_name,
                encoding: match &topic.encoding {
                    Encoding::Ros1 => "ros1",
                    Encoding::Cdr => "cdr",
                    Encoding::Carmen => "carmen",
                    Encoding::Event => "event",
                    Encoding::Other(other) => other,
                },
                messages: topic.messages,
                rate: rate(log, topic),
                undecodable: topic.definition.as_ref().err().map(ToString::to_string),
            })
            .collect(),
        mapping: carriers.into_iter().collect(),
    }
}

/// A name out of a log, as it can be printed.
fn shown(name: &str) -> String {
    name.escape_debug().to_string()
}

fn print(
    out: &mut dyn Write,
    path: &Path,
    log: &Log,
    verification: Option<&Verification>,
    carriers: &[(&str, Vec<&str>)],
) -> Result<(), CliError> {
    let format = match log.format() {
        Format::Bag => "ROS 1 bag",
        Format::Mcap => "MCAP",
        Format::Carmen => "CARMEN log",
        Format::Events => "events",
        Format::Database => "rosbag2 database",
        Format::Folder => "rosbag2 folder",
    };
    let compression = log.compression();
    let compression = compression.map_or(String::new(), |known| format!(", {}", known.name()));
    let size = grouped(log.size().into());
    writeln!(out, "{}: {format}{compression}, {size} bytes", path.display())?;
    if let Some(truncation) = log.truncation() {
        print_hanging(out, "", &truncation.to_string())?;
    }
    print_hanging(out, "", &contents(log, verification))?;
    if let Some(found) = verification {
        print_damage(out, found)?;
    }
    if let (Some(start), Some(duration)) = (log.start(), duration(log)) {
        let exact = format!("{duration:.3} s");
        let duration = if duration < 60.0 { exact } else { duration_text(duration) };
        writeln!(out, "from {}, for {duration}", moment(start))?;
    }
    writeln!(out, "{}", counted(log.messages_total() as usize, "message"))?;
    if let Some(skipped) = log.skipped() {
        print_hanging(out, "", &format!("skipped {skipped}"))?;
    }
    writeln!(out)?;
    let rows: Vec<_> = log
        .topics()
        .iter()
        .map(|topic| {
            let rate = rate(log, topic).map_or(String::new(), rate_text);
            let why = topic.definition.as_ref().err().map(|why| shown(&why.to_string()));
            [
                format!("{:>10}", grouped(topic.messages.into())),
                format!("{rate:>8}"),
                shown(&topic.name),
                shown(&topic.type_name),
                why.unwrap_or_default(),
            ]
        })
        .collect();
    print_rows(out, ["  messages", "a second", "topic", "type", ""], &rows)?;
    writeln!(out)?;
    if carriers.is_empty() {
        writeln!(out, "No topic of a run is recognised; select topics with a topics file.")?;
    }
    let rows: Vec<_> = carriers
        .iter()
        .map(|(role, topics)| {
            let topics: Vec<_> = topics.iter().map(|topic| shown(topic)).collect();
            [(*role).to_owned(), topics.join(" or ")]
        })
        .collect();
    if !rows.is_empty() {
        print_rows(out, ["role", "topic"], &rows)?;
    }
    Ok(())
}

/// Writes the roles with one possible topic; those with several are comments.
fn write_topics(path: &Path, log: &Log, carriers: &[(&str, Vec<&str>)]) -> Result<(), CliError> {
    let topics = TopicMap::unambiguous(log);
    if topics.is_empty() {
        return Err(CliError::in_file(path, "no role has exactly one possible topic"));
    }
    let several = carriers.iter().filter(|(_, topics)| topics.len() > 1);
    let comments = several.map(|(role, topics)| {
        let topics: Vec<_> = topics.iter().map(|topic| shown(topic)).collect();
        format!("\n# [{role}]\n# topic = {}\n", topics.join(" or "))
    });
    let text = topics.to_toml() + &comments.collect::<String>();
    output::write_whole(path, text.as_bytes())
}
