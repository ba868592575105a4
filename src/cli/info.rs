//! `toposlam info LOG...`: the contents of logs. Sections 5 and 6.

use std::{
    collections::BTreeMap,
    io::Write,
    path::{Path, PathBuf},
};

use serde::Serialize;
use toposlam_robot::log::{
    Format,
    reader::Log,
    topic::{Encoding, Topic},
    topic_map::{RoleGuess, TopicMap, guess},
};

use super::{
    Failure, Outcome, input,
    json::print_object,
    outcome::SeveralInputs,
    output,
    text::{grouped, print_rows},
};

/// Show the contents of logs: times, completeness and topics
///
/// A log is a ROS 1 bag (version 2.0) or an MCAP file, from this program or any other. The command also
/// lists the topics that could carry images, odometry, motion, percepts and doors. If several topics
/// could, or none is recognised, a mapping file selects the topic.
#[derive(clap::Args)]
#[command(after_help = "\
Example:
  toposlam info run.mcap --write-mapping mapping.toml

A log that cannot be read is reported, and the others are shown. Exit code 2 if there is one; 3 if a log \
is truncated: its contents up to there are shown.")]
pub(super) struct InfoArguments {
    /// The logs
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Check that this mapping file fits each log
    #[arg(long, value_name = "FILE", conflicts_with = "write_mapping")]
    mapping: Option<PathBuf>,
    /// Write a mapping file with the topics that are unambiguous
    #[arg(long, value_name = "FILE")]
    write_mapping: Option<PathBuf>,
    /// Print one JSON object for each log
    #[arg(long)]
    json: bool,
}

/// What `--json` prints for a log.
#[derive(Serialize)]
struct Line<'l> {
    schema: u32,
    log: String,
    format: &'static str,
    bytes: u64,
    /// Nanoseconds.
    start: Option<u64>,
    end: Option<u64>,
    /// Seconds.
    duration: Option<f64>,
    messages: u64,
    truncated: Option<Truncated>,
    topics: Vec<TopicLine<'l>>,
    /// For each role, the topics that could carry it, or the one in the mapping file.
    mapping: BTreeMap<&'static str, Vec<&'l str>>,
}

#[derive(Serialize)]
struct Truncated {
    offset: u64,
    cause: String,
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
    pub(super) fn run(self, out: &mut dyn Write) -> Result<Outcome, Failure> {
        if let Some(path) = &self.write_mapping {
            output::check_place(path, &["toml"])?;
            if self.logs.len() > 1 {
                return Err(Failure::at("--write-mapping", "this needs exactly one log"));
            }
        }
        let mapping = match &self.mapping {
            None => None,
            Some(path) => {
                let read = TopicMap::read(&input::read(path)?);
                Some((path, read.map_err(|error| Failure::in_file(path, error))?))
            }
        };
        let mut inputs = SeveralInputs::new();
        for path in &self.logs {
            let Some(log) = inputs.add(opened(path, mapping.as_ref())) else { continue };
            let carriers = carriers(&log, mapping.as_ref().map(|(_, mapping)| mapping));
            if let Some(target) = &self.write_mapping {
                write_mapping(target, &log, &carriers)?;
            }
            if self.json {
                print_object(out, &line(path, &log, carriers))?;
            } else {
                print(out, path, &log, &carriers)?;
            }
        }
        inputs.worst()
    }
}

/// Opens a log, which is incomplete if it is truncated. The mapping must fit it.
fn opened(path: &Path, mapping: Option<&(&PathBuf, TopicMap)>) -> Result<(Log, Outcome), Failure> {
    let log = input::open_log(path)?;
    if let Some((mapping_path, mapping)) = mapping {
        mapping.bind(&log).map_err(|error| {
            Failure::in_file(mapping_path, format!("{error} ({})", path.display()))
        })?;
    }
    let whole = log.truncation().is_none();
    Ok((log, if whole { Outcome::Holds } else { Outcome::Incomplete }))
}

