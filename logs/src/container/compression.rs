//! How chunks are compressed.

use std::io::Read;

use lz4_flex::frame::FrameDecoder as Lz4Decoder;
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};

use crate::error::LogErrorKind;

pub const MOST_GROWTH: u64 = 1000;

/// Every decoder of Zstandard supports a window of this many bytes.
const USUAL_WINDOW: u64 = 8 << 20;
/// A larger window is at most this many times as long as the compressed chunk: the decoder keeps it in
/// memory twice.
const MOST_WINDOW_GROWTH: u64 = 300;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Bz2,
    Lz4,
    Zstd,
}

impl Compression {
    pub(super) fn of_bag(name: &[u8]) -> Result<Self, LogErrorKind> {
        match name {
            b"none" => Ok(Self::None),
            b"bz2" => Ok(Self::Bz2),
            b"lz4" => Ok(Self::Lz4),
            _ => Err(unknown(name, "none, bz2 and lz4")),
        }
    }

    /// Whether compressed bytes carry a checksum that decompression compares, by their first five bytes.
    /// The checksum of Zstandard is not compared.
    pub(super) fn has_checksum(self, head: &[u8]) -> bool {
        // Of the blocks or of the content, by the flags of an LZ4 frame.
        const LZ4_CHECKSUMS: u8 = 0b0001_0100;
        match self {
            Self::None | Self::Zstd => false,
            Self::Bz2 => true,
            Self::Lz4 => head.get(4).is_some_and(|flags| flags & LZ4_CHECKSUMS != 0),
        }
    }

    pub(super) fn of_mcap(name: &[u8]) -> Result<Self, LogErrorKind> {
        match name {
            b"" => Ok(Self::None),
            b"lz4" => Ok(Self::Lz4),
            b"zstd" => Ok(Self::Zstd),
            _ => Err(unknown(name, "lz4 and zstd")),
        }
    }
}

fn unknown(name: &[u8], known: &'static str) -> LogErrorKind {
    let beginning = name.get(..name.len().min(20)).unwrap_or_default();
    LogErrorKind::Compression(String::from_utf8_lossy(beginning).into_owned(), known)
}

/// The decompressed bytes of a chunk, checked for their size and checksum.
pub(super) fn decompress(
    compression: Compression,
    bytes: Vec<u8>,
    size: u64,
    checksum: u32,
) -> Result<Vec<u8>, LogErrorKind> {
    let compressed = bytes.len() as u64;
    if compressed == 0 && size == 0 {
        // A recorder that crashes leaves this of the chunk that it compresses.
        return Ok(bytes);
    }
    if size > compressed.saturating_mul(MOST_GROWTH) {
        return Err(LogErrorKind::Growth { compressed, size, most: MOST_GROWTH });
    }
    let whole = match compression {
        Compression::None => bytes,
        Compression::Bz2 => read(bzip2::read::BzDecoder::new(&bytes[..]), size)?,
        Compression::Lz4 => read(Lz4Decoder::new(&bytes[..]), size)?,
        Compression::Zstd => {
            let mut decoder = FrameDecoder::new();
            let window = size.min(compressed.saturating_mul(MOST_WINDOW_GROWTH));
            decoder.set_max_window_size(window.max(USUAL_WINDOW));
            let mut whole = Vec::with_capacity(size as usize);
            decoder.decode_all_to_vec(&bytes, &mut whole).map_err(|error| fails(&error))?;
            whole
        }
    };
    let found = whole.len() as u64;
    if found != size {
        return Err(LogErrorKind::Size { claimed: size, found });
    }
    if checksum != 0 && crc32fast::hash(&whole) != checksum {
        return Err(LogErrorKind::Checksum("chunk"));
    }
    Ok(whole)
}

pub(super) const ZSTANDARD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

pub(super) fn decompress_message(bytes: &[u8]) -> Result<Vec<u8>, LogErrorKind> {
    let compressed = bytes.len() as u64;
    let most = compressed.saturating_mul(MOST_GROWTH);
    let frame = StreamingDecoder::new(bytes).map_err(|error| fails(&error))?;
    let whole = read(frame, most)?;
    let size = whole.len() as u64;
    if size > most {
        return Err(LogErrorKind::Growth { compressed, size, most: MOST_GROWTH });
    }
    Ok(whole)
}

fn read(decoder: impl Read, size: u64) -> Result<Vec<u8>, LogErrorKind> {
    let mut whole = Vec::new();
    decoder.take(size.saturating_add(1)).read_to_end(&mut whole).map_err(|error| fails(&error))?;
    Ok(whole)
}

fn fails(error: &impl ToString) -> LogErrorKind {
    LogErrorKind::Undecompressable(error.to_string().replace(char::is_control, " "))
}
