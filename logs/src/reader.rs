//! A log that is open for reading, and its topics.

use std::{collections::BTreeMap, fs::File, io::Cursor, path::Path, sync::Mutex};

use super::{
    compressed::{FileCompression, Storage},
    container::{
        self, BAG_MAGIC, Database, Format, LogFile, MCAP_MAGIC, PlacedRecord, Record, Section,
        TEXT_HEAD, TextState,
    },
    error::{LogError, LogErrorKind, OffsetUnit, Truncation},
    line_times::LineTimes,
    no_return::NoReturnSign,
    rosbag2,
    skipped_lines::SkippedLines,
    source::Source,
    topic::{Topic, Topics},
};

/// A log, open for reading.
///
/// Its messages stay in the file until they are asked for.
pub struct Log {
    pub(super) files: Vec<LogFile>,
    pub(super) format: Format,
    pub(super) topics: Vec<Topic>,
    pub(super) connections: BTreeMap<(usize, u32), usize>,
    /// Those with messages, in the order of the files.
    pub(super) sections: Vec<Section>,
    truncation: Option<Truncation>,
    times: Option<[u64; 2]>,
    indexed: bool,
    /// How the scans on a topic write that there is no return, once it was asked for.
    pub(super) no_returns: Mutex<BTreeMap<usize, Option<NoReturnSign>>>,
}

impl Log {
    /// Opens a file, or a folder of rosbag2.
    ///
    /// # Errors
    /// As [`Log::new`].
    pub fn open(path: &Path) -> Result<Self, LogError> {
        if path.is_dir() {
            let open = |name: String| match open_file(&path.join(&name)) {
                Ok(file) => Ok(LogFile { name: Some(name), ..file }),
                Err(error) => Err(LogError { file: Some(name), ..error }),
            };
            let files = rosbag2::names(path)?.into_iter().map(open);
            return Self::of_files(files.collect::<Result<_, _>>()?, Format::Folder);
        }
        Self::of_file(open_file(path)?)
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
        Self::of_file(open(Box::new(storage), None)?)
    }

    fn of_file(file: LogFile) -> Result<Self, LogError> {
        let format = file.format;
        Self::of_files(vec![file], format)
    }

    fn of_files(mut files: Vec<LogFile>, format: Format) -> Result<Self, LogError> {
        let mut topics = Topics::default();
        let mut all_sections = Vec::new();
        let mut truncation = None;
        let mut indexed = true;
        for (index, file) in files.iter_mut().enumerate() {
            let topics = topics.in_file(index);
            let (scan, text) = container::scan(file, &mut |record| topics.add_record(record))?;
            file.text = text;
            // An index is at the end of its file.
            indexed &= file.format.unit() != OffsetUnit::Line && scan.truncation.is_none();
            let (unit, name) = (file.format.unit(), file.name.clone());
            let ended = scan.truncation;
            let ended = ended.map(|(offset, cause)| Truncation { offset, unit, file: name, cause });
            truncation = truncation.or(ended);
            for mut section in scan.sections {
                section.file = index;
                let known = section.counts.as_ref().is_some_and(|counts| {
                    let mut ids = counts.keys();
                    let declared = ids.all(|id| topics.connections.contains_key(&(index, *id)));
                    let empty = counts.values().all(|count| *count == 0);
                    declared && (section.times.is_some() || empty)
                });
                if !known {
                    indexed = false;
                    scan_section(&mut section, file, topics)?;
                }
                all_sections.push(section);
            }
        }
        let Topics { list: topics, connections, .. } = topics;
        let mut log = Self {
            files,
            format,
            topics,
            connections,
            sections: all_sections,
            truncation,
            times: None,
            indexed,
            no_returns: Mutex::default(),
        };
        log.count();
        Ok(log)
    }

