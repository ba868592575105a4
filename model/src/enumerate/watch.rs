//! Long work on many worlds: done in parts, in parallel if there are threads, with progress.

use std::num::NonZero;

use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Interrupted;

/// Watches long work, from several threads at once, and may stop it.
pub trait Watch: Sync {
    fn parts(&self, _count: usize) {}

    /// One part is done, with this number of cases.
    fn part_done(&self, _cases: u64) {}

    fn stop(&self) -> bool {
        false
    }

    /// Does the same as [`stop`](Self::stop), as an error.
    ///
    /// # Errors
    /// Returns an error if the work is to stop.
    fn check_stop(&self) -> Result<(), Interrupted> {
        if self.stop() { Err(Interrupted) } else { Ok(()) }
    }
}

impl Watch for () {}

/// The most threads that work is spread over.
pub const MOST_THREADS: u16 = 1024;

/// The number of threads that work is spread over unless a user gives another one: the variable `RAYON_NUM_THREADS` of the
/// environment, at most [`MOST_THREADS`], or the number of processors.
#[must_use]
pub fn threads() -> usize {
    let wanted = std::env::var("RAYON_NUM_THREADS").ok().and_then(|number| number.parse().ok());
    let processors = || std::thread::available_parallelism().map_or(1, NonZero::get);
    wanted.filter(|&number| number > 0).unwrap_or_else(processors).min(MOST_THREADS.into())
}

/// Works on the parts and merges the results in the order of the parts. The number of threads is that of rayon's pool, or 1 without the feature `rayon`.
pub(crate) fn in_parts<P: Sync, R: Send>(
    parts: &[P],
    watch: &dyn Watch,
    nothing: impl Fn() -> R + Sync + Send,
    work: impl Fn(&P) -> R + Sync + Send,
    cases: impl Fn(&R) -> u64 + Sync,
    merge: impl Fn(R, R) -> R + Sync + Send,
) -> R {
    watch.parts(parts.len());
    let work = |part: &P| {
        let result = work(part);
        watch.part_done(cases(&result));
        result
    };
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        parts.par_iter().with_max_len(1).map(work).reduce(nothing, merge)
    }
    #[cfg(not(feature = "rayon"))]
    {
        parts.iter().map(work).fold(nothing(), merge)
    }
}
