//! A log that is open for reading, and its topics.

use std::{collections::BTreeMap, fs::File, io::Cursor, path::Path};

use super::{
    container::{self, BAG_MAGIC, Format, MCAP_MAGIC, Record, Section},
    error::{LogError, LogErrorKind, Truncation},
    source::{Source, Storage},
    topic::{Topic, Topics},
};

/// A log, open for reading.
///
/// Its messages stay in the file until they are asked for.
pub struct Log {
    pub(super) source: Source,
    pub(super) format: Format,
    pub(super) topics: Vec<Topic>,
    /// The topic of each connection.
    pub(super) connections: BTreeMap<u32, usize>,
    /// Those with messages, in the order of the file.
    pub(super) sections: Vec<Section>,
    truncation: Option<Truncation>,
    times: Option<[u64; 2]>,
    indexed: bool,
}

impl Log {
    /// Opens a file.
    ///
    /// # Errors
    /// As [`Log::new`].
    pub fn open(path: &Path) -> Result<Self, LogError> {
        Self::new(File::open(path).map_err(|error| LogErrorKind::from(error).at(0))?)
    }

    /// A log that is in memory.
    ///
    /// # Errors
    /// As [`Log::new`].
    pub fn of_bytes(bytes: Vec<u8>) -> Result<Self, LogError> {
        Self::new(Cursor::new(bytes))
    }

    /// Scans a log. Without an index, this decompresses the whole log once, a chunk at a time.
    ///
    /// Takes at most 1,100 bytes of memory for each byte of the largest chunk, 256 for each byte outside
    /// of chunks, and 32 MiB besides.
    ///
    /// # Errors
    /// Returns an error if the file is not a log, cannot be read, or is damaged. A truncated log is not an
    /// error.
    pub fn new(storage: impl Storage + 'static) -> Result<Self, LogError> {
        let source =
            Source::new(Box::new(storage)).map_err(|error| LogErrorKind::from(error).at(0))?;
        let format = format(&source)?;
        let mut topics = Topics::default();
        let scan = container::scan(format, &source, &mut |record| topics.add_record(record))?;
        let mut sections = scan.sections;
        let mut indexed = true;
        for section in &mut sections {
            let known = section.counts.as_ref().is_some_and(|counts| {
                let declared = counts.keys().all(|id| topics.connections.contains_key(id));
                declared && (section.times.is_some() || counts.values().all(|count| *count == 0))
            });
            if !known {
                indexed = false;
                scan_section(section, format, &source, &mut topics)?;
            }
        }
        let Topics { list: topics, connections, .. } = topics;
        let mut log = Self {
            source,
            format,
            topics,
            connections,
            sections,
            truncation: scan.truncation,
            times: None,
            indexed,
        };
        log.count();
        Ok(log)
    }

    /// Counts the messages of each topic.
    fn count(&mut self) {
        for section in &self.sections {
            for (id, count) in section.counts.iter().flatten() {
                let topic = self.connections.get(id).and_then(|topic| self.topics.get_mut(*topic));
                if let Some(topic) = topic {
                    topic.messages = topic.messages.saturating_add(*count);
                }
            }
        }
        self.sections.retain(|section| {
            section.times.is_some() && section.counts.iter().flatten().any(|(_, count)| *count > 0)
        });
        let times = self.sections.iter().filter_map(|section| section.times);
        self.times = times.reduce(|[first, last], [start, end]| [first.min(start), last.max(end)]);
    }

    /// Its format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Its size, in bytes.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.source.length()
    }

    /// Its topics, in the order of the file.
    #[must_use]
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The time of its first message, in nanoseconds; `None` if it has none.
    #[must_use]
    pub fn start(&self) -> Option<u64> {
        self.times.map(|[start, _]| start)
    }

    /// The time of its last message, in nanoseconds; `None` if it has none.
    #[must_use]
    pub fn end(&self) -> Option<u64> {
        self.times.map(|[_, end]| end)
    }

    /// The number of its messages, on all topics.
    #[must_use]
    pub fn messages_total(&self) -> u64 {
        self.topics.iter().fold(0, |sum, topic| sum.saturating_add(topic.messages))
    }

    /// Whether it has an index of its messages. If not, all of it was read to find them.
    #[must_use]
    pub fn is_indexed(&self) -> bool {
        self.indexed
    }

    /// Where it is truncated, if it is.
    #[must_use]
    pub fn truncation(&self) -> Option<&Truncation> {
        self.truncation.as_ref()
    }
}

fn format(source: &Source) -> Result<Format, LogError> {
    let head =
        source.read(0..source.length().min(16)).map_err(|error| LogErrorKind::from(error).at(0))?;
    if head.starts_with(MCAP_MAGIC) {
        return Ok(Format::Mcap);
    }
    if head.starts_with(BAG_MAGIC) {
        return Ok(Format::Bag);
    }
    let version =
        head.strip_prefix(b"#ROSBAG V").and_then(|rest| rest.split(|&byte| byte == b'\n').next());
    Err(match version {
        Some(version) => {
            LogErrorKind::Version(String::from_utf8_lossy(version).replace(char::is_control, " "))
        }
        None => LogErrorKind::NotALog,
    }
    .at(0))
}

/// Scans a section that has no index.
fn scan_section(
    section: &mut Section,
    format: Format,
    source: &Source,
    topics: &mut Topics,
) -> Result<(), LogError> {
    let bytes = section.load(source)?;
    let mut counts = BTreeMap::new();
    let mut times: Option<[u64; 2]> = None;
    for read in section.records(format, &bytes) {
        let (at, record) = read?;
        topics.add_record(&record);
        let Record::Message { connection, time, .. } = record else { continue };
        if !topics.connections.contains_key(&connection) {
            return Err(LogErrorKind::UnknownConnection(connection).at(section.place(at)));
        }
        *counts.entry(connection).or_default() += 1;
        let [first, last] = times.unwrap_or([time; 2]);
        times = Some([first.min(time), last.max(time)]);
    }
    section.counts = Some(counts);
    section.times = times;
    Ok(())
}
