//! Writing a log: MCAP with the profile `ros2`, messages in CDR, definitions embedded.
//!
//! The same messages make the same bytes. A writer that is killed leaves a log that can be read up to
//! its last chunk: a chunk is written whole, and holds at most [`CHUNK_TIME`] of messages and, unless
//! one message is larger, [`CHUNK_BYTES`].

use std::{
    collections::BTreeMap,
    io::{self, Write},
};

use byteorder::LittleEndian;
use mcap::{
    McapError, WriteOptions,
    records::{MessageHeader, Metadata},
    write::{NoSeek, Writer},
};
use thiserror::Error;

use super::message::{Message, schema};

/// The messages of a chunk are so long apart at most, in nanoseconds: ten seconds.
pub const CHUNK_TIME: u64 = 10_000_000_000;
/// So many bytes before compression fill a chunk.
pub const CHUNK_BYTES: usize = 1 << 20;

/// Before the body of a message: plain CDR, the lesser byte first.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

/// Why a log cannot be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The file does not take it.
    #[error(transparent)]
    File(#[from] io::Error),
    /// It would be no log.
    #[error(transparent)]
    Log(McapError),
    /// A message cannot be told in CDR.
    #[error("{topic}: {cause}")]
    Message {
        /// The topic of the message.
        topic: String,
        /// What is wrong with it.
        cause: cdr_encoding::Error,
    },
}

impl From<McapError> for WriteError {
    fn from(error: McapError) -> Self {
        match error {
            McapError::Io(error) => Self::File(error),
            error => Self::Log(error),
        }
    }
}

/// A log that is being written. Dropped before it is finished, it still becomes a file that is whole;
/// only a process that is killed leaves a part of one.
pub struct LogWriter<W: Write> {
    out: Writer<NoSeek<W>>,
    topics: BTreeMap<String, Topic>,
    /// The present message; its memory serves the next.
    body: Vec<u8>,
    chunk: Option<Chunk>,
}

#[derive(Clone, Copy, Debug)]
struct Topic {
    channel: u16,
    /// The number of the next message.
    sequence: u32,
}

/// What is in the chunk that is being filled.
#[derive(Clone, Copy, Debug)]
struct Chunk {
    begun: u64,
    bytes: usize,
}

impl<W: Write> LogWriter<W> {
    /// Begins a log.
    ///
    /// # Errors
    /// Where the file does not take it.
    pub fn new(out: W) -> Result<Self, WriteError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library("toposlam")
            // Chunks are ended here, by two rules instead of one.
            .chunk_size(None)
            // A chunk is in the file whole or not at all.
            .disable_seeking(true)
            // On any machine the same.
            .compression_threads(0);
        let out = options.create(NoSeek::new(out))?;
        Ok(Self { out, topics: BTreeMap::new(), body: Vec::new(), chunk: None })
    }

    /// Writes something that is known of the whole log, under a name.
    ///
    /// # Errors
    /// Where the file does not take it.
    pub fn note(
        &mut self,
        name: &str,
        entries: BTreeMap<String, String>,
    ) -> Result<(), WriteError> {
        self.chunk = None;
        Ok(self.out.write_metadata(&Metadata { name: name.to_owned(), metadata: entries })?)
    }

    /// Writes a message, at a time in nanoseconds.
    ///
    /// # Errors
    /// Where the file does not take it, or the message cannot be told.
    pub fn write<M: Message>(
        &mut self,
        topic: &str,
        time: u64,
        message: &M,
    ) -> Result<(), WriteError> {
        self.body.clear();
        self.body.extend(ENCAPSULATION);
        cdr_encoding::to_writer::<M, LittleEndian, _>(&mut self.body, message)
            .map_err(|cause| WriteError::Message { topic: topic.to_owned(), cause })?;
        let bytes = self.body.len();
        if let Some(chunk) = self.chunk
            && (chunk.bytes + bytes > CHUNK_BYTES || time.saturating_sub(chunk.begun) > CHUNK_TIME)
        {
            self.flush()?;
        }
        let (channel_id, sequence) = self.next_of::<M>(topic)?;
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.out.write_to_known_channel(&header, &self.body)?;
        self.chunk.get_or_insert(Chunk { begun: time, bytes: 0 }).bytes += bytes;
        Ok(())
    }

    /// Ends the chunk: what was written so far is in the file.
    ///
    /// # Errors
    /// Where the file does not take it.
    pub fn flush(&mut self) -> Result<(), WriteError> {
        self.chunk = None;
        Ok(self.out.flush()?)
    }

    /// Ends the log.
    ///
    /// # Errors
    /// Where the file does not take it.
    pub fn finish(mut self) -> Result<W, WriteError> {
        self.out.finish()?;
        let mut out = self.out.into_inner().into_inner();
        out.flush()?;
        Ok(out)
    }

    /// The channel of a topic, and the number of its next message.
    fn next_of<M: Message>(&mut self, topic: &str) -> Result<(u16, u32), WriteError> {
        let known = match self.topics.get_mut(topic) {
            Some(known) => known,
            None => {
                let schema =
                    self.out.add_schema(M::TYPE, "ros2msg", schema::<M>().as_bytes())?;
                let channel = self.out.add_channel(schema, topic, "cdr", &BTreeMap::new())?;
                self.topics.entry(topic.to_owned()).or_insert(Topic { channel, sequence: 0 })
            }
        };
        let sequence = known.sequence;
        known.sequence = sequence.wrapping_add(1);
        Ok((known.channel, sequence))
    }
}
