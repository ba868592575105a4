//! Logs of lines: CARMEN logs, and lists of events.

use std::ops::Range;

use super::{
    Clock, Failure, FileStructure, Format, Listener, Record, Section, TimedLine, clock::resolution,
};
use crate::{
    carmen::{self, Parameters},
    definition::{Definition, Dialect},
    error::{LogErrorKind, TruncationKind},
    event_line::{self, Columns, Parsed},
    line_times::LineTimes,
    skipped_lines::SkippedLines,
    source::Source,
};

const LONGEST: usize = 1 << 20;
const PIECE: u64 = 1 << 16;
/// The largest size of a section, in bytes, unless it is one line.
const SECTION: u64 = 1 << 18;
pub(crate) const EVENT: &str = "toposlam/Event";
/// The number of bytes by which a log of lines is recognised.
pub(crate) const HEAD: u64 = 1 << 14;

#[derive(Default)]
pub(crate) struct TextState {
    pub(crate) columns: Option<Columns>,
    pub(crate) parameters: Parameters,
    pub(crate) first_event: u32,
    pub(crate) skipped: SkippedLines,
    pub(crate) times: LineTimes,
}

/// The format of a log that begins with these bytes, if it is one of lines.
pub(crate) fn recognise(head: &[u8]) -> Option<Format> {
    if event_line::is_events(head) {
        Some(Format::Events)
    } else {
        carmen::is_carmen(head).then_some(Format::Carmen)
    }
}

enum Content {
    Nothing,
    Parameter,
    Unknown(String),
    Message { kind: u32, time: TimedLine },
}

fn content(format: Format, columns: Option<&Columns>, line: &[u8]) -> Result<Content, String> {
    let line = line.trim_ascii();
    if line.is_empty() || line.starts_with(b"#") {
        return Ok(Content::Nothing);
    }
    if format == Format::Events {
        if columns.is_some() && Columns::read(line).as_ref() == columns {
            return Ok(Content::Nothing);
        }
        return Ok(match event_line::parse(line, columns)? {
            Parsed::Event(event, _) => {
                let time = TimedLine { time: event.stamp, ..TimedLine::default() };
                Content::Message { kind: 0, time }
            }
            Parsed::Other(kind) => Content::Unknown(kind),
        });
    }
    let keyword = carmen::keyword(line);
    if keyword == carmen::PARAMETER {
        return Ok(Content::Parameter);
    }
    let Some((kind, known)) = carmen::kind_of(keyword, line) else {
        let beginning = keyword.get(..keyword.len().min(20)).unwrap_or_default();
        let shown = String::from_utf8_lossy(beginning).escape_debug().to_string();
        return Ok(Content::Unknown(shown));
    };
    // A line without a time is not whole.
    let (word, time) = carmen::logger_time(line).unwrap_or(("", f64::NAN));
    let (time, resolution) = (Some(time), resolution(word));
    Ok(Content::Message { kind, time: TimedLine { time, resolution, has_scan: known.has_scan() } })
}

pub(super) fn scan(
    format: Format,
    source: &Source,
    listener: &mut Listener<'_>,
) -> Result<(FileStructure, TextState), Failure> {
    let mut scan = FileStructure::default();
    let mut state = TextState::default();
    let mut lines = Lines::new(source);
    let mut clock = Clock::new(format);
    let (mut number, mut seen) = (0, 0_u32);
    loop {
        number += 1;
        let Some(line) = lines.next().map_err(|cause| (cause, number))? else { break };
        if line.is_last && source.is_cut {
            return Ok((scan.truncated(number, TruncationKind::Compressed), state));
        }
        let is_first = seen == 0;
        if format == Format::Events && is_first && state.columns.is_none() {
            state.columns = Columns::read(line.bytes);
            if let Some(name) = state.columns.as_ref().and_then(Columns::repeated) {
                let what = format!("the column {name} is there twice");
                return Err((LogErrorKind::Line(what), number));
            }
        }
        let found = content(format, state.columns.as_ref(), line.bytes);
        let found = match found {
            Ok(Content::Message { kind, .. }) if line.is_last => {
                check(format, kind, line.bytes).and(found)
            }
            found => found,
        };
        let before = clock;
        let message = match found {
            Err(_) if line.is_last => {
                return Ok((scan.truncated(number, TruncationKind::RestOfRecord), state));
            }
            Err(what) => return Err((LogErrorKind::Line(what), number)),
            Ok(Content::Nothing) => None,
            Ok(Content::Parameter) => {
                state.parameters.read(line.bytes);
                None
            }
            Ok(Content::Unknown(name)) => {
                state.skipped.add_unknown(name);
                None
            }
            Ok(Content::Message { kind, time }) => Some((kind, clock.tick(time, &mut state.times))),
        };
        if let Some((kind, _)) = message
            && seen & (1 << kind) == 0
        {
            seen |= 1 << kind;
            if format == Format::Events {
                state.first_event = first_index(line.bytes, state.columns.as_ref());
            }
            listener(&topic(format, kind));
        }
        add(&mut scan, line.start..line.end, (number, before), message);
    }
    if source.is_cut {
        return Ok((scan.truncated(number, TruncationKind::Compressed), state));
    }
    scan.end_loose();
    Ok((scan, state))
}

