//! Where a search puts its candidates, to get them back in order.

use std::{
    error,
    sync::{Mutex, PoisonError},
};

use thiserror::Error;

use super::{AmbiguityCandidate, Unfinished};

/// Why candidates cannot be stored or read.
pub type SorterError = Box<dyn error::Error + Send + Sync>;

/// Why a search with a [sorter](CandidateSorter) has no findings.
#[derive(Debug, Error)]
pub enum SearchError {
    #[error(transparent)]
    Unfinished(#[from] Unfinished),
    #[error("{0}")]
    Sorter(SorterError),
}

pub type SortedCandidates = Box<dyn Iterator<Item = Result<AmbiguityCandidate, SorterError>>>;

/// Sorts the candidates of a search: in memory, on disk, or on other machines.
pub trait CandidateSorter: Sync {
    /// Adds candidates, in any order and from several threads.
    ///
    /// # Errors
    /// Returns an error if they cannot be stored.
    fn add(&self, candidates: Vec<AmbiguityCandidate>) -> Result<(), SorterError>;

    /// All candidates that were added, in their order.
    ///
    /// # Errors
    /// Returns an error if they cannot be read; so does the iterator.
    fn sorted(self: Box<Self>) -> Result<SortedCandidates, SorterError>;
}

#[derive(Debug, Default)]
pub struct CandidatesInMemory(Mutex<Vec<AmbiguityCandidate>>);

impl CandidateSorter for CandidatesInMemory {
    fn add(&self, candidates: Vec<AmbiguityCandidate>) -> Result<(), SorterError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend(candidates);
        Ok(())
    }

    fn sorted(self: Box<Self>) -> Result<SortedCandidates, SorterError> {
        let mut candidates = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        // No two candidates are equal.
        candidates.sort_unstable();
        Ok(Box::new(candidates.into_iter().map(Ok)))
    }
}
