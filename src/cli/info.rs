//! `toposlam info LOG...`: the contents of logs. Sections 5 and 6.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use serde::{Serialize, Serializer};
use toposlam_logs::{
    FileCompression, Format, SkippedLines,
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
struct LogReport<'l> {
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
    indexed: bool,
    skipped: Option<&'l SkippedLines>,
    verification: Option<VerificationReport>,
    topics: Vec<TopicReport<'l>>,
    /// For each role, the topics that could carry it, or the one in the topics file.
    #[serde(serialize_with = "as_map")]
    mapping: Carriers<'l>,
}

/// With `--verify`.
#[derive(Serialize)]
struct VerificationReport {
    chunks: u64,
    messages: u64,
    /// The number of bytes that a checksum covers.
    covered_bytes: u64,
    complete: bool,
    damage: Vec<DamageReport>,
    verdict: &'static str,
    holds: bool,
}

#[derive(Serialize)]
struct DamageReport {
    offset: u64,
    cause: String,
}

/// What `--json` prints for a log that is too damaged to be listed.
#[derive(Serialize)]
struct DamagedLogReport {
    log: String,
    verification: VerificationReport,
}

#[derive(Serialize)]
struct TopicReport<'l> {
    name: &'l str,
    r#type: &'l str,
    encoding: &'l str,
    messages: u64,
    /// Messages a second; not of a log that is shorter than a second.
    rate: Option<f64>,
    undecodable: Option<String>,
}

/// For each role, the names of topics.
type Carriers<'l> = Vec<(&'static str, Vec<&'l str>)>;