fn topic(format: Format, kind: u32) -> Record<'static> {
    let (name, type_name, encoding, definition) = match carmen::KINDS.get(kind as usize) {
        Some(kind) if format == Format::Carmen => {
            (kind.keyword, kind.type_name, "carmen", kind.definition)
        }
        _ => ("events", EVENT, "event", ""),
    };
    Record::Connection {
        id: kind,
        topic: name.as_bytes(),
        type_name: type_name.as_bytes(),
        encoding: encoding.as_bytes(),
        schema: b"text",
        definition: definition.as_bytes(),
    }
}

fn first_index(line: &[u8], columns: Option<&Columns>) -> u32 {
    match event_line::parse(line, columns) {
        Ok(Parsed::Event(event, _)) => event.index.unwrap_or_default(),
        _ => 0,
    }
}

/// Whether a line without an end is whole.
fn check(format: Format, kind: u32, line: &[u8]) -> Result<(), String> {
    let Some(kind) = carmen::KINDS.get(kind as usize).filter(|_| format == Format::Carmen) else {
        return Ok(());
    };
    let definition = Definition::read(Dialect::Ros1, kind.type_name, kind.definition);
    let definition = definition.map_err(|error| error.to_string())?;
    carmen::decode(&definition, line).map(|_| ()).map_err(|error| error.to_string())
}

fn add(
    scan: &mut FileStructure,
    line: Range<u64>,
    start: (u64, Clock),
    message: Option<(u32, u64)>,
) {
    if scan.loose.as_ref().is_some_and(|section: &Section| line.end - section.offset > SECTION) {
        scan.end_loose();
    }
    let new = || Section { text: Some(start), ..Section::loose(line.start) };
    scan.loose.get_or_insert_with(new).extend(line.end, message);
}

pub(super) fn record<'a>(
    format: Format,
    state: &TextState,
    clock: &mut Clock,
    rest: &'a [u8],
) -> (Record<'a>, usize) {
    let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    let next = rest.len().min(end + 1);
    let line = rest.get(..end).unwrap_or_default();
    let record = match content(format, state.columns.as_ref(), line) {
        Ok(Content::Message { kind, time }) => {
            let time = clock.tick(time, &mut LineTimes::default());
            Record::Message { connection: kind, time, bytes: 0..end }
        }
        _ => Record::Other,
    };
    (record, next)
}

struct Lines<'s> {
    source: &'s Source,
    start: u64,
    bytes: Vec<u8>,
    used: usize,
}

struct Line<'l> {
    bytes: &'l [u8],
    start: u64,
    end: u64,
    is_last: bool,
}

impl<'s> Lines<'s> {
    fn new(source: &'s Source) -> Self {
        Self { source, start: 0, bytes: Vec::new(), used: 0 }
    }

    fn next(&mut self) -> Result<Option<Line<'_>>, LogErrorKind> {
        let mut searched = self.used;
        loop {
            let rest = self.bytes.get(searched..).unwrap_or_default();
            let end = rest.iter().position(|&byte| byte == b'\n').map(|at| searched + at);
            let read = self.start + self.bytes.len() as u64;
            if end.is_none() && read < self.source.length() {
                self.bytes.drain(..self.used);
                self.start += self.used as u64;
                self.used = 0;
                searched = self.bytes.len();
                if searched > LONGEST {
                    return Err(LogErrorKind::LongLine(LONGEST));
                }
                let more = read..self.source.length().min(read + PIECE);
                self.bytes.extend(self.source.read(more)?);
                continue;
            }
            let begin = self.used;
            let (end, next) = match end {
                Some(end) => (end, end + 1),
                None => (self.bytes.len(), self.bytes.len()),
            };
            if begin == next {
                return Ok(None);
            }
            self.used = next;
            return Ok(Some(Line {
                bytes: self.bytes.get(begin..end).unwrap_or_default(),
                start: self.start + begin as u64,
                end: self.start + next as u64,
                is_last: end == next,
            }));
        }
    }
}
