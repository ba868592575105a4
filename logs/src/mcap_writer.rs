//! Writing MCAP files (mcap.dev/spec): chunks compressed by LZ4, and an index of them.
//!
//! [`container::mcap`](super::container) reads them.

use std::{
    collections::BTreeMap,
    io::{self, Write},
};

use crc32fast::Hasher;
use lz4_flex::frame::{BlockMode, BlockSize, FrameEncoder, FrameInfo};

use super::container::MCAP_MAGIC;

const HEADER: u8 = 0x01;
const FOOTER: u8 = 0x02;
const SCHEMA: u8 = 0x03;
const CHANNEL: u8 = 0x04;
const MESSAGE: u8 = 0x05;
const CHUNK: u8 = 0x06;
const MESSAGE_INDEX: u8 = 0x07;
const CHUNK_INDEX: u8 = 0x08;
const STATISTICS: u8 = 0x0b;
const METADATA: u8 = 0x0c;
const METADATA_INDEX: u8 = 0x0d;
const SUMMARY_OFFSET: u8 = 0x0e;
const DATA_END: u8 = 0x0f;

/// An MCAP file that is being written. A chunk is written whole or not at all. When dropped, the file is
/// finished, unless writing has failed.
pub(super) struct McapWriter<W: Write> {
    /// `None` after the end and after an error.
    out: Option<W>,
    length: u64,
    checksum: Hasher,
    chunk: Chunk,
    chunk_count: u32,
    metadata_count: u32,
    counts: BTreeMap<u16, u64>,
    times: Option<[u64; 2]>,
    schemas: Vec<u8>,
    channels: Vec<u8>,
    chunk_indexes: Vec<u8>,
    metadata_indexes: Vec<u8>,
}

#[derive(Default)]
struct Chunk {
    records: Vec<u8>,
    times: Option<[u64; 2]>,
    messages: BTreeMap<u16, Vec<[u64; 2]>>,
}

impl<W: Write> McapWriter<W> {
    pub(super) fn new(out: W, profile: &str, library: &str) -> io::Result<Self> {
        let mut writer = Self {
            out: Some(out),
            length: 0,
            checksum: Hasher::new(),
            chunk: Chunk::default(),
            chunk_count: 0,
            metadata_count: 0,
            counts: BTreeMap::new(),
            times: None,
            schemas: Vec::new(),
            channels: Vec::new(),
            chunk_indexes: Vec::new(),
            metadata_indexes: Vec::new(),
        };
        writer.put(MCAP_MAGIC)?;
        writer.put(&Fields::new().text(profile).text(library).record(HEADER))?;
        Ok(writer)
    }

    /// Adds a schema of ROS 2 and a channel that uses it, both with the same number, counted from 1.
    pub(super) fn add_channel(&mut self, topic: &str, type_name: &str, schema: &str) -> u16 {
        let id = self.counts.len() as u16 + 1;
        let record = Fields::new().u16(id).text(type_name).text("ros2msg").text(schema);
        let record = record.record(SCHEMA);
        self.chunk.records.extend(&record);
        self.schemas.extend(record);
        let record = Fields::new().u16(id).u16(id).text(topic).text("cdr").map(&[]).record(CHANNEL);
        self.chunk.records.extend(&record);
        self.channels.extend(record);
        self.counts.insert(id, 0);
        id
    }

    /// Adds a message to the present chunk, at a time in nanoseconds.
    pub(super) fn add_message(&mut self, channel: u16, time: u64, body: &[u8]) {
        let chunk = &mut self.chunk;
        let place = chunk.records.len() as u64;
        chunk.messages.entry(channel).or_default().push([time, place]);
        let count = self.counts.entry(channel).or_default();
        let head = Fields::new().u16(channel).u32(*count as u32).u64(time).u64(time).0;
        *count += 1;
        chunk.records.push(MESSAGE);
        chunk.records.extend((head.len() as u64 + body.len() as u64).to_le_bytes());
        chunk.records.extend(head);
        chunk.records.extend(body);
        for times in [&mut chunk.times, &mut self.times] {
            let [first, last] = times.unwrap_or([time; 2]);
            *times = Some([first.min(time), last.max(time)]);
        }
    }

    pub(super) fn write_metadata(
        &mut self,
        name: &str,
        entries: &BTreeMap<String, String>,
    ) -> io::Result<()> {
        self.end_chunk()?;
        let entries: Vec<_> = entries.iter().collect();
        let pairs = entries.iter().fold(Fields::new(), |all, (k, v)| all.text(k).text(v));
        let record = Fields::new().text(name).map(&pairs.0).record(METADATA);
        let index = Fields::new().u64(self.length).u64(record.len() as u64).text(name);
        self.metadata_indexes.extend(index.record(METADATA_INDEX));
        self.metadata_count += 1;
        self.put(&record)
    }