fn as_map<S: Serializer>(carriers: &Carriers, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(carriers.iter().map(|(role, topics)| (role, topics)))
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
        let mut inputs = SeveralInputs::default();
        for path in &self.logs {
            let shown = self.show(out, path, topics.as_ref());
            if let (true, Err(error @ CliError::Input(_))) = (self.json, &shown) {
                print_unread(out, &path.display().to_string(), &error.cause_in(path))?;
            }
            if inputs.add(shown) == Some(true) {
                break;
            }
        }
        inputs.worst()
    }

    /// Shows one log. Returns whether its verification was interrupted.
    fn show(
        &self,
        out: &mut dyn Write,
        path: &Path,
        topics: Option<&(&PathBuf, TopicMap)>,
    ) -> Result<(bool, Outcome), CliError> {
        let log = match input::log_or_cause(path)? {
            Ok(log) => log,
            Err(error) if self.verify && error.cause.is_damage() => {
                let found = Verification { damage: vec![error], ..Verification::default() };
                let log = path.display().to_string();
                let verification = VerificationReport::new(&found, Outcome::Violated);
                if self.json {
                    let report = DamagedLogReport { log, verification };
                    print_line(out, "damaged-log", &report)?;
                } else {
                    writeln!(out, "{log}: damaged, and not read further")?;
                    print_damage(out, &found)?;
                }
                return Ok((false, Outcome::Violated));
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
        let is_interrupted = verification.as_ref().is_some_and(|found| !found.complete);
        let outcome = match &verification {
            Some(found) if !found.damage.is_empty() => Outcome::Violated,
            _ if is_interrupted || log.truncation().is_some() => Outcome::Incomplete,
            _ => Outcome::Holds,
        };
        let report = LogReport::new(path, &log, verification.as_ref(), outcome, carriers);
        if self.json {
            print_line(out, "log", &report)?;
        } else {
            report.print(out, &log, verification.as_ref())?;
        }
        Ok((is_interrupted, outcome))
    }
}

/// For each role, the names of the topics that carry it or could carry it.
fn carriers<'l>(log: &'l Log, topics: Option<&'l TopicMap>) -> Carriers<'l> {
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

impl VerificationReport {
    fn new(found: &Verification, outcome: Outcome) -> Self {
        let damage = found.damage.iter();
        Self {
            chunks: found.chunks,
            messages: found.messages,
            covered_bytes: found.covered,
            complete: found.complete,
            damage: damage
                .map(|error| DamageReport { offset: error.offset, cause: error.cause.to_string() })
                .collect(),
            verdict: outcome.verdict(),
            holds: outcome == Outcome::Holds,
        }
    }
}

fn print_damage(out: &mut dyn Write, found: &Verification) -> Result<(), CliError> {
    for error in &found.damage {
        print_hanging(out, "  ", &error.to_string())?;
    }
    Ok(())
}

/// The name of a log's format, and what it is called in words.
fn format(log: &Log) -> [&'static str; 2] {
    match log.format() {
        Format::Bag => ["bag", "ROS 1 bag"],
        Format::Mcap => ["mcap", "MCAP"],
        Format::Carmen => ["carmen", "CARMEN log"],
        Format::Events => ["events", "events"],
        Format::Database => ["db3", "rosbag2 database"],
        Format::Folder => ["rosbag2", "rosbag2 folder"],
    }
}

/// A name out of a log, as it can be printed.
fn shown(name: &str) -> String {
    name.escape_debug().to_string()
}

impl<'l> LogReport<'l> {
    fn new(
        path: &Path,
        log: &'l Log,
        verification: Option<&Verification>,
        outcome: Outcome,
        mapping: Carriers<'l>,
    ) -> Self {
        let duration = log.start().zip(log.end());
        let duration = duration.map(|(start, end)| end.saturating_sub(start) as f64 / 1e9);
        let whole_seconds = duration.filter(|duration| *duration >= 1.0);
        let topic = |topic: &'l Topic| TopicReport {
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
            rate: whole_seconds.map(|duration| topic.messages as f64 / duration),
            undecodable: topic.definition.as_ref().err().map(ToString::to_string),
        };
        Self {
            log: path.display().to_string(),
            format: format(log)[0],
            compression: log.compression().map(FileCompression::name),
            bytes: log.size(),
            start: log.start(),
            end: log.end(),
            duration,
            messages: log.messages_total(),
            truncated: log.truncation().map(TruncatedLine::from),
            // Lines have none: all of them are read.
            indexed: !matches!(log.format(), Format::Carmen | Format::Events) && log.is_indexed(),
            skipped: log.skipped(),
            verification: verification.map(|found| VerificationReport::new(found, outcome)),
            topics: log.topics().iter().map(topic).collect(),
            mapping,
        }
    }

    /// What is known of the contents.
    fn contents(&self) -> String {
        let index = if self.indexed { "an index" } else { "no index" };
        match &self.verification {
            None => format!("has {index}, contents not verified"),
            Some(found) if !found.damage.is_empty() => format!("has {index}, contents damaged:"),
            Some(found) if !found.complete => format!("has {index}, verification interrupted"),
            Some(found) => {
                let [covered, size] =
                    [found.covered_bytes, self.bytes].map(|bytes| grouped(bytes.into()));
                let messages = counted(found.messages as usize, "message");
                let chunks = counted(found.chunks as usize, "chunk");
                format!(
                    "has {index}, contents verified: {messages}, {chunks}, checksums of {covered} \
                     of {size} bytes"
                )
            }
        }
    }

    fn print(
        &self,
        out: &mut dyn Write,
        log: &Log,
        verification: Option<&Verification>,
    ) -> Result<(), CliError> {
        let compression = self.compression.map_or(String::new(), |known| format!(", {known}"));
        let size = grouped(self.bytes.into());
        writeln!(out, "{}: {}{compression}, {size} bytes", self.log, format(log)[1])?;
        if let Some(truncation) = log.truncation() {
            print_hanging(out, "", &truncation.to_string())?;
        }
        print_hanging(out, "", &self.contents())?;
        if let Some(found) = verification {
            print_damage(out, found)?;
        }
        if let (Some(start), Some(duration)) = (self.start, self.duration) {
            let exact = format!("{duration:.3} s");
            let duration = if duration < 60.0 { exact } else { duration_text(duration) };
            writeln!(out, "from {}, for {duration}", moment(start))?;
        }
        writeln!(out, "{}", counted(self.messages as usize, "message"))?;
        if let Some(skipped) = log.skipped() {
            print_hanging(out, "", &format!("skipped {skipped}"))?;
        }
        writeln!(out)?;
        let row = |topic: &TopicReport| {
            let rate = match topic.rate {
                None => String::new(),
                Some(rate) if rate < 100.0 => format!("{rate:.2}"),
                Some(rate) => grouped(rate.round() as u128),
            };
            [
                format!("{:>10}", grouped(topic.messages.into())),
                format!("{rate:>8}"),
                shown(topic.name),
                shown(topic.r#type),
                topic.undecodable.as_deref().map(shown).unwrap_or_default(),
            ]
        };
        let rows: Vec<_> = self.topics.iter().map(row).collect();
        print_rows(out, ["  messages", "a second", "topic", "type", ""], &rows)?;
        writeln!(out)?;
        if self.mapping.is_empty() {
            writeln!(out, "No topic of a run is recognised; select topics with a topics file.")?;
            return Ok(());
        }
        let row = |(role, topics): &(&str, Vec<&str>)| [(*role).to_owned(), any_of(topics)];
        let rows: Vec<_> = self.mapping.iter().map(row).collect();
        Ok(print_rows(out, ["role", "topic"], &rows)?)
    }
}

/// The names of topics that could carry one role.
fn any_of(topics: &[&str]) -> String {
    topics.iter().map(|topic| shown(topic)).collect::<Vec<_>>().join(" or ")
}

/// Writes the roles with one possible topic; those with several are comments.
fn write_topics(path: &Path, log: &Log, carriers: &Carriers) -> Result<(), CliError> {
    let topics = TopicMap::unambiguous(log);
    if topics.is_empty() {
        return Err(CliError::in_file(path, "no role has exactly one possible topic"));
    }
    let several = carriers.iter().filter(|(_, topics)| topics.len() > 1);
    let comments =
        several.map(|(role, topics)| format!("\n# [{role}]\n# topic = {}\n", any_of(topics)));
    let text = topics.to_toml() + &comments.collect::<String>();
    output::write_whole(path, text.as_bytes())
}