    fn count(&mut self) {
        for section in &self.sections {
            for (id, count) in section.counts.iter().flatten() {
                let topic = self
                    .connections
                    .get(&(section.file, *id))
                    .and_then(|topic| self.topics.get_mut(*topic));
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

    pub fn format(&self) -> Format {
        self.format
    }

    /// What the offsets of its messages count. rosbag2 writes all files of a folder in one format.
    pub fn offset_unit(&self) -> OffsetUnit {
        self.files.first().map_or(self.format, |file| file.format).unit()
    }

    pub fn size(&self) -> u64 {
        self.files.iter().fold(0, |sum, file| sum.saturating_add(file.source.size))
    }

    pub fn compression(&self) -> Option<FileCompression> {
        self.files.first().and_then(|file| file.source.compression)
    }

    /// The lines that are skipped, of a log of lines; `None` if there are none.
    pub fn skipped(&self) -> Option<&SkippedLines> {
        self.files.first().map(|file| &file.text.skipped).filter(|skipped| !skipped.is_empty())
    }

    /// The times of a log of lines, if some are not those of a clock.
    pub fn irregular_times(&self) -> Option<LineTimes> {
        self.files.first().map(|file| file.text.times).filter(|times| times.irregular() > 0)
    }

    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// The time of its first message, in nanoseconds; `None` if it has none.
    pub fn start(&self) -> Option<u64> {
        self.times.map(|[start, _]| start)
    }

    /// The time of its last message, in nanoseconds; `None` if it has none.
    pub fn end(&self) -> Option<u64> {
        self.times.map(|[_, end]| end)
    }

    pub fn messages_total(&self) -> u64 {
        self.topics.iter().fold(0, |sum, topic| sum.saturating_add(topic.messages))
    }

    /// Whether it has an index of its messages. If not, all of it was read to find them.
    pub fn is_indexed(&self) -> bool {
        self.indexed
    }

    pub fn truncation(&self) -> Option<&Truncation> {
        self.truncation.as_ref()
    }
}

fn open_file(path: &Path) -> Result<LogFile, LogError> {
    let file = File::open(path).map_err(|error| LogErrorKind::from(error).at(0))?;
    open(Box::new(file), Some(path))
}

fn open(storage: Box<dyn Storage>, path: Option<&Path>) -> Result<LogFile, LogError> {
    let wrong = |cause: LogErrorKind| cause.at(0);
    let mut source = Source::new(storage).map_err(|error| wrong(error.into()))?;
    let format = format(&source)?;
    if matches!(format, Format::Bag | Format::Mcap) && source.compression.is_none() {
        source.end_before_zeros().map_err(|error| wrong(error.into()))?;
    }
    let database = match format {
        Format::Database if source.is_cut => {
            return Err(LogErrorKind::CutDatabase.at(source.length()));
        }
        Format::Database => Some(Database::open(&source, path).map_err(wrong)?),
        _ => None,
    };
    Ok(LogFile { name: None, format, source, database, text: TextState::default() })
}

fn format(source: &Source) -> Result<Format, LogError> {
    let head = source.read(0..source.length().min(TEXT_HEAD));
    let head = head.map_err(|error| LogErrorKind::from(error).at(0))?;
    if head.starts_with(MCAP_MAGIC) {
        return Ok(Format::Mcap);
    }
    if head.starts_with(BAG_MAGIC) {
        return Ok(Format::Bag);
    }
    if head.starts_with(b"SQLite format 3\0") {
        return Ok(Format::Database);
    }
    if let Some(format) = container::recognise(&head) {
        return Ok(format);
    }
    let head = head.get(..16).unwrap_or(&head);
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
    file: &LogFile,
    topics: &mut Topics,
) -> Result<(), LogError> {
    let bytes = section.load(file)?;
    let mut counts = BTreeMap::new();
    let mut times: Option<[u64; 2]> = None;
    for read in section.records(file, &bytes) {
        let PlacedRecord { place, record, .. } = read?;
        topics.add_record(&record);
        let Record::Message { connection, time, .. } = record else { continue };
        if !topics.connections.contains_key(&(section.file, connection)) {
            return Err(file.error(LogErrorKind::UnknownConnection(connection), place));
        }
        *counts.entry(connection).or_default() += 1;
        let [first, last] = times.unwrap_or([time; 2]);
        times = Some([first.min(time), last.max(time)]);
    }
    section.counts = Some(counts);
    section.times = times;
    Ok(())
}
