//! `toposlam info LOG...`: the contents of logs. Sections 5 and 6.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use serde_json::{Map, Value, json};
use toposlam_logs::{
    FileCompression, Format,
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
    text::{counted, duration_text, grouped, moment, print_hanging, print_rows, printable},
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

/// An open log, what its topics could carry, and its verification, if it is wanted.
struct ListedLog<'l> {
    path: &'l Path,
    log: &'l Log,
    carriers: Carriers<'l>,
    verification: Option<Verification>,
}

/// For each role, the names of the topics that could carry it, or of the one in the topics file.
type Carriers<'l> = Vec<(&'static str, Vec<&'l str>)>;

impl InfoArguments {
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, CliError> {
        output::check_place(&self.write_topics, &["toml"])?;
        if self.write_topics.is_some() && self.logs.len() > 1 {
            return Err(CliError::at("--write-topics", "this needs exactly one log"));
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
                if self.json {
                    let verification = verification_json(&found, Outcome::Violated);
                    let line = json!({ "log": log, "verification": verification });
                    print_line(out, "damaged-log", &line)?;
                } else {
                    writeln!(out, "{}: damaged, and not read further", printable(&log))?;
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
        let listed = ListedLog { path, log: &log, carriers, verification };
        if self.json {
            print_line(out, "log", &listed.json(outcome))?;
        } else {
            listed.print(out)?;
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

/// What `--json` prints with `--verify`.
fn verification_json(found: &Verification, outcome: Outcome) -> Value {
    let damage =
        |error: &LogError| json!({ "offset": error.offset, "cause": error.cause.to_string() });
    json!({
        "chunks": found.chunks,
        "messages": found.messages,
        "covered_bytes": found.covered,
        "complete": found.complete,
        "damage": found.damage.iter().map(damage).collect::<Vec<_>>(),
        "verdict": outcome.verdict(),
        "holds": outcome == Outcome::Holds,
    })
}

fn print_damage(out: &mut dyn Write, found: &Verification) -> Result<(), CliError> {
    for error in &found.damage {
        print_hanging(out, "  ", &error.to_string())?;
    }
    Ok(())
}

fn format_in_words(format: Format) -> &'static str {
    match format {
        Format::Bag => "ROS 1 bag",
        Format::Mcap => "MCAP",
        Format::Carmen => "CARMEN log",
        Format::Events => "events",
        Format::Database => "rosbag2 database",
        Format::Folder => "rosbag2 folder",
    }
}

/// A name out of a log, as it can be printed.
fn shown(name: &str) -> String {
    name.escape_debug().to_string()
}

impl ListedLog<'_> {
    /// Seconds; `None` if the times of its lines are not those of a clock.
    fn duration(&self) -> Option<f64> {
        self.log.irregular_times().is_none_or(|times| times.are_known()).then_some(())?;
        let (start, end) = self.log.start().zip(self.log.end())?;
        Some(end.saturating_sub(start) as f64 / 1e9)
    }

    /// The messages of a topic in a second; not of a log that is shorter than a second.
    fn rate(&self, topic: &Topic) -> Option<f64> {
        let whole_seconds = self.duration().filter(|duration| *duration >= 1.0);
        whole_seconds.map(|duration| topic.messages as f64 / duration)
    }

    fn is_indexed(&self) -> bool {
        // Lines have none: all of them are read.
        !matches!(self.log.format(), Format::Carmen | Format::Events) && self.log.is_indexed()
    }

    /// What `--json` prints.
    fn json(&self, outcome: Outcome) -> Value {
        let Self { path, log, carriers, verification } = self;
        let topic = |topic: &Topic| {
            let encoding = match &topic.encoding {
                Encoding::Ros1 => "ros1",
                Encoding::Cdr => "cdr",
                Encoding::Carmen => "carmen",
                Encoding::Event => "event",
                Encoding::Other(other) => other,
            };
            json!({
                "name": topic.name, "type": topic.type_name, "encoding": encoding,
                "messages": topic.messages, "rate": self.rate(topic), "undecodable": undecodable(topic),
            })
        };
        let mapping = carriers.iter().map(|(role, topics)| ((*role).to_owned(), json!(topics)));
        let mapping: Map<_, _> = mapping.collect();
        json!({
            "log": path.display().to_string(),
            "format": log.format().name(),
            "compression": log.compression().map(FileCompression::name),
            "bytes": log.size(),
            // Nanoseconds.
            "start": log.start(),
            "end": log.end(),
            "duration": self.duration(),
            "messages": log.messages_total(),
            "truncated": log.truncation().map(TruncatedLine::from),
            "indexed": self.is_indexed(),
            "skipped": log.skipped(),
            "line_times": log.irregular_times(),
            "verification": verification.as_ref().map(|found| verification_json(found, outcome)),
            "topics": log.topics().iter().map(topic).collect::<Vec<_>>(),
            "mapping": mapping,
        })
    }

    /// What is known of the contents.
    fn contents(&self) -> String {
        let index = if self.is_indexed() { "an index" } else { "no index" };
        match &self.verification {
            None => format!("has {index}, contents not verified"),
            Some(found) if !found.damage.is_empty() => format!("has {index}, contents damaged:"),
            Some(found) if !found.complete => format!("has {index}, verification interrupted"),
            Some(found) => {
                let [covered, size] =
                    [found.covered, self.log.size()].map(|bytes| grouped(bytes.into()));
                let messages = counted(found.messages as usize, "message");
                let chunks = counted(found.chunks as usize, "chunk");
                format!(
                    "has {index}, contents verified: {messages}, {chunks}, checksums of {covered} \
                     of {size} bytes"
                )
            }
        }
    }

    fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let log = self.log;
        let compression =
            log.compression().map_or(String::new(), |known| format!(", {}", known.name()));
        let path = printable(&self.path.display().to_string());
        let size = grouped(log.size().into());
        writeln!(out, "{path}: {}{compression}, {size} bytes", format_in_words(log.format()))?;
        if let Some(truncation) = log.truncation() {
            print_hanging(out, "", &truncation.to_string())?;
        }
        print_hanging(out, "", &self.contents())?;
        if let Some(found) = &self.verification {
            print_damage(out, found)?;
        }
        if let (Some(start), Some(duration)) = (log.start(), self.duration()) {
            let exact = format!("{duration:.3} s");
            let duration = if duration < 60.0 { exact } else { duration_text(duration) };
            writeln!(out, "from {}, for {duration}", moment(start))?;
        }
        writeln!(out, "{}", counted(log.messages_total() as usize, "message"))?;
        if let Some(skipped) = log.skipped() {
            print_hanging(out, "", &format!("skipped {skipped}"))?;
        }
        if let Some(times) = log.irregular_times() {
            print_hanging(out, "", &times.to_string())?;
        }
        writeln!(out)?;
        let row = |topic: &Topic| {
            let rate = match self.rate(topic) {
                None => String::new(),
                Some(rate) if rate < 100.0 => format!("{rate:.2}"),
                Some(rate) => grouped(rate.round() as u128),
            };
            [
                format!("{:>10}", grouped(topic.messages.into())),
                format!("{rate:>8}"),
                shown(&topic.name),
                shown(&topic.type_name),
                undecodable(topic).as_deref().map(shown).unwrap_or_default(),
            ]
        };
        let rows: Vec<_> = log.topics().iter().map(row).collect();
        print_rows(out, ["  messages", "a second", "topic", "type", ""], &rows)?;
        writeln!(out)?;
        if self.carriers.is_empty() {
            writeln!(out, "No topic of a run is recognised; select topics with a topics file.")?;
            return Ok(());
        }
        let row = |(role, topics): &(&str, Vec<&str>)| [(*role).to_owned(), any_of(topics)];
        let rows: Vec<_> = self.carriers.iter().map(row).collect();
        Ok(print_rows(out, ["role", "topic"], &rows)?)
    }
}

/// Why the messages of a topic cannot be decoded.
fn undecodable(topic: &Topic) -> Option<String> {
    topic.definition.as_ref().err().map(ToString::to_string)
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
