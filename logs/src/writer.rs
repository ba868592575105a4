//! Writing a log: MCAP with the profile `ros2`, messages in CDR, definitions embedded.
//!
//! The same messages make the same bytes. A writer that is killed leaves a log that can be read up to
//! its last chunk: a chunk is written whole, and holds at most [`CHUNK_TIME`] of messages and, unless
//! one message is larger, [`CHUNK_BYTES`].

#![expect(
    clippy::missing_errors_doc,
    reason = "each function returns an error if the file cannot be written"
)]

use std::{
    collections::BTreeMap,
    io::{self, Write},
};

use byteorder::LittleEndian;
use cdr::Serializer;
use thiserror::Error;

use super::{
    mcap_writer::McapWriter,
    message::{Message, schema},
};

/// The messages of a chunk are so long apart at most, in nanoseconds: ten seconds.
pub const CHUNK_TIME: u64 = 10_000_000_000;
/// The size of a full chunk before compression, in bytes.
pub const CHUNK_BYTES: usize = 1 << 20;

/// Before the body of a message: plain CDR, the lesser byte first.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

#[derive(Debug, Error)]
pub enum LogWriteError {
    #[error(transparent)]
    File(#[from] io::Error),
    #[error("{topic}: {cause}")]
    Message { topic: String, cause: cdr::Error },
}

/// A log that is being written. Dropped before it is finished, it still becomes a file that is whole;
/// only a process that is killed leaves a part of one.
pub struct LogWriter<W: Write> {
    out: McapWriter<W>,
    /// The channels of the topics.
    topics: BTreeMap<String, u16>,
    /// The present message; its memory serves the next.
    body: Vec<u8>,
    chunk: Option<Chunk>,
}

#[derive(Clone, Copy, Debug)]
struct Chunk {
    begun: u64,
    bytes: usize,
}

impl<W: Write> LogWriter<W> {
    /// Begins a log.
    pub fn new(out: W) -> Result<Self, LogWriteError> {
        let out = McapWriter::new(out, "ros2", "toposlam")?;
        Ok(Self { out, topics: BTreeMap::new(), body: Vec::new(), chunk: None })
    }

    /// Writes something that is known of the whole log, under a name.
    pub fn note(
        &mut self,
        name: &str,
        entries: &BTreeMap<String, String>,
    ) -> Result<(), LogWriteError> {
        self.chunk = None;
        Ok(self.out.write_metadata(name, entries)?)
    }

    /// Writes a message, at a time in nanoseconds.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written, or the message cannot be encoded.
    pub fn write<M: Message>(
        &mut self,
        topic: &str,
        time: u64,
        message: &M,
    ) -> Result<(), LogWriteError> {
        self.body.clear();
        self.body.extend(ENCAPSULATION);
        message
            .serialize(&mut Serializer::<_, LittleEndian>::new(&mut self.body))
            .map_err(|cause| LogWriteError::Message { topic: topic.to_owned(), cause })?;
        let bytes = self.body.len();
        if let Some(chunk) = self.chunk
            && (chunk.bytes + bytes > CHUNK_BYTES || time.saturating_sub(chunk.begun) > CHUNK_TIME)
        {
            self.flush()?;
        }
        let channel = self.channel::<M>(topic);
        self.out.add_message(channel, time, &self.body);
        self.chunk.get_or_insert(Chunk { begun: time, bytes: 0 }).bytes += bytes;
        Ok(())
    }

    /// Ends the chunk: what was written so far is in the file.
    pub fn flush(&mut self) -> Result<(), LogWriteError> {
        self.chunk = None;
        Ok(self.out.flush()?)
    }

    /// Ends the log.
    pub fn finish(mut self) -> Result<W, LogWriteError> {
        let closed = || io::Error::other("the log is closed");
        Ok(self.out.finish()?.ok_or_else(closed)?)
    }

    fn channel<M: Message>(&mut self, topic: &str) -> u16 {
        if let Some(known) = self.topics.get(topic) {
            return *known;
        }
        let channel = self.out.add_channel(topic, M::TYPE, &schema(M::DEFINITION));
        self.topics.insert(topic.to_owned(), channel);
        channel
    }
}

#[cfg(test)]
mod tests {
    use mcap::{
        MessageStream, Summary,
        read::Options,
        records::{Record, op},
    };

    use super::*;
    use crate::messages::{Command, Door, Percept, ProjectMessage, Stamp};

    const SECOND: u64 = 1_000_000_000;

    fn written(messages: impl Fn(&mut LogWriter<Vec<u8>>)) -> Vec<u8> {
        let mut log = LogWriter::new(Vec::new()).unwrap();
        messages(&mut log);
        log.finish().unwrap()
    }

    fn bodies(file: &[u8]) -> Vec<Vec<u8>> {
        let messages =
            MessageStream::new_with_options(file, Options::IgnoreEndMagic.into()).unwrap();
        messages.map_while(Result::ok).map(|message| message.data.to_vec()).collect()
    }

