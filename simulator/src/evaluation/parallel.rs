//! Runs many cases on all threads and returns the results in order.

use std::convert::Infallible;

use rayon::prelude::*;
use toposlam_model::enumerate::Watch;

/// Works on numbers on all threads. The results are in the order of the numbers.
pub(super) fn in_turn<R: Send, E: Send>(
    numbers: std::ops::Range<u64>,
    watch: &dyn Watch,
    work: impl Fn(u64) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let count = usize::try_from(numbers.end.saturating_sub(numbers.start)).unwrap_or(usize::MAX);
    watch.parts(count);
    let numbered = (0..count).into_par_iter().with_max_len(1);
    // The numbers after a stop are not even counted: there may be very many.
    let results = numbered.take_any_while(|_| !watch.stop()).map(|index| {
        let result = work(numbers.start + index as u64)?;
        watch.part_done(1);
        Ok(result)
    });
    results.collect()
}

/// Makes the cases of these numbers, as far as they exist, on all threads. `make` returns `None` if the
/// watch stopped it.
pub(super) fn made_in_turn<C, R: Send>(
    numbers: std::ops::Range<u64>,
    watch: &dyn Watch,
    case: impl Fn(u64) -> Option<C> + Sync,
    make: impl Fn(C) -> Option<R> + Sync,
) -> Vec<R> {
    let made = in_turn(numbers, watch, |number| Ok::<_, Infallible>(case(number).and_then(&make)));
    made.into_iter().flatten().flatten().collect()
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
            let made = made_in_turn(5..u64::MAX, &watch, Some, Some);
            // A case that was begun is completed.
            assert!(made.len() as u64 >= most && made.is_sorted(), "{made:?}");
            assert_eq!(made.len() as u64, watch.done.into_inner());
        }
        assert_eq!(made_in_turn(5..9, &(), Some, Some), [5, 6, 7, 8]);
    }
}