    /// Ends the present chunk: what was written so far is in the file.
    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.end_chunk()?;
        self.out.as_mut().map_or(Ok(()), Write::flush)
    }

    /// Writes the index and the end of the file. `None` if that was done before, or if writing has
    /// failed.
    pub(super) fn finish(&mut self) -> io::Result<Option<W>> {
        if self.out.is_none() {
            return Ok(None);
        }
        self.end_chunk()?;
        let checksum = self.checksum.clone().finalize();
        self.put(&Fields::new().u32(checksum).record(DATA_END))?;
        let summary = self.summary();
        self.put(&summary)?;
        self.put(MCAP_MAGIC)?;
        let mut out = self.out.take();
        out.as_mut().map_or(Ok(()), Write::flush)?;
        Ok(out)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        let out = self.out.as_mut().ok_or_else(|| io::Error::other("the log is closed"))?;
        if let Err(error) = out.write_all(bytes) {
            self.out = None;
            return Err(error);
        }
        self.length += bytes.len() as u64;
        self.checksum.update(bytes);
        Ok(())
    }

    fn end_chunk(&mut self) -> io::Result<()> {
        let chunk = std::mem::take(&mut self.chunk);
        if chunk.records.is_empty() {
            return Ok(());
        }
        let start = self.length;
        let [first, last] = chunk.times.unwrap_or_default();
        let size = chunk.records.len() as u64;
        let compressed = compressed(&chunk.records)?;
        let record = Fields::new().u64(first).u64(last).u64(size);
        let record = record.u32(crc32fast::hash(&chunk.records)).text("lz4");
        let mut record = record.u64(compressed.len() as u64);
        record.0.extend(&compressed);
        self.put(&record.record(CHUNK))?;
        let end = self.length;
        let mut places = Fields::new();
        for (channel, messages) in chunk.messages {
            places = places.u16(channel).u64(self.length);
            let entries = messages.iter().fold(Fields::new(), |all, [t, at]| all.u64(*t).u64(*at));
            self.put(&Fields::new().u16(channel).map(&entries.0).record(MESSAGE_INDEX))?;
        }
        let index = Fields::new().u64(first).u64(last).u64(start).u64(end - start);
        let index = index.map(&places.0).u64(self.length - end).text("lz4");
        let index = index.u64(compressed.len() as u64).u64(size);
        self.chunk_indexes.extend(index.record(CHUNK_INDEX));
        self.chunk_count += 1;
        Ok(())
    }

    fn summary(&self) -> Vec<u8> {
        let [first, last] = self.times.unwrap_or_default();
        let channels = self.counts.len();
        let statistics = Fields::new().u64(self.counts.values().sum()).u16(channels as u16);
        let statistics = statistics.u32(channels as u32).u32(0).u32(self.metadata_count);
        let counts = self.counts.iter().fold(Fields::new(), |all, (id, n)| all.u16(*id).u64(*n));
        let statistics = statistics.u32(self.chunk_count).u64(first).u64(last).map(&counts.0);
        let (mut summary, mut offsets) = (Vec::new(), Vec::new());
        for (op, group) in [
            (SCHEMA, &self.schemas),
            (CHANNEL, &self.channels),
            (STATISTICS, &statistics.record(STATISTICS)),
            (CHUNK_INDEX, &self.chunk_indexes),
            (METADATA_INDEX, &self.metadata_indexes),
        ] {
            if !group.is_empty() {
                let mut offset = Fields(vec![op]);
                offset = offset.u64(self.length + summary.len() as u64).u64(group.len() as u64);
                offsets.extend(offset.record(SUMMARY_OFFSET));
                summary.extend(group);
            }
        }
        let footer = Fields::new().u64(self.length).u64(self.length + summary.len() as u64);
        summary.extend(offsets);
        summary.extend(footer.u32(0).record(FOOTER));
        // The checksum covers the footer up to the checksum.
        let checksum = summary.len() - 4;
        let value = crc32fast::hash(&summary[..checksum]);
        summary[checksum..].copy_from_slice(&value.to_le_bytes());
        summary
    }
}

impl<W: Write> Drop for McapWriter<W> {
    fn drop(&mut self) {
        let _ = self.finish();
    }
}

fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let info = FrameInfo::new().block_size(BlockSize::Max4MB).block_mode(BlockMode::Linked);
    let mut encoder = FrameEncoder::with_frame_info(info, Vec::new());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?)
}

struct Fields(Vec<u8>);

impl Fields {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn u16(mut self, value: u16) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn u32(mut self, value: u32) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn u64(mut self, value: u64) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn text(self, text: &str) -> Self {
        self.map(text.as_bytes())
    }

    fn map(self, entries: &[u8]) -> Self {
        let mut fields = self.u32(entries.len() as u32);
        fields.0.extend(entries);
        fields
    }

    fn record(self, op: u8) -> Vec<u8> {
        let mut record = vec![op];
        record.extend((self.0.len() as u64).to_le_bytes());
        record.extend(self.0);
        record
    }
}
