//! `--memory`: the candidates of a search are sorted on disk.

use std::{
    cmp::Ordering,
    env, fs,
    io::{self, BufReader, BufWriter, IntoInnerError, Read, Seek, Take, Write},
    mem,
    path::{Path, PathBuf},
    str::FromStr,
    sync::{Mutex, PoisonError},
};

use ext_sort::BinaryHeapMerger;
use toposlam_model::ambiguity::{
    AmbiguityCandidate, CandidateSorter, CandidatesInMemory, SortedCandidates, SorterError,
};

use crate::cli::CliError;

/// The memory that a search takes besides what it sorts.
const BESIDES: u64 = 40_000_000;

/// The least memory with which a search works.
const LEAST: u64 = 64_000_000;

/// What a candidate takes besides its bytes: its place in a list, which may have to grow, and the allocator's own.
const FOR_EACH: usize = 64;

/// A bound on the memory of a search, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MemoryLimit(u64);

impl FromStr for MemoryLimit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const UNITS: [(&str, f64); 4] =
            [("MB", 1e6), ("GB", 1e9), ("MiB", (1 << 20) as f64), ("GiB", (1 << 30) as f64)];
        let parsed = UNITS.iter().find_map(|(unit, bytes)| {
            let number: f64 = text.strip_suffix(unit)?.trim_end().parse().ok()?;
            (number.is_finite() && number > 0.0).then_some((number * bytes) as u64)
        });
        match parsed {
            None => Err("write a number with MB, GB, MiB or GiB, as in 2GB".to_owned()),
            Some(bytes) if bytes < LEAST => Err("a search needs at least 64MB".to_owned()),
            Some(bytes) => Ok(Self(bytes)),
        }
    }
}

/// The sorter for the candidates of a search.
pub(super) fn sorter(limit: Option<MemoryLimit>) -> Result<Box<dyn CandidateSorter>, CliError> {
    let Some(limit) = limit else { return Ok(Box::new(CandidatesInMemory::default())) };
    let at_once = usize::try_from(limit.0 - BESIDES).unwrap_or(usize::MAX);
    let on_disk = CandidatesOnDisk::new(at_once, env::temp_dir());
    Ok(Box::new(on_disk.map_err(|cause| CliError::at("--memory", cause))?))
}

/// A file of sorted candidates, each after its length.
struct CandidateFile(Take<BufReader<fs::File>>);

impl CandidateFile {
    /// Writes sorted candidates to a file in a folder.
    fn write(candidates: &[AmbiguityCandidate], folder: &Path) -> io::Result<Self> {
        let mut writer = BufWriter::new(tempfile::tempfile_in(folder)?);
        for candidate in candidates {
            let bytes = candidate.as_bytes();
            writer.write_all(&(bytes.len() as u32).to_le_bytes())?;
            writer.write_all(bytes)?;
        }
        let mut file = writer.into_inner().map_err(IntoInnerError::into_error)?;
        let length = file.stream_position()?;
        file.rewind()?;
        Ok(Self(BufReader::new(file).take(length)))
    }

    fn read(&mut self) -> io::Result<AmbiguityCandidate> {
        let mut length = [0; 4];
        self.0.read_exact(&mut length)?;
        let length = u32::from_le_bytes(length);
        if u64::from(length) > self.0.limit() {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; length as usize];
        self.0.read_exact(&mut bytes)?;
        let candidate = AmbiguityCandidate::from_bytes(bytes.into_boxed_slice());
        candidate.ok_or_else(|| io::ErrorKind::InvalidData.into())
    }
}

impl Iterator for CandidateFile {
    type Item = io::Result<AmbiguityCandidate>;

    fn next(&mut self) -> Option<Self::Item> {
        (self.0.limit() > 0).then(|| self.read())
    }
}

/// Sorts candidates in memory until there are too many, and then in files that are merged at the end.
struct CandidatesOnDisk {
    /// The most bytes of candidates in memory.
    at_once: usize,
    added: Mutex<Added>,
    /// The folder of the files.
    folder: PathBuf,
}

#[derive(Default)]
struct Added {
    in_memory: Vec<AmbiguityCandidate>,
    /// What these take, in bytes.
    bytes: usize,
    /// They have no names: the system removes them when the program ends in any way.
    files: Vec<CandidateFile>,
}

impl CandidatesOnDisk {
    fn new(at_once: usize, folder: PathBuf) -> Result<Self, String> {
        tempfile::tempfile_in(&folder).map_err(|error| failure(&folder, &error))?;
        Ok(Self { at_once, added: Mutex::default(), folder })
    }
}

/// The message of a failure in the folder of temporary files.
fn failure(folder: &Path, error: &io::Error) -> String {
    let advice = "TMPDIR=DIR chooses another folder for temporary files";
    format!("{}: {error}; {advice}", folder.display())
}

/// Moves the candidates in memory to a file. One thread sorts: with several, another part of the search would
/// begin while this one waits, and wait for the same lock.
fn spill(added: &mut Added, folder: &Path) -> Result<(), SorterError> {
    let mut candidates = mem::take(&mut added.in_memory);
    added.bytes = 0;
    candidates.sort_unstable();
    let file = CandidateFile::write(&candidates, folder);
    added.files.push(file.map_err(|error| failure(folder, &error))?);
    Ok(())
}

