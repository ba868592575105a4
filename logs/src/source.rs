//! The bytes of a log, in a file or in memory.

use std::{
    io::{self, Read, Seek, SeekFrom},
    ops::Range,
    sync::{Mutex, PoisonError},
};

use super::compressed::{Decompressed, FileCompression, Storage};

/// A file with random access, perhaps compressed.
pub(super) struct Source {
    storage: Mutex<Box<dyn Storage>>,
    length: u64,
    pub(super) size: u64,
    pub(super) compression: Option<FileCompression>,
    pub(super) is_cut: bool,
}

impl Source {
    pub(super) fn new(mut storage: Box<dyn Storage>) -> io::Result<Self> {
        let size = storage.seek(SeekFrom::End(0))?;
        storage.seek(SeekFrom::Start(0))?;
        let mut head = Vec::new();
        (&mut storage).take(4).read_to_end(&mut head)?;
        let compression = FileCompression::detect(&head);
        let Some(known) = compression else {
            let storage = Mutex::new(storage);
            return Ok(Self { storage, length: size, size, compression, is_cut: false });
        };
        let (mut storage, is_cut) = Decompressed::new(storage, known)?;
        let length = storage.seek(SeekFrom::End(0))?;
        let storage: Box<dyn Storage> = Box::new(storage);
        Ok(Self { storage: Mutex::new(storage), length, size, compression, is_cut })
    }

    /// Ends the file before the zeros at its end, if there are many: a computer that lost power has not written
    /// what belongs there.
    pub(super) fn end_before_zeros(&mut self) -> io::Result<()> {
        let mut end = self.length;
        loop {
            let start = end.saturating_sub(AHEAD);
            let bytes = self.read(start..end)?;
            match bytes.iter().rposition(|&byte| byte != 0) {
                Some(last) => {
                    end = start + last as u64 + 1;
                    break;
                }
                None if start == 0 => return Ok(()),
                None => end = start,
            }
        }
        if self.length - end >= MANY_ZEROS {
            self.length = end;
        }
        Ok(())
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// A part of the file; takes as much memory as it is long. It must lie within the file.
    pub(super) fn read(&self, part: Range<u64>) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.read_into(part, &mut bytes)?;
        Ok(bytes)
    }

    fn read_into(&self, part: Range<u64>, bytes: &mut Vec<u8>) -> io::Result<()> {
        if part.start > part.end || part.end > self.length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let length = usize::try_from(part.end - part.start).map_err(io::Error::other)?;
        let mut storage = self.storage.lock().unwrap_or_else(PoisonError::into_inner);
        storage.seek(SeekFrom::Start(part.start))?;
        bytes.clear();
        bytes.resize(length, 0);
        storage.read_exact(bytes)
    }
}

/// Reads a file from its front to its back, a little ahead.
pub(super) struct Window<'s> {
    source: &'s Source,
    start: u64,
    bytes: Vec<u8>,
}

const AHEAD: u64 = 1 << 16;
/// No log ends with so many zeros.
const MANY_ZEROS: u64 = 256;

impl<'s> Window<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        Self { source, start: 0, bytes: Vec::new() }
    }

    /// A part of the file; `None` if the file ends before it.
    pub(super) fn get(&mut self, start: u64, length: u64) -> io::Result<Option<&[u8]>> {
        let Some(end) = start.checked_add(length).filter(|end| *end <= self.source.length) else {
            return Ok(None);
        };
        if start < self.start || end > self.start + self.bytes.len() as u64 {
            let ahead = end.max(start.saturating_add(AHEAD).min(self.source.length));
            self.source.read_into(start..ahead, &mut self.bytes)?;
            self.start = start;
        }
        let [start, end] = [start, end].map(|at| (at - self.start) as usize);
        Ok(self.bytes.get(start..end))
    }

    pub(super) fn within(&self, end: u64) -> bool {
        end <= self.source.length
    }

    pub(super) fn u32(&mut self, start: u64) -> io::Result<Option<u32>> {
        Ok(self.get(start, 4)?.and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes))
    }
}
