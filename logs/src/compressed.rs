//! Compressed files: gzip and Zstandard, read from front to back without being kept in memory. A step back
//! starts again from the front.

use std::{
    io::{self, BufReader, Read, Seek, SeekFrom},
    sync::{Arc, Mutex, PoisonError},
};

use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

/// Where the bytes of a log are.
pub trait Storage: Read + Seek + Send {}

impl<S: Read + Seek + Send> Storage for S {}

const GZIP: &[u8] = &[0x1f, 0x8b];
const ZSTANDARD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

toposlam_model::words! {
    FileCompression {
        Gzip = "gzip",
        Zstandard = "zstd",
    }
}

impl FileCompression {
    pub(super) fn detect(head: &[u8]) -> Option<Self> {
        match head {
            head if head.starts_with(GZIP) => Some(Self::Gzip),
            head if head.starts_with(ZSTANDARD) => Some(Self::Zstandard),
            _ => None,
        }
    }
}

/// A log does not become larger by a greater factor, ...
const MOST_GROWTH: u64 = 200;
/// ... or it is not larger than this, in bytes.
const ALWAYS: u64 = 256 << 20;

/// A compressed file, as the file that it decompresses to.
pub(super) struct Decompressed {
    file: SharedFile,
    compression: FileCompression,
    decoder: Box<dyn Read + Send>,
    decoded: u64,
    position: u64,
    length: u64,
}

impl Decompressed {
    /// Decompresses a file once, for its length. The truth is whether its end is missing.
    ///
    /// # Errors
    /// Returns an error if it cannot be read, or if it is much larger than any log would be.
    pub(super) fn new(
        storage: Box<dyn Storage>,
        compression: FileCompression,
    ) -> io::Result<(Self, bool)> {
        let file = SharedFile { storage: Arc::new(Mutex::new(storage)), at: 0, ended: false };
        let size = file.size()?;
        let most = size.saturating_mul(MOST_GROWTH).max(ALWAYS);
        let decoder = decoder(compression, file.clone());
        let mut opened =
            Self { file, compression, decoder, decoded: 0, position: 0, length: u64::MAX };
        let ended = io::copy(&mut (&mut opened).take(most.saturating_add(1)), &mut io::sink());
        opened.length = opened.decoded;
        if opened.length > most {
            let cause = format!(
                "{size} compressed bytes become more than {most}, {MOST_GROWTH} times as many"
            );
            return Err(io::Error::other(cause));
        }
        match ended {
            Ok(_) => Ok((opened, false)),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok((opened, true)),
            Err(error) => Err(error),
        }
    }
}

fn decoder(compression: FileCompression, file: SharedFile) -> Box<dyn Read + Send> {
    match compression {
        FileCompression::Gzip => {
            Box::new(MultiGzDecoder::new(BufReader::with_capacity(1 << 16, file)))
        }
        FileCompression::Zstandard => Box::new(Frames::Before(file)),
    }
}

impl Read for Decompressed {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        if self.position >= self.length {
            return Ok(0);
        }
        if self.position < self.decoded {
            self.decoder = decoder(self.compression, self.file.clone());
            self.decoded = 0;
        }
        if self.position > self.decoded {
            let before = self.position - self.decoded;
            self.decoded += io::copy(&mut (&mut self.decoder).take(before), &mut io::sink())?;
        }
        let most = usize::try_from(self.length - self.position).unwrap_or(usize::MAX);
        let most = most.min(bytes.len());
        let read = self.decoder.read(bytes.get_mut(..most).unwrap_or_default())?;
        self.decoded += read as u64;
        self.position += read as u64;
        Ok(read)
    }
}

impl Seek for Decompressed {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let to = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.length.checked_add_signed(by),
            SeekFrom::Current(by) => self.position.checked_add_signed(by),
        };
        self.position = to.ok_or(io::ErrorKind::InvalidInput)?;
        Ok(self.position)
    }
}

/// The compressed file. Each clone starts at its front.
struct SharedFile {
    storage: Arc<Mutex<Box<dyn Storage>>>,
    at: u64,
    ended: bool,
}

impl SharedFile {
    fn size(&self) -> io::Result<u64> {
        let mut storage = self.storage.lock().unwrap_or_else(PoisonError::into_inner);
        storage.seek(SeekFrom::End(0))
    }

    fn goes_on(&self) -> io::Result<bool> {
        let mut ahead = Self { at: self.at, ..self.clone() };
        Ok(ahead.read(&mut [0])? > 0)
    }
}

impl Clone for SharedFile {
    fn clone(&self) -> Self {
        Self { storage: self.storage.clone(), at: 0, ended: false }
    }
}

impl Read for SharedFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let mut storage = self.storage.lock().unwrap_or_else(PoisonError::into_inner);
        storage.seek(SeekFrom::Start(self.at))?;
        let read = storage.read(bytes)?;
        self.at += read as u64;
        self.ended |= read == 0 && !bytes.is_empty();
        Ok(read)
    }
}

/// The frames of a Zstandard file, one after the other.
enum Frames {
    Before(SharedFile),
    In(Box<StreamingDecoder<SharedFile, FrameDecoder>>),
}

impl Read for Frames {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            match self {
                Self::Before(file) if !file.goes_on()? => return Ok(0),
                Self::Before(file) => {
                    let start = SharedFile { at: file.at, ..file.clone() };
                    let frame = StreamingDecoder::new(start).map_err(io::Error::other)?;
                    *self = Self::In(Box::new(frame));
                }
                Self::In(frame) => {
                    let read = frame.read(bytes).map_err(|error| {
                        let ended = frame.get_ref().ended;
                        if ended { io::ErrorKind::UnexpectedEof.into() } else { error }
                    })?;
                    if read > 0 || bytes.is_empty() {
                        return Ok(read);
                    }
                    let end = frame.get_ref();
                    *self = Self::Before(SharedFile { at: end.at, ..end.clone() });
                }
            }
        }
    }
}
