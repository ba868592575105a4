//! The driver of all measurements.

use std::ops::Range;

use rayon::prelude::*;
use toposlam_model::enumerate::Watch;

/// Takes the samples of these numbers on all threads. The results are in the order of the numbers and do not depend on
/// the number of threads. `sample` returns `None` if there is no such sample, or if the watch stopped it.
pub fn sample<R: Send>(
    numbers: Range<u64>,
    watch: &dyn Watch,
    sample: impl Fn(u64) -> Option<R> + Sync,
) -> Vec<R> {
    let count = usize::try_from(numbers.end.saturating_sub(numbers.start)).unwrap_or(usize::MAX);
    watch.parts(count);
    // The numbers after a stop are not even counted: there may be very many.
    let indices = (0..count).into_par_iter().with_max_len(1).take_any_while(|_| !watch.stop());
    let samples = indices.map(|index| {
        let result = sample(numbers.start + index as u64);
        watch.part_done(1);
        result
    });
    samples.flatten_iter().collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;

    /// Stops when some cases are done.
    #[derive(Default)]
    struct StopsAfter {
        most: u64,
        done: AtomicU64,
    }

    impl Watch for StopsAfter {
        fn part_done(&self, cases: u64) {
            self.done.fetch_add(cases, Ordering::Relaxed);
        }

        fn stop(&self) -> bool {
            self.done.load(Ordering::Relaxed) >= self.most
        }
    }

    #[test]
    fn a_stop_ends_any_number_of_cases_at_once() {
        for most in [0, 100] {
            let watch = StopsAfter { most, ..StopsAfter::default() };
            let made = sample(5..u64::MAX, &watch, Some);
            // A case that was begun is completed.
            assert!(made.len() as u64 >= most && made.is_sorted(), "{made:?}");
            assert_eq!(made.len() as u64, watch.done.into_inner());
        }
        assert_eq!(sample(5..9, &(), Some), [5, 6, 7, 8]);
    }
}