impl CandidateSorter for CandidatesOnDisk {
    fn add(&self, candidates: Vec<AmbiguityCandidate>) -> Result<(), SorterError> {
        let mut added = self.added.lock().unwrap_or_else(PoisonError::into_inner);
        for candidate in candidates {
            let bytes = candidate.as_bytes().len() + FOR_EACH;
            if added.bytes + bytes > self.at_once && added.bytes > 0 {
                spill(&mut added, &self.folder)?;
            }
            added.bytes += bytes;
            added.in_memory.push(candidate);
        }
        Ok(())
    }

    fn sorted(self: Box<Self>) -> Result<SortedCandidates, SorterError> {
        let Self { added, folder, .. } = *self;
        let mut added = added.into_inner().unwrap_or_else(PoisonError::into_inner);
        if added.files.is_empty() {
            added.in_memory.sort_unstable();
            return Ok(Box::new(added.in_memory.into_iter().map(Ok)));
        }
        spill(&mut added, &folder)?;
        let order: fn(&AmbiguityCandidate, &AmbiguityCandidate) -> Ordering = Ord::cmp;
        let merged = BinaryHeapMerger::new(added.files, order);
        Ok(Box::new(merged.map(move |candidate: io::Result<_>| {
            candidate.map_err(|error| failure(&folder, &error).into())
        })))
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use toposlam_model::{
        aid::named,
        ambiguity::{AmbiguitySearch, KeptPairs},
        enumerate::Class,
    };

    use super::*;

    /// The candidates of a search.
    #[derive(Default)]
    struct Collected(Mutex<Vec<AmbiguityCandidate>>);

    impl CandidateSorter for &Collected {
        fn add(&self, candidates: Vec<AmbiguityCandidate>) -> Result<(), SorterError> {
            self.0.lock().unwrap().extend(candidates);
            Ok(())
        }

        fn sorted(self: Box<Self>) -> Result<SortedCandidates, SorterError> {
            Ok(Box::new(iter::empty()))
        }
    }

    /// The candidates of one search, sorted: several threads find them in any order.
    fn candidates() -> Vec<AmbiguityCandidate> {
        let search = AmbiguitySearch::new(Class::Multigraph, 6, named("undirected").unwrap());
        let collected = Collected::default();
        let sorter = Box::new(&collected);
        search.unwrap().run_sorted(sorter, KeptPairs::Smallest, &()).unwrap();
        let mut found = collected.0.into_inner().unwrap();
        found.sort();
        found
    }

    #[test]
    fn candidates_come_back_in_their_order_from_many_files() {
        let sorted = candidates();
        let reversed: Vec<_> = sorted.iter().rev().cloned().collect();
        assert!(sorted.len() > 1000);
        let bytes: usize = sorted.iter().map(|one| one.as_bytes().len() + FOR_EACH).sum();
        for parts in [1, 5, 20] {
            let folder = tempfile::tempdir().unwrap();
            let on_disk = CandidatesOnDisk::new(bytes / parts, folder.path().to_owned()).unwrap();
            on_disk.add(reversed.clone()).unwrap();
            let files = on_disk.added.lock().unwrap().files.len();
            assert!((parts - 1..=parts).contains(&files), "{files} files");
            let returned: Result<Vec<_>, _> = Box::new(on_disk).sorted().unwrap().collect();
            assert_eq!(returned.unwrap(), sorted);
            // The files never have names.
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }

    #[test]
    fn a_file_that_cannot_be_written_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_owned();
        let on_disk = CandidatesOnDisk::new(100, path.clone()).unwrap();
        folder.close().unwrap();
        let error = on_disk.add(candidates()).unwrap_err().to_string();
        let begins = format!("{}: No such file or directory", path.display());
        assert!(error.starts_with(&begins) && error.contains("TMPDIR=DIR"), "{error}");
        assert_eq!(CandidatesOnDisk::new(100, path).err(), Some(error));
    }

    #[test]
    fn a_file_that_ends_early_or_is_not_of_candidates_is_an_error() {
        let mut bytes = Vec::new();
        let candidates = candidates();
        for candidate in &candidates[..2] {
            bytes.extend((candidate.as_bytes().len() as u32).to_le_bytes());
            bytes.extend(candidate.as_bytes());
        }
        let read = |bytes: &[u8]| {
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(bytes).unwrap();
            file.rewind().unwrap();
            let mut file = CandidateFile(BufReader::new(file).take(bytes.len() as u64));
            (file.next().unwrap().is_ok(), file.next().unwrap().map_err(|error| error.kind()))
        };
        assert!(matches!(read(&bytes), (true, Ok(_))));
        let cut = read(&bytes[..bytes.len() - 1]);
        assert_eq!(cut, (true, Err(io::ErrorKind::UnexpectedEof)));
        let second = 4 + candidates[0].as_bytes().len();
        bytes[second + 4] = 0xff;
        assert_eq!(read(&bytes), (true, Err(io::ErrorKind::InvalidData)));
    }

    #[test]
    fn a_limit_has_a_unit() {
        let limit = |text: &str| text.parse::<MemoryLimit>().map(|limit| limit.0);
        assert_eq!(limit("2GB"), Ok(2_000_000_000));
        assert_eq!(limit("1.5 GiB"), Ok(3 << 29));
        assert_eq!(limit("64MB"), Ok(64_000_000));
        for wrong in ["", "GB", "2", "2 gb", "nanGB", "infGB", "0GB", "63MB", "1TB"] {
            assert!(limit(wrong).is_err(), "{wrong}");
        }
    }
}
