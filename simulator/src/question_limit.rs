//! A watch for tests: it stops work at a question, so that a test counts questions and measures no time.

use std::sync::atomic::{AtomicU64, Ordering};

use toposlam_model::enumerate::Watch;

/// Stops at the question of this number, from 1, and at each one after it.
pub(crate) struct QuestionLimit {
    at: u64,
    asked: AtomicU64,
}

impl QuestionLimit {
    pub(crate) fn at(at: u64) -> Self {
        Self { at, asked: AtomicU64::new(0) }
    }

    /// Counts the questions and stops nothing.
    pub(crate) fn never() -> Self {
        Self::at(u64::MAX)
    }

    /// The number of questions so far.
    pub(crate) fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Watch for QuestionLimit {
    fn stop(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) + 1 >= self.at
    }
}
