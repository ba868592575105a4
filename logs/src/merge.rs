//! Messages in the order of their times, from sections that may overlap.

use std::{
    cmp::Reverse,
    collections::{BTreeMap, BinaryHeap},
};

use super::{
    container::{LogFile, PlacedRecord, Record, Section},
    error::{LogError, LogErrorKind},
    reader::Log,
};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawMessage {
    pub topic: usize,
    /// When it was recorded, in nanoseconds.
    pub time: u64,
    /// The offset of its record in its file, or of its compressed chunk; or its line.
    pub offset: u64,
    /// The index of its file in the log.
    pub(super) file: usize,
    /// Its number in the order of time, counted from 1.
    pub number: u64,
    pub bytes: Vec<u8>,
}

/// The largest size of the chunks in memory, in bytes.
const HELD: u64 = 64 << 20;

pub struct RawMessages<'l> {
    log: &'l Log,
    wanted: Vec<bool>,
    ahead: Vec<usize>,
    waiting: BinaryHeap<Reverse<Waiting>>,
    held: BTreeMap<usize, Held>,
    held_bytes: u64,
    asked: u64,
    number: u64,
}

/// A message that waits. Those of the same time come in the order of the file.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    time: u64,
    section: usize,
    at: usize,
    place: u64,
    start: usize,
    end: usize,
    topic: usize,
}

struct Held {
    bytes: Option<Vec<u8>>,
    waiting: usize,
    asked: u64,
}

impl Log {
    /// The messages of some of its topics in the order of their times, messages of the same time in the
    /// order of the file. Ends after the first error.
    ///
    /// Chunks that overlap in time are in memory together, up to 64 MiB; beyond that they are read again.
    pub fn read(&self, topics: &[usize]) -> RawMessages<'_> {
        RawMessages::new(self, topics)
    }

    pub(super) fn section(&self, index: usize) -> Option<(&Section, &LogFile)> {
        let section = self.sections.get(index)?;
        Some((section, self.files.get(section.file)?))
    }

    pub fn read_all(&self) -> RawMessages<'_> {
        RawMessages::new(self, &(0..self.topics.len()).collect::<Vec<_>>())
    }
}

impl<'l> RawMessages<'l> {
    fn new(log: &'l Log, topics: &[usize]) -> Self {
        // Without topics there is nothing to read.
        let sections = if topics.is_empty() { 0 } else { log.sections.len() };
        let mut ahead: Vec<usize> = (0..sections).collect();
        let start = |section: usize| log.sections.get(section).and_then(|section| section.times);
        ahead.sort_by_key(|section| Reverse((start(*section).map(|[start, _]| start), *section)));
        Self {
            log,
            wanted: (0..log.topics.len()).map(|topic| topics.contains(&topic)).collect(),
            ahead,
            waiting: BinaryHeap::new(),
            held: BTreeMap::new(),
            held_bytes: 0,
            asked: 0,
            number: 0,
        }
    }

    pub(super) fn end(&mut self) {
        self.ahead.clear();
        self.waiting.clear();
        self.held.clear();
        self.held_bytes = 0;
    }

    fn message(&mut self) -> Result<Option<RawMessage>, LogError> {
        loop {
            while let Some(&section) = self.ahead.last() {
                let start = self.log.sections.get(section).and_then(|section| section.times);
                let Some([start, _]) = start else {
                    self.ahead.pop();
                    continue;
                };
                if self.waiting.peek().is_some_and(|Reverse(first)| first.time < start) {
                    break;
                }
                self.ahead.pop();
                self.read_section(section, start)?;
            }
            let Some(Reverse(next)) = self.waiting.pop() else { return Ok(None) };
            self.number += 1;
            let is_wanted = self.wanted.get(next.topic).copied().unwrap_or_default();
            let message = if is_wanted { self.take(&next)? } else { None };
            self.release(next.section);
            if message.is_some() {
                return Ok(message);
            }
        }
    }

    fn read_section(&mut self, index: usize, start: u64) -> Result<(), LogError> {
        let log = self.log;
        let Some((section, file)) = log.section(index) else { return Ok(()) };
        let bytes = section.load(file)?;
        let mut waiting = 0;
        for read in section.records(file, &bytes) {
            let PlacedRecord { at, place, record } = read?;
            let Record::Message { connection, time, bytes } = record else { continue };
            let wrong = |cause: LogErrorKind| file.error(cause, place);
            let topic = log.connections.get(&(section.file, connection)).copied();
            let topic = topic.ok_or_else(|| wrong(LogErrorKind::UnknownConnection(connection)))?;
            if time < start {
                return Err(wrong(LogErrorKind::TooOld));
            }
            let [start, end] = [bytes.start, bytes.end].map(|within| at + within);
            let section = index;
            self.waiting.push(Reverse(Waiting { time, section, at, place, start, end, topic }));
            waiting += 1;
        }
        if waiting > 0 {
            self.asked += 1;
            self.held_bytes += section.size();
            self.held.insert(index, Held { bytes: Some(bytes), waiting, asked: self.asked });
            self.free_memory();
        }
        Ok(())
    }

    /// A message of a section, which is read again if it was released.
    fn take(&mut self, next: &Waiting) -> Result<Option<RawMessage>, LogError> {
        let Some((section, file)) = self.log.section(next.section) else { return Ok(None) };
        let Some(held) = self.held.get_mut(&next.section) else { return Ok(None) };
        self.asked += 1;
        held.asked = self.asked;
        let bytes = match &mut held.bytes {
            Some(bytes) => bytes,
            gone => {
                self.held_bytes += section.size();
                gone.insert(section.load(file)?)
            }
        };
        let bytes = bytes.get(next.start..next.end).unwrap_or_default().to_vec();
        self.free_memory();
        let bytes = file.message(bytes).map_err(|cause| file.error(cause, next.place))?;
        let Waiting { time, place: offset, topic, .. } = *next;
        let (file, number) = (section.file, self.number);
        Ok(Some(RawMessage { topic, time, offset, file, number, bytes }))
    }

    fn release(&mut self, index: usize) {
        let Some(held) = self.held.get_mut(&index) else { return };
        held.waiting -= 1;
        if held.waiting == 0 {
            let gone = self.held.remove(&index).and_then(|held| held.bytes);
            let section = self.log.sections.get(index);
            if let (Some(_), Some(section)) = (gone, section) {
                self.held_bytes -= section.size();
            }
        }
    }

    /// Releases the least recently requested sections, except the last request.
    fn free_memory(&mut self) {
        while self.held_bytes > HELD {
            let last = self.asked;
            let held = self.held.iter_mut();
            let others = held.filter(|(_, held)| held.bytes.is_some() && held.asked != last);
            let Some((index, held)) = others.min_by_key(|(_, held)| held.asked) else { return };
            held.bytes = None;
            self.held_bytes -= self.log.sections.get(*index).map_or(0, Section::size);
        }
    }
}

impl Iterator for RawMessages<'_> {
    type Item = Result<RawMessage, LogError>;

    fn next(&mut self) -> Option<Self::Item> {
        let next = self.message();
        if next.is_err() {
            self.end();
        }
        next.transpose()
    }
}