/// For each role, the names of the topics that carry it or could carry it.
fn carriers<'l>(log: &'l Log, mapping: Option<&'l TopicMap>) -> Vec<(&'static str, Vec<&'l str>)> {
    if let Some(mapping) = mapping {
        let carriers = mapping.carriers();
        return carriers.map(|(role, carrier)| (role.name(), vec![&*carrier.topic])).collect();
    }
    let name = |topic: usize| log.topics().get(topic).map(|topic| &*topic.name);
    let names = |guess: RoleGuess| {
        let topics = guess.topics.into_iter().filter_map(name);
        (guess.role.name(), topics.collect())
    };
    guess(log.topics()).into_iter().map(names).collect()
}

fn format(log: &Log) -> &'static str {
    match log.format() {
        Format::Bag => "bag",
        Format::Mcap => "mcap",
    }
}

/// The time from the first to the last message, in seconds.
fn duration(log: &Log) -> Option<f64> {
    Some(log.end()?.saturating_sub(log.start()?) as f64 / 1e9)
}

/// The number of messages a second on a topic.
fn rate(log: &Log, topic: &Topic) -> Option<f64> {
    let duration = duration(log).filter(|duration| *duration > 0.0)?;
    Some(topic.messages as f64 / duration)
}

fn line<'l>(path: &Path, log: &'l Log, carriers: Vec<(&'static str, Vec<&'l str>)>) -> Line<'l> {
    Line {
        schema: 1,
        log: path.display().to_string(),
        format: format(log),
        bytes: log.size(),
        start: log.start(),
        end: log.end(),
        duration: duration(log),
        messages: log.messages_total(),
        truncated: log
            .truncation()
            .map(|found| Truncated { offset: found.offset, cause: found.cause.to_string() }),
        topics: log
            .topics()
            .iter()
            .map(|topic| TopicLine {
                name: &topic.name,
                r#type: &topic.type_name,
                encoding: match &topic.encoding {
                    Encoding::Ros1 => "ros1",
                    Encoding::Cdr => "cdr",
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
    carriers: &[(&str, Vec<&str>)],
) -> Result<(), Failure> {
    let whole = match log.truncation() {
        None => "whole".to_owned(),
        Some(truncation) => truncation.to_string(),
    };
    let format = match log.format() {
        Format::Bag => "ROS 1 bag",
        Format::Mcap => "MCAP",
    };
    writeln!(out, "{}: {format}, {} bytes, {whole}", path.display(), grouped(log.size().into()))?;
    if let (Some(start), Some(duration)) = (log.start(), duration(log)) {
        let (seconds, rest) = (start / 1_000_000_000, start % 1_000_000_000);
        writeln!(out, "from {seconds}.{rest:09} s, for {duration:.3} s")?;
    }
    writeln!(out, "{} messages\n", grouped(log.messages_total().into()))?;
    let rows: Vec<_> = log
        .topics()
        .iter()
        .map(|topic| {
            let rate = rate(log, topic).map_or(String::new(), |rate| format!("{rate:.2}"));
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
        writeln!(out, "No topic of a run is recognised; select topics with a mapping file.")?;
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
fn write_mapping(path: &Path, log: &Log, carriers: &[(&str, Vec<&str>)]) -> Result<(), Failure> {
    let mapping = TopicMap::unambiguous(log);
    if mapping.is_empty() {
        return Err(Failure::in_file(path, "no role has exactly one possible topic"));
    }
    let several = carriers.iter().filter(|(_, topics)| topics.len() > 1);
    let comments = several.map(|(role, topics)| {
        let topics: Vec<_> = topics.iter().map(|topic| shown(topic)).collect();
        format!("\n# [{role}]\n# topic = {}\n", topics.join(" or "))
    });
    let text = mapping.to_toml() + &comments.collect::<String>();
    output::write_whole(path, text.as_bytes())
}
