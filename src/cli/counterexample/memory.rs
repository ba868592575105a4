//! `--memory`: the candidates of a search are sorted on disk.

use std::{
    cmp::Ordering,
    io::{self, Read, Write},
    iter,
    str::FromStr,
    sync::{Mutex, PoisonError},
};

use extsort::{ExternalSorter, PushExternalSorter, Sortable};
use toposlam_model::ambiguity::{
    AmbiguityCandidate, AmbiguitySearch, CandidateSorter, CandidatesInMemory, SortedCandidates,
    SorterError,
};

use crate::cli::{CliError, temporary_folder::TemporaryFolder};

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
pub(super) fn sorter(
    limit: Option<MemoryLimit>,
    search: &AmbiguitySearch,
) -> Result<Box<dyn CandidateSorter>, CliError> {
    let Some(limit) = limit else { return Ok(Box::new(CandidatesInMemory::default())) };
    let for_each = (search.candidate_bytes() + FOR_EACH) as u64;
    let at_once = (limit.0 - BESIDES) / for_each;
    let on_disk = CandidatesOnDisk::new(usize::try_from(at_once).unwrap_or(usize::MAX));
    Ok(Box::new(on_disk.map_err(|cause| CliError::at("--memory", cause))?))
}

/// A candidate that can be written to disk.
struct Stored(AmbiguityCandidate);

impl Sortable for Stored {
    fn encode<W: Write>(&self, writer: &mut W) -> io::Result<()> {
        let bytes = self.0.as_bytes();
        writer.write_all(&(bytes.len() as u32).to_le_bytes())?;
        writer.write_all(bytes)
    }

    fn decode<R: Read>(reader: &mut R) -> io::Result<Self> {
        let mut length = [0; 4];
        reader.read_exact(&mut length)?;
        let mut bytes = vec![0; u32::from_le_bytes(length) as usize];
        reader.read_exact(&mut bytes)?;
        let candidate = AmbiguityCandidate::from_bytes(bytes.into_boxed_slice());
        candidate.map(Self).ok_or_else(|| io::ErrorKind::InvalidData.into())
    }
}

type Order = fn(&Stored, &Stored) -> Ordering;

/// Sorts candidates in memory until there are too many, and then in files that are merged at the end.
struct CandidatesOnDisk {
    sorter: Mutex<PushExternalSorter<Stored, Order>>,
    folder: TemporaryFolder,
}

impl CandidatesOnDisk {
    /// Keeps so many candidates in memory.
    fn new(at_once: usize) -> Result<Self, String> {
        let folder = TemporaryFolder::new()?;
        let sorter = ExternalSorter::new()
            .with_segment_size(at_once)
            .with_sort_dir(folder.path().to_owned())
            .with_parallel_sort()
            .pushed_by((|one, other| one.0.cmp(&other.0)) as Order);
        Ok(Self { sorter: Mutex::new(sorter), folder })
    }
}

impl CandidateSorter for CandidatesOnDisk {
    fn add(&self, candidates: Vec<AmbiguityCandidate>) -> Result<(), SorterError> {
        let mut sorter = self.sorter.lock().unwrap_or_else(PoisonError::into_inner);
        let added = sorter.push_iter(candidates.into_iter().map(Stored));
        added.map_err(|error| self.folder.failure(&error).into())
    }

    fn sorted(self: Box<Self>) -> Result<SortedCandidates, SorterError> {
        let Self { sorter, folder } = *self;
        let sorter = sorter.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut sorted = sorter.done().map_err(|error| folder.failure(&error))?;
        let mut left = sorted.sorted_count();
        Ok(Box::new(iter::from_fn(move || match sorted.next() {
            Some(Ok(Stored(candidate))) => {
                left -= 1;
                Some(Ok(candidate))
            }
            Some(Err(error)) => Some(Err(folder.failure(&error).into())),
            // A file that ends too early looks like one that is finished.
            None if left > 0 => {
                left = 0;
                Some(Err(folder.failure(&io::ErrorKind::UnexpectedEof.into()).into()))
            }
            None => None,
        })))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use toposlam_model::{enumerate::Class, marker::named};

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

    fn candidates() -> Vec<AmbiguityCandidate> {
        let search = AmbiguitySearch::new(Class::Multigraph, 5, named("undirected").unwrap());
        let collected = Collected::default();
        let kept = toposlam_model::ambiguity::KeptPairs::Smallest;
        search.unwrap().run_sorted(Box::new(&collected), kept, &()).unwrap();
        collected.0.into_inner().unwrap()
    }

    #[test]
    fn candidates_come_back_in_their_order_from_many_files() {
        let mut all = candidates();
        assert!(all.len() > 1000);
        for at_once in [usize::MAX, 100, 7] {
            let on_disk = CandidatesOnDisk::new(at_once).unwrap();
            let folder = on_disk.folder.path().to_owned();
            on_disk.add(all.clone()).unwrap();
            let files = fs::read_dir(&folder).unwrap().count();
            assert_eq!(files > 0, at_once < all.len());
            let sorted: Result<Vec<_>, _> = Box::new(on_disk).sorted().unwrap().collect();
            all.sort();
            assert_eq!(sorted.unwrap(), all);
            assert!(!folder.exists());
        }
    }

    #[test]
    fn a_file_that_was_cut_or_cannot_be_written_is_an_error() {
        let all = candidates();
        let on_disk = CandidatesOnDisk::new(100).unwrap();
        on_disk.add(all.clone()).unwrap();
        let file = fs::OpenOptions::new().write(true).open(on_disk.folder.path().join("3"));
        file.unwrap().set_len(50).unwrap();
        let sorted: Result<Vec<_>, _> = Box::new(on_disk).sorted().unwrap().collect();
        let error = sorted.unwrap_err().to_string();
        assert!(error.contains("toposlam-") && error.contains("TMPDIR=DIR"), "{error}");
        let on_disk = CandidatesOnDisk::new(100).unwrap();
        fs::remove_dir_all(on_disk.folder.path()).unwrap();
        let error = on_disk.add(all).unwrap_err().to_string();
        assert!(error.contains("No such file or directory"), "{error}");
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
