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
    watch.parts((numbers.end.saturating_sub(numbers.start)) as usize);
    let numbers: Vec<_> = numbers.collect();
    let results = numbers.into_par_iter().with_max_len(1).map(|number| {
        if watch.stop() {
            return Ok(None);
        }
        let result = work(number)?;
        watch.part_done(1);
        Ok(Some(result))
    });
    let results = results.collect::<Result<Vec<_>, E>>()?;
    Ok(results.into_iter().flatten().collect())
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