    fn doors(count: u64) -> impl Fn(&mut LogWriter<Vec<u8>>) {
        move |log| {
            for time in 0..count {
                let door = Door { r#move: time as u32, ..Door::default() };
                log.write(Door::TOPIC, time * SECOND, &door).unwrap();
            }
        }
    }

    /// Common Data Representation: each number is aligned to its size, counted from the end of the four
    /// bytes of encapsulation. A string starts with its length and ends in a zero. An array of fixed
    /// length has no length field.
    #[test]
    fn a_message_is_written_in_cdr() {
        let stamp = Stamp { sec: 1, nanosec: 2 };
        let command = Command { stamp, state: "go".to_owned(), turn: 1.0, forward: -0.5 };
        let form = [true, false, true, false];
        let percept = Percept {
            stamp,
            r#move: 3,
            degree: 2,
            marker: -1,
            form,
            entry: 1.0,
            ..Percept::default()
        };
        let file = written(|log| {
            log.write(Command::TOPIC, 5, &command).unwrap();
            log.write(Percept::TOPIC, 6, &percept).unwrap();
        });
        let (one, minus_half) = ([0, 0, 0, 0, 0, 0, 0xf0, 0x3f], [0, 0, 0, 0, 0, 0, 0xe0, 0xbf]);
        let head = [0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0];
        let word = [3, 0, 0, 0, b'g', b'o', 0, 0];
        let padded = [&head[..], &word, &one, &minus_half].concat();
        let aligned = [&head[..], &[3, 0, 0, 0, 2, 0, 0, 0, 255, 255, 255, 255, 1, 0, 1, 0]];
        let empty = vec![1, 0, 0, 0, 0];
        assert_eq!(bodies(&file), [padded, [aligned.concat(), one.to_vec(), empty].concat()]);
    }

    #[test]
    fn the_same_messages_make_the_same_bytes_of_the_profile_of_ros_2() {
        let file = written(doors(30));
        assert_eq!(file, written(doors(30)));
        let mut records = mcap::read::LinearReader::new(&file).unwrap();
        let Some(Ok(Record::Header(header))) = records.next() else { panic!("a header") };
        assert_eq!((header.profile.as_str(), header.library.as_str()), ("ros2", "toposlam"));
        let message = MessageStream::new(&file).unwrap().next().unwrap().unwrap();
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!((schema.name.as_str(), schema.encoding.as_str()), (Door::TYPE, "ros2msg"));
        let text = String::from_utf8(schema.data.to_vec()).unwrap();
        let time = "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
        assert!(text.starts_with(Door::DEFINITION) && text.ends_with(time), "{text}");
        assert_eq!(message.channel.message_encoding, "cdr");
    }

    #[test]
    fn a_log_that_was_broken_off_is_read_up_to_its_last_whole_chunk() {
        let file = written(doors(35));
        let chunks = Summary::read(&file).unwrap().unwrap().chunk_indexes;
        // Eleven messages are ten seconds long.
        assert_eq!(chunks.len(), 4);
        for (number, chunk) in chunks.iter().enumerate() {
            let begins = chunk.chunk_start_offset as usize;
            let ends = begins + chunk.chunk_length as usize;
            assert_eq!(file[begins], op::CHUNK);
            assert_eq!(bodies(&file[..ends - 1]).len(), 11 * number);
            assert_eq!(bodies(&file[..ends]).len(), (11 * (number + 1)).min(35));
        }
    }

    #[test]
    fn a_chunk_is_full_at_a_mebibyte_and_one_message_may_be_larger() {
        let sizes = [600_000, 500_000, 3_000_000, 1000];
        let file = written(|log| {
            for bytes in sizes {
                let data = vec![7; bytes];
                let image = crate::standard::CompressedImage::new(Stamp::default(), &data);
                log.write("/camera", 0, &image).unwrap();
            }
        });
        assert_eq!(Summary::read(&file).unwrap().unwrap().chunk_indexes.len(), sizes.len());
        assert!(bodies(&file).iter().map(Vec::len).eq(sizes.map(|bytes| bytes + 36)));
    }

    struct Full(usize);

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            if taken == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(taken) }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_an_error_at_any_byte() {
        let fill = |bytes: usize| {
            let mut log = LogWriter::new(Full(bytes))?;
            log.note("n", &BTreeMap::new())?;
            for time in 0..20 {
                log.write(Door::TOPIC, time * SECOND, &Door::default())?;
            }
            log.finish()
        };
        let most = 1 << 20;
        let needed = most - fill(most).unwrap().0;
        for bytes in 0..needed {
            let Err(LogWriteError::File(error)) = fill(bytes) else {
                panic!("{bytes} bytes are enough")
            };
            assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{bytes}");
        }
        assert!(fill(needed).is_ok());
    }
}
